//! Clearing a tile's attachments.

use super::{MAX_TARGETS, TileJob};
use crate::attachment::RenderTarget;
use crate::commands::{Discards, LoadOp, RenderPass};
use crate::pipeline::color_target::MAX_WORDS;
use estampe_format::AttachmentCodec;
use estampe_simd::{LANES, Lanes, Level, SimdBase, dispatch, f32x16, u32x16};

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

    /// Clears a tile.
    pub(super) fn run(&self, level: Level, job: &mut TileJob<'_>) {
        dispatch!(level, s => self.run_lanes(s, job));
    }

    /// Sixteen elements a store: `fill` is compiled for the least processor.
    #[inline(always)]
    fn run_lanes<S: Lanes>(&self, s: S, job: &mut TileJob<'_>) {
        for (lines, color) in job.colors.iter_mut().zip(&self.colors) {
            let Some((words, count)) = color else {
                continue;
            };
            for (word, bits) in words.iter().enumerate().take(*count) {
                let value = <u32x16<S> as SimdBase<S>>::splat(s, *bits);
                if *count == 1 {
                    lines.iter_mut().for_each(|line| value.store_array(line));
                    break;
                }
                for line in lines.iter_mut().skip(word).step_by(*count) {
                    value.store_array(line);
                }
            }
        }
        if let Some(stencil) = self.stencil {
            job.stencil.fill([stencil; LANES]);
        }
        if let Some(depth) = self.depth {
            let value = <f32x16<S> as SimdBase<S>>::splat(s, depth);
            for line in job.depth.iter_mut() {
                value.store_array(line);
            }
        }
    }
}
