//! Texels as numbers: unpacking four channels from a word, and their units.
//!
//! Until the end of filtering, channels are in the units that are cheapest to unpack exactly: unorm8's first
//! and third as codes c, its second and fourth as 256·c, sRGB's colours as linear values. [`finish`]
//! brings all of them to 0..1.

use estampe_format::srgb;
use estampe_simd::bits_of;
use estampe_types::{Int, Real, Vec3, Vec4};

/// 2²³ as f32: the bits below are its mantissa, so `MAGIC | c` is 2²³ + c for c < 2²³.
const MAGIC: i32 = 0x4B00_0000;
const MAGIC_REAL: f32 = 8_388_608.0;

/// 1/255 rounded, and the same for channels in units of 1/256 code: exact, a power of two apart.
const UNIT: f32 = 1.0 / 255.0;
const UNIT_256: f32 = UNIT / 256.0;

/// One channel of one texel, plus 2²³.
#[inline(always)]
fn biased<I: Int>(word: I, mask: i32) -> I::Real {
    ((word & word.splat(mask)) | word.splat(MAGIC)).to_real_bits()
}

/// `start + (end − start)·t`.
#[inline(always)]
pub(crate) fn mix<R: Real>(start: R, end: R, t: R) -> R {
    start + (end - start) * t
}

/// The texels of one level around a sample.
pub(crate) struct Corners<I> {
    /// Left and right of the upper row.
    pub(crate) upper: [I; 2],
    /// Left and right of the lower row.
    pub(crate) lower: [I; 2],
}

impl<I: Int> Corners<I> {
    /// The weighted mean of the four, in the units of this module.
    #[inline(always)]
    pub(crate) fn mean(self, fx: I::Real, fy: I::Real, is_srgb: bool) -> Vec4<I::Real> {
        if is_srgb {
            return self.mean_of_srgb(fx, fy);
        }
        let high = self.shifted();
        Vec4::new(
            self.mean_of_bytes(0xFF, fx, fy),
            self.mean_of_bytes(0xFF00, fx, fy),
            high.mean_of_bytes(0xFF, fx, fy),
            high.mean_of_bytes(0xFF00, fx, fy),
        )
    }

    /// R, G and B of the weighted mean of unorm8, in the units of this module.
    #[inline(always)]
    pub(crate) fn mean_of_colors(&self, fx: I::Real, fy: I::Real) -> Vec3<I::Real> {
        Vec3::new(
            self.mean_of_bytes(0xFF, fx, fy),
            self.mean_of_bytes(0xFF00, fx, fy),
            self.shifted().mean_of_bytes(0xFF, fx, fy),
        )
    }

    /// The upper two channels of each word as the lower two.
    #[inline(always)]
    fn shifted(&self) -> Self {
        Self {
            upper: [self.upper[0] >> 16, self.upper[1] >> 16],
            lower: [self.lower[0] >> 16, self.lower[1] >> 16],
        }
    }

    /// The mean of the channel under the mask.
    #[inline(always)]
    fn mean_of_bytes(&self, mask: i32, fx: I::Real, fy: I::Real) -> I::Real {
        mix(
            mean_of_bytes(self.upper, mask, fx),
            mean_of_bytes(self.lower, mask, fx),
            fy,
        )
    }

    /// The mean with R, G and B decoded; a loop, because its many gathers are long code on processors
    /// without such an instruction.
    #[inline(always)]
    fn mean_of_srgb(self, fx: I::Real, fy: I::Real) -> Vec4<I::Real> {
        let table = bits_of(&*srgb::LINEAR_FROM_SRGB);
        let mut colors = [fx; 3];
        let ([mut a, mut b], [mut c, mut d]) = (self.upper, self.lower);
        for color in &mut colors {
            let upper = mix(decoded(a, table), decoded(b, table), fx);
            let lower = mix(decoded(c, table), decoded(d, table), fx);
            *color = mix(upper, lower, fy);
            (a, b, c, d) = (a >> 8, b >> 8, c >> 8, d >> 8);
        }
        let alpha = Self {
            upper: [a << 8, b << 8],
            lower: [c << 8, d << 8],
        };
        let [x, y, z] = colors;
        Vec4::new(x, y, z, alpha.mean_of_bytes(0xFF00, fx, fy))
    }
}

/// The mean of two texels' channel under the mask: the differences of biased channels are exact.
#[inline(always)]
fn mean_of_bytes<I: Int>([left, right]: [I; 2], mask: i32, f: I::Real) -> I::Real {
    let (left, right) = (biased(left, mask), biased(right, mask));
    (left - MAGIC_REAL) + (right - left) * f
}

/// The linear value of the sRGB code in the lowest byte.
#[inline(always)]
fn decoded<I: Int>(word: I, table: &[u32]) -> I::Real {
    (word & word.splat(0xFF)).gather(table).to_real_bits()
}

/// Alpha 255 in the units of this module: what any mean of such texels is, for differences of 0 add nothing.
pub(crate) const OPAQUE: f32 = 65_280.0;

/// One texel in the units of this module.
#[inline(always)]
pub(crate) fn unpack<I: Int>(word: I, is_srgb: bool) -> Vec4<I::Real> {
    let high = word >> 16;
    let w = biased(high, 0xFF00) - MAGIC_REAL;
    if is_srgb {
        let table = bits_of(&*srgb::LINEAR_FROM_SRGB);
        let mut colors = [w; 3];
        let mut word = word;
        for color in &mut colors {
            *color = decoded(word, table);
            word = word >> 8;
        }
        let [x, y, z] = colors;
        return Vec4::new(x, y, z, w);
    }
    Vec4::new(
        biased(word, 0xFF) - MAGIC_REAL,
        biased(word, 0xFF00) - MAGIC_REAL,
        biased(high, 0xFF) - MAGIC_REAL,
        w,
    )
}

/// From the units of this module to 0..1.
#[inline(always)]
pub(crate) fn finish<R: Real>(color: Vec4<R>, is_srgb: bool) -> Vec4<R> {
    let w = color.w * UNIT_256;
    if is_srgb {
        Vec4 { w, ..color }
    } else {
        Vec4::new(color.x * UNIT, color.y * UNIT_256, color.z * UNIT, w)
    }
}
