//! Draws of one colour: nothing varies over a draw, so it is shaded once for each tile, and the
//! colours of all such draws are stored in one pass over the tile's packets.
//!
//! Triangles may still differ in whether they face the viewer. One packet is shaded
//! for both: some of its quads face the viewer and some do not. Where the two colours differ, the
//! draw's samples are left to the passes by group.

use super::ids::lanes_in;
use super::per_primitive::store_texels;
use super::{IdStorage, Resolver, ShadingGroup};
use crate::fragment::queue::packets_of_visibility;
use crate::per_sample::color_writer::ColorWriter;
use crate::pipeline::color_target::MAX_WORDS;
use crate::raster::Covered;
use crate::tile_pass::TileScratch;
use estampe_simd::{LANES, Lanes, Select, SimdBase, u32x16};
use estampe_types::{Bindings, BoundResource};
use std::hint::black_box;

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
    /// The texels of the packet that was shaded last, word by word.
    encoded: Vec<[u32; LANES]>,
}

impl<const N: usize> Resolver<'_, '_, '_, N> {
    /// Stores the samples of draws that have one colour. Returns false if others are left.
    #[inline(always)]
    pub(super) fn fill_draws<S: Lanes>(&mut self, s: S, groups: &[ShadingGroup]) -> bool {
        let draws = &mut self.scratch.visibility.resolve.draws;
        draws.texels.clear();
        draws.colors.clear();
        draws.colors.resize(groups.len(), DrawColor::Unknown);
        let plans = self.pass.plans;
        let words = groups.iter().map(|group| {
            let plan = &plans[group.sub_draw as usize];
            first_uniform(plan.bindings)
        });
        black_box(words.fold(0, u32::wrapping_add));
        let mut is_done = true;
        let targets = self.pass.plans[groups[0].sub_draw as usize]
            .pipeline
            .color_targets();
        let is_one_word = N == 1 && targets.len() == 1 && self.storage == IdStorage::Attachment;
        for packet in 0..self.packets {
            let buffer = &self.scratch.visibility.buffer;
            if buffer.single.of_packet(packet).is_some() {
                is_done = false;
                continue;
            }
            let mut left = buffer.unresolved[packet];
            let mut others = [0; N];
            if is_one_word {
                others[0] = self.fill_words(s, groups, (packet, left[0]));
                left = [0; N];
            }
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

    /// Stores the texels of a packet of one sample a pixel, in place of ids in the only attachment.
    /// Returns the lanes that are left.
    #[inline(always)]
    fn fill_words<S: Lanes>(
        &mut self,
        s: S,
        groups: &[ShadingGroup],
        (packet, unresolved): (usize, u16),
    ) -> u16 {
        let (mut left, mut others) = (unresolved, 0);
        if left == 0 {
            return 0;
        }
        let ids = u32x16::load_array_ref(s, &self.job.colors[0][packet]);
        let mut words = ids;
        while left != 0 {
            let id = self.job.colors[0][packet][left.trailing_zeros() as usize % LANES];
            let number = self.group_of(id);
            let group = &groups[number];
            let mask = lanes_in(s, ids, group) & left;
            left &= !mask;
            if let Some(first) = self.texels_of_draw(group, number) {
                let word = self.scratch.visibility.resolve.draws.texels[first][0];
                let word = <u32x16<S> as SimdBase<S>>::splat(s, word);
                words = s.mask_from_bits(mask).select(word, words);
            } else {
                others |= mask;
            }
        }
        words.store_array(&mut self.job.colors[0][packet]);
        self.scratch.statistics.fragments_shaded += u64::from((unresolved & !others).count_ones());
        others
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
            queue.configure(
                pipeline,
                self.samples,
                plan.tests.stored.range,
                (false, packets_of_visibility(pipeline)),
            );
            self.shaded_last = Some(pipeline);
        }
        queue.push_across_triangles(u16::MAX, FRONT_LANES);
        queue.shade(self.pass.level, pipeline, plan.bindings);
        let first = draws.texels.len();
        for (index, target) in pipeline.color_targets().iter().enumerate() {
            let constant = plan.blend_constant;
            let writer = ColorWriter {
                target,
                index,
                constant,
            };
            draws.encoded.clear();
            writer.encode_batch(self.pass.level, &queue.batch(), &mut draws.encoded);
            let mut texel = [0; MAX_WORDS];
            for (word, lanes) in texel.iter_mut().zip(&draws.encoded) {
                let [front, back] = FRONT_AND_BACK.map(|lane| lanes[lane]);
                if front != back {
                    queue.clear();
                    return None;
                }
                *word = front;
            }
            draws.texels.push(texel);
        }
        queue.clear();
        draws.colors[number] = DrawColor::One(first);
        Some(first)
    }
}

/// A word of the first buffer that some bindings name. To read it brings the uniforms of a draw to
/// the cache: of many draws at once, where shading would wait for one after the other.
#[inline(always)]
fn first_uniform(bindings: &Bindings) -> u32 {
    let Some(bound) = bindings.groups.first() else {
        return 0;
    };
    let Some((_, BoundResource::Buffer { buffer, offset, .. })) = bound.group.entries.first()
    else {
        return 0;
    };
    let at = (*offset as usize).saturating_add(bound.dynamic_offsets[0] as usize);
    let second_line = at.saturating_add(64) / 4;
    buffer.words().get(second_line).copied().unwrap_or_default()
}
