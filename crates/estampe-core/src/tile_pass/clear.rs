//! Clearing a tile's attachments.

use super::{MAX_TARGETS, PacketSet, TileJob, TilePass};
use crate::attachment::RenderTarget;
use crate::commands::{Discards, LoadOp, RenderPass};
use crate::pipeline::color_target::MAX_WORDS;
use estampe_format::AttachmentCodec;
use estampe_simd::{LANES, Lanes, SimdBase, dispatch, f32x16, u32x16};
use std::ops::Range;

/// The values that a pass clears attachments to, in each tile.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Clear {
    /// The words of a texel, by colour attachment, and how many there are.
    colors: [Option<([u32; MAX_WORDS], usize)>; MAX_TARGETS],
    /// As it is stored.
    pub(crate) depth: Option<f32>,
    stencil: Option<u8>,
}

impl Clear {
    pub(crate) fn new(target: &RenderTarget, pass: &RenderPass<'_>) -> Self {
        let mut clear = Self::default();
        let formats = target.color_formats().iter();
        for (index, (color, format)) in clear.colors.iter_mut().zip(formats).enumerate() {
            let load = pass.load_colors.get(index);
            if let LoadOp::Clear(rgba) = load.copied().unwrap_or(LoadOp::Clear([0.0; 4])) {
                let codec = AttachmentCodec::new(*format);
                *color = Some((codec.clear_words(rgba), codec.words()));
            }
        }
        // Depths are kept in 0..=1, NaN as 0: hierarchical z relies on their order.
        if let (LoadOp::Clear(depth), true) = (pass.load_depth, target.has_depth()) {
            let clamped = if depth > 0.0 { depth.min(1.0) } else { 0.0 };
            clear.depth = Some(target.depth_format().stored(clamped));
        }
        if let (LoadOp::Clear(stencil), true) = (pass.load_stencil, target.has_stencil()) {
            clear.stencil = Some(stencil);
        }
        clear
    }

    /// Returns true if there is nothing to clear.
    pub(crate) fn is_done(&self) -> bool {
        self.colors.iter().all(Option::is_none) && self.depth.is_none() && self.stencil.is_none()
    }

    /// Those of the attachments that are cleared: what they held before is not seen.
    pub(crate) fn cleared(&self, attachments: Discards, target: &RenderTarget) -> Discards {
        let cleared = self.colors.iter().rev();
        let cleared = cleared.fold(0, |bits, color| bits << 1 | u8::from(color.is_some()));
        let keeps_depth = target.has_depth() && self.depth.is_none();
        let keeps_stencil = target.has_stencil() && self.stencil.is_none();
        Discards {
            colors: attachments.colors & cleared,
            depth_stencil: attachments.depth_stencil && !keeps_depth && !keeps_stencil,
        }
    }

    /// The first attachment whose colours may wait until it is known where a tile shows triangles,
    /// so that they are cleared elsewhere alone: of one sample. The first of all holds the
    /// triangles' ids if its texels have one word.
    pub(super) fn first_waiting<const N: usize>(&self) -> usize {
        if const { N > 1 } {
            return MAX_TARGETS;
        }
        usize::from(self.colors[0].is_some_and(|(_, words)| words == 1))
    }

    /// True if some attachment from a number on is cleared.
    pub(super) fn clears_colors_from(&self, first: usize) -> bool {
        self.colors.iter().skip(first).any(Option::is_some)
    }

    /// Clears a tile in which nothing is drawn.
    pub(super) fn tile<const N: usize>(&self, pass: &TilePass<'_>, job: &mut TileJob<'_>) {
        self.stencil(job);
        self.blocks::<N>(pass, job, u16::MAX);
        self.waiting_colors::<N>(pass, job, None);
    }

    /// Clears a tile's stencil values.
    pub(super) fn stencil(&self, job: &mut TileJob<'_>) {
        if let Some(stencil) = self.stencil {
            job.stencil.fill([stencil; LANES]);
        }
    }

    /// Clears some blocks of a tile, of 16×16 pixels, one bit each: their depths, and the colours
    /// that [need not wait](Self::first_waiting).
    pub(super) fn blocks<const N: usize>(
        &self,
        pass: &TilePass<'_>,
        job: &mut TileJob<'_>,
        blocks: u16,
    ) {
        let mut in_target = pass.blocks_in_target(job.tile);
        in_target.set &= blocks;
        if in_target.set == 0 {
            return;
        }
        dispatch!(pass.level, s => {
            self.depth_lanes(s, job, in_target);
            self.color_lanes(s, job, 0..self.first_waiting::<N>(), (in_target, None));
        });
    }

    /// Clears the colours of a tile that wait: of all packets, or, of one sample, of those in a
    /// set.
    pub(super) fn waiting_colors<const N: usize>(
        &self,
        pass: &TilePass<'_>,
        job: &mut TileJob<'_>,
        packets: Option<&PacketSet>,
    ) {
        let waiting = self.first_waiting::<N>()..MAX_TARGETS;
        if self.clears_colors_from(waiting.start) {
            let blocks = pass.blocks_in_target(job.tile);
            dispatch!(pass.level, s => self.color_lanes(s, job, waiting, (blocks, packets)));
        }
    }

    /// Sixteen elements a store: `fill` is compiled for the least processor.
    #[inline(always)]
    fn color_lanes<S: Lanes>(
        &self,
        s: S,
        job: &mut TileJob<'_>,
        attachments: Range<usize>,
        (blocks, packets): (TileBlocks, Option<&PacketSet>),
    ) {
        let images = job.colors.iter_mut().zip(&self.colors);
        for (lines, color) in images.take(attachments.end).skip(attachments.start) {
            let Some((words, count)) = color else {
                continue;
            };
            let words = &words[..*count];
            for (block, lines) in blocks.of(lines) {
                if let ([word], None) = (words, packets) {
                    let value = <u32x16<S> as SimdBase<S>>::splat(s, *word);
                    lines.iter_mut().for_each(|line| value.store_array(line));
                    continue;
                }
                let texels = lines.chunks_exact_mut(words.len());
                for (packet, texels) in (block * BLOCK_PACKETS..).zip(texels) {
                    let is_cleared = packets
                        .is_none_or(|set| set[packet / 64 % set.len()] >> (packet % 64) & 1 == 1);
                    if is_cleared {
                        for (line, word) in texels.iter_mut().zip(words) {
                            <u32x16<S> as SimdBase<S>>::splat(s, *word).store_array(line);
                        }
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn depth_lanes<S: Lanes>(&self, s: S, job: &mut TileJob<'_>, blocks: TileBlocks) {
        if let Some(depth) = self.depth {
            let value = <f32x16<S> as SimdBase<S>>::splat(s, depth);
            for (_, lines) in blocks.of(job.depth) {
                for line in lines {
                    value.store_array(line);
                }
            }
        }
    }
}

/// Packets of a block of 16×16 pixels.
const BLOCK_PACKETS: usize = 16;

/// The blocks of 16×16 pixels of a tile that hold pixels of the target. What lies beyond its edges
/// is nobody's, and need not be cleared: of 1280×720 it is one part in sixteen.
#[derive(Debug, Clone, Copy)]
struct TileBlocks {
    /// One bit each.
    set: u16,
    count: usize,
}

impl TileBlocks {
    /// The lines of each block, with its number.
    #[inline(always)]
    fn of<L>(self, lines: &mut [L]) -> impl Iterator<Item = (usize, &mut [L])> {
        let block_lines = (lines.len() / self.count).max(1);
        let blocks = lines.chunks_exact_mut(block_lines).enumerate();
        blocks.filter(move |(block, _)| self.set >> block & 1 == 1)
    }
}

impl TilePass<'_> {
    fn blocks_in_target(&self, tile: u32) -> TileBlocks {
        let shape = self.tile_shape(tile);
        TileBlocks {
            set: shape.blocks_reached(&shape.local(&self.target)),
            count: shape.blocks(),
        }
    }
}
