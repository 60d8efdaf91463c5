//! Comparison samplers: texels are compared with a reference, and the results, 1 or 0, are
//! filtered.

use super::PacketRequest;
use super::SampledTexture;
use super::coordinates::{Answers, answer};
use super::sample::Tap;
use estampe_types::state::CompareFunction;
use estampe_types::{Real, TexelEncoding};

/// The comparison of a texel with a reference: 1 where it passes, else 0.
pub(crate) struct Comparison {
    function: CompareFunction,
    reference: f32,
}

impl Tap for Comparison {
    #[inline(always)]
    fn of(&self, unit: [f32; 4]) -> [f32; 4] {
        let passes = self.function.passes(self.reference, unit[0]);
        [if passes { 1.0 } else { 0.0 }, 0.0, 0.0, 0.0]
    }
}

impl SampledTexture {
    /// The comparison with a reference; for fixed-point depths, the reference is clamped to 0..=1
    /// as they are.
    pub(crate) fn comparison(&self, reference: f32) -> Comparison {
        let encoding = self.view.texture.stored_format().encoding();
        let is_fixed = matches!(encoding, TexelEncoding::Depth16 | TexelEncoding::Depth24);
        Comparison {
            // A sampler without a comparison is refused earlier; `Never` gives 0 for it.
            function: self.sampler.compare.unwrap_or(CompareFunction::Never),
            reference: if is_fixed {
                Real::saturate(reference)
            } else {
                reference
            },
        }
    }

    /// Compares lanes: by packet code if possible, else lane by lane. The results are in the first
    /// channel.
    #[inline(never)]
    pub(crate) fn compare_lanes(&self, lanes: &PacketRequest<'_>, answers: &mut Answers) {
        if self.sample_packet(lanes, answers, true).is_none() {
            for lane in 0..lanes.count {
                answer(answers, lane, self.compare_lane(lanes, lane));
            }
        }
    }

    /// Compares one lane.
    pub(crate) fn compare_lane(&self, lanes: &PacketRequest<'_>, lane: usize) -> [f32; 4] {
        let footprint = super::footprint::Footprint {
            probes: 1,
            ..self.footprint(lanes, lane)
        };
        let comparison = self.comparison(lanes.reference.0[lane]);
        self.probes(lanes, lane, &footprint, &comparison)
    }
}
