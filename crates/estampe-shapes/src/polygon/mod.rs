//! Polygons: area, convexity, simplicity, point tests, triangulation, and fill on pixels.
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
//! | corners | [`Triangulator`], for faces of meshes |
//! |---|---|
//! | 3 | the triangle itself |
//! | 4 | the shorter of the diagonals that lie inside |
//! | more, convex | a fan |
//! | more, concave | ear clipping (the `earcut` crate), on the plane's dominant axes |
//! | without area, not finite, or crossing itself everywhere | a fan, which may overlap itself |
//!
//! Its predicates are computed in f64 from f32 coordinates relative to the first corner.
//!
//! [`triangulate_rings`] is for polygons in the plane that may have holes and cross themselves. It
//! fills them by a [`FillRule`], exactly, with new vertices where edges cross:
//!
//! ```text
//!  rings -> corners on an integer grid -> edges divided where they meet    (arrangement)
//!        -> spans of the inside, from bottom to top                        (sweep)
//!        -> triangles of each span                                         (monotone)
//! ```
//!
//! [`fill_spans`] fills polygons on pixels without triangles.

mod arrangement;
mod crossings;
mod exact;
mod fill;
mod measure;
mod monotone;
mod plane;
mod scanline;
mod simplicity;
mod sweep;
#[cfg(test)]
mod tests;
mod triangulate;

pub use fill::{FilledPolygon, MAX_CORNERS, PolygonError, triangulate_rings};
pub use measure::{
    FillRule, PointLocation, is_convex_2d, locate_in_polygon, point_in_polygon, signed_area_2d,
};
pub use scanline::{PixelSpan, fill_spans};
pub use simplicity::is_simple_2d;
pub use triangulate::{Triangulator, triangulate_2d, triangulate_3d};
