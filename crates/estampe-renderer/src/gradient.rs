//! Gradients behind a model.

use crate::alpha::{Encoding, decode, encode, straighten};

/// A gradient of up to eight colours at equal distances.
///
/// Colours are mixed in Oklab (Ottosson 2020), multiplied by their alpha, so that mixtures look as
/// bright as their neighbours and nothing dark is between a colour and transparency. Pictures of
/// numbers mix the sRGB codes. There is no dithering: colours of neighbouring pixels differ by at
/// most one code more than the gradient itself, and files stay small.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gradient {
    /// Where the colours are.
    shape: GradientShape,
    /// sRGB and alpha; the first `count` are used.
    colors: [[u8; 4]; Self::MOST_COLORS],
    count: usize,
}

/// Where the colours of a gradient are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum GradientShape {
    /// From the upper edge of the picture to the lower one.
    Linear,
    /// From the middle of the picture to its corners, in circles.
    Radial,
}

impl Gradient {
    /// The most colours.
    pub const MOST_COLORS: usize = 8;

    /// A gradient of sRGB colours with straight alpha; one colour is everywhere. `None` of no
    /// colour, and of more than [`Self::MOST_COLORS`].
    #[must_use]
    pub fn new(shape: GradientShape, colors: &[[u8; 4]]) -> Option<Self> {
        let mut all = [[0; 4]; Self::MOST_COLORS];
        let count = colors.len();
        if count == 0 || count > all.len() {
            return None;
        }
        all[..count].copy_from_slice(colors);
        Some(Self {
            shape,
            colors: all,
            count,
        })
    }

    /// The shape.
    #[must_use]
    pub fn shape(&self) -> GradientShape {
        self.shape
    }

    /// The colours.
    #[must_use]
    pub fn colors(&self) -> &[[u8; 4]] {
        &self.colors[..self.count]
    }

    /// True if no colour is transparent.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        self.colors().iter().all(|color| color[3] == 255)
    }

    /// The colour halfway, sRGB, without its alpha.
    #[must_use]
    pub fn middle(&self) -> [u8; 3] {
        let (color, _) = self.linear_middle();
        color.map(|channel| encode(channel, Encoding::Srgb))
    }

    /// The colour halfway, sRGB with straight alpha, rounded as in pictures, which hold colours
    /// multiplied by alpha.
    #[must_use]
    pub fn middle_with_alpha(&self) -> [u8; 4] {
        let (color, alpha) = self.linear_middle();
        let [r, g, b] = color.map(|channel| encode(channel * alpha, Encoding::Srgb));
        let mut rgba = [r, g, b, encode(alpha, Encoding::Linear)];
        straighten(&mut rgba, Encoding::Srgb);
        rgba
    }

    /// The linear colour halfway, not multiplied by alpha, and alpha.
    fn linear_middle(&self) -> ([f32; 3], f32) {
        let last = self.count - 1;
        let [a, b] = [last / 2, last.div_ceil(2)].map(|at| oklab(self.colors[at], Encoding::Srgb));
        let sum = [0, 1, 2, 3].map(|i| a[i] + b[i]);
        let alpha = sum[3].max(1e-6);
        let color = linear([sum[0] / alpha, sum[1] / alpha, sum[2] / alpha]);
        (color, sum[3] / 2.0)
    }
}

/// A colour as gradients mix it, multiplied by its alpha: Oklab's L, a, b, or the codes ÷ 255 of
/// pictures of numbers; then the alpha.
pub(crate) fn oklab([r, g, b, alpha]: [u8; 4], encoding: Encoding) -> [f32; 4] {
    let alpha = f32::from(alpha) / 255.0;
    let rgb = [r, g, b].map(|code| decode(code, encoding));
    let mixed = match encoding {
        Encoding::Linear => rgb,
        Encoding::Srgb => {
            let [r, g, b] = rgb;
            let [l, m, s] = [
                0.412_221_46 * r + 0.536_332_55 * g + 0.051_445_995 * b,
                0.211_903_5 * r + 0.680_699_5 * g + 0.107_396_96 * b,
                0.088_302_46 * r + 0.281_718_85 * g + 0.629_978_7 * b,
            ]
            .map(libm::cbrtf);
            [
                0.210_454_26 * l + 0.793_617_8 * m - 0.004_072_047 * s,
                1.977_998_5 * l - 2.428_592_2 * m + 0.450_593_7 * s,
                0.025_904_037 * l + 0.782_771_77 * m - 0.808_675_77 * s,
            ]
        }
    };
    let [x, y, z] = mixed.map(|value| value * alpha);
    [x, y, z, alpha]
}

/// Rows of the matrix from Oklab to the cube roots of the cones' responses.
pub(crate) const ROOTS: [[f32; 3]; 3] = [
    [1.0, 0.396_337_78, 0.215_803_76],
    [1.0, -0.105_561_346, -0.063_854_17],
    [1.0, -0.089_484_18, -1.291_485_5],
];

/// Rows of the matrix from the cones' responses to linear sRGB.
pub(crate) const LINEAR: [[f32; 3]; 3] = [
    [4.076_741_7, -3.307_711_6, 0.230_969_94],
    [-1.268_438, 2.609_757_4, -0.341_319_38],
    [-0.004_196_086_3, -0.703_418_6, 1.707_614_7],
];

/// Linear sRGB of Oklab.
fn linear(lab: [f32; 3]) -> [f32; 3] {
    let dot = |row: [f32; 3], v: [f32; 3]| row[0] * v[0] + row[1] * v[1] + row[2] * v[2];
    let cones = ROOTS.map(|row| {
        let root = dot(row, lab);
        root * root * root
    });
    LINEAR.map(|row| dot(row, cones))
}

#[cfg(test)]
mod tests {
    use super::{Gradient, GradientShape, linear, oklab};
    use crate::alpha::{Encoding, encode};

    #[test]
    fn every_grey_and_many_colours_come_back_from_oklab() {
        for code in 0..=255_u8 {
            for color in [[code; 3], [code, 255 - code, 7], [200, code / 3, code]] {
                let [r, g, b] = color;
                let [l, a, b, _] = oklab([r, g, b, 255], Encoding::Srgb);
                let back = linear([l, a, b]).map(|channel| encode(channel, Encoding::Srgb));
                assert_eq!(back, color);
            }
        }
        // Ottosson's table: red has L 0.628, a 0.225, b 0.126.
        let [l, a, b, alpha] = oklab([255, 0, 0, 255], Encoding::Srgb);
        assert!((l - 0.628).abs() < 1e-3 && (a - 0.225).abs() < 1e-3 && (b - 0.126).abs() < 1e-3);
        assert!((alpha - 1.0).abs() < 1e-6);
    }

    #[test]
    fn gradients_have_one_to_eight_colours_and_a_middle() {
        let of = |colors: &[[u8; 4]]| Gradient::new(GradientShape::Linear, colors);
        assert!(of(&[]).is_none() && of(&[[0; 4]; 9]).is_none());
        let grey = of(&[[0, 0, 0, 255], [90, 90, 90, 255], [255; 4]]).expect("three");
        assert_eq!(grey.middle(), [90; 3]);
        assert!(grey.is_opaque());
        let clear = of(&[[200, 10, 10, 255], [0; 4]]).expect("two");
        assert_eq!(clear.middle(), [200, 10, 10], "nothing dark is between");
        assert_eq!(clear.middle_with_alpha()[3], 128);
        let pale = of(&[[255, 0, 0, 128]]).expect("one");
        assert_eq!(pale.middle_with_alpha(), [255, 0, 0, 128]);
        assert_eq!(grey.middle_with_alpha(), [90, 90, 90, 255]);
        assert!(!clear.is_opaque());
        assert_eq!(of(&[[0; 4]]).expect("one").middle(), [0; 3]);
    }
}
