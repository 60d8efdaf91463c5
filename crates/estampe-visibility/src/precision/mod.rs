//! Precision of depth buffers: the least separation of two surfaces that they tell apart.
//!
//! The eye looks along −z; a surface at the distance z, parallel to the picture, has the depth
//!
//! ```text
//!   hyperbolic    d = f·(z − n) / (z·(f − n))        reversed: n·(f − z) / (z·(f − n))
//!   logarithmic   d = log(z/n) / log(f/n)            reversed: 1 − d
//! ```
//!
//! between the near plane n and the far plane f. A format rounds d to steps of δ, so the second of
//! two surfaces is told apart from the first at z if it lies s behind:
//!
//! ```text
//!   hyperbolic    s = δ·z² / (n·f/(f − n) − δ·z)     ≈ z² / (n·2ᵇ) for b bits
//!   logarithmic   s = z·((f/n)^δ − 1)
//! ```
//!
//! (From d(z + s) = d(z) ± δ; Akeley and Su, "Minimum Triangle Separation for Correct z-Buffer
//! Occlusion", Graphics Hardware 2006, add the error of window coordinates.) The pipeline computes
//! d in f32, which rounds on the way: the [formula](DepthMethod::formula) is that of the format
//! alone, the [measurement](DepthMethod::least_separation) includes both.

mod formula;
mod method;
mod separation;
#[cfg(test)]
mod tests;

pub use method::{DepthFormat, DepthMapping, DepthMethod, PrecisionError};
