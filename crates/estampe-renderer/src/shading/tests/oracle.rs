//! The sum of the light on random points against the oracle in f64.

use super::*;
use crate::shading::lighting::Positional;
use estampe_reference::illumination::{self as oracle, Light, Material, Source, Specular};
use fastrand::Rng;

/// A random case, in f32 for the shader; [`Case::exact`] has the same numbers in f64.
struct Case {
    lights: Lights,
    ambient: f32,
    gloss: Gloss,
    base: [f32; 3],
    point: SurfacePoint<f32>,
}

fn between(random: &mut Rng, low: f32, high: f32) -> f32 {
    low + (high - low) * random.f32()
}

fn vector(random: &mut Rng, size: f32) -> [f32; 3] {
    [(); 3].map(|()| between(random, -size, size))
}

/// A unit vector.
fn direction(random: &mut Rng) -> [f32; 3] {
    loop {
        let v = glam::Vec3::from(vector(random, 1.0));
        if (0.01..1.0).contains(&v.length_squared()) {
            return v.normalize().to_array();
        }
    }
}

impl Case {
    fn random(random: &mut Rng) -> Self {
        let color = |random: &mut Rng| [(); 3].map(|()| between(random, 0.0, 1.5));
        let ambient = random.f32();
        let mut lights = Lights::with_uniform_ambient(ambient);
        for _ in 0..random.usize(0..4) {
            lights.directional.push(ViewLight {
                source: Directional(direction(random)),
                color: color(random),
                highlight: 1.0,
                shadow_map: None,
            });
        }
        for _ in 0..random.usize(0..4) {
            let inverse_reach = match random.bool() {
                true => 1.0 / between(random, 1.0, 6.0),
                false => 0.0,
            };
            lights.positional.push(ViewLight {
                source: Positional {
                    position: vector(random, 3.0),
                    inverse_reach,
                },
                color: color(random),
                highlight: 1.0,
                shadow_map: None,
            });
        }
        let highlight = match random.bool() {
            true => Highlight::Reflection,
            false => Highlight::HalfVector,
        };
        Self {
            lights,
            ambient,
            gloss: Gloss {
                specular: if random.u8(..) < 32 {
                    [0.0; 3]
                } else {
                    color(random)
                },
                shininess: random.u32(1..=128),
                emissive: color(random),
                highlight,
            },
            base: color(random),
            point: SurfacePoint {
                position: vector(random, 1.0).into(),
                normal: direction(random).into(),
                to_eye: direction(random).into(),
                visibilities: Visibilities::all(1.0),
            },
        }
    }

    fn exact(&self) -> (Material, Vec<Light>, oracle::SurfacePoint) {
        let wide = |v: [f32; 3]| v.map(f64::from);
        let material = Material {
            base: wide(self.base),
            ambient: f64::from(self.ambient),
            specular: wide(self.gloss.specular),
            shininess: self.gloss.shininess.cast_signed(),
            model: match self.gloss.highlight {
                Highlight::Reflection => Specular::Reflection,
                Highlight::HalfVector => Specular::HalfVector,
            },
            emissive: wide(self.gloss.emissive),
        };
        let directional = self.lights.directional.iter().map(|light| Light {
            source: Source::Direction(wide(light.source.0)),
            color: wide(light.color),
        });
        let positional = self.lights.positional.iter().map(|light| {
            let reach = 1.0 / f64::from(light.source.inverse_reach);
            Light {
                source: Source::Position(wide(light.source.position), reach),
                color: wide(light.color),
            }
        });
        let point = oracle::SurfacePoint {
            position: wide(self.point.position.into()),
            normal: wide(self.point.normal.into()),
            to_eye: wide(self.point.to_eye.into()),
        };
        (material, directional.chain(positional).collect(), point)
    }
}

/// The error of a term: some roundings of numbers up to 10, and those of the cosine, which the
/// exponent multiplies.
///
/// Rows: F3.
#[test]
fn the_sum_is_the_oracles() {
    let mut random = Rng::with_seed(0xF3);
    let mut hits = [0_u32; 5];
    for _ in 0..20_000 {
        let case = Case::random(&mut random);
        let reflectance = reflectance(case.lights.clone(), case.gloss, Terms::All);
        let light = reflectance.light(case.point);
        let color: [f32; 3] = reflectance.color(Vec3::from(case.base), light).into();
        let (material, lights, point) = case.exact();
        let expected = oracle::illuminated(&material, &lights, &point);
        let exponent = f64::from(case.gloss.shininess);
        let tolerance = 1e-5 + 2e-6 * exponent;
        for (color, expected) in color.into_iter().zip(expected) {
            let error = (f64::from(color) - expected).abs();
            assert!(
                error < tolerance,
                "{color} is not {expected}: {material:?} {lights:?} {point:?}"
            );
        }
        let unlit = oracle::illuminated(&material, &[], &point);
        let shines = |light: &Light| {
            oracle::specular(material.model, material.shininess, light, &point) > 0.1
        };
        let ends = |light: &Light| oracle::attenuation(light, &point) == 0.0;
        hits[0] += u32::from(!lights.is_empty() && expected == unlit);
        hits[1] += u32::from(lights.iter().any(shines));
        hits[2] += u32::from(lights.iter().any(ends));
        hits[3] += u32::from(lights.len() > 2);
        hits[4] += u32::from(material.model == Specular::HalfVector);
    }
    // Dark points, highlights, lights out of reach, several lights, half vectors.
    assert!(hits.iter().all(|&count| count > 500), "{hits:?}");
}

/// A step may be missed by the rounding error next to its border alone.
///
/// Rows: F3.
#[test]
fn toon_steps_are_the_oracles() {
    let mut random = Rng::with_seed(0x700);
    let (mut equal, mut seen) = (0, std::collections::BTreeSet::new());
    for _ in 0..5000 {
        let case = Case::random(&mut random);
        let levels = random.u16(2..9);
        let reflectance = reflectance(case.lights.clone(), DULL, Terms::Toon(levels));
        let light = reflectance.light(case.point);
        let color = reflectance.color(Vec3::repeat(1.0), light).x;
        let (_, lights, point) = case.exact();
        let step = oracle::quantised(oracle::lit_fraction(&lights, &point), levels);
        let expected = 0.3 + 0.7 * step;
        if (f64::from(color) - expected).abs() < 1e-6 {
            equal += 1;
        } else {
            let near = [-1e-5, 1e-5].map(|by| {
                let brighter = lights.iter().map(|light| Light {
                    color: light.color.map(|channel| channel * (1.0 + by)),
                    ..*light
                });
                let lit = oracle::lit_fraction(&brighter.collect::<Vec<_>>(), &point);
                oracle::quantised(lit, levels)
            });
            assert!(near[0] < near[1], "{color} is not {expected}");
        }
        seen.insert((step * 1e6).round().to_bits());
    }
    assert!(equal > 4990 && seen.len() > 15, "{equal} {}", seen.len());
}

/// Terms that vanish, whatever the rest is.
///
/// Rows: F3.
#[test]
fn light_from_behind_and_light_out_of_reach_is_none() {
    let mut random = Rng::with_seed(0xDA2C);
    for _ in 0..2000 {
        let mut case = Case::random(&mut random);
        let normal = glam::Vec3::from(<[f32; 3]>::from(case.point.normal));
        for light in &mut case.lights.directional {
            let towards = glam::Vec3::from(light.source.0);
            if towards.dot(normal) > 0.0 {
                light.source.0 = (-towards).to_array();
            }
        }
        for light in &mut case.lights.positional {
            let position = glam::Vec3::from(<[f32; 3]>::from(case.point.position));
            let distance = (glam::Vec3::from(light.source.position) - position).length();
            light.source.inverse_reach = 1.01 / distance;
        }
        let light = case.lights.illuminate(&case.gloss, case.point);
        let ambient = case.lights.ambient(case.point.normal);
        assert_eq!(light.diffuse, ambient);
        assert_eq!(light.added, Vec3::from(case.gloss.emissive));
    }
}
