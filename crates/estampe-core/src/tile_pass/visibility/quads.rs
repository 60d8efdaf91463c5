//! Quads of packets that show several triangles, sorted by triangle.
//!
//! They are listed packet by packet, those of one sample a pixel without a branch: which triangles
//! share a quad cannot be predicted, and to ask for one after the other is a chain of loads. Then
//! they are counted and moved, so that those of triangles of one packet lie side by side, four in
//! the lanes of a packet of fragments.
//!
//! ```text
//!     ids of a packet     7 7 8 8 │ 7 7 7 9 │ …     each quad's pixels
//!     leaders             ▲   ▲   │ ▲     ▲ │       the first pixel of each triangle in its quad
//!     quads               7: 0011, 8: 1100, 7: 0111, 9: 1000, …
//! ```

use super::buffer::TriangleRef;
use super::resolve::NONE;
use crate::fragment::fill::lanes_between;
use crate::fragment::quad::{QUAD, QUADS};
use crate::raster::Covered;
use estampe_simd::{LANES, Lanes, Packing, Select, SimdBase, u32x16};
use std::ops::Range;

/// Bits of a quad's word: the pixels whose first sample shows its triangle; its place in the tile,
/// packet·4 + quad; and, once it is sorted, its triangle's lane.
const PLACE_SHIFT: u32 = 4;
const LANE_SHIFT: u32 = 14;
/// Quads of a packet, in places.
const QUADS_EACH: u32 = 4;

/// The lanes of a packet's pixels across, below and opposite in their quads.
const ACROSS: [u32; LANES] = [1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14];
const BELOW: [u32; LANES] = [2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13];
const OPPOSITE: [u32; LANES] = [3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12];
/// Each pixel in its quad, as a bit.
const PIXEL_BITS: [u32; LANES] = [1, 2, 4, 8, 1, 2, 4, 8, 1, 2, 4, 8, 1, 2, 4, 8];
/// Each pixel's quad in its packet.
const QUAD_OF: [u32; LANES] = [0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3];
/// Each pixel's number in its quad.
const PIXEL_OF: [u32; LANES] = [0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3];

/// Quads by triangle.
#[derive(Debug)]
pub(super) struct Quads<const N: usize> {
    /// As they were added: the triangles' ids, the quads' words, and, if a pixel has several
    /// samples, those that show the triangle, four bits each. Sixteen are written at a time.
    ids: Vec<u32>,
    words: Vec<u32>,
    masks: Vec<[u16; N]>,
    len: usize,
    /// The words and masks sorted by id, with room for sixteen more words to be read.
    sorted_words: Vec<u32>,
    sorted_masks: Vec<[u16; N]>,
    /// By id, from the group's first one on: the end of the triangle's quads among the sorted ones.
    ends: Vec<u32>,
    /// The group's first id.
    first_id: u32,
}

impl<const N: usize> Default for Quads<N> {
    fn default() -> Self {
        Self {
            ids: Vec::new(),
            words: Vec::new(),
            masks: Vec::new(),
            len: 0,
            sorted_words: Vec::new(),
            sorted_masks: Vec::new(),
            ends: Vec::new(),
            first_id: 0,
        }
    }
}

/// Four quads that are the lanes of a packet of fragments, or some of them.
pub(super) struct FourQuads<S: Lanes, const N: usize> {
    /// The lanes of their triangles.
    pub(super) lane: u32x16<S>,
    /// Where their pixels are in the tile: packet·16 + lane.
    pub(super) places: u32x16<S>,
    /// By sample: the pixels that show their triangle.
    pub(super) masks: [u16; N],
}

impl<const N: usize> Quads<N> {
    /// Forgets the quads of the group before.
    pub(super) fn begin_group(&mut self) {
        self.len = 0;
    }

    /// Returns true if no triangle of the group has quads.
    pub(super) fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Makes room for so many more.
    #[inline(always)]
    fn reserve(&mut self, count: usize) {
        let needed = self.len + count;
        if self.words.len() < needed {
            self.ids.resize(2 * needed, 0);
            self.words.resize(2 * needed, 0);
            if const { N > 1 } {
                self.masks.resize(2 * needed, [0; N]);
            }
        }
    }

    /// Adds the quads of a packet whose pixels have one sample, of all triangles with these ids
    /// that are shown in some lanes.
    #[inline(always)]
    pub(super) fn add_all<S: Lanes>(
        &mut self,
        s: S,
        packet: u32,
        (ids, shown): (&[u32; LANES], u16),
    ) {
        self.reserve(LANES);
        let load = |lanes: [u32; LANES]| u32x16::load_array(s, lanes);
        let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
        let ids = u32x16::load_array_ref(s, ids);
        let ids = s.mask_from_bits(shown).select(ids, splat(NONE));
        let across = s.permute(ids, load(ACROSS)).simd_eq(ids);
        let below = s.permute(ids, load(BELOW)).simd_eq(ids);
        let opposite = s.permute(ids, load(OPPOSITE)).simd_eq(ids);
        // The first pixel of a triangle in its quad has none before it that shows the same one.
        let other_row = s.bits_of_mask(below | opposite) & 0xCCCC;
        let leaders = shown & !(s.bits_of_mask(across) & 0xAAAA) & !other_row;
        let bits = load(PIXEL_BITS);
        let zero = splat(0);
        let mask = bits
            | across.select(s.permute(bits, load(ACROSS)), zero)
            | below.select(s.permute(bits, load(BELOW)), zero)
            | opposite.select(s.permute(bits, load(OPPOSITE)), zero);
        let place = load(QUAD_OF) + packet * QUADS_EACH;
        let words = mask | (place << PLACE_SHIFT);
        let packing = Packing::new(s, leaders);
        for (list, values) in [(&mut self.ids, ids), (&mut self.words, words)] {
            let to = list.get_mut(self.len..).and_then(<[_]>::first_chunk_mut);
            let Some(to) = to else {
                unreachable!("there is room for sixteen more");
            };
            packing.store(s, values, to);
        }
        self.len += packing.count();
    }

    /// Adds a triangle's quads of one packet; bit 4·i of `quads` is quad i.
    #[inline(always)]
    pub(super) fn add(&mut self, id: u32, covered: Covered<N>, quads: u16) {
        self.reserve(QUADS);
        for (quad, place) in (0..QUADS).zip(u32::from(covered.packet) * QUADS_EACH..) {
            let shift = quad * QUAD;
            let mut masks = covered.masks;
            for mask in &mut masks {
                *mask = *mask >> shift & 0xF;
            }
            // The next one takes its place, unless the triangle has it: there is no branch.
            self.ids[self.len] = id;
            self.words[self.len] = place << PLACE_SHIFT | u32::from(masks[0]);
            if const { N > 1 } {
                self.masks[self.len] = masks;
            }
            self.len += usize::from(quads >> shift & 1);
        }
    }

    /// Sorts the group's quads by id; `triangles` are those of all ids.
    pub(super) fn sort(&mut self, group: Range<u32>, triangles: &[TriangleRef]) {
        self.first_id = group.start;
        self.ends.clear();
        self.ends.resize(group.len(), 0);
        let of_group = triangles.get(group.start as usize..).unwrap_or_default();
        let listed = self.len.min(self.ids.len());
        for id in &self.ids[..listed] {
            if let Some(count) = self.ends.get_mut((*id - group.start) as usize) {
                *count += 1;
            }
        }
        // Where each begins; it moves on to the end.
        let mut before = 0;
        for end in &mut self.ends {
            let count = std::mem::replace(end, before);
            before += count;
        }
        if self.sorted_words.len() < listed + LANES {
            self.sorted_words.resize(2 * (listed + LANES), 0);
            if const { N > 1 } {
                self.sorted_masks.resize(2 * (listed + LANES), [0; N]);
            }
        }
        for (at, (id, word)) in self.ids[..listed].iter().zip(&self.words).enumerate() {
            let of_id = (*id - group.start) as usize;
            let (Some(next), Some(triangle)) = (self.ends.get_mut(of_id), of_group.get(of_id))
            else {
                continue;
            };
            let to = *next as usize;
            *next += 1;
            if let Some(sorted) = self.sorted_words.get_mut(to) {
                *sorted = word | u32::from(triangle.lane) << LANE_SHIFT;
            }
            if const { N > 1 } {
                self.sorted_masks[to] = self.masks[at];
            }
        }
        debug_assert_eq!(before as usize, self.len, "quads of another group");
    }

    /// The end of the sorted quads of all triangles before one.
    #[inline(always)]
    pub(super) fn end_before(&self, id: u32) -> usize {
        let before = (id - self.first_id).checked_sub(1);
        before.map_or(0, |before| self.ends[before as usize] as usize)
    }

    /// Sorted quads, from one on, in a packet from quad `used` on up to `end`. Those of other lanes
    /// repeat them.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "at most four")]
    pub(super) fn four<S: Lanes>(
        &self,
        s: S,
        from: usize,
        [used, end]: [usize; 2],
    ) -> FourQuads<S, N> {
        let load = |lanes: [u32; LANES]| u32x16::load_array(s, lanes);
        let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
        let words = self.sorted_words.get(from..).and_then(<[_]>::first_chunk);
        let words = u32x16::load_array_ref(s, words.unwrap_or(&[0; LANES]));
        let (first, last) = (splat(used as u32), splat((end - 1) as u32));
        let quad = load(QUAD_OF).max(first).min(last) - first;
        let words = s.permute(words, quad);
        let mut masks = [0; N];
        if const { N > 1 } {
            for (quad, of_quad) in (used..end).zip(&self.sorted_masks[from..]) {
                for (mask, of_quad) in masks.iter_mut().zip(of_quad) {
                    *mask |= of_quad << (quad * QUAD);
                }
            }
        } else {
            let hides = s.bits_of_mask((words & load(PIXEL_BITS)).simd_eq(splat(0)));
            masks[0] = !hides & lanes_between(used * QUAD, end * QUAD);
        }
        let place = (words >> PLACE_SHIFT) & splat((1 << (LANE_SHIFT - PLACE_SHIFT)) - 1);
        FourQuads {
            lane: words >> LANE_SHIFT,
            places: (place << QUAD.ilog2()) | load(PIXEL_OF),
            masks,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_simd::{Level, dispatch};

    /// The quads of triangles by id, as they come sorted: id, place, mask of each sample.
    type Found<const N: usize> = Vec<(u32, u32, [u16; N])>;

    fn triangles(count: u32) -> Vec<TriangleRef> {
        let lanes = (0..16).cycle().take(count as usize);
        let triangle = |lane| TriangleRef {
            chunk: 0,
            packet: 0,
            sub_draw: 0,
            lane,
        };
        lanes.map(triangle).collect()
    }

    /// Reads sorted quads back, some of a packet at a time.
    fn sorted<const N: usize>(level: Level, quads: &Quads<N>, group: &Range<u32>) -> Found<N> {
        let mut found = Vec::new();
        for id in group.clone() {
            let (mut next, end) = (quads.end_before(id), quads.end_before(id + 1));
            let mut used = id as usize % QUADS;
            while next < end {
                let until = QUADS.min(used + end - next);
                let (lane, places, masks) = dispatch!(level, s => {
                    let four = quads.four(s, next, [used, until]);
                    (four.lane.to_array(), four.places.to_array(), four.masks)
                });
                for quad in used..until {
                    let first = quad * QUAD;
                    assert_eq!(lane[first] % 16, id % 16, "{level:?}");
                    for pixel in 0..4 {
                        assert_eq!(places[first + pixel] as usize % 4, pixel, "{level:?}");
                    }
                    let masks = masks.map(|mask| mask >> first & 0xF);
                    found.push((id, places[first] / 4, masks));
                }
                next += until - used;
                used = 0;
            }
        }
        found
    }

    #[test]
    fn quads_of_each_triangle_are_found_and_sorted() {
        let group = 3..23;
        for level in Level::all_available() {
            if level.is_scalar() {
                continue;
            }
            let (mut quads, mut state) = (Quads::<1>::default(), 5_u32);
            let mut random = || {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                state >> 16
            };
            for few in [1, 3, 20] {
                quads.begin_group();
                let mut expected = Found::new();
                for packet in (0..256).step_by(3) {
                    let ids = [0; LANES].map(|_| group.start + random() % few);
                    let shown = ((random() | random()) & 0xFFFF) as u16;
                    for (quad, place) in (0..QUADS).zip(0..) {
                        for id in group.clone() {
                            let shows = |pixel: &usize| {
                                let lane = quad * QUAD + pixel;
                                ids[lane] == id && shown >> lane & 1 == 1
                            };
                            let pixels = (0..QUAD).filter(shows);
                            let mask = pixels.fold(0, |mask, pixel| mask | 1 << pixel);
                            if mask != 0 {
                                expected.push((id, packet * 4 + place, [mask]));
                            }
                        }
                    }
                    dispatch!(level, s => quads.add_all(s, packet, (&ids, shown)));
                }
                expected.sort();
                quads.sort(group.clone(), &triangles(30));
                let mut found = sorted(level, &quads, &group);
                found.sort();
                assert_eq!(found, expected, "{level:?}, {few} triangles");
            }
        }
    }

    #[test]
    fn quads_keep_the_masks_of_their_samples() {
        let covered = |packet, masks| Covered { packet, masks };
        let mut quads = Quads::<4>::default();
        quads.add(7, covered(5, [0x00F0, 0x0010, 0, 0x1000]), 0x1010);
        quads.add(6, covered(255, [0x0001, 0, 0x0002, 0]), 0x0001);
        quads.add(7, covered(0, [0x0300; 4]), 0x0100);
        quads.sort(6..8, &triangles(8));
        let expected = [
            (6, 255 * 4, [1, 0, 2, 0]),
            (7, 2, [3; 4]),
            (7, 5 * 4 + 1, [0xF, 1, 0, 0]),
            (7, 5 * 4 + 3, [0, 0, 0, 1]),
        ];
        for level in Level::all_available() {
            if !level.is_scalar() {
                let mut found = sorted(level, &quads, &(6..8));
                found.sort();
                assert_eq!(found, expected, "{level:?}");
            }
        }
    }
}
