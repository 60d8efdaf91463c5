//! The heat map of perceived differences: black, purple, red, orange, pale yellow.
//!
//! The colour map is a path through CIE L*C*h. Lightness rises linearly with the value, so that
//! equal steps look equal, in greyscale prints too. The hue turns from violet over red to yellow.
//! Chroma is as large as sRGB allows, up to a limit that leaves both ends nearly grey.

use estampe_scene::Image;

use super::flip::FlipMap;

/// Lightness of the values 0 and 1.
const LIGHTNESS: [f64; 2] = [0.5, 97.0];
/// Hue of the values 0 and 1 in degrees: violet, and yellow a turn further.
const HUE_DEG: [f64; 2] = [285.0, 455.0];
/// Chroma at half lightness; it decreases to 0 at black and to [`PALE_CHROMA`] at the brightest.
const MAX_CHROMA: f64 = 82.0;
const PALE_CHROMA: f64 = 32.0;

/// Paints each pixel with the colour of its difference, 0 to 1.
pub(crate) fn paint(map: &FlipMap) -> Image {
    let colors: [[u8; 4]; 256] = std::array::from_fn(|i| color(i as f64 / 255.0));
    let rgba = map
        .values
        .iter()
        .flat_map(|&value| colors[index_of(value)])
        .collect();
    Image {
        width: map.width,
        height: map.height,
        rgba,
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "clamped to 0..=255; NaN becomes 0"
)]
fn index_of(value: f32) -> usize {
    (value * 255.0 + 0.5).clamp(0.0, 255.0) as usize
}

/// The colour of `value` in [0, 1].
fn color(value: f64) -> [u8; 4] {
    let lightness = LIGHTNESS[0] + (LIGHTNESS[1] - LIGHTNESS[0]) * value;
    let hue = (HUE_DEG[0] + (HUE_DEG[1] - HUE_DEG[0]) * value).to_radians();
    let wanted = MAX_CHROMA * (1.0 - (2.0 * value - 1.0) * (2.0 * value - 1.0))
        + PALE_CHROMA * value * value;

    // Find the largest chroma in sRGB's gamut, up to the wanted one.
    let (mut held, mut beyond) = (0.0, wanted);
    for _ in 0..20 {
        let chroma = 0.5 * (held + beyond);
        if linear_rgb(lightness, chroma, hue)
            .iter()
            .all(|v| (0.0..=1.0).contains(v))
        {
            held = chroma;
        } else {
            beyond = chroma;
        }
    }
    let [red, green, blue] = linear_rgb(lightness, held, hue).map(unorm8_srgb_from_linear);
    [red, green, blue, 255]
}

/// CIE L*C*h (hue in radians) to linear sRGB, under D65 (CIE 15; IEC 61966-2-1).
fn linear_rgb(lightness: f64, chroma: f64, hue: f64) -> [f64; 3] {
    let fy = (lightness + 16.0) / 116.0;
    let fx = fy + chroma * libm::cos(hue) / 500.0;
    let fz = fy - chroma * libm::sin(hue) / 200.0;
    let [x, y, z] = [fx, fy, fz].map(|f| {
        const DELTA: f64 = 6.0 / 29.0;
        if f > DELTA {
            f * f * f
        } else {
            3.0 * DELTA * DELTA * (f - 4.0 / 29.0)
        }
    });
    let (x, z) = (x * 0.950_456, z * 1.089_058);
    [
        3.240_970 * x - 1.537_383 * y - 0.498_611 * z,
        -0.969_244 * x + 1.875_968 * y + 0.041_555 * z,
        0.055_630 * x - 0.203_977 * y + 1.056_972 * z,
    ]
}

#[expect(clippy::cast_possible_truncation, reason = "clamped to 0..=255")]
fn unorm8_srgb_from_linear(value: f64) -> u8 {
    let encoded = if value <= 0.003_130_8 {
        12.92 * value
    } else {
        1.055 * libm::pow(value, 1.0 / 2.4) - 0.055
    };
    (encoded * 255.0 + 0.5).clamp(0.0, 255.0) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn luminance(color: [u8; 4]) -> f64 {
        let linear = |v: u8| libm::pow((f64::from(v) / 255.0 + 0.055) / 1.055, 2.4);
        0.2126 * linear(color[0]) + 0.7152 * linear(color[1]) + 0.0722 * linear(color[2])
    }

    #[test]
    fn brighter_means_more_different() {
        let colors: Vec<_> = (0..=64).map(|i| color(f64::from(i) / 64.0)).collect();
        for pair in colors.windows(2) {
            assert!(luminance(pair[0]) < luminance(pair[1]), "{pair:?}");
        }
        assert!(colors[0].iter().take(3).all(|&v| v < 12), "{:?}", colors[0]);
        assert!(
            colors[64][0] > 240 && colors[64][1] > 240,
            "{:?}",
            colors[64]
        );
    }

    #[test]
    fn the_middle_is_red_and_the_quarter_violet() {
        let [red, green, blue, _] = color(0.5);
        assert!(red > 180 && green < 110 && blue < red, "{:?}", color(0.5));
        let [red, green, blue, _] = color(0.22);
        assert!(blue > green && red > green, "{:?}", color(0.22));
    }

    #[test]
    fn values_outside_the_scale_take_its_ends() {
        let map = FlipMap {
            width: 4,
            height: 1,
            values: vec![-1.0, f32::NAN, 1.0, 7.0],
        };
        let image = paint(&map);
        assert_eq!(image.texel(0, 0), color(0.0));
        assert_eq!(image.texel(1, 0), color(0.0));
        assert_eq!(image.texel(2, 0), color(1.0));
        assert_eq!(image.texel(3, 0), color(1.0));
    }
}
