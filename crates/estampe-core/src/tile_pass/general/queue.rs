//! Packets of fragments that wait to be shaded together, for any number of samples.

use crate::fragment::interpolate::{Places, Surface};
use crate::fragment::queue::{CAPACITY, clamp_depth};
use crate::per_sample::texel::Numbers;
use crate::pipeline::RenderPipeline;
use crate::raster::general::{MAX_SAMPLES, SampleCoverage};
use estampe_simd::{LANE_X, LANE_Y, LANES, Lanes, Level, Packet, SimdBase, f32x16};
use estampe_types::shader::{DepthOutput, Sampling};
use estampe_types::{Bindings, FragmentBatch};

/// Where a packet of fragments is, and which of its samples.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    /// What the primitive covers, less the samples that may not change.
    pub(super) coverage: SampleCoverage,
    /// What of that has passed the tests so far.
    pub(super) alive: SampleCoverage,
    /// The packet's first pixel in the target.
    pub(super) pixel: [i32; 2],
    pub(super) front: bool,
    /// The sample that is shaded, where shading is by sample.
    pub(super) sample: Option<u32>,
}

/// Shader inputs and outputs of up to [`CAPACITY`] packets, structure of arrays.
#[derive(Debug, Default)]
pub(super) struct GeneralQueue {
    places: Vec<Place>,
    samples: usize,
    scalars: usize,
    targets: usize,
    /// Colours of a fragment: its targets', and the second one.
    colors_each: usize,
    depth_output: DepthOutput,
    /// Where each scalar is sampled; empty if all are at the centre.
    sampling: Vec<Sampling>,
    needs: Needs,
    varyings: Vec<Packet<f32>>,
    /// Varyings of one packet at other places.
    spare: Vec<Packet<f32>>,
    positions: Vec<Packet<f32>>,
    front_facing: Vec<u16>,
    sample_index: Vec<u32>,
    samples_covered: Vec<Packet<u32>>,
    coverage: Vec<u16>,
    /// Depths of each sample, where tests come after shading.
    depths: Vec<[f32; LANES]>,
    colors: Vec<Packet<f32>>,
    depth_out: Vec<Packet<f32>>,
    sample_masks: Vec<Packet<u32>>,
}

/// Which inputs and outputs the program has.
#[derive(Debug, Clone, Copy, Default)]
struct Needs {
    position: bool,
    sample_index: bool,
    coverage: bool,
    sample_mask: bool,
}

impl GeneralQueue {
    /// Gets ready for a pipeline's packets. The queue must be empty.
    pub(super) fn configure(&mut self, pipeline: &RenderPipeline, samples: usize) {
        let interface = pipeline.interface();
        debug_assert!(
            self.places.is_empty(),
            "packets of another pipeline are still queued"
        );
        self.samples = samples;
        self.scalars = interface.varyings.len();
        self.targets = interface.color_targets;
        self.colors_each = interface.colors();
        self.depth_output = interface.depth_output;
        self.sampling.clear();
        if interface.sampling.contains(&Sampling::Centroid) {
            self.sampling.extend(&interface.sampling);
            // A program of a caller's own may list fewer or more than it has.
            self.sampling.resize(self.scalars, Sampling::Center);
        }
        self.needs = Needs {
            position: interface.reads_position,
            sample_index: interface.per_sample,
            coverage: interface.reads_coverage,
            sample_mask: interface.writes_sample_mask,
        };
        let of = |needed: bool, each: usize| if needed { each * CAPACITY } else { 0 };
        let zero = Packet::default();
        self.varyings.resize(of(true, self.scalars), zero);
        self.spare.resize(self.scalars, zero);
        self.positions.resize(of(self.needs.position, 4), zero);
        self.front_facing.resize(CAPACITY, 0);
        self.sample_index.resize(of(self.needs.sample_index, 1), 0);
        self.samples_covered
            .resize(of(self.needs.coverage, 1), Packet::default());
        self.coverage.resize(CAPACITY, 0);
        self.depths.resize(of(true, samples), [0.0; LANES]);
        self.colors.resize(of(true, self.colors_each * 4), zero);
        let writes_depth = self.depth_output != DepthOutput::None;
        self.depth_out.resize(of(writes_depth, 1), zero);
        self.sample_masks
            .resize(of(self.needs.sample_mask, 1), Packet::default());
    }

    pub(super) fn is_full(&self) -> bool {
        self.places.len() >= CAPACITY
    }

    pub(super) fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Queues a packet; `keeps_depths` where tests come after shading.
    #[inline(always)]
    pub(super) fn push<S: Lanes>(
        &mut self,
        s: S,
        surface: &impl Surface<S>,
        place: &Place,
        (offsets, keeps_depths, depth_range): (&[[f32; 2]], bool, [f32; 2]),
    ) {
        let slot = self.places.len() % CAPACITY;
        self.places.push(*place);
        let pixel = place.pixel;
        self.coverage[slot] = match place.sample {
            Some(sample) => place.alive.masks[sample as usize % MAX_SAMPLES],
            None => place.alive.any(),
        };
        self.front_facing[slot] = if place.front { u16::MAX } else { 0 };
        let offset = place
            .sample
            .and_then(|sample| offsets.get(sample as usize))
            .copied();
        let out = &mut self.varyings[slot * self.scalars..][..self.scalars];
        match offset {
            _ if out.is_empty() => {}
            Some(offset) => surface.varyings_in(s, pixel, &Places::all(offset), out),
            None => surface.varyings(s, pixel, out),
        }
        if offset.is_none() && !self.sampling.is_empty() {
            let places = centroids(&place.coverage, offsets);
            surface.varyings_in(s, pixel, &places, &mut self.spare);
            for ((out, spare), sampling) in out.iter_mut().zip(&self.spare).zip(&self.sampling) {
                if *sampling == Sampling::Centroid {
                    *out = *spare;
                }
            }
        }
        if self.needs.position {
            let at = offset.unwrap_or([0.5; 2]);
            let out = &mut self.positions[slot * 4..][..4];
            for (lane, (dx, dy)) in LANE_X.iter().zip(&LANE_Y).enumerate() {
                out[0].0[lane] = (pixel[0] + i32::from(*dx)) as f32 + at[0];
                out[1].0[lane] = (pixel[1] + i32::from(*dy)) as f32 + at[1];
            }
            let depth = clamp_depth(s, surface.depth(s, pixel, at), depth_range);
            depth.store_array(&mut out[2].0);
            let inverse_w = surface.inverse_w_at(s, pixel, &Places::all(at));
            inverse_w.store_array(&mut out[3].0);
        }
        if self.needs.sample_index {
            self.sample_index[slot] = place.sample.unwrap_or(0);
        }
        if self.needs.coverage {
            self.samples_covered[slot] = covered_bits(place);
        }
        if keeps_depths {
            let depths = &mut self.depths[slot * self.samples..][..self.samples];
            for (depth, offset) in depths.iter_mut().zip(offsets) {
                let value: f32x16<S> = surface.depth(s, pixel, *offset);
                clamp_depth(s, value, depth_range).store_array(depth);
            }
        }
    }

    /// Runs the program over what is queued, and says how many fragments that were.
    pub(super) fn shade(
        &mut self,
        level: Level,
        pipeline: &RenderPipeline,
        bindings: &Bindings,
    ) -> u64 {
        let len = self.places.len().min(CAPACITY);
        let fragments = self.coverage[..len].iter();
        let fragments = fragments.map(|mask| u64::from(mask.count_ones())).sum();
        let of = |needed: bool, each: usize| if needed { len * each } else { 0 };
        let writes_depth = self.depth_output != DepthOutput::None;
        pipeline.program().run_fragments(
            level,
            bindings,
            FragmentBatch {
                varyings: &self.varyings[..len * self.scalars],
                positions: &self.positions[..of(self.needs.position, 4)],
                front_facing: &self.front_facing[..len],
                sample_index: &self.sample_index[..of(self.needs.sample_index, 1)],
                samples_covered: &self.samples_covered[..of(self.needs.coverage, 1)],
                coverage: &mut self.coverage[..len],
                colors: &mut self.colors[..len * self.colors_each * 4],
                depths: &mut self.depth_out[..of(writes_depth, 1)],
                sample_masks: &mut self.sample_masks[..of(self.needs.sample_mask, 1)],
            },
        );
        fragments
    }

    /// Multiplies the alpha of every target's colour by a factor for each pixel of the packets at hand.
    pub(super) fn scale_alpha(&mut self, factors: impl Fn([i32; 2]) -> Packet<f32>) {
        for (slot, place) in self.places.iter().enumerate().take(CAPACITY) {
            let factors = factors(place.pixel);
            let from = slot * self.colors_each * 4;
            for color in self.colors[from..][..self.targets * 4]
                .as_chunks_mut::<4>()
                .0
            {
                for (alpha, factor) in color[3].0.iter_mut().zip(factors.0) {
                    *alpha *= factor;
                }
            }
        }
    }

    /// How many packets there are.
    pub(super) fn len(&self) -> usize {
        self.places.len().min(CAPACITY)
    }

    /// Forgets the packets.
    pub(super) fn clear(&mut self) {
        self.places.clear();
    }

    /// A shaded packet.
    #[inline(always)]
    pub(super) fn shaded(&self, slot: usize) -> Shaded<'_> {
        let place = &self.places[slot];
        let mut alive = place.alive;
        for (sample, mask) in alive.masks.iter_mut().enumerate() {
            let is_shaded = place.sample.is_none_or(|of| of as usize == sample);
            *mask &= if is_shaded { self.coverage[slot] } else { 0 };
        }
        Shaded {
            alive,
            front: place.front,
            colors: &self.colors[slot * self.colors_each * 4..][..self.colors_each * 4],
            targets: self.targets,
            depths: &self.depths[slot * self.samples..][..self.samples],
            depth_output: self.depth_output,
            depth_out: self.depth_out.get(slot),
            sample_mask: self.sample_masks.get(slot),
        }
    }
}

/// A shaded packet.
#[derive(Debug)]
pub(super) struct Shaded<'a> {
    /// The samples that are covered, alive and not discarded.
    pub(super) alive: SampleCoverage,
    pub(super) front: bool,
    colors: &'a [Packet<f32>],
    targets: usize,
    depths: &'a [[f32; LANES]],
    depth_output: DepthOutput,
    depth_out: Option<&'a Packet<f32>>,
    sample_mask: Option<&'a Packet<u32>>,
}

impl Shaded<'_> {
    /// The colour for a target; zeros beyond the last one.
    #[inline(always)]
    pub(super) fn color(&self, index: usize) -> Numbers {
        match self.colors.get(index * 4..index * 4 + 4) {
            Some([r, g, b, a]) if index < self.targets => [r.0, g.0, b.0, a.0],
            _ => [[0.0; LANES]; 4],
        }
    }

    /// The second colour; zeros if there is none.
    #[inline(always)]
    pub(super) fn second(&self) -> Numbers {
        match &self.colors[(self.targets * 4).min(self.colors.len())..] {
            [r, g, b, a] => [r.0, g.0, b.0, a.0],
            _ => [[0.0; LANES]; 4],
        }
    }

    /// Keeps the first of the samples, as many as the alpha of target 0 says.
    #[inline(always)]
    pub(super) fn keep_by_alpha(&mut self, samples: usize) {
        let [_, _, _, alpha] = self.color(0);
        for (sample, mask) in self.alive.masks.iter_mut().enumerate() {
            for (lane, &alpha) in alpha.iter().enumerate() {
                let positive = if alpha > 0.0 { alpha } else { 0.0 };
                let confined = if positive < 1.0 { positive } else { 1.0 };
                let kept = (confined * samples as f32 + 0.5).floor();
                if sample as f32 >= kept {
                    *mask &= !(1 << lane);
                }
            }
        }
    }

    /// Keeps the samples that the shader keeps.
    #[inline(always)]
    pub(super) fn keep_by_mask(&mut self) {
        let Some(kept) = self.sample_mask else {
            return;
        };
        for (sample, mask) in self.alive.masks.iter_mut().enumerate() {
            for (lane, kept) in kept.0.iter().enumerate() {
                if kept >> sample & 1 == 0 {
                    *mask &= !(1 << lane);
                }
            }
        }
    }

    /// The depth of a sample: interpolated, or the shader's as it declares it.
    #[inline(always)]
    pub(super) fn depth_of(&self, sample: usize, [low, high]: [f32; 2]) -> [f32; LANES] {
        let mut depths = self.depths[sample];
        let Some(written) = self.depth_out else {
            return depths;
        };
        for (depth, &written) in depths.iter_mut().zip(&written.0) {
            // NaN is the lower end.
            let above = if written > low { written } else { low };
            let written = if above < high { above } else { high };
            *depth = match self.depth_output {
                DepthOutput::Greater if *depth > written => *depth,
                DepthOutput::Less if *depth < written => *depth,
                _ => written,
            };
        }
        depths
    }
}

/// Where centroid varyings are interpolated: at the centre where all samples are covered or none, else at the
/// covered one of the lowest number.
fn centroids(coverage: &SampleCoverage, offsets: &[[f32; 2]]) -> Places {
    let mut places = Places::all([0.5; 2]);
    let masks = &coverage.masks[..offsets.len().min(MAX_SAMPLES)];
    let all = masks.iter().fold(u16::MAX, |all, mask| all & mask);
    for lane in 0..LANES {
        let first = masks.iter().position(|mask| mask >> lane & 1 == 1);
        if let (Some(first), 0) = (first, all >> lane & 1) {
            [places.x[lane], places.y[lane]] = offsets[first];
        }
    }
    places
}

/// By lane the covered samples, bit by bit; of a packet that is shaded by sample its own alone.
fn covered_bits(place: &Place) -> Packet<u32> {
    let mut bits = [0; LANES];
    for (sample, mask) in place.coverage.masks.iter().enumerate() {
        if place.sample.is_some_and(|own| own as usize != sample) {
            continue;
        }
        for (lane, bits) in bits.iter_mut().enumerate() {
            *bits |= u32::from(mask >> lane & 1) << sample;
        }
    }
    Packet(bits)
}
