//! Vertex shading: fetches the attributes of one vertex and shades it.
//!
//! In · Out: vertex and instance index · a vertex in clip space.

use crate::program::{Shaders, VertexInput};
use crate::{Draw, fetch};

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

/// The attributes of the vertex at `position` in the draw's range, counted from the range's start,
/// by location.
#[must_use]
pub fn fetch_attributes(
    shaders: &dyn Shaders,
    draw: &Draw<'_>,
    position: u32,
    instance_index: u32,
) -> Vec<Vec<f32>> {
    let vertex_index = draw.vertex_index(position);
    let instance = [instance_index, draw.instances.start];
    let components = (0u32..).zip(&shaders.interface().attributes);
    let attributes = components.map(|(location, &count)| {
        let value = fetch::attribute(draw.buffers, location, vertex_index, instance);
        value[..count.min(4)].to_vec()
    });
    attributes.collect()
}

/// Fetches and shades the vertex at `position` in the draw's range, counted from the range's start.
#[must_use]
pub fn shade_vertex(
    shaders: &dyn Shaders,
    draw: &Draw<'_>,
    position: u32,
    instance_index: u32,
) -> ClipVertex {
    let attributes = fetch_attributes(shaders, draw, position, instance_index).concat();
    let input = VertexInput {
        vertex_index: draw.vertex_index(position),
        instance_index,
        bindings: draw.bindings,
    };
    shaders.vertex(&input, &attributes)
}
