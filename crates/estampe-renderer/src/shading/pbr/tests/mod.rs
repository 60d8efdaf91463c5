//! Single points of physically based surfaces against the oracle's integrals.
//!
//! | module | contents |
//! |---|---|
//! | [`furnace`] | each layer alone in white surroundings |
//! | [`integral`] | random materials of all layers against the oracle |
//! | [`film`] | thin films against the oracle |

mod film;
mod furnace;
mod integral;

use super::brdf;
use super::environment::EnvironmentLight;
use super::lights::{PbrLight, PbrSource};
use super::reflection::PbrPoint;
use super::tone_map::ToneMap;
use crate::environment::EnvironmentMap;
use crate::shading::shadow::Visibilities;
use crate::transforms::round_to_f32;
use estampe::{Device, DeviceDescriptor, Mat4, Vec3};
use estampe_reference::pbr;

fn environment(map: &EnvironmentMap) -> EnvironmentLight {
    let device = Device::new(&DeviceDescriptor::default()).expect("a device");
    EnvironmentLight::new(&device, map, Mat4::IDENTITY, 1.0).expect("small textures")
}

/// A point that is seen at a cosine; the normal is +Z.
fn point(n_dot_v: f32, roughness: f32) -> PbrPoint<f32> {
    let zero = Vec3::new(0.0, 0.0, 0.0);
    PbrPoint {
        position: zero,
        normal: Vec3::new(0.0, 0.0, 1.0),
        to_eye: Vec3::new((1.0 - n_dot_v * n_dot_v).sqrt(), 0.0, n_dot_v),
        diffuse: zero,
        passing: None,
        f0: Vec3::new(1.0, 1.0, 1.0),
        f90: 1.0,
        roughness,
        occlusion: 1.0,
        clearcoat: None,
        sheen: None,
        grooves: None,
        film: None,
        visibilities: Visibilities::all(1.0),
    }
}

#[test]
fn terms_are_those_of_the_oracle() {
    for cosine in [0.05_f32, 0.3, 0.77, 0.999] {
        for alpha in [0.01_f32, 0.2, 0.7, 1.0] {
            let exact = [f64::from(cosine), f64::from(alpha)];
            let sin_squared = 1.0 - cosine * cosine;
            let close = |what: &str, own: f32, right: f64| {
                let error = (f64::from(own) - right).abs();
                assert!(error < 2e-4 * right + 1e-6, "{what}: {own}, not {right}");
            };
            let density = brdf::density_ggx(cosine, sin_squared, alpha);
            close("GGX", density, pbr::density_ggx(exact[0], exact[1]));
            let visibility = brdf::visibility_ggx(0.4, cosine, alpha);
            let right = pbr::visibility_ggx(f64::from(0.4_f32), exact[0], exact[1]);
            close("masking", visibility, right);
            let density = brdf::density_sheen(cosine, alpha);
            close("sheen", density, pbr::density_sheen(exact[0], exact[1]));
            let visibility = brdf::visibility_sheen(0.4, cosine);
            let right = pbr::visibility_sheen(f64::from(0.4_f32), exact[0]);
            close("masking of fibres", visibility, right);
        }
        let fresnel = brdf::schlick(cosine) * 0.96 + 0.04;
        let right = pbr::fresnel(0.04, 1.0, f64::from(cosine));
        assert!((f64::from(fresnel) - right).abs() < 1e-6);
    }
}

/// A red gradient from below to above and a green one from left to right, against the integral of
/// the surroundings times the lobe.
#[test]
fn light_from_all_around_is_the_integral_over_the_lobe() {
    let radiance = |[x, y, _]: [f64; 3]| [1.0 + 0.8 * y, 1.0 + 0.8 * x, 0.5];
    let (width, height) = (128_u16, 64_u16);
    let mut panorama = Vec::new();
    for row in 0..height {
        for column in 0..width {
            let v = (f64::from(row) + 0.5) / f64::from(height) * std::f64::consts::PI;
            let u = (0.5 - (f64::from(column) + 0.5) / f64::from(width)) * std::f64::consts::TAU;
            let ((sin, cos), (sin_u, cos_u)) = (libm::sincos(v), libm::sincos(u));
            let direction = [sin * sin_u, cos, sin * cos_u];
            panorama.extend(radiance(direction).map(round_to_f32));
        }
    }
    let workers = estampe_scene::Workers::ONE;
    let map = EnvironmentMap::from_panorama(width.into(), height.into(), &panorama, workers);
    let light = environment(&map.expect("a panorama"));
    for n_dot_v in [0.6_f32, 0.9, 1.0] {
        for roughness in [0.2_f32, 0.5, 0.8] {
            let point = PbrPoint {
                f0: Vec3::new(0.5, 0.5, 0.5),
                ..point(n_dot_v, roughness)
            };
            let alpha = f64::from(roughness * roughness);
            let surface = pbr::Surface {
                f0: [0.5; 3],
                f90: 1.0,
                alpha,
            };
            let view = [point.to_eye.x, 0.0, point.to_eye.z].map(f64::from);
            let right = pbr::over_lobe(256, alpha, view, |l| {
                let (term, arriving) = (pbr::specular(&surface, view, l), radiance(l));
                [0, 1, 2].map(|channel| term[channel] * arriving[channel] * l[2])
            });
            // Light between facets is not in the integral: a few hundredths of rough surfaces.
            let own = point.leaving(&light, &[]).reflected;
            let between = pbr_between_facets(&point);
            for (channel, own) in [own.x, own.y, own.z].into_iter().enumerate() {
                let own = f64::from(own) - between * radiance([0.0, 0.0, 1.0])[channel];
                let error = (own - right[channel]).abs();
                // The split sum takes n = v, which grazing views of rough surfaces are far from.
                let allowed = if n_dot_v < 0.7 { 0.06 } else { 0.03 };
                assert!(
                    error < allowed,
                    "n·v {n_dot_v}, roughness {roughness}, channel {channel}: {own}, not {}",
                    right[channel]
                );
            }
        }
    }
}

/// What a point reflects between facets in uniform light: the furnace's sum less the lobe.
fn pbr_between_facets(point: &PbrPoint<f32>) -> f64 {
    let white = environment(&EnvironmentMap::uniform([1.0; 3]));
    let alpha = f64::from(point.roughness * point.roughness);
    let surface = pbr::Surface {
        f0: [f64::from(point.f0.x); 3],
        f90: 1.0,
        alpha,
    };
    let view = [point.to_eye.x, 0.0, point.to_eye.z].map(f64::from);
    let [lobe, ..] = pbr::over_lobe(256, alpha, view, |l| {
        pbr::specular(&surface, view, l).map(|term| term * l[2])
    });
    f64::from(point.leaving(&white, &[]).reflected.x) - lobe
}

/// Reference values of the Khronos shader, and the ends of each curve.
#[test]
fn tone_maps_keep_black_and_bound_what_is_bright() {
    let shown = |map: ToneMap, value: f32| map.apply(Vec3::new(value, value, value)).x;
    for map in [ToneMap::Neutral, ToneMap::Agx, ToneMap::Aces] {
        assert!(shown(map, 0.0).abs() < 2e-3, "{map:?}: {}", shown(map, 0.0));
        let mut before = -1.0;
        for step in 0..64_u8 {
            let value = shown(map, libm::exp2f(f32::from(step) / 4.0 - 8.0));
            assert!(value >= before - 1e-4, "{map:?} falls at step {step}");
            assert!(value <= 1.001, "{map:?} exceeds 1 at step {step}");
            before = value;
        }
        assert!(before > 0.97, "{map:?} ends at {before}");
    }
    assert_eq!(shown(ToneMap::None, 3.5), 3.5);
    // Grey 0.5 loses the 0.04 that a dielectric reflects; 1 is compressed:
    // 1 − 0.24² ÷ (0.96 + 0.24 − 0.76).
    assert!((shown(ToneMap::Neutral, 0.5) - 0.46).abs() < 1e-6);
    assert!((shown(ToneMap::Neutral, 1.0) - 0.869_090_9).abs() < 1e-5);
    // A toe below 0.08: x − (x − 6.25x²).
    assert!((shown(ToneMap::Neutral, 0.04) - 0.01).abs() < 1e-6);
    // The matrices of ACES keep grey; v = 0.18 ÷ 0.6: (v² + 0.0246v − 0.0001) ÷ (0.984v² +
    // 0.433v + 0.238) = 0.09728 ÷ 0.45650.
    assert!((shown(ToneMap::Aces, 0.18) - 0.2131).abs() < 1e-3);
}

/// A point light of I candela lights a white surface at distance d with I ÷ d² ÷ π, until its
/// range ends; a cone ends at its outer angle.
#[test]
fn points_and_cones_decrease_as_their_extension_says() {
    let light = |cone, inverse_range| PbrLight {
        source: PbrSource::Point {
            position: [0.0, 0.0, 4.0],
            inverse_range,
            cone,
        },
        color: [32.0, 16.0, 0.0],
        shadow_map: None,
    };
    let at = |light: PbrLight, x: f32| light.arrive(Vec3::new(x, 0.0, 0.0)).1;
    assert!((at(light(None, 0.0), 0.0).x - 2.0).abs() < 1e-6);
    assert!((at(light(None, 0.0), 3.0).y - 16.0 / 25.0).abs() < 1e-6);
    // (1 − (4/8)⁴).
    assert!((at(light(None, 0.125), 0.0).x - 2.0 * 0.9375).abs() < 1e-6);
    assert_eq!(at(light(None, 0.25), 0.1).x, 0.0);
    let (inner, outer) = (0.9_f32, 0.8_f32);
    let cone = super::lights::Cone {
        axis: [0.0, 0.0, -1.0],
        scale: 1.0 / (inner - outer),
        offset: -outer / (inner - outer),
    };
    assert!((at(light(Some(cone), 0.0), 0.0).x - 2.0).abs() < 1e-6);
    // The cosine at x = 3 is 0.8: the edge.
    assert!(at(light(Some(cone), 0.0), 3.0).x < 1e-5);
    // Half-way between the cosines, the square of ½.
    let cosine = 0.85_f32;
    let x = 4.0 * (1.0 - cosine * cosine).sqrt() / cosine;
    let squared = x * x + 16.0;
    assert!((at(light(Some(cone), 0.0), x).x - 32.0 / squared * 0.25).abs() < 1e-3);
}
