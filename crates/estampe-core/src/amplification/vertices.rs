//! Shading the vertices of patches and primitives.
//!
//! *In* a part of a draw · *Out* records of vertices, x, y, z, w in clip space and then the
//! varyings, and the record of each corner. A vertex that several primitives of a unit share is
//! shaded once.

use super::elements::InputPart;
use crate::geometry::fetch::{PacketIndex, fetch, fetch_rare};
use crate::pipeline::{Decoding, RenderPipeline};
use estampe_simd::{LANES, Level, Packet, dispatch};
use estampe_types::{Bindings, BufferData, VertexBatch};
use std::ops::Range;

/// The source of vertices.
#[derive(Debug, Clone, Copy)]
pub(super) struct VertexStage<'a> {
    pub(super) pipeline: &'a RenderPipeline,
    pub(super) buffers: &'a [BufferData],
    pub(super) bindings: &'a Bindings,
    /// The draw's first instance.
    pub(super) base_instance: u32,
}

/// Primitives, and the records of their vertices.
#[derive(Debug, Default)]
pub(super) struct Primitives {
    /// The vertices' records.
    pub(super) records: Vec<u32>,
    /// Words of a record.
    pub(super) words: usize,
    /// The record of each vertex of each primitive.
    pub(super) corners: Vec<u32>,
    /// The number of each primitive in its instance.
    pub(super) numbers: Vec<u32>,
}

/// Memory for the vertices of a packet.
#[derive(Debug, Default)]
struct PacketMemory {
    attributes: Vec<Packet<f32>>,
    columns: Vec<Packet<f32>>,
    point_size: [Packet<f32>; 1],
    distances: Vec<Packet<f32>>,
}

/// The largest ratio of a range of indices to the number of corners; beyond it each different
/// vertex is found by sorting.
const SPARSE_FACTOR: u64 = 4;

impl VertexStage<'_> {
    /// Shades the vertices of some primitives of a part. Says how many there were.
    pub(super) fn shade(
        &self,
        level: Level,
        part: &InputPart,
        primitives: Range<usize>,
    ) -> (Primitives, u64) {
        let each = part.corners_each;
        let corners = &part.vertices[primitives.start * each..primitives.end * each];
        let instances = &part.instances[primitives.clone()];
        let (vertices, corners) = different_vertices(corners, instances, each);
        let interface = self.pipeline.interface();
        let words = 4 + interface.varyings.len();
        let mut out = Primitives {
            records: vec![0; vertices.len() * words],
            words,
            corners,
            numbers: part.numbers[primitives].to_vec(),
        };
        let mut memory = PacketMemory::default();
        let packets = vertices.chunks(LANES);
        for (vertices, records) in packets.zip(out.records.chunks_mut(LANES * words)) {
            self.shade_packet(level, vertices, &mut memory);
            for (lane, record) in records.chunks_exact_mut(words).enumerate() {
                for (word, column) in record.iter_mut().zip(&memory.columns) {
                    *word = column.0[lane].to_bits();
                }
            }
        }
        (out, vertices.len() as u64)
    }

    /// Shades up to sixteen vertices, each with its instance.
    fn shade_packet(&self, level: Level, vertices: &[[u32; 2]], memory: &mut PacketMemory) {
        let interface = self.pipeline.interface();
        let wanted = &interface.attributes;
        let sources = self.pipeline.attributes();
        let mut index = PacketIndex::default();
        let last = vertices.last().copied().unwrap_or_default();
        for lane in 0..LANES {
            let [instance, vertex] = vertices.get(lane).copied().unwrap_or(last);
            index.vertex.0[lane] = vertex;
            index.instance.0[lane] = instance;
        }
        let resize = |packets: &mut Vec<Packet<f32>>, len| packets.resize(len, Packet::default());
        resize(&mut memory.attributes, interface.attribute_scalars());
        resize(&mut memory.columns, 4 + interface.varyings.len());
        resize(&mut memory.distances, interface.distances());
        let attributes = &mut memory.attributes[..];
        dispatch!(level, s => fetch(s, sources, wanted, self.buffers, &index, attributes));
        if sources
            .iter()
            .any(|source| source.decoding == Decoding::Rare)
        {
            let at = (&index, self.base_instance);
            fetch_rare(
                level,
                sources,
                wanted,
                self.buffers,
                at,
                &mut memory.attributes,
            );
        }
        let (positions, varyings) = memory.columns.split_at_mut(4);
        let sizes = usize::from(interface.writes_point_size);
        self.pipeline.program().run_vertices(
            level,
            self.bindings,
            VertexBatch {
                attributes: &memory.attributes,
                vertex_index: &[index.vertex],
                instance_index: &[index.instance],
                positions,
                varyings,
                point_sizes: &mut memory.point_size[..sizes],
                distances: &mut memory.distances,
            },
        );
    }
}

/// The different vertices of some corners as [instance, vertex], and the number of each corner's.
fn different_vertices(
    corners: &[u32],
    instances: &[u32],
    each: usize,
) -> (Vec<[u32; 2]>, Vec<u32>) {
    let (Some(&least), Some(&greatest)) = (corners.iter().min(), corners.iter().max()) else {
        return (Vec::new(), Vec::new());
    };
    let first = instances.first().copied().unwrap_or_default();
    let span = u64::from(greatest - least) + 1;
    if span <= corners.len() as u64 * SPARSE_FACTOR
        && instances.iter().all(|instance| *instance == first)
    {
        let vertices = (least..=greatest).map(|vertex| [first, vertex]).collect();
        return (
            vertices,
            corners.iter().map(|vertex| vertex - least).collect(),
        );
    }
    let of_corner = |(at, vertex): (usize, &u32)| [instances[at / each], *vertex];
    let keys: Vec<[u32; 2]> = corners.iter().enumerate().map(of_corner).collect();
    let mut vertices = keys.clone();
    vertices.sort_unstable();
    vertices.dedup();
    let number = |key: &[u32; 2]| {
        let found = vertices.binary_search(key).unwrap_or_default();
        // Of the corners of one unit.
        u32::try_from(found).unwrap_or(u32::MAX)
    };
    let corners = keys.iter().map(number).collect();
    (vertices, corners)
}
