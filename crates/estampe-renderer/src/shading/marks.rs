//! Points and lines: they have a colour and no normal; what is further away is paler.

use super::VertexTransforms;
use estampe::{FragmentIn, FragmentOut, Vec3, Vec4, VertexIn, VertexOut};

/// The shader of points and lines.
#[derive(Debug, Clone)]
pub(crate) struct Marks {
    pub(crate) transforms: VertexTransforms,
    /// Linear colour, times the vertex colour.
    pub(crate) color: [f32; 3],
    /// What the colour fades to with distance.
    pub(crate) haze: [f32; 3],
    /// How much of it has faded at the model's furthest point, in 0..=1.
    pub(crate) fading: f32,
    /// Distances of the model's nearest and furthest point along the view direction.
    pub(crate) depth_range: (f32, f32),
    /// Width of a point, in pixels.
    pub(crate) point_size_px: f32,
}

estampe::shader! {
    impl Shader for Marks {
        type Attributes<R: Real> = (Vec3<R>, Vec4<R>); // position, color
        type Varyings<R: Real> = Vec3<R>;
        const WRITES_POINT_SIZE: bool = true;

        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            (position, color): (Vec3<R>, Vec4<R>),
        ) -> VertexOut<R, Vec3<R>> {
            let (nearest, furthest) = self.depth_range;
            let distance = -self.transforms.view(position).z;
            let faded = ((distance - nearest) / (furthest - nearest)).saturate() * self.fading;
            let own = color.xyz() * Vec3::uniform(input.zero, self.color);
            let color = own.mix(Vec3::uniform(input.zero, self.haze), faded);
            VertexOut::new(self.transforms.clip(position), color)
                .with_point_size(input.real(self.point_size_px))
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, color: Vec3<R>) -> FragmentOut<R> {
            FragmentOut::color(color.point())
        }
    }
}
