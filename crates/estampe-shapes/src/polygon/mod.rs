//! Polygons: area, convexity, point tests and triangulation.
//!
//! A polygon is a ring of corners without repetition of the first one. A triangulation names its
//! corners by index and keeps their winding, so that a mesh face may be triangulated without
//! touching its vertices:
//!
//! ```text
//!   3───────2          corners 0 1 2 3 4
//!   │    _ /│          triangles cover the polygon exactly once,
//!   │ _-`  / │         n − 2 of them, all wound as the polygon is
//!   4     /  │
//!    `-_ /   │
//!       0────1
//! ```
//!
//! | corners | triangulation |
//! |---|---|
//! | 3 | the triangle itself |
//! | 4 | the shorter of the diagonals that lie inside |
//! | more, convex | a fan |
//! | more, concave | ear clipping (the `earcut` crate), on the plane's dominant axes |
//! | without area, not finite, or crossing itself everywhere | a fan, which may overlap itself |
//!
//! All predicates are computed in f64 from f32 coordinates relative to the first corner.

mod crossings;
mod measure;
mod plane;
#[cfg(test)]
mod tests;
mod triangulate;

pub use measure::{FillRule, is_convex_2d, point_in_polygon, signed_area_2d};
pub use triangulate::{Triangulator, triangulate_2d, triangulate_3d};
