//! The shader of all passes, and its vertices.

use crate::polygon::Corner;
use estampe::{FragmentIn, FragmentOut, Mat4, Vec3, Vec4, VertexFormat, VertexIn, VertexOut};
use estampe_transparency::{DepthOrder, weighted_fragment};

/// The formats of a vertex: position and colour with alpha.
pub(super) const FORMATS: [VertexFormat; 2] = [VertexFormat::Float32x3, VertexFormat::Float32x4];

/// What a fragment gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Output {
    /// Colour and alpha.
    Color,
    /// Weighted colour and alpha, and alpha in a second target.
    Weighted,
}

/// Polygons in world space, each corner with its colour.
pub(super) struct Tinted {
    pub(super) clip_from_world: Mat4,
    pub(super) output: Output,
}

estampe::attributes! {
    pub(super) struct TintedCorner<R> { position: Vec3<R>, color: Vec4<R> }
}

estampe::varyings! {
    pub(super) struct Tint<R> { color: Vec4<R> }
}

estampe::shader! {
    impl Shader for Tinted {
        type Attributes<R: Real> = TintedCorner<R>;
        type Varyings<R: Real> = Tint<R>;

        fn vertex<R: Real>(
            &self,
            _: VertexIn<'_, R>,
            a: TintedCorner<R>,
        ) -> VertexOut<R, Tint<R>> {
            let clip = self.clip_from_world.transform_point(a.position);
            VertexOut::new(clip, Tint { color: a.color })
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, v: Tint<R>) -> FragmentOut<R> {
            match self.output {
                Output::Color => FragmentOut::color(v.color),
                Output::Weighted => {
                    weighted_fragment(DepthOrder::NearIsOne, v.color, input.position.z)
                }
            }
        }
    }
}

/// The vertices of convex polygons as triangles; colours without alpha are opaque.
pub(super) fn vertices<'p, const N: usize>(
    polygons: impl Iterator<Item = &'p [Corner<N>]>,
) -> Vec<f32> {
    let mut numbers = Vec::new();
    for corners in polygons {
        for k in 2..corners.len() {
            for corner in [&corners[0], &corners[k - 1], &corners[k]] {
                #[expect(
                    clippy::cast_possible_truncation,
                    reason = "rounds to the nearest float"
                )]
                numbers.extend(corner.position.map(|x| x as f32));
                let of = |k: usize| corner.attributes.get(k).copied().unwrap_or(1.0);
                numbers.extend([of(0), of(1), of(2), of(3)]);
            }
        }
    }
    numbers
}
