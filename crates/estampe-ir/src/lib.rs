#![forbid(unsafe_code)]
//! The intermediate representations of the shader compiler, and the interpreter.
//!
//! A shader is compiled in three steps:
//!
//! 1. A front end lowers its source to a [`tree::Tree`]: structured SSA as *one invocation* sees
//!    it. Calls are inlined, vectors and structs are taken apart into 32-bit [words](Type::Word),
//!    and local variables are values. [`tree::Builder`] folds constants and finds common
//!    subexpressions while the tree grows; [`tree::passes`] remove what is not used.
//! 2. [`lanes::Kernel::from_tree`] makes it SSA for *many lanes*: a flow graph of basic blocks in
//!    which masks are values. Its analysis finds which values and branches are uniform (the same in
//!    all lanes). Uniform branches stay branches; others run both sides under masks.
//! 3. A back end runs the kernel: the [interpreter], or machine code.
//!
//! Both forms use the same operations, [`Op`], whose documentation defines their results bit by
//! bit. So the back ends agree: the arithmetic is that of `docs/NUMERICS.md`, in the order written.
//!
//! | module | is |
//! |---|---|
//! | [`op`] | values, types and operations |
//! | [`interface`] | inputs, outputs, memory that a kernel names |
//! | [`tree`] | one invocation's view: structured control flow |
//! | [`lanes`] | many lanes' view: a flow graph with masks |
//! | [`interpreter`] | runs a kernel |
//! | [`text`] | trees and kernels as text, and back |

pub mod interface;
pub mod interpreter;
pub mod lanes;
pub mod op;
pub mod text;
pub mod tree;

pub use op::{Op, Type, Value};
