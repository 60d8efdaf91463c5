//! Decoding of texels: unpacking of four channels from a word, and their units.
//!
//! Until the end of filtering, channels are in the units that are cheapest to unpack exactly. Of
//! unorm8, the first and third channel are the encoded values c, the second and fourth are 256·c;
//! colours of sRGB are linear values. [`finish`] scales all of them to 0..1.

use estampe_format::srgb::LINEAR_FROM_SRGB;
use estampe_simd::{ByteTable, Bytes, ExtractToken, Lanes, bits_of, i32x16, u32x16};
use estampe_types::{Int, Quad, Real, Vec3, Vec4};
use std::sync::LazyLock;

/// 2²³ as f32: the bits below are its mantissa, so `MAGIC | c` is 2²³ + c for c < 2²³.
const MAGIC: i32 = 0x4B00_0000;
const MAGIC_REAL: f32 = 8_388_608.0;

/// 1/255 rounded, and the factor of channels that are 256·c; the two differ by an exact power of
/// two.
const UNIT: f32 = 1.0 / 255.0;
const UNIT_256: f32 = UNIT / 256.0;

/// The bits of the linear value of each encoded 8-bit sRGB value.
static LINEAR: LazyLock<ByteTable> =
    LazyLock::new(|| ByteTable::new(LINEAR_FROM_SRGB.map(f32::to_bits)));

/// Integers whose lanes hold texels of four bytes.
pub(crate) trait Texels: Int {
    /// Looks up the lowest three bytes in the table.
    fn lookup_three(self, table: &ByteTable) -> [Self::Real; 3];
}

/// Numbers whose lanes can read texels.
pub(crate) trait Number: Real<Int: Texels> {}

impl<R: Real<Int: Texels>> Number for R {}

impl<S: Lanes> Texels for i32x16<S> {
    #[inline(always)]
    fn lookup_three(self, table: &ByteTable) -> [Self::Real; 3] {
        let words: u32x16<S> = self.bitcast();
        let [r, g, b] = self.token().lookup_three(table, words);
        [r.bitcast(), g.bitcast(), b.bitcast()]
    }
}

impl Texels for i32 {
    #[inline(always)]
    fn lookup_three(self, table: &ByteTable) -> [f32; 3] {
        let [r, g, b, _] = self.to_le_bytes();
        [r, g, b].map(|code| f32::from_bits(table.get(code)))
    }
}

impl Texels for Quad<i32> {
    #[inline(always)]
    fn lookup_three(self, table: &ByteTable) -> [Quad; 3] {
        let four = self.0.map(|word| word.lookup_three(table));
        [0, 1, 2].map(|k| Quad(four.map(|channels| channels[k])))
    }
}

/// One channel of each lane's texel, plus 2²³.
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

impl<I: Texels> Corners<I> {
    /// The weighted mean of the four, in the units of this module.
    #[inline(always)]
    pub(crate) fn mean(self, fx: I::Real, fy: I::Real, is_srgb: bool) -> Vec4<I::Real> {
        if is_srgb {
            return self.mean_of_srgb(fx, fy);
        }
        self.mean_of_unorm(fx, fy)
    }

    /// The weighted mean of unorm8 texels, in the units of this module.
    #[inline(always)]
    pub(crate) fn mean_of_unorm(&self, fx: I::Real, fy: I::Real) -> Vec4<I::Real> {
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

    /// The weighted mean of sRGB texels, whose R, G and B are decoded first.
    #[inline(always)]
    fn mean_of_srgb(self, fx: I::Real, fy: I::Real) -> Vec4<I::Real> {
        let ([a, b], [c, d]) = (self.upper, self.lower);
        let table = &*LINEAR;
        let (a, b) = (a.lookup_three(table), b.lookup_three(table));
        let (c, d) = (c.lookup_three(table), d.lookup_three(table));
        let alpha = self.shifted();
        Vec4::new(
            mix(mix(a[0], b[0], fx), mix(c[0], d[0], fx), fy),
            mix(mix(a[1], b[1], fx), mix(c[1], d[1], fx), fy),
            mix(mix(a[2], b[2], fx), mix(c[2], d[2], fx), fy),
            alpha.mean_of_bytes(0xFF00, fx, fy),
        )
    }
}

/// The mean of two texels' channel under the mask: the differences of biased channels are exact.
#[inline(always)]
fn mean_of_bytes<I: Int>([left, right]: [I; 2], mask: i32, f: I::Real) -> I::Real {
    let (left, right) = (biased(left, mask), biased(right, mask));
    (left - MAGIC_REAL) + (right - left) * f
}

/// Alpha 255 in the units of this module. Any mean of opaque texels has this alpha, because
/// differences of 0 add nothing.
pub(crate) const OPAQUE: f32 = 65_280.0;

/// The linear values of R, G and B of an sRGB texel.
#[inline(always)]
pub(crate) fn linear<I: Texels>(word: I) -> [I::Real; 3] {
    word.lookup_three(&LINEAR)
}

/// [`linear`] for any kind of integer, by gathers.
#[inline(always)]
pub(crate) fn linear_of_any<I: Int>(word: I) -> [I::Real; 3] {
    let table = bits_of(&*LINEAR_FROM_SRGB);
    let byte = word.splat(0xFF);
    [
        (word & byte).gather(table).to_real_bits(),
        (word >> 8 & byte).gather(table).to_real_bits(),
        (word >> 16 & byte).gather(table).to_real_bits(),
    ]
}

/// Unpacks one texel to the units of this module; `linear` holds the linear values of an sRGB
/// texel.
#[inline(always)]
pub(crate) fn unpack<I: Int>(word: I, linear: Option<[I::Real; 3]>) -> Vec4<I::Real> {
    let high = word >> 16;
    let w = biased(high, 0xFF00) - MAGIC_REAL;
    if let Some([x, y, z]) = linear {
        return Vec4::new(x, y, z, w);
    }
    Vec4::new(
        biased(word, 0xFF) - MAGIC_REAL,
        biased(word, 0xFF00) - MAGIC_REAL,
        biased(high, 0xFF) - MAGIC_REAL,
        w,
    )
}

/// Scales a colour from the units of this module to 0..1.
#[inline(always)]
pub(crate) fn finish<R: Real>(color: Vec4<R>, is_srgb: bool) -> Vec4<R> {
    let w = color.w * UNIT_256;
    if is_srgb {
        Vec4 { w, ..color }
    } else {
        Vec4::new(color.x * UNIT, color.y * UNIT_256, color.z * UNIT, w)
    }
}
