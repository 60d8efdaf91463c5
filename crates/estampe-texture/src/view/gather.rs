//! Texel gathering: one channel, or the comparison, of the four texels around a coordinate in the
//! base level; the scalar code, lane by lane.

use super::PacketRequest;
use super::SampledTexture;
use super::axis;
use super::coordinates::{Answers, answer};
use super::sample::{Channels, Tap};
use estampe_types::ViewDimension;

/// From upper left, upper right, lower left, lower right to the order of shading languages: lower
/// left, lower right, upper right, upper left.
pub(super) const ORDER: [usize; 4] = [2, 3, 1, 0];

impl SampledTexture {
    /// Gathers a channel of lanes: by packet code if possible, else lane by lane.
    #[inline(never)]
    pub(crate) fn gather_lanes(
        &self,
        lanes: &PacketRequest<'_>,
        channel: usize,
        texels: &mut Answers,
    ) {
        if self.gather_packet(lanes, Some(channel), texels).is_none() {
            for lane in 0..lanes.count {
                answer(texels, lane, self.gather_lane(lanes, lane, channel));
            }
        }
    }

    /// Gathers a channel of one lane.
    pub(crate) fn gather_lane(
        &self,
        lanes: &PacketRequest<'_>,
        lane: usize,
        channel: usize,
    ) -> [f32; 4] {
        let codec = &self.view.codec;
        let four = self.four(lanes, lane, &Channels);
        let four = four.map(|unit| codec.finish(unit)[channel & 3]);
        ORDER.map(|index| four[index])
    }

    /// Gathers comparison results of lanes: by packet code if possible, else lane by lane.
    #[inline(never)]
    pub(crate) fn gather_compare_lanes(&self, lanes: &PacketRequest<'_>, results: &mut Answers) {
        if self.gather_packet(lanes, None, results).is_none() {
            for lane in 0..lanes.count {
                answer(results, lane, self.gather_compare_lane(lanes, lane));
            }
        }
    }

    /// Gathers comparison results of one lane.
    pub(crate) fn gather_compare_lane(&self, lanes: &PacketRequest<'_>, lane: usize) -> [f32; 4] {
        let comparison = self.comparison(lanes.reference.0[lane]);
        let four = self.four(lanes, lane, &comparison);
        ORDER.map(|index| four[index][0])
    }

    /// The four texels around a lane's coordinates: upper left, upper right, lower left, lower
    /// right.
    fn four(&self, lanes: &PacketRequest<'_>, lane: usize, tap: &impl Tap) -> [[f32; 4]; 4] {
        if matches!(self.view.dimension, ViewDimension::D1 | ViewDimension::D3) {
            return [[0.0; 4]; 4];
        }
        let plane = &self.view.planes[0];
        let spot = self.spot(lanes.at(lane), lanes.layer(lane));
        if self.view.is_cube() {
            return self.four_of_cube(plane, &spot, plane.sides[0], tap).0;
        }
        let [x, y] = [0, 1].map(|axis| {
            let side = (plane.sides[axis], plane.size[axis]);
            let mode = self.address_modes()[axis];
            axis::gathered(spot.uvw[axis], side, mode, lanes.offset[axis])
        });
        [(x[0], y[0]), (x[1], y[0]), (x[0], y[1]), (x[1], y[1])]
            .map(|(x, y)| tap.of(self.unit(plane, [x, y, spot.layer()])))
    }
}
