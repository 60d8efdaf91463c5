//! Geometry shaders: the vertices that are made of a list of primitives.
//!
//! In · Out: the vertices of primitives, with adjacency · the vertices of points, lines or
//! triangles, as a list, with layer and viewport index. Spec: Vulkan §Geometry Shading.

use crate::pipeline::draw_runs;
use crate::program::RustShaders;
use crate::shading::shade_vertex;
use crate::{ClipVertex, Draw, State, assembly};
use estampe_types::shader::{
    Emit, EmittedVertex, GeometryIn, GeometryProgram, GeometryShader, GeometryShaderProgram,
    GeometryTopology, Points, Shader,
};
use estampe_types::state::{PrimitiveTopology, ProvokingVertex};
use estampe_types::{Bindings, Varyings};

/// A primitive that was emitted.
#[derive(Debug, Clone, PartialEq)]
pub struct EmittedPrimitive {
    /// One, two or three vertices, in the order of a list.
    pub vertices: Vec<ClipVertex>,
    /// The layer and the viewport index of the provoking vertex.
    pub place: [u32; 2],
}

/// The vertices of a draw's primitives, all six of a triangle with adjacency, and for each
/// primitive its number in its instance.
pub fn input<V: Shader>(vertex: &V, state: &State, draw: &Draw<'_>) -> (Vec<ClipVertex>, Vec<i32>) {
    let Ok(shaders) = RustShaders::new(vertex) else {
        return Default::default();
    };
    let (mut vertices, mut numbers) = (Vec::new(), Vec::new());
    for instance in draw.instances.clone() {
        let mut number = 0;
        for run in draw_runs(state, draw) {
            for corners in primitives(state.primitive.topology, run.end - run.start) {
                let shade = |at| shade_vertex(&shaders, draw, run.start + at, instance);
                vertices.extend(corners.into_iter().map(shade));
                numbers.push(number);
                number += 1;
            }
        }
    }
    (vertices, numbers)
}

/// All positions of each primitive of `count` vertices, after Vulkan's table of primitives with
/// adjacency.
fn primitives(topology: PrimitiveTopology, count: u32) -> Vec<Vec<u32>> {
    use PrimitiveTopology as T;
    let all = assembly::primitives(topology, count).enumerate();
    let number = assembly::primitives(topology, count).count();
    let positions = all.map(|(index, primitive)| {
        let i = u32::try_from(index).unwrap_or(u32::MAX);
        match (topology, primitive) {
            (T::LineListAdjacency, _) => (4 * i..4 * i + 4).collect(),
            (T::LineStripAdjacency, _) => (i..i + 4).collect(),
            (T::TriangleListAdjacency, _) => (6 * i..6 * i + 6).collect(),
            (T::TriangleStripAdjacency, _) => {
                // The neighbours of the triangle's edge that came before, of the one beside it, and
                // of the one ahead.
                let before = if i == 0 { 1 } else { 2 * i - 1 };
                let beside = 2 * i + 3;
                let ahead = 2 * i + if index + 1 == number { 5 } else { 6 };
                if i % 2 == 0 {
                    vec![2 * i, before, 2 * i + 2, ahead, 2 * i + 4, beside]
                } else {
                    vec![2 * i, beside, 2 * i + 4, ahead, 2 * i + 2, before]
                }
            }
            (_, assembly::Primitive::Point(a)) => vec![a],
            (_, assembly::Primitive::Line(line)) => line.to_vec(),
            (_, assembly::Primitive::Triangle(triangle)) => triangle.to_vec(),
        }
    });
    positions.collect()
}

/// The primitives that a geometry shader makes of others.
pub fn emit<G: GeometryShader + Clone>(
    shader: &G,
    (vertices, numbers): &(Vec<ClipVertex>, Vec<i32>),
    provoking: ProvokingVertex,
    bindings: &Bindings,
) -> Vec<EmittedPrimitive> {
    let program = GeometryShaderProgram::new(shader.clone());
    if program.validate().is_err() {
        return Vec::new();
    }
    let output = &program.interface().output;
    let distances = [output.clip_distances, output.cull_distances];
    let mut all = Vec::new();
    for (corners, &number) in vertices.chunks(G::INPUT.vertices()).zip(numbers) {
        let records: Vec<u32> = corners.iter().flat_map(ClipVertex::words).collect();
        let words = records.len() / corners.len();
        for invocation in 0..G::INVOCATIONS {
            let mut strips = Strips {
                strips: vec![Vec::new()],
                left: G::MAX_VERTICES,
                distances,
            };
            let input = GeometryIn {
                points: Points::of_patch(0.0_f32, &records, words, corners.len()),
                primitive_index: number,
                invocation,
                bindings,
                zero: 0.0,
            };
            shader.geometry(input, &mut strips);
            for strip in &strips.strips {
                all.extend(primitives_of(strip, G::OUTPUT, provoking));
            }
        }
    }
    all
}

/// A vertex with its layer and viewport index.
type Placed = (ClipVertex, [u32; 2]);

/// The strips that one invocation emits.
struct Strips {
    strips: Vec<Vec<Placed>>,
    /// Vertices that may still be emitted.
    left: usize,
    distances: [usize; 2],
}

impl<V: Varyings<f32>> Emit<f32, V> for Strips {
    fn emit(&mut self, lanes: bool, vertex: impl Into<EmittedVertex<f32, V>>) {
        if !lanes || self.left == 0 {
            return;
        }
        self.left -= 1;
        let vertex = vertex.into();
        let place = [vertex.layer, vertex.viewport_index];
        let place = place.map(|number| number.unwrap_or(0).cast_unsigned());
        let vertex = ClipVertex::of(vertex.vertex, self.distances);
        if let Some(strip) = self.strips.last_mut() {
            strip.push((vertex, place));
        }
    }

    fn end_primitive(&mut self, lanes: bool) {
        if lanes {
            self.strips.push(Vec::new());
        }
    }
}

/// The primitives of a strip.
fn primitives_of(
    strip: &[Placed],
    topology: GeometryTopology,
    provoking: ProvokingVertex,
) -> Vec<EmittedPrimitive> {
    let size = match topology {
        GeometryTopology::PointList => 1,
        GeometryTopology::LineStrip => 2,
        GeometryTopology::TriangleStrip => 3,
    };
    let windows = strip.windows(size).enumerate();
    let primitives = windows.map(|(number, window)| {
        let is_last = provoking == ProvokingVertex::Last;
        let place = window[if is_last { size - 1 } else { 0 }].1;
        let mut vertices: Vec<ClipVertex> =
            window.iter().map(|(vertex, _)| vertex.clone()).collect();
        if size == 3 && number % 2 == 1 {
            // Turned, with the provoking vertex where it was.
            if is_last {
                vertices.swap(0, 1);
            } else {
                vertices.swap(1, 2);
            }
        }
        EmittedPrimitive { vertices, place }
    });
    primitives.collect()
}
