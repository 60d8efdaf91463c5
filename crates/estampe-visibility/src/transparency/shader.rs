//! The shader of all passes, and its vertices.

use crate::polygon::Corner;
use estampe::{
    FragmentIn, FragmentOut, Mat4, TextureBindings, Vec3, Vec4, VertexFormat, VertexIn, VertexOut,
};

/// The formats of a vertex: position and colour with alpha.
pub(super) const FORMATS: [VertexFormat; 2] = [VertexFormat::Float32x3, VertexFormat::Float32x4];

/// What a fragment gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Output {
    /// Colour and alpha.
    Color,
    /// The depth alone, if the fragment is nearer than the depth in binding 0.
    NearerDepth,
    /// Colour and alpha, if the fragment is nearer than the depth in binding 0.
    NearerColor,
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
                Output::NearerDepth | Output::NearerColor => {
                    let (x, y) = (input.position.x.to_int(), input.position.y.to_int());
                    let zero = x.splat(0);
                    let depths = input.bindings.texture(0, 0);
                    let peeled = depths.fetch([x, y, zero], zero, zero).x;
                    let is_nearer = input.position.z.gt(peeled);
                    let fragment = match self.output {
                        Output::NearerDepth => FragmentOut::none(),
                        _ => FragmentOut::color(v.color),
                    };
                    fragment.discard_unless(is_nearer)
                }
                Output::Weighted => {
                    // Depth is reversed: z = 1 − d.
                    let (z, alpha) = (input.position.z, v.color.w);
                    let weight = alpha * (z * z * z * 3e3).max(1e-2);
                    let scale = alpha * weight;
                    let Vec4 { x, y, z, .. } = v.color;
                    let sum = Vec4::new(x * scale, y * scale, z * scale, scale);
                    FragmentOut::color(sum).with_color(1, Vec3::repeat(alpha).point())
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
