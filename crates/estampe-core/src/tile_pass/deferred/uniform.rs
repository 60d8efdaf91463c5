//! Shading a run whose triangles each have one colour: once for each triangle.

use super::super::TileScratch;
use super::Deferred;
use super::shade::{NONE, Shading, surface_of};
use crate::per_sample::color::write_code;
use crate::per_sample::depth::line_mut;
use crate::per_sample::visibility::ONLY_WIDE;
use crate::raster::{Covered, MAX_PACKETS, packet_origin};
use estampe_simd::{LANES, Lanes, SimdBase, dispatch, u32x16};

impl<const N: usize> Shading<'_, '_, '_, N> {
    /// Shades the run.
    pub(super) fn shade_uniform(&mut self) {
        let level = self.pass.level;
        dispatch!(@wide level, s => self.uniform(s), scalar => unreachable!("{ONLY_WIDE}"));
        self.flush_uniform();
        dispatch!(@wide level, s => self.write_codes(s), scalar => unreachable!("{ONLY_WIDE}"));
    }

    /// Shades one packet of every triangle that is seen.
    #[inline(always)]
    fn uniform<S: Lanes>(&mut self, s: S) {
        let (mut last, mut next) = (NONE, 0u16);
        while usize::from(next) < MAX_PACKETS {
            let (packet, number_of_packet) = (usize::from(next) % MAX_PACKETS, next);
            let visibility = &self.scratch.deferred.visibility;
            let (mut pending, owner) = (
                visibility.pending[packet],
                visibility.owners.of_packet(packet),
            );
            next += if owner.is_some() { 16 } else { 1 };
            if owner.is_some_and(|owner| owner != last) {
                pending = [u16::MAX; N];
            }
            // Large triangles: most packets show the one before.
            for (sample, pending) in pending.iter_mut().enumerate() {
                if *pending != 0 && owner.is_none() {
                    *pending &= !self.lanes_of(s, packet * N + sample, last);
                }
            }
            while pending != [0; N] {
                let (number, masks) = match owner {
                    Some(number) => (number, std::mem::replace(&mut pending, [0; N])),
                    None => self.next_seen(s, packet, &mut pending),
                };
                last = number;
                let known = self.scratch.deferred.shown.len();
                let shown = self.shown(s, number);
                if (shown as usize) < known {
                    continue;
                }
                if self.scratch.queue.is_full() {
                    self.flush_uniform();
                }
                let covered = Covered {
                    packet: number_of_packet,
                    masks,
                };
                let (x, y) = packet_origin(u32::from(number_of_packet));
                let pixel = [self.origin[0] + x, self.origin[1] + y];
                let TileScratch {
                    queue, deferred, ..
                } = &mut *self.scratch;
                let (surface, front) =
                    surface_of(deferred, (self.modes, self.item.all_smooth), shown as usize);
                queue.push(s, &surface, (covered, pixel), front, self.needs);
            }
        }
    }

    /// Shades what is queued; the first lane's colours are the triangles', in the order of `shown`.
    fn flush_uniform(&mut self) {
        let queue = &mut self.scratch.queue;
        if queue.is_empty() {
            return;
        }
        queue.shade(self.pass.level, self.item.pipeline, self.item.bindings);
        let codes = &mut self.scratch.deferred.codes;
        for shaded in queue.drain(false) {
            let targets = self.item.targets.iter().flatten();
            for (target, colors) in targets.zip(shaded.colors.chunks_exact(4)) {
                codes.push(target.code([0, 1, 2, 3].map(|channel| colors[channel].0[0])));
            }
        }
    }

    /// Puts triangles' colours in the place of their numbers.
    #[inline(always)]
    fn write_codes<S: Lanes>(&mut self, s: S) {
        let Deferred {
            visibility,
            shown_of,
            shown,
            codes,
            ..
        } = &mut self.scratch.deferred;
        let targets = codes.len() / shown.len().max(1);
        let (mut fragments, mut last) = (0, (NONE, 0));
        let mut next = 0;
        while next < MAX_PACKETS {
            let packet = next % MAX_PACKETS;
            if let Some(number) = visibility.owners.of_packet(packet) {
                // A block that shows one triangle.
                next += LANES;
                fragments += 256;
                let shown = shown_of.get(number as usize).copied().unwrap_or(0) as usize;
                for (target, stored) in (0..targets).zip(&mut self.job.colors) {
                    let code = codes.get(shown * targets + target).copied().unwrap_or(0);
                    let code = <u32x16<S> as SimdBase<S>>::splat(s, code);
                    let lines = stored.get_mut(packet * N * LANES..(packet + LANES) * N * LANES);
                    for line in lines.unwrap_or_default().as_chunks_mut::<LANES>().0 {
                        code.store_array(line);
                    }
                }
                continue;
            }
            next += 1;
            let pending = visibility.pending[packet];
            let any = pending.iter().fold(0, |any, mask| any | mask);
            if any == 0 {
                continue;
            }
            fragments += u64::from(any.count_ones());
            for (sample, mask) in pending.into_iter().enumerate() {
                let at = packet * N + sample;
                let Some(line) = line_mut(self.job.colors[0], at) else {
                    continue;
                };
                if targets == 1 {
                    // Large triangles: most packets show one, and mostly that of the packet before.
                    let old = u32x16::load_array_ref(s, line);
                    if lanes_that_are(s, old, last.0) & mask != mask {
                        let number = line[mask.trailing_zeros() as usize % LANES];
                        let shown = shown_of.get(number as usize).copied().unwrap_or(0) as usize;
                        last = (number, codes.get(shown).copied().unwrap_or(0));
                    }
                    if lanes_that_are(s, old, last.0) & mask == mask {
                        write_code(s, last.1, mask, line);
                        continue;
                    }
                }
                let numbers = *line;
                let first = numbers[mask.trailing_zeros() as usize % LANES];
                let same = u32x16::load_array(s, numbers)
                    .simd_eq(<u32x16<S> as SimdBase<S>>::splat(s, first));
                let is_one = s.bits_of_mask(same) & mask == mask;
                for (target, stored) in (0..targets).zip(&mut self.job.colors) {
                    let Some(line) = line_mut(stored, at) else {
                        continue;
                    };
                    let code = |number: u32| {
                        let shown = shown_of.get(number as usize).copied().unwrap_or(0) as usize;
                        codes.get(shown * targets + target).copied().unwrap_or(0)
                    };
                    if is_one {
                        write_code(s, code(first), mask, line);
                        continue;
                    }
                    let mut lanes = mask;
                    while lanes != 0 {
                        let lane = lanes.trailing_zeros() as usize % LANES;
                        lanes &= lanes - 1;
                        line[lane] = code(numbers[lane]);
                    }
                }
            }
        }
        self.scratch.statistics.fragments_shaded += fragments;
    }
}

/// The lanes that hold a number.
#[inline(always)]
fn lanes_that_are<S: Lanes>(s: S, numbers: u32x16<S>, number: u32) -> u16 {
    s.bits_of_mask(numbers.simd_eq(<u32x16<S> as SimdBase<S>>::splat(s, number)))
}
