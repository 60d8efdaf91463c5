//! The formulas of illumination with numbers that can be checked by hand.

use crate::illumination::{
    Light, Material, Source, Specular, SurfacePoint, attenuation, fogged, illuminated,
    lit_fraction, quantised, specular, toon,
};

const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// A light at 3-4-5 distance, a surface that faces the eye.
fn scene(model: Specular) -> (Material, Light, SurfacePoint) {
    let material = Material {
        base: [1.0, 0.5, 0.0],
        ambient: 0.1,
        specular: [0.5; 3],
        shininess: 2,
        model,
        emissive: [0.0, 0.0, 0.25],
    };
    let light = Light {
        source: Source::Position([0.0, 3.0, 4.0], 10.0),
        color: [1.0, 2.0, -1.0],
    };
    let point = SurfacePoint {
        position: [0.0; 3],
        normal: UP,
        to_eye: UP,
    };
    (material, light, point)
}

#[test]
fn the_sum_has_each_term_once() {
    let (material, light, point) = scene(Specular::Reflection);
    // n·l = r·v = 0.8, half of the light is left at 5 of 10.
    let red = 0.1 + 0.5 * (0.8 + 0.5 * 0.64);
    let green = 0.05 + 1.0 * (0.8 * 0.5 + 0.5 * 0.64);
    let color = illuminated(&material, &[light], &point);
    assert!((color[0] - red).abs() < 1e-12, "{color:?}");
    assert!((color[1] - green).abs() < 1e-12, "{color:?}");
    assert_eq!(color[2], 0.25, "negative light is none");
    let twice = illuminated(&material, &[light, light], &point);
    assert!(
        (twice[0] - (2.0 * red - 0.1)).abs() < 1e-12,
        "ambient light is added once: {twice:?}"
    );
    // h = (0, 3, 9)/√90, n·h squared = 0.9.
    let half = specular(Specular::HalfVector, 2, &light, &point);
    assert!((half - 0.9).abs() < 1e-12, "{half}");
    let behind = SurfacePoint {
        normal: [0.0, 0.0, -1.0],
        ..point
    };
    let dark = illuminated(&material, &[light], &behind);
    assert_eq!(dark, [0.1, 0.05, 0.25], "ambient and emitted light alone");
}

#[test]
fn light_ends_at_its_reach() {
    let (_, light, point) = scene(Specular::Reflection);
    let at = |z: f64| {
        let position = [0.0, 3.0, z];
        attenuation(&light, &SurfacePoint { position, ..point })
    };
    assert_eq!(
        (at(4.0), at(-1.0), at(-6.0), at(-60.0)),
        (1.0, 0.5, 0.0, 0.0)
    );
    let endless = Light {
        source: Source::Position([0.0; 3], f64::INFINITY),
        ..light
    };
    assert_eq!(attenuation(&endless, &point), 1.0);
}

#[test]
fn levels_are_equally_wide_and_far_apart() {
    let levels: Vec<f64> = (-1..=8).map(|i| quantised(f64::from(i) / 8.0, 4)).collect();
    let third = 1.0 / 3.0;
    let expected = [
        0.0,
        0.0,
        0.0,
        third,
        third,
        2.0 * third,
        2.0 * third,
        1.0,
        1.0,
        1.0,
    ];
    assert_eq!(levels, expected);
    let (material, light, point) = scene(Specular::Reflection);
    let lit = lit_fraction(&[light], &point);
    assert!((lit - (0.2126 + 2.0 * 0.7152) * 0.8 * 0.5).abs() < 1e-12);
    assert_eq!(lit_fraction(&[light; 9], &point), 1.0);
    // 0.657 is in the third of four steps.
    let share = 0.3 + 0.7 * 2.0 / 3.0;
    let expected = [share, share * 0.5, 0.25];
    for (channel, expected) in toon(&material, lit, 4).into_iter().zip(expected) {
        assert!((channel - expected).abs() < 1e-12, "{channel} {expected}");
    }
}

#[test]
fn fog_is_none_at_its_start_and_all_at_its_end() {
    let (color, fog) = ([1.0, 0.5, 0.0], [0.0, 0.5, 1.0]);
    let at = |distance| fogged(color, fog, [2.0, 6.0], distance);
    assert_eq!((at(0.0), at(2.0)), (color, color));
    assert_eq!((at(6.0), at(60.0)), (fog, fog));
    assert_eq!(at(4.0), [0.5; 3]);
}
