//! What a vertex shader is given and gives.

use crate::{Bindings, Real, Vec4};
use estampe_simd::Packet;

/// The built-in inputs of a vertex shader.
#[derive(Debug, Clone, Copy)]
pub struct VertexIn<'a, R: Real> {
    /// Index of the vertex: from the index buffer, or counted.
    pub vertex_index: R::Int,
    /// Index of the instance.
    pub instance_index: R::Int,
    /// What the draw binds.
    pub bindings: &'a Bindings,
    /// Any number, to make constants from.
    pub zero: R,
}

impl<R: Real> VertexIn<'_, R> {
    /// A constant.
    #[inline(always)]
    pub fn real(&self, value: f32) -> R {
        self.zero.splat(value)
    }
}

/// What a vertex shader gives.
#[derive(Debug, Clone, Copy)]
pub struct VertexOut<R, V> {
    /// Position in clip space: visible where −w ≤ x, y ≤ w and 0 ≤ z ≤ w.
    pub position: Vec4<R>,
    /// What the fragments get, interpolated.
    pub varyings: V,
    /// Width of a point in pixels, if the shader sets it.
    pub point_size: Option<R>,
    /// How far inside each clip distance's plane the vertex is; 0 where the shader does not say.
    pub clip_distances: [Option<R>; MAX_DISTANCES],
    /// The same of cull distances.
    pub cull_distances: [Option<R>; MAX_DISTANCES],
}

/// How many clip distances, and how many cull distances, a vertex may have.
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

    /// The same with a point size in pixels; the shader must say `WRITES_POINT_SIZE`.
    #[inline(always)]
    #[must_use]
    pub fn with_point_size(self, pixels: R) -> Self {
        Self {
            point_size: Some(pixels),
            ..self
        }
    }

    /// The same with clip distance `index`, of as many as the shader says in `CLIP_DISTANCES`: primitives are cut
    /// where it, interpolated, is negative.
    #[inline(always)]
    #[must_use]
    pub fn with_clip_distance(mut self, index: usize, distance: R) -> Self {
        if let Some(place) = self.clip_distances.get_mut(index) {
            *place = Some(distance);
        }
        self
    }

    /// The same with cull distance `index`, of as many as the shader says in `CULL_DISTANCES`: a primitive is
    /// dropped if one of them is negative at all of its vertices.
    #[inline(always)]
    #[must_use]
    pub fn with_cull_distance(mut self, index: usize, distance: R) -> Self {
        if let Some(place) = self.cull_distances.get_mut(index) {
            *place = Some(distance);
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
    /// Out: point size by packet; empty unless the interface says that it is written.
    pub point_sizes: &'a mut [Packet<f32>],
    /// Out: the clip distances that the interface names, then the cull distances; empty if it names none.
    pub distances: &'a mut [Packet<f32>],
}
