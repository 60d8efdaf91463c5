//! Clip-space positions, clip and cull distances of the few vertices that are clipped, computed
//! again when they are asked for.
//!
//! *In* a sub-draw's vertex numbers · *Out* their positions and distances · *Space* clip.
//!
//! Filled triangles need clip-space positions only where they leave the view volume. To keep them
//! for all vertices took a tenth of the geometry side of a scene that clips nothing: 16 bytes
//! written for each vertex. A program gives the same bits each time, and packets begin where they
//! did the first time. Neighbouring triangles share vertices, so that the last packets are kept.

use super::shading::{PACKET, ShadingScratch, VertexSource, shade_positions};
use estampe_simd::{Lane, Level, Packet};
use estampe_types::Interface;

/// The number of packets kept: two rows of a mesh of a thousand columns.
const KEPT: usize = 128;

/// Memory of one worker.
#[derive(Debug, Default)]
pub(crate) struct PositionCache {
    /// The packet kept at each place; empty until the first one is requested.
    packets: Vec<Option<u32>>,
    positions: Vec<[Packet<f32>; 4]>,
    /// The clip distances, then the cull distances, of each place; empty where the program has
    /// none.
    distances: Vec<Packet<f32>>,
    shading: ShadingScratch,
}

impl PositionCache {
    /// Forgets what belongs to another sub-draw.
    pub(crate) fn clear(&mut self) {
        self.packets.clear();
    }

    /// The clip distances of the vertex whose position was asked for last, then its cull distances.
    pub(crate) fn distances_of(
        &self,
        interface: &Interface,
        vertex: u32,
    ) -> impl Iterator<Item = f32> {
        let (packet, lane) = place_of(vertex);
        let count = interface.distances();
        let place = packet as usize % KEPT;
        // Nothing is stored yet where the position was not asked for because it is kept.
        let all = self.distances.get(place * count..).unwrap_or_default();
        all.iter().take(count).map(move |distance| distance[lane])
    }

    /// The position of one of the sub-draw's vertices.
    pub(crate) fn position_of(
        &mut self,
        level: Level,
        source: &VertexSource<'_>,
        vertex: u32,
    ) -> [f32; 4] {
        let (packet, lane) = place_of(vertex);
        let place = packet as usize % KEPT;
        if self.packets.is_empty() {
            self.packets.resize(KEPT, None);
            self.positions.resize_with(KEPT, Default::default);
            let distances = source.pipeline.interface().distances();
            self.distances.resize(KEPT * distances, Packet::default());
        }
        if self.packets[place] != Some(packet) {
            let first = packet * PACKET;
            self.positions[place] = shade_positions(level, source, first, &mut self.shading);
            let distances = source.pipeline.interface().distances();
            let distances = self.shading.distances_of_first(distances);
            let to = &mut self.distances[place * distances.len()..];
            to[..distances.len()].copy_from_slice(distances);
            self.packets[place] = Some(packet);
        }
        self.positions[place].each_ref().map(|scalar| scalar[lane])
    }
}

/// The packet of a vertex, and its lane there.
fn place_of(vertex: u32) -> (u32, Lane) {
    (vertex / PACKET, Lane::new((vertex % PACKET) as usize))
}
