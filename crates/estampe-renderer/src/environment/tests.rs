//! Maps whose integrals are known.

use super::cube::{CubeImage, direction};
use super::{EnvironmentError, EnvironmentMap, directional_albedos, studio};
use crate::environment::ALBEDO_SIDE;
use estampe_reference::pbr;
use estampe_scene::Workers;
use glam::Vec3;

/// Each texel's direction leads back to the texel, at every face and row.
#[test]
fn directions_of_texels_lead_back_to_them() {
    let cube = CubeImage::new(8, |d| d, Workers::ONE);
    for face in 0..6 {
        for (x, y) in [(0, 0), (7, 0), (3, 4), (0, 7), (7, 7)] {
            let towards = direction(face, [x, y], 8);
            assert!(
                (cube.sample(towards) - towards).length() < 1e-5,
                "{face} {x} {y}"
            );
        }
    }
    // The faces of cube textures: +X first, and rows from the top of +Z.
    assert!(direction(0, [3, 3], 8).x > 0.9 && direction(3, [3, 3], 8).y < -0.9);
    assert!(direction(4, [0, 0], 8).y > 0.5 && direction(4, [0, 0], 8).x < -0.5);
}

#[test]
fn uniform_surroundings_stay_uniform_at_every_roughness() {
    let panorama = [0.25_f32, 0.5, 2.0].repeat(64 * 32);
    let map = EnvironmentMap::from_panorama(64, 32, &panorama, Workers::ONE).expect("a panorama");
    assert_eq!(map.specular.len(), 3, "16, 8 and 4 texels");
    let grey = |d: Vec3| {
        let values = super::diffuse::basis(d);
        let sum: f32 = (0..9).map(|k| map.diffuse()[k][1] * values[k]).sum();
        sum
    };
    for towards in [Vec3::X, Vec3::NEG_Y, Vec3::new(0.6, 0.0, -0.8)] {
        for level in &map.specular {
            let light = level.sample(towards);
            assert!((light - Vec3::new(0.25, 0.5, 2.0)).abs().max_element() < 1e-4);
        }
        assert!((grey(towards) - 0.5).abs() < 1e-4);
    }
}

/// A small sun at the middle of the panorama is at +Z, one at three quarters of its width at −X;
/// rough surfaces spread it, and its light in all directions stays the same.
#[test]
fn a_sun_is_where_the_panorama_has_it_and_keeps_its_power() {
    let (width, height) = (256, 128);
    for (column, towards) in [(128, Vec3::Z), (192, Vec3::NEG_X), (64, Vec3::X)] {
        let mut panorama = vec![0.0_f32; width * height * 3];
        for y in 62..66 {
            let first = (y * width + column - 2) * 3;
            panorama[first..first + 12].fill(1000.0);
        }
        let map = EnvironmentMap::from_panorama(width, height, &panorama, Workers::new(2));
        let map = map.expect("a panorama");
        let power = |level: &CubeImage| {
            let texels = level.texels_with_solid_angles();
            texels.map(|(_, light, angle)| light.x * angle).sum::<f32>()
        };
        let all = power(&map.specular[0]);
        let mut brightest = f32::INFINITY;
        for level in &map.specular {
            let light = level.sample(towards).x;
            assert!(light > level.sample(-towards).x && light < brightest);
            brightest = light;
        }
        // A convolution keeps the sum over all normals; the sharpest one is finer than its texels.
        for level in &map.specular[2..5] {
            let spread = power(level);
            assert!((spread / all - 1.0).abs() < 0.05, "{spread} of {all}");
        }
    }
}

#[test]
fn reflected_shares_are_those_of_the_oracle() {
    let table = directional_albedos();
    assert_eq!(
        table.len(),
        usize::from(ALBEDO_SIDE) * usize::from(ALBEDO_SIDE)
    );
    for (row, column) in [(6, 10), (12, 31), (18, 3), (24, 20), (31, 31), (31, 5)] {
        let last = f64::from(ALBEDO_SIDE - 1);
        let (n_dot_v, roughness) = (f64::from(column) / last, f64::from(row) / last);
        let alpha = roughness * roughness;
        let view = [(1.0 - n_dot_v * n_dot_v).max(0.0).sqrt(), 0.0, n_dot_v];
        let share = |f0: f64, f90: f64| {
            let surface = pbr::Surface {
                f0: [f0; 3],
                f90,
                alpha,
            };
            pbr::over_lobe(400, alpha, view, |l| {
                pbr::specular(&surface, view, l).map(|term| term * l[2])
            })[0]
        };
        let [scale, bias, ..] = table[row as usize * usize::from(ALBEDO_SIDE) + column as usize];
        let exact = [share(1.0, 0.0), share(0.0, 1.0)];
        for (own, right) in [scale, bias].into_iter().zip(exact) {
            let error = (f64::from(own) - right).abs();
            assert!(
                error < 5e-3,
                "row {row}, column {column}: {own}, not {right}"
            );
        }
    }
}

/// The key light is on the left and above, the back has its strips, and a white surface in front is
/// bright without being white.
#[test]
fn the_studio_lights_from_the_left_and_from_above() {
    let studio_map = EnvironmentMap::studio();
    let lit = |d: Vec3| {
        let values = super::diffuse::basis(d);
        (0..9)
            .map(|k| studio_map.diffuse()[k][1] * values[k])
            .sum::<f32>()
    };
    let front = lit(Vec3::Z);
    assert!((0.5..0.85).contains(&front), "{front}");
    assert!(lit(Vec3::Y) > lit(Vec3::NEG_Y) * 2.0);
    assert!(lit(Vec3::NEG_X) > lit(Vec3::X));
    assert!(studio::radiance(Vec3::new(-0.75, 0.72, 0.75).normalize()).x > 3.0);
}

/// Rows: D4.
#[test]
fn maps_do_not_depend_on_threads() {
    let made = |threads| {
        let cube = CubeImage::new(32, studio::radiance, Workers::new(threads));
        EnvironmentMap::from_cube(cube, Workers::new(threads))
    };
    assert_eq!(made(1), made(3));
}

#[test]
fn hostile_panoramas_are_errors_or_finite() {
    let map = |width, height, rgb: &[f32]| {
        EnvironmentMap::from_panorama(width, height, rgb, Workers::ONE)
    };
    assert_eq!(map(0, 0, &[]), Err(EnvironmentError::Empty));
    let wrong = map(2, 2, &[1.0; 11]);
    assert!(matches!(
        wrong,
        Err(EnvironmentError::Size {
            expected: 12,
            actual: 11,
            ..
        })
    ));
    assert!(map(usize::MAX, 2, &[1.0; 3]).is_err());
    for value in [f32::NAN, f32::INFINITY, f32::MAX, -1.0, f32::NEG_INFINITY] {
        let map = map(3, 1, &[value; 9]).expect("three pixels");
        for (_, texels) in map.specular_texels(1.0) {
            let numbers = texels
                .as_chunks::<4>()
                .0
                .iter()
                .copied()
                .map(f32::from_le_bytes);
            assert!(
                { numbers }.all(|n| (0.0..=65_505.0).contains(&n)),
                "{value}"
            );
        }
    }
}
