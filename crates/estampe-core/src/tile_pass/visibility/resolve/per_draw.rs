//! Draws of one colour: nothing varies over a draw, so it is shaded once for each tile, and the
//! colours of all such draws are stored in one pass over the tile's packets.
//!
//! What may still differ between triangles is whether they face the viewer. One packet is shaded
//! for both: some of its quads face the viewer and some do not. Where the two colours differ, the
//! draw's samples are left to the passes by group.

use super::per_primitive::store_texels;
use super::{Resolver, ShadingGroup};
use crate::pipeline::color_target::MAX_WORDS;
use crate::raster::Covered;
use crate::tile_pass::TileScratch;
use estampe_simd::{Lanes, Packet};

/// The lanes that face the viewer in the packet that is shaded: whole quads, so that derivatives
/// are 0.
const FRONT_LANES: u16 = 0xF0F0;
/// A lane of that packet that faces the viewer, and one that does not.
const FRONT_AND_BACK: [usize; 2] = [4, 0];

/// The colour of a draw.
#[derive(Debug, Clone, Copy)]
enum DrawColor {
    /// It was not shaded yet.
    Unknown,
    /// It has several.
    Varies,
    /// The index of its first texel.
    One(usize),
}

/// By shading group, the texels of each target.
#[derive(Debug, Default)]
pub(super) struct DrawTexels {
    colors: Vec<DrawColor>,
    texels: Vec<[u32; MAX_WORDS]>,
}

impl<const N: usize> Resolver<'_, '_, '_, N> {
    /// Stores the samples of draws that have one colour. Returns false if others are left.
    #[inline(always)]
    pub(super) fn fill_draws<S: Lanes>(&mut self, s: S, groups: &[ShadingGroup]) -> bool {
        let draws = &mut self.scratch.visibility.resolve.draws;
        draws.texels.clear();
        draws.colors.clear();
        draws.colors.resize(groups.len(), DrawColor::Unknown);
        let mut is_done = true;
        for packet in 0..self.packets {
            let buffer = &self.scratch.visibility.buffer;
            if buffer.single.of_packet(packet).is_some() {
                is_done = false;
                continue;
            }
            let mut left = buffer.unresolved[packet];
            let mut others = [0; N];
            while left != [0; N] {
                let id = self.first_id(packet, &left);
                let number = self.group_of(id);
                let mut masks = left;
                for (sample, (mask, left)) in masks.iter_mut().zip(&mut left).enumerate() {
                    if *mask != 0 {
                        *mask &= self.lanes_in(s, self.line_of(packet, sample), &groups[number]);
                        *left &= !*mask;
                    }
                }
                if let Some(first) = self.texels_of_draw(&groups[number], number) {
                    self.store_draw(s, first, packet, masks);
                } else {
                    for (others, mask) in others.iter_mut().zip(masks) {
                        *others |= mask;
                    }
                }
            }
            is_done &= others == [0; N];
            self.scratch.visibility.buffer.unresolved[packet] = others;
        }
        is_done
    }

    /// Stores a draw's texels in samples of a packet.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "a tile has 256 packets")]
    fn store_draw<S: Lanes>(&mut self, s: S, first: usize, packet: usize, masks: [u16; N]) {
        let covered = Covered {
            packet: packet as u16,
            masks,
        };
        self.scratch.statistics.fragments_shaded += u64::from(covered.any().count_ones());
        let texels = &self.scratch.visibility.resolve.draws.texels[first..];
        let (packets, samples) = (self.packets, self.samples.count());
        let colors = &mut self.job.colors;
        store_texels(s, texels, &covered, [packets, samples], colors);
    }

    /// The index of a group's first texel, if the group has one colour.
    #[inline(always)]
    fn texels_of_draw(&mut self, group: &ShadingGroup, number: usize) -> Option<usize> {
        let draws = &self.scratch.visibility.resolve.draws;
        match draws.colors[number] {
            DrawColor::One(first) => Some(first),
            DrawColor::Varies => None,
            DrawColor::Unknown => self.shade_draw(group, number),
        }
    }

    /// Shades one packet of a group, and keeps its texels if it has one colour.
    #[inline(never)]
    fn shade_draw(&mut self, group: &ShadingGroup, number: usize) -> Option<usize> {
        let plan = &self.pass.plans[group.sub_draw as usize];
        let pipeline = plan.pipeline;
        let TileScratch {
            queue, visibility, ..
        } = &mut *self.scratch;
        let draws = &mut visibility.resolve.draws;
        draws.colors[number] = DrawColor::Varies;
        if !pipeline.key().uniform_over_draw {
            return None;
        }
        if !self.shaded_last.is_some_and(|last| last.is_same(pipeline)) {
            queue.configure(pipeline, self.samples, plan.tests.stored.range, false);
            self.shaded_last = Some(pipeline);
        }
        queue.push_across_triangles(u16::MAX, FRONT_LANES);
        queue.shade(self.pass.level, pipeline, plan.bindings);
        let packet = queue.batch().packets().next();
        let packet = packet.expect("a packet was queued");
        let first = draws.texels.len();
        for (index, target) in pipeline.color_targets().iter().enumerate() {
            let color = packet.color(index);
            if color.iter().any(is_different) {
                queue.clear();
                return None;
            }
            let color = color.each_ref().map(|channel| channel.0[0]);
            draws.texels.push(target.texel(color));
        }
        queue.clear();
        draws.colors[number] = DrawColor::One(first);
        Some(first)
    }
}

/// Returns true if a channel depends on whether a triangle faces the viewer.
fn is_different(channel: &Packet<f32>) -> bool {
    let [front, back] = FRONT_AND_BACK.map(|lane| channel.0[lane].to_bits());
    front != back
}
