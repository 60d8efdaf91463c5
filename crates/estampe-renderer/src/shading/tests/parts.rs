//! Each part of a surface's shader, with numbers that can be checked by hand.

use super::*;
use crate::shading::base_color::{Alpha, Painted};
use crate::shading::output::{EyeDistance, Fog, Output, Presentation};
use crate::shading::shading_normal;
use crate::shading::steps::quantised;
use crate::shading::surface::{Surface, Written};
use estampe::Shader;

/// Rows: F3.
#[test]
fn phong_is_ambient_plus_diffuse_plus_specular() {
    let white = Vec3::new(1.0, 0.5, 0.25);
    let (view, normal) = (Vec3::new(0.0, 0.0, -2.0), Vec3::new(0.0, 0.0, 4.0));
    let light = at_fragments(one_light([0.0, 0.6, 0.8], 0.1), DULL, Terms::All);
    let color = color_at(&light, white, view, normal);
    assert!(
        (color.x - 0.9).abs() < 1e-6 && (color.y - 0.45).abs() < 1e-6,
        "{color:?}"
    );
    // r·v = 2(n·l)(n·v) − l·v = 0.8, squared.
    let gloss = Gloss {
        specular: [0.5; 3],
        shininess: 2,
        emissive: [0.0, 0.0, 0.25],
        highlight: Highlight::Reflection,
    };
    let light = at_fragments(one_light([0.0, 0.6, 0.8], 0.0), gloss, Terms::All);
    let color = color_at(&light, white, view, normal);
    assert!((color.x - (0.8 + 0.5 * 0.64)).abs() < 1e-6, "{color:?}");
    assert!((color.z - (0.2 + 0.32 + 0.25)).abs() < 1e-6, "{color:?}");
    // h = (0, 0.6, 1.8)/√3.6, n·h squared = 0.9.
    let half = Gloss {
        highlight: Highlight::HalfVector,
        ..gloss
    };
    let light = at_fragments(one_light([0.0, 0.6, 0.8], 0.0), half, Terms::All);
    let color = color_at(&light, white, view, normal);
    assert!((color.x - (0.8 + 0.5 * 0.9)).abs() < 1e-6, "{color:?}");
    // A light from behind gives neither diffuse light nor a highlight.
    for gloss in [gloss, half] {
        let light = at_fragments(one_light([0.0, 0.0, -1.0], 0.0), gloss, Terms::All);
        assert_eq!(color_at(&light, white, view, normal).x, 0.0);
    }
}

#[test]
fn back_faces_negate_the_normal_and_missing_ones_face_the_eye() {
    let normal = Vec3::new(0.0, 3.0, 0.0);
    assert_eq!(
        shading_normal(normal, TO_EYE, true),
        Vec3::new(0.0, 1.0, 0.0)
    );
    assert_eq!(
        shading_normal(normal, TO_EYE, false),
        Vec3::new(0.0, -1.0, 0.0)
    );
    assert_eq!(shading_normal(Vec3::repeat(0.0), TO_EYE, false), TO_EYE);
}

/// Rows: F3.
#[test]
fn toon_has_as_many_steps_as_levels() {
    for levels in [2, 3, 4, 9] {
        let mut seen = Vec::new();
        for step in 0..=100u8 {
            let cosine = f32::from(step) / 100.0;
            let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
            let lights = one_light([sine, 0.0, cosine], 0.2);
            let light = at_fragments(lights, DULL, Terms::Toon(levels));
            let (base, position) = (Vec3::repeat(1.0), Vec3::repeat(0.0));
            let color = color_at(&light, base, position, TO_EYE);
            if seen.last() != Some(&color.x) {
                seen.push(color.x);
            }
        }
        assert_eq!(seen.len(), usize::from(levels), "{seen:?}");
        let last = seen[seen.len() - 1];
        assert!(
            seen.is_sorted() && seen[0] > 0.2 && (last - 1.0).abs() < 1e-6,
            "{seen:?}"
        );
    }
}

/// Rows: F3.
#[test]
fn n_levels_are_n_values_from_black_to_white() {
    for levels in [2_u16, 3, 4, 17, 256] {
        let mut values: Vec<f32> = (-100..=2100_i16)
            .map(|i| quantised(f32::from(i) / 2000.0, levels))
            .collect();
        assert!(values.is_sorted());
        values.dedup();
        assert_eq!(values.len(), usize::from(levels));
        assert_eq!((values[0], values[values.len() - 1]), (0.0, 1.0));
    }
    for (value, expected) in [
        (f32::NAN, 0.0),
        (f32::INFINITY, 1.0),
        (f32::NEG_INFINITY, 0.0),
        (3e38, 1.0),
    ] {
        assert_eq!(quantised(value, 4), expected, "{value}");
    }
    assert_eq!(quantised(0.7, 0), 1.0, "fewer than two levels are two");
}

/// Rows: F3.
#[test]
fn vertices_carry_the_light_of_both_sides() {
    let lights = one_light([0.0, 0.0, 1.0], 0.1);
    let light = at_vertices(lights.clone(), DULL, Terms::All, Viewer::Eye);
    let (zero, base) = (Vec3::repeat(0.0), Vec3::repeat(1.0));
    let sides = light.vertex(zero, (TO_EYE, zero));
    let bindings = Bindings::default();
    let front = input(&bindings, Vec4::repeat(0.0));
    let back = FragmentIn {
        front_facing: false,
        ..front
    };
    assert!((light.fragment(base, None, sides, &front).x - 1.1).abs() < 1e-6);
    assert!((light.fragment(base, None, sides, &back).x - 0.1).abs() < 1e-6);
    let unlit = at_vertices(lights, DULL, Terms::Unlit, Viewer::Infinity);
    let sides = unlit.vertex(zero, (TO_EYE, zero));
    assert_eq!(unlit.fragment(base, None, sides, &back), base);
}

#[test]
fn the_default_lights_leave_nothing_dark_or_overexposed() {
    let lights = Lights::studio(crate::shading::lighting::DEFAULT_AMBIENT);
    let diffuse = |normal| lights.illuminate(&DULL, point(normal)).diffuse.y;
    let seen: Vec<f32> = (0..1000u16)
        .filter_map(|i| {
            // Points of a spiral on the sphere that face the eye.
            let z = 1.0 - f32::from(i) / 500.0;
            let (s, c) = libm::sincosf(f32::from(i) * 2.4);
            let r = (1.0 - z * z).max(0.0).sqrt();
            (z > 0.05).then(|| diffuse(Vec3::new(c * r, s * r, z)))
        })
        .collect();
    let darkest = seen.iter().copied().fold(f32::INFINITY, f32::min);
    let brightest = seen.iter().copied().fold(0.0, f32::max);
    assert!((0.1..0.35).contains(&darkest), "{darkest}");
    assert!(
        (1.0..1.5).contains(&brightest),
        "{brightest}: times the grey of 0.6 it stays below 1"
    );
    let facing = diffuse(TO_EYE);
    assert!(facing > 0.5, "{facing}: what faces the eye is well lit");
}

/// Rows: F3.
#[test]
fn colours_are_quantised_before_they_are_fogged() {
    let bindings = Bindings::default();
    let fog = Fog {
        color: [0.0, 0.5, 1.0],
        backdrop: None,
        start: 2.0,
        per_distance: 0.25,
        // One pixel of the window is the whole view, of 90°: the ray at its middle is the axis.
        eye_distance: EyeDistance::Perspective {
            x: [2.0, -1.0],
            y: [-2.0, 1.0],
        },
    };
    let color = Vec3::new(1.0, 0.6, 0.3);
    let at = |output: Output, x: f32, distance: f32| {
        let position = Vec4::new(x, 0.5, 0.9, 1.0 / distance);
        output.color(&input(&bindings, position), color)
    };
    let quantised = Output {
        levels: Some(2),
        ..Output::default()
    };
    assert_eq!(at(quantised, 0.5, 3.0), Vec3::new(1.0, 1.0, 0.0));
    let fogged = Output {
        fog: Some(fog),
        ..Output::default()
    };
    assert_eq!(at(fogged, 0.5, 2.0), color, "none at its start");
    assert_eq!(at(fogged, 0.5, 0.5), color, "none before it");
    assert_eq!(
        at(fogged, 0.5, 6.0),
        Vec3::from(fog.color),
        "all at its end"
    );
    assert_eq!(at(fogged, 0.5, 1e30), Vec3::from(fog.color), "all beyond");
    // At the window's edge the ray (1, 0, −1) is longer: 3√2 of the way from 2 to 6.
    let edge = at(fogged, 1.0, 3.0);
    let share = (3.0 * 2.0_f32.sqrt() - 2.0) / 4.0;
    assert!((edge.x - (1.0 - share)).abs() < 1e-6, "{edge:?}");
    let both = Output {
        levels: Some(2),
        fog: Some(fog),
        ..Output::default()
    };
    assert_eq!(at(both, 0.5, 4.0), Vec3::new(0.5, 0.75, 0.5));
}

/// The default light loses 38 % up to the model's furthest point, in both projections, and colours
/// never reach white.
#[test]
fn the_default_light_recedes_and_keeps_headroom() {
    let bindings = Bindings::default();
    let of = |orthographic| Output {
        presentation: Some(Presentation {
            nearest: 2.0,
            per_distance: 0.25,
            orthographic,
        }),
        ..Output::default()
    };
    let shown = |output: Output, channel: f32, distance: f32| {
        // The distance is 10·z + 1 in the parallel projection.
        let position = Vec4::new(0.5, 0.5, (distance - 1.0) / 10.0, 1.0 / distance);
        output
            .color(&input(&bindings, position), Vec3::repeat(channel))
            .x
    };
    for output in [of(None), of(Some([10.0, 1.0]))] {
        for (distance, share) in [
            (1.0, 1.0),
            (2.0, 1.0),
            (4.0, 0.81),
            (6.0, 0.62),
            (9.0, 0.62),
        ] {
            let near = shown(output, 0.5, distance);
            assert!((near - 0.5 * share).abs() < 1e-5, "{distance}: {near}");
        }
        let brighter = [0.4, 0.55, 0.56, 0.7, 1.0, 1.5, 3.0, 10.0].map(|c| shown(output, c, 2.0));
        assert!(
            brighter.is_sorted_by(|a, b| a < b) && brighter[7] < 1.0,
            "{brighter:?}"
        );
        // White in the default light is not brighter than the default background.
        assert!(brighter[5] < 0.88, "{brighter:?}");
        assert!(
            (brighter[2] - 0.56).abs() < 1e-3,
            "the slope at the shoulder is 1"
        );
    }
}

#[test]
fn alpha_cuts_out_is_kept_or_ignored() {
    let lights = one_light([0.0, 0.0, 1.0], 0.0);
    let painted = |alpha| Surface {
        base_color: Painted {
            factor: [1.0, 1.0, 1.0, 0.5],
            texture: None,
            bump: None,
            alpha,
        },
        interpolation: at_vertices(lights.clone(), DULL, Terms::Unlit, Viewer::Infinity),
        output: Output::default(),
        written: Written::Color,
    };
    let bindings = Bindings::default();
    let (one, none) = (Vec3::repeat(1.0), Vec3::repeat(0.0));
    let run = |alpha, vertex_alpha: f32| {
        let color = Vec4::new(0.25, 0.5, 1.0, vertex_alpha);
        let varyings = ((one, none, one, none), (Vec2::repeat(0.0).into(), color));
        painted(alpha).fragment(input(&bindings, Vec4::repeat(0.0)), varyings)
    };
    let out = run(Alpha::Kept, 0.5);
    assert_eq!(out.color_of(0), Some(Vec4::new(0.25, 0.5, 1.0, 0.25)));
    assert_eq!(out.kept(), None);
    assert_eq!(run(Alpha::Ignored, 0.0).color_of(0).map(|c| c.w), Some(1.0));
    assert_eq!(run(Alpha::CutsOut, 0.9).kept(), Some(false));
    assert_eq!(run(Alpha::CutsOut, 1.0).kept(), Some(true));
    // What is kept is opaque; with several samples by their mask.
    assert_eq!(run(Alpha::CutsOut, 1.0).color_of(0).map(|c| c.w), Some(1.0));
    assert_eq!(run(Alpha::Covers(4), 0.9).sample_mask(), Some(0));
    assert_eq!(run(Alpha::Covers(4), 1.0).sample_mask(), Some(15));
    assert_eq!(
        run(Alpha::Covers(4), 1.0).color_of(0).map(|c| c.w),
        Some(1.0)
    );
}
