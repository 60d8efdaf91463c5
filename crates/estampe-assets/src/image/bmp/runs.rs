//! Run-length encoded indices: RLE8 and RLE4.
//!
//! ```text
//!   n v       n texels of the index v; of two indices in turn for 4 bits
//!   0 0       end of the row           0 2 x y   x texels to the right, y rows on
//!   0 1       end of the image         0 n …     n indices as they are, filled up to 16 bits
//! ```

use super::decode::color;
use super::header::Header;
use crate::AssetError;
use crate::image::fault::{allocate_texels, malformed};

/// The most texels for which a byte can stand, apart from those that are skipped: 255 texels in two
/// bytes. A file of fewer bytes than that is refused before memory is allocated for its texels.
const MAX_TEXELS_PER_BYTE: usize = 128;

/// The RGBA of all rows in the order of the file. Texels that are skipped have colour 0.
pub(super) fn decode(
    bytes: &[u8],
    header: &Header,
    bits: u8,
    palette: &[[u8; 4]],
) -> Result<Vec<u8>, AssetError> {
    let (width, height) = (header.width as usize, header.height as usize);
    if width * height / MAX_TEXELS_PER_BYTE > bytes.len() {
        let what = format!(
            "a run-length encoded BMP of {width} × {height} texels cannot have {} bytes",
            bytes.len()
        );
        return Err(malformed(0, what));
    }
    let background = color(palette, 0, header.texels_start)?;
    let mut rgba = allocate_texels(width * height)?;
    rgba.resize(width * height * 4, 0);
    let texels = rgba.as_chunks_mut::<4>().0;
    texels.fill(background);

    let mut codes = Codes {
        bytes,
        at: header.texels_start,
    };
    let (mut x, mut y) = (0, 0);
    while y < height {
        let start = codes.at;
        let [count, value] = codes.pair()?;
        match (count, value) {
            (0, 0) => (x, y) = (0, y + 1),
            (0, 1) => break,
            (0, 2) => {
                let [right, rows] = codes.pair()?;
                (x, y) = (x + usize::from(right), y + usize::from(rows));
            }
            (0, count) => {
                let indices = codes.literal(usize::from(count), bits)?;
                let row = &mut texels[y * width..][..width];
                for i in 0..usize::from(count) {
                    let index = nth(indices, i, bits);
                    put(row, x + i, color(palette, index, start)?);
                }
                x += usize::from(count);
            }
            (count, value) => {
                let row = &mut texels[y * width..][..width];
                for i in 0..usize::from(count) {
                    let index = nth(&[value; 255], i, bits);
                    put(row, x + i, color(palette, index, start)?);
                }
                x += usize::from(count);
            }
        }
    }
    Ok(rgba)
}

/// Stores a texel; those behind the end of the row are dropped, as every reader does.
fn put(row: &mut [[u8; 4]], x: usize, color: [u8; 4]) {
    if let Some(texel) = row.get_mut(x) {
        *texel = color;
    }
}

/// The index number `i` of packed ones.
fn nth(packed: &[u8], i: usize, bits: u8) -> u8 {
    match bits {
        4 if i.is_multiple_of(2) => packed[i / 2] >> 4,
        4 => packed[i / 2] & 15,
        _ => packed[i],
    }
}

/// The codes that are left.
struct Codes<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Codes<'a> {
    fn pair(&mut self) -> Result<[u8; 2], AssetError> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let pair = rest.first_chunk().ok_or_else(|| self.ends())?;
        self.at += 2;
        Ok(*pair)
    }

    /// The bytes of `count` indices, which end at a multiple of 16 bits.
    fn literal(&mut self, count: usize, bits: u8) -> Result<&'a [u8], AssetError> {
        let len = (count * usize::from(bits)).div_ceil(16) * 2;
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let literal = rest.get(..len).ok_or_else(|| self.ends())?;
        self.at += len;
        Ok(literal)
    }

    fn ends(&self) -> AssetError {
        malformed(
            self.bytes.len(),
            "the file ends within the runs of the BMP; an end-of-image code is missing",
        )
    }
}
