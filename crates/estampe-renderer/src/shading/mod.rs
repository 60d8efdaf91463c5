//! The shaders of each [`Shading`](crate::Shading), each written once for all lane counts.
//!
//! | module | contents |
//! |---|---|
//! | [`lighting`] | lights, and the sum of their light on a point |
//! | [`shadow`], [`shadow_caster`] | shadow maps: looked up, and drawn |
//! | [`steps`] | light in steps |
//! | [`terms`] | the terms of a surface: all, toon, or none (unlit) |
//! | [`bump`] | normals bent by a texture of heights |
//! | [`interpolation`] | lighting at every fragment (Phong), or at the vertices (Gouraud, flat) |
//! | [`base_color`] | one colour, or texture and vertex colours |
//! | [`cut_out`] | surfaces with holes |
//! | [`pbr`] | physically based surfaces |
//! | [`output`] | quantised colours, fog |
//! | [`surface`] | the shader of surfaces, composed of these parts |
//! | [`wireframe`] | edges over faces that hide the edges behind them, or over shaded surfaces |
//! | [`inspection`] | normals, depth, uv, faces, barycentric coordinates and overdraw as colours |
//! | [`points_and_lines`] | points and lines |
//! | [`ground`] | the shadow on the ground |
//! | [`backdrop`] | the gradient behind everything |
//! | [`stroke`] | lines of a width, with smooth borders |
//!
//! Lighting is computed in view space, in linear light.
//!
//! The module is public for `tests/as_text` alone, which draws these shaders as the library has
//! compiled them: as unit tests, they would be compiled a second time, which takes over a minute.

pub mod backdrop;
pub mod base_color;
pub mod bump;
pub mod cut_out;
pub mod ground;
pub mod inspection;
pub mod interpolation;
pub mod lighting;
pub mod output;
pub mod pbr;
pub mod points_and_lines;
pub mod shadow;
pub mod shadow_caster;
pub mod steps;
pub mod stroke;
pub mod surface;
pub mod terms;
pub mod wireframe;

#[cfg(test)]
mod tests;

pub use crate::geometry::vertex_data::VertexStream;

use estampe::{Mat4, Real, Vec3, Vec4};

/// The transforms of vertices.
#[derive(Debug, Clone, Copy)]
pub struct VertexTransforms {
    /// From unit space, the space of vertex buffers, to clip space.
    pub clip_from_unit: Mat4,
    /// From unit space to view space.
    pub view_from_unit: Mat4,
    /// From object-space normals to view-space normals; a rotation.
    pub view_from_object_normal: Mat4,
    /// True if all rays to the eye are parallel.
    pub is_orthographic: bool,
}

impl VertexTransforms {
    /// Position in clip space.
    #[inline(always)]
    pub fn clip<R: Real>(&self, position: Vec3<R>) -> Vec4<R> {
        self.clip_from_unit.transform_point(position)
    }

    /// Position in view space.
    #[inline(always)]
    pub fn view<R: Real>(&self, position: Vec3<R>) -> Vec3<R> {
        self.view_from_unit.transform_point(position).xyz()
    }

    /// Normal in view space.
    #[inline(always)]
    pub fn normal<R: Real>(&self, normal: Vec3<R>) -> Vec3<R> {
        self.view_from_object_normal.transform_vector(normal)
    }

    /// Unit direction from a view-space point to the eye.
    #[inline(always)]
    pub fn eye_direction<R: Real>(&self, position_view: Vec3<R>) -> Vec3<R> {
        if self.is_orthographic {
            Vec3::uniform(position_view.x, [0.0, 0.0, 1.0])
        } else {
            (-position_view).normalize()
        }
    }
}

/// The unit shading normal: `normal` normalised, and negated on back faces (two-sided lighting). If
/// the vertices have no normal, it is `to_eye`, the direction to the eye.
#[inline(always)]
pub fn shading_normal<R: Real>(
    normal: Vec3<R>,
    to_eye: Vec3<R>,
    front_facing: R::SelectMask,
) -> Vec3<R> {
    let squared = normal.dot(normal);
    let has_one = squared.gt(squared.splat(1e-12));
    let one = squared.splat(1.0);
    let scale = one / squared.sqrt();
    let unit = normal * R::select(front_facing, scale, -scale);
    Vec3::select(has_one, unit, to_eye)
}
