//! Writing of Radiance HDR.

use super::{BIAS, RUN_WIDTHS};
use crate::AssetError;
use estampe_scene::HdrImage;

/// The bytes of a Radiance HDR, whose rows are in runs by component where the format permits it (8
/// to 32767 pixels). Numbers keep 8 bits of the greatest one of their texel; negative ones and NaN
/// become 0, and the greatest is 255 · 2¹¹⁹.
///
/// # Errors
/// `Malformed` if there are no texels, or not three numbers for each.
pub fn encode_hdr(image: &HdrImage) -> Result<Vec<u8>, AssetError> {
    let (width, height) = (image.width, image.height);
    let expected = u128::from(width) * u128::from(height) * 3;
    if expected == 0 || expected != image.rgb.len() as u128 {
        return Err(AssetError::malformed(
            format!(
                "{image:?} comes with {} numbers instead of {expected}",
                image.rgb.len()
            ),
            "give both sides at least one pixel, and each pixel three numbers",
        ));
    }
    let header = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n");
    let mut bytes = header.into_bytes();
    let texels: Vec<[u8; 4]> = { image.rgb.as_chunks::<3>().0.iter() }
        .map(|&rgb| texel(rgb))
        .collect();
    if !RUN_WIDTHS.contains(&width) {
        bytes.extend(texels.as_flattened());
        return Ok(bytes);
    }
    let mut component = Vec::with_capacity(width as usize);
    for row in texels.chunks_exact(width as usize) {
        let [.., high, low] = width.to_be_bytes();
        bytes.extend([2, 2, high, low]);
        for at in 0..4 {
            component.clear();
            component.extend(row.iter().map(|texel| texel[at]));
            write_runs(&component, &mut bytes);
        }
    }
    Ok(bytes)
}

/// One component of a row: runs of one value as 128 + length and the value, other values after
/// their number.
fn write_runs(values: &[u8], bytes: &mut Vec<u8>) {
    /// Shorter runs save nothing among other values.
    const LEAST_RUN: usize = 4;
    const MOST_RUN: usize = 127;
    const MOST_VALUES: usize = 128;
    let code = |count: usize| u8::try_from(count).unwrap_or(u8::MAX);
    let mut rest = values;
    // The values before `rest` that are in no run.
    let mut plain: &[u8] = &[];
    let mut start = values;
    let flush = |plain: &[u8], bytes: &mut Vec<u8>| {
        for part in plain.chunks(MOST_VALUES) {
            bytes.push(code(part.len()));
            bytes.extend(part);
        }
    };
    while let Some(&value) = rest.first() {
        let same = rest.iter().take(MOST_RUN).take_while(|&&one| one == value);
        let length = same.count();
        if length < LEAST_RUN {
            rest = &rest[length..];
            plain = &start[..start.len() - rest.len()];
            continue;
        }
        flush(plain, bytes);
        bytes.extend([code(128 + length), value]);
        rest = &rest[length..];
        (start, plain) = (rest, &[]);
    }
    flush(plain, bytes);
}

/// The mantissas of a colour, and the exponent of the greatest.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "mantissas are in 0..=255, and exponents of f32 with the bias in 0..=255"
)]
fn texel(rgb: [f32; 3]) -> [u8; 4] {
    let rgb = rgb.map(|number| number.clamp(0.0, f32::MAX).max(0.0));
    let greatest = rgb.into_iter().fold(0.0, f32::max);
    // 2^−127 is the least with an exponent above 0.
    if greatest < libm::ldexpf(1.0, -127) {
        return [0; 4];
    }
    let (fraction, exponent) = libm::frexpf(greatest);
    // The greatest mantissa may round to 256.
    let carry = i32::from(libm::roundf(fraction * 256.0) > 255.0);
    let exponent = (exponent + carry).min(127);
    let scale = libm::ldexp(1.0, 8 - exponent);
    let mantissa = |number: f32| libm::round(f64::from(number) * scale).min(255.0) as u8;
    let [r, g, b] = rgb.map(mantissa);
    // A texel of three ones would repeat the one before.
    let b = if [r, g, b] == [1; 3] { 2 } else { b };
    [r, g, b, (exponent + BIAS - 8) as u8]
}
