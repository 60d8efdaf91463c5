#![forbid(unsafe_code)]
//! Shaders as text: from WGSL, GLSL or SPIR-V to the intermediate representation.
//!
//! | module | does |
//! |---|---|
//! | [`front`] | source text to a checked module: versions of GLSL, errors with their place, reflection |
//! | [`lower`] | an entry point of a module to a [`Tree`](estampe_ir::tree::Tree) |
//! | [`order`] | whether the order of the work-groups of a dispatch can be seen |
//! | [`program`] | lowered stages to a program of the pipeline |

pub mod front;
pub mod lower;
pub mod order;
pub mod program;
