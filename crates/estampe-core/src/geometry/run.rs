//! The work of one run: some primitives of a sub-draw, and everything that they depend on.

use super::assembly::ElementSource;
use super::groups::InstanceSize;
use super::plan::GeometryPlan;
use super::shaded_vertices::SubDrawVertices;
use super::shading::VertexSource;
use estampe_simd::Level;

/// Some primitives of a sub-draw, with everything that they depend on.
#[derive(Debug, Clone)]
pub(crate) struct RunWork<'a> {
    pub(crate) level: Level,
    pub(crate) plan: &'a GeometryPlan,
    pub(crate) elements: ElementSource<'a>,
    pub(crate) vertices: SubDrawVertices<'a>,
    /// The source of the vertices, for those that are shaded again.
    pub(crate) source: VertexSource<'a>,
    /// True if each line begins at the end of the line before it.
    pub(crate) is_line_strip: bool,
    /// Those lines of an instance that begin a strip after a restart, ascending.
    pub(crate) line_restarts: &'a [u32],
    pub(crate) instance: InstanceSize,
    /// The primitives, counted over all instances; half-open.
    pub(crate) primitives: [u32; 2],
}
