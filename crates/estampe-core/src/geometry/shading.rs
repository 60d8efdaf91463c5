//! Vertex shading (V1): runs the program over a sub-draw's vertices and takes what it gives to the
//! window.
//!
//! *In* a dense range of vertices · *Out* a slice of
//! [`ShadedVertices`](super::shaded_vertices::ShadedVertices) · *Space* clip, then window.

use super::ahead::prefetch;
use super::fetch::{PacketIndex, fetch, fetch_rare};
use super::shaded_vertices::{NEEDS_CLIPPING, PackedVertex, ShadedSlice};
use super::viewport::ViewportTransform;
use crate::bounds::transpose::{store_components, store_records};
use crate::pipeline::{Decoding, RenderPipeline};
use estampe_simd::{
    Bytes, LANES, Lanes, Level, Packet, Select, SimdBase, dispatch, f32x16, i32x16, u32x16,
};
use estampe_types::{Bindings, BufferData, Interface, VertexBatch};

/// The most packets that a program shades in one call: 16 are no gain.
const BATCH: usize = 8;

/// The memory of vertices is prefetched as many before they are stored: four packets.
const AHEAD: usize = 4 * LANES;

/// Vertices of a packet.
#[expect(clippy::cast_possible_truncation, reason = "sixteen")]
pub(crate) const PACKET: u32 = LANES as u32;

/// The number of each lane.
const LANE_NUMBERS: [u32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// The source of a sub-draw's vertices. Flat vertex `i` is vertex `i % count` of instance `i /
/// count`.
#[derive(Debug, Clone)]
pub(crate) struct VertexSource<'a> {
    pub(crate) pipeline: &'a RenderPipeline,
    pub(crate) buffers: &'a [BufferData],
    pub(crate) bindings: &'a Bindings,
    /// The first vertex index.
    pub(crate) first_vertex: u32,
    /// Vertices of one instance.
    pub(crate) count: u32,
    pub(crate) first_instance: u32,
    /// The draw's first instance, which the sub-draw's need not be.
    pub(crate) base_instance: u32,
    pub(crate) instances: u32,
    /// Explicit vertex indices in place of the dense range, where indices are sparse.
    pub(crate) sparse: Option<&'a [u32]>,
}

impl VertexSource<'_> {
    /// Returns the number of flat vertices.
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
    /// The distances of the first packet of the batch that was shaded last, of a shader with so
    /// many.
    pub(crate) fn distances_of_first(&self, distances: usize) -> &[Packet<f32>] {
        &self.distances[..distances]
    }
}

/// A batch of flat vertices: those from `done` on of `total`, which begin at `first`.
#[derive(Debug, Clone, Copy)]
struct ShadeBatch {
    first: u32,
    done: usize,
    total: usize,
}

impl ShadeBatch {
    /// Returns the number of packets in the batch.
    #[inline(always)]
    fn packets(self) -> usize {
        (self.total - self.done).div_ceil(LANES).min(BATCH)
    }
}

/// Shades the flat vertices from `first` on, as many as `out` holds.
pub(crate) fn shade(
    level: Level,
    source: &VertexSource<'_>,
    transform: &ViewportTransform,
    first: u32,
    out: &mut ShadedSlice<'_>,
    scratch: &mut ShadingScratch,
) {
    let interface = source.pipeline.interface();
    let total = out.window.len();
    let mut batch = ShadeBatch {
        first,
        done: 0,
        total,
    };
    while batch.done < total {
        run(level, source, batch, scratch);
        dispatch!(level, s => store_batch(s, transform, batch, out, scratch));
        if interface.distances() > 0 {
            let window = &mut out.window[batch.done..];
            mark_outside_distances(interface, &scratch.distances, window);
        }
        batch.done += BATCH * LANES;
    }
}

/// The clip-space positions of the packet that begins with the flat vertex `first`.
pub(crate) fn shade_positions(
    level: Level,
    source: &VertexSource<'_>,
    first: u32,
    scratch: &mut ShadingScratch,
) -> [Packet<f32>; 4] {
    let total = source.total().saturating_sub(first).min(PACKET) as usize;
    let batch = ShadeBatch {
        first,
        done: 0,
        total,
    };
    run(level, source, batch, scratch);
    scratch.positions[0]
}

/// Fetches and shades a batch.
fn run(level: Level, source: &VertexSource<'_>, batch: ShadeBatch, scratch: &mut ShadingScratch) {
    let pipeline = source.pipeline;
    let interface = pipeline.interface();
    let stride = interface.varyings.len();
    let attributes = interface.attribute_scalars();
    let packets = batch.packets();
    scratch
        .attributes
        .resize(attributes * BATCH, Packet::default());
    scratch.varyings.resize(stride * BATCH, Packet::default());
    let distances = interface.distances();
    scratch
        .distances
        .resize(distances * BATCH, Packet::default());
    dispatch!(level, s => fetch_batch(s, source, batch, scratch));
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

/// Writes the vertex and instance index of each lane of the packet whose first vertex is the flat
/// vertex `first`; lanes beyond the flat vertex `last` repeat it.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "a lane is below 16")]
fn number_vertices<S: Lanes>(
    s: S,
    source: &VertexSource<'_>,
    [first, last]: [u32; 2],
    index: &mut PacketIndex,
) {
    let (mut start, mut turn) = match source.count {
        count if first < count => (first, 0),
        count => (first % count, first / count),
    };
    let follows = last - first >= LANES as u32 - 1 && source.count - start >= LANES as u32;
    let vertex = source.first_vertex.checked_add(start);
    index.first = match (vertex, source.sparse) {
        (Some(vertex), None) if follows && vertex <= u32::MAX - LANES as u32 => Some(vertex),
        _ => None,
    };
    let left = last - first;
    if source.sparse.is_none() && left.min(LANES as u32 - 1) < source.count - start {
        // All in one instance. They are copied and loaded as whole vectors, which is fast only if
        // they were stored as such.
        let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
        let lanes = u32x16::load_array(s, LANE_NUMBERS).min(splat(left));
        let vertices = lanes + splat(source.first_vertex.wrapping_add(start));
        vertices.store_array(&mut index.vertex.0);
        let instance = source.first_instance.wrapping_add(turn);
        splat(instance).store_array(&mut index.instance.0);
        return;
    }
    let lanes = index.vertex.0.iter_mut().zip(&mut index.instance.0);
    for (lane, (vertex, instance)) in (0..).zip(lanes) {
        *vertex = match source.sparse {
            // As many as the source's count.
            Some(sparse) => sparse[start as usize],
            None => source.first_vertex.wrapping_add(start),
        };
        *instance = source.first_instance.wrapping_add(turn);
        if lane < left {
            start += 1;
            if start == source.count {
                (start, turn) = (0, turn + 1);
            }
        }
    }
}

/// Fetches the attributes of a batch.
#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "a sub-draw has fewer than 2³² vertices"
)]
fn fetch_batch<S: Lanes>(
    s: S,
    source: &VertexSource<'_>,
    batch: ShadeBatch,
    scratch: &mut ShadingScratch,
) {
    let pipeline = source.pipeline;
    let wanted = &pipeline.interface().attributes;
    let scalars: usize = wanted.iter().sum();
    let last = batch.first + (batch.total - 1) as u32;
    for packet in 0..batch.packets() {
        let mut index = PacketIndex::default();
        let start = batch.first + (batch.done + packet * LANES) as u32;
        number_vertices(s, source, [start, last], &mut index);
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

/// Marks the vertices of a batch with a negative clip or cull distance as needing clipping. All
/// other primitives are drawn as if there were no distances.
#[inline(never)]
fn mark_outside_distances(
    interface: &Interface,
    distances: &[Packet<f32>],
    window: &mut [PackedVertex],
) {
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

/// Takes a batch to the window and writes it vertex by vertex.
#[inline(always)]
fn store_batch<S: Lanes>(
    s: S,
    transform: &ViewportTransform,
    batch: ShadeBatch,
    out: &mut ShadedSlice<'_>,
    scratch: &ShadingScratch,
) {
    let stride = scratch.varyings.len() / BATCH;
    for packet in 0..batch.packets() {
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
        let first = batch.done + packet * LANES;
        let count = (out.window.len() - first).min(LANES);
        let ahead = first + AHEAD;
        prefetch(s, out.window, ahead, LANES);
        prefetch(s, out.varyings, ahead * stride, LANES * stride);
        store_records(s, window, &mut out.window[first..][..count]);
        if !out.clip.is_empty() {
            let clip = [
                clip[0].bitcast(),
                clip[1].bitcast(),
                clip[2].bitcast(),
                clip[3].bitcast(),
            ];
            store_records(s, clip, &mut out.clip[first..][..count]);
        }
        let varyings = &scratch.varyings[packet * stride..][..stride];
        let to = &mut out.varyings[first * stride..][..count * stride];
        store_components(s, varyings, to);
        if !out.point_size.is_empty() {
            let sizes = &scratch.point_size[packet].0[..count];
            out.point_size[first..][..count].copy_from_slice(sizes);
        }
    }
}
