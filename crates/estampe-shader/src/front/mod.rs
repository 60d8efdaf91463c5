//! Source text to a checked module.
//!
//! ```text
//! WGSL ───────────────────────────► naga ─┐
//! SPIR-V ──── words checked ──────► naga ─┼─► validation ─► reflection ─► Module
//! GLSL ── preprocessed, rewritten ► naga ─┘
//! ```
//!
//! naga reads GLSL 450 as Vulkan has it. [`glsl`] brings the GLSL of OpenGL and WebGL to that form.
//!
//! Errors name the place in the author's text: see [`ShaderErrors`]. Sources are untrusted: no
//! input panics, hangs, or takes more memory than [`Limits`] allows.

mod chains;
mod constants;
mod errors;
pub mod glsl;
mod guard;
mod lines;
mod load;
mod module;
mod reflect;
mod source;
mod spirv;
mod suggest;
mod validate;
mod wgsl;
mod wgsl_enable;

pub use errors::{ShaderError, ShaderErrors};
pub use load::{load, load_pair};
pub use module::{EntryPoint, Module};
pub use reflect::{
    Binding, BindingKind, CombinedSampler, Override, OverrideValue, Reflection, SampleType, Scalar,
    Stages, TextureDimension, UniformBlock, UniformMember, ValueType, Varying,
};
pub use source::{ClipSpace, Dialect, Limits, Options, Source};
