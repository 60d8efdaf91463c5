//! Triangles that have one colour: shaded once for each tile, and stored without a shader call.

use super::Resolver;
use crate::pipeline::color_target::MAX_WORDS;
use crate::raster::Covered;
use crate::tile_pass::TileScratch;
use crate::tile_pass::visibility::ONLY_WIDE;
use estampe_simd::{LANES, Lanes, Select, SimdBase, dispatch, u32x16};

impl<const N: usize> Resolver<'_, '_, '_, N> {
    /// Stores the one texel of a triangle in the block of 16×16 pixels that begins with a packet.
    #[inline(always)]
    pub(super) fn fill_block<S: Lanes>(&mut self, s: S, id: u32, first_packet: usize) {
        let visible = self.texels_of(id);
        self.scratch.statistics.fragments_shaded += 256;
        let targets = self.plan.pipeline.color_targets();
        let resolve = &self.scratch.visibility.resolve;
        let texels = resolve.texels.get(visible, targets.len());
        for (texel, stored) in texels.unwrap_or_default().iter().zip(&mut self.job.colors) {
            let of_packet = stored.len() / self.packets;
            let lines = &mut stored[first_packet * of_packet..][..LANES * of_packet];
            let words = of_packet / self.samples.count();
            let splat = |word| <u32x16<S> as SimdBase<S>>::splat(s, word);
            if words == 1 {
                let value = splat(texel[0]);
                for line in lines {
                    value.store_array(line);
                }
            } else {
                for lines in lines.chunks_exact_mut(words) {
                    for (line, word) in lines.iter_mut().zip(texel) {
                        splat(*word).store_array(line);
                    }
                }
            }
        }
    }

    /// Stores the one texel of a triangle in the lanes of a packet.
    #[inline(always)]
    pub(super) fn fill<S: Lanes>(&mut self, s: S, id: u32, covered: &Covered<N>) {
        let visible = self.texels_of(id);
        self.scratch.statistics.fragments_shaded += u64::from(covered.any().count_ones());
        let targets = self.plan.pipeline.color_targets();
        let resolve = &self.scratch.visibility.resolve;
        let texels = resolve.texels.get(visible, targets.len());
        let sizes = [self.packets, self.samples.count()];
        let colors = &mut self.job.colors;
        store_texels(s, texels.unwrap_or_default(), covered, sizes, colors);
    }

    /// The place in `visible` of a triangle that has one colour, whose texels are known afterwards.
    #[inline(always)]
    fn texels_of(&mut self, id: u32) -> usize {
        let visible = self.visible(id);
        let targets = self.plan.pipeline.color_targets().len();
        let resolve = &self.scratch.visibility.resolve;
        if resolve.texels.get(visible, targets).is_none() {
            self.shade_primitive(visible);
        }
        visible
    }

    /// Shades one packet of a triangle that has one colour, and keeps its texels.
    #[inline(never)]
    fn shade_primitive(&mut self, visible: usize) {
        debug_assert!(self.scratch.queue.is_empty(), "one packet is shaded alone");
        let any = Covered {
            packet: 0,
            masks: self.samples.whole(),
        };
        dispatch!(@wide self.pass.level, s => self.push(s, visible, &any),
            scalar => unreachable!("{ONLY_WIDE}"));
        let TileScratch {
            queue, visibility, ..
        } = &mut *self.scratch;
        queue.shade(self.pass.level, self.plan.pipeline, self.plan.bindings);
        let packet = queue.batch().packets().next();
        let packet = packet.expect("a packet was queued");
        let targets = self.plan.pipeline.color_targets().iter();
        let texels = targets.map(|target| {
            let color = packet
                .color(target.output)
                .each_ref()
                .map(|channel| channel.0[0]);
            target.texel(color)
        });
        visibility.resolve.texels.set(visible, texels);
        queue.clear();
    }
}

/// Stores one texel of each target in the lanes of a packet; the tile has so many packets, and so
/// many samples of a pixel.
#[inline(always)]
pub(super) fn store_texels<S: Lanes, const N: usize>(
    s: S,
    texels: &[[u32; MAX_WORDS]],
    covered: &Covered<N>,
    [packets, samples]: [usize; 2],
    colors: &mut [&mut [[u32; LANES]]],
) {
    for (texel, stored) in texels.iter().zip(colors) {
        let words = stored.len() / packets / samples;
        for (sample, mask) in covered.masks.iter().enumerate().take(samples) {
            let line = (usize::from(covered.packet) * samples + sample) * words;
            for (stored, word) in stored[line..].iter_mut().zip(texel).take(words) {
                let old = u32x16::load_array_ref(s, stored);
                let new = <u32x16<S> as SimdBase<S>>::splat(s, *word);
                let new = s.mask_from_bits(*mask).select(new, old);
                new.store_array(stored);
            }
        }
    }
}
