//! Triangles of one colour that follow each other: the fan of a rounded panel, a window.
//!
//! Nothing varies over such a triangle, so all of its fragments have one colour, and so have those
//! of the next one if its varyings are the same. Their coverage is gathered until a primitive comes
//! that differs or overlaps. Then one packet is shaded for all of them, and the pixels of a packet
//! that several triangles share are written together.
//!
//! Gathered pixels are disjoint, so no order among them can be seen. The queue holds what was drawn
//! before: it is written first if it has a fragment at one of the pixels; otherwise it may wait.

use super::InOrder;
use super::solid_colors::Blending;
use crate::fragment::queue::FragmentQueue;
use crate::per_sample::solid_blend::SolidBlend;
use crate::raster::packet_masks::PacketMasks;
use crate::statistics::Statistics;
use crate::tile_pass::write_colors;
use estampe_simd::LANES;

/// So many packets are worth to ask how a colour is blended that is seen for the first time.
const PACKETS_TO_ASK: u32 = 32;

/// Gathered coverage of triangles that have one colour.
#[derive(Debug, Default)]
pub(super) struct Solid<const N: usize> {
    shown: SolidInputs,
    covered: PacketMasks<N>,
}

/// The inputs of the colour of primitives over which nothing varies: the varyings of all fragments,
/// and whether the primitives face the viewer.
#[derive(Debug, Default)]
pub(super) struct SolidInputs {
    pub(super) varyings: Vec<f32>,
    pub(super) front: bool,
}

impl SolidInputs {
    #[inline(always)]
    pub(super) fn are(&self, varyings: &[f32], front: bool) -> bool {
        let pairs = self.varyings.iter().zip(varyings);
        self.front == front
            && self.varyings.len() == varyings.len()
            && pairs.fold(true, |all, (a, b)| all & (a.to_bits() == b.to_bits()))
    }

    #[inline(always)]
    pub(super) fn set(&mut self, varyings: &[f32], front: bool) {
        self.varyings.clear();
        self.varyings.extend_from_slice(varyings);
        self.front = front;
    }
}

impl<const N: usize> Solid<N> {
    /// Returns true if a packet of the queue has a fragment at a gathered pixel.
    #[inline(always)]
    fn overlaps(&self, queue: &FragmentQueue<N>) -> bool {
        let mut queued = queue.queued();
        queued.any(|(place, pixels)| place.overlaps(pixels, |packet| self.covered.any(packet)))
    }
}

impl<const N: usize> InOrder<'_, '_, '_, '_, N> {
    /// Gathers the list of a triangle whose varyings are the same at all pixels.
    #[inline(always)]
    pub(super) fn gather(&mut self, varyings: &[f32], front: bool) {
        let scratch = &self.scratch.in_order;
        let (solid, items) = (&scratch.solid, scratch.list.items());
        let is_same = solid.shown.are(varyings, front);
        if !is_same || solid.covered.overlaps(items) {
            self.end_solid();
        } else if !solid.covered.is_empty() {
            self.scratch.statistics.triangles_gathered += 1;
        }
        let scratch = &mut self.scratch.in_order;
        let solid = &mut scratch.solid;
        if !is_same {
            solid.shown.set(varyings, front);
        }
        solid.covered.add(scratch.list.items());
    }

    /// Shades and writes what is gathered, before something else is drawn.
    #[inline(always)]
    pub(super) fn end_solid(&mut self) {
        if !self.scratch.in_order.solid.covered.is_empty() {
            self.write_solid();
        }
    }

    #[inline(never)]
    fn write_solid(&mut self) {
        if self.scratch.in_order.solid.overlaps(&self.scratch.queue) {
            self.flush();
        }
        match self.blend_solid() {
            Blending::Line(line) => self.write_line(&line),
            Blending::Unknown | Blending::Formula => self.write_shaded_solid(),
        }
        self.scratch.solid_queue.clear();
    }

    /// How the gathered colour is blended. Unless that is a line, the colour is in its queue.
    fn blend_solid(&mut self) -> Blending {
        let (plan, level) = (self.work.plan, self.work.level);
        let scratch = &mut *self.scratch;
        let (solid, queue) = (&scratch.in_order.solid, &mut scratch.solid_queue);
        let (varyings, front) = (solid.shown.varyings.as_slice(), solid.shown.front);
        let kept = &mut scratch.in_order.solid_colors;
        let (place, found) = kept.find(varyings, front);
        let mut is_worth_asking = solid.covered.packets() >= PACKETS_TO_ASK;
        if let Some(found) = found {
            scratch.statistics.colors_kept += 1;
            if let Blending::Line(_) = found.blending {
                return found.blending;
            }
            queue.set_solid_colors(found.color);
            if let Blending::Formula = found.blending {
                return found.blending;
            }
            is_worth_asking = true;
        } else {
            queue.shade_solid(level, plan.pipeline, plan.bindings, (varyings, front));
            kept.keep(place, (varyings, front), queue.solid_colors());
        }
        let targets = plan.pipeline.color_targets();
        let mut blending = Blending::Unknown;
        if is_worth_asking && let [target] = targets {
            let color = queue.solid_color(target.output);
            let line = color.and_then(|color| SolidBlend::new(level, target, color));
            blending = line.map_or(Blending::Formula, Blending::Line);
            kept.keep_blending(place, blending);
        }
        blending
    }

    /// Writes what is gathered by a line.
    fn write_line(&mut self, line: &SolidBlend) {
        let (samples, level) = (self.samples.count(), self.work.level);
        let covered = &mut self.scratch.in_order.solid.covered;
        let fragments = line.write(level, covered, samples, self.job.colors[0]);
        let statistics = &mut self.scratch.statistics;
        statistics.fragments_blended_by_lines += fragments;
        count_solid(statistics, fragments);
    }

    /// Writes what is gathered with the colour in its queue.
    fn write_shaded_solid(&mut self) {
        let (plan, level) = (self.work.plan, self.work.level);
        let scratch = &mut *self.scratch;
        let queue = &mut scratch.solid_queue;
        let colors = &mut self.job.colors;
        let mut fragments = 0;
        scratch.in_order.solid.covered.take_each(|packet, masks| {
            if queue.is_full() {
                write_colors(plan, level, &queue.batch(), colors);
                queue.empty_solid();
            }
            queue.push_solid(packet, masks);
            let any = masks.iter().fold(0, |any, mask| any | mask);
            fragments += u64::from(any.count_ones());
        });
        write_colors(plan, level, &queue.batch(), colors);
        count_solid(&mut scratch.statistics, fragments);
    }
}

/// Counts fragments of one colour.
fn count_solid(statistics: &mut Statistics, fragments: u64) {
    statistics.fragments_shaded += fragments;
    statistics.fragments_of_shared_colors += fragments.saturating_sub(LANES as u64);
}
