//! Random materials of all layers against the oracle, in f64 and by random directions.
//!
//! | light | bound |
//! |---|---|
//! | one light | the oracle's function: 1 % of it, and the error of the light between facets ÷ π |
//! | uneven surroundings | four deviations of the estimate, and the split sum |
//!
//! The error between facets is 0.01; with grooves 0.067 · strength + 0.036
//! ([`Grooves::equivalent`]), with a film 0.1 · factor, whose F0 is that of the eye's angle. The
//! split sum (light and reflectance apart, view along the normal) is off by some hundredths of the
//! light's gradient; the bounds are the measured errors, rounded up, and are stated where they are.

use super::super::anisotropy::Grooves;
use super::super::iridescence::Film;
use super::super::lights::{PbrLight, PbrSource};
use super::super::reflection::{Coat, Fibres, PbrPoint};
use super::{environment, point};
use crate::environment::EnvironmentMap;
use crate::shading::lighting::Directional;
use crate::transforms::round_to_f32;
use estampe::Vec3;
use estampe_reference::pbr::{self, Layered};
use fastrand::Rng;

fn vec(channels: [f32; 3]) -> Vec3<f32> {
    let [x, y, z] = channels;
    Vec3::new(x, y, z)
}

/// A random material as the shader has it and as the oracle has it, seen at a random angle.
struct Random {
    point: PbrPoint<f32>,
    material: Layered,
    view: [f64; 3],
    /// The greatest error of what is spread: between facets, and diffusely below.
    spread: f64,
}

fn random(rng: &mut Rng) -> Random {
    let number = |rng: &mut Rng, least: f32, most: f32| least + rng.f32() * (most - least);
    let color = |rng: &mut Rng| [rng.f32(), rng.f32(), rng.f32()];
    let n_dot_v = number(rng, 0.35, 1.0);
    let roughness = number(rng, 0.35, 1.0);
    let metallic = rng.f32();
    let base = color(rng);
    let mix = |a: f32, b: f32| a + (b - a) * metallic;
    let f0 = base.map(|channel| mix(0.04, channel));
    let diffuse = base.map(|channel| channel * (1.0 - metallic));
    let has = |rng: &mut Rng| rng.bool();
    let mut own = PbrPoint {
        f0: vec(f0),
        diffuse: vec(diffuse),
        ..point(n_dot_v, roughness)
    };
    let mut material = Layered {
        diffuse: diffuse.map(f64::from),
        f0: f0.map(f64::from),
        f90: 1.0,
        alpha: f64::from(roughness * roughness),
        grooves: None,
        film: None,
        sheen: None,
        coat: None,
    };
    let mut spread = 0.01;
    if has(rng) {
        let (strength, angle) = (rng.f32(), number(rng, -1.6, 1.6));
        let (sin, cos) = libm::sincosf(angle);
        own.grooves = Some(Grooves {
            tangent: vec([cos, sin, 0.0]),
            bitangent: vec([-sin, cos, 0.0]),
            strength,
        });
        let (strength, angle_rad) = (f64::from(strength), f64::from(angle));
        material.grooves = Some(pbr::Grooves {
            strength,
            angle_rad,
        });
        spread += 0.067 * strength + 0.036;
    }
    if has(rng) {
        let film = Film {
            factor: rng.f32(),
            ior: number(rng, 1.1, 2.0),
            thickness_nm: number(rng, 50.0, 900.0),
        };
        own.film = Some(film);
        material.film = Some(pbr::Film {
            factor: f64::from(film.factor),
            ior: f64::from(film.ior),
            thickness_nm: f64::from(film.thickness_nm),
        });
        spread += 0.1 * f64::from(film.factor);
    }
    if has(rng) {
        let (color, roughness) = (color(rng), number(rng, 0.3, 1.0));
        own.sheen = Some(Fibres {
            color: vec(color),
            roughness,
        });
        material.sheen = Some(pbr::Fibres {
            color: color.map(f64::from),
            alpha: f64::from(roughness * roughness),
        });
    }
    if has(rng) {
        let (factor, roughness) = (rng.f32(), number(rng, 0.3, 1.0));
        own.clearcoat = Some(Coat {
            factor,
            roughness,
            normal: own.normal,
        });
        material.coat = Some(pbr::Coat {
            factor: f64::from(factor),
            alpha: f64::from(roughness * roughness),
        });
    }
    Random {
        view: [own.to_eye.x, own.to_eye.y, own.to_eye.z].map(f64::from),
        point: own,
        material,
        spread,
    }
}

/// 60 materials under 20 lights each.
#[test]
fn single_lights_are_reflected_as_by_the_oracle() {
    let mut rng = Rng::with_seed(21);
    let black = environment(&EnvironmentMap::uniform([0.0; 3]));
    for number in 0..60 {
        let Random {
            point,
            material,
            view,
            spread,
        } = random(&mut rng);
        let directions: Vec<[f64; 3]> = (0..20)
            .map(|_| {
                let (cosine, turn) = (0.02 + 0.98 * rng.f64(), rng.f64() * std::f64::consts::TAU);
                let (sin, cos) = libm::sincos(turn);
                let sine = (1.0 - cosine * cosine).sqrt();
                [sine * cos, sine * sin, cosine]
            })
            .collect();
        let right = material.of_lights(view, &directions);
        for (direction, right) in directions.into_iter().zip(right) {
            let light = PbrLight {
                source: PbrSource::Directional(Directional(direction.map(round_to_f32))),
                color: [1.0; 3],
                shadow_map: None,
            };
            let own = point.leaving(&black, &[light]).reflected;
            for (own, right) in [own.x, own.y, own.z].into_iter().zip(right) {
                let error = (f64::from(own) - right).abs();
                let bound = 0.01 * right + spread * direction[2] / std::f64::consts::PI;
                assert!(
                    error < bound,
                    "material {number} under {direction:?}: {own}, not {right}; {material:?}"
                );
            }
        }
    }
}

/// 40 materials in surroundings that change by half across them, against 20,000 random directions
/// each: four standard deviations (a false alarm in 10⁴ numbers), 0.03, the error of what is
/// spread, and 0.05 of the fibres' colour, whose lobe is looked up around the mirrored direction.
#[test]
fn surroundings_are_reflected_as_random_directions_say() {
    let radiance = |[x, y, z]: [f64; 3]| [1.0 + 0.25 * x, 1.0 + 0.25 * y, 0.9 + 0.1 * z];
    let (width, height) = (64_u16, 32_u16);
    let mut panorama = Vec::new();
    for row in 0..height {
        for column in 0..width {
            let v = (f64::from(row) + 0.5) / f64::from(height) * std::f64::consts::PI;
            let u = (0.5 - (f64::from(column) + 0.5) / f64::from(width)) * std::f64::consts::TAU;
            let ((sin, cos), (sin_u, cos_u)) = (libm::sincos(v), libm::sincos(u));
            panorama.extend(radiance([sin * sin_u, cos, sin * cos_u]).map(round_to_f32));
        }
    }
    let workers = estampe_scene::Workers::ONE;
    let map = EnvironmentMap::from_panorama(width.into(), height.into(), &panorama, workers);
    let light = environment(&map.expect("a panorama"));
    let mut rng = Rng::with_seed(22);
    let mut uniform = Rng::with_seed(23);
    for number in 0..40 {
        let Random {
            point,
            material,
            view,
            spread,
        } = random(&mut rng);
        let mut numbers = || uniform.f64();
        let right = pbr::reflected(&material, view, 20_000, &mut numbers, &radiance);
        let own = point.leaving(&light, &[]).reflected;
        let fibres = material.sheen.map_or([0.0; 3], |sheen| sheen.color);
        let fibres = fibres.into_iter().fold(0.0, f64::max);
        for (c, own) in [own.x, own.y, own.z].into_iter().enumerate() {
            let error = (f64::from(own) - right.mean[c]).abs();
            let bound = 4.0 * right.deviation[c] + 0.03 + spread + 0.05 * fibres;
            assert!(
                error < bound,
                "material {number}, channel {c}: {own}, not {} ± {}; {material:?}",
                right.mean[c],
                right.deviation[c]
            );
        }
    }
}
