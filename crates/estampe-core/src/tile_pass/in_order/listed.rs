//! Small primitives of a batch as a list of pixels, or quads: tests before shading, then packets.

use super::small::{Listing, SmallScratch};
use super::tests::{run_apart, samples_in};
use super::{InOrder, InOrderScratch};
use crate::bounds::lane_order::AnyOrder;
use crate::depth_format::clamp_depth;
use crate::fragment::alpha_test::{AlphaPlaces, may_pass, whole_quads};
use crate::fragment::cross_fragments::{Row, bits_of_row};
use crate::fragment::fill::lanes_between;
use crate::fragment::interpolate::{VaryingSource, WindowPixels};
use crate::fragment::place::indices_of;
use crate::fragment::quad::QUAD;
use crate::fragment::queue::{PixelPacket, replace};
use crate::per_sample::sample_tests::StoredSamples;
use crate::plan::tile_plan::TestTiming;
use crate::raster::pixel_list::Pixels;
use estampe_simd::{
    Bytes, LANES, Lanes, Packet, Select, SimdBase, bits_of, dispatch, f32x16, u32x16,
};
use estampe_types::shader::AlphaTest;

/// When the tests that come before shading are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum EarlyTests {
    None,
    /// Over the whole list, because nothing is written.
    OfList,
    /// Packet by packet.
    OfPackets,
}

/// The values of listed pixels: those of their triangles or lines. Distances are from the origins.
pub(super) trait ListedValues {
    /// The primitives that face the viewer.
    fn front<const N: usize>(of: &SmallScratch<N>) -> u16;

    /// Returns true if all samples of a pixel have the depth of its centre.
    fn has_depths_of_centers<const N: usize>(of: &SmallScratch<N>) -> bool;

    /// What gives the depths of sixteen pixels, for all of their samples.
    type Depths<'a, S: Lanes>;

    /// The depths of the primitives in `lane`, which is also an order.
    fn depths<'a, S: Lanes, const N: usize>(
        of: &'a SmallScratch<N>,
        s: S,
        order: AnyOrder<S>,
        lane: u32x16<S>,
    ) -> Self::Depths<'a, S>;

    /// Depth, not yet clamped.
    fn depth<S: Lanes>(of: &Self::Depths<'_, S>, s: S, distances: [f32x16<S>; 2]) -> f32x16<S>;

    /// 1/w at the pixels' centres.
    fn inverse_w<S: Lanes, const N: usize>(
        of: &SmallScratch<N>,
        s: S,
        row: Row<S>,
        distances: [f32x16<S>; 2],
    ) -> f32x16<S>;

    /// The places of pixels' centres in the texture of an alpha test, if they are looked up.
    #[inline(always)]
    fn alpha_places<S: Lanes, const N: usize>(
        _of: &SmallScratch<N>,
        _s: S,
        _order: AnyOrder<S>,
        _test: &AlphaTest,
        _distances: [f32x16<S>; 2],
    ) -> Option<AlphaPlaces<S>> {
        None
    }

    /// The varyings at the pixels' centres.
    fn varyings<S: Lanes, const N: usize>(
        of: &SmallScratch<N>,
        s: S,
        row: Row<S>,
        source: &VaryingSource<'_>,
        distances: [f32x16<S>; 2],
        out: &mut [Packet<f32>],
    );
}

impl<const N: usize> InOrder<'_, '_, '_, '_, N> {
    /// Draws small primitives of the batch that follow each other.
    #[inline(never)]
    pub(super) fn list_pixels<V: ListedValues>(&mut self, lanes: u16) {
        if const { N <= 4 } {
            dispatch!(@wide self.work.level, s => self.list_lanes::<_, V>(s, lanes),
                scalar => unreachable!("the scalar level draws one by one"));
        }
    }

    #[inline(always)]
    fn list_lanes<S: Lanes, V: ListedValues>(&mut self, s: S, lanes: u16) {
        let plan = self.work.plan;
        let scratch = &mut *self.scratch.in_order.small;
        if self.listing == Listing::Quads {
            scratch.small.list_quads(s, lanes, &mut scratch.listed);
        } else {
            scratch.small.list_any(s, lanes, &mut scratch.listed);
        }
        let is_read_only = plan.tests.stencil.is_none() && !plan.tests.writes_depth();
        let early = match plan.timing {
            TestTiming::Late => EarlyTests::None,
            TestTiming::Early if plan.tests.is_empty() => EarlyTests::None,
            TestTiming::Early if !is_read_only => EarlyTests::OfPackets,
            TestTiming::Early | TestTiming::RejectEarly => EarlyTests::OfList,
        };
        if let Some(test) = &plan.alpha_test {
            self.test_alpha_of_list::<V>(test);
        } else {
            self.test_list::<_, V>(s, early == EarlyTests::OfList, None);
        }
        let mut from = 0;
        let count = self.scratch.in_order.fragments.len();
        if count != 0 {
            self.end_solid();
        }
        while from < count {
            from += self.queue_pixels::<_, V>(s, from, early == EarlyTests::OfPackets);
        }
    }

    /// Makes fragments of the listed pixels, less those of which no sample passes, or that fail an
    /// alpha test.
    #[inline(always)]
    pub(super) fn test_list<S: Lanes, V: ListedValues>(
        &mut self,
        s: S,
        tests: bool,
        alpha_test: Option<&AlphaTest>,
    ) {
        let plan = self.work.plan;
        let (offsets, count) = (self.samples.offsets(), self.samples.count());
        let depths_at = self.depths_at::<V>();
        self.scratch.in_order.fragments.clear();
        let quads = self.listing == Listing::Quads;
        let pixels_each = if quads { QUAD } else { 1 };
        let end = self.scratch.in_order.small.listed.len() * pixels_each;
        for from in (0..end).step_by(LANES) {
            let scratch = &*self.scratch.in_order.small;
            let pixels = if quads {
                scratch.listed.four_quads(s, from / QUAD)
            } else {
                scratch.listed.sixteen(s, from)
            };
            let listed = u16::MAX >> (LANES - (end - from).min(LANES));
            let order = AnyOrder::new(s, pixels.lane());
            let places = scratch.small.pixels_in_tile(s, pixels, order);
            let first = scratch.small.distances(s, pixels, order);
            let new_depths = V::depths(scratch, s, order, pixels.lane());
            let zero = <u32x16<S> as SimdBase<S>>::splat(s, 0);
            let depths = bits_of(self.job.depth.as_flattened());
            let stored: [u32x16<S>; N] = if tests {
                s.gather_lines(depths, indices_of(s, places, [count, 0]))
            } else {
                [zero; N]
            };
            let (mut samples, mut any) = (zero, 0);
            for (sample, depth_at) in depths_at.iter().enumerate().take(count) {
                let mut mask = listed;
                if N > 1 || quads {
                    mask &= scratch.small.covers(s, sample, pixels, order);
                }
                if tests && mask != 0 {
                    let distances = moved(first, offsets[0], *depth_at);
                    let new = V::depth(&new_depths, s, distances);
                    let new = plan.tests.stored.of(s, new);
                    let stored: f32x16<S> = stored[sample].bitcast();
                    let mut stored = stored.to_array();
                    let stored = (!self.job.depth.is_empty()).then_some(&mut stored);
                    mask = if plan.timing == TestTiming::Early {
                        let stored = StoredSamples {
                            depth: stored,
                            stencil: None,
                        };
                        plan.tests.run(s, new, mask, u16::MAX, stored)
                    } else {
                        mask & plan.tests.would_pass(s, new, stored)
                    };
                }
                any |= mask;
                if N > 1 || quads {
                    let bit = <u32x16<S> as SimdBase<S>>::splat(s, 1 << sample);
                    samples |= s.mask_from_bits(mask).select(bit, zero);
                }
                if plan.query.is_some() && tests && plan.timing == TestTiming::Early {
                    self.passed += u64::from(mask.count_ones());
                }
            }
            if quads {
                // A quad of which any pixel is left stays whole.
                any = whole_quads(any);
            }
            if let Some(test) = alpha_test {
                let small = &*self.scratch.in_order.small;
                let center = moved(first, offsets[0], [0.5; 2]);
                if let Some(places) = V::alpha_places(small, s, order, test, center) {
                    let kept = may_pass(s, test, &places, quads);
                    let failing = (any & !kept).count_ones();
                    self.scratch.statistics.fragments_failing_alpha += u64::from(failing);
                    any &= kept;
                }
            }
            let fragments = &mut self.scratch.in_order.fragments;
            fragments.add(s, any, [pixels.0, places, samples]);
        }
        self.scratch.in_order.fragments.end();
    }

    /// Queues the next packet of different pixels, from a fragment on; gives the number of its
    /// fragments.
    #[inline(always)]
    fn queue_pixels<S: Lanes, V: ListedValues>(&mut self, s: S, from: usize, tests: bool) -> usize {
        let plan = self.work.plan;
        let is_shown = self.is_shown();
        let (offsets, samples) = (self.samples.offsets(), self.samples.count());
        let depths_at = self.depths_at::<V>();
        let InOrderScratch {
            small: scratch,
            fragments,
            last_packet,
            ..
        } = &mut self.scratch.in_order;
        let quads = self.listing == Listing::Quads;
        // Quads begin a packet of their own.
        let used = if quads {
            0
        } else {
            self.scratch.queue.open_pixels()
        };
        let [pixels, places, of_samples] = fragments.sixteen(from, used);
        let (pixels, places) = (Pixels(u32x16::load_array_ref(s, pixels)), *places);
        let of_samples = u32x16::load_array_ref(s, of_samples);
        let wanted = LANES.min(used + fragments.len() - from);
        let mut masks = [lanes_between(used, wanted); N];
        if N > 1 || quads {
            for (mask, sample) in masks.iter_mut().zip(0u32..) {
                *mask &= s.sign_bits((of_samples << (31 - sample)).bitcast());
            }
        }
        let alive = masks.iter().fold(0, |any, mask| any | mask);
        // Which fragment a pixel shows is found before they are shaded: only those that are tested
        // together must be of different pixels.
        let mut end = match (is_shown, used) {
            (true, _) if !tests => LANES,
            (true, _) => last_packet.begin_with(s, (&places, alive), false),
            (false, 0) => last_packet.begin_with(s, (&places, alive), !quads && wanted < LANES),
            (false, _) => last_packet.add(&places, alive),
        };
        end = end.min(wanted);
        end -= if quads { end % QUAD } else { 0 };
        if end == used {
            self.scratch.queue.close_pixels();
            return 0;
        }
        let (lanes, count) = (lanes_between(used, end), end - used);
        let row = Row {
            pixels,
            lanes,
            is_open: used != 0,
        };
        for mask in &mut masks {
            *mask &= lanes;
        }
        let mut packet = PixelPacket {
            places: &places,
            are_quads: quads,
            masks,
            front: bits_of_row(s, V::front(scratch), row),
        };
        let order = row.order(s);
        let first = scratch.small.distances(s, pixels, order);
        if tests {
            let depths = V::depths(scratch, s, order, pixels.lane());
            let (place, front) = (&packet.place(), packet.front);
            run_apart(
                s,
                &plan.tests,
                (&mut packet.masks, front),
                (place, samples),
                self.job,
                #[inline(always)]
                |sample| {
                    let distances = moved(first, offsets[0], depths_at[sample]);
                    plan.tests.stored.of(s, V::depth(&depths, s, distances))
                },
            );
            if plan.tests.writes_depth() {
                self.scratch.hiz.invalidate(place.blocks());
            }
        }
        if tests || plan.timing == TestTiming::Early && plan.tests.is_empty() {
            if plan.query.is_some() {
                self.passed += samples_in(&packet.masks);
            }
            if packet.masks == [0; N] {
                return count;
            }
        }
        if used == 0 && self.scratch.queue.is_full() {
            self.flush();
        }
        if is_shown {
            let shown = (&places, packet.masks[0]);
            self.scratch.show_pixels(plan, self.job, shown, used == 0);
        }
        let inputs = self.scratch.queue.push_pixels(&packet, lanes);
        let small = &*self.scratch.in_order.small;
        let center = moved(first, offsets[0], [0.5; 2]);
        let source = &self.source;
        V::varyings(small, s, row, source, center, inputs.varyings);
        let set = inputs.lanes;
        let depths = V::depths(small, s, order, pixels.lane());
        if let Some([to_x, to_y, to_z, to_w]) = inputs.position {
            let tile = [self.work.shape.x, self.work.shape.y];
            let places = u32x16::load_array(s, places);
            let [x, y] = WindowPixels::of_places(s, places, tile).coordinates([0.5; 2]);
            replace(s, to_x, set, x);
            replace(s, to_y, set, y);
            let depth = V::depth(&depths, s, center);
            replace(s, to_z, set, clamp_depth(s, depth, inputs.depth_range));
            replace(s, to_w, set, V::inverse_w(small, s, row, center));
        }
        for (to, place_of_depth) in inputs.depths.iter_mut().zip(depths_at) {
            let distances = moved(first, offsets[0], place_of_depth);
            let depth = V::depth(&depths, s, distances);
            replace(s, to, set, clamp_depth(s, depth, inputs.depth_range));
        }
        if quads || end < wanted && !is_shown {
            // Quads, or a pixel that comes again, begin a packet.
            self.scratch.queue.close_pixels();
        }
        let [fragments, packets] = &mut self.scratch.statistics.fragments_listed_in_order;
        *fragments += u64::from((alive & lanes).count_ones());
        *packets += u64::from(used == 0);
        count
    }

    /// The places in a pixel at which its samples have their depths.
    #[inline(always)]
    pub(super) fn depths_at<V: ListedValues>(&self) -> [[f32; 2]; N] {
        if V::has_depths_of_centers(&self.scratch.in_order.small) {
            return [[0.5; 2]; N];
        }
        self.samples.offsets()
    }
}

/// The distances of another place in each pixel: exact, because places are multiples of 1/256.
#[inline(always)]
pub(super) fn moved<S: Lanes>(
    [x, y]: [f32x16<S>; 2],
    from: [f32; 2],
    to: [f32; 2],
) -> [f32x16<S>; 2] {
    [x + (to[0] - from[0]), y + (to[1] - from[1])]
}
