//! Alpha tests before shading: of a list of pixels, and of the packets of one triangle.

use super::listed::{ListedValues, moved};
use super::small::Listing;
use super::{InOrder, InOrderScratch};
use crate::bounds::lane_order::AnyOrder;
use crate::fragment::alpha_test::may_pass;
use crate::fragment::interpolate::TriangleInterpolant;
use crate::raster::packet_origin;
use crate::raster::pixel_list::Pixels;
use estampe_simd::{Lanes, dispatch};
use estampe_types::shader::AlphaTest;

impl<const N: usize> InOrder<'_, '_, '_, '_, N> {
    /// Drops the listed fragments that certainly have no effect. A function of its own, as most
    /// draws have no alpha test.
    #[inline(never)]
    pub(super) fn test_alpha_of_list<V: ListedValues>(&mut self, test: &AlphaTest) {
        if const { N <= 4 } {
            dispatch!(@wide self.work.level, s => self.test_alpha_of_lanes::<_, V>(s, test),
                scalar => unreachable!("the scalar level draws one by one"));
        }
    }

    #[inline(always)]
    fn test_alpha_of_lanes<S: Lanes, V: ListedValues>(&mut self, s: S, test: &AlphaTest) {
        let offset = self.samples.offsets()[0];
        let quads = self.listing == Listing::Quads;
        let InOrderScratch {
            small, fragments, ..
        } = &mut self.scratch.in_order;
        let before = fragments.len();
        fragments.retain(
            s,
            #[inline(always)]
            |pixels| {
                let pixels = Pixels(pixels);
                let order = AnyOrder::new(s, pixels.lane());
                let first = small.small.distances(s, pixels, order);
                let center = moved(first, offset, [0.5; 2]);
                match V::alpha_places(small, s, order, test, center) {
                    Some(places) => may_pass(s, test, &places, quads),
                    None => u16::MAX,
                }
            },
        );
        let dropped = before - fragments.len();
        self.scratch.statistics.fragments_failing_alpha += dropped as u64;
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
