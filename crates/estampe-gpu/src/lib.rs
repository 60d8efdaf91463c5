#![forbid(unsafe_code)]
//! **estampe**: a complete GPU in software. The whole real-time graphics pipeline on the CPU,
//! programmable in Rust, WGSL and GLSL, with the same bits on every machine, and no driver, display
//! or system library.
//!
//! The API has WebGPU's nouns: a [`Device`] creates [`Buffer`]s, [`Texture`]s, [`BindGroup`]s and
//! [`RenderPipeline`]s, and draws a [`RenderPass`] of [`Draw`]s into views of textures. A shader is
//! text, of which [`Device::create_shader_module`] makes a [`ShaderModule`], or a Rust value that
//! implements [`Shader`]: see [`shader!`], and `docs/from-glsl.md` for those who know GLSL or WGSL.
//! It finds the textures that a draw binds through [`TextureBindings`]. [`Mat4`] has the transforms
//! of models and cameras, [`transforms`] all of them in f64. Spaces, rounding and the order of
//! every operation are in `docs/NUMERICS.md`.
//!
//! # Features
//!
//! `shader-text` is on by default.
//!
//! | feature | adds |
//! |---|---|
//! | `shader-text` | shaders as text: WGSL, GLSL and SPIR-V; a Rust shader needs none of it, and a first debug build takes half the processor's time without |
//! | `image` | `Device::create_texture_from_image` and `Device::read_image`: textures and the `image` crate |
//! | `png` | `Device::encode_png` and `Device::write_png`: textures as PNG files |
//! | `scalar-level` | the scalar SIMD level, for tests |
//!
//! # Debug builds
//!
//! Cargo does not optimise debug builds, and lane code without optimisation is 70 to 250 times
//! slower. Put this into the `Cargo.toml` of your workspace:
//!
//! ```toml
//! [profile.dev]
//! opt-level = 1 # your shaders are compiled in your crate
//!
//! [profile.dev.package."*"] # estampe and all other dependencies
//! debug = false
//! debug-assertions = false
//! overflow-checks = false
//! ```
//!
//! A debug build then draws at about half the speed of a release build. With debug
//! assertions and overflow checks the pipeline checks its own invariants and takes 1.4 times as
//! long to compile.
//!
//! The first build, debug or release, takes a fifth less with two lines in `.cargo/config.toml`.
//! They keep LLVM from writing down what does not overlap at every load and store of lane code;
//! what it makes is as fast:
//!
//! ```toml
//! [build]
//! rustflags = ["-C", "llvm-args=-enable-noalias-to-md-conversion=false"]
//! ```

mod bind_group;
mod blit;
mod buffer;
mod command;
mod compute;
mod copy;
mod device;
mod immediates;
mod inspect;
mod pass;
#[cfg(feature = "png")]
mod png_file;
#[cfg(any(feature = "image", feature = "png"))]
mod rgba;
#[cfg(feature = "image")]
mod rgba_image;
#[cfg(feature = "shader-text")]
mod shader_module;
mod texture;
pub mod transforms;

/// The README's snippet, compiled and run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// The snippets of the page for those who know GLSL or WGSL.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/from-glsl.md")]
struct FromGlsl;

/// The snippets of the page for those who know wgpu.
#[cfg(all(doctest, feature = "shader-text"))]
#[doc = include_str!("../../../docs/from-wgpu.md")]
struct FromWgpu;

/// The sRGB transfer function (IEC 61966-2-1) of 8-bit codes.
pub mod srgb {
    pub use estampe_format::srgb::{decode, encode};
}

/// The 2×2 box filter of texels of four 8-bit channels, by which mip levels are made.
pub mod box_filter {
    pub use estampe_format::box_filter::{Averaged, halve_rows};
}

pub use bind_group::{BindGroup, BindGroupDescriptor, BindGroupError, BindingResource};
pub use blit::{BlitError, BlitRegion};
pub use buffer::{
    Buffer, BufferConflict, BufferDescriptor, BufferError, BufferNumber, BufferSlice, BufferUsages,
    bytes_of,
};
pub use command::{Command, CommandError, SubmitError};
pub use compute::{
    ComputePipeline, ComputePipelineDescriptor, ComputePipelineError, Dispatch, DispatchError,
    DispatchErrorKind, DispatchSize,
};
pub use copy::CopyError;
pub use device::{Device, DeviceDescriptor, DeviceError};
pub(crate) use estampe_core::Context;
pub use estampe_core::profile::JobTimings;
pub use estampe_core::{
    LoadOp, OcclusionQueries, PassControl, PathCounts, PipelineError, RenderPassError as DrawError,
    RenderPipeline, RenderPipelineDescriptor, ResolveMode, Statistics, TessellatedDomain,
    TessellationState, ThreadPool, ThreadPoolBuilder, TilePath, ViewportScissor,
};
pub use estampe_simd::{Level, LevelError};
pub use estampe_texture::{
    Coordinates, Lod, SampledTexture, TexelView, TextureBindings, TextureCoordinates,
    sample_compare_level, sample_compare_sum, storage_load, storage_store,
};
pub use estampe_types::shader::{
    ComputeInterface, ComputeProgram, ComputeStopped, ControlIn, DepthOutput, Emit, EmittedVertex,
    EvaluationIn, GeometryIn, GeometryPrimitive, GeometryProgram, GeometryShader,
    GeometryShaderProgram, GeometryTopology, Interpolation, PatchIn, Points, Sample2d, Sampling,
    ShadedPoint, TessellationLevels, TessellationProgram, TessellationShader,
    TessellationShaderProgram, VertexOut, WorkgroupOrder, Workgroups,
};
pub use estampe_types::{
    AddressMode, Attributes, BindGroupLayout, BindGroupLayoutEntry, BindingType, Bindings,
    BorderColor, BufferBindingType, Centroid, FilterMode, Flat, FragmentIn, FragmentOut,
    IndexFormat, Int, Limits, Mat2, Mat3, Mat4, NoPerspective, Operand, PerSample, Program, Quad,
    Real, SampleType, SamplerDescriptor, Shader, ShaderError, ShaderProgram, ShadowMap,
    StorageBuffer, TexelEncoding, TextureAspect, TextureDimension, TextureFormat, Varyings, Vec2,
    Vec3, Vec4, VertexEncoding, VertexFormat, VertexIn, ViewDimension, WithGradient, attributes,
    maths, operand, shader, state, varyings, vec2, vec3, vec4,
};
pub use immediates::ImmediatesError;
pub use inspect::{
    BlockCounts, ClipOutcome, EmittedRecord, FragmentRecord, InspectError, InspectedVertex,
    PassStages, PieceVertex, PixelCounts, PixelHistory, PolygonVertex, PrimitiveKind,
    PrimitiveOrigin, PrimitiveRecord, SampleRecord, SampleValues, StagePiece, StagePrimitive,
    StageVertex, TessellatedRecord, TessellatedVertex, TestOutcome,
};
pub use pass::{
    AspectOperations, ColorAttachment, DepthStencilAttachment, DepthStencilResolve, Draw,
    PassErrorKind, PassExtent, RangeQueries, RangeResult, RenderPass, RenderPassError, StoreOp,
};
#[cfg(feature = "png")]
pub use png_file::PngError;
#[cfg(feature = "shader-text")]
pub use shader_module::{
    ClipSpace, EntryPoint, EntryPointDescriptor, GlslDialect, ProgramDescriptor, Reflection,
    ScalarType, ShaderErrors, ShaderModule, ShaderModuleDescriptor, ShaderModuleError,
    ShaderSource, ShaderSourceError, ShaderStage, UniformBlock, UniformError, UniformMember,
    UniformValue, Uniforms, ValueType,
};
pub use texture::{
    Extent3d, Sampler, TexelCopyLayout, Texture, TextureConflict, TextureCopy, TextureDescriptor,
    TextureError, TextureUsages, TextureView, TextureViewDescriptor,
};
