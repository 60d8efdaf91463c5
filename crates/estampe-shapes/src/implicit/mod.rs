//! Implicit functions: curves F(x, y) = 0 and surfaces F(x, y, z) = 0 in a box.
//!
//! A simplicial lattice fills the box. An edge of the lattice at whose ends F has different signs
//! holds a vertex, at the root that a bracketing search finds on it; a tetrahedron with both signs
//! holds one or two triangles between such vertices, a triangle of the plane holds a segment:
//!
//! ```text
//!        +            +            −            F < 0 is inside, F ≥ 0 outside;
//!       ╱ ╲          ╱ ╲          ╱ ╲           triangles are counter-clockwise, and
//!      +───+        •───•        •───•          normals (the gradients) point, to the
//!                  ╱     ╲      ╱     ╲         outside. Segments have the inside on
//!                 −───────−    +───────+        their left.
//! ```
//!
//! **Why the mesh is a manifold.** Only signs decide which edges hold vertices and how vertices are
//! connected, as if F were a function that is linear on each simplex and zero at no node. Of such
//! a function a triangle of the lattice holds one segment or none. Each triangle belongs to two
//! tetrahedra, or to one if it lies on the box, so each edge of the mesh belongs to two of its
//! triangles, in opposite directions, or lies on the box. The tetrahedra around a lattice edge form
//! a ring, or on the box a fan; so do the triangles around a vertex of the mesh. Vertices keep a
//! small distance from the nodes, which makes the vertices of any triangle differ and, as they lie
//! on three edges of a tetrahedron, not be collinear.
//!
//! **The lattice** of space is the body-centred cubic one: the corners and the centres of cubic
//! cells. Each pair of neighbouring centres and each edge of the face between them span a
//! tetrahedron, so a cell has 12, all of the same good shape. In the plane each square has four
//! triangles around its centre. Marching cubes (Lorensen and Cline 1987) was rejected: a table
//! must resolve ambiguous faces, and even one that does so consistently needs a proof of 256 cases.
//! Tetrahedra (Doi and Koide 1991; Chan and Purisima 1998 on this lattice) have two cases.
//!
//! **Jumps.** F may change its sign without a root, as `1/x` and `sign(x)` do. The search ends at a
//! pair of numbers between which F still differs; triangles at such a vertex are left out, as are
//! simplices with a node at which F is NaN. There the surface has a border inside the box, which
//! [`ImplicitSurface::interruptions`] counts.
//!
//! Roots at which F does not change its sign, such as those of (x² + y² − 1)², are not found.

mod axis;
mod curve;
mod error;
mod finish;
mod lattice;
mod root;
mod surface;

pub use curve::{ImplicitCurve, curve};
pub use error::ImplicitError;
pub use surface::{ImplicitSurface, surface};

/// The maximum number of cells along each axis of a surface's box; larger numbers are clamped.
pub const MAX_SURFACE_CELLS: u32 = 512;

/// The maximum number of cells along each axis of a curve's box; larger numbers are clamped.
pub const MAX_CURVE_CELLS: u32 = 4096;

/// The maximum number of triangles or segments.
pub const MAX_ELEMENTS: usize = 1 << 23;

#[cfg(test)]
mod tests;
