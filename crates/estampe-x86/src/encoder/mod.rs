//! The encoder: bytes of the instructions that the back end uses.
//!
//! Vector and mask-register instructions are rows of a table, [`VectorOp`], which one function
//! encodes with VEX or EVEX prefixes; scalar instructions are functions of the [`Assembler`].
//!
//! | module | has |
//! |---|---|
//! | [`assembler`] | bytes, labels, the pool of constants behind the code |
//! | [`address`] | memory operands, ModRM and SIB bytes |
//! | [`vector_op`] | the table of vector instructions |
//! | [`vector`] | VEX and EVEX prefixes |
//! | [`element`] | instructions on one of many words |
//! | [`scalar`] | instructions on general-purpose registers, jumps |
//! | [`mod@text`] | the texts of instructions, for listings |
//!
//! Source: Intel 64 and IA-32 Architectures Software Developer's Manual, volume 2.

pub(crate) mod address;
pub(crate) mod assembler;
pub(crate) mod element;
pub(crate) mod scalar;
pub(crate) mod text;
pub(crate) mod vector;
pub(crate) mod vector_op;

pub(crate) use address::{Address, Base};
pub(crate) use assembler::{Assembler, Label};
pub(crate) use scalar::{Condition, Gpr};
pub(crate) use vector::{Length, Rm, VectorInstruction};
pub(crate) use vector_op::VectorOp;

#[cfg(test)]
mod tests;
