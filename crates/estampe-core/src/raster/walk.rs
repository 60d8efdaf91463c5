//! The walk over a polygon's packets: 64×64 → 16×16 → 4×4 → pixels.
//!
//! How many packets of a block a triangle touches cannot be predicted, so a loop over the packets
//! of each block would wait, at its end, for a mispredicted branch. Here the packets of all blocks
//! are listed first, sixteen edge values with each block, and one loop goes over the list. Nothing
//! in it depends on the coverage that it finds: an item is written each time, and stays if it
//! covers anything. A packet that is covered whole is treated as any other.
//!
//! ```text
//!     blocks of the box ─▶ sixteen packets each: edges at their first pixels, which of them touch
//!                                        │
//!                          list of packets ─▶ edges at the pixels: value of the packet + steps
//! ```

use super::coverage::CoveredPackets;
use super::triangle::{Edge, TilePolygon};
use super::{CoverageList, Covered, MAX_PACKETS, SampleSet, TileShape, rect_mask};
use crate::bounds::pixel_rect::PixelRect;
use estampe_simd::{LANE_X, LANE_Y, LANES, Lanes, SimdBase, i32x16};

/// Packets of a box that are listed one by one, without a look at their blocks.
const FEW_PACKETS: i32 = 3;
/// Packets of a box whose blocks are not looked at as wholes.
const PACKETS_OF_BLOCK: i32 = 16;
/// The most edges of a polygon: those of a line.
const MAX_EDGES: usize = 4;

/// Values between the steps of a walk. They have no meaning after it.
#[derive(Debug)]
#[repr(C, align(64))]
pub(super) struct WalkScratch {
    /// By edge and packet: the edge's value at the packet's first pixel, without its constants; of
    /// one sample, with it.
    values: [[i32; MAX_PACKETS]; MAX_EDGES],
    /// By edge and block: such a value at the block's first pixel.
    blocks: [[i32; LANES]; MAX_EDGES],
    packets: PacketNumbers,
    /// Those of the second class.
    others: PacketNumbers,
}

/// A list of packets.
#[derive(Debug)]
struct PacketNumbers {
    /// Sixteen at a time are written, so there is room behind the last one.
    packets: [u32; MAX_PACKETS + LANES],
    len: usize,
}

impl Default for PacketNumbers {
    fn default() -> Self {
        Self {
            packets: [0; MAX_PACKETS + LANES],
            len: 0,
        }
    }
}

impl PacketNumbers {
    /// Adds some packets of a block.
    #[inline(always)]
    fn add<S: Lanes>(&mut self, s: S, block: usize, packets: u16) {
        // Of each of sixteen blocks sixteen packets, so that the last one's are listed at 240.
        let Some(out) = self.packets[self.len % MAX_PACKETS..].first_chunk_mut() else {
            unreachable!("there is room behind the last packet");
        };
        #[expect(clippy::cast_possible_truncation, reason = "a tile has 256 packets")]
        let first = (block * LANES) as u32;
        self.len += s.list_bits(packets, first, out);
    }

    #[inline(always)]
    fn items(&self) -> &[u32] {
        &self.packets[..self.len.min(MAX_PACKETS)]
    }
}

/// A look at the packets of a block before their pixels.
pub(crate) trait PacketClasses<S: Lanes> {
    /// Of packets that hold covered samples, perhaps: those of two classes, which are listed apart.
    /// Others are left out.
    fn of_block(&self, s: S, block: usize, packets: u16) -> [u16; 2];
}

/// One class.
struct AnyPacket;

impl<S: Lanes> PacketClasses<S> for AnyPacket {
    #[inline(always)]
    fn of_block(&self, _s: S, _block: usize, packets: u16) -> [u16; 2] {
        [packets, 0]
    }
}

impl Default for WalkScratch {
    fn default() -> Self {
        Self {
            values: [[0; MAX_PACKETS]; MAX_EDGES],
            blocks: [[0; LANES]; MAX_EDGES],
            packets: PacketNumbers::default(),
            others: PacketNumbers::default(),
        }
    }
}

impl WalkScratch {
    #[inline(always)]
    fn clear(&mut self) {
        self.packets.len = 0;
        self.others.len = 0;
    }

    /// Lists one packet.
    #[inline(always)]
    fn push<const N: usize, const E: usize>(
        &mut self,
        edges: &[Edge<N>; E],
        packet: u32,
        [x, y]: [i32; 2],
    ) {
        for (values, edge) in self.values.iter_mut().zip(edges) {
            values[packet as usize % MAX_PACKETS] = edge.folded() + edge.a * x + edge.b * y;
        }
        let PacketNumbers { packets, len } = &mut self.packets;
        packets[*len % MAX_PACKETS] = packet;
        *len += 1;
    }
}

impl<const N: usize, const E: usize> TilePolygon<N, E> {
    /// Lists the packets that the polygon covers, leaving out the blocks of `skip`. Of the
    /// blocks `whole`, those that are covered whole are returned, one bit each, and not listed.
    #[inline(always)]
    pub(crate) fn cover<S: Lanes>(
        &self,
        s: S,
        tile: TileShape,
        skip: u16,
        whole: u16,
        out: &mut CoverageList<N>,
    ) -> u16 {
        let steps = Steps::new(s, self);
        let packets = self.packets();
        let mut covered_whole = 0;
        out.walk.clear();
        if packets <= FEW_PACKETS {
            for row in self.rows[0]..self.rows[1] {
                for column in self.columns[0]..self.columns[1] {
                    let packet = crate::layout::morton(column.cast_unsigned(), row.cast_unsigned());
                    if skip >> (packet >> 4) & 1 == 0 {
                        out.walk.push(&self.edges, packet, [column * 4, row * 4]);
                    }
                }
            }
        } else {
            let mut live = self.blocks() & !skip;
            debug_assert!(tile.log2 == 6 || live <= 0xF, "a tile of four blocks");
            if packets > PACKETS_OF_BLOCK {
                let (some, all) = steps.classify_blocks(s, self);
                live &= some;
                covered_whole = live & all & whole;
                live &= !covered_whole;
            }
            steps.list_packets(s, self, live, &AnyPacket, &mut out.walk);
        }
        let CoverageList { walk, covered, .. } = out;
        steps.list_covered(s, self, (&walk.values, walk.packets.items()), covered);
        covered_whole
    }

    /// Lists the packets of the first class that the polygon covers. Those of the second are
    /// [covered](Steps::cover_second) after it.
    #[inline(always)]
    pub(crate) fn cover_first<S: Lanes, C: PacketClasses<S>>(
        &self,
        s: S,
        classes: &C,
        first: &mut CoverageList<N>,
    ) -> Steps<S, E> {
        let steps = Steps::new(s, self);
        let mut live = self.blocks();
        if self.packets() > PACKETS_OF_BLOCK {
            live &= steps.classify_blocks(s, self).0;
        }
        let CoverageList { walk, covered, .. } = first;
        walk.clear();
        steps.list_packets(s, self, live, classes, walk);
        steps.list_covered(s, self, (&walk.values, walk.packets.items()), covered);
        steps
    }

    /// The blocks that the box touches, one bit each.
    #[inline(always)]
    pub(crate) fn blocks(&self) -> u16 {
        let blocks = PixelRect {
            x0: self.columns[0] >> 2,
            y0: self.rows[0] >> 2,
            x1: (self.columns[1] + 3) >> 2,
            y1: (self.rows[1] + 3) >> 2,
        };
        rect_mask(&blocks, 0, 0)
    }
}

impl<const N: usize> Edge<N> {
    /// The constant that is part of a packet's values: of one sample.
    #[inline(always)]
    fn folded(&self) -> i32 {
        if const { N == 1 } { self.c[0] } else { 0 }
    }
}

/// The values that sixteen lanes add to an edge's value: `a·column + b·row` of each lane, one pixel
/// apart.
pub(crate) struct Steps<S: Lanes, const E: usize> {
    pixel: [i32x16<S>; E],
}

impl<S: Lanes, const E: usize> Steps<S, E> {
    #[inline(always)]
    fn new<const N: usize>(s: S, polygon: &TilePolygon<N, E>) -> Self {
        let mut x = [0; LANES];
        let mut y = [0; LANES];
        let mut lane = 0;
        while lane < LANES {
            (x[lane], y[lane]) = (i32::from(LANE_X[lane]), i32::from(LANE_Y[lane]));
            lane += 1;
        }
        let (x, y) = (i32x16::load_array(s, x), i32x16::load_array(s, y));
        let mut pixel = [splat(s, 0); E];
        for (pixel, Edge { a, b, .. }) in pixel.iter_mut().zip(&polygon.edges) {
            *pixel = x * splat(s, *a) + y * splat(s, *b);
        }
        Self { pixel }
    }

    /// Of the tile's blocks: which hold covered samples, perhaps, and which are covered whole.
    #[inline(always)]
    fn classify_blocks<const N: usize>(&self, s: S, polygon: &TilePolygon<N, E>) -> (u16, u16) {
        let (mut outside, mut partial) = (splat(s, 0), splat(s, 0));
        for (edge, pixel) in polygon.edges.iter().zip(&self.pixel) {
            let [best, worst] = edge.extremes(16);
            let block = *pixel << 4;
            outside |= block + splat(s, best);
            partial |= block + splat(s, worst);
        }
        (!s.sign_bits(outside), !s.sign_bits(partial))
    }

    /// Lists the packets of some blocks that hold covered samples, perhaps.
    #[inline(always)]
    fn list_packets<const N: usize>(
        &self,
        s: S,
        polygon: &TilePolygon<N, E>,
        mut blocks: u16,
        classes: &impl PacketClasses<S>,
        walk: &mut WalkScratch,
    ) {
        let mut packet = self.pixel;
        let mut best = [0; E];
        for (number, edge) in polygon.edges.iter().enumerate() {
            packet[number] = self.pixel[number] << 2;
            best[number] = edge.extremes(4)[0] - edge.folded();
            let at_blocks = (self.pixel[number] << 4) + splat(s, edge.folded());
            at_blocks.store_array(&mut walk.blocks[number]);
        }
        while blocks != 0 {
            let block = blocks.trailing_zeros() as usize % LANES;
            blocks &= blocks - 1;
            let mut outside = splat(s, 0);
            for number in 0..E {
                let value = packet[number] + splat(s, walk.blocks[number][block]);
                let values = walk.values[number].as_chunks_mut().0;
                value.store_array(&mut values[block]);
                outside |= value + splat(s, best[number]);
            }
            let some = !s.sign_bits(outside);
            let [first, second] = classes.of_block(s, block, some);
            walk.packets.add(s, block, first);
            walk.others.add(s, block, second);
        }
    }

    /// Lists those of the listed packets that are covered.
    #[inline(always)]
    fn list_covered<const N: usize>(
        &self,
        s: S,
        polygon: &TilePolygon<N, E>,
        listed: (&[[i32; MAX_PACKETS]; MAX_EDGES], &[u32]),
        out: &mut CoveredPackets<N>,
    ) {
        let CoveredPackets { samples, items, .. } = out;
        // In a register: a length in memory would be waited for, item by item.
        let mut len = out.len;
        self.cover_packets(
            s,
            polygon,
            listed,
            *samples,
            #[inline(always)]
            |item| {
                debug_assert!(len < MAX_PACKETS, "a packet comes once");
                items[len % MAX_PACKETS] = item;
                len += usize::from(item.any() != 0);
            },
        );
        out.len = len;
    }

    /// Gives the packets of the second class, of which some may not be covered at all.
    #[inline(always)]
    pub(crate) fn cover_second<const N: usize>(
        &self,
        s: S,
        polygon: &TilePolygon<N, E>,
        list: &CoverageList<N>,
        give: impl FnMut(Covered<N>),
    ) {
        let CoverageList { walk, covered } = list;
        let listed = (&walk.values, walk.others.items());
        self.cover_packets(s, polygon, listed, covered.samples, give);
    }

    /// Covers the listed packets, sample by sample.
    #[inline(always)]
    fn cover_packets<const N: usize>(
        &self,
        s: S,
        polygon: &TilePolygon<N, E>,
        (values, packets): (&[[i32; MAX_PACKETS]; MAX_EDGES], &[u32]),
        samples: SampleSet<N>,
        mut give: impl FnMut(Covered<N>),
    ) {
        let samples = samples.count();
        let mut pixel = [[splat(s, 0); N]; E];
        for (number, edge) in polygon.edges.iter().enumerate() {
            for (pixel, &c) in pixel[number].iter_mut().zip(&edge.c).take(samples) {
                *pixel = self.pixel[number] + splat(s, c - edge.folded());
            }
        }
        for packet in packets {
            let at = *packet as usize % MAX_PACKETS;
            let mut of_packet = [splat(s, 0); E];
            for (value, of_packets) in of_packet.iter_mut().zip(values) {
                *value = splat(s, of_packets[at]);
            }
            let mut masks = [0; N];
            for (sample, mask) in masks.iter_mut().enumerate().take(samples) {
                let mut outside = splat(s, 0);
                for (pixel, value) in pixel.iter().zip(&of_packet) {
                    outside |= pixel[sample] + *value;
                }
                *mask = !s.sign_bits(outside);
            }
            #[expect(clippy::cast_possible_truncation, reason = "a tile has 256 packets")]
            let packet = at as u16;
            give(Covered { packet, masks });
        }
    }
}

#[inline(always)]
fn splat<S: Lanes>(s: S, value: i32) -> i32x16<S> {
    SimdBase::splat(s, value)
}
