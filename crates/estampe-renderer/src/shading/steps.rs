//! Light in steps.

use estampe::Real;

/// The value in `levels` steps, at least 2, equally wide and equally far apart:
///
/// ```text
///   min(⌊I·N⌋, N − 1) ÷ (N − 1)
///
///   N = 4:   I  0 ── ¼ ── ½ ── ¾ ── 1
///               0    ⅓    ⅔    1
/// ```
///
/// The minimum is for I ≥ 1, which would be more levels; negative values and NaN are the level 0.
#[inline(always)]
pub fn quantised<R: Real>(value: R, levels: u16) -> R {
    let n = f32::from(levels.max(2));
    (value.max(0.0) * n).floor().min(value.splat(n - 1.0)) / (n - 1.0)
}
