//! Vertex shading: fetches the attributes of one vertex and shades it.
//!
//! In · Out: vertex and instance index · a vertex in clip space.

use crate::program::{Shaders, VertexInput};
use crate::{Draw, fetch};
use estampe_types::shader::{OutputInterface, Sink, Varyings, VertexOut};

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

impl ClipVertex {
    /// The outputs of a shader that has so many clip and cull distances.
    pub(crate) fn of<V: Varyings<f32>>(
        output: VertexOut<f32, V>,
        [clip, cull]: [usize; 2],
    ) -> Self {
        let p = output.position;
        Self {
            position: [p.x, p.y, p.z, p.w],
            varyings: scalars_of(output.varyings),
            point_size: output.point_size.unwrap_or(1.0),
            clip_distances: given(&output.clip_distances[..clip]),
            cull_distances: given(&output.cull_distances[..cull]),
        }
    }

    /// The vertex of a record that a tessellation or geometry program wrote.
    pub(crate) fn of_record(record: &[u32], output: &OutputInterface) -> Self {
        let mut scalars = record.iter().map(|&word| f32::from_bits(word));
        let mut next = |count: usize| scalars.by_ref().take(count).collect::<Vec<f32>>();
        let position = next(4);
        Self {
            position: [0, 1, 2, 3].map(|k| position[k]),
            varyings: next(output.varyings.len()),
            clip_distances: next(output.clip_distances),
            cull_distances: next(output.cull_distances),
            point_size: match output.writes_point_size {
                true => next(1)[0],
                false => 1.0,
            },
        }
    }

    /// The words that a later stage reads: the position, then the varyings.
    pub(crate) fn words(&self) -> impl Iterator<Item = u32> {
        let scalars = self.position.iter().chain(&self.varyings);
        scalars.map(|scalar| scalar.to_bits())
    }
}

/// The scalars of a value, in order.
pub(crate) fn scalars_of(value: impl Varyings<f32>) -> Vec<f32> {
    let mut scalars = Collected(Vec::new());
    value.store(&mut scalars);
    scalars.0
}

/// The distances; 0 for those that the shader did not write.
fn given(distances: &[Option<f32>]) -> Vec<f32> {
    distances
        .iter()
        .map(|distance| distance.unwrap_or(0.0))
        .collect()
}

/// The scalars that a shader wrote, in order.
struct Collected(Vec<f32>);

impl Sink<f32> for Collected {
    fn put(&mut self, value: f32) {
        self.0.push(value);
    }
}
