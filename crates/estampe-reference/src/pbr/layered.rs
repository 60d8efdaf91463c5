//! A material of all layers, as a function of two directions.
//!
//! ```text
//!   f = below · ( F·D·V + (between facets + diffuse colour · rest) ÷ π ) + sheen + clear coat
//!
//!   below           what sheen and coat leave, at the angle of the view
//!   between facets  single · mean ÷ (1 − mean·lost) · lost             C. Fdez-Agüera 2019
//!   rest            1 − single − between facets; of a film the least of the channels
//!   single          ∫ F·D·V n·l,  lost = 1 − ∫ D·V n·l,  mean = 2 ∫ F(c)·c dc
//! ```

use super::{
    Direction, density_ggx, density_sheen, dot, film, fresnel, normalised, over_hemisphere,
    visibility_ggx, visibility_sheen,
};
use std::f64::consts::PI;

/// A material of all layers.
#[derive(Debug, Clone, PartialEq)]
pub struct Layered {
    /// Colour of diffuse light.
    pub diffuse: [f64; 3],
    /// Reflectance at normal incidence.
    pub f0: [f64; 3],
    /// Reflectance at grazing incidence.
    pub f90: f64,
    /// The α of GGX.
    pub alpha: f64,
    /// Roughness that depends on the direction.
    pub grooves: Option<Grooves>,
    /// A thin film.
    pub film: Option<Film>,
    /// Fibres on top.
    pub sheen: Option<Fibres>,
    /// A clear layer on top.
    pub coat: Option<Coat>,
}

/// Roughness that depends on the direction (KHR_materials_anisotropy).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grooves {
    /// 0 to 1.
    pub strength: f64,
    /// The angle of the tangent from +X towards +Y.
    pub angle_rad: f64,
}

/// A thin film (KHR_materials_iridescence).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Film {
    /// The share of the film in the reflectance.
    pub factor: f64,
    /// Index of refraction.
    pub ior: f64,
    /// Thickness.
    pub thickness_nm: f64,
}

/// Fibres (KHR_materials_sheen).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fibres {
    /// Colour.
    pub color: [f64; 3],
    /// The α of the fibres.
    pub alpha: f64,
}

/// A clear layer (KHR_materials_clearcoat), of index 1.5.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coat {
    /// 0 to 1.
    pub factor: f64,
    /// The α of GGX.
    pub alpha: f64,
}

/// What depends on the view alone.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    below: f64,
    /// Between facets and diffuse, for uniform light.
    spread: [f64; 3],
}

impl Layered {
    /// The reflectance of light from `light` towards `view`, times the cosine of `light`, by
    /// channel, for each of the light directions.
    #[must_use]
    pub fn of_lights(&self, view: Direction, lights: &[Direction]) -> Vec<[f64; 3]> {
        let seen = self.seen(view);
        let value = |&light: &Direction| self.value(&seen, view, light);
        lights.iter().map(value).collect()
    }

    /// The α along the tangent and along the bitangent, and both directions.
    pub(super) fn axes(&self) -> ([f64; 2], [Direction; 2]) {
        let Some(Grooves {
            strength,
            angle_rad,
        }) = self.grooves
        else {
            return ([self.alpha; 2], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        };
        let (sin, cos) = angle_rad.sin_cos();
        let stretched = self.alpha + (1.0 - self.alpha) * strength * strength;
        ([stretched, self.alpha], [[cos, sin, 0.0], [-sin, cos, 0.0]])
    }

    /// D·V of GGX.
    fn lobe(&self, view: Direction, light: Direction) -> f64 {
        let half = normalised([0, 1, 2].map(|axis| view[axis] + light[axis]));
        let ([at, ab], [t, b]) = self.axes();
        // The slopes of the facet in units of both α.
        let stretched = (dot(t, half) / at).powi(2) + (dot(b, half) / ab).powi(2);
        let density = 1.0 / (PI * at * ab * (stretched + half[2] * half[2]).powi(2));
        let lambda = |w: Direction| {
            let tangent2 = ((at * dot(t, w)).powi(2) + (ab * dot(b, w)).powi(2)) / (w[2] * w[2]);
            ((1.0 + tangent2).sqrt() - 1.0) / 2.0
        };
        density / ((1.0 + lambda(view) + lambda(light)) * 4.0 * view[2] * light[2])
    }

    /// F of GGX, or of the film, by channel.
    fn fresnel(&self, cosine: f64) -> [f64; 3] {
        let plain = self.f0.map(|f0| fresnel(f0, self.f90, cosine));
        let Some(Film {
            factor,
            ior,
            thickness_nm,
        }) = self.film
        else {
            return plain;
        };
        let of_film = film::reflectance(ior, thickness_nm, self.f0, cosine);
        std::array::from_fn(|c| plain[c] + (of_film[c] - plain[c]) * factor)
    }

    pub(super) fn seen(&self, view: Direction) -> Seen {
        let single = over_hemisphere(160, |light| {
            let half = normalised([0, 1, 2].map(|axis| view[axis] + light[axis]));
            let lobe = self.lobe(view, light) * light[2];
            self.fresnel(dot(view, half)).map(|f| f * lobe)
        });
        let [kept, ..] =
            over_hemisphere(160, |light| [self.lobe(view, light) * light[2], 0.0, 0.0]);
        let lost = (1.0 - kept).max(0.0);
        let mut mean = [0.0; 3];
        for step in 0..64 {
            let cosine = (f64::from(step) + 0.5) / 64.0;
            let of_cosine = self.fresnel(cosine);
            for c in 0..3 {
                mean[c] += of_cosine[c] * 2.0 * cosine / 64.0;
            }
        }
        let multiple: [f64; 3] =
            std::array::from_fn(|c| single[c] * mean[c] / (1.0 - mean[c] * lost) * lost);
        let mut rest: [f64; 3] = std::array::from_fn(|c| 1.0 - single[c] - multiple[c]);
        if let Some(film) = self.film {
            let least = rest.into_iter().fold(f64::INFINITY, f64::min);
            rest = rest.map(|share| share + (least - share) * film.factor);
        }
        let mut below = 1.0;
        if let Some(fibres) = self.sheen {
            let [share, ..] = over_hemisphere(160, |light| {
                [fibres_term(&fibres, view, light) * light[2], 0.0, 0.0]
            });
            let strongest = fibres.color.into_iter().fold(0.0, f64::max);
            below *= 1.0 - strongest * share;
        }
        if let Some(coat) = self.coat {
            below *= 1.0 - coat.factor * fresnel(0.04, 1.0, view[2]);
        }
        Seen {
            below,
            spread: std::array::from_fn(|c| multiple[c] + self.diffuse[c] * rest[c]),
        }
    }

    /// The reflectance times the light's cosine.
    pub(super) fn value(&self, seen: &Seen, view: Direction, light: Direction) -> [f64; 3] {
        if light[2] <= 0.0 || view[2] <= 0.0 {
            return [0.0; 3];
        }
        let half = normalised([0, 1, 2].map(|axis| view[axis] + light[axis]));
        let v_dot_h = dot(view, half);
        let (lobe, f) = (self.lobe(view, light), self.fresnel(v_dot_h));
        std::array::from_fn(|c| {
            let mut sum = seen.below * (f[c] * lobe + seen.spread[c] / PI);
            if let Some(fibres) = &self.sheen {
                sum += fibres.color[c] * fibres_term(fibres, view, light);
            }
            if let Some(coat) = &self.coat {
                sum += coat.factor
                    * fresnel(0.04, 1.0, v_dot_h)
                    * density_ggx(half[2], coat.alpha)
                    * visibility_ggx(light[2], view[2], coat.alpha);
            }
            sum * light[2]
        })
    }
}

/// D·V of fibres.
fn fibres_term(fibres: &Fibres, view: Direction, light: Direction) -> f64 {
    let half = normalised([0, 1, 2].map(|axis| view[axis] + light[axis]));
    density_sheen(half[2], fibres.alpha) * visibility_sheen(light[2], view[2])
}
