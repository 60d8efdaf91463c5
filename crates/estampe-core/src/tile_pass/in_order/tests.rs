//! The tests of the in-order path: before shading, and after it (O9).

use super::InOrder;
use crate::depth_format::StoredDepth;
use crate::fragment::interpolate::Interpolant;
use crate::fragment::place::Place;
use crate::fragment::queue::{LatePacket, depth_after_shading};
use crate::per_sample::sample_tests::{SampleTests, StoredSamples};
use crate::plan::tile_plan::TestTiming;
use crate::raster::packet_origin;
use crate::tile_pass::TileJob;
use estampe_simd::{LANES, Lanes, Packet, SimdBase, f32x16, outline};
use estampe_types::shader::DepthOutput;

impl<const N: usize> InOrder<'_, '_, '_, '_, N> {
    /// Drops the samples that the sample mask excludes and those that fail before shading; false
    /// when nothing is left.
    #[inline(always)]
    pub(super) fn test_early<S: Lanes>(
        &mut self,
        s: S,
        interpolant: &impl Interpolant<S>,
        front: bool,
    ) -> bool {
        let (plan, key) = (self.work.plan, self.work.plan.pipeline.key());
        let scratch = &mut self.scratch.in_order;
        if let Some(cut) = &plan.cut_samples {
            let (shape, samples) = (self.work.shape, self.samples);
            let mut pixels = [shape.local(&plan.rect); N];
            for (pixels, at) in pixels.iter_mut().zip(samples.subpixels()) {
                *pixels = shape.local(&cut.pixels_of(at));
            }
            scratch.list.clip_samples(&pixels);
        }
        if let Some(mask) = key.sample_mask {
            scratch.list.keep_samples(mask);
        }
        if key.keeps_coverage {
            scratch.covered.clone_from(&scratch.list);
        }
        match plan.timing {
            TestTiming::Late => {}
            TestTiming::Early if plan.tests.is_empty() => self.count_passed(),
            TestTiming::Early => {
                self.run_early::<S, true>(s, interpolant, front);
                self.count_passed();
            }
            TestTiming::RejectEarly => self.run_early::<S, false>(s, interpolant, front),
        }
        !self.scratch.in_order.list.items().is_empty()
    }

    /// Tests the list; with `WRITES` values are written, else samples that fail are dropped only.
    #[inline(always)]
    fn run_early<S: Lanes, const WRITES: bool>(
        &mut self,
        s: S,
        interpolant: &impl Interpolant<S>,
        front: bool,
    ) {
        let tests = &self.work.plan.tests;
        let (shape, samples) = (self.work.shape, self.samples);
        let (offsets, count) = (samples.offsets(), samples.count());
        // Prepared once for all packets, and depth is not interpolated if nothing compares it.
        let face = match &tests.stencil {
            Some(test) if WRITES => Some(test.face(front).lanes(s)),
            _ => None,
        };
        let compares_depth = tests.depth.is_some();
        let TileJob { depth, stencil, .. } = &mut *self.job;
        let mut touched = 0;
        self.scratch.in_order.list.retain(
            #[inline(always)]
            |item| {
                let packet = usize::from(item.packet);
                let (x, y) = packet_origin(u32::from(item.packet));
                let pixel = [shape.x + x, shape.y + y];
                for (sample, mask) in item.masks.iter_mut().enumerate().take(count) {
                    outline!(s, {
                        let mut new = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
                        if compares_depth {
                            new = interpolant.depth(s, pixel, offsets[sample]);
                        }
                        let line = packet * count + sample;
                        let stored_depth = depth.get_mut(line);
                        if WRITES {
                            let stored = StoredSamples {
                                depth: stored_depth,
                                stencil: stencil.get_mut(line),
                            };
                            let new = tests.comparable(s, new);
                            *mask = tests.run_face(s, new, *mask, face.as_ref(), stored);
                        } else {
                            let new = tests.stored.of(s, new);
                            *mask &= tests.would_pass(s, new, stored_depth);
                        }
                    });
                }
                touched |= 1u16 << ((packet >> 4) & 15);
            },
        );
        if WRITES && tests.writes_depth() {
            self.scratch.hiz.invalidate(touched);
        }
    }

    /// Counts the samples of the list for an occlusion query.
    #[inline(always)]
    fn count_passed(&mut self) {
        if self.work.plan.query.is_some() {
            let items = self.scratch.in_order.list.items().iter();
            self.passed += items.map(|item| item.count()).sum::<u64>();
        }
    }

    /// Alpha to coverage, the shader's sample mask, and the tests after shading, of all queued
    /// packets.
    #[inline(always)]
    pub(super) fn test_late<S: Lanes>(&mut self, s: S) {
        let plan = self.work.plan;
        let count = self.samples.count();
        self.keep_shaded(s);
        if const { N <= 4 && !S::IS_SCALAR } && self.shares_packets {
            let scratch = &mut *self.scratch;
            let survivors = &mut scratch.in_order.survivors;
            let gathered = scratch.queue.gather_survivors(s, survivors);
            scratch.statistics.packets_of_survivors[0] += gathered[0];
            scratch.statistics.packets_of_survivors[1] += gathered[1];
        }
        if plan.timing == TestTiming::Early {
            return;
        }
        let mut written = 0;
        for mut packet in self.scratch.queue.late_packets() {
            if !plan.tests.is_empty() {
                run_late(s, &plan.tests, &mut packet, count, self.job);
                written |= packet.place.blocks();
            }
            if plan.query.is_some() {
                self.passed += samples_in(packet.masks);
            }
        }
        if plan.tests.writes_depth() {
            self.scratch.hiz.invalidate(written);
        }
    }

    /// Keeps the samples that alpha to coverage and the shader's sample mask leave.
    #[inline(always)]
    fn keep_shaded<S: Lanes>(&mut self, s: S) {
        let count = self.samples.count();
        let alpha_to_coverage = self.work.plan.pipeline.key().alpha_to_coverage;
        for packet in self.scratch.queue.late_packets() {
            if alpha_to_coverage && let Some(alpha) = packet.alpha {
                keep_by_alpha(s, alpha, &mut packet.masks[..count]);
            }
            if let Some(kept) = packet.sample_mask {
                keep_by_mask(kept, &mut packet.masks[..count]);
            }
        }
    }
}

/// The number of samples in masks of lanes.
#[inline(always)]
pub(super) fn samples_in(masks: &[u16]) -> u64 {
    masks.iter().map(|mask| u64::from(mask.count_ones())).sum()
}

/// Tests one shaded packet.
#[inline(always)]
fn run_late<S: Lanes, const N: usize>(
    s: S,
    tests: &SampleTests,
    packet: &mut LatePacket<'_, N>,
    samples: usize,
    job: &mut TileJob<'_>,
) {
    let (depths, depth_out) = (packet.depths, packet.depth_out);
    let (place, front) = (packet.place, packet.front);
    let Place::Packet(number) = *place else {
        run_apart(
            s,
            tests,
            (packet.masks, front),
            (place, samples),
            job,
            #[inline(always)]
            |sample| late_depth(s, tests.stored, &depths[sample], depth_out),
        );
        return;
    };
    for (sample, mask) in packet.masks.iter_mut().enumerate().take(samples) {
        if *mask == 0 {
            continue;
        }
        let line = usize::from(number) * samples + sample;
        let stored = StoredSamples {
            depth: job.depth.get_mut(line),
            stencil: job.stencil.get_mut(line),
        };
        let new = late_depth(s, tests.stored, &depths[sample], depth_out);
        *mask = tests.run(s, new, *mask, front, stored);
    }
}

/// The depths of one sample, as they are stored, after shading.
#[inline(always)]
fn late_depth<S: Lanes>(
    s: S,
    StoredDepth { range, format }: StoredDepth,
    interpolated: &Packet<f32>,
    depth_out: Option<(DepthOutput, &Packet<f32>)>,
) -> f32x16<S> {
    let interpolated = f32x16::load_array_ref(s, &interpolated.0);
    format.stored_lanes(s, depth_after_shading(s, interpolated, depth_out, range))
}

/// Tests fragments that lie apart, of different pixels, given the new depths of each sample. Leaves
/// the lanes that pass.
#[inline(always)]
pub(super) fn run_apart<S: Lanes, const N: usize>(
    s: S,
    tests: &SampleTests,
    (masks, front): (&mut [u16; N], u16),
    (place, samples): (&Place, usize),
    job: &mut TileJob<'_>,
    new: impl Fn(usize) -> f32x16<S>,
) {
    let mut depths = [[0.0; LANES]; N];
    let has_depth = !job.depth.is_empty();
    if has_depth {
        place.depths(s, job.depth, samples, &mut depths);
    }
    let tested = *masks;
    for (sample, mask) in masks.iter_mut().enumerate().take(samples) {
        if *mask == 0 {
            continue;
        }
        let mut stencil =
            (!job.stencil.is_empty()).then(|| place.gather(job.stencil, samples, sample));
        let stored = StoredSamples {
            depth: has_depth.then_some(&mut depths[sample]),
            stencil: stencil.as_mut(),
        };
        *mask = tests.run(s, new(sample), tested[sample], front, stored);
        if let (Some(stencil), Some(_)) = (&stencil, &tests.stencil) {
            place.scatter(stencil, tested[sample], job.stencil, samples, sample);
        }
    }
    if has_depth && tests.writes_depth() {
        place.set_depths(s, (&depths, &tested), job.depth, samples);
    }
}

/// Keeps the first of the samples, as many as alpha says: ⌊alpha·samples + ½⌋.
#[inline(always)]
fn keep_by_alpha<S: Lanes>(s: S, alpha: &Packet<f32>, masks: &mut [u16]) {
    let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
    let alpha = s.min_f32(
        s.max_f32(f32x16::load_array_ref(s, &alpha.0), splat(0.0)),
        splat(1.0),
    );
    let kept = s.floor_f32(alpha * masks.len() as f32 + 0.5);
    for (sample, mask) in (0u8..).zip(masks) {
        *mask &= s.bits_of_mask(splat(f32::from(sample)).simd_lt(kept));
    }
}

/// Keeps the samples that the shader keeps.
#[inline(always)]
fn keep_by_mask(kept: &Packet<u32>, masks: &mut [u16]) {
    for (sample, mask) in masks.iter_mut().enumerate() {
        for lane in 0..LANES {
            if kept.0[lane] >> sample & 1 == 0 {
                *mask &= !(1 << lane);
            }
        }
    }
}
