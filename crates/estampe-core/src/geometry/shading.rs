//! Vertex shading (V1): runs the program over an item's vertices and projects what it gives.
//!
//! *In* a dense range of vertices · *Out* [`ShadedVertices`] · *Space* clip, then window.

use super::fetch::{PacketIndex, fetch, fetch_rare};
use super::rows::{store_rows, store_scalars};
use super::viewport::ViewportTransform;
use crate::pipeline::{Decoding, RenderPipeline};
use estampe_simd::{
    Bytes, LANES, Lanes, Level, Packet, Select, SimdBase, dispatch, f32x16, i32x16,
};
use estampe_types::{Bindings, Buffer, Interface, VertexBatch};

/// Packets that a program shades in one call. Few, because fetching and storing wait for memory while programs
/// compute: of a million triangles' half a million vertices, with 2, 4, 8 and 16 packets, the geometry side took
/// 9.6, 9.9, 10.5 and 11.6 ms of CPU time.
const BATCH: usize = 2;

/// Vertices of a packet.
#[expect(clippy::cast_possible_truncation, reason = "sixteen")]
pub(crate) const PACKET: u32 = LANES as u32;

/// A window x that says "this vertex must be clipped"; no snapped coordinate reaches it.
pub(crate) const NEEDS_CLIPPING: i32 = i32::MIN;

/// A vertex in the window, as bits: x and y in 1/256 pixel, depth, 1/w.
pub(crate) type WindowRow = [u32; 4];

/// Vertices after the shader and the viewport, one after the other.
#[derive(Debug, Default)]
pub(crate) struct ShadedVertices {
    pub(crate) window: Vec<WindowRow>,
    /// Clip-space positions as bits: of points, lines and outlines, which all look at them.
    pub(crate) clip: Vec<[u32; 4]>,
    /// The varyings' scalars of each vertex.
    pub(crate) varyings: Vec<f32>,
    /// Point sizes in pixels, where points are drawn.
    pub(crate) point_size: Vec<f32>,
}

/// The part of [`ShadedVertices`] that one worker fills.
#[derive(Debug)]
pub(crate) struct ShadedSlice<'a> {
    pub(crate) window: &'a mut [WindowRow],
    pub(crate) clip: &'a mut [[u32; 4]],
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
    /// The draw's first instance, which an item's need not be.
    pub(crate) base_instance: u32,
    pub(crate) instances: u32,
    /// Explicit vertex indices in place of the dense range, where indices are sparse.
    pub(crate) sparse: Option<&'a [u32]>,
}

impl VertexSource<'_> {
    /// How many flat vertices there are.
    fn total(&self) -> u32 {
        self.count.saturating_mul(self.instances)
    }
}

/// Memory of one worker.
#[derive(Debug, Default)]
pub(crate) struct ShadingScratch {
    vertex_index: [Packet<u32>; BATCH],
    instance_index: [Packet<u32>; BATCH],
    attributes: Vec<Packet<f32>>,
    positions: [[Packet<f32>; 4]; BATCH],
    varyings: Vec<Packet<f32>>,
    point_size: [Packet<f32>; BATCH],
    /// Clip distances, then cull distances, by packet.
    distances: Vec<Packet<f32>>,
}

impl ShadingScratch {
    /// The distances of the first packet that was shaded last.
    pub(crate) fn distances_of_first(&self, pipeline: &RenderPipeline) -> &[Packet<f32>] {
        &self.distances[..pipeline.interface().distances()]
    }
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
    let (stride, distances) = (interface.varyings.len(), interface.distances());
    let total = out.window.len();
    let mut done = 0;
    while done < total {
        let count = (total - done).min(BATCH * LANES);
        let packets = count.div_ceil(LANES);
        run(level, pipeline, source, (first, done, total), scratch);
        dispatch!(level, s => store_batch(s, transform, stride, done, packets, (out, scratch)));
        if distances > 0 {
            mark_distant(interface, &scratch.distances, &mut out.window[done..]);
        }
        done += count;
    }
}

/// The clip-space positions of the packet that begins with the flat vertex `first`.
pub(crate) fn shade_positions(
    level: Level,
    pipeline: &RenderPipeline,
    source: &VertexSource<'_>,
    first: u32,
    scratch: &mut ShadingScratch,
) -> [Packet<f32>; 4] {
    let total = source.total().saturating_sub(first).min(PACKET);
    run(level, pipeline, source, (first, 0, total as usize), scratch);
    scratch.positions[0]
}

/// Fetches and shades a batch: the vertices from `done` on of `total`, which begin at the flat vertex
/// `first`.
fn run(
    level: Level,
    pipeline: &RenderPipeline,
    source: &VertexSource<'_>,
    (first, done, total): (u32, usize, usize),
    scratch: &mut ShadingScratch,
) {
    let interface = pipeline.interface();
    let stride = interface.varyings.len();
    let attributes = interface.attribute_scalars();
    let packets = (total - done).div_ceil(LANES).min(BATCH);
    scratch
        .attributes
        .resize(attributes * BATCH, Packet::default());
    scratch.varyings.resize(stride * BATCH, Packet::default());
    let distances = interface.distances();
    scratch
        .distances
        .resize(distances * BATCH, Packet::default());
    dispatch!(level, s => fetch_batch(s, pipeline, source, (first, done, total), scratch));
    let sources = pipeline.attributes();
    if sources
        .iter()
        .any(|source| source.decoding == Decoding::Rare)
    {
        for packet in 0..packets {
            let index = PacketIndex {
                vertex: scratch.vertex_index[packet],
                instance: scratch.instance_index[packet],
                first: None,
            };
            let index = (&index, source.base_instance);
            let out = &mut scratch.attributes[packet * attributes..][..attributes];
            let wanted = &interface.attributes;
            fetch_rare(level, sources, wanted, source.buffers, index, out);
        }
    }
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
            vertex_index: &scratch.vertex_index[..packets],
            instance_index: &scratch.instance_index[..packets],
            positions: &mut scratch.positions.as_flattened_mut()[..packets * 4],
            varyings: &mut scratch.varyings[..packets * stride],
            point_sizes: &mut scratch.point_size[..sizes],
            distances: &mut scratch.distances[..packets * distances],
        },
    );
}

/// Writes the vertex and instance index of each lane of the packet whose first vertex is the flat vertex
/// `first`; lanes beyond the end repeat the last vertex.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "a lane is below 16")]
fn number_vertices(source: &VertexSource<'_>, first: u32, last: u32, index: &mut PacketIndex) {
    let (start, turn) = (first % source.count, first / source.count);
    let follows = last - first >= LANES as u32 - 1 && source.count - start >= LANES as u32;
    let vertex = source.first_vertex.checked_add(start);
    index.first = match (vertex, source.sparse) {
        (Some(vertex), None) if follows && vertex <= u32::MAX - LANES as u32 => Some(vertex),
        _ => None,
    };
    if let Some(vertex) = index.first {
        for (lane, to) in index.vertex.0.iter_mut().enumerate() {
            *to = vertex + lane as u32;
        }
        index.instance.0 = [source.first_instance.wrapping_add(turn); LANES];
        return;
    }
    let lanes = index.vertex.0.iter_mut().zip(&mut index.instance.0);
    for (lane, (vertex, instance)) in lanes.enumerate() {
        let flat = first.saturating_add(lane as u32).min(last);
        let (start, turn) = (flat % source.count, flat / source.count);
        *vertex = match source.sparse {
            Some(sparse) => sparse.get(start as usize).copied().unwrap_or_default(),
            None => source.first_vertex.wrapping_add(start),
        };
        *instance = source.first_instance.wrapping_add(turn);
    }
}

/// Fetches the attributes of a batch: the vertices from `done` on of `total`, which begin at the flat
/// vertex `first`.
#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "an item has fewer than 2³² vertices"
)]
fn fetch_batch<S: Lanes>(
    s: S,
    pipeline: &RenderPipeline,
    source: &VertexSource<'_>,
    (first, done, total): (u32, usize, usize),
    scratch: &mut ShadingScratch,
) {
    let wanted = &pipeline.interface().attributes;
    let scalars: usize = wanted.iter().sum();
    let packets = (total - done).div_ceil(LANES).min(BATCH);
    let last = first + (total - 1) as u32;
    for packet in 0..packets {
        let mut index = PacketIndex::default();
        let start = first + (done + packet * LANES) as u32;
        number_vertices(source, start, last, &mut index);
        scratch.vertex_index[packet] = index.vertex;
        scratch.instance_index[packet] = index.instance;
        let out = &mut scratch.attributes[packet * scalars..][..scalars];
        fetch(
            s,
            pipeline.attributes(),
            wanted,
            source.buffers,
            &index,
            out,
        );
    }
}

/// Marks the vertices of a batch that a clip or cull distance keeps from being drawn as they are. So primitives
/// that no distance touches take the way of all others.
#[inline(never)]
fn mark_distant(interface: &Interface, distances: &[Packet<f32>], window: &mut [WindowRow]) {
    let of_packets = distances.chunks_exact(interface.distances());
    for (of_packet, rows) in of_packets.zip(window.chunks_mut(LANES)) {
        let (clip, cull) = of_packet.split_at(interface.clip_distances);
        for (lane, row) in rows.iter_mut().enumerate() {
            let is_kept = |distance: &Packet<f32>| (0.0..f32::INFINITY).contains(&distance.0[lane]);
            if !clip.iter().all(is_kept) || cull.iter().any(|distance| distance.0[lane] < 0.0) {
                row[0] = NEEDS_CLIPPING.cast_unsigned();
            }
        }
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
        let clip = [
            f32x16::load_array_ref(s, &x.0),
            f32x16::load_array_ref(s, &y.0),
            f32x16::load_array_ref(s, &z.0),
            f32x16::load_array_ref(s, &w.0),
        ];
        let projected = transform.project_lanes(s, clip);
        let outside = <i32x16<S> as SimdBase<S>>::splat(s, NEEDS_CLIPPING);
        let x = projected.inside.select(projected.x, outside);
        let window = [
            x.bitcast(),
            projected.y.bitcast(),
            projected.z.bitcast(),
            projected.iw.bitcast(),
        ];
        let first = done + packet * LANES;
        let count = (out.window.len() - first).min(LANES);
        store_rows(s, window, &mut out.window[first..][..count]);
        if !out.clip.is_empty() {
            let clip = [
                clip[0].bitcast(),
                clip[1].bitcast(),
                clip[2].bitcast(),
                clip[3].bitcast(),
            ];
            store_rows(s, clip, &mut out.clip[first..][..count]);
        }
        let varyings = &scratch.varyings[packet * stride..][..stride];
        let to = &mut out.varyings[first * stride..][..count * stride];
        store_scalars(s, varyings, to);
        if !out.point_size.is_empty() {
            let sizes = &scratch.point_size[packet].0[..count];
            out.point_size[first..][..count].copy_from_slice(sizes);
        }
    }
}
