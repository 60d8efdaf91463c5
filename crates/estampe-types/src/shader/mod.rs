//! Shaders: the trait by which they are written in Rust, and the one interface by which all run.
//!
//! A shader is a plain value that implements [`Shader`]: two functions that are generic over the
//! number they compute with, so that the same source runs on one fragment and on sixteen. The value
//! holds its uniforms and shares its textures. [`ShaderProgram`] erases its type once, when a
//! pipeline is created, into a [`Program`], the interface that compiled text shaders implement too.

mod alpha_test;
mod amplification;
mod compute;
mod declaration;
mod dry_run;
mod erased;
mod error;
mod fragment;
mod gradient;
mod interface;
mod packets;
mod scalar;
mod shader_macro;
mod stopped;
mod structs;
mod texture_reads;
mod varyings;
mod vertex;

pub use alpha_test::{
    ALPHA_CELLS, ALPHA_STEPS, AlphaMap, AlphaMapKey, AlphaMaps, AlphaTest, AlphaTestRequest,
};
pub use amplification::{
    ControlBatch, ControlIn, Emit, EmittedVertex, EvaluationBatch, EvaluationIn, GeometryBatch,
    GeometryIn, GeometryInterface, GeometryPrimitive, GeometryProgram, GeometryShader,
    GeometryShaderProgram, GeometryTopology, MAX_GEOMETRY_INVOCATIONS, MAX_GEOMETRY_VERTICES,
    OutputInterface, PatchIn, Points, ShadedPoint, TessellationInterface, TessellationLevels,
    TessellationProgram, TessellationShader, TessellationShaderProgram,
};
pub use compute::{ComputeInterface, ComputeProgram, ComputeStopped, WorkgroupOrder, Workgroups};
pub use dry_run::interface_of;
#[cfg(test)]
pub(crate) use erased::AtATime;
pub use erased::ShaderProgram;
pub use error::ShaderError;
pub use fragment::{FragmentBatch, FragmentIn, FragmentOut};
pub use gradient::WithGradient;
pub use interface::{DepthOutput, Interface, Interpolation, Sampling};
pub use stopped::StoppedBatches;
pub use texture_reads::TextureReads;
pub use varyings::{Attributes, Centroid, Flat, NoPerspective, PerSample, Sink, Source, Varyings};
pub use vertex::{MAX_DISTANCES, VertexBatch, VertexIn, VertexOut};

pub use estampe_simd::{LANES, Level, Packet};

use crate::{BindGroupLayout, Bindings, Real, Vec2, Vec4};

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
///
/// # The interface
///
/// The pipeline needs to know which inputs a shader reads and which outputs it sets. It finds out
/// by a *dry run*: when [`ShaderProgram::new`] wraps a shader, it runs the vertex and the fragment
/// function a few times on numbers that record what is done to them. So a body that calls
/// [`FragmentOut::discard_unless`], reads [`FragmentIn::position`] or sets a clip distance needs no
/// declaration.
///
/// The dry run is done with the shader's own value, so branches on its fields are those that will
/// be taken. Branches on masks ([`Real::any`], [`Real::all`]) are tried both ways. Nothing is
/// bound, and numbers from bindings are tried as 0, 1, 2 and 3. **A use that depends on bindings
/// otherwise must be declared** by the constant of that use: `COLOR_TARGETS`, `DISCARDS`,
/// `DEPTH_OUTPUT`, `READS_POSITION`, `PER_SAMPLE`, `READS_COVERAGE`, `WRITES_SAMPLE_MASK`,
/// `STORES`, `DUAL_SOURCE`, `TAKES_DERIVATIVES`, `WRITES_POINT_SIZE`, `CLIP_DISTANCES` and
/// `CULL_DISTANCES`. They widen what is found, and never narrow it. A declared use that does not
/// happen costs some time.
///
/// An output that is neither found nor declared has no effect, and stops a debug build with a
/// sentence that names the constant; derivatives that are neither are undefined, and stop it too.
/// An input that is neither reads as zeros. A shader that sets a colour or a distance beyond the
/// limit, or panics in its dry run, is refused when a pipeline is created, with a [`ShaderError`].
///
/// # What makes shaders fast
///
/// The dry run also finds what saves time, and no constant promises it:
///
/// * Fragments that take **no derivatives**, neither explicit nor those of textures, are shaded
///   without their quads, so that those of several triangles share a packet. Textures take none if
///   they are sampled at a varying with its [gradient](WithGradient), or at a given level.
/// * If the one colour of a fragment is the first four scalars of its varyings **as they are**, the
///   shader is not called at all.
///
/// Both hold only of a body that branches on no mask, looks at no single lane, and does not ask
/// [`Bindings`] for a resource that may be missing, but for a texture or a shadow map.
pub trait Shader: Send + Sync + 'static {
    /// Attributes that a vertex reads, at location 0, 1, … in order: a number, a vector, a tuple of
    /// up to six of those, or a struct of [`attributes!`](crate::attributes).
    type Attributes<R: Real>: Attributes<R>;
    /// Values that a vertex passes to the fragments: a number, a vector, a tuple of up to six of
    /// those, or a struct of [`varyings!`](crate::varyings). The wrappers [`Flat`],
    /// [`NoPerspective`], [`Centroid`] and [`PerSample`] choose the interpolation in tuples.
    type Varyings<R: Real>: Varyings<R>;

    /// Declares at least this many colour targets ([`FragmentOut::with_color`]), at most 8. Targets
    /// that the fragment does not set are given zeros.
    const COLOR_TARGETS: usize = 0;
    /// Declares that the fragment may discard ([`FragmentOut::discard_unless`]).
    const DISCARDS: bool = false;
    /// Declares that the fragment may set its depth ([`FragmentOut::with_depth`]). Fragments that
    /// do not set it keep the interpolated depth. [`DepthOutput::Greater`] and
    /// [`DepthOutput::Less`] are never found, and save work: depths are held to them.
    const DEPTH_OUTPUT: DepthOutput = DepthOutput::None;
    /// Declares that the fragment may read [`FragmentIn::position`].
    const READS_POSITION: bool = false;
    /// Declares that the fragment is shaded once per sample, whose index is
    /// [`FragmentIn::sample_index`]. A [`PerSample`] varying has the same effect.
    const PER_SAMPLE: bool = false;
    /// Declares that the fragment may read [`FragmentIn::coverage`].
    const READS_COVERAGE: bool = false;
    /// Declares that the fragment may set a sample mask ([`FragmentOut::with_sample_mask`]).
    const WRITES_SAMPLE_MASK: bool = false;
    /// Declares that the fragment may store to [storage textures](crate::StorageTexture). It is
    /// then shaded wherever the primitive covers it, visible or not, and tested afterwards. Stores
    /// must exclude [helper invocations](FragmentIn::is_helper). Vertices must not store: lanes of
    /// a packet beyond the last vertex are shaded too.
    const STORES: bool = false;
    /// Promises that what the fragment stores does not depend on the order in which different
    /// pixels are shaded: each pixel has texels of its own. Without the promise, a pass with this
    /// shader is drawn by one thread, so that its bits do not depend on threads.
    const STORES_IN_ANY_ORDER: bool = false;
    /// Declares that the fragment may take derivatives ([`Real::ddx`]), or sample a texture whose
    /// level of detail comes from them.
    const TAKES_DERIVATIVES: bool = false;
    /// Declares that the fragment may set a second colour for blending
    /// ([`FragmentOut::with_second_color`]). It then has one target.
    const DUAL_SOURCE: bool = false;
    /// Declares that the vertex may set a point size ([`VertexOut::with_point_size`]). Points whose
    /// size is not set are one pixel wide.
    const WRITES_POINT_SIZE: bool = false;
    /// Declares at least this many clip distances ([`VertexOut::with_clip_distance`]), at most 8.
    const CLIP_DISTANCES: usize = 0;
    /// Declares at least this many cull distances ([`VertexOut::with_cull_distance`]), at most 8.
    const CULL_DISTANCES: usize = 0;

    /// If set, outputs that the interface lacks stop the program; [`shader!`](macro@crate::shader)
    /// sets it in debug builds of the shader's crate.
    #[doc(hidden)]
    const ASSERTS_OUTPUTS: bool = cfg!(debug_assertions);

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
    /// Called when a pipeline is created of the program. Shaders in Rust report here how they
    /// contradict [their interface](Shader#the-interface).
    ///
    /// # Errors
    /// [`ShaderError`] says what is wrong; no pipeline is then created.
    fn validate(&self) -> Result<(), ShaderError> {
        Ok(())
    }
    /// The layouts of the groups that the program binds, by group number; those that a pipeline of
    /// it has if no others are given. Shaders in Rust do not declare them.
    fn bind_group_layouts(&self) -> &[BindGroupLayout] {
        &[]
    }
    /// The bytes of immediates that the program reads: each draw must give at least as many.
    /// Shaders in Rust do not declare them.
    fn immediate_size(&self) -> u32 {
        0
    }
    /// The batches that were stopped, of programs that may not end. Shaders in Rust are not
    /// stopped.
    fn stopped_batches(&self) -> Option<&StoppedBatches> {
        None
    }
    /// How shaders may read the texture at this place. What a pass has just drawn need not be
    /// brought into rows if they only compare it, or load it at their own pixel. Shaders in Rust do
    /// not say.
    fn texture_reads(&self, _group: u32, _binding: u32) -> TextureReads {
        TextureReads::ALL
    }
    /// What decides alone whether a fragment has any effect, if that is the alpha of a texture.
    /// Fragments that fail it are not shaded. Shaders in Rust have none.
    fn alpha_test(&self, _bindings: &Bindings, _request: AlphaTestRequest) -> Option<AlphaTest> {
        None
    }
    /// Shades packets of vertices.
    fn run_vertices(&self, level: Level, bindings: &Bindings, batch: VertexBatch<'_>);
    /// Shades packets of fragments.
    fn run_fragments(&self, level: Level, bindings: &Bindings, batch: FragmentBatch<'_>);
}
