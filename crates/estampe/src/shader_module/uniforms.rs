//! The bytes of a uniform block, set by name.

use super::{ScalarType, UniformBlock, UniformError, UniformMember, ValueType};
use estampe_types::{Mat2, Mat3, Mat4};

/// The bytes of a uniform block. They begin as zeros.
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
    pub(super) fn new(block: UniformBlock) -> Self {
        let bytes = vec![0; block.size as usize];
        Self { block, bytes }
    }

    /// The names, types and offsets.
    #[must_use]
    pub fn block(&self) -> &UniformBlock {
        &self.block
    }

    /// The bytes, for a uniform buffer.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Sets a uniform: `model`, `lights[2].color`, or an element of an array, `weights[3]`.
    ///
    /// # Errors
    /// [`UniformError`] if there is no such uniform, or it has another type.
    pub fn set(&mut self, name: &str, value: impl UniformValue) -> Result<(), UniformError> {
        let (member, offset) = self.find(name)?;
        let actual = value.value_type();
        if without_bool(actual) != without_bool(member.kind) {
            return Err(UniformError::Type {
                name: name.to_owned(),
                expected: member.kind.to_string(),
                actual: actual.to_string(),
            });
        }
        let rows = match member.kind {
            ValueType::Scalar(_) => 1,
            ValueType::Vector(_, rows) | ValueType::Matrix { rows, .. } => usize::from(rows),
        };
        let stride = member.matrix_stride as usize;
        for (column, words) in value.words().chunks(rows).enumerate() {
            let first = offset + column * stride;
            for (row, word) in words.iter().enumerate() {
                let at = first + row * 4;
                // A member lies in its block.
                if let Some(bytes) = self.bytes.get_mut(at..at + 4) {
                    bytes.copy_from_slice(&word.to_le_bytes());
                }
            }
        }
        Ok(())
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
    /// Its words, column after column.
    fn words(&self) -> Vec<u32>;
}

/// The type in a buffer, where a truth value is a word.
fn without_bool(ty: ValueType) -> ValueType {
    match ty {
        ValueType::Scalar(ScalarType::Bool) => ValueType::Scalar(ScalarType::U32),
        ValueType::Vector(ScalarType::Bool, size) => ValueType::Vector(ScalarType::U32, size),
        _ => ty,
    }
}

macro_rules! numbers {
    ($($number:ty, $scalar:ident, $bits:expr;)*) => {$(
        impl UniformValue for $number {
            fn value_type(&self) -> ValueType {
                ValueType::Scalar(ScalarType::$scalar)
            }

            fn words(&self) -> Vec<u32> {
                vec![$bits(*self)]
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
                self.iter().copied().map($bits).collect()
            }
        }
    )*};
}

numbers! {
    f32, F32, f32::to_bits;
    i32, I32, i32::cast_unsigned;
    u32, U32, u32::from;
    bool, Bool, u32::from;
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
