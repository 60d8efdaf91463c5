//! The looks: shaders written once for one fragment and for sixteen.
//!
//! | module | what |
//! |---|---|
//! | [`lighting`] | the lights and the Phong model |
//! | [`phong`] | light at every fragment, smooth or in toon's steps |
//! | [`vertex_lit`] | light at the vertices (Gouraud) or the faces (flat), or none (unlit) |
//! | [`surfaces`] | the shaders of plain and of painted surfaces, in either light |
//! | [`wireframe`] | edges over faces that hide what lies behind |
//! | [`inspection`] | normals, depth and uv as colours |
//! | [`marks`] | points and lines |
//!
//! All light is computed in view space, linear.

pub(crate) mod inspection;
pub(crate) mod lighting;
pub(crate) mod marks;
pub(crate) mod phong;
pub(crate) mod surfaces;
pub(crate) mod vertex_lit;
pub(crate) mod wireframe;

#[cfg(test)]
mod tests;

use estampe::{Mat4, Real, Vec3, Vec4};

/// The transforms that vertices go through.
#[derive(Debug, Clone, Copy)]
pub(crate) struct VertexTransforms {
    /// Clip space from the unit space that vertices are in.
    pub(crate) clip_from_unit: Mat4,
    /// View space from the unit space.
    pub(crate) view_from_unit: Mat4,
    /// Normals of view space from normals of object space; a rotation.
    pub(crate) view_from_object_normal: Mat4,
    /// Whether all rays to the eye are parallel.
    pub(crate) is_orthographic: bool,
}

impl VertexTransforms {
    /// Position in clip space.
    #[inline(always)]
    pub(crate) fn clip<R: Real>(&self, position: Vec3<R>) -> Vec4<R> {
        self.clip_from_unit.transform_point(position)
    }

    /// Position in view space.
    #[inline(always)]
    pub(crate) fn view<R: Real>(&self, position: Vec3<R>) -> Vec3<R> {
        self.view_from_unit.transform_point(position).xyz()
    }

    /// Normal in view space.
    #[inline(always)]
    pub(crate) fn normal<R: Real>(&self, normal: Vec3<R>) -> Vec3<R> {
        self.view_from_object_normal.transform_vector(normal)
    }

    /// Unit direction to the eye from a point of view space.
    #[inline(always)]
    pub(crate) fn eye_direction<R: Real>(&self, position_view: Vec3<R>) -> Vec3<R> {
        if self.is_orthographic {
            Vec3::uniform(position_view.x, [0.0, 0.0, 1.0])
        } else {
            (-position_view).normalize()
        }
    }
}

/// The unit shading normal: `normal` renormalised, negated on back faces (two-sided), and towards the
/// eye where the vertices have none.
#[inline(always)]
pub(crate) fn shading_normal<R: Real>(
    normal: Vec3<R>,
    to_eye: Vec3<R>,
    front_facing: R::Mask,
) -> Vec3<R> {
    let squared = normal.dot(normal);
    let has_one = squared.gt(squared.splat(1e-12));
    let one = squared.splat(1.0);
    let scale = one / squared.sqrt();
    let unit = normal * R::select(front_facing, scale, -scale);
    Vec3::select(has_one, unit, to_eye)
}
