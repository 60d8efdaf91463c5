#![forbid(unsafe_code)]
//! The contract of the pipeline: plain data and traits that all other crates share.
//!
//! * [`state`]: the state of a pipeline in WebGPU's words: topology, culling, depth, blending,
//!   write masks, multisampling, vertex layouts, each a value with stated defaults;
//! * [`mod@format`]: formats of vertices, indices and textures; [`Limits`];
//! * [`buffer`], [`texture`], [`bindings`]: data that shaders read, and how a draw binds it;
//! * [`mod@shader`]: the trait by which a shader is written in Rust, and the one interface
//!   ([`Program`]) that Rust shaders and compiled text shaders share;
//! * [`Real`], the vectors [`Vec2`], [`Vec3`], [`Vec4`], the matrices [`Mat2`], [`Mat3`], [`Mat4`],
//!   and [`maths`], the functions of WGSL: arithmetic that is written once and runs on one
//!   fragment, on a 2×2 quad, or on sixteen lanes; [`operand`] says what can be combined.
//!
//! The conventions (spaces, rounding, order of operations) are in `docs/NUMERICS.md`.

mod bind_group_layout;
pub mod bindings;
pub mod buffer;
mod depth_minmax;
mod derivatives;
pub mod format;
mod int;
mod limits;
mod lines;
pub mod maths;
mod matrix;
pub mod morton;
pub mod operand;
mod pair;
mod quad;
mod real;
pub mod shader;
pub mod state;
mod storage_buffer;
pub mod texture;
mod vector;
mod wide;

pub use bind_group_layout::{
    BindGroupLayout, BindGroupLayoutEntry, BindingType, BufferBindingType,
};
pub use bindings::{
    Bindings, BoundGroup, BoundResource, BoundResources, MAX_DYNAMIC_OFFSETS, OtherResource,
};
pub use buffer::BufferData;
pub use format::{
    IndexFormat, SampleType, TexelEncoding, TextureFormat, VertexEncoding, VertexFormat,
};
pub use int::Int;
pub use limits::Limits;
pub use lines::Lines;
pub use matrix::{Mat2, Mat3, Mat4};
pub use operand::Operand;
pub use pair::Pair;
pub use quad::Quad;
pub use real::Real;
pub use shader::{
    Attributes, Centroid, Flat, FragmentBatch, FragmentIn, FragmentOut, Interface, Interpolation,
    NoPerspective, PerSample, Program, Sampling, Shader, ShaderError, ShaderProgram, Varyings,
    VertexBatch, VertexIn, WithGradient,
};
pub use storage_buffer::StorageBuffer;
pub use texture::{
    AddressMode, BorderColor, ByteSquares, FilterMode, MipLevel, SamplerDescriptor, ShadowMap,
    StorageTexture, TexelData, TexelViewDescriptor, TextureAspect, TextureDimension, TextureShape,
    ViewDimension,
};
pub use vector::{Vec2, Vec3, Vec4, vec2, vec3, vec4};

#[cfg(test)]
mod tests;
