//! Furnaces: what each layer alone reflects of uniform white light.
//!
//! | layer | in white surroundings | by lights from everywhere |
//! |---|---|---|
//! | GGX, metal | all | all |
//! | GGX and diffuse, dielectric | all | all |
//! | diffuse | all | all |
//! | clear coat over them | all | at most all; loses up to 21 % |
//! | sheen over them | all | all |
//! | grooves, metal | loses up to 13 % · strength | at most all; loses up to 12 % |
//! | film | at most all: a film reflects what its base and thickness say | the same |
//! | transmission | all, with what comes from behind | all |
//!
//! The bound is 1 % everywhere. Losses have these reasons: what is below a clear coat is reduced by
//! the Fresnel term at the angle of the view, as KHR_materials_clearcoat asks, while the coat's
//! lobe reflects by the half vector's, which is less at grazing angles; the light between the
//! facets of grooved surfaces is an estimate on the safe side (`Grooves::equivalent`).

use super::super::anisotropy::Grooves;
use super::super::iridescence::Film;
use super::super::lights::{PbrLight, PbrSource};
use super::super::reflection::{Coat, Fibres, Leaving, PbrPoint};
use super::{environment, point};
use crate::environment::EnvironmentMap;
use crate::shading::lighting::Directional;
use crate::transforms::round_to_f32;
use estampe::Vec3;
use estampe_reference::pbr;

const COSINES: [f32; 5] = [0.1, 0.3, 0.6, 0.85, 1.0];
const ROUGHNESSES: [f32; 6] = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0];

const WHITE: [f32; 3] = [1.0; 3];

fn vec(channels: [f32; 3]) -> Vec3<f32> {
    let [x, y, z] = channels;
    Vec3::new(x, y, z)
}

/// A layer alone, and the shares of light that it may lose in white surroundings and under lights.
struct Layer {
    name: &'static str,
    point: PbrPoint<f32>,
    loss: [f32; 2],
}

fn layers(n_dot_v: f32, roughness: f32) -> Vec<Layer> {
    let metal = point(n_dot_v, roughness);
    let dielectric = PbrPoint {
        diffuse: vec(WHITE),
        f0: vec([0.04; 3]),
        ..metal
    };
    let layer = |name, point, loss| Layer { name, point, loss };
    let mut layers = vec![
        layer("metal", metal, [0.0, 0.0]),
        layer("dielectric", dielectric, [0.0, 0.0]),
        layer(
            "diffuse",
            PbrPoint {
                f0: vec([0.0; 3]),
                f90: 0.0,
                ..dielectric
            },
            [0.0, 0.0],
        ),
        layer(
            "coat",
            PbrPoint {
                clearcoat: Some(Coat {
                    factor: 1.0,
                    roughness: roughness.max(0.3),
                    normal: metal.normal,
                }),
                ..dielectric
            },
            [0.0, 0.21],
        ),
        layer(
            "sheen",
            PbrPoint {
                sheen: Some(Fibres {
                    color: vec(WHITE),
                    roughness: roughness.max(0.3),
                }),
                ..dielectric
            },
            [0.0, 0.02],
        ),
        layer(
            "film",
            PbrPoint {
                film: Some(Film {
                    factor: 1.0,
                    ior: 1.3,
                    thickness_nm: 400.0,
                }),
                ..dielectric
            },
            // It is not white: see below.
            [1.0, 1.0],
        ),
        layer(
            "transmission",
            PbrPoint {
                diffuse: vec([0.3; 3]),
                passing: Some(vec([0.7; 3])),
                ..dielectric
            },
            [0.0, 0.0],
        ),
    ];
    for (strength, angle) in [(0.3, 0.0), (0.6, 0.8), (1.0, 0.0), (1.0, 0.8), (1.0, 1.6)] {
        let (sin, cos) = libm::sincosf(angle);
        let grooves = Grooves {
            tangent: vec([cos, sin, 0.0]),
            bitangent: vec([-sin, cos, 0.0]),
            strength,
        };
        layers.push(layer(
            "grooves",
            PbrPoint {
                grooves: Some(grooves),
                ..metal
            },
            [0.13 * strength, 0.12],
        ));
    }
    layers
}

/// The light that a point reflects, and the share that passes of white light from behind.
fn all_light(Leaving { reflected, passing }: Leaving<f32>) -> [f32; 3] {
    let passing = passing.unwrap_or(vec([0.0; 3]));
    [
        reflected.x + passing.x,
        reflected.y + passing.y,
        reflected.z + passing.z,
    ]
}

#[track_caller]
fn check(what: &str, light: [f32; 3], loss: f32) {
    for channel in light {
        assert!(channel < 1.01, "{what} gains: {channel}");
        assert!(channel > 0.99 - loss, "{what} loses: {channel}");
    }
}

/// White surfaces in white surroundings vanish.
#[test]
fn white_surroundings_keep_their_energy() {
    let white = environment(&EnvironmentMap::uniform(WHITE));
    for n_dot_v in COSINES {
        for roughness in ROUGHNESSES {
            for Layer { name, point, loss } in layers(n_dot_v, roughness) {
                let light = all_light(point.leaving(&white, &[]));
                let what = format!("{name}, n·v {n_dot_v}, roughness {roughness}");
                check(&what, light, loss[0]);
            }
        }
    }
}

/// The same furnace by many lights, without surroundings: each direction's share of 4π.
#[test]
fn lights_from_everywhere_are_a_furnace_too() {
    let black = environment(&EnvironmentMap::uniform([0.0; 3]));
    for n_dot_v in [0.3, 0.7, 1.0] {
        for roughness in [0.5, 0.8, 1.0] {
            for Layer { name, point, loss } in layers(n_dot_v, roughness) {
                let passing = all_light(Leaving {
                    reflected: vec([0.0; 3]),
                    ..point.leaving(&black, &[])
                });
                let sums = pbr::over_hemisphere(160, |direction| {
                    let light = PbrLight {
                        source: PbrSource::Directional(Directional(direction.map(round_to_f32))),
                        color: WHITE,
                        shadow_map: None,
                    };
                    let light = point.leaving(&black, &[light]).reflected;
                    [light.x, light.y, light.z].map(f64::from)
                });
                let sums = sums.map(round_to_f32);
                let light = std::array::from_fn(|c| sums[c] + passing[c]);
                let what = format!("{name}, n·v {n_dot_v}, roughness {roughness}");
                check(&what, light, loss[1]);
            }
        }
    }
}

/// A film on a white metal takes away what interference takes away, and no channel gains: the sum
/// is at most 1, and the mean is that of the film's reflectance at the eye's angle.
#[test]
fn films_reflect_what_they_say() {
    let white = environment(&EnvironmentMap::uniform(WHITE));
    for n_dot_v in COSINES {
        for thickness_nm in [100.0, 250.0, 400.0, 800.0] {
            let film = Film {
                factor: 1.0,
                ior: 1.6,
                thickness_nm,
            };
            let base = vec([0.9, 0.6, 0.3]);
            let point = PbrPoint {
                f0: base,
                film: Some(film),
                ..point(n_dot_v, 0.0)
            };
            let light = all_light(point.leaving(&white, &[]));
            let right = film.fresnel(base, n_dot_v);
            for (own, right) in light.into_iter().zip([right.x, right.y, right.z]) {
                // A reflectance that falls towards grazing angles has no F0: it becomes 0.
                let grazing = super::super::brdf::schlick(n_dot_v);
                let right = right.max(grazing);
                assert!(
                    (own - right).abs() < 0.01,
                    "n·v {n_dot_v}: {own}, not {right}"
                );
            }
        }
    }
}
