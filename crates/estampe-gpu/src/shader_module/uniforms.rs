//! The bytes of a uniform block, set by name.

use super::{ScalarType, UniformBlock, UniformError, UniformMember, ValueType};
use estampe_format::half;
use estampe_types::{Mat2, Mat3, Mat4};

/// The bytes of a uniform block. They begin as the values that the shader gives its uniforms
/// (`uniform float gain = 0.5;` in GLSL), and as zeros where it gives none.
///
/// ```
/// use estampe::{Device, DeviceDescriptor, Mat4, ShaderModuleDescriptor, ShaderSource};
///
/// let device = Device::new(&DeviceDescriptor::default())?;
/// let module = device.create_shader_module(&ShaderModuleDescriptor::new(ShaderSource::Glsl {
///     vertex: "#version 330 core
///         in vec3 position;
///         uniform mat4 model;
///         void main() { gl_Position = model * vec4(position, 1.0); }",
///     fragment: "#version 330 core
///         uniform vec3 tint[2];
///         out vec4 color;
///         void main() { color = vec4(tint[0] + tint[1], 1.0); }",
/// }))?;
/// let mut uniforms = module.uniforms("")?;
/// uniforms.set("model", Mat4::translation([0.0, 1.0, 0.0]))?;
/// uniforms.set("tint[1]", [0.5_f32, 0.25, 1.0])?;
/// let buffer = device.create_buffer_with_contents(uniforms.bytes())?;
/// assert_eq!(buffer.size(), 64 + 2 * 16);
/// let error = uniforms.set("model", 1.0_f32).unwrap_err();
/// assert_eq!(error.to_string(), "the uniform `model` is mat4x4<f32>, and the value is f32");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Uniforms {
    block: UniformBlock,
    bytes: Vec<u8>,
}

impl Uniforms {
    /// The bytes of a block. Other shaders have the same block, or its beginning, and may give
    /// values to other uniforms.
    pub(super) fn new<'a>(
        block: UniformBlock,
        same: impl Iterator<Item = &'a UniformBlock>,
    ) -> Self {
        // In whole words: a block may end with one 16-bit float.
        let bytes = vec![0; block.size.next_multiple_of(4) as usize];
        let mut uniforms = Self { block, bytes };
        for member in same.flat_map(|block| &block.members) {
            if let Some(words) = &member.initial_value {
                let count = member.array_length.unwrap_or(1).max(1) as usize;
                let length = words.len().div_ceil(count).max(1);
                for (element, words) in words.chunks(length).enumerate() {
                    let offset = member.offset as usize + member.array_stride as usize * element;
                    uniforms.put(member, offset, words);
                }
            }
        }
        uniforms
    }

    /// The names, types and offsets.
    #[must_use]
    pub fn block(&self) -> &UniformBlock {
        &self.block
    }

    /// The bytes, for a uniform buffer or for immediates.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Sets a uniform: `model`, `lights[2].color`, or an element of an array, `weights[3]`. Values
    /// of `f32` are rounded to 16 bits for uniforms of `f16`.
    ///
    /// # Errors
    /// [`UniformError`] if there is no such uniform, or it has another type.
    pub fn set(&mut self, name: &str, value: impl UniformValue) -> Result<(), UniformError> {
        let (member, offset) = self.find(name)?;
        let actual = value.value_type();
        if of_host(actual) != of_host(member.kind) {
            return Err(UniformError::Type {
                name: name.to_owned(),
                expected: member.kind.to_string(),
                actual: actual.to_string(),
            });
        }
        self.put(&member, offset, &value.words());
        Ok(())
    }

    /// Writes the words of a member, or of an element of it, from a byte on.
    fn put(&mut self, member: &UniformMember, offset: usize, words: &[u32]) {
        let rows = match member.kind {
            ValueType::Scalar(_) => 1,
            ValueType::Vector(_, rows) | ValueType::Matrix { rows, .. } => usize::from(rows),
        };
        let is_half = member.kind.scalar() == ScalarType::F16;
        let size = if is_half { 2 } else { 4 };
        let stride = member.matrix_stride as usize;
        let words_of_column = rows * words_of(member.kind);
        for (column, words) in words.chunks(words_of_column).enumerate() {
            let first = offset + column * stride;
            for (row, &word) in words.iter().enumerate() {
                let at = first + row * size;
                let word = if is_half {
                    half::encode(f32::from_bits(word))
                } else {
                    word
                };
                // A member lies in its block.
                if let Some(bytes) = self.bytes.get_mut(at..at + size) {
                    bytes.copy_from_slice(&word.to_le_bytes()[..size]);
                }
            }
        }
    }

    /// The member of a name, and the first byte of it or of its element.
    fn find(&self, name: &str) -> Result<(UniformMember, usize), UniformError> {
        let of = |name: &str| self.block.members.iter().find(|member| member.name == name);
        if let Some(member) = of(name) {
            return Ok((member.clone(), member.offset as usize));
        }
        let element = name
            .strip_suffix(']')
            .and_then(|name| name.rsplit_once('['));
        if let Some((array, index)) = element
            && let Ok(index) = index.parse::<usize>()
            && let Some(member) = of(array)
            && let Some(length) = member.array_length
        {
            if index >= length as usize {
                return Err(UniformError::Index {
                    name: array.to_owned(),
                    length,
                    index,
                });
            }
            let offset = member.offset as usize + index * member.array_stride as usize;
            return Ok((member.clone(), offset));
        }
        let names = self.block.members.iter().map(|member| member.name.clone());
        Err(UniformError::NoUniform {
            name: name.to_owned(),
            there_are: names.collect(),
        })
    }
}

/// A value of a uniform: a scalar, vector or matrix.
pub trait UniformValue {
    /// Its type.
    fn value_type(&self) -> ValueType;
    /// Its words, column after column. A 64-bit integer is two: the low one, then the high one.
    fn words(&self) -> Vec<u32>;
}

/// The words of a number of a type.
fn words_of(ty: ValueType) -> usize {
    match ty.scalar() {
        ScalarType::I64 | ScalarType::U64 | ScalarType::F64 => 2,
        _ => 1,
    }
}

/// The words of a 64-bit integer.
fn halves(number: u64) -> [u32; 2] {
    [(number & 0xFFFF_FFFF) as u32, (number >> 32) as u32]
}

/// The type of the host's values: a truth value is a word, and a 16-bit float one of 32 bits.
fn of_host(ty: ValueType) -> ValueType {
    let scalar = match ty.scalar() {
        ScalarType::Bool => ScalarType::U32,
        ScalarType::F16 => ScalarType::F32,
        other => other,
    };
    match ty {
        ValueType::Scalar(_) => ValueType::Scalar(scalar),
        ValueType::Vector(_, rows) => ValueType::Vector(scalar, rows),
        ValueType::Matrix { columns, rows, .. } => ValueType::Matrix {
            scalar,
            columns,
            rows,
        },
    }
}

macro_rules! numbers {
    ($($number:ty, $scalar:ident, $bits:expr;)*) => {$(
        impl UniformValue for $number {
            fn value_type(&self) -> ValueType {
                ValueType::Scalar(ScalarType::$scalar)
            }

            fn words(&self) -> Vec<u32> {
                $bits(*self).to_vec()
            }
        }

        numbers!(@vectors $number, $scalar, $bits, 2 3 4);
    )*};
    (@vectors $number:ty, $scalar:ident, $bits:expr, $($rows:literal)*) => {$(
        impl UniformValue for [$number; $rows] {
            fn value_type(&self) -> ValueType {
                ValueType::Vector(ScalarType::$scalar, $rows)
            }

            fn words(&self) -> Vec<u32> {
                self.iter().copied().flat_map($bits).collect()
            }
        }
    )*};
}

numbers! {
    f32, F32, |number: f32| [number.to_bits()];
    i32, I32, |number: i32| [number.cast_unsigned()];
    u32, U32, |number: u32| [number];
    bool, Bool, |truth: bool| [u32::from(truth)];
    i64, I64, |number: i64| halves(number.cast_unsigned());
    u64, U64, halves;
}

macro_rules! matrices {
    ($($matrix:ty, $n:literal;)*) => {$(
        impl UniformValue for $matrix {
            fn value_type(&self) -> ValueType {
                ValueType::Matrix {
                    scalar: ScalarType::F32,
                    columns: $n,
                    rows: $n,
                }
            }

            fn words(&self) -> Vec<u32> {
                self.0.as_flattened().iter().map(|number| number.to_bits()).collect()
            }
        }

        impl UniformValue for [[f32; $n]; $n] {
            fn value_type(&self) -> ValueType {
                ValueType::Matrix {
                    scalar: ScalarType::F32,
                    columns: $n,
                    rows: $n,
                }
            }

            fn words(&self) -> Vec<u32> {
                self.as_flattened().iter().map(|number| number.to_bits()).collect()
            }
        }
    )*};
}

matrices! {
    Mat2, 2;
    Mat3, 3;
    Mat4, 4;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_of_64_bits_are_two_words() {
        let member = |name: &str, kind, offset, array_length| UniformMember {
            name: name.to_owned(),
            kind,
            array_length,
            array_stride: 16,
            matrix_stride: 0,
            offset,
            initial_value: None,
        };
        let block = UniformBlock {
            name: String::new(),
            slot: None,
            size: 48,
            members: vec![
                member("count", ValueType::Scalar(ScalarType::U64), 0, None),
                member("steps", ValueType::Vector(ScalarType::I64, 2), 16, Some(2)),
            ],
        };
        let mut uniforms = Uniforms::new(block, std::iter::empty());
        uniforms.set("count", 0x1_0000_0002_u64).expect("a number");
        uniforms.set("steps[1]", [-1_i64, 5]).expect("a vector");
        let numbers = uniforms.bytes().as_chunks::<8>().0;
        let numbers: Vec<_> = numbers.iter().copied().map(u64::from_le_bytes).collect();
        assert_eq!(numbers, [0x1_0000_0002, 0, 0, 0, u64::MAX, 5]);
        uniforms.set("count", 1_i64).expect_err("another type");
    }
}
