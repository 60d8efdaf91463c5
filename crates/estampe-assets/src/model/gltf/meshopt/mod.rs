//! EXT_meshopt_compression: compressed buffer views.
//!
//! ```text
//! ATTRIBUTES  attributes: deltas of bytes  -> filter: octahedral, quaternion, exponential
//! TRIANGLES   triangles: recent edges and vertices
//! INDICES     indices: deltas
//! ```
//!
//! Memory is allocated only after a check that so many elements can be in so many bytes.
//!
//! Source: Khronos Group, "EXT_meshopt_compression", appendices A and B.

mod attributes;
mod filter;
mod indices;
mod triangles;

use super::buffers::Buffers;
use super::document::MeshoptView;
use super::fault::malformed;
use crate::AssetError;
use filter::Filter;

/// How the elements of a view are compressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mode {
    Attributes(Filter),
    Triangles,
    Indices,
}

/// A compressed view.
pub(super) struct Compressed<'a> {
    bytes: &'a [u8],
    mode: Mode,
    count: usize,
    /// Bytes of an element.
    stride: usize,
}

impl<'a> Compressed<'a> {
    /// Finds the compressed bytes. `pointer` is the place of the extension, `length` that of the
    /// buffer view.
    pub(super) fn new(
        view: &MeshoptView,
        length: usize,
        buffers: &'a Buffers<'_>,
        pointer: &str,
    ) -> Result<Self, AssetError> {
        let (count, stride) = (view.count.0, view.byte_stride.0);
        let filter_name = view.filter.as_deref();
        let filter = Filter::of_name(filter_name.unwrap_or("NONE")).ok_or_else(|| {
            let what = format!("`{}` is not a filter", filter_name.unwrap_or_default());
            malformed(format!("{pointer}/filter"), what)
        })?;
        let (mode, is_stride_valid) = match (&*view.mode, filter) {
            ("ATTRIBUTES", filter) => (Mode::Attributes(filter), filter.accepts(stride)),
            ("TRIANGLES", Filter::None) => (Mode::Triangles, matches!(stride, 2 | 4)),
            ("INDICES", Filter::None) => (Mode::Indices, matches!(stride, 2 | 4)),
            (mode, filter) => {
                let what = format!("the mode `{mode}` with the filter {filter:?} is not defined");
                return Err(malformed(format!("{pointer}/mode"), what));
            }
        };
        if !is_stride_valid {
            let what = format!("elements of {stride} bytes do not fit the mode and the filter");
            return Err(malformed(format!("{pointer}/byteStride"), what));
        }
        if mode == Mode::Triangles && count % 3 != 0 {
            let what = format!("{count} is not a multiple of 3, which triangles need");
            return Err(malformed(format!("{pointer}/count"), what));
        }
        if count.checked_mul(stride) != Some(length) {
            let what = format!(
                "{count} elements of {stride} bytes are not the {length} bytes of the buffer view"
            );
            return Err(malformed(format!("{pointer}/count"), what));
        }
        let bytes = buffers.range(view.buffer, view.byte_offset, view.byte_length, pointer)?;
        Ok(Self {
            bytes,
            mode,
            count,
            stride,
        })
    }

    /// Number of bytes after decoding.
    pub(super) fn decoded_length(&self) -> u64 {
        self.count as u64 * self.stride as u64
    }

    /// The decoded bytes.
    pub(super) fn decode(&self) -> Result<Vec<u8>, AssetError> {
        let decoded = match self.mode {
            Mode::Attributes(filter) => {
                let decoded = attributes::decode(self.bytes, self.count, self.stride);
                decoded.map(|mut bytes| {
                    filter.apply(&mut bytes, self.stride);
                    bytes
                })
            }
            Mode::Triangles => triangles::decode(self.bytes, self.count / 3)
                .map(|indices| stored(&indices, self.stride)),
            Mode::Indices => {
                indices::decode(self.bytes, self.count).map(|indices| stored(&indices, self.stride))
            }
        };
        decoded.map_err(|Damage(what)| {
            AssetError::malformed(
                format!("the compressed data is damaged: {what}"),
                "export the file again",
            )
        })
    }
}

/// What is wrong with compressed data.
#[derive(Debug, PartialEq, Eq)]
struct Damage(&'static str);

const TOO_SHORT: Damage = Damage("it ends too early");
const TOO_LONG: Damage = Damage("bytes are left at its end");
const WRONG_HEADER: Damage = Damage("its first byte is not that of the mode");

/// Indices as 16 or 32 bits.
fn stored(indices: &[u32], stride: usize) -> Vec<u8> {
    let low = |index: &u32| {
        let [a, b, ..] = index.to_le_bytes();
        [a, b]
    };
    match stride {
        2 => indices.iter().flat_map(low).collect(),
        _ => indices
            .iter()
            .flat_map(|index| index.to_le_bytes())
            .collect(),
    }
}

/// The next byte.
fn next_byte(data: &mut &[u8]) -> Result<u8, Damage> {
    let (&byte, rest) = data.split_first().ok_or(TOO_SHORT)?;
    *data = rest;
    Ok(byte)
}

/// A number of 7 bits per byte, the lowest first (LEB128). Bits beyond 32 are lost.
fn next_varint(data: &mut &[u8]) -> Result<u32, Damage> {
    let mut value = 0;
    for shift in [0, 7, 14, 21, 28] {
        let byte = next_byte(data)?;
        value |= u32::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            return Ok(value);
        }
    }
    Err(Damage("a number has more than five bytes"))
}

/// A signed difference from its zigzag code: 0, −1, 1, −2, 2, … in two's complement.
fn unzigzag(code: u32) -> u32 {
    (code >> 1) ^ (code & 1).wrapping_neg()
}

#[cfg(test)]
mod tests {
    use super::{next_varint, unzigzag};

    #[test]
    fn numbers_are_decoded_as_the_specification_shows() {
        for (bytes, number) in [
            (&[0x7f][..], 0x7f),
            (&[0x81, 0x04], 0x201),
            // The specification prints 0x1fd005, which is the order of bytes turned round.
            (&[0xff, 0xa0, 0x05], 0x1_507f),
        ] {
            assert_eq!(next_varint(&mut &bytes[..]), Ok(number));
        }
        assert!(next_varint(&mut &[0x80][..]).is_err());
        assert!(next_varint(&mut &[0x80; 9][..]).is_err());
        let signed = [0, 1, 2, 3, u32::MAX].map(|code| unzigzag(code).cast_signed());
        assert_eq!(signed, [0, -1, 1, -2, i32::MIN]);
    }
}
