//! One colour blended over texels of four unorm bytes.
//!
//! Where source and alpha are the same for all fragments, each new code is a function of the stored
//! code alone, a line but for roundings: ⌊slope·code + first⌋. [`SolidBlend::new`] compares that
//! with the formula of docs/NUMERICS.md, as [`color_writer`](super::color_writer) computes it, for
//! all 256 codes, at the SIMD level that writes. If all are equal, the line is used: 5 operations
//! a channel in place of 14, and none at all if the colour hides what is stored.
//!
//! Codes are *raised* as in [`source_over`](super::source_over): 256 + code as a float, whose bits
//! are the code's with others around it, so that nothing is converted.

use super::blend::{BlendInputs, BlendKernel, ColorLanes};
use super::color_writer::{clamp, load};
use super::source_over::{raised_codes, texels};
use crate::fragment::fill::LANE_NUMBERS;
use crate::pipeline::color_target::{ColorTarget, Equation, Over, Weight};
use crate::raster::packet_masks::PacketMasks;
use estampe_format::PacketCodec;
use estampe_format::attachment::Family;
use estampe_simd::{
    Bytes, LANES, Lanes, Level, Packet, Select, SimdBase, SimdFloat, dispatch, f32x16, u32x16,
};

/// A colour's effect on stored texels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SolidBlend {
    /// By byte of a texel: the line through raised codes, 256 + new = slope·(256 + old) + first.
    slopes: [f32; 4],
    firsts: [f32; 4],
    /// The new texel, if it is the same whatever is stored.
    hides: Option<u32>,
}

impl SolidBlend {
    /// The blending of a colour into a target, if it is known to be a line.
    pub(crate) fn new(
        level: Level,
        target: &ColorTarget,
        color: &[Packet<f32>; 4],
    ) -> Option<Self> {
        let Family::Rgba8(codec) = target.codec.family() else {
            return None;
        };
        if target.logic.is_some() || !target.writes_all {
            return None;
        }
        let over = match target.equation {
            Equation::Replace => None,
            Equation::Over(over) if depends_on_one_code(&over) => Some(over),
            Equation::Over(_) | Equation::Any(_) => return None,
        };
        let blending = Exact {
            codec,
            over,
            range: target.codec.range(),
            color,
        };
        let mut bytes = [0; 4];
        for (channel, byte) in bytes.iter_mut().enumerate() {
            *byte = target.codec.channel_bits(channel)[0].trailing_zeros() as usize / 8 % 4;
        }
        dispatch!(@wide level, s => Self::fit(s, &blending, bytes),
            scalar => None)
    }

    /// The line of each byte, `bytes` by channel, if all codes are those of the formula.
    #[inline(always)]
    fn fit<S: Lanes>(
        s: S,
        exact: &Exact<'_, impl PacketCodec<S>>,
        bytes: [usize; 4],
    ) -> Option<Self> {
        let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
        let (over_least, over_most) = (exact.values(s, splat(0)), exact.values(s, splat(u32::MAX)));
        let mut line = Self {
            slopes: [0.0; 4],
            firsts: [0.0; 4],
            hides: None,
        };
        for (channel, byte) in bytes.into_iter().enumerate() {
            let (least, most) = (
                over_least[channel].to_array()[0],
                over_most[channel].to_array()[0],
            );
            line.slopes[byte] = most - least;
            line.firsts[byte] = 256.5 + 255.0 * least - 256.0 * (most - least);
        }
        // Of a word whose bytes are one code.
        let each_byte = 0x0101_0101;
        for first in (0..256).step_by(LANES) {
            let stored = (u32x16::load_array(s, LANE_NUMBERS) + splat(first)) * splat(each_byte);
            let expected = exact.texels(s, stored);
            if s.bits_of_mask(line.blend(s, stored).simd_eq(expected)) != u16::MAX {
                return None;
            }
        }
        if line.slopes == [0.0; 4] {
            line.hides = Some(line.blend(s, splat(0)).to_array()[0]);
        }
        Some(line)
    }

    /// The texels that stored ones become.
    #[inline(always)]
    fn blend<S: Lanes>(&self, s: S, stored: u32x16<S>) -> u32x16<S> {
        let mut codes = raised_codes(s, stored);
        let mut byte = 0;
        while byte < 4 {
            let code: f32x16<S> = codes[byte].bitcast();
            let slope = f32x16::splat(s, self.slopes[byte]);
            let first = f32x16::splat(s, self.firsts[byte]);
            codes[byte] = code.mul_add(slope, first).bitcast();
            byte += 1;
        }
        texels(s, &codes)
    }

    /// Blends the colour into all covered samples of a tile, and forgets these. Returns the number
    /// of their fragments.
    pub(crate) fn write<const N: usize>(
        &self,
        level: Level,
        covered: &mut PacketMasks<N>,
        samples: usize,
        stored: &mut [[u32; LANES]],
    ) -> u64 {
        dispatch!(@wide level, s => self.write_lanes(s, covered, samples, stored),
            scalar => unreachable!("the scalar level has no lines"))
    }

    #[inline(always)]
    fn write_lanes<S: Lanes, const N: usize>(
        &self,
        s: S,
        covered: &mut PacketMasks<N>,
        samples: usize,
        stored: &mut [[u32; LANES]],
    ) -> u64 {
        let mut fragments = 0;
        let hides = self.hides.map(|texel| u32x16::splat(s, texel));
        covered.take_each(
            #[inline(always)]
            |packet, masks| {
                let Some(lines) = stored.get_mut(packet * samples..) else {
                    return;
                };
                let any = masks.iter().fold(0, |any, mask| any | mask);
                fragments += u64::from(any.count_ones());
                for (line, mask) in lines.iter_mut().zip(masks).take(samples) {
                    let old = u32x16::load_array_ref(s, line);
                    let new = match hides {
                        Some(texel) => texel,
                        None => self.blend(s, old),
                    };
                    s.mask_from_bits(mask).select(new, old).store_array(line);
                }
            },
        );
        fragments
    }
}

/// Returns true if each channel's new value depends on no other stored channel.
fn depends_on_one_code(over: &Over) -> bool {
    [over.source_color, over.stored_color]
        .iter()
        .all(|weight| !matches!(weight, Weight::StoredAlpha | Weight::OneMinusStoredAlpha))
}

/// The formula itself; without an equation colours replace what is stored.
struct Exact<'a, C> {
    codec: C,
    over: Option<Over>,
    range: Option<[f32; 2]>,
    color: &'a [Packet<f32>; 4],
}

impl<C: Copy> Exact<'_, C> {
    /// The blended values over some texels.
    #[inline(always)]
    fn values<S: Lanes>(&self, s: S, stored: u32x16<S>) -> ColorLanes<S>
    where
        C: PacketCodec<S>,
    {
        let zero = <u32x16<S> as SimdBase<S>>::splat(s, 0);
        let source = clamp(s, load(s, self.color), self.range);
        let Some(over) = self.over else {
            return source;
        };
        let inputs = BlendInputs {
            source,
            second: [SimdBase::splat(s, 0.0); 4],
            stored: self.codec.decode(s, [stored, zero, zero, zero]),
        };
        over.blend(s, &inputs)
    }

    /// The texels that some become.
    #[inline(always)]
    fn texels<S: Lanes>(&self, s: S, stored: u32x16<S>) -> u32x16<S>
    where
        C: PacketCodec<S>,
    {
        self.codec.encode(s, self.values(s, stored))[0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_types::TextureFormat;
    use estampe_types::state::{BlendComponent, BlendFactor as F, BlendState, ColorTargetState};

    fn target(format: TextureFormat, blend: BlendState) -> ColorTarget {
        let state = ColorTargetState {
            blend: Some(blend),
            ..format.into()
        };
        ColorTarget::new(&state, 0, None)
    }

    fn blending([from, to]: [F; 2], [alpha_from, alpha_to]: [F; 2]) -> BlendState {
        let component = |src_factor, dst_factor| BlendComponent {
            src_factor,
            dst_factor,
            ..BlendComponent::default()
        };
        BlendState {
            color: component(from, to),
            alpha: component(alpha_from, alpha_to),
        }
    }

    /// A color of codes, premultiplied or not, is a line.
    #[test]
    fn colors_of_codes_are_lines_at_every_level() {
        let egui = blending([F::One, F::OneMinusSrcAlpha], [F::OneMinusDstAlpha, F::One]);
        let levels = Level::all_available();
        for level in levels.into_iter().filter(|level| !level.is_scalar()) {
            for format in [TextureFormat::Rgba8Unorm, TextureFormat::Bgra8Unorm] {
                for alpha in [0.0, 51.0, 140.0, 255.0] {
                    let codes = [alpha * 0.25, alpha * 0.75, alpha, alpha].map(f32::floor);
                    let color = codes.map(|code| Packet([code / 255.0; LANES]));
                    let line = SolidBlend::new(level, &target(format, egui), &color);
                    let line = line.expect("a line");
                    assert_eq!(line.hides.is_some(), alpha == 255.0, "{codes:?}");
                }
            }
        }
    }

    /// Blending that saturates, or depends on another channel, is no line.
    #[test]
    fn other_blending_is_no_line() {
        let color = [0.75, 0.5, 0.25, 0.5].map(|value| Packet([value; LANES]));
        let by_stored_alpha = blending([F::DstAlpha, F::One], [F::One, F::Zero]);
        for blend in [BlendState::ADDITIVE, by_stored_alpha] {
            let target = target(TextureFormat::Rgba8Unorm, blend);
            for level in Level::all_available() {
                assert_eq!(SolidBlend::new(level, &target, &color), None, "{blend:?}");
            }
        }
    }
}
