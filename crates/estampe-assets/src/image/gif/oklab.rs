//! Oklab: a space in which distances are about perceived differences (Ottosson 2020).

use std::sync::LazyLock;

/// L, a and b.
pub(super) type Oklab = [f64; 3];

/// The linear values of the sRGB codes.
static LINEAR: LazyLock<[f64; 256]> = LazyLock::new(|| {
    std::array::from_fn(|code| {
        let value = code as f64 / 255.0;
        if value <= 0.04045 {
            value / 12.92
        } else {
            libm::pow((value + 0.055) / 1.055, 2.4)
        }
    })
});

/// The colour of sRGB codes.
pub(super) fn from_srgb(codes: [u8; 3]) -> Oklab {
    let [r, g, b] = codes.map(|code| LINEAR[usize::from(code)]);
    let l = libm::cbrt(0.412_221_470_8 * r + 0.536_332_536_3 * g + 0.051_445_992_9 * b);
    let m = libm::cbrt(0.211_903_498_2 * r + 0.680_699_545_1 * g + 0.107_396_956_6 * b);
    let s = libm::cbrt(0.088_302_461_9 * r + 0.281_718_837_6 * g + 0.629_978_700_5 * b);
    [
        0.210_454_255_3 * l + 0.793_617_785 * m - 0.004_072_046_8 * s,
        1.977_998_495_1 * l - 2.428_592_205 * m + 0.450_593_709_9 * s,
        0.025_904_037_1 * l + 0.782_771_766_2 * m - 0.808_675_766 * s,
    ]
}

/// The nearest sRGB codes, of a colour that may be a little outside.
pub(super) fn to_srgb([l, a, b]: Oklab) -> [u8; 3] {
    let cube = |value: f64| value * value * value;
    let long = cube(l + 0.396_337_777_4 * a + 0.215_803_757_3 * b);
    let middle = cube(l - 0.105_561_345_8 * a - 0.063_854_172_8 * b);
    let short = cube(l - 0.089_484_177_5 * a - 1.291_485_548 * b);
    [
        4.076_741_662_1 * long - 3.307_711_591_3 * middle + 0.230_969_929_2 * short,
        -1.268_438_004_6 * long + 2.609_757_401_1 * middle - 0.341_319_396_5 * short,
        -0.004_196_086_3 * long - 0.703_418_614_7 * middle + 1.707_614_701 * short,
    ]
    .map(code)
}

/// The sRGB code whose linear value is nearest.
fn code(linear: f64) -> u8 {
    let above = LINEAR.partition_point(|&value| value < linear);
    let nearest = match above {
        0 => 0,
        256 => 255,
        _ if linear - LINEAR[above - 1] < LINEAR[above] - linear => above - 1,
        _ => above,
    };
    u8::try_from(nearest).unwrap_or(u8::MAX)
}

/// The square of the distance.
pub(super) fn distance(a: Oklab, b: Oklab) -> f64 {
    let d = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_colours() {
        // From the table of the article: white is (1, 0, 0), and red (0.628, 0.2249, 0.1258).
        let white = from_srgb([255; 3]);
        assert!((white[0] - 1.0).abs() < 1e-4 && white[1].abs() < 1e-4 && white[2].abs() < 1e-4);
        let red = from_srgb([255, 0, 0]);
        for (value, expected) in red.into_iter().zip([0.627_96, 0.224_86, 0.125_85]) {
            assert!((value - expected).abs() < 1e-4, "{red:?}");
        }
    }

    #[test]
    fn codes_come_back() {
        for r in (0..=255).step_by(15) {
            for g in (0..=255).step_by(15) {
                for b in (0..=255).step_by(15) {
                    assert_eq!(to_srgb(from_srgb([r, g, b])), [r, g, b]);
                }
            }
        }
        assert_eq!(to_srgb([2.0, 0.0, 0.0]), [255; 3]);
        assert_eq!(to_srgb([-1.0, 0.0, 0.0]), [0; 3]);
    }
}
