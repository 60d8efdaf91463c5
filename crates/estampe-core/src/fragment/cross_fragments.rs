//! Fragments of sixteen triangles, in rows of sixteen fragments.
//!
//! If fragments need no neighbours, a packet need not be 4×4 pixels of one triangle: in a *row*,
//! each lane is a pixel of any of a packet's triangles, and no lane is empty but in the last row.

use crate::bounds::lane_order::AnyOrder;
use crate::raster::pixel_list::Pixels;
use crate::raster::small::PIXELS;
use estampe_simd::{Bytes, LANES, Lanes, Select, SimdBase, u32x16};

/// Fragments of one packet's small triangles in rows of sixteen, the first of which may hold
/// fragments of other packets already.
#[derive(Debug)]
#[repr(C, align(64))]
pub(crate) struct CrossFragments {
    /// The fragments' pixels, with room for a row that is open, and for one that is written too
    /// much.
    pixels: [u32; Self::ROOM],
    /// The first fragment's place.
    begin: usize,
    end: usize,
    /// The triangles that have fragments.
    pub(crate) lanes: u16,
}

/// Lanes of a row that are fragments of the packet at hand.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row<S: Lanes> {
    pub(crate) pixels: Pixels<S>,
    pub(crate) lanes: u16,
    /// True if other lanes hold fragments already.
    pub(crate) is_open: bool,
}

impl<S: Lanes> Row<S> {
    /// The lanes of the triangles, mostly as a window: a row's fragments are in the order of their
    /// triangles.
    #[inline(always)]
    pub(crate) fn order(self, s: S) -> AnyOrder<S> {
        let mut lane = self.pixels.lane();
        if const { S::HAS_WINDOWS } && self.is_open {
            // Lanes that hold fragments already are of any triangles.
            let first = <u32x16<S> as SimdBase<S>>::splat(s, self.lanes.trailing_zeros());
            lane = s
                .mask_from_bits(self.lanes)
                .select(lane, s.permute(lane, first));
        }
        AnyOrder::new(s, lane)
    }
}

impl Default for CrossFragments {
    fn default() -> Self {
        Self {
            pixels: [0; Self::ROOM],
            begin: 0,
            end: 0,
            lanes: 0,
        }
    }
}

impl CrossFragments {
    /// All pixels of sixteen triangles, and two rows more.
    pub(crate) const ROOM: usize = (PIXELS + 2) * LANES;

    /// Begins the fragments of a packet, behind so many fragments of others in the first row: below
    /// [`LANES`]. Gives the memory for all pixels.
    #[inline(always)]
    pub(crate) fn begin(&mut self, open: usize) -> &mut [u32; Self::ROOM] {
        (self.begin, self.end) = (open, open);
        self.lanes = 0;
        &mut self.pixels
    }

    /// Ends the fragments, which are of the triangles in `lanes`.
    #[inline(always)]
    pub(crate) fn end(&mut self, end: usize, lanes: u16) {
        (self.end, self.lanes) = (end, lanes);
        // Lanes that are not used repeat a fragment: another's numbers could be slow.
        let pixels = &mut self.pixels;
        if let Some(&last) = pixels.get(end.wrapping_sub(1))
            && let Some(behind) = pixels.get_mut(end..).and_then(<[u32]>::first_chunk_mut)
        {
            *behind = [last; LANES];
        }
    }

    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        self.begin == self.end
    }

    /// The number of rows.
    #[inline(always)]
    pub(crate) fn rows(&self) -> usize {
        self.end.div_ceil(LANES)
    }

    /// The number of fragments in the last row, if it is not full.
    #[inline(always)]
    pub(crate) fn open(&self) -> usize {
        self.end % LANES
    }

    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "sixteen bits")]
    pub(crate) fn row<S: Lanes>(&self, s: S, number: usize) -> Row<S> {
        let (rows, _) = self.pixels.as_chunks();
        let first = number * LANES;
        let from = self.begin.saturating_sub(first);
        let to = (self.end - first).min(LANES);
        Row {
            pixels: Pixels(u32x16::load_array_ref(s, &rows[number])),
            lanes: ((1u32 << to) - (1 << from)) as u16,
            is_open: from != 0,
        }
    }
}

/// The lanes of a row whose bit is set for their triangle.
#[inline(always)]
pub(crate) fn bits_of_row<S: Lanes>(s: S, bits: u16, row: Row<S>) -> u16 {
    let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
    // The bit of each lane's triangle is moved to the sign.
    let signs = splat(u32::from(bits)) << (splat(31) - row.pixels.lane());
    s.sign_bits(signs.bitcast()) & row.lanes
}
