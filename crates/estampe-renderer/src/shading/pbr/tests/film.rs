//! Thin films against the oracle, which has the paper's units.

use super::super::iridescence::Film;
use crate::transforms::round_to_f32;
use estampe::Vec3;
use estampe_reference::pbr::film;

/// At each index, thickness, angle and base, to 3·10⁻⁴: binary32 and its cosines.
#[test]
fn films_are_those_of_the_oracle() {
    let mut rng = fastrand::Rng::with_seed(11);
    let mut greatest = 0.0_f64;
    for _ in 0..4000 {
        let ior = 1.0 + rng.f32() * 1.5;
        let thickness_nm = rng.f32() * 1500.0;
        let base = [rng.f32(), rng.f32(), rng.f32() * 0.1];
        let cosine = 0.05 + 0.95 * rng.f32();
        let own = Film {
            factor: 1.0,
            ior,
            thickness_nm,
        };
        let own = own.fresnel(Vec3::new(base[0], base[1], base[2]), cosine);
        let right = film::reflectance(
            f64::from(ior),
            f64::from(thickness_nm),
            base.map(f64::from),
            f64::from(cosine),
        );
        for (own, right) in [own.x, own.y, own.z].into_iter().zip(right) {
            let error = (f64::from(own) - right).abs();
            // Where the base has the film's index, the phase jumps: both sides are right.
            let index = film::ior_of_f0(f64::from(base[0]));
            if (index - f64::from(ior)).abs() > 1e-3 {
                greatest = greatest.max(error);
            }
        }
    }
    assert!(greatest < 3e-4, "{greatest}");
}

/// Numbers that no film has give reflectances from 0 to 1.
#[test]
fn hostile_films_reflect_from_nothing_to_all() {
    for ior in [0.0, 1.0, 1e30, f32::INFINITY, f32::NAN] {
        for thickness_nm in [0.0, -5.0, 1e5, 1e30] {
            for cosine in [0.0, round_to_f32(1e-4), 1.0] {
                let film = Film {
                    factor: 1.0,
                    ior,
                    thickness_nm,
                };
                let light = film.fresnel(Vec3::new(0.0, 0.5, 1.0), cosine);
                for channel in [light.x, light.y, light.z] {
                    assert!(
                        (0.0..=1.0).contains(&channel),
                        "{film:?}, {cosine}: {channel}"
                    );
                }
            }
        }
    }
}
