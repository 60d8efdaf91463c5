//! Covered pixels in the boxes of small triangles: their list, and, sixteen of them at a time,
//! their places in the tile and their depths.

use super::SampleSet;
use super::pixel_list::{PixelList, Pixels};
use super::small::SmallBoxes;
use crate::bounds::lane_order::{AnyOrder, LaneOrder};
use crate::bounds::primitives::TrianglePacket;
use crate::depth_format::StoredDepth;
use estampe_simd::{Bytes, LANES, Lanes, Packet, Select, SimdBase, SimdCvtFloat, f32x16, u32x16};

impl<const N: usize> SmallBoxes<N> {
    /// Lists the pixels of the triangles in `lanes` of which one sample is covered.
    #[inline(always)]
    pub(crate) fn list<S: Lanes>(&self, s: S, sample: usize, lanes: u16, list: &mut PixelList) {
        self.list_covered(s, &self.covered[sample % N], lanes, list);
    }

    /// Lists the pixels of the triangles in `lanes` of which any sample is covered.
    #[inline(always)]
    pub(crate) fn list_any<S: Lanes>(&self, s: S, lanes: u16, list: &mut PixelList) {
        if const { N == 1 } {
            return self.list(s, 0, lanes, list);
        }
        self.list_covered(s, &self.covered_by_any(s), lanes, list);
    }

    /// Lists the first pixels of the quads of the triangles in `lanes` of which any sample is
    /// covered. Boxes must be [those of quads](Boxes::quads).
    #[inline(always)]
    pub(crate) fn list_quads<S: Lanes>(&self, s: S, lanes: u16, list: &mut PixelList) {
        let mut any = self.covered_by_any(s);
        for rows in &mut any {
            let pixels = u32x16::load_array_ref(s, &rows.0);
            let columns = pixels | (pixels >> 1);
            let quads = (columns | (columns >> 8)) & splat_u32(s, 0x0055_0055);
            quads.store_array(&mut rows.0);
        }
        self.list_covered(s, &any, lanes, list);
    }

    /// The pixels of which any sample is covered.
    #[inline(always)]
    fn covered_by_any<S: Lanes>(&self, s: S) -> [Packet<u32>; 2] {
        let mut any = self.covered[0];
        for covered in &self.covered[1..] {
            for (any, covered) in any.iter_mut().zip(covered) {
                let of = |rows: &Packet<u32>| u32x16::load_array_ref(s, &rows.0);
                let both = of(any) | of(covered);
                both.store_array(&mut any.0);
            }
        }
        any
    }

    /// Lists pixels of the triangles in `lanes`.
    #[inline(always)]
    fn list_covered<S: Lanes>(
        &self,
        s: S,
        covered: &[Packet<u32>; 2],
        lanes: u16,
        list: &mut PixelList,
    ) {
        // Four rows of a box are a word.
        match self.rows {
            0..=4 => list.fill::<S, 1>(s, covered, lanes),
            _ => list.fill::<S, 2>(s, covered, lanes),
        }
    }

    /// The lanes of sixteen pixels whose sample is covered.
    #[inline(always)]
    pub(crate) fn covers<S: Lanes>(
        &self,
        s: S,
        sample: usize,
        pixels: Pixels<S>,
        order: impl LaneOrder<S>,
    ) -> u16 {
        let [upper, lower] = &self.covered[sample % N];
        let mut rows = order.permuted_words(s, upper);
        let bit = pixels.bit(s);
        if self.rows > 4 {
            let lower = order.permuted_words(s, lower);
            let is_upper = (bit & splat_u32(s, 32)).simd_eq(splat_u32(s, 0));
            rows = is_upper.select(rows, lower);
        }
        // The bit is moved to the sign.
        let shifted = rows << (splat_u32(s, 31) - (bit & splat_u32(s, 31)));
        s.sign_bits(shifted.bitcast())
    }

    /// The distances of sixteen pixels' first samples from their planes' origin, exact.
    #[inline(always)]
    pub(crate) fn distances<S: Lanes>(
        &self,
        s: S,
        pixels: Pixels<S>,
        order: impl LaneOrder<S>,
    ) -> [f32x16<S>; 2] {
        let [column, row] = [pixels.column(s), pixels.row(s)];
        let from_x = order.permuted(s, &self.from_x);
        let from_y = order.permuted(s, &self.from_y);
        [
            from_x + f32x16::float_from(column),
            from_y + f32x16::float_from(row),
        ]
    }

    /// Where sixteen pixels are in the tile: packet·16 + lane.
    #[inline(always)]
    pub(crate) fn pixels_in_tile<S: Lanes>(
        &self,
        s: S,
        pixels: Pixels<S>,
        order: impl LaneOrder<S>,
    ) -> u32x16<S> {
        let first = order.permuted_words(s, &self.first);
        let step: u32x16<S> = (pixels.column(s) | (pixels.row(s) << 16)).bitcast();
        spread(s, first + step)
    }

    /// The places of sixteen pixels' first samples in the tile.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "four samples at most")]
    fn places<S: Lanes>(&self, s: S, pixels: Pixels<S>, order: impl LaneOrder<S>) -> u32x16<S> {
        let pixels = self.pixels_in_tile(s, pixels, order);
        if const { N == 1 } {
            return pixels;
        }
        // The lines of a packet's samples lie one after the other.
        let lane = pixels & <u32x16<S> as SimdBase<S>>::splat(s, LANES as u32 - 1);
        (pixels - lane) * (N as u32) + lane
    }

    /// Places in the tile and depths of one sample of all listed pixels.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "four samples at most")]
    pub(crate) fn locate<S: Lanes>(
        &self,
        s: S,
        packet: &TrianglePacket,
        (stored, samples, sample): (StoredDepth, SampleSet<N>, usize),
        list: &mut PixelList,
    ) {
        let offsets = samples.offsets();
        let [from_first_x, from_first_y] =
            [0, 1].map(|axis| offsets[sample % N][axis] - offsets[0][axis]);
        let line = <u32x16<S> as SimdBase<S>>::splat(s, (sample * LANES) as u32);
        for (pixels, (places, depths)) in list.sixteens() {
            let pixels = Pixels(s.widen(pixels));
            let order = AnyOrder::new(s, pixels.lane());
            let [mut x, mut y] = self.distances(s, pixels, order);
            if const { N > 1 } {
                (x, y) = (x + from_first_x, y + from_first_y);
            }
            let depth = packet.z.of_lanes(s, order).at([x, y]);
            stored.of(s, depth).store_array(depths);
            (self.places(s, pixels, order) + line).store_array(places);
        }
    }
}

#[inline(always)]
fn splat_u32<S: Lanes>(s: S, value: u32) -> u32x16<S> {
    SimdBase::splat(s, value)
}

/// Morton order: the index in its tile of a pixel whose column is in the lower half and whose row
/// is in the upper half, six bits each.
#[inline(always)]
pub(super) fn spread<S: Lanes>(s: S, v: u32x16<S>) -> u32x16<S> {
    let mask = |bits: u32| <u32x16<S> as SimdBase<S>>::splat(s, bits);
    let v = v & mask(0x3F_003F);
    let v = (v | (v << 4)) & mask(0x030F_030F);
    let v = (v | (v << 2)) & mask(0x0333_0333);
    let v = (v | (v << 1)) & mask(0x0555_0555);
    (v | (v >> 15)) & mask(0xFFF)
}
