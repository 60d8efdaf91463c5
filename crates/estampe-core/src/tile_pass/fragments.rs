//! Lists of fragments that fill packets, pixel by pixel.

use crate::fragment::fill::{LANE_NUMBERS, samples_of};
use crate::raster::Covered;
use crate::raster::small::PIXELS;
use estampe_simd::{LANES, Lanes, Packing, SimdBase, u32x16};

/// Listed pixels.
#[derive(Debug)]
#[repr(C, align(64))]
pub(super) struct Fragments {
    /// Which they are among their triangles' pixels, as in a
    /// [`PixelList`](crate::raster::pixel_list::PixelList).
    pixels: [u32; Self::ROOM],
    /// Where they are in the tile: packet·16 + lane.
    places: [u32; Self::ROOM],
    /// Their samples, one bit each.
    samples: [u32; Self::ROOM],
    len: usize,
}

impl Default for Fragments {
    fn default() -> Self {
        Self {
            pixels: [0; Self::ROOM],
            places: [0; Self::ROOM],
            samples: [0; Self::ROOM],
            len: 0,
        }
    }
}

impl Fragments {
    /// The index of the first one. So many lanes before it may be loaded with it.
    const FIRST: usize = LANES;

    /// The most fragments: all pixels of sixteen small triangles.
    pub(super) const MOST: usize = PIXELS * LANES;

    /// Sixteen more, because so many are written at a time.
    const ROOM: usize = Self::FIRST + Self::MOST + LANES;

    #[inline(always)]
    pub(super) fn clear(&mut self) {
        self.len = 0;
    }

    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// Adds those of sixteen fragments that are in a mask: pixels, places, samples.
    #[inline(always)]
    pub(super) fn add<S: Lanes>(&mut self, s: S, kept: u16, of: [u32x16<S>; 3]) {
        let packing = Packing::new(s, kept);
        let lists = [&mut self.pixels, &mut self.places, &mut self.samples];
        for (list, values) in lists.into_iter().zip(of) {
            if let Some(to) = chunk_from(list, Self::FIRST + self.len) {
                packing.store(s, values, to);
            }
        }
        self.len += packing.count();
        debug_assert!(self.len <= Self::MOST, "{} fragments", self.len);
    }

    /// Keeps those in the masks that `keeps` gives for the pixels, places and samples of each
    /// sixteen, with the samples that it gives.
    #[inline(always)]
    pub(super) fn retain<S: Lanes>(
        &mut self,
        s: S,
        mut keeps: impl FnMut([u32x16<S>; 3]) -> (u16, u32x16<S>),
    ) {
        let (end, mut from) = (self.len, 0);
        self.len = 0;
        // Sixteen are written no further than those end that were read.
        while from < end {
            let [pixels, places, samples] = self.sixteen(from, 0);
            let pixels = u32x16::load_array_ref(s, pixels);
            let places = u32x16::load_array_ref(s, places);
            let samples = u32x16::load_array_ref(s, samples);
            let listed = u16::MAX >> (LANES - (end - from).min(LANES));
            let (kept, samples) = keeps([pixels, places, samples]);
            self.add(s, kept & listed, [pixels, places, samples]);
            from += LANES;
        }
        if self.len != 0 {
            self.end();
        }
    }

    /// Adds the pixels of a packet of the tile of which some samples, which are in masks, show the
    /// triangle of a lane.
    #[inline(always)]
    pub(super) fn add_packet<S: Lanes, const N: usize>(
        &mut self,
        s: S,
        lane: u8,
        covered: &Covered<N>,
    ) {
        let samples = samples_of(s, &covered.masks);
        let places = u32x16::load_array(s, LANE_NUMBERS) + u32::from(covered.packet) * 16;
        let pixels = <u32x16<S> as SimdBase<S>>::splat(s, pixel_of(lane));
        self.add(s, covered.any(), [pixels, places, samples]);
    }

    /// Sixteen fragments: pixels, places, samples. The lane of fragment `from` is `lane`.
    #[inline(always)]
    pub(super) fn sixteen(&self, from: usize, lane: usize) -> [&[u32; LANES]; 3] {
        let first = Self::FIRST + from - lane % LANES;
        [
            sixteen_of(&self.pixels, first),
            sixteen_of(&self.places, first),
            sixteen_of(&self.samples, first),
        ]
    }

    /// Repeats the last fragment behind the end, and the first before the beginning: numbers of
    /// others could be slow.
    #[inline(always)]
    pub(super) fn end(&mut self) {
        let end = Self::FIRST + self.len;
        for list in [&mut self.pixels, &mut self.places, &mut self.samples] {
            let (first, last) = (list[Self::FIRST], list[(end - 1) % Self::ROOM]);
            if let Some(before) = list.first_chunk_mut() {
                *before = [first; Self::FIRST];
            }
            if let Some(behind) = chunk_from(list, end) {
                *behind = [last; LANES];
            }
        }
    }
}

/// The first pixel of a lane's triangle.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "64")]
fn pixel_of(lane: u8) -> u32 {
    u32::from(lane) * PIXELS as u32
}

#[inline(always)]
fn chunk_from(list: &mut [u32; Fragments::ROOM], from: usize) -> Option<&mut [u32; LANES]> {
    list.get_mut(from..).and_then(<[u32]>::first_chunk_mut)
}

#[inline(always)]
fn sixteen_of(list: &[u32; Fragments::ROOM], from: usize) -> &[u32; LANES] {
    let sixteen = list.get(from..).and_then(<[u32]>::first_chunk);
    sixteen.unwrap_or(&[0; LANES])
}
