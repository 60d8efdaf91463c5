//! Tone maps: from radiance without a bound to what a screen shows, 0 to 1, linear.

use estampe::{Real, Vec3};

/// A tone map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ToneMap {
    /// What is above 1 is cut off.
    None,
    /// Khronos PBR Neutral (2024): colours up to 0.8 stay as they are, brighter ones are
    /// compressed and lose colour.
    #[default]
    Neutral,
    /// AgX (T. Sobotka), its base look, with the curve as the polynomial of B. Wrensch: bright
    /// colours become white gradually.
    Agx,
    /// ACES (Academy Color Encoding System), reference rendering and sRGB output in the fit of
    /// S. Hill: the contrast of film.
    Aces,
}

impl ToneMap {
    /// The colour that is shown.
    #[inline(always)]
    pub fn apply<R: Real>(self, color: Vec3<R>) -> Vec3<R> {
        match self {
            Self::None => color,
            Self::Neutral => color.x.out_of_line(
                #[inline(always)]
                || neutral(color),
            ),
            Self::Agx => color.x.out_of_line(
                #[inline(always)]
                || agx(color),
            ),
            Self::Aces => color.x.out_of_line(
                #[inline(always)]
                || aces(color),
            ),
        }
    }
}

/// The rows of a matrix times a colour.
#[inline(always)]
fn transform<R: Real>(rows: [[f32; 3]; 3], color: Vec3<R>) -> Vec3<R> {
    Vec3::new(
        color.dot_uniform(rows[0]),
        color.dot_uniform(rows[1]),
        color.dot_uniform(rows[2]),
    )
}

/// <https://github.com/KhronosGroup/ToneMapping>: F90 0.04 is taken away first, so that a base
/// colour under white light comes out unchanged.
#[inline(always)]
fn neutral<R: Real>(color: Vec3<R>) -> Vec3<R> {
    const START: f32 = 0.8 - 0.04;
    const RANGE: f32 = 1.0 - START;
    const DESATURATION: f32 = 0.15;
    let least = color.x.min(color.y).min(color.z);
    let toe = least - least * least * 6.25;
    let offset = R::select(least.lt(0.08), toe, least.splat(0.04));
    let color = color - Vec3::repeat(offset);
    let peak = color.x.max(color.y).max(color.z);
    let compressed = 1.0 - (RANGE * RANGE) / (peak + (RANGE - START)).max(RANGE);
    let white = 1.0 - 1.0 / ((peak - compressed) * DESATURATION + 1.0);
    let scaled = color * (compressed / peak.max(START));
    let bright = scaled.mix(Vec3::repeat(compressed), white);
    Vec3::select(peak.lt(START), color, bright)
}

#[inline(always)]
fn agx<R: Real>(color: Vec3<R>) -> Vec3<R> {
    const INSET: [[f32; 3]; 3] = [
        [0.842_479_06, 0.078_433_6, 0.079_223_745],
        [0.042_328_242, 0.878_468_6, 0.079_166_13],
        [0.042_375_654, 0.078_433_6, 0.879_143],
    ];
    const OUTSET: [[f32; 3]; 3] = [
        [1.196_879, -0.098_020_88, -0.099_029_74],
        [-0.052_896_85, 1.151_903_1, -0.098_961_18],
        [-0.052_971_635, -0.098_043_45, 1.151_073_7],
    ];
    let inset = transform(INSET, color);
    let shown = Vec3::new(agx_curve(inset.x), agx_curve(inset.y), agx_curve(inset.z));
    let shown = transform(OUTSET, shown);
    Vec3::new(
        agx_linear(shown.x),
        agx_linear(shown.y),
        agx_linear(shown.z),
    )
}

/// The curve gives display codes of exponent 2.2. Out of line, as [`agx_curve`]: for three powers
/// and three logarithms in one function LLVM took 5 s at x86-64's baseline.
#[inline(always)]
fn agx_linear<R: Real>(code: R) -> R {
    code.out_of_line(
        #[inline(always)]
        || code.max(0.0).pow(2.2),
    )
}

#[inline(always)]
fn agx_curve<R: Real>(value: R) -> R {
    value.out_of_line(
        #[inline(always)]
        || agx_polynomial(value),
    )
}

#[inline(always)]
fn agx_polynomial<R: Real>(value: R) -> R {
    /// Stops below and above middle grey that the curve holds.
    const STOPS: [f32; 2] = [-12.473_93, 4.026_069];
    let stops = value.max(1e-10).log2().clamp(STOPS[0], STOPS[1]);
    let x = (stops - STOPS[0]) / (STOPS[1] - STOPS[0]);
    let sum = x * 15.5 - 40.14;
    let sum = sum * x + 31.96;
    let sum = sum * x - 6.868;
    let sum = sum * x + 0.429_8;
    let sum = sum * x + 0.119_1;
    sum * x - 0.002_32
}

#[inline(always)]
fn aces<R: Real>(color: Vec3<R>) -> Vec3<R> {
    const INPUT: [[f32; 3]; 3] = [
        [0.597_19, 0.354_58, 0.048_23],
        [0.076_00, 0.908_34, 0.015_66],
        [0.028_40, 0.133_83, 0.837_77],
    ];
    const OUTPUT: [[f32; 3]; 3] = [
        [1.604_75, -0.531_08, -0.073_67],
        [-0.102_08, 1.108_13, -0.006_05],
        [-0.003_27, -0.072_76, 1.076_02],
    ];
    /// Middle grey comes out as with the other tone maps.
    const EXPOSURE: f32 = 1.0 / 0.6;
    let seen = transform(INPUT, color * EXPOSURE);
    let shown = Vec3::new(aces_curve(seen.x), aces_curve(seen.y), aces_curve(seen.z));
    let shown = transform(OUTPUT, shown);
    Vec3::new(shown.x.saturate(), shown.y.saturate(), shown.z.saturate())
}

#[inline(always)]
fn aces_curve<R: Real>(v: R) -> R {
    let above = v * (v + 0.024_578_6) - 0.000_090_537;
    above / (v * (v * 0.983_729 + 0.432_951) + 0.238_081)
}
