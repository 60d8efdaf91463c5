//! The light that a point of a physically based surface reflects.
//!
//! ```text
//!   lobes    clear coat      F0 0.04
//!            sheen           takes its share of the light from what is below
//!            GGX             F0, F90, or a thin film; light between facets is added
//!                            (C. Fdez-Agüera 2019)
//!            diffuse         what GGX does not reflect, times the base colour
//!            passing         the share of the diffuse light that passes through instead
//! ```
//!
//! A dielectric and a metal are mixed by their parameters: F0 is mixed, and the diffuse colour is
//! that of the dielectric's share.
//!
//! What is spread, between facets and diffusely, has the weight that it has in uniform light, so
//! that no surface reflects more than it gets: the factor 1 − F(v·h) of appendix B's sample gives
//! too much at grazing angles.

use super::anisotropy::Grooves;
use super::brdf;
use super::environment::{DirectionalAlbedo, EnvironmentLight};
use super::iridescence::Film;
use super::lights::PbrLight;
use crate::shading::shadow::Visibilities;
use estampe::{Real, Vec3};
use std::f32::consts::FRAC_1_PI;

/// A point of a surface with its reflectance.
#[derive(Debug, Clone, Copy)]
pub struct PbrPoint<R> {
    /// In view space.
    pub position: Vec3<R>,
    /// Unit normal.
    pub normal: Vec3<R>,
    /// Unit direction to the eye.
    pub to_eye: Vec3<R>,
    /// Diffuse colour.
    pub diffuse: Vec3<R>,
    /// The colour of light that passes through.
    pub passing: Option<Vec3<R>>,
    /// Reflectance at normal incidence.
    pub f0: Vec3<R>,
    /// Reflectance at grazing incidence.
    pub f90: R,
    /// Perceptual.
    pub roughness: R,
    /// The share of the light from all around that arrives.
    pub occlusion: R,
    pub clearcoat: Option<Coat<R>>,
    pub sheen: Option<Fibres<R>>,
    pub grooves: Option<Grooves<R>>,
    pub film: Option<Film<R>>,
    /// The shares of the lights that reach it.
    pub visibilities: Visibilities<R>,
}

/// A clear layer at a point.
#[derive(Debug, Clone, Copy)]
pub struct Coat<R> {
    pub factor: R,
    pub roughness: R,
    /// Unit normal.
    pub normal: Vec3<R>,
}

/// Fibres at a point.
#[derive(Debug, Clone, Copy)]
pub struct Fibres<R> {
    pub color: Vec3<R>,
    pub roughness: R,
}

/// The light that leaves a point towards the eye.
#[derive(Debug, Clone, Copy)]
pub struct Leaving<R> {
    pub reflected: Vec3<R>,
    /// The share of the light from behind; `None` if none passes.
    pub passing: Option<Vec3<R>>,
}

/// What several lobes need, computed once.
struct Shared<R> {
    n_dot_v: R,
    /// Of uniform light: what GGX reflects at once, what is reflected between facets, and the
    /// diffuse rest times its colour.
    single: Vec3<R>,
    multiple: Vec3<R>,
    diffuse: Vec3<R>,
    /// What GGX leaves.
    rest: Vec3<R>,
    /// Of the coat and the sheen, by which what is below is multiplied.
    below: R,
    /// Reflected by the coat at the eye's angle.
    coat: Option<(Coat<R>, R)>,
    /// The sheen with its share of the light.
    sheen: Option<(Fibres<R>, R)>,
}

/// F0 of a clear coat, of index 1.5.
const COAT_F0: f32 = 0.04;

impl<R: Real> PbrPoint<R> {
    /// The light that leaves towards the eye.
    #[inline(always)]
    pub fn leaving(&self, environment: &EnvironmentLight, lights: &[PbrLight]) -> Leaving<R> {
        // Functions of their own: in one, the compiler took minutes for the shader.
        let shared = self.roughness.out_of_line(
            #[inline(always)]
            || self.shared(environment),
        );
        let mut sum = self.roughness.out_of_line(
            #[inline(always)]
            || self.environment_light(environment, &shared),
        );
        for light in lights {
            sum += self.roughness.out_of_line(
                #[inline(always)]
                || self.punctual_light(light, &shared),
            );
        }
        let mut passing = None;
        if let Some(color) = self.passing {
            passing = Some(color * shared.rest * shared.below);
        }
        Leaving {
            reflected: sum,
            passing,
        }
    }

    #[inline(always)]
    fn shared(&self, environment: &EnvironmentLight) -> Shared<R> {
        let n_dot_v = self.normal.dot(self.to_eye).clamp(1e-4, 1.0);
        let one = n_dot_v.splat(1.0);
        let mut below = one;
        let sheen = match self.sheen {
            Some(fibres) => {
                let share = environment.albedo(n_dot_v, fibres.roughness).sheen;
                let strongest = fibres.color.x.max(fibres.color.y).max(fibres.color.z);
                below *= one - strongest * share;
                Some((fibres, share))
            }
            None => None,
        };
        let coat = match self.clearcoat {
            Some(coat) => {
                let cosine = coat.normal.dot(self.to_eye).clamp(1e-4, 1.0);
                let fresnel = brdf::schlick(cosine) * (1.0 - COAT_F0) + COAT_F0;
                let share = fresnel * coat.factor;
                below *= one - share;
                Some((coat, share))
            }
            None => None,
        };
        let (f0, f90) = self.seen_reflectance(n_dot_v);
        let (albedo, uncertain) = match self.grooves {
            Some(grooves) => {
                let alphas = grooves.alphas(brdf::alpha(self.roughness));
                let like = grooves.equivalent((self.to_eye, n_dot_v), alphas);
                let albedo = environment.albedo(like.cosine, like.roughness);
                (albedo, Some(like.uncertain))
            }
            None => (environment.albedo(n_dot_v, self.roughness), None),
        };
        let DirectionalAlbedo { scale, bias, .. } = albedo;
        let single = f0 * scale + Vec3::repeat(bias * f90);
        let mut lost = one - (scale + bias);
        if let Some(uncertain) = uncertain {
            lost = (lost - uncertain).max(0.0);
        }
        let mean = f0 + (Vec3::repeat(one) - f0) * (1.0 / 21.0);
        let multiple = Vec3::new(
            between_facets(single.x, mean.x, lost),
            between_facets(single.y, mean.y, lost),
            between_facets(single.z, mean.z, lost),
        );
        let mut rest = Vec3::repeat(one) - single - multiple;
        if let Some(film) = self.film {
            // The same for each channel, or what is below would have the complementary colour.
            let least = rest.x.min(rest.y).min(rest.z);
            rest = rest.mix(Vec3::repeat(least), film.factor);
        }
        Shared {
            n_dot_v,
            single,
            multiple,
            diffuse: self.diffuse * rest,
            rest,
            below,
            coat,
            sheen,
        }
    }

    /// F0 and F90 for light from all around. A film has the F0 with which Schlick's term gives what
    /// the film reflects at the eye's angle.
    #[inline(always)]
    fn seen_reflectance(&self, n_dot_v: R) -> (Vec3<R>, R) {
        let Some(film) = self.film else {
            return (self.f0, self.f90);
        };
        let weight = brdf::schlick(n_dot_v);
        let seen = film.fresnel(self.f0, n_dot_v);
        let scale = 1.0 / (1.0 - weight);
        let f0 = (seen - Vec3::repeat(weight)) * scale;
        let f0 = Vec3::new(f0.x.saturate(), f0.y.saturate(), f0.z.saturate());
        (
            self.f0.mix(f0, film.factor),
            self.f90.mix(weight.splat(1.0), film.factor),
        )
    }

    /// The light from all around.
    #[inline(always)]
    fn environment_light(&self, environment: &EnvironmentLight, shared: &Shared<R>) -> Vec3<R> {
        // The lobe of a rough surface leans towards the normal.
        let mirrored = (-self.to_eye).reflect(self.normal);
        let turned = match self.grooves {
            Some(grooves) => {
                let bent = grooves.bent_normal(self.normal, self.to_eye, self.roughness);
                (-self.to_eye).reflect(bent)
            }
            None => mirrored,
        };
        let lobe = turned.mix(self.normal, self.roughness * self.roughness);
        let radiance = environment.radiance(lobe, self.roughness);
        let mut irradiance = environment.irradiance(self.normal);
        let mut seen = specular_occlusion(shared.n_dot_v, self.occlusion, self.roughness);
        if let Some(shaded) = environment.shaded(&self.visibilities) {
            irradiance = shaded.irradiance(irradiance, self.normal);
            seen *= shaded.mirrored(environment.irradiance(mirrored), mirrored);
        }
        let spread = irradiance * (shared.multiple + shared.diffuse) * self.occlusion;
        let mut sum = radiance * shared.single * seen + spread;
        sum *= shared.below;
        if let Some((fibres, share)) = shared.sheen {
            let around = environment.radiance(mirrored, fibres.roughness.max(0.5));
            sum += around * fibres.color * (share * self.occlusion);
        }
        if let Some((coat, share)) = shared.coat {
            let mirrored = (-self.to_eye).reflect(coat.normal);
            sum += environment.radiance(mirrored, coat.roughness) * (share * seen);
        }
        sum
    }

    /// The light of one light.
    #[inline(always)]
    fn punctual_light(&self, light: &PbrLight, shared: &Shared<R>) -> Vec3<R> {
        let (towards, illuminance) = light.arrive(self.position);
        let zero = shared.n_dot_v.splat(0.0);
        let half = (towards + self.to_eye).normalize();
        let n_dot_l = self.normal.dot(towards);
        let v_dot_h = self.to_eye.dot(half).saturate();
        let lit = n_dot_l.max(zero);

        let alpha = brdf::alpha(self.roughness);
        let across = self.normal.cross(half);
        let n_dot_h = self.normal.dot(half).saturate();
        let lobe = match self.grooves {
            Some(grooves) => {
                let alphas = grooves.alphas(alpha);
                let eye = (self.to_eye, shared.n_dot_v);
                grooves.density(half, n_dot_h, alphas)
                    * grooves.visibility(eye, (towards, lit), alphas)
            }
            None => {
                brdf::density_ggx(n_dot_h, across.dot(across), alpha)
                    * brdf::visibility_ggx(lit, shared.n_dot_v, alpha)
            }
        };
        let weight = brdf::schlick(v_dot_h);
        let mut fresnel = self.f0 + (Vec3::repeat(self.f90) - self.f0) * weight;
        if let Some(film) = self.film {
            fresnel = fresnel.mix(film.fresnel(self.f0, v_dot_h), film.factor);
        }
        // Light between facets leaves evenly, as diffuse light does.
        let spread = (shared.multiple + shared.diffuse) * FRAC_1_PI;
        let mut reflectance = (spread + fresnel * lobe) * shared.below;
        if let Some((fibres, _)) = shared.sheen {
            let lobe = lit.out_of_line(
                #[inline(always)]
                || {
                    let alpha = brdf::sheen_alpha(fibres.roughness);
                    brdf::density_sheen(n_dot_h, alpha)
                        * brdf::visibility_sheen(lit, shared.n_dot_v)
                },
            );
            reflectance += fibres.color * lobe;
        }
        let mut sum = illuminance * reflectance * lit;
        if let Some((coat, _)) = shared.coat {
            let alpha = brdf::alpha(coat.roughness);
            let across = coat.normal.cross(half);
            let coat_lit = coat.normal.dot(towards).max(zero);
            let coat_seen = coat.normal.dot(self.to_eye).clamp(1e-4, 1.0);
            let cosine = coat.normal.dot(half).saturate();
            let lobe = brdf::density_ggx(cosine, across.dot(across), alpha)
                * brdf::visibility_ggx(coat_lit, coat_seen, alpha);
            let fresnel = weight * (1.0 - COAT_F0) + COAT_F0;
            sum += illuminance * (lobe * fresnel * coat.factor * coat_lit);
        }
        if let Some(share) = self.visibilities.of(light.shadow_map) {
            sum *= share;
        }
        // A half vector between opposite directions is NaN.
        let black = Vec3::repeat(zero);
        Vec3::select(n_dot_l.gt(zero), sum, black)
    }
}

/// The share of uniform light that is reflected between facets, given what GGX reflects at once,
/// the mean reflectance, and what is lost with a reflectance of 1.
#[inline(always)]
fn between_facets<R: Real>(single: R, mean: R, lost: R) -> R {
    single * mean / (1.0 - mean * lost) * lost
}

/// The share of mirrored light that arrives where a share of all light does (S. Lagarde, C. de
/// Rousiers, "Moving Frostbite to Physically Based Rendering", 2014).
#[inline(always)]
fn specular_occlusion<R: Real>(n_dot_v: R, occlusion: R, roughness: R) -> R {
    let exponent = (roughness * -16.0 - 1.0).exp2();
    let seen = (n_dot_v + occlusion).pow(exponent) - 1.0 + occlusion;
    R::select(occlusion.lt(1.0), seen.saturate(), occlusion)
}
