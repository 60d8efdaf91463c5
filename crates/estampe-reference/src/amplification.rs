//! The stages that make primitives, joined: tessellation, then a geometry shader, or one of them.
//!
//! In · Out: the patches or primitives of a draw · finished primitives, one after the other, each
//! with what it was made of.

use crate::geometry_shader::{EmittedPrimitive, PrimitiveShaders, emitted, for_each_input};
use crate::program::Shaders;
use crate::tessellation::{TessellatedPatch, Tessellation, corners_of, for_each_patch};
use crate::{ClipVertex, Draw, State};
use estampe_types::shader::GeometryTopology;
use estampe_types::state::PrimitiveTopology;

/// The stages of a draw before its primitives are drawn.
#[derive(Clone, Copy)]
pub struct Stages<'a> {
    /// Shades the vertices of patches and primitives.
    pub vertex: &'a dyn Shaders,
    /// Tessellation; the topology of the draw is then that of patches.
    pub tessellation: Option<Tessellation<'a>>,
    /// The geometry shader.
    pub geometry: Option<&'a dyn PrimitiveShaders>,
}

impl std::fmt::Debug for Stages<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Stages")
            .field("tessellation", &self.tessellation)
            .finish_non_exhaustive()
    }
}

/// A finished primitive, and what it was made of.
#[derive(Debug, Clone, Copy)]
pub struct MadePrimitive<'a> {
    /// The index of the instance.
    pub instance: u32,
    /// The number of the patch or primitive in its instance.
    pub number: i32,
    /// The positions of the vertices of the patch or primitive in the draw's range.
    pub positions: &'a [u32],
    /// These vertices, as the vertex shader left them.
    pub input: &'a [ClipVertex],
    /// The patch, and the number of the primitive in it, if the draw is tessellated.
    pub tessellated: Option<(&'a TessellatedPatch, usize)>,
    /// What the geometry shader emitted, if there is one.
    pub emitted: Option<&'a EmittedPrimitive>,
    /// The vertices: those of a point, a line or a triangle of a list.
    pub vertices: &'a [ClipVertex],
}

impl Stages<'_> {
    /// The topology as which finished primitives are drawn: a list.
    #[must_use]
    pub fn topology(&self) -> PrimitiveTopology {
        let corners = match (self.geometry, &self.tessellation) {
            (Some(geometry), _) => match geometry.topology() {
                GeometryTopology::PointList => 1,
                GeometryTopology::LineStrip => 2,
                GeometryTopology::TriangleStrip => 3,
            },
            (None, Some(stage)) => corners_of(stage.mode),
            (None, None) => 3,
        };
        match corners {
            1 => PrimitiveTopology::PointList,
            2 => PrimitiveTopology::LineList,
            _ => PrimitiveTopology::TriangleList,
        }
    }

    /// Makes the primitives of a draw, in order.
    pub fn for_each(
        &self,
        state: &State,
        draw: &Draw<'_>,
        visit: &mut dyn FnMut(&MadePrimitive<'_>),
    ) {
        let mut pass_on = |made: MadePrimitive<'_>| {
            let Some(geometry) = self.geometry else {
                return visit(&made);
            };
            let provoking = state.primitive.provoking_vertex;
            let number = made.number;
            for primitive in &emitted(geometry, made.vertices, number, provoking, draw.bindings) {
                visit(&MadePrimitive {
                    emitted: Some(primitive),
                    vertices: &primitive.vertices,
                    ..made
                });
            }
        };
        let Some(stage) = &self.tessellation else {
            for_each_input(self.vertex, state, draw, &mut |primitive| {
                pass_on(MadePrimitive {
                    instance: primitive.instance,
                    number: primitive.number,
                    positions: &primitive.positions,
                    input: &primitive.vertices,
                    tessellated: None,
                    emitted: None,
                    vertices: &primitive.vertices,
                });
            });
            return;
        };
        for_each_patch(self.vertex, stage, state, draw, &mut |patch| {
            for (number, points) in patch.primitives.iter().enumerate() {
                let vertices = points.iter().map(|&at| patch.vertices[at].clone());
                pass_on(MadePrimitive {
                    instance: patch.instance,
                    number: patch.number,
                    positions: &patch.positions,
                    input: &patch.corners,
                    tessellated: Some((patch, number)),
                    emitted: None,
                    vertices: &vertices.collect::<Vec<_>>(),
                });
            }
        });
    }
}
