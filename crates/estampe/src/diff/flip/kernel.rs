//! One-dimensional kernels, and their application along rows and columns.

use std::f64::consts::PI;

/// The kernels for one image axis, each of 2 · [`Kernels::reach`] + 1 taps.
#[derive(Debug)]
pub(super) struct Kernels {
    /// Taps on either side of the middle.
    pub(super) reach: usize,
    /// Contrast sensitivity of the luminance axis.
    pub(super) luminance: Vec<f32>,
    /// Contrast sensitivity of the red-green axis.
    pub(super) red_green: Vec<f32>,
    /// Contrast sensitivity of the blue-yellow axis: a narrow and a wide Gaussian with their
    /// weights.
    pub(super) blue_yellow: [(Vec<f32>, f32); 2],
    /// The Gaussian of the feature detectors.
    pub(super) smooth: Vec<f32>,
    /// The first derivative of the Gaussian.
    pub(super) edge: Vec<f32>,
    /// The second derivative of the Gaussian.
    pub(super) point: Vec<f32>,
}

/// Contrast sensitivity over frequency, a·exp(−b f²) in cycles per degree (the paper's table 1).
const LUMINANCE_B: f64 = 0.0047;
const RED_GREEN_B: f64 = 0.0053;
const BLUE_YELLOW: [(f64, f64); 2] = [(34.1, 0.04), (13.5, 0.025)];
/// The width of the feature detectors in degrees of visual angle (the paper's w).
const FEATURE_WIDTH_DEG: f64 = 0.082;

impl Kernels {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a reach is a small whole number"
    )]
    pub(super) fn new(pixels_per_degree: f64) -> Self {
        // Three standard deviations of the widest Gaussian: exp(−π² x² / b) has σ² = b / (2π²).
        let widest = (BLUE_YELLOW[0].1 / (2.0 * PI * PI)).sqrt();
        let sensitivity_reach = (3.0 * widest * pixels_per_degree).ceil();
        let feature_sigma = 0.5 * FEATURE_WIDTH_DEG * pixels_per_degree;
        let feature_reach = (3.0 * feature_sigma).ceil();
        let reach = f64::max(sensitivity_reach, feature_reach) as usize;

        // The taps at distance x: sampled within the filter's own reach, zero beyond.
        let sample = |own_reach: f64, f: &dyn Fn(f64) -> f64| -> Vec<f64> {
            (0..=2 * reach)
                .map(|i| i as f64 - reach as f64)
                .map(|x| if x.abs() <= own_reach { f(x) } else { 0.0 })
                .collect()
        };
        let gaussian = |b: f64| {
            sample(sensitivity_reach, &|x| {
                let degrees = x / pixels_per_degree;
                libm::exp(-PI * PI * degrees * degrees / b)
            })
        };
        // A Gaussian weighs a·√(π/b) at its peak; over both axes, its share is that times its sum².
        let shares = BLUE_YELLOW.map(|(a, b)| {
            let sum: f64 = gaussian(b).iter().sum();
            a * (PI / b).sqrt() * sum * sum
        });
        let total = shares[0] + shares[1];

        let variance = feature_sigma * feature_sigma;
        let bell = |x: f64| libm::exp(-x * x / (2.0 * variance));
        Self {
            reach,
            luminance: summing_to_one(gaussian(LUMINANCE_B)),
            red_green: summing_to_one(gaussian(RED_GREEN_B)),
            blue_yellow: [0, 1].map(|i| {
                (
                    summing_to_one(gaussian(BLUE_YELLOW[i].1)),
                    rounded(shares[i] / total),
                )
            }),
            smooth: summing_to_one(sample(feature_reach, &bell)),
            edge: balanced(sample(feature_reach, &|x| -x * bell(x))),
            point: balanced(sample(feature_reach, &|x| {
                (x * x / variance - 1.0) * bell(x)
            })),
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "taps are worked out in f64 and used in f32"
)]
fn rounded(value: f64) -> f32 {
    value as f32
}

fn summing_to_one(taps: Vec<f64>) -> Vec<f32> {
    let sum: f64 = taps.iter().sum();
    taps.iter().map(|tap| rounded(tap / sum)).collect()
}

/// Scales the positive taps to sum to 1 and the negative ones to −1.
fn balanced(taps: Vec<f64>) -> Vec<f32> {
    let positive: f64 = taps.iter().filter(|tap| **tap > 0.0).sum();
    let negative: f64 = -taps.iter().filter(|tap| **tap < 0.0).sum::<f64>();
    taps.iter()
        .map(|&tap| rounded(tap / if tap > 0.0 { positive } else { negative }))
        .collect()
}

/// Filters a row: `out[x] = Σ taps[k] · padded[x + k]`, where `padded` holds the row with the reach
/// of the kernel on both sides.
#[inline]
pub(super) fn along_row(padded: &[f32], taps: &[f32], out: &mut [f32]) {
    out.fill(0.0);
    for (k, &tap) in taps.iter().enumerate() {
        add_scaled(out, &padded[k..], tap);
    }
}

/// Filters down the columns into row `y`: `out[x] = Σ taps[k] · plane[y + k][x]`, where `plane`
/// holds the rows with the reach of the kernel above and below.
#[inline]
pub(super) fn down_columns(plane: &[f32], y: usize, taps: &[f32], out: &mut [f32]) {
    out.fill(0.0);
    let width = out.len();
    for (k, &tap) in taps.iter().enumerate() {
        add_scaled(out, &plane[(y + k) * width..], tap);
    }
}

#[inline]
fn add_scaled(out: &mut [f32], values: &[f32], scale: f32) {
    if scale != 0.0 {
        for (out, value) in out.iter_mut().zip(values) {
            *out += scale * value;
        }
    }
}
