//! The reflectance of a thin film (KHR_materials_iridescence): light that is reflected at the film
//! interferes with light that is reflected below it (L. Belcour, P. Barla, "A Practical Extension
//! to Microfacet Theory for the Modeling of Varying Iridescence", 2017).
//!
//! ```text
//!     θ₁ ╲   ╱   ╱         outside, index 1
//!   ──────╲─╱───╱────      R₁₂                     phases: π where light meets a lower index,
//!       θ₂ ╲   ╱           film, index η₂, d thick          0 elsewhere, and φ₂₁ = π − φ₁₂
//!   ────────╲─╱──────      R₂₃
//!            ╲             base, whose index follows from its F0
//!
//!   D = 2·η₂·d·cos θ₂      the difference of the paths
//!   R* = T₁₂₁²·R₂₃ ÷ (1 − R₁₂·R₂₃)
//!   I  = R₁₂ + R* + Σ over m = 1, 2   (R* − T₁₂₁)·√(R₁₂·R₂₃)ᵐ · 2·S(m·D, m·(φ₂₁ + φ₂₃))
//! ```
//!
//! Both reflectances are Schlick's, as the extension asks. S is the Fourier transform of the eye's
//! sensitivities, which are sums of Gaussians, so that no wavelengths are sampled; its numbers are
//! the extension's, in nanometres.

use super::brdf;
use estampe::{Real, Vec3};
use std::f32::consts::PI;

/// A thin film at a point.
#[derive(Debug, Clone, Copy)]
pub struct Film<R> {
    /// The share of the film's reflectance in the surface's.
    pub factor: R,
    /// Index of refraction, at least 1.
    pub ior: f32,
    pub thickness_nm: R,
}

/// The sensitivity of the eye for X: its second Gaussian.
const SECOND: Gaussian = Gaussian {
    height: 0.153_868_3,
    frequency: 0.014_073_707,
    decay: 2.579_051e-7,
};

/// The greatest Gaussians of the sensitivities for X, Y and Z.
const FIRST: [Gaussian; 3] = [
    Gaussian {
        height: 0.846_59,
        frequency: 0.010_562_034,
        decay: 2.464_912_2e-7,
    },
    Gaussian {
        height: 1.000_221_9,
        frequency: 0.011_280_203,
        decay: 5.299_465e-7,
    },
    Gaussian {
        height: 1.001_122_5,
        frequency: 0.013_875_786,
        decay: 3.765_942_5e-7,
    },
];

/// Linear sRGB of XYZ: rows.
const RGB_OF_XYZ: [[f32; 3]; 3] = [
    [3.240_454_2, -1.537_138_5, -0.498_531_4],
    [-0.969_266, 1.876_010_8, 0.041_556],
    [0.055_643_4, -0.204_025_9, 1.057_225_2],
];

/// A Gaussian of a sensitivity, in Fourier space: a wave that fades with the path's difference.
#[derive(Debug, Clone, Copy)]
struct Gaussian {
    height: f32,
    /// Radians per nanometre.
    frequency: f32,
    /// Halvings per square nanometre.
    decay: f32,
}

impl Gaussian {
    /// height · cos(frequency·path + shift) · 2^(−decay·path²).
    #[inline(always)]
    fn at<R: Real>(&self, path_nm: R, shift: R) -> R {
        // Out of line: LLVM took 1.4 s at x86-64's baseline for four of them in one function.
        path_nm.out_of_line(
            #[inline(always)]
            || {
                let wave = (path_nm * self.frequency + shift).cos() * self.height;
                wave * (path_nm * path_nm * -self.decay).exp2()
            },
        )
    }
}

impl<R: Real> Film<R> {
    /// The reflectance of film and base for light at an angle with this cosine, 0 to 1. `base_f0`
    /// is the base's reflectance in air, at normal incidence.
    #[inline(always)]
    pub fn fresnel(&self, base_f0: Vec3<R>, cosine: R) -> Vec3<R> {
        let ior = self.ior.max(1.0);
        let outer = (ior - 1.0) / (ior + 1.0);
        let outer = outer * outer;
        let first = brdf::schlick(cosine) * (1.0 - outer) + outer;
        let sine_squared = (1.0 - cosine * cosine) * (1.0 / (ior * ior));
        let inside = (1.0 - sine_squared).max(0.0).sqrt();
        let grazing = brdf::schlick(inside);
        let base = |f0| Below::new(f0, (ior, grazing), first);
        let (x, y, z) = (base(base_f0.x), base(base_f0.y), base(base_f0.z));
        let path = self.thickness_nm * inside * (2.0 * ior);
        let shift = Vec3::new(x.shift, y.shift, z.shift);
        let sensitivity = |path: R, shift| {
            path.out_of_line(
                #[inline(always)]
                || sensitivity(path, shift),
            )
        };
        let once = sensitivity(path, shift) * 2.0;
        let twice = sensitivity(path * 2.0, shift * 2.0) * 2.0;
        Vec3::new(
            x.sum(once.x, twice.x),
            y.sum(once.y, twice.y),
            z.sum(once.z, twice.z),
        )
    }
}

/// The light of one channel that film and base reflect.
#[derive(Debug, Clone, Copy)]
struct Below<R> {
    /// Without interference.
    mean: R,
    /// The weights of the waves of one and of two paths.
    waves: [R; 2],
    /// φ₂₁ + φ₂₃.
    shift: R,
}

impl<R: Real> Below<R> {
    /// `grazing` is Schlick's weight in the film, `first` is R₁₂.
    #[inline(always)]
    fn new(base_f0: R, (ior, grazing): (f32, R), first: R) -> Self {
        let root = base_f0.clamp(0.0, 0.9999).sqrt();
        let base_ior = (1.0 + root) / (1.0 - root);
        let ratio = (base_ior - ior) / (base_ior + ior);
        let normal = ratio * ratio;
        let second = normal + (1.0 - normal) * grazing;
        let through = 1.0 - first;
        let both = (first * second).clamp(1e-5, 0.9999);
        let rest = through * through * second / (1.0 - both);
        let wave = (rest - through) * both.sqrt();
        // No film has a lower index than air, so φ₂₁ is π.
        let pi = base_f0.splat(PI);
        Self {
            mean: first + rest,
            waves: [wave, wave * both.sqrt()],
            shift: R::select(base_ior.lt(ior), pi + pi, pi),
        }
    }

    #[inline(always)]
    fn sum(&self, once: R, twice: R) -> R {
        (self.mean + self.waves[0] * once + self.waves[1] * twice).saturate()
    }
}

/// S: the share of each channel that a path's difference leaves, −1 to 1.
#[inline(always)]
fn sensitivity<R: Real>(path_nm: R, shift: Vec3<R>) -> Vec3<R> {
    let xyz = Vec3::new(
        FIRST[0].at(path_nm, shift.x) + SECOND.at(path_nm, shift.x),
        FIRST[1].at(path_nm, shift.y),
        FIRST[2].at(path_nm, shift.z),
    );
    Vec3::new(
        xyz.dot_uniform(RGB_OF_XYZ[0]),
        xyz.dot_uniform(RGB_OF_XYZ[1]),
        xyz.dot_uniform(RGB_OF_XYZ[2]),
    )
}
