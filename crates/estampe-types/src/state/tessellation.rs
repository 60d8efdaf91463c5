//! Tessellation state: the domain that a patch is divided over, and how.

use super::FrontFace;

/// The domain of a patch, over which its points are evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TessellationDomain {
    /// A triangle with barycentric coordinates (u, v, w). Outer level 0 divides the edge u = 0,
    /// level 1 the edge v = 0, level 2 the edge w = 0; inner level 0 divides the inside.
    #[default]
    Triangles,
    /// The unit square. Outer level 0 divides the edge u = 0, level 1 v = 0, level 2 u = 1, level 3
    /// v = 1; inner level 0 divides the inside along u, level 1 along v.
    Quads,
    /// Lines along u at the heights v = 0, 1/n, … (n − 1)/n. Outer level 0 is their number n, outer
    /// level 1 divides each of them.
    Isolines,
}

/// The division of an edge by its level.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TessellationSpacing {
    /// The level is clamped to 1..=64 and rounded up to n; n segments have the same length.
    #[default]
    Equal,
    /// The level f is clamped to 1..=63 and rounded up to an odd n; n − 2 segments have the length
    /// 1/f, the first and the last share what is left.
    FractionalOdd,
    /// As [`TessellationSpacing::FractionalOdd`] with levels of 2..=64 and an even n.
    FractionalEven,
}

/// The greatest tessellation level; greater ones are clamped to it.
pub const MAX_TESSELLATION_LEVEL: u32 = 64;

/// The greatest number of control points of a patch.
pub const MAX_PATCH_POINTS: u32 = 32;

/// The fixed-function state of tessellation. The default divides triangles equally,
/// counter-clockwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct TessellationMode {
    /// The domain of a patch.
    pub domain: TessellationDomain,
    /// The division of edges.
    pub spacing: TessellationSpacing,
    /// The winding of the triangles in the domain, where u points to the right and v up. Isolines
    /// have none.
    pub winding: FrontFace,
    /// If set, each different point of the domain becomes a point, in place of triangles or lines.
    pub point_mode: bool,
}
