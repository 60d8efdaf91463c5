//! The functions of WGSL and GLSL on numbers and vectors.
//!
//! ```
//! use estampe_types::{Real, Vec3, maths::*, vec3};
//!
//! fn sky<R: Real>(direction: Vec3<R>, haze: R) -> Vec3<R> {
//!     let height = smoothstep(-0.1, 0.6, direction.y);
//!     let color = mix(vec3(0.9, 0.8, 0.7), vec3(0.2, 0.4, 0.9), height);
//!     mix(color, 1.0, haze * exp(-4.0 * abs(direction.y)))
//! }
//! # assert_eq!(sky(vec3(0.0, -1.0, 0.0), 0.0), vec3(0.9, 0.8, 0.7));
//! ```
//!
//! Names, order of arguments and results are those of WGSL; `modulo` is GLSL's `mod`.
//! Component-wise functions take numbers and vectors, and constants (`f32`) in any place: the
//! result is a number or vector of the shader's kind.
//!
//! All are made of `+ − × ÷ √` on `f32` and of integer operations on bits. They give the same bits
//! at every SIMD level and on every machine, which the system's functions do not.
//! `docs/NUMERICS.md` lists formulas, errors and special values.

mod componentwise;
mod exponential;
mod free;
mod geometric;
mod hyperbolic;
mod inverse_trigonometric;
pub(crate) mod list;
mod rounding;
pub mod traced;
mod trigonometric;

pub use componentwise::Componentwise;
pub use free::*;
pub use geometric::*;
pub(crate) use list::with_functions;
pub(crate) mod scalar {
    //! The functions of one number, from which all others are made.
    pub(crate) use super::exponential::{exp, exp2, log, log2, pow, powi};
    pub(crate) use super::hyperbolic::{cosh, sinh, tanh};
    pub(crate) use super::inverse_trigonometric::{acos, asin, atan, atan2};
    pub(crate) use super::rounding::{ceil, inverse_sqrt, modulo, remainder, round, sign, trunc};
    pub(crate) use super::trigonometric::{cos, degrees, radians, sin, tan};
}
