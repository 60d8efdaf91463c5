//! How a shader is written in Rust, and the one interface behind which every shader runs.
//!
//! A shader is a plain value that implements [`Shader`]: two functions, generic over the number they
//! compute with, so that the same text runs on one fragment and on sixteen. It owns its uniforms and
//! shares its textures. [`ShaderProgram`] erases its type once, when a pipeline is made, into a
//! [`Program`]: the interface that compiled text shaders implement too.

mod erased;
mod fragment;
mod interface;
mod packets;
mod pass_through;
mod scalar;
mod varyings;
mod vertex;

pub use erased::ShaderProgram;
pub use fragment::{FragmentBatch, FragmentIn, FragmentOut};
pub use interface::{DepthOutput, Interface, Interpolation, Sampling};
pub use varyings::{Attributes, Centroid, Flat, NoPerspective, PerSample, Sink, Source, Varyings};
pub use vertex::{MAX_DISTANCES, VertexBatch, VertexIn, VertexOut};

use crate::{Bindings, Real, Vec2, Vec4};
use estampe_simd::Level;

/// A vertex and a fragment shader in Rust.
///
/// Write the implementation inside [`shader!`](macro@crate::shader): it marks the functions
/// `#[inline(always)]`, without which the sixteen-lane form is compiled without SIMD.
///
/// ```
/// use estampe_types::{Mat4, Real, Shader, Vec3, shader::*};
///
/// struct Lit { clip_from_object: Mat4, towards_light: [f32; 3] }
///
/// estampe_types::shader! {
///     impl Shader for Lit {
///         type Attributes<R: Real> = (Vec3<R>, Vec3<R>); // position, normal
///         type Varyings<R: Real> = Vec3<R>;              // normal
///
///         fn vertex<R: Real>(
///             &self,
///             _input: VertexIn<'_, R>,
///             (position, normal): (Vec3<R>, Vec3<R>),
///         ) -> VertexOut<R, Vec3<R>> {
///             VertexOut::new(self.clip_from_object.transform_point(position), normal)
///         }
///
///         fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, normal: Vec3<R>) -> FragmentOut<R> {
///             let light = normal.normalize().dot_uniform(self.towards_light).saturate();
///             FragmentOut::color(Vec3::repeat(light).point())
///         }
///     }
/// }
/// ```
pub trait Shader: Send + Sync + 'static {
    /// What a vertex reads: location 0, 1, … in order; a number, a vector or a tuple of those.
    type Attributes<R: Real>: Attributes<R>;
    /// What a vertex hands to the fragments: a number, a vector or a tuple of those; [`Flat`] and
    /// [`NoPerspective`] around one choose its interpolation.
    type Varyings<R: Real>: Varyings<R>;

    /// How many colour targets the fragment writes.
    const COLOR_TARGETS: usize = 1;
    /// Whether the fragment may discard.
    const DISCARDS: bool = false;
    /// Whether the fragment writes its depth.
    const DEPTH_OUTPUT: DepthOutput = DepthOutput::None;
    /// Whether the fragment reads [`FragmentIn::position`]; where not, it is zero.
    const READS_POSITION: bool = false;
    /// Whether the fragment is shaded once for each sample, which it finds in [`FragmentIn::sample_index`]. So it is
    /// in any case if a varying is [`PerSample`].
    const PER_SAMPLE: bool = false;
    /// Whether the fragment reads [`FragmentIn::coverage`].
    const READS_COVERAGE: bool = false;
    /// Whether the fragment says which samples it keeps: [`FragmentOut::with_sample_mask`].
    const WRITES_SAMPLE_MASK: bool = false;
    /// Whether the fragment stores to [storage textures](crate::StorageTexture). It is then shaded wherever the
    /// primitive covers it, hidden or not, and tested afterwards. Vertices must not store: lanes of a packet beyond
    /// the last vertex are shaded too.
    const STORES: bool = false;
    /// Whether the fragment gives a second colour for blending: [`FragmentOut::with_second_color`]. It then has one
    /// target.
    const DUAL_SOURCE: bool = false;
    /// Whether the fragment's colour is the first four scalars of its varyings as they are, and nothing
    /// else: a pass-through shader, which the pipeline need not call. It is tried when the program is made;
    /// one that does otherwise is called.
    const PASSES_COLOR: bool = false;
    /// Whether a fragment depends on its own inputs alone: the shader takes no derivatives, and samples no
    /// texture whose level of detail comes from them. Fragments of small triangles are then shaded without
    /// their quads. A shader that says so and takes derivatives gets those of strangers.
    const INDEPENDENT_FRAGMENTS: bool = Self::PASSES_COLOR;
    /// Whether the fragment's time goes by in long chains of operations each of which waits for the one before,
    /// such as the steps of a ray. Fragments are then shaded two packets at a time ([`Pair`](crate::Pair)), so that
    /// the two chains overlap. Both packets stay in a loop until the last lane of both is done; and a short
    /// shader only runs out of registers that way.
    const LONG_CHAINS: bool = false;
    /// Whether the vertex sets a point size; where not, points are one pixel.
    const WRITES_POINT_SIZE: bool = false;

    /// How many clip distances the vertex gives ([`VertexOut::with_clip_distance`]), at most 8: primitives are cut
    /// where one of them, interpolated, is negative.
    const CLIP_DISTANCES: usize = 0;
    /// How many cull distances it gives ([`VertexOut::with_cull_distance`]), at most 8: a primitive is dropped
    /// if one of them is negative at all of its vertices.
    const CULL_DISTANCES: usize = 0;

    /// One vertex: its clip-space position and varyings.
    fn vertex<R: Real>(
        &self,
        input: VertexIn<'_, R>,
        attributes: Self::Attributes<R>,
    ) -> VertexOut<R, Self::Varyings<R>>;

    /// One fragment: its colours.
    fn fragment<R: Real>(
        &self,
        input: FragmentIn<'_, R>,
        varyings: Self::Varyings<R>,
    ) -> FragmentOut<R>;
}

/// A texture as a shader sees it: sampled at (u, v), level of detail from the quad's derivatives.
pub trait Sample2d: Send + Sync {
    /// The filtered texel: linear values in 0..=1.
    fn sample<R: Real>(&self, uv: Vec2<R>) -> Vec4<R>;
}

/// A compiled shader: the one interface that the pipeline calls, a batch of packets at a time.
///
/// Implementations must not read or write beyond the batch's slices and must give the same bits at
/// every level.
pub trait Program: Send + Sync + std::fmt::Debug {
    /// What goes in and out.
    fn interface(&self) -> &Interface;
    /// Shades packets of vertices.
    fn run_vertices(&self, level: Level, bindings: &Bindings, batch: VertexBatch<'_>);
    /// Shades packets of fragments.
    fn run_fragments(&self, level: Level, bindings: &Bindings, batch: FragmentBatch<'_>);
}

/// Implements [`Shader`] with every function `#[inline(always)]`.
#[macro_export]
macro_rules! shader {
    (impl $(<$($generic:ident: $bound:path),*>)? Shader for $shader:ty { $($items:tt)* }) => {
        impl $(<$($generic: $bound),*>)? $crate::Shader for $shader {
            $crate::shader! { @items $($items)* }
        }
    };
    (@items) => {};
    (@items type $name:ident<$r:ident: Real> = $type:ty; $($rest:tt)*) => {
        type $name<$r: $crate::Real> = $type;
        $crate::shader! { @items $($rest)* }
    };
    (@items const $name:ident: $type:ty = $value:expr; $($rest:tt)*) => {
        const $name: $type = $value;
        $crate::shader! { @items $($rest)* }
    };
    (@items fn $name:ident<$r:ident: Real>($($inputs:tt)*) -> $out:ty $body:block $($rest:tt)*) => {
        #[inline(always)]
        fn $name<$r: $crate::Real>($($inputs)*) -> $out $body
        $crate::shader! { @items $($rest)* }
    };
}
