//! Vertex shading: runs the vertex shader on one vertex at a time, with `R = f32`.
//!
//! In · Out: vertex and instance index · a vertex in clip space.

use crate::{Draw, fetch};
use estampe_types::shader::{Attributes, Interface, Shader, Sink, Source, Varyings, VertexIn};

/// The outputs of the vertex shader.
#[derive(Debug, Clone, PartialEq)]
pub struct ClipVertex {
    /// x, y, z, w in clip space.
    pub position: [f32; 4],
    /// The scalars of the varyings, in order.
    pub varyings: Vec<f32>,
    /// The width of a point, in pixels.
    pub point_size: f32,
    /// The clip distances; negative outside.
    pub clip_distances: Vec<f32>,
    /// The cull distances: a primitive is dropped if one of them is negative at all of its
    /// vertices.
    pub cull_distances: Vec<f32>,
}

/// Fetches and shades the vertex at `position` in the draw's range, counted from the range's start.
pub fn shade_vertex<S: Shader>(
    shader: &S,
    interface: &Interface,
    draw: &Draw<'_>,
    position: u32,
    instance_index: u32,
) -> ClipVertex {
    let vertex_index = draw.vertex_index(position);

    let mut components = Vec::new();
    S::Attributes::<f32>::components(&mut components);
    let mut scalars = Vec::new();
    for (location, &count) in (0u32..).zip(&components) {
        let instance = [instance_index, draw.instances.start];
        let value = fetch::attribute(draw.buffers, location, vertex_index, instance);
        scalars.extend(&value[..count.min(4)]);
    }
    let attributes = S::Attributes::load(&mut Scalars(scalars.into_iter()));

    let input = VertexIn {
        vertex_index: vertex_index.cast_signed(),
        instance_index: instance_index.cast_signed(),
        bindings: draw.bindings,
        zero: 0.0_f32,
    };
    let output = shader.vertex(input, attributes);

    let mut varyings = Collected(Vec::new());
    output.varyings.store(&mut varyings);
    let p = output.position;
    ClipVertex {
        position: [p.x, p.y, p.z, p.w],
        varyings: varyings.0,
        point_size: output.point_size.unwrap_or(1.0),
        clip_distances: given(&output.clip_distances[..interface.clip_distances]),
        cull_distances: given(&output.cull_distances[..interface.cull_distances]),
    }
}

/// The distances; 0 for those that the shader did not write.
fn given(distances: &[Option<f32>]) -> Vec<f32> {
    distances
        .iter()
        .map(|distance| distance.unwrap_or(0.0))
        .collect()
}

/// A source of scalars for a shader, in order; zeros after the last.
struct Scalars(std::vec::IntoIter<f32>);

impl Source<f32> for Scalars {
    fn take(&mut self) -> f32 {
        self.0.next().unwrap_or_default()
    }
}

/// The scalars that a shader wrote, in order.
struct Collected(Vec<f32>);

impl Sink<f32> for Collected {
    fn put(&mut self, value: f32) {
        self.0.push(value);
    }
}
