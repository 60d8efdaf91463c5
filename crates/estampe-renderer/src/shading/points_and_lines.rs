//! The shader of points and lines: vertex colours without lighting, with depth cueing, and fog.

use super::VertexTransforms;
use super::output::Fog;
use estampe::{FragmentIn, FragmentOut, Vec3, Vec4, VertexIn, VertexOut};

/// The shader of points and lines.
#[derive(Debug, Clone)]
pub struct PointsAndLines {
    pub transforms: VertexTransforms,
    /// Linear colour, multiplied by the vertex colour.
    pub color: [f32; 3],
    /// Linear colour into which distant points fade (depth cueing).
    pub distant_color: [f32; 3],
    /// Share of this colour at the model's furthest point, in 0..=1; none at its nearest.
    pub share_at_furthest: f32,
    /// Distances of the model's nearest and furthest point along the view direction.
    pub depth_range: (f32, f32),
    pub fog: Option<Fog>,
    /// Width of a point, in pixels.
    pub point_size_px: f32,
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
            let depth = ((distance - nearest) / (furthest - nearest)).saturate();
            let own = color.xyz() * Vec3::uniform(input.zero, self.color);
            let distant = Vec3::uniform(input.zero, self.distant_color);
            let color = own.mix(distant, depth * self.share_at_furthest);
            VertexOut::new(self.transforms.clip(position), color)
                .with_point_size(input.real(self.point_size_px))
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, color: Vec3<R>) -> FragmentOut<R> {
            let color = match &self.fog {
                Some(fog) => fog.color(&input, color),
                None => color,
            };
            FragmentOut::color(color.point())
        }
    }
}
