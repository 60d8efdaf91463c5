//! Whether the order of the work-groups of a dispatch can be seen.
//!
//! Work-groups run on all threads only if every order gives the same bits. That is so if what one
//! writes no other one reads or writes, and for atomic sums and the like whose results are not
//! used.
//!
//! ```text
//! tree ─▶ analysis ─▶ Accesses: each place in memory as a form ─┐
//!                          (when the shader is compiled)        ├─▶ check ─▶ free, or in order
//!                        sizes and uniforms of the dispatch ────┘
//! ```
//!
//! A form is a sum of indices of work-groups and invocations times coefficients, and
//! an interval; `bytes` says which bytes from there on an access uses. Coefficients may be words of
//! read-only buffers, such as the width of a picture, so the last step is taken for each dispatch:
//! numbers in mixed radix are different if each digit's weight is more than what the digits below
//! it reach.

mod analysis;
mod bytes;
mod check;
mod form;

pub use analysis::Accesses;
