//! The covered quads of a primitive: the fragment shader, then the per-sample operations.

use super::Pass;
use crate::cull::Face;
use crate::fragment::{Invocation, Surface, sample_depth, shade_quad};
use crate::observer::{FragmentEvent, SampleEvent};
use crate::per_sample::{self, Outcome};
use crate::raster::{self, QuadCoverage, sample_positions};

impl Pass<'_> {
    /// Shades quads, per pixel or per sample.
    pub(super) fn fragments(&mut self, quads: &[QuadCoverage], surface: &dyn Surface, face: Face) {
        let samples = self.target.samples;
        let inside = self.viewport_samples.clone();
        let kept = |pixel: [u32; 2], covered: u16| {
            let mut kept = 0;
            for (s, &position) in sample_positions(samples).iter().enumerate() {
                let at = raster::sample_subpixel(pixel.map(i64::from), position);
                let is_masked = self.state.sample_mask >> s & 1 == 1;
                kept |= u16::from(is_masked && inside.contains(at)) << s;
            }
            covered & kept
        };
        let kept = |quad: &QuadCoverage| {
            [0, 1, 2, 3]
                .map(|lane| kept(QuadCoverage::pixel(quad.origin, lane), quad.samples[lane]))
        };
        let coverages: Vec<[u16; 4]> = quads.iter().map(kept).collect();
        for (quad, coverage) in quads.iter().zip(coverages) {
            let whole = Invocation {
                origin: quad.origin,
                coverage,
                samples,
                sample: None,
                front_facing: face == Face::Front,
            };
            if self.is_by_sample {
                for sample in 0..samples {
                    let sample = Some(sample);
                    self.shade(&Invocation { sample, ..whole }, surface, face);
                }
            } else {
                self.shade(&whole, surface, face);
            }
        }
    }

    /// Runs the fragment shader once on a quad, unless no sample of it is covered, and passes the
    /// results to the per-sample operations.
    fn shade(&mut self, invocation: &Invocation, surface: &dyn Surface, face: Face) {
        let kept = [0, 1, 2, 3].map(|lane| invocation.samples_of(lane));
        if kept == [0; 4] {
            return;
        }
        let viewport = self.viewport;
        let clamp_depth = |depth| viewport.clamp_depth(depth);
        let (shaders, interface) = (self.shaders, self.interface);
        let shaded = shade_quad(shaders, self.bindings, surface, invocation, clamp_depth);
        for (lane, mut fragment) in shaded.into_iter().enumerate() {
            let pixel = QuadCoverage::pixel(invocation.origin, lane);
            if let Some(factor) = surface.alpha(pixel) {
                for [_, _, _, alpha] in &mut fragment.colors {
                    *alpha *= factor;
                }
            }
            let fragment = &fragment;
            let covered = kept[lane];
            self.counts.fragments += u64::from(covered != 0);
            self.counts.samples_covered += u64::from(covered.count_ones());
            let stored = if fragment.is_discarded {
                0
            } else {
                covered & per_sample::kept_samples(fragment, self.state, self.target)
            };
            if covered != 0 {
                self.observer.fragment(&FragmentEvent {
                    pixel,
                    lane,
                    invocation,
                    covered,
                    stored,
                    surface,
                    bindings: self.bindings,
                    clamp_depth: &clamp_depth,
                    fragment,
                });
            }
            for (s, &sample) in (0u32..).zip(sample_positions(invocation.samples)) {
                if stored >> s & 1 == 0 {
                    continue;
                }
                let interpolated = clamp_depth(surface.depth(pixel, sample));
                let depth = sample_depth(interface.depth_output, fragment.depth, interpolated);
                let index = self.target.index(pixel, s);
                let before = self
                    .observer
                    .wants(pixel)
                    .then(|| self.target.sample(index));
                let outcome =
                    per_sample::store_sample(self.target, index, self.state, face, depth, fragment);
                if let Some(before) = before {
                    self.observer.sample(SampleEvent {
                        sample: s,
                        depth: self.target.quantised(depth),
                        outcome,
                        before,
                        after: self.target.sample(index),
                    });
                }
                self.counts.samples_passed += u64::from(outcome == Outcome::Passed);
            }
        }
    }
}
