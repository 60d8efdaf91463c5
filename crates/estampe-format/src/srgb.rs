//! The sRGB transfer function (IEC 61966-2-1) by tables: 256 decoded values, 255 thresholds.
//!
//! The tables are computed once, in f64 with `+ − × ÷ √` only, so they are the same on every
//! machine: x^2.4 = x²·(x²)^(1/5), the fifth root by Newton's method.

use estampe_simd::{
    Bytes, Lanes, Select, SimdBase, SimdCvtTruncate, bits_of, f32x16, i32x16, outline, u32x16,
};
use std::sync::LazyLock;

/// The linear value of each 8-bit sRGB code, rounded once to f32.
pub static LINEAR_FROM_SRGB: LazyLock<[f32; 256]> = LazyLock::new(|| {
    let mut table = [0.0; 256];
    for (code, value) in (0u32..).zip(&mut table) {
        *value = narrow(transfer(f64::from(code) / 255.0));
    }
    table
});

/// [`LINEAR_FROM_SRGB`] as bits.
static LINEAR_BITS: LazyLock<[u32; 256]> = LazyLock::new(|| LINEAR_FROM_SRGB.map(f32::to_bits));

/// Threshold `k` is the least f32 whose code is `k + 1`: the linear value of the code boundary
/// `(k + ½) / 255`, rounded up.
pub static THRESHOLDS: LazyLock<[f32; 255]> = LazyLock::new(|| {
    let mut table = [0.0; 255];
    for (code, value) in (0u32..).zip(&mut table) {
        let exact = transfer((f64::from(code) + 0.5) / 255.0);
        let near = narrow(exact);
        *value = if f64::from(near) < exact {
            near.next_up()
        } else {
            near
        };
    }
    table
});

/// The 8-bit sRGB code of a linear value: how many thresholds are at or below it. NaN gives 0.
#[must_use]
#[inline]
pub fn encode(linear: f32) -> u8 {
    let code = Encoder::new().code(linear.clamp(0.0, 1.0));
    u8::try_from(code).unwrap_or(u8::MAX)
}

/// [`encode`] for loops, which finds its tables once.
#[derive(Clone, Copy)]
pub(crate) struct Encoder(&'static EncodeTables);

impl Encoder {
    pub(crate) fn new() -> Self {
        Self(&ENCODE)
    }

    /// The code of a linear value in 0..=1. NaN gives 0.
    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0 to 4096; NaN gives 0"
    )]
    pub(crate) fn code(self, linear: f32) -> u32 {
        let start = self.0.start[((linear * BUCKETS as f32) as usize).min(BUCKETS)];
        // Codes are below 256; the mask saves a check.
        start + u32::from(linear >= self.0.next[(start & 255) as usize])
    }
}

/// [`encode`] by searching the thresholds.
fn encode_by_search(linear: f32) -> u8 {
    // 255 thresholds: at most 255.
    u8::try_from(THRESHOLDS.partition_point(|threshold| *threshold <= linear)).unwrap_or(u8::MAX)
}

/// [`encode`] of sixteen values in 0..=1.
///
/// In a bucket of 1/4096 lies at most one threshold (their least distance is 1/3294), so the code
/// of a value is that of its bucket's start, or one more if the value reaches the next threshold.
#[inline(always)]
pub fn encode_lanes<S: Lanes>(s: S, linear: f32x16<S>) -> u32x16<S> {
    outline!(s, {
        let tables = &*ENCODE;
        let bucket: u32x16<S> = i32x16::truncate_from(linear * BUCKETS as f32).bitcast();
        let start = s.gather(&tables.start, bucket);
        let next: f32x16<S> = s.gather(bits_of(&tables.next), start).bitcast();
        let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
        start + linear.simd_ge(next).select(splat(1), splat(0))
    })
}

/// The linear value of an sRGB code.
#[inline(always)]
#[must_use]
pub fn decode(code: u8) -> f32 {
    LINEAR_FROM_SRGB[usize::from(code)]
}

/// [`decode`] of sixteen codes, 0..=255.
#[inline(always)]
pub fn decode_lanes<S: Lanes>(s: S, code: u32x16<S>) -> f32x16<S> {
    s.lookup(&LINEAR_BITS, code).bitcast()
}

/// Tables for [`encode_lanes`].
struct EncodeTables {
    /// The code of b/4096 for each bucket b.
    start: [u32; BUCKETS + 1],
    /// The threshold above each code; none above the last.
    next: [f32; 256],
}

const BUCKETS: usize = 4096;

static ENCODE: LazyLock<EncodeTables> = LazyLock::new(|| {
    let mut tables = EncodeTables {
        start: [0; BUCKETS + 1],
        next: [f32::INFINITY; 256],
    };
    for (bucket, code) in tables.start.iter_mut().enumerate() {
        // Exact: a small integer over a power of two.
        *code = u32::from(encode_by_search(bucket as f32 / BUCKETS as f32));
    }
    tables.next[..255].copy_from_slice(&*THRESHOLDS);
    tables
});

/// The linear value of an encoded one, both in 0..=1.
fn transfer(encoded: f64) -> f64 {
    if encoded <= 0.04045 {
        return encoded / 12.92;
    }
    let x = (encoded + 0.055) / 1.055;
    let square = x * x;
    square * fifth_root(square)
}

/// The fifth root of a number in 0..=1, to the last bits of f64.
fn fifth_root(a: f64) -> f64 {
    let mut y = 1.0;
    // From above, Newton's iteration falls until rounding stops it; 100 steps are ample.
    for _ in 0..100 {
        let next = (4.0 * y + a / (y * y * y * y)) / 5.0;
        if next >= y {
            break;
        }
        y = next;
    }
    y
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "the one rounding from f64 to f32"
)]
fn narrow(value: f64) -> f32 {
    value as f32
}
