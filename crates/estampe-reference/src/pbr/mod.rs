//! Physically based reflectance in f64, written from glTF 2.0's appendix B and the texts of its
//! extensions, and integrals of it by brute force.
//!
//! It shares no code with the shaders of `estampe-renderer`, whose tests compare with it. The
//! normal is +Z; directions are unit vectors away from the surface. Row F4.
//!
//! | | |
//! |---|---|
//! | here | single terms, and integrals on grids |
//! | [`film`] | the reflectance of thin films |
//! | [`Layered`] | a material of all layers |
//! | [`reflected`] | the light that such a material reflects, by random directions |

#![expect(
    clippy::disallowed_methods,
    reason = "the oracle is compared with tolerances, and std's functions are independent of ours"
)]

pub mod film;
mod layered;
mod monte_carlo;

pub use layered::{Coat, Fibres, Film, Grooves, Layered};
pub use monte_carlo::{Estimate, reflected};

use std::f64::consts::PI;

type Direction = [f64; 3];

/// A surface of one lobe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// Reflectance at normal incidence.
    pub f0: [f64; 3],
    /// Reflectance at grazing incidence.
    pub f90: f64,
    /// The α of GGX.
    pub alpha: f64,
}

/// The density of GGX for the cosine of n and h.
#[must_use]
pub fn density_ggx(n_dot_h: f64, alpha: f64) -> f64 {
    let a2 = alpha * alpha;
    a2 / (PI * (n_dot_h * n_dot_h * (a2 - 1.0) + 1.0).powi(2))
}

/// The visibility of GGX with height-correlated masking: G ÷ 4(n·l)(n·v).
#[must_use]
pub fn visibility_ggx(n_dot_l: f64, n_dot_v: f64, alpha: f64) -> f64 {
    // Smith's Λ of each direction; G = 1 ÷ (1 + Λ(l) + Λ(v)).
    let lambda = |cosine: f64| {
        let tangent2 = (1.0 - cosine * cosine) / (cosine * cosine);
        ((1.0 + alpha * alpha * tangent2).sqrt() - 1.0) / 2.0
    };
    1.0 / ((1.0 + lambda(n_dot_l) + lambda(n_dot_v)) * 4.0 * n_dot_l * n_dot_v)
}

/// Schlick's Fresnel term.
#[must_use]
pub fn fresnel(f0: f64, f90: f64, v_dot_h: f64) -> f64 {
    f0 + (f90 - f0) * (1.0 - v_dot_h).powi(5)
}

/// The density of a sheen (Charlie) for the cosine of n and h.
#[must_use]
pub fn density_sheen(n_dot_h: f64, alpha: f64) -> f64 {
    let sine = (1.0 - n_dot_h * n_dot_h).max(0.0).sqrt();
    (2.0 + 1.0 / alpha) * sine.powf(1.0 / alpha) / (2.0 * PI)
}

/// The visibility of a sheen.
#[must_use]
pub fn visibility_sheen(n_dot_l: f64, n_dot_v: f64) -> f64 {
    1.0 / (4.0 * (n_dot_l + n_dot_v - n_dot_l * n_dot_v))
}

/// The specular term D·V·F of white light, without light that is reflected twice.
#[must_use]
pub fn specular(surface: &Surface, view: Direction, light: Direction) -> [f64; 3] {
    if light[2] <= 0.0 || view[2] <= 0.0 {
        return [0.0; 3];
    }
    let half = normalised([0, 1, 2].map(|axis| view[axis] + light[axis]));
    let lobe =
        density_ggx(half[2], surface.alpha) * visibility_ggx(light[2], view[2], surface.alpha);
    let v_dot_h = dot(view, half);
    surface
        .f0
        .map(|f0| lobe * fresnel(f0, surface.f90, v_dot_h))
}

/// The integral of a function over the hemisphere around +Z, by `count`² directions of equal solid
/// angles.
pub fn over_hemisphere(count: u32, mut value: impl FnMut(Direction) -> [f64; 3]) -> [f64; 3] {
    let mut sums = [0.0; 3];
    let steps = f64::from(count);
    for row in 0..count {
        for column in 0..count {
            // Equal steps of the cosine are equal solid angles (Archimedes).
            let cosine = (f64::from(row) + 0.5) / steps;
            let turn = (f64::from(column) + 0.5) / steps * 2.0 * PI;
            let sine = (1.0 - cosine * cosine).sqrt();
            let values = value([sine * turn.cos(), sine * turn.sin(), cosine]);
            for (sum, value) in sums.iter_mut().zip(values) {
                *sum += value;
            }
        }
    }
    sums.map(|sum| sum * 2.0 * PI / (steps * steps))
}

/// The integral of a function of the half vector's neighbourhood: light from all directions in
/// which a GGX lobe reflects, by `count`² samples of the lobe itself, each weighted with the term
/// over its probability.
pub fn over_lobe(
    count: u32,
    alpha: f64,
    view: Direction,
    mut value: impl FnMut(Direction) -> [f64; 3],
) -> [f64; 3] {
    let mut sums = [0.0; 3];
    let steps = f64::from(count);
    for row in 0..count {
        for column in 0..count {
            let u = (f64::from(row) + 0.5) / steps;
            let turn = (f64::from(column) + 0.5) / steps * 2.0 * PI;
            let cosine = ((1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u)).sqrt();
            let sine = (1.0 - cosine * cosine).sqrt();
            let half = [sine * turn.cos(), sine * turn.sin(), cosine];
            let v_dot_h = dot(view, half);
            let light = [0, 1, 2].map(|axis| 2.0 * v_dot_h * half[axis] - view[axis]);
            if v_dot_h <= 0.0 || light[2] <= 0.0 {
                continue;
            }
            let probability = density_ggx(cosine, alpha) * cosine / (4.0 * v_dot_h);
            for (sum, value) in sums.iter_mut().zip(value(light)) {
                *sum += value / probability;
            }
        }
    }
    sums.map(|sum| sum / (steps * steps))
}

fn dot(a: Direction, b: Direction) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn normalised(v: Direction) -> Direction {
    let length = dot(v, v).sqrt();
    v.map(|component| component / length)
}

#[cfg(test)]
mod tests;
