//! Stored texels of sixteen lanes as numbers: the formats that are filtered most.

use super::TextureView;
use estampe_types::srgb::LINEAR_BITS_FROM_SRGB;
use estampe_types::state::CompareFunction;
use estampe_types::{Int, Real, TexelEncoding};

/// Formats without code of their own.
pub(super) const OTHERS: u8 = 0;
/// Four unorm bytes: arrays of them are sampled in 11 ns rather than 17.
pub(super) const RGBA8: u8 = 1;
/// Four half floats.
pub(super) const RGBA16F: u8 = 2;

/// A format whose texels sixteen lanes read at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PacketFormat {
    encoding: TexelEncoding,
    is_srgb: bool,
    /// Channels that are stored.
    pub(super) components: usize,
    /// Words of a texel.
    pub(super) words: i32,
}

impl PacketFormat {
    /// `None` where a view's texels are read one by one: integers, stencil, and formats with odd bits.
    pub(crate) fn new(view: &TextureView) -> Option<Self> {
        use TexelEncoding as E;
        let stored = view.texture.stored_format();
        let encoding = stored.encoding();
        let is_known = matches!(
            encoding,
            E::Unorm8 | E::Unorm16 | E::Float16 | E::Float32 | E::Depth16 | E::Depth24 | E::Depth32
        );
        (is_known && !view.decoder.is_integer()).then_some(Self {
            encoding,
            is_srgb: stored.is_srgb(),
            components: stored.components(),
            words: i32::try_from(view.decoder.words).unwrap_or(1),
        })
    }

    /// The format's number among those that have code of their own.
    pub(super) fn kind(self) -> u8 {
        match (self.encoding, self.components) {
            (TexelEncoding::Unorm8, 4) if !self.is_srgb => RGBA8,
            (TexelEncoding::Float16, 4) => RGBA16F,
            _ => OTHERS,
        }
    }

    /// Whether it is a depth of whole codes.
    pub(super) fn is_fixed_depth(self) -> bool {
        matches!(
            self.encoding,
            TexelEncoding::Depth16 | TexelEncoding::Depth24
        )
    }

    /// Texels' channels in units, the index being that of their first words; those that the format lacks are left.
    #[inline(always)]
    pub(super) fn units<R: Real, const C: usize, const KIND: u8>(
        self,
        words: &[u32],
        index: R::Int,
        units: &mut [R; C],
    ) {
        use TexelEncoding as E;
        if KIND == RGBA8 {
            let all = word(words, index, 0);
            for (k, unit) in (0..).zip(units) {
                *unit = (all.shr_unsigned(8 * k) & index.splat(0xFF)).to_real();
            }
            return;
        }
        if KIND == RGBA16F {
            let (rg, ba) = (word(words, index, 0), word(words, index, 1));
            for (k, unit) in (0..).zip(units) {
                let pair = if k < 2 { rg } else { ba };
                *unit = float_of_half(pair.shr_unsigned(16 * (k % 2)) & index.splat(0xFFFF));
            }
            return;
        }
        match self.encoding {
            E::Float32 | E::Depth32 => {
                for (k, unit) in (0..).zip(units).take(self.components) {
                    *unit = word(words, index, k).to_real_bits();
                }
            }
            E::Float16 | E::Unorm16 => {
                let mut of_two = word(words, index, 0);
                for (k, unit) in units.iter_mut().enumerate().take(self.components) {
                    let half = if k % 2 == 0 {
                        of_two & index.splat(0xFFFF)
                    } else {
                        of_two.shr_unsigned(16)
                    };
                    *unit = if self.encoding == E::Float16 {
                        float_of_half(half)
                    } else {
                        half.to_real()
                    };
                    if k == 1 && self.components > 2 {
                        of_two = word(words, index, 1);
                    }
                }
            }
            E::Depth16 => {
                units[0] = (word(words, index, 0) & index.splat(0xFFFF)).to_real() / 65535.0
            }
            E::Depth24 => {
                units[0] = (word(words, index, 0) & index.splat(0xFF_FFFF)).to_real() / 16_777_215.0
            }
            _ => {
                let mut left = word(words, index, 0);
                for (k, unit) in units.iter_mut().enumerate().take(self.components) {
                    let code = left & index.splat(0xFF);
                    *unit = if self.is_srgb && k < 3 {
                        code.gather(&*LINEAR_BITS_FROM_SRGB).to_real_bits()
                    } else {
                        code.to_real()
                    };
                    left = left.shr_unsigned(8);
                }
            }
        }
    }
}

/// One of the words of texels that begin at an index.
#[inline(always)]
fn word<I: Int>(words: &[u32], index: I, k: i32) -> I {
    (index + index.splat(k)).gather(words)
}

/// The numbers that half floats' bits stand for.
///
/// Their exponent and mantissa, moved to a float's place, are the number times 2⁻¹¹², exactly, denormals too.
#[inline(always)]
fn float_of_half<I: Int>(half: I) -> I::Real {
    /// 2¹¹².
    const SCALE: f32 = f32::from_bits((127 + 112) << 23);
    let magnitude = half & half.splat(0x7FFF);
    let moved = magnitude << 13;
    let scaled = (moved.to_real_bits() * SCALE).to_bits();
    let infinite = half.splat(0x7BFF).lt(magnitude);
    let finite = I::select(infinite, moved | half.splat(0x7F80_0000), scaled);
    let sign = (half & half.splat(0x8000)) << 16;
    (finite | sign).to_real_bits()
}

/// 1 where a comparison passes, else 0.
#[inline(always)]
pub(super) fn passes<R: Real>(function: CompareFunction, reference: R, texel: R) -> R {
    let mask = match function {
        CompareFunction::Never => reference.splat_mask(false),
        CompareFunction::Less => reference.lt(texel),
        CompareFunction::Equal => reference.eq(texel),
        CompareFunction::LessEqual => reference.le(texel),
        CompareFunction::Greater => reference.gt(texel),
        CompareFunction::NotEqual => !reference.eq(texel),
        CompareFunction::GreaterEqual => reference.ge(texel),
        CompareFunction::Always => reference.splat_mask(true),
    };
    R::select(mask, reference.splat(1.0), reference.splat(0.0))
}
