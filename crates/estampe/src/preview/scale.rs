//! Pictures with fewer pixels.

use estampe::srgb;
use estampe_scene::Image;

/// The size of a picture inside a frame, in its own proportions; it is not enlarged.
pub(super) fn fitted([width, height]: [u32; 2], [most_x, most_y]: [u32; 2]) -> [u32; 2] {
    let (w, h) = (u64::from(width.max(1)), u64::from(height.max(1)));
    let (x, y) = (u64::from(most_x.max(1)), u64::from(most_y.max(1)));
    if w <= x && h <= y {
        return [width.max(1), height.max(1)];
    }
    // The side that is tight, and the other one, rounded.
    let (fitted_x, fitted_y) = if w * y > h * x {
        (x, (h * x + w / 2) / w)
    } else {
        ((w * y + h / 2) / h, y)
    };
    [fitted_x, fitted_y].map(|side| u32::try_from(side).unwrap_or(u32::MAX).max(1))
}

/// The picture in a smaller size: means of the pixels, in linear light, by their alpha.
pub(super) fn reduced(image: &Image, [width, height]: [u32; 2]) -> Image {
    if [image.width, image.height] == [width, height] {
        return image.clone();
    }
    let range = |at: u32, to: u32, from: u32| {
        let edge = |at: u32| u64::from(at) * u64::from(from) / u64::from(to);
        let start = edge(at);
        let bound = |edge| u32::try_from(edge).unwrap_or(from);
        bound(start)..bound(edge(at + 1).max(start + 1))
    };
    let mut rgba = Vec::with_capacity(width as usize * height as usize * 4);
    for y in 0..height {
        for x in 0..width {
            let mut sum = [0.0_f32; 4];
            let mut count = 0.0_f32;
            for v in range(y, height, image.height) {
                for u in range(x, width, image.width) {
                    let texel = image.texel(u, v);
                    let alpha = f32::from(texel[3]) / 255.0;
                    for (sum, code) in sum.iter_mut().zip(&texel[..3]) {
                        *sum += srgb::decode(*code) * alpha;
                    }
                    sum[3] += alpha;
                    count += 1.0;
                }
            }
            let color = |sum_of: f32| {
                if sum[3] > 0.0 {
                    srgb::encode(sum_of / sum[3])
                } else {
                    0
                }
            };
            rgba.extend([
                color(sum[0]),
                color(sum[1]),
                color(sum[2]),
                alpha_code(sum[3] / count),
            ]);
        }
    }
    Image {
        width,
        height,
        rgba,
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to 0..=255"
)]
fn alpha_code(alpha: f32) -> u8 {
    (alpha * 255.0 + 0.5).clamp(0.0, 255.0) as u8
}

#[cfg(test)]
mod tests {
    use super::{fitted, reduced};
    use estampe_scene::Image;

    #[test]
    fn pictures_keep_their_proportions() {
        assert_eq!(fitted([1024, 768], [80, 44]), [59, 44]);
        assert_eq!(fitted([1000, 10], [80, 44]), [80, 1]);
        assert_eq!(fitted([20, 30], [80, 44]), [20, 30]);
        assert_eq!(fitted([1, 16_384], [80, 44]), [1, 44]);
    }

    #[test]
    fn means_are_of_linear_light_and_by_alpha() {
        let mut image = Image::filled(4, 1, [0, 0, 0, 255]);
        image.rgba[..4].copy_from_slice(&[255; 4]);
        // The third and the fourth pixel: red, and nothing.
        image.rgba[8..].copy_from_slice(&[255, 0, 0, 255, 9, 9, 9, 0]);
        let half = reduced(&image, [2, 1]);
        assert_eq!(half.texel(0, 0), [188, 188, 188, 255]);
        assert_eq!(half.texel(1, 0), [255, 0, 0, 128]);
        assert_eq!(reduced(&image, [4, 1]), image);
    }
}
