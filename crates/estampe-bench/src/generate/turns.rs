//! Sine and cosine with the same bits on every machine.

use std::f64::consts::TAU;

/// Denominators of the sine's Taylor series after the first term: 3!, 5!, … 13!, signs alternating.
const SINE: [f64; 6] = [
    6.0,
    120.0,
    5_040.0,
    362_880.0,
    39_916_800.0,
    6_227_020_800.0,
];
/// Denominators of the cosine's Taylor series after the first term: 2!, 4!, … 14!.
const COSINE: [f64; 7] = [
    2.0,
    24.0,
    720.0,
    40_320.0,
    3_628_800.0,
    479_001_600.0,
    87_178_291_200.0,
];

/// Sine and cosine of an angle in turns (1 is the full circle).
///
/// The angle is reduced exactly to ±⅛ turn around a multiple of a quarter; there the first omitted
/// terms of the series are below 10⁻¹².
#[must_use]
pub fn sin_cos_turns(turns: f64) -> (f64, f64) {
    let quarter = (turns * 4.0 + 0.5).floor();
    let angle_rad = (turns - quarter * 0.25) * TAU;
    let square = angle_rad * angle_rad;
    let sine = angle_rad * alternating_series(&SINE, square);
    let cosine = alternating_series(&COSINE, square);
    // Rotate back by the quarters that were subtracted.
    match quarter.rem_euclid(4.0) {
        0.0 => (sine, cosine),
        1.0 => (cosine, -sine),
        2.0 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// 1 − x/d₀ + x²/d₁ − …, by Horner's rule from the last term on.
fn alternating_series(denominators: &[f64], x: f64) -> f64 {
    let mut sum = 0.0;
    for (index, &denominator) in denominators.iter().enumerate().rev() {
        let sign = if index % 2 == 0 { -1.0 } else { 1.0 };
        // In the first round x·0 adds nothing: the sum starts with the last coefficient.
        sum = sign / denominator + x * sum;
    }
    1.0 + x * sum
}
