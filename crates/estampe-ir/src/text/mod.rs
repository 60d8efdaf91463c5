//! Trees and kernels as text: `Display`, and the way back.
//!
//! ```text
//! kernel fragment
//! input varying(0)
//! input push_constant(0)
//! output color(0, 0)
//! output cover
//! b0:
//!   v0 = input 0
//!   uv1 = input 1
//!   m2 = flt v0, uv1
//!   branch m2 ? b1 : b2(v0)
//! b1:
//!   v3 = fmul v0, v0
//!   jump b2(v3)
//! b2(v4):
//!   return v4, m2
//! ```
//!
//! A value's name is its type and its number: `v` is a word, `m` a mask, and a `u` before it says
//! that it is uniform, in kernels. Numbers are decimal, hexadecimal with `0x`, or floats with a
//! point or an exponent, which stand for their bits. The interface comes first, in the order of its
//! entries; a buffer, texture or sampler is `group.binding`, and `buffer immediates` holds the
//! immediates. Values that nothing defines are listed
//! as `undefined`. Line breaks mean nothing. Comments go from `//` to the end of the line.
//!
//! A tree has nested bodies:
//!
//! ```text
//! tree vertex
//! input vertex_index
//! output varying(0)
//! v0 = input 0
//! block l0 (v1) {
//!   loop l1 (v2 = v0) {
//!     m3 = ult v2, v0
//!     if m3 { branch l0(v2) }
//!     branch l1(v2)
//!   }
//! }
//! outputs v1
//! ```

mod interface;
mod ops;
mod parse;
mod read;
mod write;
mod write_ops;

pub use parse::{kernel, tree};

/// Why a text is no tree or kernel.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{line}:{column}: {what}")]
pub struct ParseError {
    /// The line, from 1 on.
    pub line: u32,
    /// The column in characters, from 1 on.
    pub column: u32,
    /// What is wrong.
    pub what: String,
}

#[cfg(test)]
mod tests;
