//! Shaders on single fragments: the same source as on sixteen, with numbers that can be checked by
//! hand.

use super::lighting::{Gloss, Lights, ViewLight};
use super::phong::{PhongLight, ShadingMode};
use super::surfaces::{Alpha, Painted, SurfaceLight};
use super::vertex_lit::{self, VertexLight, VertexShadingMode};
use super::{VertexTransforms, shading_normal};
use estampe::{Bindings, FragmentIn, Mat4, Shader, Vec2, Vec3, Vec4};
use std::sync::Arc;

const TRANSFORMS: VertexTransforms = VertexTransforms {
    clip_from_unit: Mat4::IDENTITY,
    view_from_unit: Mat4::IDENTITY,
    view_from_object_normal: Mat4::IDENTITY,
    is_orthographic: true,
};

const DULL: Gloss = Gloss {
    specular: [0.0; 3],
    shininess: 1,
    emissive: [0.0; 3],
};

fn one_light(towards: [f32; 3], ambient: f32) -> Arc<Lights> {
    let light = ViewLight {
        towards,
        color: [1.0; 3],
        highlight: 1.0,
    };
    Arc::new(Lights::with_uniform_ambient(vec![light], ambient))
}

fn phong(lights: Arc<Lights>, gloss: Gloss, mode: ShadingMode) -> PhongLight {
    PhongLight {
        transforms: TRANSFORMS,
        lights,
        gloss,
        mode,
    }
}

#[test]
fn phong_is_ambient_plus_diffuse_plus_specular() {
    let white = Vec3::new(1.0, 0.5, 0.25);
    let (view, normal) = (Vec3::new(0.0, 0.0, -2.0), Vec3::new(0.0, 0.0, 4.0));
    let light = phong(one_light([0.0, 0.6, 0.8], 0.1), DULL, ShadingMode::Smooth);
    let color = light.color(white, view, normal, true);
    assert!(
        (color.x - 0.9).abs() < 1e-6 && (color.y - 0.45).abs() < 1e-6,
        "{color:?}"
    );
    // r·v = 2(n·l)(n·v) − l·v = 0.8, squared.
    let gloss = Gloss {
        specular: [0.5; 3],
        shininess: 2,
        emissive: [0.0, 0.0, 0.25],
    };
    let light = phong(one_light([0.0, 0.6, 0.8], 0.0), gloss, ShadingMode::Smooth);
    let color = light.color(white, view, normal, true);
    assert!((color.x - (0.8 + 0.5 * 0.64)).abs() < 1e-6, "{color:?}");
    assert!((color.z - (0.2 + 0.32 + 0.25)).abs() < 1e-6, "{color:?}");
    // A light from behind gives neither diffuse light nor a highlight.
    let light = phong(one_light([0.0, 0.0, -1.0], 0.0), gloss, ShadingMode::Smooth);
    assert_eq!(light.color(white, view, normal, true).x, 0.0);
}

#[test]
fn back_faces_negate_the_normal_and_missing_ones_face_the_eye() {
    let (normal, to_eye) = (Vec3::new(0.0, 3.0, 0.0), Vec3::new(0.0, 0.0, 1.0));
    assert_eq!(
        shading_normal(normal, to_eye, true),
        Vec3::new(0.0, 1.0, 0.0)
    );
    assert_eq!(
        shading_normal(normal, to_eye, false),
        Vec3::new(0.0, -1.0, 0.0)
    );
    assert_eq!(shading_normal(Vec3::repeat(0.0), to_eye, false), to_eye);
}

#[test]
fn toon_has_four_steps() {
    let mut seen = Vec::new();
    for step in 0..=100u8 {
        let cosine = f32::from(step) / 100.0;
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let light = phong(
            one_light([sine, 0.0, cosine], 0.2),
            DULL,
            ShadingMode::Toon(4),
        );
        let color = light.color(
            Vec3::repeat(1.0),
            Vec3::repeat(0.0),
            Vec3::new(0.0, 0.0, 1.0),
            true,
        );
        if seen.last() != Some(&color.x) {
            seen.push(color.x);
        }
    }
    assert_eq!(seen.len(), 4, "{seen:?}");
    assert!(
        seen.is_sorted() && seen[0] > 0.2 && (seen[3] - 1.0).abs() < 1e-6,
        "{seen:?}"
    );
}

#[test]
fn vertices_carry_the_light_of_both_sides() {
    let lights = one_light([0.0, 0.0, 1.0], 0.1);
    let light = VertexLight {
        transforms: TRANSFORMS,
        lights,
        gloss: DULL,
        mode: VertexShadingMode::Gouraud,
    };
    let sides = light.both_sides(Vec3::repeat(0.0), Vec3::new(0.0, 0.0, 1.0));
    let base = Vec3::repeat(1.0);
    assert!((vertex_lit::color(base, sides, true).x - 1.1).abs() < 1e-6);
    assert!((vertex_lit::color(base, sides, false).x - 0.1).abs() < 1e-6);
    let unlit = VertexLight {
        mode: VertexShadingMode::Unlit,
        ..light
    };
    let sides = unlit.both_sides(Vec3::repeat(0.0), Vec3::new(0.0, 0.0, 1.0));
    assert_eq!(vertex_lit::color(base, sides, false), base);
}

#[test]
fn the_default_lights_leave_nothing_dark_or_overexposed() {
    let lights = Lights::studio(super::lighting::DEFAULT_AMBIENT);
    let to_eye = Vec3::new(0.0, 0.0, 1.0);
    let seen: Vec<f32> = (0..1000u16)
        .filter_map(|i| {
            // Points of a spiral on the sphere that face the eye.
            let z = 1.0 - f32::from(i) / 500.0;
            let (s, c) = libm::sincosf(f32::from(i) * 2.4);
            let r = (1.0 - z * z).max(0.0).sqrt();
            (z > 0.05).then(|| {
                lights
                    .illuminate(&DULL, Vec3::new(c * r, s * r, z), to_eye)
                    .diffuse
                    .y
            })
        })
        .collect();
    let darkest = seen.iter().copied().fold(f32::INFINITY, f32::min);
    let brightest = seen.iter().copied().fold(0.0, f32::max);
    assert!((0.1..0.35).contains(&darkest), "{darkest}");
    assert!(
        (1.0..1.5).contains(&brightest),
        "{brightest}: times the grey of 0.6 it stays below 1"
    );
    let facing = lights.illuminate(&DULL, to_eye, to_eye).diffuse.y;
    assert!(facing > 0.5, "{facing}: what faces the eye is well lit");
}

#[test]
fn alpha_cuts_out_is_kept_or_ignored() {
    let lights = one_light([0.0, 0.0, 1.0], 0.0);
    let painted = |alpha| Painted {
        light: SurfaceLight::Vertices(VertexLight {
            transforms: TRANSFORMS,
            lights: Arc::clone(&lights),
            gloss: DULL,
            mode: VertexShadingMode::Unlit,
        }),
        factor: [1.0, 1.0, 1.0, 0.5],
        texture: None,
        alpha,
    };
    let bindings = Bindings::default();
    let input = FragmentIn {
        position: Vec4::repeat(0.0_f32),
        front_facing: true,
        is_helper: false,
        sample_index: 0,
        coverage: 0,
        bindings: &bindings,
        zero: 0.0,
    };
    let one = Vec3::repeat(1.0);
    let none = Vec3::repeat(0.0);
    let run = |alpha, vertex_alpha: f32| {
        let color = Vec4::new(0.25, 0.5, 1.0, vertex_alpha);
        let varyings = ((one, none, one, none), Vec2::repeat(0.0), color);
        painted(alpha).fragment(input, varyings)
    };
    let out = run(Alpha::Kept, 0.5);
    assert_eq!(out.color_of(0), Some(Vec4::new(0.25, 0.5, 1.0, 0.25)));
    assert_eq!(out.kept(), None);
    assert_eq!(run(Alpha::Ignored, 0.0).color_of(0).map(|c| c.w), Some(1.0));
    assert_eq!(run(Alpha::CutsOut, 0.9).kept(), Some(false));
    assert_eq!(run(Alpha::CutsOut, 1.0).kept(), Some(true));
}
