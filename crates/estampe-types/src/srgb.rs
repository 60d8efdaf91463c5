//! The sRGB transfer function (IEC 61966-2-1) as tables: 256 decoded values and 255 thresholds.
//!
//! The tables are computed once, in f64 with `+ − × ÷ √` only, so that they are the same on every
//! machine: x^2.4 = x²·(x²)^(1/5), with the fifth root by Newton's method.

use std::sync::LazyLock;

/// The linear value of each 8-bit sRGB code, rounded once to f32.
pub static LINEAR_FROM_SRGB: LazyLock<[f32; 256]> = LazyLock::new(|| {
    let mut table = [0.0; 256];
    for (code, value) in (0u32..).zip(&mut table) {
        *value = narrow(decode(f64::from(code) / 255.0));
    }
    table
});

/// [`LINEAR_FROM_SRGB`] as bits, for gathering.
pub static LINEAR_BITS_FROM_SRGB: LazyLock<[u32; 256]> =
    LazyLock::new(|| LINEAR_FROM_SRGB.map(f32::to_bits));

/// Threshold `k` is the least f32 that is encoded as `k + 1`: the linear value of the boundary
/// `(k + ½) / 255` between two codes, rounded up.
pub static THRESHOLDS: LazyLock<[f32; 255]> = LazyLock::new(|| {
    let mut table = [0.0; 255];
    for (code, value) in (0u32..).zip(&mut table) {
        let exact = decode((f64::from(code) + 0.5) / 255.0);
        let near = narrow(exact);
        *value = if f64::from(near) < exact {
            near.next_up()
        } else {
            near
        };
    }
    table
});

/// The 8-bit sRGB code of a linear value: the number of thresholds that are at or below it. NaN
/// gives 0.
#[must_use]
pub fn srgb_from_linear(linear: f32) -> u8 {
    // There are 255 thresholds, so the count fits `u8`.
    u8::try_from(THRESHOLDS.partition_point(|threshold| *threshold <= linear)).unwrap_or(u8::MAX)
}

fn decode(encoded: f64) -> f64 {
    if encoded <= 0.04045 {
        return encoded / 12.92;
    }
    let x = (encoded + 0.055) / 1.055;
    let square = x * x;
    square * fifth_root(square)
}

/// The fifth root of a number in 0..=1, accurate to the last bits of f64.
fn fifth_root(a: f64) -> f64 {
    let mut y = 1.0;
    // Started from above, Newton's iteration decreases until rounding stops it; 100 steps are
    // ample.
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
