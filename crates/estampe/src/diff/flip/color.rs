//! The colour spaces of FLIP: sRGB, linear light, YCxCz and Hunt-adjusted L*a*b*.
//!
//! Values are relative to white: X, Y and Z are each divided by the white point's, D65 at the
//! chromaticity (0.31271, 0.32902). The matrix follows from the primaries of sRGB (IEC 61966-2-1)
//! and that white; it is computed once in f64.

/// Exponent of the final colour difference (the paper's q_c).
const COLOR_EXPONENT: f32 = 0.7;
/// The fraction of the largest difference (p_c) that is mapped to [`KNEE_TO`] (p_t).
const KNEE_FROM: f32 = 0.4;
const KNEE_TO: f32 = 0.95;

/// A colour relative to white, along X, Y, Z.
pub(super) type Xyz = [f32; 3];

/// Luminance and two opponent axes, linear in light: 116 Y − 16, 500 (X − Y), 200 (Y − Z).
pub(super) type YCxCz = [f32; 3];

/// L*, and a* and b* reduced in the dark.
pub(super) type HuntLab = [f32; 3];

/// The conversions, with their tables.
#[derive(Debug)]
pub(super) struct Colors {
    /// Linear light of each 8-bit sRGB value.
    linear: [f32; 256],
    white_relative_xyz_from_rgb: [[f32; 3]; 3],
    rgb_from_white_relative_xyz: [[f32; 3]; 3],
    /// HyAB of green and blue, the furthest pair, to the power q_c.
    largest: f32,
}

impl Colors {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "tables are rounded to f32 once"
    )]
    pub(super) fn new() -> Self {
        let matrix = white_relative_xyz_from_rgb();
        let mut colors = Self {
            linear: std::array::from_fn(|i| linear_from_srgb(i as f64 / 255.0) as f32),
            white_relative_xyz_from_rgb: matrix.map(|row| row.map(|v| v as f32)),
            rgb_from_white_relative_xyz: inverse(matrix).map(|row| row.map(|v| v as f32)),
            largest: 1.0,
        };
        let [green, blue] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
            .map(|rgb| hunt_lab(multiply(&colors.white_relative_xyz_from_rgb, rgb)));
        colors.largest = libm::powf(hyab(green, blue), COLOR_EXPONENT);
        colors
    }

    /// An sRGB texel over a grey background, as YCxCz.
    pub(super) fn ycxcz(&self, [r, g, b, alpha]: [u8; 4], ground: u8) -> YCxCz {
        // Straight alpha mixes the encoded values, as viewers and browsers do.
        let over = |value: u8| {
            let (value, alpha, ground) = (u32::from(value), u32::from(alpha), u32::from(ground));
            (value * alpha + ground * (255 - alpha) + 127) / 255
        };
        let rgb = [r, g, b].map(|value| self.linear[over(value) as usize]);
        let [x, y, z] = multiply(&self.white_relative_xyz_from_rgb, rgb);
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    /// A filtered YCxCz colour, clamped to the gamut, as Hunt-adjusted L*a*b*.
    pub(super) fn hunt_lab(&self, [luma, cx, cz]: YCxCz) -> HuntLab {
        let y = (luma + 16.0) / 116.0;
        let rgb = multiply(
            &self.rgb_from_white_relative_xyz,
            [cx / 500.0 + y, y, y - cz / 200.0],
        );
        hunt_lab(multiply(
            &self.white_relative_xyz_from_rgb,
            rgb.map(|v| v.clamp(0.0, 1.0)),
        ))
    }

    /// The colour difference ΔE in [0, 1]: HyAB to the power q_c, then a knee that gives the lower
    /// 40 % of its range 95 % of the scale.
    pub(super) fn difference(&self, a: HuntLab, b: HuntLab) -> f32 {
        let distance = hyab(a, b);
        if distance == 0.0 {
            return 0.0;
        }
        let share = libm::powf(distance, COLOR_EXPONENT) / self.largest;
        if share < KNEE_FROM {
            share * (KNEE_TO / KNEE_FROM)
        } else {
            KNEE_TO + (share - KNEE_FROM) / (1.0 - KNEE_FROM) * (1.0 - KNEE_TO)
        }
    }
}

/// |ΔL*| plus the Euclidean distance of (a*, b*) (Abasi, Tehran, Fairchild, 2020).
fn hyab(a: HuntLab, b: HuntLab) -> f32 {
    let [l, u, v] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    l.abs() + (u * u + v * v).sqrt()
}

/// CIE L*a*b* (CIE 15) with a* and b* times 0.01 L*: colours fade in the dark (Hunt, 1952).
fn hunt_lab(xyz: Xyz) -> HuntLab {
    let [x, y, z] = xyz.map(|t| {
        const DELTA: f32 = 6.0 / 29.0;
        if t > DELTA * DELTA * DELTA {
            libm::cbrtf(t)
        } else {
            t / (3.0 * DELTA * DELTA) + 4.0 / 29.0
        }
    });
    let lightness = 116.0 * y - 16.0;
    let hunt = 0.01 * lightness;
    [lightness, hunt * 500.0 * (x - y), hunt * 200.0 * (y - z)]
}

/// The electro-optical transfer function of sRGB.
fn linear_from_srgb(value: f64) -> f64 {
    if value <= 0.04045 {
        value / 12.92
    } else {
        libm::pow((value + 0.055) / 1.055, 2.4)
    }
}

/// The matrix whose columns are the primaries, scaled so that (1, 1, 1) gives the white point, with
/// each row divided by that white (so every row sums to 1).
fn white_relative_xyz_from_rgb() -> [[f64; 3]; 3] {
    let xyz_of = |x: f64, y: f64| [x / y, 1.0, (1.0 - x - y) / y];
    let primaries = [xyz_of(0.64, 0.33), xyz_of(0.30, 0.60), xyz_of(0.15, 0.06)];
    let columns = [0, 1, 2].map(|row| primaries.map(|primary| primary[row]));
    let white = xyz_of(0.31271, 0.32902);
    let scales =
        inverse(columns).map(|row| row[0] * white[0] + row[1] * white[1] + row[2] * white[2]);
    [0, 1, 2].map(|row| [0, 1, 2].map(|c| columns[row][c] * scales[c] / white[row]))
}

/// The inverse by the adjugate: row r, column c holds the cofactor of (c, r) over the determinant.
fn inverse(m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let cofactor = |r: usize, c: usize| {
        let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
        m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
    };
    let determinant = (0..3).map(|c| m[0][c] * cofactor(0, c)).sum::<f64>();
    [0, 1, 2].map(|r| [0, 1, 2].map(|c| cofactor(c, r) / determinant))
}

#[inline]
fn multiply(m: &[[f32; 3]; 3], [x, y, z]: [f32; 3]) -> [f32; 3] {
    [
        m[0][0] * x + m[0][1] * y + m[0][2] * z,
        m[1][0] * x + m[1][1] * y + m[1][2] * z,
        m[2][0] * x + m[2][1] * y + m[2][2] * z,
    ]
}
