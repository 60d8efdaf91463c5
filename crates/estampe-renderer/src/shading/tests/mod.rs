//! Shaders on single fragments: the same source as on sixteen, with numbers that can be checked by
//! hand ([`parts`]), or compared with the oracle ([`oracle`]).

mod oracle;
mod parts;

use super::VertexTransforms;
use super::bump::BumpMap;
use super::interpolation::{AtFragments, AtVertices, Interpolation, Viewer};
use super::lighting::{Directional, Gloss, Highlight, Lights, SurfacePoint, ViewLight};
use super::shadow::Visibilities;
use super::terms::{Reflectance, Terms};
use estampe::{Bindings, FragmentIn, Mat4, Vec2, Vec3, Vec4};
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
    highlight: Highlight::Reflection,
};

/// Towards the eye of [`TRANSFORMS`].
const TO_EYE: Vec3<f32> = Vec3::new(0.0, 0.0, 1.0);

fn one_light(towards: [f32; 3], ambient: f32) -> Lights {
    let mut lights = Lights::with_uniform_ambient(ambient);
    lights.directional.push(ViewLight {
        source: Directional(towards),
        color: [1.0; 3],
        highlight: 1.0,
        shadow_map: None,
    });
    lights
}

fn reflectance(lights: Lights, gloss: Gloss, terms: Terms) -> Reflectance {
    Reflectance {
        lights: Arc::new(lights),
        gloss,
        terms,
    }
}

fn at_fragments(lights: Lights, gloss: Gloss, terms: Terms) -> AtFragments {
    AtFragments {
        transforms: TRANSFORMS,
        reflectance: reflectance(lights, gloss, terms),
    }
}

fn at_vertices(lights: Lights, gloss: Gloss, terms: Terms, viewer: Viewer) -> AtVertices {
    AtVertices {
        transforms: TRANSFORMS,
        reflectance: reflectance(lights, gloss, terms),
        viewer,
    }
}

/// The colour of a front-facing fragment at a vertex.
fn color_at<I: Interpolation>(
    interpolation: &I,
    base: Vec3<f32>,
    position: Vec3<f32>,
    attributes: I::Attributes<f32>,
) -> Vec3<f32> {
    let varyings = interpolation.vertex(position, attributes);
    let bindings = Bindings::default();
    let input = input(&bindings, Vec4::repeat(0.0));
    interpolation.fragment(base, None::<(&BumpMap, Vec2<f32>)>, varyings, &input)
}

/// A point on the eye's axis.
fn point(normal: Vec3<f32>) -> SurfacePoint<f32> {
    SurfacePoint {
        position: Vec3::repeat(0.0),
        normal,
        to_eye: TO_EYE,
        visibilities: Visibilities::all(1.0),
    }
}

/// The input of a fragment at a position in the window.
fn input(bindings: &Bindings, position: Vec4<f32>) -> FragmentIn<'_, f32> {
    FragmentIn {
        position,
        front_facing: true,
        is_helper: false,
        sample_index: 0,
        coverage: 0,
        bindings,
        zero: 0.0,
    }
}
