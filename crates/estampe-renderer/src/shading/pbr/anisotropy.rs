//! Surfaces whose roughness depends on the direction, such as brushed metal
//! (KHR_materials_anisotropy).
//!
//! ```text
//!   t, b tangent and bitangent of the grooves, s strength, α = roughness²
//!   αt = α + (1 − α)·s²,  αb = α
//!
//!   D = w² αt·αb ÷ π,  w = αt·αb ÷ ‖(αb·t·h, αt·b·h, αt·αb·n·h)‖²        Burley 2012
//!   V = ½ ÷ ( n·l ‖(αt·t·v, αb·b·v, n·v)‖ + n·v ‖(αt·t·l, αb·b·l, n·l)‖ )  Heitz 2014
//! ```
//!
//! The extension's sample clamps V to 1, which takes light from smooth surfaces at grazing angles;
//! here it is not clamped, as with surfaces without a direction, so that a strength of 0 changes
//! nothing.

use super::parameters::AnisotropyParameters;
use estampe::{Real, Vec2, Vec3};
use std::f32::consts::FRAC_1_PI;

/// The grooves of a surface at a point.
#[derive(Debug, Clone, Copy)]
pub struct Grooves<R> {
    /// Unit direction across the normal in which the highlight is stretched.
    pub tangent: Vec3<R>,
    /// cross(normal, tangent).
    pub bitangent: Vec3<R>,
    /// 0 to 1.
    pub strength: R,
}

/// The α of GGX along the tangent and along the bitangent.
#[derive(Debug, Clone, Copy)]
pub struct Alphas<R> {
    pub tangent: R,
    pub bitangent: R,
}

impl<R: Real> Grooves<R> {
    /// The grooves of a material at a point, given tangent and bitangent of its texture coordinates
    /// and the unit normal. Without a tangent the strength is 0.
    ///
    /// The direction is laid across the shading normal, so that the lobe is normalised where a
    /// normal map bends it.
    #[inline(always)]
    pub fn new(
        parameters: &AnisotropyParameters,
        uvs: (Vec2<R>, Vec2<R>),
        [tangent, bitangent]: [Vec3<R>; 2],
        normal: Vec3<R>,
    ) -> Self {
        let [cos, sin] = parameters.rotation;
        let one = normal.x.splat(1.0);
        let mut strength = one * parameters.strength;
        let (mut along, mut across) = (one * cos, one * sin);
        if let Some(texture) = &parameters.texture {
            let texel = texture.sample(uvs);
            let (x, y) = (texel.x * 2.0 - 1.0, texel.y * 2.0 - 1.0);
            let length = (x * x + y * y).sqrt();
            let (x, y) = (x / length, y / length);
            along = x * cos - y * sin;
            across = x * sin + y * cos;
            strength *= texel.z;
        }
        let direction = tangent * along + bitangent * across;
        let flat = direction - normal * normal.dot(direction);
        let squared = flat.dot(flat);
        let is_known = squared.gt(1e-12) & squared.lt(f32::INFINITY);
        let axis = Vec3::select(
            normal.y.abs().lt(0.9),
            Vec3::uniform(one, [0.0, 1.0, 0.0]),
            Vec3::uniform(one, [1.0, 0.0, 0.0]),
        );
        let any = normal.cross(axis).normalize();
        let tangent = Vec3::select(is_known, flat / squared.sqrt(), any);
        Self {
            tangent,
            bitangent: normal.cross(tangent),
            strength: R::select(is_known, strength.saturate(), one.splat(0.0)),
        }
    }

    /// The α of both directions, given that of the material.
    #[inline(always)]
    pub fn alphas(&self, alpha: R) -> Alphas<R> {
        Alphas {
            tangent: alpha + (1.0 - alpha) * (self.strength * self.strength),
            bitangent: alpha,
        }
    }

    /// The density of half vectors.
    #[inline(always)]
    pub fn density(&self, half: Vec3<R>, n_dot_h: R, alphas: Alphas<R>) -> R {
        let product = alphas.tangent * alphas.bitangent;
        let scaled = Vec3::new(
            self.tangent.dot(half) * alphas.bitangent,
            self.bitangent.dot(half) * alphas.tangent,
            n_dot_h * product,
        );
        let w = product / scaled.dot(scaled);
        product * w * w * FRAC_1_PI
    }

    /// The visibility, masking and shadowing ÷ 4(n·l)(n·v).
    #[inline(always)]
    pub fn visibility(
        &self,
        (to_eye, n_dot_v): (Vec3<R>, R),
        (towards, n_dot_l): (Vec3<R>, R),
        alphas: Alphas<R>,
    ) -> R {
        let sum = n_dot_l * self.masked(to_eye, n_dot_v, alphas)
            + n_dot_v * self.masked(towards, n_dot_l, alphas);
        0.5 / sum.max(1e-6)
    }

    /// ‖(αt·t·d, αb·b·d, n·d)‖ of a direction d.
    #[inline(always)]
    fn masked(&self, direction: Vec3<R>, cosine: R, alphas: Alphas<R>) -> R {
        let along = self.tangent.dot(direction) * alphas.tangent;
        let across = self.bitangent.dot(direction) * alphas.bitangent;
        Vec3::new(along, across, cosine).length()
    }

    /// The normal by which the surroundings are mirrored: bent towards the eye across the grooves,
    /// as the extension's sample renderer does (after Filament).
    #[inline(always)]
    pub fn bent_normal(&self, normal: Vec3<R>, to_eye: Vec3<R>, roughness: R) -> Vec3<R> {
        let across = self.bitangent.cross(to_eye);
        let facing = across.cross(self.bitangent);
        let kept = 1.0 - self.strength * (1.0 - roughness);
        let squared = kept * kept;
        facing.mix(normal, squared * squared).normalize()
    }

    /// Cosine and perceptual roughness at which a surface without grooves reflects about the same
    /// share of uniform light, and the share by which this is uncertain.
    ///
    /// ```text
    ///   α² = (αt² + αb²) ÷ 2
    ///   cos = n·v ÷ √((n·v)² + (t·v)² + (αb ÷ αt)²(b·v)²)  as the rough direction sees it
    /// ```
    ///
    /// Compared with integrals (roughness 0.1 to 0.85), the share that such a surface loses is at
    /// most 0.067·s too great and 0.036 too small. What is reflected between facets is computed for
    /// a loss that is 0.045·s less, so that no surface reflects 1 % more than it gets.
    #[inline(always)]
    pub fn equivalent(&self, (to_eye, n_dot_v): (Vec3<R>, R), alphas: Alphas<R>) -> Equivalent<R> {
        const UNCERTAIN: f32 = 0.045;
        let Alphas { tangent, bitangent } = alphas;
        let along = self.tangent.dot(to_eye);
        let across = self.bitangent.dot(to_eye) * (bitangent / tangent);
        let length = Vec3::new(along, across, n_dot_v).length();
        let mean = (tangent * tangent + bitangent * bitangent) * 0.5;
        Equivalent {
            cosine: n_dot_v / length,
            roughness: mean.sqrt().sqrt(),
            uncertain: self.strength * UNCERTAIN,
        }
    }
}

/// A surface without grooves that reflects about as much.
#[derive(Debug, Clone, Copy)]
pub struct Equivalent<R> {
    pub cosine: R,
    /// Perceptual.
    pub roughness: R,
    /// By how much less light between facets is assumed to be lost.
    pub uncertain: R,
}
