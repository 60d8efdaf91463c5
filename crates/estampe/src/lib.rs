#![forbid(unsafe_code)]
//! **estampe**: a complete GPU in software. The whole real-time graphics pipeline on the CPU,
//! programmable in Rust, the same bits on every machine, with no driver, display or system library.
//!
//! The nouns are WebGPU's: a [`Device`] makes [`RenderPipeline`]s and [`RenderTarget`]s and draws a
//! [`RenderPass`] of [`Draw`]s into a target. A shader is a Rust value that implements [`Shader`]:
//! see [`shader!`]. Spaces, rounding and the order of every operation are in `docs/NUMERICS.md`.

mod device;

/// The README's snippet, compiled and run as a test.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;

pub use device::{Device, DeviceDescriptor, DeviceError};
pub use estampe_core::recording::Phase;
pub use estampe_core::{
    Draw, LoadOp, OcclusionQueries, PipelineError, RenderPass, RenderPipeline,
    RenderPipelineDescriptor, RenderTarget, RenderTargetDescriptor, Statistics, TargetError,
};
pub use estampe_simd::{Level, LevelError};
pub use estampe_texture as texture;
pub use estampe_types::shader::{DepthOutput, Interpolation, Sample2d, Sampling, VertexOut};
pub use estampe_types::{
    AddressMode, Attributes, BindGroup, Binding, Bindings, Buffer, Centroid, DepthTexture,
    FilterMode, Flat, FragmentIn, FragmentOut, IndexFormat, Int, Limits, Mat4, MipLevel,
    NoPerspective, PerSample, Program, Quad, Real, SampleType, SamplerDescriptor, Shader,
    ShaderProgram, TexelEncoding, Texture, TextureFormat, Varyings, Vec2, Vec3, Vec4,
    VertexEncoding, VertexFormat, VertexIn, maths, shader, srgb, state,
};
