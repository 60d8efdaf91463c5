//! Surfaces S(s, t) from points with derivatives: poles, seams, jumps, and the ends of the domain.
//!
//! ```text
//!   t ↑  ┌──┬──┐    p01──p11      each cell: p00 p10 p11, p00 p11 p01,
//!     │  ├──┼──┤     │ ╱  │       counter-clockwise on the side of ∂S/∂s × ∂S/∂t
//!     │  └──┴──┘    p00──p10
//!     └───────▶ s
//!
//!   grid  -> poles and seams get equal positions     (seams)
//!         -> triangles, without those over a jump    (draft)
//!         -> cut at the ends of the domain           (cut)
//!         -> mesh
//! ```
//!
//! Against [`surface`](super::surface), whose t runs down the image and whose caller has normals, t
//! runs upwards here, as in textbooks: the outside of (cos s cos t, sin s cos t, sin t) is that of
//! the sphere.

mod cut;
mod draft;
mod seams;

use std::ops::Range;

use super::jet::SurfaceJet;
use crate::mesh::ShapeMesh;
pub(crate) use draft::Draft;

/// The vertices where a closed surface meets itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Seams {
    /// Both sides have vertices of their own, at the same position with the same normal, so that
    /// texture coordinates run from 0 to 1.
    #[default]
    Split,
    /// Both sides share their vertices, and a pole is one vertex: the surface is closed by its
    /// indices too. There are no texture coordinates. Sides whose normals differ, as at a crease,
    /// stay apart.
    Joined,
}

/// The parameters of a surface's grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// The range of s; it may run backwards.
    pub s: Range<f64>,
    /// The range of t.
    pub t: Range<f64>,
    /// The numbers of cells along s and t, clamped to 1..=[`MAX_CELLS`](super::MAX_CELLS).
    pub cells: [u32; 2],
    /// The treatment of seams.
    pub seams: Seams,
}

/// Meshes the surface `point(s, t)` over a grid.
///
/// Normals have the side of ∂S/∂s × ∂S/∂t; at poles they are limits ([`SurfaceJet::normal`]).
/// Positions that differ by less than 1e-9 of the surface's extent are equal at poles and seams.
/// Triangles over a jump are left out, and where the function ends (it is NaN, infinite or beyond
/// 1e30) the surface is cut at the last parameter that bisection finds, unless it has a pole there.
/// Texture coordinates have u = 0 at the beginning of s and v = 0 at the end of t.
#[must_use]
pub fn sheet(name: &str, grid: &Grid, point: impl Fn(f64, f64) -> SurfaceJet) -> ShapeMesh {
    let mut draft = Draft::new(grid, point);
    draft.cut_to_domain(false);
    draft.into_mesh(name)
}

#[cfg(test)]
mod tests;
