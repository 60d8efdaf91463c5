//! Geometry shaders: the vertices that are made of a list of primitives.
//!
//! In · Out: the vertices of primitives, with adjacency · the vertices of points, lines or
//! triangles, as a list, with layer and viewport index. Spec: Vulkan §Geometry Shading.

mod primitive_shaders;

pub use primitive_shaders::{Placed, PrimitiveShaders, ProgramPrimitives, RustPrimitives};

use crate::pipeline::draw_runs;
use crate::program::{RustShaders, Shaders};
use crate::shading::shade_vertex;
use crate::{ClipVertex, Draw, State, assembly};
use estampe_types::Bindings;
use estampe_types::shader::{GeometryShader, GeometryTopology, Shader};
use estampe_types::state::{PrimitiveTopology, ProvokingVertex};

/// A primitive that was emitted.
#[derive(Debug, Clone, PartialEq)]
pub struct EmittedPrimitive {
    /// One, two or three vertices, in the order of a list.
    pub vertices: Vec<ClipVertex>,
    /// The layer and the viewport index of the provoking vertex.
    pub place: [u32; 2],
    /// The invocation that emitted it.
    pub invocation: usize,
}

/// A primitive that a geometry shader reads.
#[derive(Debug, Clone, PartialEq)]
pub struct InputPrimitive {
    /// The index of the instance.
    pub instance: u32,
    /// The number of the primitive in its instance.
    pub number: i32,
    /// The positions of its vertices in the draw's range, those of neighbours included.
    pub positions: Vec<u32>,
    /// Its vertices.
    pub vertices: Vec<ClipVertex>,
}

/// The vertices of a draw's primitives, all six of a triangle with adjacency, and for each
/// primitive its number in its instance.
pub fn input<V: Shader>(vertex: &V, state: &State, draw: &Draw<'_>) -> (Vec<ClipVertex>, Vec<i32>) {
    let Ok(shaders) = RustShaders::new(vertex) else {
        return Default::default();
    };
    let (mut vertices, mut numbers) = (Vec::new(), Vec::new());
    for_each_input(&shaders, state, draw, &mut |primitive| {
        vertices.extend_from_slice(&primitive.vertices);
        numbers.push(primitive.number);
    });
    (vertices, numbers)
}

/// Assembles the primitives of a draw, one after the other.
pub fn for_each_input(
    vertex: &dyn Shaders,
    state: &State,
    draw: &Draw<'_>,
    visit: &mut dyn FnMut(&InputPrimitive),
) {
    for instance in draw.instances.clone() {
        let mut number = 0;
        for run in draw_runs(state, draw) {
            for mut positions in primitives(state.primitive.topology, run.end - run.start) {
                for position in &mut positions {
                    *position += run.start;
                }
                let shade = |&at: &u32| shade_vertex(vertex, draw, at, instance);
                visit(&InputPrimitive {
                    instance,
                    number,
                    vertices: positions.iter().map(shade).collect(),
                    positions,
                });
                number += 1;
            }
        }
    }
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
    let Ok(shaders) = RustPrimitives::new(shader) else {
        return Vec::new();
    };
    let primitives = vertices.chunks(G::INPUT.vertices()).zip(numbers);
    let emitted = primitives
        .flat_map(|(corners, &number)| emitted(&shaders, corners, number, provoking, bindings));
    emitted.collect()
}

/// The primitives that a geometry shader makes of one.
pub fn emitted(
    shaders: &dyn PrimitiveShaders,
    corners: &[ClipVertex],
    number: i32,
    provoking: ProvokingVertex,
    bindings: &Bindings,
) -> Vec<EmittedPrimitive> {
    let mut all = Vec::new();
    let invocations = shaders.strips(corners, number, bindings);
    for (invocation, strips) in invocations.iter().enumerate() {
        for strip in strips {
            let mut primitives = primitives_of(strip, shaders.topology(), provoking);
            for primitive in &mut primitives {
                primitive.invocation = invocation;
            }
            all.append(&mut primitives);
        }
    }
    all
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
        EmittedPrimitive {
            vertices,
            place,
            invocation: 0,
        }
    });
    primitives.collect()
}
