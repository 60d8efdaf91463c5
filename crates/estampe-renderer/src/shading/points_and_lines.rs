//! The shader of points and lines: vertex colours without lighting, with linear fog (depth cueing).

use super::VertexTransforms;
use estampe::{FragmentIn, FragmentOut, Vec3, Vec4, VertexIn, VertexOut};

/// The shader of points and lines.
#[derive(Debug, Clone)]
pub(crate) struct PointsAndLines {
    pub(crate) transforms: VertexTransforms,
    /// Linear colour, multiplied by the vertex colour.
    pub(crate) color: [f32; 3],
    /// Linear colour of the fog (depth cueing).
    pub(crate) fog_color: [f32; 3],
    /// Share of fog in the colour at the model's furthest point, in 0..=1; none at its nearest.
    pub(crate) fog_at_furthest: f32,
    /// Distances of the model's nearest and furthest point along the view direction.
    pub(crate) depth_range: (f32, f32),
    /// Width of a point, in pixels.
    pub(crate) point_size_px: f32,
}

estampe::shader! {
    impl Shader for PointsAndLines {
        type Attributes<R: Real> = (Vec3<R>, Vec4<R>); // position, color
        type Varyings<R: Real> = Vec3<R>;

        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            (position, color): (Vec3<R>, Vec4<R>),
        ) -> VertexOut<R, Vec3<R>> {
            let (nearest, furthest) = self.depth_range;
            let distance = -self.transforms.view(position).z;
            let fog = ((distance - nearest) / (furthest - nearest)).saturate() * self.fog_at_furthest;
            let own = color.xyz() * Vec3::uniform(input.zero, self.color);
            let color = own.mix(Vec3::uniform(input.zero, self.fog_color), fog);
            VertexOut::new(self.transforms.clip(position), color)
                .with_point_size(input.real(self.point_size_px))
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, color: Vec3<R>) -> FragmentOut<R> {
            FragmentOut::color(color.point())
        }
    }
}
