//! Light at the vertices: Gouraud's interpolated colours, and flat faces.
//!
//! Which side of a triangle is seen is known only after the vertices, so light is computed for both
//! sides, and the fragment takes one.

use super::base_color::BaseColor;
use super::lighting::{Gloss, LightRig};
use super::{VertexTransforms, shading_normal};
use estampe::{Flat, FragmentIn, FragmentOut, Real, Vec3, VertexIn, VertexOut};
use std::sync::Arc;

/// What both shaders need.
#[derive(Debug, Clone)]
pub(crate) struct VertexLighting {
    pub(crate) transforms: VertexTransforms,
    pub(crate) rig: Arc<LightRig>,
    pub(crate) gloss: Gloss,
}

/// Light on both sides: diffuse and added of the front, then of the back.
type BothSides<R> = (Vec3<R>, Vec3<R>, Vec3<R>, Vec3<R>);

impl VertexLighting {
    #[inline(always)]
    fn both_sides<R: Real>(&self, normal: Vec3<R>, to_eye: Vec3<R>) -> BothSides<R> {
        let yes = to_eye.x.splat_mask(true);
        let normal = shading_normal(normal, to_eye, yes);
        let front = self.rig.illuminate(&self.gloss, normal, to_eye);
        let back = self.rig.illuminate(&self.gloss, -normal, to_eye);
        (front.diffuse, front.added, back.diffuse, back.added)
    }
}

/// The light of the side that is seen, on the base colour.
#[inline(always)]
fn seen_side<R: Real>(sides: BothSides<R>, base: Vec3<R>, front_facing: R::Mask) -> Vec3<R> {
    let (front, front_added, back, back_added) = sides;
    let diffuse = Vec3::select(front_facing, front, back);
    base * diffuse + Vec3::select(front_facing, front_added, back_added)
}

/// The shader of surfaces lit at their vertices.
#[derive(Debug, Clone)]
pub(crate) struct Gouraud<B> {
    pub(crate) lighting: VertexLighting,
    pub(crate) base: B,
}

estampe::shader! {
    impl<B: BaseColor> Shader for Gouraud<B> {
        type Attributes<R: Real> = (Vec3<R>, Vec3<R>, B::Attributes<R>); // position, normal
        type Varyings<R: Real> = (BothSides<R>, B::Varyings<R>);
        const DISCARDS: bool = B::MASKS;

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, normal, base): (Vec3<R>, Vec3<R>, B::Attributes<R>),
        ) -> VertexOut<R, (BothSides<R>, B::Varyings<R>)> {
            let transforms = &self.lighting.transforms;
            let to_eye = transforms.eye_direction(transforms.view(position));
            let sides = self.lighting.both_sides(transforms.normal(normal), to_eye);
            VertexOut::new(transforms.clip(position), (sides, self.base.vertex(base)))
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            (sides, base): (BothSides<R>, B::Varyings<R>),
        ) -> FragmentOut<R> {
            let base = self.base.fragment(base, input.zero);
            let color = seen_side(sides, base.xyz(), input.front_facing);
            let out = FragmentOut::color(color.extend(base.w));
            if B::MASKS { out.keep_where(base.w.ge(input.real(0.5))) } else { out }
        }
    }
}

/// The shader of surfaces whose faces have one light each. It is given the faces' normals, and looks at
/// them from infinitely far away, so that faces of one plane look the same.
#[derive(Debug, Clone)]
pub(crate) struct FlatFaces<B> {
    pub(crate) lighting: VertexLighting,
    pub(crate) base: B,
}

/// [`BothSides`] of the provoking vertex.
type FlatSides<R> = Flat<BothSides<R>>;

estampe::shader! {
    impl<B: BaseColor> Shader for FlatFaces<B> {
        type Attributes<R: Real> = (Vec3<R>, Vec3<R>, B::Attributes<R>); // position, face normal
        type Varyings<R: Real> = (FlatSides<R>, B::Varyings<R>);
        const DISCARDS: bool = B::MASKS;

        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            (position, normal, base): (Vec3<R>, Vec3<R>, B::Attributes<R>),
        ) -> VertexOut<R, (FlatSides<R>, B::Varyings<R>)> {
            let transforms = &self.lighting.transforms;
            let to_eye = Vec3::uniform(input.zero, [0.0, 0.0, 1.0]);
            let sides = self.lighting.both_sides(transforms.normal(normal), to_eye);
            VertexOut::new(transforms.clip(position), (Flat(sides), self.base.vertex(base)))
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            (sides, base): (FlatSides<R>, B::Varyings<R>),
        ) -> FragmentOut<R> {
            let base = self.base.fragment(base, input.zero);
            let color = seen_side(sides.0, base.xyz(), input.front_facing);
            let out = FragmentOut::color(color.extend(base.w));
            if B::MASKS { out.keep_where(base.w.ge(input.real(0.5))) } else { out }
        }
    }
}
