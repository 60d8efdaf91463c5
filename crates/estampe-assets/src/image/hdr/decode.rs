//! The rows of a Radiance HDR.

use super::header::Header;
use super::{BIAS, RUN_WIDTHS};
use crate::image::fault::malformed;
use crate::{AssetError, Limits};
use estampe_scene::HdrImage;

/// Reads a Radiance HDR; colours are divided by the exposure of the header.
///
/// # Errors
/// `Malformed` with a byte offset if the file is cut off or contradicts itself, `Unsupported` for
/// XYZ colours and turned images, `LimitExceeded` before any texel is stored.
pub fn decode_hdr(bytes: &[u8], limits: &Limits) -> Result<HdrImage, AssetError> {
    let header = Header::parse(bytes, limits)?;
    let (width, height) = (header.width as usize, header.height as usize);
    // A row has at least 4 bytes, and one in runs 4 for each 127 texels of a component.
    let left = bytes.len() - header.end;
    let fewest = width.div_ceil(127).saturating_mul(height).saturating_mul(2);
    if left < fewest.min(height.saturating_mul(4)) {
        return Err(malformed(bytes.len(), "the file ends before its rows"));
    }
    let mut rgb = Vec::new();
    let numbers = width
        .checked_mul(height)
        .and_then(|texels| texels.checked_mul(3));
    if numbers.is_none_or(|numbers| rgb.try_reserve_exact(numbers).is_err()) {
        return Err(AssetError::limit_exceeded(
            format!("not enough memory for an image of {width}x{height} pixels"),
            "use a smaller image",
        ));
    }
    let mut rows = Rows {
        bytes,
        at: header.end,
        width,
    };
    let mut row = vec![[0_u8; 4]; width];
    for _ in 0..height {
        rows.next(&mut row)?;
        if header.is_mirrored {
            row.reverse();
        }
        rgb.extend(row.iter().flat_map(|&texel| linear(texel, header.exposure)));
    }
    if header.is_upside_down {
        let upright: Vec<f32> = rgb.chunks(width * 3).rev().flatten().copied().collect();
        rgb = upright;
    }
    Ok(HdrImage {
        width: header.width,
        height: header.height,
        rgb,
    })
}

/// The colour of a texel.
fn linear([r, g, b, exponent]: [u8; 4], exposure: f32) -> [f32; 3] {
    if exponent == 0 {
        return [0.0; 3];
    }
    let scale = libm::ldexpf(1.0, i32::from(exponent) - BIAS) / exposure;
    [r, g, b].map(|mantissa| (f32::from(mantissa) * scale).min(f32::MAX))
}

/// The rows that are left.
struct Rows<'a> {
    bytes: &'a [u8],
    at: usize,
    width: usize,
}

impl Rows<'_> {
    fn next(&mut self, row: &mut [[u8; 4]]) -> Result<(), AssetError> {
        let start = self.bytes.get(self.at..self.at + 4);
        let width = u32::try_from(self.width).unwrap_or(u32::MAX);
        if let Some(&[2, 2, high, low]) = start
            && RUN_WIDTHS.contains(&width)
            && high < 128
        {
            if u32::from(u16::from_be_bytes([high, low])) != width {
                return Err(malformed(self.at, format!("a row has not {width} texels")));
            }
            self.at += 4;
            for component in 0..4 {
                self.component(row, component)?;
            }
            return Ok(());
        }
        self.texels(row)
    }

    fn byte(&mut self) -> Result<u8, AssetError> {
        let Some(&byte) = self.bytes.get(self.at) else {
            return Err(malformed(self.at, "the file ends within a row"));
        };
        self.at += 1;
        Ok(byte)
    }

    /// One component of a row: runs of one value (more than 128), or values (up to 128).
    fn component(&mut self, row: &mut [[u8; 4]], component: usize) -> Result<(), AssetError> {
        let mut x = 0;
        while x < row.len() {
            let start = self.at;
            let code = usize::from(self.byte()?);
            let (count, is_run) = if code > 128 {
                (code - 128, true)
            } else {
                (code, false)
            };
            if count == 0 || count > row.len() - x {
                return Err(malformed(start, "a run does not fit its row"));
            }
            let mut value = 0;
            for (index, texel) in row[x..x + count].iter_mut().enumerate() {
                if index == 0 || !is_run {
                    value = self.byte()?;
                }
                texel[component] = value;
            }
            x += count;
        }
        Ok(())
    }

    /// Texels one by one; 1 1 1 n repeats the last one n times, and further ones that follow count
    /// 256 times as much each.
    fn texels(&mut self, row: &mut [[u8; 4]]) -> Result<(), AssetError> {
        let (mut x, mut shift) = (0, 0_u32);
        while x < row.len() {
            let start = self.at;
            let mut texel = [0; 4];
            for value in &mut texel {
                *value = self.byte()?;
            }
            let [1, 1, 1, count] = texel else {
                row[x] = texel;
                (x, shift) = (x + 1, 0);
                continue;
            };
            let count = usize::from(count).checked_shl(shift).unwrap_or(usize::MAX);
            if x == 0 || count == 0 || count > row.len() - x {
                return Err(malformed(start, "a repeated texel does not fit its row"));
            }
            let last = row[x - 1];
            row[x..x + count].fill(last);
            (x, shift) = (x + count, shift + 8);
        }
        Ok(())
    }
}
