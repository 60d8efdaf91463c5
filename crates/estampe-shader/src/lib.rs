#![forbid(unsafe_code)]
//! Shaders as text: from WGSL, GLSL or SPIR-V to the intermediate representation.
//!
//! | module | does |
//! |---|---|
//! | [`front`] | source text to a checked module: versions of GLSL, errors with their place, reflection |
//! | [`lower`] | an entry point of a module to a [`Tree`](estampe_ir::tree::Tree) |
//! | [`order`] | whether the order of the work-groups of a dispatch can be seen |
//! | [`program`] | lowered stages to a program of the pipeline |
//!
//! # Example
//!
//! ```
//! use estampe_ir::interface::Stage;
//! use estampe_shader::front::{Options, Source, load};
//!
//! let text = "#version 330 core
//! in vec3 position;
//! uniform mat4 model;
//! uniform float size;
//! void main() { gl_Position = model * vec4(position * size, 1.0); }
//! ";
//! let source = Source::Glsl { text, stage: Stage::Vertex };
//! let module = load(source, &Options::default())?;
//! let (_, size) = module.reflection.uniform("size").expect("a uniform");
//! assert_eq!(size.offset, 64);
//! # Ok::<(), estampe_shader::front::ShaderErrors>(())
//! ```

pub mod front;
pub mod lower;
pub mod order;
pub mod program;
