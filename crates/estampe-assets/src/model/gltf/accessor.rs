//! Accessors: typed elements in buffer views, checked and copied in bulk.
//!
//! ```text
//! buffer     [ ................................................ ]
//! view             [ ......................... ]
//! accessor            | element | … | element | …               stride between their first bytes
//! sparse     replaces some elements by those of another view
//! ```
//!
//! Source: glTF 2.0 specification, §3.6.

use super::buffers::Views;
use super::document::{Document, Index, Sparse};
use super::fault::{element, malformed};
use crate::{AssetError, Limits};
use std::ops::Range;

/// Type of a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    pub(super) fn of(code: Index) -> Option<Self> {
        Some(match code.0 {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    /// Bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }
}

/// The accessors of a file.
pub(super) struct Accessors<'a> {
    document: &'a Document<'a>,
    views: &'a Views<'a>,
    /// Elements that an accessor without bytes may have.
    max_zeros: usize,
}

/// An accessor whose bytes are there.
#[derive(Debug)]
pub(super) struct Elements<'a> {
    pub(super) count: usize,
    /// Components per element.
    pub(super) width: usize,
    pub(super) component: Component,
    index: Index,
    is_normalized: bool,
    array: Array<'a>,
    sparse: Option<Replacements<'a>>,
}

/// Bytes of elements.
#[derive(Debug, Clone, Copy)]
struct Array<'a> {
    /// From the first byte of the first element to the end of the last one; empty for zeros.
    bytes: &'a [u8],
    stride: usize,
}

/// Elements that replace others.
#[derive(Debug)]
struct Replacements<'a> {
    count: usize,
    component: Component,
    indices: Array<'a>,
    values: Array<'a>,
    pointer: String,
}

impl<'a> Accessors<'a> {
    pub(super) fn new(document: &'a Document<'a>, views: &'a Views<'a>, limits: &Limits) -> Self {
        Self {
            document,
            views,
            max_zeros: usize::try_from(limits.max_vertices).unwrap_or(usize::MAX),
        }
    }

    /// The number of elements, as stated. `pointer` is the place of the index.
    pub(super) fn count(
        &self,
        index: Index,
        pointer: impl FnOnce() -> String,
    ) -> Result<usize, AssetError> {
        let accessor = element(&self.document.accessors, index, "accessor", pointer)?;
        Ok(accessor.count.0)
    }

    /// Checks an accessor. `pointer` is the place of the index.
    pub(super) fn get(
        &self,
        index: Index,
        pointer: impl FnOnce() -> String,
    ) -> Result<Elements<'a>, AssetError> {
        let accessor = element(&self.document.accessors, index, "accessor", pointer)?;
        let place = |property: &str| format!("/accessors/{index}{property}");
        let component = component(accessor.component_type, || place("/componentType"))?;
        let width = match &*accessor.kind {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            "MAT4" => 16,
            other => {
                let what = format!("the type `{other}` is not one that is read here");
                return Err(malformed(place("/type"), what));
            }
        };
        let count = accessor.count.0;
        let size = width * component.size();
        let array = if let Some(view) = accessor.buffer_view {
            let bytes = self.views.bytes(view, || place("/bufferView"))?;
            let stride = self.views.stride(view).unwrap_or(size);
            if stride < size {
                let what = format!("elements of {size} bytes overlap, the stride is {stride}");
                return Err(malformed(format!("/bufferViews/{view}/byteStride"), what));
            }
            Array::new(bytes, accessor.byte_offset, [count, stride, size])
                .map_err(|what| malformed(place(""), what))?
        } else {
            if count > self.max_zeros {
                let limit = self.max_zeros as u64;
                return Limits::check("elements", count as u64, limit)
                    .map_err(|error| error.at_json(place("/count")))
                    .map(|()| unreachable!("the count is over the limit"));
            }
            Array {
                bytes: &[],
                stride: size,
            }
        };
        let sparse = accessor.sparse.as_deref();
        let sparse = sparse.map(|sparse| self.replacements(sparse, index, [count, size]));
        Ok(Elements {
            count,
            width,
            component,
            index,
            is_normalized: accessor.normalized,
            array,
            sparse: sparse.transpose()?,
        })
    }

    fn replacements(
        &self,
        sparse: &Sparse,
        index: Index,
        [of_count, size]: [usize; 2],
    ) -> Result<Replacements<'a>, AssetError> {
        let pointer = format!("/accessors/{index}/sparse");
        let place = |property: &str| format!("{pointer}{property}");
        let count = sparse.count.0;
        if count > of_count {
            let what = format!("{count} elements replace some of {of_count}");
            return Err(malformed(place("/count"), what));
        }
        let indices = &sparse.indices;
        let component = component(indices.component_type, || place("/indices/componentType"))?;
        let bytes = self
            .views
            .bytes(indices.buffer_view, || place("/indices/bufferView"))?;
        let layout = [count, component.size(), component.size()];
        let indices = Array::new(bytes, indices.byte_offset, layout)
            .map_err(|what| malformed(place("/indices"), what))?;
        let values = &sparse.values;
        let bytes = self
            .views
            .bytes(values.buffer_view, || place("/values/bufferView"))?;
        let values = Array::new(bytes, values.byte_offset, [count, size, size])
            .map_err(|what| malformed(place("/values"), what))?;
        Ok(Replacements {
            count,
            component,
            indices,
            values,
            pointer,
        })
    }
}

fn component(code: Index, pointer: impl FnOnce() -> String) -> Result<Component, AssetError> {
    Component::of(code)
        .ok_or_else(|| malformed(pointer(), format!("{code} is not the type of a component")))
}

impl<'a> Array<'a> {
    /// `count` elements of `size` bytes every `stride` bytes from `offset`.
    fn new(
        bytes: &'a [u8],
        offset: Index,
        [count, stride, size]: [usize; 3],
    ) -> Result<Self, String> {
        if count == 0 {
            return Ok(Array { bytes: &[], stride });
        }
        let length = stride
            .checked_mul(count - 1)
            .and_then(|before| before.checked_add(size));
        let range = length.and_then(|length| {
            let end = offset.0.checked_add(length)?;
            bytes.get(offset.0..end)
        });
        range.map(|bytes| Array { bytes, stride }).ok_or_else(|| {
            format!(
                "{count} elements of {size} bytes every {stride} from byte {offset} do not fit into the \
                 {} bytes of the buffer view",
                bytes.len()
            )
        })
    }
}

impl Elements<'_> {
    /// The accessor's place.
    pub(super) fn pointer(&self) -> String {
        format!("/accessors/{}", self.index)
    }

    /// Number of elements that others replace. They are read whichever range is asked for.
    pub(super) fn replaced_count(&self) -> usize {
        self.sparse.as_ref().map_or(0, |sparse| sparse.count)
    }

    /// All elements as floating-point numbers; integers that are normalized as −1..1 or 0..1.
    pub(super) fn floats<const N: usize>(&self) -> Result<Vec<[f32; N]>, AssetError> {
        self.floats_in(0..self.count)
    }

    /// The elements of a range, which must be within the count.
    pub(super) fn floats_in<const N: usize>(
        &self,
        range: Range<usize>,
    ) -> Result<Vec<[f32; N]>, AssetError> {
        self.check_width(N)?;
        let convert = |array: Array<'_>, range: Range<usize>| -> Vec<[f32; N]> {
            match (self.component, self.is_normalized) {
                (Component::F32, _) => array.convert(range, f32::from_le_bytes),
                (Component::U8, false) => array.convert(range, |[byte]| f32::from(byte)),
                (Component::U8, true) => array.convert(range, |[byte]| f32::from(byte) / 255.0),
                (Component::I8, false) => {
                    array.convert(range, |byte| f32::from(i8::from_le_bytes(byte)))
                }
                (Component::I8, true) => array.convert(range, |byte| {
                    (f32::from(i8::from_le_bytes(byte)) / 127.0).max(-1.0)
                }),
                (Component::U16, false) => {
                    array.convert(range, |bytes| f32::from(u16::from_le_bytes(bytes)))
                }
                (Component::U16, true) => array.convert(range, |bytes| {
                    f32::from(u16::from_le_bytes(bytes)) / 65535.0
                }),
                (Component::I16, false) => {
                    array.convert(range, |bytes| f32::from(i16::from_le_bytes(bytes)))
                }
                (Component::I16, true) => array.convert(range, |bytes| {
                    (f32::from(i16::from_le_bytes(bytes)) / 32767.0).max(-1.0)
                }),
                // f64 keeps all bits of the integer until it is divided.
                (Component::U32, is_normalized) => {
                    let scale = if is_normalized { 4_294_967_295.0 } else { 1.0 };
                    array.convert(range, |bytes| narrow(u32::from_le_bytes(bytes), scale))
                }
            }
        };
        self.read(range, [0.0; N], convert)
    }

    /// All elements as integers.
    pub(super) fn integers<const N: usize>(&self) -> Result<Vec<[u32; N]>, AssetError> {
        self.check_width(N)?;
        if !matches!(
            self.component,
            Component::U8 | Component::U16 | Component::U32
        ) {
            return Err(malformed(
                format!("{}/componentType", self.pointer()),
                "unsigned integers are needed here",
            ));
        }
        let convert = |array: Array<'_>, range| array.unsigned(range, self.component);
        self.read(0..self.count, [0; N], convert)
    }

    fn check_width(&self, width: usize) -> Result<(), AssetError> {
        if self.width == width {
            return Ok(());
        }
        let kind = match width {
            1 => "SCALAR",
            2 => "VEC2",
            3 => "VEC3",
            4 => "VEC4",
            _ => "MAT4",
        };
        let what = format!("the type must be {kind} for this use");
        Err(malformed(format!("{}/type", self.pointer()), what))
    }

    /// The elements of a range, with those that are replaced.
    fn read<T: Copy, const N: usize>(
        &self,
        range: Range<usize>,
        zero: [T; N],
        convert: impl Fn(Array<'_>, Range<usize>) -> Vec<[T; N]>,
    ) -> Result<Vec<[T; N]>, AssetError> {
        let mut elements = if self.array.bytes.is_empty() {
            vec![zero; range.len()]
        } else {
            convert(self.array, range.clone())
        };
        let Some(sparse) = &self.sparse else {
            return Ok(elements);
        };
        let indices: Vec<[u32; 1]> = sparse.indices.unsigned(0..sparse.count, sparse.component);
        let values = convert(sparse.values, 0..sparse.count);
        let mut next = 0;
        for (at, ([index], value)) in indices.into_iter().zip(values).enumerate() {
            let index = index as usize;
            if index < next || index >= self.count {
                return Err(malformed(
                    format!("{}/indices", sparse.pointer),
                    format!(
                        "index {index} at {at} is not between the one before it and the accessor's count \
                         of {}",
                        self.count
                    ),
                ));
            }
            next = index + 1;
            if range.contains(&index) {
                elements[index - range.start] = value;
            }
        }
        Ok(elements)
    }
}

impl Array<'_> {
    fn unsigned<const N: usize>(self, range: Range<usize>, component: Component) -> Vec<[u32; N]> {
        match component {
            Component::U8 | Component::I8 => self.convert(range, |[byte]| u32::from(byte)),
            Component::U16 | Component::I16 => {
                self.convert(range, |bytes| u32::from(u16::from_le_bytes(bytes)))
            }
            Component::U32 | Component::F32 => self.convert(range, u32::from_le_bytes),
        }
    }

    /// Copies the elements of a range. Compiled for each type of a component.
    fn convert<T: Copy, const N: usize, const SIZE: usize>(
        self,
        range: Range<usize>,
        number: impl Fn([u8; SIZE]) -> T,
    ) -> Vec<[T; N]> {
        let start = (self.stride * range.start).min(self.bytes.len());
        let elements = self.bytes[start..].chunks(self.stride.max(1));
        elements
            .take(range.len())
            .map(|element| {
                let (components, _) = element.as_chunks::<SIZE>();
                std::array::from_fn(|i| number(components[i]))
            })
            .collect()
    }
}

fn narrow(value: u32, scale: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "the nearest f32 is wanted")]
    {
        (f64::from(value) / scale) as f32
    }
}
