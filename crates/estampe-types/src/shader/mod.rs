//! Shaders: the trait by which they are written in Rust, and the one interface by which all run.
//!
//! A shader is a plain value that implements [`Shader`]: two functions that are generic over the
//! number they compute with, so that the same source runs on one fragment and on sixteen. The value
//! holds its uniforms and shares its textures. [`ShaderProgram`] erases its type once, when a
//! pipeline is created, into a [`Program`], the interface that compiled text shaders implement too.

mod erased;
mod fragment;
mod interface;
mod packets;
mod pass_through;
mod scalar;
mod shader_macro;
mod structs;
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
///         fn fragment<R: Real>(
///             &self,
///             _input: FragmentIn<'_, R>,
///             normal: Vec3<R>,
///         ) -> FragmentOut<R> {
///             let light = normal.normalize().dot_uniform(self.towards_light).saturate();
///             FragmentOut::color(Vec3::repeat(light).point())
///         }
///     }
/// }
/// ```
pub trait Shader: Send + Sync + 'static {
    /// Attributes that a vertex reads, at location 0, 1, … in order: a number, a vector, a tuple of
    /// up to six of those, or a struct of [`attributes!`](crate::attributes).
    type Attributes<R: Real>: Attributes<R>;
    /// Values that a vertex passes to the fragments: a number, a vector, a tuple of up to six of
    /// those, or a struct of [`varyings!`](crate::varyings). The wrappers [`Flat`],
    /// [`NoPerspective`], [`Centroid`] and [`PerSample`] choose the interpolation in tuples.
    type Varyings<R: Real>: Varyings<R>;

    /// Number of colour targets that the fragment writes.
    const COLOR_TARGETS: usize = 1;
    /// Must be set if the fragment may discard.
    const DISCARDS: bool = false;
    /// Depth that the fragment writes.
    const DEPTH_OUTPUT: DepthOutput = DepthOutput::None;
    /// If set, the fragment reads [`FragmentIn::position`]; otherwise that is zero.
    const READS_POSITION: bool = false;
    /// If set, the fragment is shaded once per sample, whose index is [`FragmentIn::sample_index`].
    /// A [`PerSample`] varying has the same effect.
    const PER_SAMPLE: bool = false;
    /// If set, the fragment reads [`FragmentIn::coverage`].
    const READS_COVERAGE: bool = false;
    /// If set, the fragment writes a sample mask: [`FragmentOut::with_sample_mask`].
    const WRITES_SAMPLE_MASK: bool = false;
    /// If set, the fragment stores to [storage textures](crate::StorageTexture). It is then shaded
    /// wherever the primitive covers it, visible or not, and tested afterwards. Vertices must not
    /// store: lanes of a packet beyond the last vertex are shaded too.
    const STORES: bool = false;
    /// If set, the fragment writes a second colour for blending:
    /// [`FragmentOut::with_second_color`]. It then has one target.
    const DUAL_SOURCE: bool = false;
    /// If set, the fragment only returns the first four scalars of its varyings as its colour. The
    /// pipeline then need not call the shader. The claim is tested when the program is created; a
    /// shader that fails the test is called as any other.
    const COLOR_PASSTHROUGH: bool = false;
    /// If set, the shader takes no derivatives, and samples no texture whose level of detail comes
    /// from them. Fragments of several small triangles are then shaded in one packet without their
    /// quads, and derivatives are undefined: neighbouring lanes may belong to other triangles.
    const NO_DERIVATIVES: bool = Self::COLOR_PASSTHROUGH;
    /// If set, fragments are shaded two packets at a time ([`Pair`](crate::Pair)). This pays for
    /// long chains of operations that depend on each other, such as the steps of a ray, because the
    /// chains of the two packets overlap. Both packets stay in a loop until the last lane of both
    /// is done. A short shader only runs out of registers.
    const PAIR_PACKETS: bool = false;
    /// If set, the vertex writes a point size; otherwise points are one pixel wide.
    const WRITES_POINT_SIZE: bool = false;

    /// Number of clip distances that the vertex writes ([`VertexOut::with_clip_distance`]), at most
    /// 8. Primitives are clipped where an interpolated clip distance is negative.
    const CLIP_DISTANCES: usize = 0;
    /// Number of cull distances that the vertex writes ([`VertexOut::with_cull_distance`]), at most
    /// 8. A primitive is dropped if one cull distance is negative at all of its vertices.
    const CULL_DISTANCES: usize = 0;

    /// Shades one vertex: returns its clip-space position and varyings.
    fn vertex<R: Real>(
        &self,
        input: VertexIn<'_, R>,
        attributes: Self::Attributes<R>,
    ) -> VertexOut<R, Self::Varyings<R>>;

    /// Shades one fragment: returns its colours.
    fn fragment<R: Real>(
        &self,
        input: FragmentIn<'_, R>,
        varyings: Self::Varyings<R>,
    ) -> FragmentOut<R>;
}

/// A texture as a shader sees it: sampled at (u, v), with the level of detail from the quad's
/// derivatives.
pub trait Sample2d: Send + Sync {
    /// The filtered texel: linear values in 0..=1.
    fn sample<R: Real>(&self, uv: Vec2<R>) -> Vec4<R>;
}

/// A compiled shader: the interface that the pipeline calls, one batch of packets at a time.
///
/// Implementations must stay inside the batch's slices, and must give the same bits at every SIMD
/// level.
pub trait Program: Send + Sync + std::fmt::Debug {
    /// The inputs and outputs of the program.
    fn interface(&self) -> &Interface;
    /// Shades packets of vertices.
    fn run_vertices(&self, level: Level, bindings: &Bindings, batch: VertexBatch<'_>);
    /// Shades packets of fragments.
    fn run_fragments(&self, level: Level, bindings: &Bindings, batch: FragmentBatch<'_>);
}
