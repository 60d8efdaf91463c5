//! The covered pixels of small triangles as a list, sixteen of which are treated at a time.
//!
//! A triangle of two pixels ends before the processor knows how long it is: a loop over the pixels
//! of each triangle waits, at its end, for a mispredicted branch. The list is made without branches
//! on coverage, and has one end for a whole packet of triangles. With it, and with fragments that
//! fill packets because they come from a list, `instances` took 51 ms in place of 63.

use super::small::PIXELS;
use estampe_simd::{Bytes, LANES, Lanes, Packet, Select, SimdBase, i32x16, u32x16};

/// Pixels of a packet's triangles, at most.
const MOST: usize = LANES * PIXELS;
/// Pixels of half of a box.
const FOUR_ROWS: usize = PIXELS / 2;

/// Covered pixels of sixteen small triangles, in the order of the triangles' lanes.
#[derive(Debug)]
#[repr(C, align(64))]
pub(crate) struct PixelList {
    /// Which pixels they are: see [`Pixels`]. The pixels of four rows are written at a time, so
    /// there is room behind the last one.
    pixels: [u16; MOST + FOUR_ROWS],
    /// Where each is in the tile.
    places: [u32; MOST],
    /// Its depth, as it is stored.
    depths: [f32; MOST],
    len: usize,
}

/// Sixteen pixels of a list, as numbers: 64·lane + 8·row + column, where row and column are in the
/// box of the lane's triangle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pixels<S: Lanes>(pub(crate) u32x16<S>);

impl<S: Lanes> Pixels<S> {
    /// The lanes of the triangles, to permute by.
    #[inline(always)]
    pub(crate) fn lane(self) -> u32x16<S> {
        self.0 >> 6
    }

    /// Which bit of its triangle's box each pixel is.
    #[inline(always)]
    pub(super) fn bit(self, s: S) -> u32x16<S> {
        self.0 & <u32x16<S> as SimdBase<S>>::splat(s, 63)
    }

    #[inline(always)]
    pub(super) fn column(self, s: S) -> i32x16<S> {
        (self.0 & <u32x16<S> as SimdBase<S>>::splat(s, 7)).bitcast()
    }

    #[inline(always)]
    pub(super) fn row(self, s: S) -> i32x16<S> {
        ((self.0 >> 3) & <u32x16<S> as SimdBase<S>>::splat(s, 7)).bitcast()
    }
}

/// The lane of one pixel's triangle.
#[inline(always)]
pub(crate) fn lane_of(pixel: u32) -> usize {
    (pixel >> 6) as usize % LANES
}

impl Default for PixelList {
    fn default() -> Self {
        Self {
            pixels: [0; MOST + FOUR_ROWS],
            places: [0; MOST],
            depths: [0.0; MOST],
            len: 0,
        }
    }
}

impl PixelList {
    /// The number of pixels.
    #[inline(always)]
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Lists the pixels whose bits are set, of `HALVES` times four rows of the boxes in `lanes`.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "a list has 1024 pixels")]
    pub(super) fn fill<S: Lanes, const HALVES: usize>(
        &mut self,
        s: S,
        covered: &[Packet<u32>; 2],
        lanes: u16,
    ) {
        let mut len = 0;
        let [upper, lower] = covered;
        for (lane, (upper, lower)) in upper.0.iter().zip(&lower.0).enumerate() {
            let listed = 0u32.wrapping_sub(u32::from(lanes >> lane & 1));
            for (half, bits) in [upper, lower].into_iter().take(HALVES).enumerate() {
                let out = self.pixels.get_mut(len..);
                let Some(out) = out.and_then(<[u16]>::first_chunk_mut) else {
                    unreachable!("{len} pixels of sixteen small triangles");
                };
                let first = (lane * PIXELS + half * FOUR_ROWS) as u16;
                len += s.list_bits_of_word(bits & listed, first, out);
            }
        }
        self.len = len;
        // Those behind the last are of its triangle, so that the last sixteen, too, are mostly of
        // neighbouring lanes.
        let last = self.pixels[len.saturating_sub(1) % MOST];
        if let Some(behind) = self
            .pixels
            .get_mut(len..)
            .and_then(<[u16]>::first_chunk_mut)
        {
            *behind = [last; LANES];
        }
    }

    /// Sixteen pixels from one on; those behind the last repeat it, or are unspecified pixels.
    #[inline(always)]
    pub(crate) fn sixteen<S: Lanes>(&self, s: S, from: usize) -> Pixels<S> {
        let sixteen = self.pixels.get(from..).and_then(<[u16]>::first_chunk);
        Pixels(s.widen(sixteen.unwrap_or(&[0; LANES])))
    }

    /// The pixels of four quads, from that of a listed pixel on, which are their first ones.
    #[inline(always)]
    pub(crate) fn four_quads<S: Lanes>(&self, s: S, from: usize) -> Pixels<S> {
        const QUAD_OF: [u32; LANES] = [0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3];
        const PIXEL: [u32; LANES] = [0, 1, 8, 9, 0, 1, 8, 9, 0, 1, 8, 9, 0, 1, 8, 9];
        let first = self.sixteen(s, from).0;
        let of_quads = s.permute(first, u32x16::load_array(s, QUAD_OF));
        Pixels(of_quads + u32x16::load_array(s, PIXEL))
    }

    /// All sixteens of pixels, with what is to be noted of each: places and depths.
    #[inline(always)]
    pub(super) fn sixteens(&mut self) -> impl Iterator<Item = Sixteen<'_>> {
        let places = self.places.as_chunks_mut().0.iter_mut();
        let places = places.zip(self.depths.as_chunks_mut().0);
        let pixels = self.pixels.as_chunks().0.iter().zip(places);
        pixels.take(self.len.div_ceil(LANES))
    }

    /// The blocks of 2ⁿ samples that hold the pixels, one bit each.
    #[inline(always)]
    pub(crate) fn blocks<S: Lanes>(&self, s: S, log2: u32) -> u16 {
        let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
        let mut blocks = splat(0);
        let places = self
            .places
            .as_chunks()
            .0
            .iter()
            .zip((0..self.len).step_by(LANES));
        for (places, from) in places {
            let listed = u16::MAX >> (LANES - (self.len - from).min(LANES));
            let block = splat(1) << (u32x16::load_array_ref(s, places) >> log2);
            blocks |= s.mask_from_bits(listed).select(block, splat(0));
        }
        let blocks = blocks.to_array();
        #[expect(clippy::cast_possible_truncation, reason = "a tile has sixteen blocks")]
        let blocks = blocks.iter().fold(0, |all, block| all | block) as u16;
        blocks
    }

    /// Number, place and depth of each pixel.
    #[inline(always)]
    pub(crate) fn iter(&self) -> impl Iterator<Item = (u32, usize, f32)> {
        // By index, so that one counter serves the three lists.
        let all = 0..self.len.min(MOST);
        all.map(move |at| {
            (
                u32::from(self.pixels[at]),
                self.places[at] as usize,
                self.depths[at],
            )
        })
    }
}

/// See [`PixelList::sixteens`].
type Sixteen<'a> = (
    &'a [u16; LANES],
    (&'a mut [u32; LANES], &'a mut [f32; LANES]),
);

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_simd::{Level, dispatch};

    #[test]
    fn blocks_are_those_of_the_listed_pixels() {
        let mut list = Box::new(PixelList::default());
        for (at, place) in (0_u32..).zip(list.places.iter_mut()) {
            *place = at.wrapping_mul(2_654_435_761) >> 20;
        }
        for len in [0, 1, 2, 15, 16, 17, 40, MOST] {
            list.len = len;
            for log2 in [8, 10] {
                let places = list.places[..len].iter();
                let expected = places.fold(0, |all, place| all | 1u16 << (place >> log2));
                for level in Level::all_available() {
                    let found = dispatch!(level, s => list.blocks(s, log2));
                    assert_eq!(found, expected, "{len} pixels, {level:?}");
                }
            }
        }
    }
}
