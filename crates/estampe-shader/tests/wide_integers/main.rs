//! 64-bit integers against those of Rust: interpreted, and as machine code at every SIMD level.

mod memory;
mod operands;
mod operators;
mod refused;
mod run;
mod spirv;
