//! The visibility buffer of one tile: which triangle each sample shows, by its id.

use super::ONLY_WIDE;
use super::shortcuts::SinglePrimitiveBlocks;
use super::touched::TouchedPackets;
use crate::bounds::bins::BinEntry;
use crate::bounds::chunk::Chunk;
use crate::plan::tile_plan::TilePlan;
use crate::raster::MAX_PACKETS;
use crate::segments::Segments;
use estampe_simd::{LANES, Lanes, Level, SimdBase, SimdMask, dispatch, u8x16};
use std::ops::Range;

/// The bit of ids that name a shaded fragment rather than a triangle.
pub(super) const SHADED: u32 = 1 << 31;

/// A triangle of a run. Its visibility id is its place in the run.
#[derive(Debug, Clone, Copy)]
pub(super) struct TriangleRef {
    /// Number of the chunk in the pass.
    pub(super) chunk: u32,
    /// Number of the packet in the chunk.
    pub(super) packet: u32,
    /// Number of the sub-draw in the pass.
    pub(super) sub_draw: u32,
    pub(super) lane: u8,
}

impl TriangleRef {
    /// Returns true if the triangles of two ids are of one sub-draw and packet.
    #[inline(always)]
    pub(super) fn shares_packet_with(&self, other: &Self) -> bool {
        let of = |triangle: &Self| (triangle.chunk, triangle.packet, triangle.sub_draw);
        of(self) == of(other)
    }
}

/// Triangles of a run whose fragments may share calls of the program.
#[derive(Debug, Clone)]
pub(super) struct ShadingGroup {
    /// Their visibility ids.
    pub(super) ids: Range<u32>,
    /// The sub-draw of the first of them, which stands for the state of all.
    pub(super) sub_draw: u32,
}

/// Samples of a tile of 64×64 pixels where a pixel has one.
pub(super) const TILE_SAMPLES: usize = MAX_PACKETS * LANES;

/// Samples of such a tile where a pixel has four.
pub(super) const TILE_SAMPLES_OF_FOUR: usize = 4 * TILE_SAMPLES;

/// Samples that hold an id of a small primitive: a byte each, 1 of those that do.
#[derive(Debug)]
pub(super) struct ShownSamples {
    samples: Box<[u8]>,
    /// False if none is noted.
    has_any: bool,
}

impl ShownSamples {
    fn new(samples: usize) -> Self {
        Self {
            samples: vec![0; samples].into(),
            has_any: false,
        }
    }

    /// The bytes of a tile of so many samples, to note samples in.
    #[inline(always)]
    pub(super) fn begin<const SAMPLES: usize>(&mut self) -> &mut [u8; SAMPLES] {
        self.has_any = true;
        let samples = self.samples.first_chunk_mut();
        samples.expect("there is a byte for each sample of a tile")
    }
}

/// A run of triangles in one tile.
#[derive(Debug)]
pub(super) struct VisibilityBuffer<const N: usize> {
    pub(super) triangles: Vec<TriangleRef>,
    pub(super) groups: Vec<ShadingGroup>,
    /// True if some draw may have one colour.
    pub(super) has_one_color_draws: bool,
    /// By packet and sample: the lanes that hold an id in place of a colour, but for those that are
    /// noted in `shown` since [`VisibilityBuffer::take_shown`].
    pub(super) unresolved: Box<[[u16; N]; MAX_PACKETS]>,
    pub(super) shown: ShownSamples,
    /// Blocks that show one triangle at every sample, whose ids are not written.
    pub(super) single: SinglePrimitiveBlocks,
    pub(super) touched: TouchedPackets,
    /// The ids of targets whose first texel is not one word: by packet and sample.
    pub(super) ids: Box<[[u32; LANES]]>,
}

impl<const N: usize> Default for VisibilityBuffer<N> {
    fn default() -> Self {
        Self {
            triangles: Vec::new(),
            groups: Vec::new(),
            has_one_color_draws: false,
            unresolved: Box::new([[0; N]; MAX_PACKETS]),
            shown: ShownSamples::new(most_lines(N) * LANES),
            single: SinglePrimitiveBlocks::default(),
            touched: TouchedPackets::default(),
            ids: vec![[0; LANES]; most_lines(N)].into(),
        }
    }
}

/// Lines of sixteen samples that a tile has at most: of one sample or four it is 64×64 pixels
/// large, of others 32×32.
pub(super) const fn most_lines(samples: usize) -> usize {
    match samples {
        1 | 4 => MAX_PACKETS * samples,
        _ => MAX_PACKETS / 4 * samples,
    }
}

impl<const N: usize> VisibilityBuffer<N> {
    /// Numbers the triangles of a run of a chunk, in the order of submission; gives the first id.
    #[expect(clippy::cast_possible_truncation, reason = "a lane is below 16")]
    pub(super) fn add(
        &mut self,
        (chunk, number): (&Chunk, u32),
        entries: &[BinEntry],
        plans: &Segments<TilePlan<'_>>,
    ) -> u32 {
        let first = self.next_id();
        let Some(BinEntry::Triangles { packet, lanes }) = entries.first() else {
            return first;
        };
        let mut sub_draws = chunk.sub_draws_from(*packet, lanes.trailing_zeros());
        let mut last = sub_draws.of(*packet, lanes.trailing_zeros());
        let mut begun = first;
        for entry in entries {
            let BinEntry::Triangles { packet, mut lanes } = *entry else {
                unreachable!("lines and points are drawn in order");
            };
            while lanes != 0 {
                let lane = lanes.trailing_zeros() as u8;
                lanes &= lanes - 1;
                let sub_draw = sub_draws.of(packet, u32::from(lane));
                if sub_draw != last {
                    self.end_sub_draw(last, begun, plans);
                    (last, begun) = (sub_draw, self.next_id());
                }
                self.triangles.push(TriangleRef {
                    chunk: number,
                    packet,
                    sub_draw,
                    lane,
                });
            }
        }
        self.end_sub_draw(last, begun, plans);
        first
    }

    /// Numbers one triangle of the sub-draw that was ended last; gives its id.
    pub(super) fn add_one(&mut self, triangle: TriangleRef) -> u32 {
        let id = self.next_id();
        self.triangles.push(triangle);
        if let Some(group) = self.groups.last_mut() {
            group.ids.end = id + 1;
        }
        id
    }

    /// Adds the triangles from an id on, which are a sub-draw's, to the groups.
    pub(super) fn end_sub_draw(
        &mut self,
        sub_draw: u32,
        first: u32,
        plans: &Segments<TilePlan<'_>>,
    ) {
        let end = self.next_id();
        match self.groups.last_mut() {
            Some(group)
                if group.sub_draw == sub_draw
                    || plans[group.sub_draw as usize].shades_like(&plans[sub_draw as usize]) =>
            {
                group.ids.end = end;
            }
            _ => self.groups.push(ShadingGroup {
                ids: first..end,
                sub_draw,
            }),
        }
    }

    /// The id of the next triangle.
    pub(super) fn next_id(&self) -> u32 {
        // A run has at most as many triangles as a draw batch and clipping's pieces: far below 2³¹.
        let next = u32::try_from(self.triangles.len()).unwrap_or(SHADED);
        debug_assert!(next < SHADED, "ids have 31 bits");
        next
    }

    /// Makes `unresolved` complete.
    pub(super) fn take_shown(&mut self, level: Level) {
        if std::mem::take(&mut self.shown.has_any) {
            dispatch!(@wide level, s => self.take_shown_lanes(s),
                scalar => unreachable!("{ONLY_WIDE}"));
        }
    }

    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "a mask of sixteen lanes")]
    fn take_shown_lanes<S: Lanes>(&mut self, s: S) {
        let none = <u8x16<S> as SimdBase<S>>::splat(s, 0);
        let lines = self.shown.samples.as_chunks_mut::<LANES>().0;
        for (line, unresolved) in lines.iter_mut().zip(self.unresolved.as_flattened_mut()) {
            let shown = u8x16::load_array_ref(s, line).simd_gt(none);
            *unresolved |= shown.to_bitmask() as u16;
            none.store_array(line);
        }
    }

    /// True if a packet shows a triangle at every sample.
    pub(super) fn shows_everywhere(&self, packet: usize) -> bool {
        self.unresolved[packet] == [u16::MAX; N] || self.single.of_packet(packet).is_some()
    }

    /// Ends the run.
    pub(super) fn clear(&mut self) {
        self.triangles.clear();
        self.groups.clear();
        self.has_one_color_draws = false;
        self.unresolved.fill([0; N]);
        self.single = SinglePrimitiveBlocks::default();
        self.touched.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::TileGrid;

    #[test]
    fn there_is_room_for_the_samples_of_a_tile() {
        let lines = |samples: u32| {
            let pixels = TileGrid::new(64, 64, samples).tile_pixels();
            pixels * samples as usize / LANES
        };
        assert_eq!([lines(1), lines(4)], [most_lines(1), most_lines(4)]);
        assert_eq!(TILE_SAMPLES, lines(1) * LANES);
        assert_eq!(TILE_SAMPLES_OF_FOUR, lines(4) * LANES);
        for samples in [2, 8, 16] {
            assert!(lines(samples) <= most_lines(16), "{samples} samples");
        }
    }

    #[test]
    fn shown_samples_are_taken_once() {
        for level in Level::all_available() {
            if level.is_scalar() {
                continue;
            }
            let mut buffer = VisibilityBuffer::<4>::default();
            buffer.unresolved[7][1] = 1;
            let end = TILE_SAMPLES_OF_FOUR;
            let places = [0, 15, 16, (7 * 4 + 1) * LANES + 2, end - 1];
            for place in places {
                buffer.shown.begin::<TILE_SAMPLES_OF_FOUR>()[place] = 1;
            }
            buffer.take_shown(level);
            let mut expected = [[0; 4]; MAX_PACKETS];
            expected[7][1] = 1;
            for place in places {
                expected.as_flattened_mut()[place / LANES] |= 1 << (place % LANES);
            }
            assert_eq!(*buffer.unresolved, expected, "{level:?}");
            // None is left.
            buffer.unresolved.fill([0; 4]);
            buffer.shown.begin::<TILE_SAMPLES_OF_FOUR>();
            buffer.take_shown(level);
            assert_eq!(*buffer.unresolved, [[0; 4]; MAX_PACKETS], "{level:?}");
        }
    }
}
