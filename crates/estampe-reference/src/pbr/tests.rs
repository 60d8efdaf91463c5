//! Integrals that are known, and estimates that agree with them.

use super::{
    Coat, Fibres, Film, Grooves, Layered, Surface, density_ggx, film, over_hemisphere, over_lobe,
    reflected, specular,
};

/// ∫ D (n·h) dω = 1: the facets of an area cover it.
#[test]
fn the_density_is_normalised() {
    for alpha in [0.1, 0.3, 0.6, 1.0] {
        let [sum, ..] = over_hemisphere(2000, |half| {
            [density_ggx(half[2], alpha) * half[2], 0.0, 0.0]
        });
        assert!((sum - 1.0).abs() < 2e-3, "α {alpha}: {sum}");
    }
}

/// Both ways of integrating give the same, and no lobe reflects more light than it gets.
#[test]
fn integrals_agree_and_keep_energy() {
    let surface = Surface {
        f0: [0.04, 0.5, 1.0],
        f90: 1.0,
        alpha: 0.36,
    };
    for cosine in [0.2_f64, 0.7, 1.0] {
        let view = [(1.0 - cosine * cosine).sqrt(), 0.0, cosine];
        let value = |light: [f64; 3]| specular(&surface, view, light).map(|f| f * light[2]);
        let slow = over_hemisphere(600, value);
        let fast = over_lobe(200, surface.alpha, view, value);
        for (slow, fast) in slow.into_iter().zip(fast) {
            assert!((slow - fast).abs() < 2e-3, "n·v {cosine}: {slow} {fast}");
        }
        assert!(slow.iter().all(|&sum| sum <= 1.0), "n·v {cosine}: {slow:?}");
    }
}

/// A film of the base's own index does not change the base, whatever its thickness. At grazing
/// angles Schlick's term reflects between the two although they are one.
#[test]
fn a_film_like_its_base_is_no_film() {
    // The index 1.5 has F0 0.04, and no light comes back from a base of the same index.
    for thickness in [0.0, 200.0, 900.0] {
        for cosine in [0.8_f64, 0.9, 1.0] {
            let own = film::reflectance(1.5, thickness, [0.04; 3], cosine);
            let right = 0.04 + 0.96 * (1.0 - cosine).powi(5);
            for channel in own {
                // Below √(R₁₂·R₂₃) = 1e-5 the appendix clamps.
                assert!(
                    (channel - right).abs() < 0.02,
                    "{cosine}: {channel}, not {right}"
                );
            }
        }
    }
}

/// Thick films have no colour: what is left is the sum of the reflectances, R₁₂ + R*.
#[test]
fn thick_films_are_grey() {
    let [r, g, b] = film::reflectance(1.4, 30_000.0, [0.2; 3], 0.9);
    assert!((r - g).abs() < 1e-6 && (g - b).abs() < 1e-6);
    let r12 = {
        let r0 = (0.4_f64 / 2.4).powi(2);
        r0 + (1.0 - r0) * 0.1_f64.powi(5)
    };
    assert!(r > r12 && r < 0.25, "{r}");
}

/// A quarter of a wavelength of a film between air and glass takes away the reflection of that
/// wavelength (index √1.52), and half a wavelength leaves that of the glass.
#[test]
fn a_quarter_wave_film_reflects_little_green() {
    let glass = ((1.52_f64 - 1.0) / 2.52).powi(2);
    let ior = 1.52_f64.sqrt();
    let green = |thickness: f64| film::reflectance(ior, thickness, [glass; 3], 1.0)[1];
    // 550 nm ÷ 4 ÷ index.
    let quarter = 550.0 / 4.0 / ior;
    assert!(green(quarter) < 0.15 * glass, "{}", green(quarter));
    assert!(
        green(2.0 * quarter) > 0.7 * glass,
        "{}",
        green(2.0 * quarter)
    );
}

/// Random directions give what grids give, within four deviations and the grid's own error.
#[test]
fn random_directions_agree_with_grids() {
    let mut rng = fastrand::Rng::with_seed(4);
    let material = Layered {
        diffuse: [0.1, 0.4, 0.7],
        f0: [0.5, 0.2, 0.04],
        f90: 1.0,
        alpha: 0.3,
        grooves: Some(Grooves {
            strength: 0.6,
            angle_rad: 0.5,
        }),
        film: Some(Film {
            factor: 0.7,
            ior: 1.4,
            thickness_nm: 350.0,
        }),
        sheen: Some(Fibres {
            color: [0.3, 0.2, 0.1],
            alpha: 0.4,
        }),
        coat: Some(Coat {
            factor: 0.5,
            alpha: 0.25,
        }),
    };
    let radiance = |[x, y, _]: [f64; 3]| [1.0, 1.0 + 0.5 * x, 1.0 - 0.5 * y];
    for cosine in [0.35_f64, 0.8] {
        let view = [(1.0 - cosine * cosine).sqrt(), 0.0, cosine];
        let estimate = reflected(&material, view, 30_000, &mut || rng.f64(), &radiance);
        let seen = material.seen(view);
        let exact = over_hemisphere(700, |light| {
            let (value, arriving) = (material.value(&seen, view, light), radiance(light));
            [0, 1, 2].map(|c| value[c] * arriving[c])
        });
        let estimates = estimate.mean.iter().zip(&estimate.deviation);
        for (channel, ((mean, deviation), exact)) in estimates.zip(&exact).enumerate() {
            assert!(*deviation < 0.006, "{deviation}");
            assert!(
                (mean - exact).abs() < 4.0 * deviation + 1e-3,
                "{cosine}, channel {channel}: {mean} ± {deviation}, not {exact}"
            );
        }
    }
}
