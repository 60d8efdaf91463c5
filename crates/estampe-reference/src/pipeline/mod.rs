//! A draw: every primitive goes through all stages before the next one begins.

mod pass;
mod state;

pub use state::{State, TargetState};

use crate::assembly::runs;
use crate::observer::Observer;
use crate::program::{RustShaders, Shaders};
use crate::shading::shade_vertex;
use crate::{ClipVertex, Target, fetch};
use estampe_types::shader::Shader;
use estampe_types::state::VertexBufferLayout;
use estampe_types::{Bindings, BufferData, IndexFormat};
use pass::Pass;
use std::collections::HashMap;
use std::ops::Range;

/// The parameters and buffers of a draw.
#[derive(Debug, Clone)]
pub struct Draw<'a> {
    /// Vertex buffers with their layouts.
    pub buffers: &'a [(VertexBufferLayout, BufferData)],
    /// The index buffer, if the draw has one.
    pub indices: Option<(IndexFormat, &'a BufferData)>,
    /// The range of vertices, or of elements of the index buffer.
    pub vertices: Range<u32>,
    /// The range of instances, drawn one after the other.
    pub instances: Range<u32>,
    /// Added to each index; without an index buffer it has no effect.
    pub base_vertex: i32,
    /// The shader's uniforms, textures and storage textures.
    pub bindings: &'a Bindings,
}

impl Draw<'_> {
    /// The index of the vertex at a position in the range, counted from the range's start.
    #[must_use]
    pub fn vertex_index(&self, position: u32) -> u32 {
        let element = self.vertices.start.wrapping_add(position);
        match self.indices {
            Some((format, buffer)) => fetch::index(format, buffer, element, self.base_vertex),
            None => element,
        }
    }

    /// Returns true if the index at a position in the range restarts primitives: it is the greatest
    /// of its format.
    #[must_use]
    pub fn is_restart(&self, position: u32) -> bool {
        let element = self.vertices.start.wrapping_add(position);
        self.indices.is_some_and(|(format, buffer)| {
            let greatest = match format {
                IndexFormat::Uint8 => u32::from(u8::MAX),
                IndexFormat::Uint16 => u32::from(u16::MAX),
                IndexFormat::Uint32 => u32::MAX,
            };
            fetch::raw_index(format, buffer, element) == greatest
        })
    }
}

/// Statistics of a draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Assembled primitives.
    pub primitives: u64,
    /// Points, lines and triangles that reached the rasterizer, after clipping and culling. In
    /// polygon modes line and point, the lines and points.
    pub rasterized: u64,
    /// Fragment shader invocations, per pixel or per sample, without helper invocations.
    pub fragments: u64,
    /// Covered samples.
    pub samples_covered: u64,
    /// Samples that passed every test.
    pub samples_passed: u64,
}

/// Draws into a target.
///
/// A draw whose viewport, scissor and target have no pixel in common does nothing: none of it is
/// counted.
///
/// It cannot fail: indices out of range and short buffers read as zeros, and NaN and infinity are
/// dropped or stored as NUMERICS.md says; a shader of which no pipeline can be made draws nothing.
/// Its time is proportional to the vertex and instance
/// ranges, however large.
pub fn draw<S: Shader>(target: &mut Target, shader: &S, state: &State, draw: &Draw<'_>) -> Counts {
    match RustShaders::new(shader) {
        Ok(shaders) => draw_observed(target, &shaders, state, draw, &mut ()),
        Err(_) => Counts::default(),
    }
}

/// Draws with any shaders into the stored pixels of a target, and tells an observer what happens:
/// of each primitive its pieces, whether they have stored pixels or not.
pub fn draw_observed(
    target: &mut Target,
    shaders: &dyn Shaders,
    state: &State,
    draw: &Draw<'_>,
    observer: &mut dyn Observer,
) -> Counts {
    let Some(mut pass) = Pass::new(target, shaders, state, draw.bindings, observer) else {
        return Counts::default();
    };
    for instance in draw.instances.clone() {
        // Wherever an index names a vertex, its outputs are the same. The map is no larger than the
        // index buffer; without one it would grow with the range of vertices, so none are kept.
        let mut of_index: HashMap<u32, ClipVertex> = HashMap::new();
        for run in draw_runs(state, draw) {
            let shade = |at: u32| {
                let shaded = || shade_vertex(shaders, draw, at, instance);
                match draw.indices {
                    Some(_) => {
                        let vertex = of_index.entry(draw.vertex_index(at));
                        vertex.or_insert_with(shaded).clone()
                    }
                    None => shaded(),
                }
            };
            pass.run(&run, instance, shade);
        }
    }
    pass.counts
}

/// The runs of a draw's positions without a restart between them.
pub(crate) fn draw_runs(state: &State, draw: &Draw<'_>) -> Vec<Range<u32>> {
    let count = draw.vertices.end.saturating_sub(draw.vertices.start);
    match draw.indices {
        Some(_) if state.primitive.primitive_restart => runs(count, |at| draw.is_restart(at)),
        _ => std::iter::once(0..count).collect(),
    }
}

/// Draws vertices that tessellation or a geometry shader made, a list of the points, lines or
/// triangles of the state's topology, with the fragment shader of `shader`.
pub fn draw_vertices<S: Shader>(
    target: &mut Target,
    shader: &S,
    state: &State,
    bindings: &Bindings,
    vertices: &[ClipVertex],
) -> Counts {
    let Ok(shaders) = RustShaders::new(shader) else {
        return Counts::default();
    };
    draw_vertices_observed(target, &shaders, state, bindings, vertices, &mut ())
}

/// Draws as [`draw_vertices`] does, with any shaders, and tells an observer what happens. The
/// positions of a primitive are those in the list.
pub fn draw_vertices_observed(
    target: &mut Target,
    shaders: &dyn Shaders,
    state: &State,
    bindings: &Bindings,
    vertices: &[ClipVertex],
    observer: &mut dyn Observer,
) -> Counts {
    let Some(mut pass) = Pass::new(target, shaders, state, bindings, observer) else {
        return Counts::default();
    };
    let count = u32::try_from(vertices.len()).unwrap_or(u32::MAX);
    pass.run(&(0..count), 0, |at| vertices[at as usize].clone());
    pass.counts
}
