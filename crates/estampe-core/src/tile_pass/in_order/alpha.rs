//! Alpha tests before shading: of a list of pixels, and of the packets of one triangle.

use super::listed::{ListedValues, moved};
use super::small::Listing;
use super::{InOrder, InOrderScratch};
use crate::bounds::lane_order::AnyOrder;
use crate::fragment::alpha_test::{may_pass, whole_quads};
use crate::fragment::interpolate::TriangleInterpolant;
use crate::fragment::place::indices_of;
use crate::plan::tile_plan::TestTiming;
use crate::raster::packet_origin;
use crate::raster::pixel_list::Pixels;
use estampe_simd::{Bytes, Lanes, Select, SimdBase, bits_of, dispatch, f32x16, u32x16};
use estampe_types::shader::AlphaTest;

impl<const N: usize> InOrder<'_, '_, '_, '_, N> {
    /// Makes fragments of the listed pixels, less those that certainly have no effect, and then
    /// those that fail the depth test: they are fewer. A function of its own, as most draws have no
    /// alpha test.
    #[inline(never)]
    pub(super) fn test_alpha_of_list<V: ListedValues>(&mut self, test: &AlphaTest) {
        if const { N <= 4 } {
            let tests = &self.work.plan.tests;
            let rejects = self.work.plan.timing == TestTiming::RejectEarly && !tests.is_empty();
            dispatch!(@wide self.work.level, s => {
                self.test_list::<_, V>(s, false, Some(test));
                if rejects {
                    self.reject_lanes::<_, V>(s);
                }
            }, scalar => unreachable!("the scalar level draws one by one"));
        }
    }

    /// Drops the samples of listed fragments that would fail the tests, and fragments of which none
    /// is left.
    #[inline(always)]
    fn reject_lanes<S: Lanes, V: ListedValues>(&mut self, s: S) {
        let plan = self.work.plan;
        let (offsets, count) = (self.samples.offsets(), self.samples.count());
        let depths_at = self.depths_at::<V>();
        let quads = self.listing == Listing::Quads;
        let depth = &self.job.depth;
        let InOrderScratch {
            small, fragments, ..
        } = &mut self.scratch.in_order;
        fragments.retain(
            s,
            #[inline(always)]
            |[pixels, places, listed]| {
                let pixels = Pixels(pixels);
                let order = AnyOrder::new(s, pixels.lane());
                let first = small.small.distances(s, pixels, order);
                let depths = V::depths(small, s, order, pixels.lane());
                let indices = indices_of(s, places, [count, 0]);
                let stored: [u32x16<S>; N] = s.gather_lines(bits_of(depth.as_flattened()), indices);
                let zero = <u32x16<S> as SimdBase<S>>::splat(s, 0);
                let (mut samples, mut any) = (zero, 0);
                for (sample, depth_at) in (0_u32..).zip(&depths_at).take(count) {
                    let mut mask = u16::MAX;
                    if N > 1 || quads {
                        mask = s.sign_bits((listed << (31 - sample)).bitcast());
                    }
                    let new = V::depth(&depths, s, moved(first, offsets[0], *depth_at));
                    let new = plan.tests.stored.of(s, new);
                    let stored: f32x16<S> = stored[sample as usize].bitcast();
                    let mut stored = stored.to_array();
                    let stored = (!depth.is_empty()).then_some(&mut stored);
                    mask &= plan.tests.would_pass(s, new, stored);
                    any |= mask;
                    if N > 1 || quads {
                        let bit = <u32x16<S> as SimdBase<S>>::splat(s, 1 << sample);
                        samples |= s.mask_from_bits(mask).select(bit, zero);
                    }
                }
                (if quads { whole_quads(any) } else { any }, samples)
            },
        );
    }

    /// Drops the fragments of a triangle's packets that certainly have no effect; false if none is
    /// left.
    #[inline(never)]
    pub(super) fn test_alpha_of_triangle(
        &mut self,
        test: &AlphaTest,
        interpolant: &TriangleInterpolant<'_>,
    ) -> bool {
        if const { N <= 4 } {
            dispatch!(@wide self.work.level, s => self.test_alpha_of_packets(s, test, interpolant),
                scalar => {});
        }
        !self.scratch.in_order.list.items().is_empty()
    }

    #[inline(always)]
    fn test_alpha_of_packets<S: Lanes>(
        &mut self,
        s: S,
        test: &AlphaTest,
        interpolant: &TriangleInterpolant<'_>,
    ) {
        let (shape, quads) = (self.work.shape, !self.needs_no_quads);
        let list = &mut self.scratch.in_order.list;
        let mut dropped = 0;
        list.retain(
            #[inline(always)]
            |item| {
                let (x, y) = packet_origin(u32::from(item.packet));
                let places = interpolant.alpha_places(s, test, [shape.x + x, shape.y + y]);
                let kept = may_pass(s, test, &places, quads);
                dropped += (item.any() & !kept).count_ones();
                item.masks.iter_mut().for_each(|mask| *mask &= kept);
            },
        );
        self.scratch.statistics.fragments_failing_alpha += u64::from(dropped);
    }
}
