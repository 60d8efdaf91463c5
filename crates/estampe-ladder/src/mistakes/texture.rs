//! Mistakes of texturing.

use crate::{Color, Course, LadderError, Picture};

/// A texture of five texels; what a read of a sixth finds is red.
const TEXELS: [Color; 5] = [
    [40, 60, 110],
    [70, 110, 150],
    [110, 160, 170],
    [170, 200, 180],
    [235, 235, 200],
];

/// u from 0 to 1 over 320 pixels. Above, with round(u·W), the first texel has half its width, and
/// the end of the range reads texel W, which does not exist; below, with ⌊u·W⌋, all are equally
/// wide.
pub(super) fn texel(_: &Course) -> Result<Picture, LadderError> {
    const WIDTH: u16 = 320;
    let row = |texel: &dyn Fn(f32) -> f32| {
        let mut picture = Picture::new(u32::from(WIDTH), 60);
        for x in 0..WIDTH {
            let u = (f32::from(x) + 0.5) / f32::from(WIDTH);
            #[expect(clippy::cast_possible_truncation, reason = "0 to 5")]
            #[expect(clippy::cast_sign_loss, reason = "0 to 5")]
            let texel = texel(u * TEXELS.len() as f32) as usize;
            let color = TEXELS.get(texel).copied().unwrap_or(Picture::RED);
            picture.line([i32::from(x), 0], [i32::from(x), 59], color);
        }
        picture
    };
    Ok(Picture::in_columns(
        1,
        &[row(&f32::round), row(&f32::floor)],
    ))
}
