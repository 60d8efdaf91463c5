#![forbid(unsafe_code)]
//! Built-in models, curves and surfaces of functions, polygons and their triangulation.
//!
//! The crate has geometry only: positions, normals, texture coordinates and triangles. It depends
//! neither on cameras nor on materials or rendering.
//!
//! | module | contents |
//! |---|---|
//! | [`builtin`] | the built-in models, by name |
//! | [`teapot`] | the Utah teapot from its published control points |
//! | [`cube`] | the one built-in model that is not a surface on a grid |
//! | [`expression`] | expressions of numbers: parsing, values, exact derivatives |
//! | [`explicit`] | curves y = f(x) and surfaces z = f(x, y) |
//! | [`parametric`] | curves C(t) and surfaces S(s, t): any, and sphere, torus, plane, helix |
//! | [`implicit`] | curves F(x, y) = 0 and surfaces F(x, y, z) = 0 |
//! | [`bezier`] | Bézier curves and patches with their derivatives |
//! | [`curve`] | polylines, and tubes around them |
//! | [`mesh`] | the triangle mesh that all of these produce |
//! | [`polygon`] | area, convexity, simplicity, point tests, triangulation, fill on pixels |
//!
//! Conventions: triangles are counter-clockwise seen from outside, normals have unit length and
//! point outwards, texture coordinates have v = 0 at the image's top row, and images are not
//! mirrored when seen from outside. Built-in models have Y up; functions have the axes of
//! textbooks, where Z is up. Points are computed in f64 with `libm` and rounded once, so a shape
//! has the same bits on every machine.

pub mod bezier;
pub mod builtin;
mod continuity;
pub mod cube;
pub mod curve;
pub mod explicit;
pub mod expression;
pub mod implicit;
pub mod mesh;
pub mod parametric;
pub mod polygon;
#[cfg(test)]
mod random_cases;
pub mod teapot;
#[cfg(test)]
mod topology;

/// The README's snippet, compiled and run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub use builtin::{BuiltinShape, UnknownShape};
pub use mesh::ShapeMesh;
