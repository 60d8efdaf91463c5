//! Light at the vertices: Gouraud's interpolated colours, flat faces, and no light at all.
//!
//! Which side of a triangle is seen is known only after the vertices, so light is computed for both
//! sides, and the fragment takes one.

use super::lighting::{Gloss, LightRig};
use super::{VertexTransforms, shading_normal};
use estampe::{Real, Vec3};
use std::sync::Arc;

/// What light a vertex gets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum VertexTone {
    /// That of its normal, as seen from the eye.
    Gouraud,
    /// That of its face's normal, as seen from infinitely far away, so that all vertices of a face, and
    /// all faces of a plane, get the same.
    Flat,
    /// Just enough to see the base colour.
    Unlit,
}

/// Light at the vertices.
#[derive(Debug, Clone)]
pub(crate) struct VertexLight {
    pub(crate) transforms: VertexTransforms,
    pub(crate) rig: Arc<LightRig>,
    pub(crate) gloss: Gloss,
    pub(crate) tone: VertexTone,
}

/// Light on both sides: diffuse and added of the front, then of the back.
pub(crate) type BothSides<R> = (Vec3<R>, Vec3<R>, Vec3<R>, Vec3<R>);

impl VertexLight {
    /// Light on a vertex of the unit space, with its normal of the object's space.
    #[inline(always)]
    pub(crate) fn both_sides<R: Real>(&self, position: Vec3<R>, normal: Vec3<R>) -> BothSides<R> {
        let to_eye = match self.tone {
            VertexTone::Gouraud => self
                .transforms
                .eye_direction(self.transforms.view(position)),
            VertexTone::Flat => Vec3::uniform(position.x, [0.0, 0.0, 1.0]),
            VertexTone::Unlit => {
                let one = Vec3::uniform(position.x, [1.0; 3]);
                let added = Vec3::uniform(position.x, self.gloss.emissive);
                return (one, added, one, added);
            }
        };
        let yes = to_eye.x.splat_mask(true);
        let normal = shading_normal(self.transforms.normal(normal), to_eye, yes);
        let front = self.rig.illuminate(&self.gloss, normal, to_eye);
        let back = self.rig.illuminate(&self.gloss, -normal, to_eye);
        (front.diffuse, front.added, back.diffuse, back.added)
    }
}

/// The light of the side that is seen, on the base colour.
#[inline(always)]
pub(crate) fn color<R: Real>(base: Vec3<R>, sides: BothSides<R>, front_facing: R::Mask) -> Vec3<R> {
    let (front, front_added, back, back_added) = sides;
    let light = Vec3::select(front_facing, front, back);
    base * light + Vec3::select(front_facing, front_added, back_added)
}
