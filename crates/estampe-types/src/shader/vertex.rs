//! Inputs and outputs of vertex shaders.

use crate::{Bindings, Real, ShaderError, Vec4};
use estampe_simd::Packet;

/// The built-in inputs of a vertex shader.
#[derive(Debug, Clone, Copy)]
pub struct VertexIn<'a, R: Real> {
    /// Index of the vertex: from the index buffer, or counted from the draw's first element.
    pub vertex_index: R::Int,
    /// Index of the instance.
    pub instance_index: R::Int,
    /// The resources that the draw binds.
    pub bindings: &'a Bindings,
    /// A number of the shader's kind, to make constants from; see [`VertexIn::real`].
    pub zero: R,
}

impl<R: Real> VertexIn<'_, R> {
    /// `value` in every lane.
    #[inline(always)]
    pub fn real(&self, value: f32) -> R {
        self.zero.splat(value)
    }
}

/// Outputs of a vertex shader.
#[derive(Debug, Clone, Copy)]
pub struct VertexOut<R, V> {
    /// Position in clip space: visible where −w ≤ x, y ≤ w and 0 ≤ z ≤ w.
    pub position: Vec4<R>,
    /// Values that are interpolated for the fragments.
    pub varyings: V,
    /// Width of a point in pixels, if the shader sets it.
    pub point_size: Option<R>,
    /// Clip distances: positive inside the plane. Distances that the shader does not set are 0.
    pub clip_distances: [Option<R>; MAX_DISTANCES],
    /// Cull distances: positive inside the plane. Distances that the shader does not set are 0.
    pub cull_distances: [Option<R>; MAX_DISTANCES],
}

/// The maximum number of clip distances, and of cull distances, of a vertex.
pub const MAX_DISTANCES: usize = 8;

impl<R, V> VertexOut<R, V> {
    /// A vertex with a clip-space position and varyings.
    #[inline(always)]
    pub const fn new(position: Vec4<R>, varyings: V) -> Self {
        Self {
            position,
            varyings,
            point_size: None,
            clip_distances: [const { None }; MAX_DISTANCES],
            cull_distances: [const { None }; MAX_DISTANCES],
        }
    }

    /// Sets the point size, in pixels.
    #[inline(always)]
    #[must_use]
    pub fn with_point_size(self, pixels: R) -> Self {
        Self {
            point_size: Some(pixels),
            ..self
        }
    }
}

impl<R: Real, V> VertexOut<R, V> {
    /// Sets clip distance `index`, 0 to 7. Primitives are clipped where the interpolated distance
    /// is negative. A shader that sets another one has no effect there, and no pipeline is made of
    /// it.
    #[inline(always)]
    #[must_use]
    pub fn with_clip_distance(mut self, index: usize, distance: R) -> Self {
        match self.clip_distances.get_mut(index) {
            Some(place) => *place = Some(distance),
            None => distance.report(ShaderError::ClipDistanceIndex { index }),
        }
        self
    }

    /// Sets cull distance `index`, 0 to 7. A primitive is dropped if the distance is negative at
    /// all of its vertices. A shader that sets another one has no effect there, and no pipeline is
    /// made of it.
    #[inline(always)]
    #[must_use]
    pub fn with_cull_distance(mut self, index: usize, distance: R) -> Self {
        match self.cull_distances.get_mut(index) {
            Some(place) => *place = Some(distance),
            None => distance.report(ShaderError::CullDistanceIndex { index }),
        }
        self
    }
}

/// Packets of vertices, structure of arrays: scalar `k` of packet `p` is element `p * scalars + k`.
#[derive(Debug)]
pub struct VertexBatch<'a> {
    /// The attributes' scalars, location by location.
    pub attributes: &'a [Packet<f32>],
    /// Vertex index of each lane, by packet.
    pub vertex_index: &'a [Packet<u32>],
    /// Instance index of each lane, by packet.
    pub instance_index: &'a [Packet<u32>],
    /// Out: x, y, z, w in clip space.
    pub positions: &'a mut [Packet<f32>],
    /// Out: the varyings' scalars.
    pub varyings: &'a mut [Packet<f32>],
    /// Out: point size by packet; empty unless `writes_point_size` is set in the interface.
    pub point_sizes: &'a mut [Packet<f32>],
    /// Out: the clip distances, then the cull distances; empty if the interface has none.
    pub distances: &'a mut [Packet<f32>],
}
