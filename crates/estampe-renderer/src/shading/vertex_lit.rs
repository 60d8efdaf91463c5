//! Lighting at the vertices: Gouraud's interpolated colours, flat faces, and unlit surfaces.
//!
//! The facing of a triangle is known only after vertex shading, so light is computed for both
//! sides, and the fragment selects one.

use super::lighting::{Gloss, Lights};
use super::{VertexTransforms, shading_normal};
use estampe::{Real, Vec3};
use std::sync::Arc;

/// Lighting of a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum VertexShadingMode {
    /// With the vertex normal, seen from the eye.
    Gouraud,
    /// With the face's normal, seen from infinitely far away, so that all vertices of a face, and
    /// all faces of a plane, have the same light.
    Flat,
    /// Full diffuse light, so that the base colour is unchanged.
    Unlit,
}

/// Lighting at the vertices.
#[derive(Debug, Clone)]
pub(crate) struct VertexLight {
    pub(crate) transforms: VertexTransforms,
    pub(crate) lights: Arc<Lights>,
    pub(crate) gloss: Gloss,
    pub(crate) mode: VertexShadingMode,
}

/// Light on both sides: diffuse and added light of the front, then of the back.
pub(crate) type BothSides<R> = (Vec3<R>, Vec3<R>, Vec3<R>, Vec3<R>);

impl VertexLight {
    /// Light on a vertex, given its position in unit space and its normal in object space.
    #[inline(always)]
    pub(crate) fn both_sides<R: Real>(&self, position: Vec3<R>, normal: Vec3<R>) -> BothSides<R> {
        let to_eye = match self.mode {
            VertexShadingMode::Gouraud => self
                .transforms
                .eye_direction(self.transforms.view(position)),
            VertexShadingMode::Flat => Vec3::uniform(position.x, [0.0, 0.0, 1.0]),
            VertexShadingMode::Unlit => {
                let one = Vec3::uniform(position.x, [1.0; 3]);
                let added = Vec3::uniform(position.x, self.gloss.emissive);
                return (one, added, one, added);
            }
        };
        let yes = to_eye.x.splat_mask(true);
        let normal = shading_normal(self.transforms.normal(normal), to_eye, yes);
        let front = self.lights.illuminate(&self.gloss, normal, to_eye);
        let back = self.lights.illuminate(&self.gloss, -normal, to_eye);
        (front.diffuse, front.added, back.diffuse, back.added)
    }
}

/// The base colour in the light of the facing side.
#[inline(always)]
pub(crate) fn color<R: Real>(
    base: Vec3<R>,
    sides: BothSides<R>,
    front_facing: R::SelectMask,
) -> Vec3<R> {
    let (front, front_added, back, back_added) = sides;
    let light = Vec3::select(front_facing, front, back);
    base * light + Vec3::select(front_facing, front_added, back_added)
}
