//! Vertex shading (V1): runs the program over an item's vertices and projects what it gives.
//!
//! *In* a dense range of vertices · *Out* [`ShadedVertices`] · *Space* clip, then window.

use super::fetch::fetch;
use super::viewport::ViewportTransform;
use crate::pipeline::RenderPipeline;
use estampe_simd::{LANES, Lanes, Level, Packet, SimdBase, dispatch, f32x16};
use estampe_types::{Bindings, Buffer, VertexBatch};

/// Packets that a program shades in one call.
const BATCH: usize = 4;

/// A window x that says "this vertex must be clipped"; no snapped coordinate reaches it.
pub(crate) const NEEDS_CLIPPING: i32 = i32::MIN;

/// Vertices after the shader and the viewport, one after the other.
#[derive(Debug, Default)]
pub(crate) struct ShadedVertices {
    /// x, y in 1/256 pixel, as bits, so that lanes gather them.
    pub(crate) window: Vec<u32>,
    /// Depth and 1/w.
    pub(crate) depth: Vec<[f32; 2]>,
    /// Clip-space positions, for what must be clipped.
    pub(crate) clip: Vec<[f32; 4]>,
    /// The varyings' scalars of each vertex.
    pub(crate) varyings: Vec<f32>,
    /// Point sizes in pixels, where points are drawn.
    pub(crate) point_size: Vec<f32>,
}

/// The part of [`ShadedVertices`] that one worker fills.
#[derive(Debug)]
pub(crate) struct ShadedSlice<'a> {
    pub(crate) window: &'a mut [u32],
    pub(crate) depth: &'a mut [[f32; 2]],
    pub(crate) clip: &'a mut [[f32; 4]],
    pub(crate) varyings: &'a mut [f32],
    pub(crate) point_size: &'a mut [f32],
}

/// Where an item's vertices come from: flat vertex `i` is vertex `i % count` of instance `i / count`.
#[derive(Debug, Clone)]
pub(crate) struct VertexSource<'a> {
    pub(crate) buffers: &'a [Buffer],
    pub(crate) bindings: &'a Bindings,
    /// The first vertex index.
    pub(crate) first_vertex: u32,
    /// Vertices of one instance.
    pub(crate) count: u32,
    pub(crate) first_instance: u32,
    /// Explicit vertex indices in place of the dense range, where indices are sparse.
    pub(crate) sparse: Option<&'a [u32]>,
}

/// Memory of one worker.
#[derive(Debug, Default)]
pub(crate) struct ShadingScratch {
    index: [Packet<u32>; BATCH],
    instance: [Packet<u32>; BATCH],
    attributes: Vec<Packet<f32>>,
    positions: [[Packet<f32>; 4]; BATCH],
    varyings: Vec<Packet<f32>>,
    point_size: [Packet<f32>; BATCH],
}

/// Shades the flat vertices from `first` on, as many as `out` holds.
pub(crate) fn shade(
    level: Level,
    pipeline: &RenderPipeline,
    source: &VertexSource<'_>,
    transform: &ViewportTransform,
    first: u32,
    (out, scratch): (&mut ShadedSlice<'_>, &mut ShadingScratch),
) {
    let interface = pipeline.interface();
    let stride = interface.varyings.len();
    let attributes = interface.attribute_scalars();
    scratch
        .attributes
        .resize(attributes * BATCH, Packet::default());
    scratch.varyings.resize(stride * BATCH, Packet::default());
    let total = out.depth.len();
    let mut done = 0;
    while done < total {
        let count = (total - done).min(BATCH * LANES);
        let packets = count.div_ceil(LANES);
        number_vertices(source, first, done, total, scratch);
        dispatch!(level, s => fetch_batch(s, pipeline, source.buffers, packets, scratch));
        let sizes = if interface.writes_point_size {
            packets
        } else {
            0
        };
        pipeline.program().run_vertices(
            level,
            source.bindings,
            VertexBatch {
                attributes: &scratch.attributes[..packets * attributes],
                vertex_index: &scratch.index[..packets],
                instance_index: &scratch.instance[..packets],
                positions: &mut scratch.positions.as_flattened_mut()[..packets * 4],
                varyings: &mut scratch.varyings[..packets * stride],
                point_sizes: &mut scratch.point_size[..sizes],
            },
        );
        dispatch!(level, s => store_batch(s, transform, stride, done, packets, (out, scratch)));
        done += count;
    }
}

/// Writes the vertex and instance index of each lane; lanes beyond the end repeat the last vertex.
#[expect(
    clippy::cast_possible_truncation,
    reason = "an item has fewer than 2³² vertices"
)]
fn number_vertices(
    source: &VertexSource<'_>,
    first: u32,
    done: usize,
    total: usize,
    scratch: &mut ShadingScratch,
) {
    let indices = scratch.index.iter_mut().flat_map(|packet| &mut packet.0);
    let instances = scratch.instance.iter_mut().flat_map(|packet| &mut packet.0);
    for (lane, (index, instance)) in indices.zip(instances).enumerate() {
        let flat = first + (done + lane).min(total - 1) as u32;
        let (vertex, turn) = if flat < source.count {
            (flat, 0)
        } else {
            (flat % source.count, flat / source.count)
        };
        *index = match source.sparse {
            Some(sparse) => sparse.get(vertex as usize).copied().unwrap_or_default(),
            None => source.first_vertex.wrapping_add(vertex),
        };
        *instance = source.first_instance.wrapping_add(turn);
    }
}

#[inline(always)]
fn fetch_batch<S: Lanes>(
    s: S,
    pipeline: &RenderPipeline,
    buffers: &[Buffer],
    packets: usize,
    scratch: &mut ShadingScratch,
) {
    let wanted = &pipeline.interface().attributes;
    let scalars: usize = wanted.iter().sum();
    for packet in 0..packets {
        let index = [&scratch.index[packet], &scratch.instance[packet]];
        let out = &mut scratch.attributes[packet * scalars..][..scalars];
        fetch(s, pipeline.attributes(), wanted, buffers, index, out);
    }
}

/// Projects a batch and writes it vertex by vertex.
#[inline(always)]
fn store_batch<S: Lanes>(
    s: S,
    transform: &ViewportTransform,
    stride: usize,
    done: usize,
    packets: usize,
    (out, scratch): (&mut ShadedSlice<'_>, &mut ShadingScratch),
) {
    for packet in 0..packets {
        let [x, y, z, w] = &scratch.positions[packet];
        let load = |packet: &Packet<f32>| f32x16::load_array_ref(s, &packet.0);
        let clip = [load(x), load(y), load(z), load(w)];
        let projected = transform.project_lanes(s, clip);
        let inside = s.bits_of_mask(projected.inside);
        let first = done + packet * LANES;
        let count = (out.depth.len() - first).min(LANES);
        let (window_x, window_y) = (projected.x.to_array(), projected.y.to_array());
        let (depth, iw) = (projected.z.to_array(), projected.iw.to_array());
        for (lane, to) in out.window[first * 2..][..count * 2]
            .chunks_exact_mut(2)
            .enumerate()
        {
            let x = if inside >> lane & 1 == 1 {
                window_x[lane]
            } else {
                NEEDS_CLIPPING
            };
            to[0] = x.cast_unsigned();
            to[1] = window_y[lane].cast_unsigned();
        }
        for (lane, to) in out.depth[first..][..count].iter_mut().enumerate() {
            *to = [depth[lane], iw[lane]];
        }
        for (lane, to) in out.clip[first..][..count].iter_mut().enumerate() {
            *to = [x.0[lane], y.0[lane], z.0[lane], w.0[lane]];
        }
        let varyings = &scratch.varyings[packet * stride..][..stride];
        if stride > 0 {
            let to = &mut out.varyings[first * stride..][..count * stride];
            for (lane, vertex) in to.chunks_exact_mut(stride).enumerate() {
                for (scalar, value) in vertex.iter_mut().zip(varyings) {
                    *scalar = value.0[lane];
                }
            }
        }
        if !out.point_size.is_empty() {
            let sizes = &scratch.point_size[packet].0[..count];
            out.point_size[first..][..count].copy_from_slice(sizes);
        }
    }
}
