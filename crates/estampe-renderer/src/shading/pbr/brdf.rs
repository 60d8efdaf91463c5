//! The terms of the reflectance of rough surfaces: glTF 2.0, appendix B, and its extensions.
//!
//! ```text
//!   n normal, v to the eye, l to the light, h = (l + v) ÷ ‖l + v‖, α = roughness²
//!
//!   GGX      D = α² ÷ π((n·h)²(α² − 1) + 1)²                        Trowbridge and Reitz 1975
//!            V = ½ ÷ ( n·l √((n·v)²(1 − α²) + α²) + n·v √((n·l)²(1 − α²) + α²) )     Heitz 2014
//!   Fresnel  F = F0 + (F90 − F0)(1 − v·h)⁵                          Schlick 1994
//!   sheen    D = (2 + 1/α) sinⁱ ÷ 2π, i = 1/α                       Estevez and Kulla 2017
//!            V = 1 ÷ 4(n·l + n·v − n·l n·v)                         Neubelt and Pettineo 2013
//! ```
//!
//! The specular term is D·V·F. Tests integrate each over the hemisphere and compare with the same
//! formulas in f64 of the oracle (`estampe_reference::pbr`).

use estampe::{Real, maths};
use std::f32::consts::{FRAC_1_PI, TAU};

/// The α of a perceptual roughness; at least that of a highlight which a pixel can show.
#[inline(always)]
pub fn alpha<R: Real>(roughness: R) -> R {
    /// Of roughness 0.045.
    const LEAST: f32 = 0.002;
    (roughness * roughness).max(LEAST)
}

/// The density of half vectors. `sin_squared` is ‖n × h‖², which near the normal has digits that
/// 1 − (n·h)² has lost.
#[inline(always)]
pub fn density_ggx<R: Real>(n_dot_h: R, sin_squared: R, alpha: R) -> R {
    let scaled = n_dot_h * alpha;
    let ratio = alpha / (scaled * scaled + sin_squared);
    ratio * ratio * FRAC_1_PI
}

/// The visibility, masking and shadowing ÷ 4(n·l)(n·v).
#[inline(always)]
pub fn visibility_ggx<R: Real>(n_dot_l: R, n_dot_v: R, alpha: R) -> R {
    let squared = alpha * alpha;
    let sum = n_dot_l * masked(n_dot_v, squared) + n_dot_v * masked(n_dot_l, squared);
    0.5 / sum.max(1e-6)
}

/// √((n·x)²(1 − α²) + α²).
#[inline(always)]
fn masked<R: Real>(cosine: R, alpha_squared: R) -> R {
    (cosine * cosine * (1.0 - alpha_squared) + alpha_squared).sqrt()
}

/// The weight of F90: (1 − cos)⁵.
#[inline(always)]
pub fn schlick<R: Real>(cosine: R) -> R {
    maths::powi((1.0 - cosine).saturate(), 5)
}

/// The α of a sheen's perceptual roughness.
#[inline(always)]
pub fn sheen_alpha<R: Real>(roughness: R) -> R {
    /// Of roughness 0.07.
    const LEAST: f32 = 0.005;
    (roughness * roughness).max(LEAST)
}

/// The density of the half vectors of fibres.
#[inline(always)]
pub fn density_sheen<R: Real>(n_dot_h: R, alpha: R) -> R {
    let inverse = 1.0 / alpha;
    let sin_squared = (1.0 - n_dot_h * n_dot_h).max(1e-7);
    (inverse + 2.0) * sin_squared.pow(inverse * 0.5) * (1.0 / TAU)
}

/// The visibility of fibres.
#[inline(always)]
pub fn visibility_sheen<R: Real>(n_dot_l: R, n_dot_v: R) -> R {
    0.25 / (n_dot_l + n_dot_v - n_dot_l * n_dot_v).max(1e-6)
}
