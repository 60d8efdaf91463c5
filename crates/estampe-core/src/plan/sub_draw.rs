//! Sub-draws: the pieces that draws are cut into.

use super::index_range::{IndexRange, is_line_strip};
use crate::commands::Draw;
use crate::geometry::assembly::ElementSource;
use crate::geometry::groups::InstanceSize;
use crate::geometry::plan::GeometryPlan;
use crate::geometry::run::RunWork;
use crate::geometry::shaded_vertices::{SubDrawVertices, VertexSpan};
use crate::geometry::shading::VertexSource;
use estampe_simd::Level;
use estampe_types::Bindings;

/// Bindings of draws that have none.
static NO_BINDINGS: Bindings = Bindings {
    unbound: None,
    groups: Vec::new(),
    immediates: Vec::new(),
};

/// A draw, or part of one: a range of vertices that is shaded once, and the primitives between
/// them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SubDraw<'a> {
    pub(crate) draw: &'a Draw<'a>,
    /// The number of its state in the batch.
    pub(crate) state: u32,
    /// The number in the batch of the state that tiles read.
    pub(crate) tile_state: u32,
    /// Its vertices in those of the batch.
    pub(crate) span: VertexSpan,
    /// Elements of one instance: first, and how many.
    pub(super) elements: [u32; 2],
    pub(super) first_instance: u32,
    pub(super) instances: u32,
    /// Vertices of one instance: first index, and how many.
    pub(super) first_vertex: u32,
    pub(super) vertices: u32,
    /// Primitives of one instance.
    pub(super) primitives: u32,
    /// The number of its lists of vertices in the batch, which few draws need.
    pub(super) listed: Option<u32>,
}

/// A sub-draw that is not in a batch yet, and its lists of vertices.
pub(super) type Cut<'a> = (SubDraw<'a>, Option<Box<ListedVertices>>);

/// Vertices that are named one by one.
#[derive(Debug, Clone, Default)]
pub(crate) struct ListedVertices {
    /// The vertex index of each element, where the range of indices is sparse.
    sparse: Option<Vec<u32>>,
    /// The vertices of each primitive of an instance, where indices may restart primitives.
    pub(super) restarted: Option<Vec<[u32; 3]>>,
    /// Those of them that begin a strip of stippled lines, ascending.
    pub(super) line_restarts: Vec<u32>,
}

/// The instances of a sub-draw.
#[derive(Debug, Clone, Copy)]
pub(super) struct Instances {
    pub(super) first: u32,
    pub(super) count: u32,
}

impl AsRef<VertexSpan> for SubDraw<'_> {
    fn as_ref(&self) -> &VertexSpan {
        &self.span
    }
}

impl<'a> SubDraw<'a> {
    /// A sub-draw of `primitives` primitives in each instance.
    pub(super) fn cut(
        draw: &'a Draw<'a>,
        elements: [u32; 2],
        primitives: u32,
        instances: Instances,
        range: IndexRange,
    ) -> Cut<'a> {
        let listed = range.sparse.map(|sparse| {
            Box::new(ListedVertices {
                sparse: Some(sparse),
                ..ListedVertices::default()
            })
        });
        let sub_draw = Self {
            draw,
            state: 0,
            tile_state: 0,
            span: VertexSpan::default(),
            elements,
            first_instance: instances.first,
            instances: instances.count,
            first_vertex: range.first,
            vertices: range.count,
            primitives,
            listed: None,
        };
        (sub_draw, listed)
    }

    /// The resources that its shaders find by number.
    pub(crate) fn bindings(&self) -> &'a Bindings {
        self.draw.bindings.unwrap_or(&NO_BINDINGS)
    }

    /// Drops instances beyond a budget of vertices, but for the first one: a triangle can have a
    /// dozen vertices, in each of a million instances.
    pub(super) fn keep_within(&mut self, vertices: usize) {
        let most = vertices / (self.vertices as usize).max(1);
        let most = u32::try_from(most).unwrap_or(u32::MAX).max(1);
        self.instances = self.instances.min(most);
    }

    /// Returns true if a tile rasterizes the triangles of both alike, whatever shades them: they
    /// differ in bindings, buffers and elements alone.
    pub(crate) fn rasterizes_like(&self, other: &Self) -> bool {
        let (draw, other_draw) = (self.draw, other.draw);
        self.state == other.state
            && draw.stencil_reference == other_draw.stencil_reference
            && draw.depth_bounds == other_draw.depth_bounds
            && draw.occlusion_query == other_draw.occlusion_query
    }

    /// Returns true if the tiles' state of both is the same.
    pub(super) fn has_tile_state_of(&self, other: &Self) -> bool {
        let constants = [self, other].map(|of| of.draw.blend_constant.map(f32::to_bits));
        constants[0] == constants[1]
            && self.rasterizes_like(other)
            && (!self.draw.pipeline.key().may_test_alpha
                || std::ptr::eq(self.bindings(), other.bindings()))
    }

    /// Vertices of all instances.
    pub(crate) fn total_vertices(&self) -> usize {
        (self.vertices as usize).saturating_mul(self.instances as usize)
    }

    /// Primitives of all instances.
    pub(crate) fn total_primitives(&self) -> usize {
        (self.primitives as usize).saturating_mul(self.instances as usize)
    }

    /// Returns the source of the vertices.
    pub(crate) fn vertex_source<'s>(
        &'s self,
        listed: Option<&'s ListedVertices>,
    ) -> VertexSource<'s> {
        VertexSource {
            pipeline: self.draw.pipeline,
            buffers: self.draw.vertex_buffers,
            bindings: self.bindings(),
            first_vertex: self.first_vertex,
            count: self.vertices,
            first_instance: self.first_instance,
            base_instance: self.draw.instances.start,
            instances: self.instances,
            sparse: listed.and_then(|list| list.sparse.as_deref()),
        }
    }

    /// The work of assembling some primitives, counted over all instances, under a plan.
    pub(crate) fn run_work<'w>(
        &'w self,
        level: Level,
        plan: &'w GeometryPlan,
        (vertices, listed): (SubDrawVertices<'w>, Option<&'w ListedVertices>),
        primitives: [u32; 2],
    ) -> RunWork<'w> {
        let state = &self.draw.pipeline.descriptor().primitive;
        RunWork {
            level,
            plan,
            elements: ElementSource {
                topology: state.topology,
                provoking: state.provoking_vertex,
                restarted: listed.and_then(|list| list.restarted.as_deref()),
                elements: self.elements[1],
                indices: self.draw.indices.filter(|_| listed.is_none()),
                first_element: self.elements[0],
                first_vertex: self.first_vertex,
                base_vertex: self.draw.base_vertex,
            },
            vertices,
            source: self.vertex_source(listed),
            is_line_strip: is_line_strip(state.topology),
            line_restarts: listed.map_or(&[], |list| &list.line_restarts),
            instance: InstanceSize {
                vertices: self.vertices,
                primitives: self.primitives,
            },
            primitives,
        }
    }
}

// There is one for each draw of a batch.
const _: () = assert!(size_of::<SubDraw<'_>>() <= 104);
