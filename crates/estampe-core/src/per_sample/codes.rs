//! Between colours and their 8-bit codes: unorm by arithmetic, sRGB by tables.

use estampe_simd::{Bytes, Lanes, SimdBase, SimdCvtFloat, SimdCvtTruncate, f32x16, i32x16, u32x16};
use estampe_types::srgb::{LINEAR_BITS_FROM_SRGB, THRESHOLDS, srgb_from_linear};
use std::sync::LazyLock;

/// Tables for encoding sRGB sixteen at a time.
///
/// In a bucket of 1/4096 lies at most one threshold (their least distance is 1/3294), so the code of a
/// value is that of its bucket's start, or one more if the value reaches the next threshold. `start[b]`
/// is the code of b/4096.
struct EncodeTables {
    start: [u32; BUCKETS + 1],
    /// The threshold above each code, as bits; none above the last.
    next: [u32; 256],
}

const BUCKETS: usize = 4096;

static ENCODE: LazyLock<EncodeTables> = LazyLock::new(|| {
    let mut tables = EncodeTables {
        start: [0; BUCKETS + 1],
        next: [0; 256],
    };
    for (bucket, code) in tables.start.iter_mut().enumerate() {
        // Exact: a small integer over a power of two.
        *code = u32::from(srgb_from_linear(bucket as f32 / BUCKETS as f32));
    }
    for (code, next) in tables.next.iter_mut().enumerate() {
        *next = THRESHOLDS
            .get(code)
            .copied()
            .unwrap_or(f32::INFINITY)
            .to_bits();
    }
    tables
});

/// 0..=1, NaN being 0.
#[inline(always)]
pub(crate) fn saturate<S: Lanes>(s: S, value: f32x16<S>) -> f32x16<S> {
    let zero = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
    let one = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
    s.min_f32(s.max_f32(value, zero), one)
}

/// floor(x·255 + ½) of a value in 0..=1.
#[inline(always)]
fn unorm_code<S: Lanes>(value: f32x16<S>) -> u32x16<S> {
    i32x16::truncate_from(value * 255.0 + 0.5).bitcast()
}

/// The sRGB code of a value in 0..=1.
#[inline(always)]
fn srgb_code<S: Lanes>(s: S, value: f32x16<S>) -> u32x16<S> {
    let bucket: u32x16<S> = i32x16::truncate_from(value * BUCKETS as f32).bitcast();
    let start = s.gather(&ENCODE.start, bucket);
    let next: f32x16<S> = s.gather(&ENCODE.next, start).bitcast();
    let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
    start + estampe_simd::Select::select(value.simd_ge(next), splat(1), splat(0))
}

/// Packs four channels, R in the low byte.
#[inline(always)]
pub(crate) fn pack<S: Lanes>(s: S, [r, g, b, a]: [f32x16<S>; 4], is_srgb: bool) -> u32x16<S> {
    let [r, g, b, a] = [
        saturate(s, r),
        saturate(s, g),
        saturate(s, b),
        saturate(s, a),
    ];
    let alpha = unorm_code(a) << 24;
    let [r, g, b] = if is_srgb {
        [srgb_code(s, r), srgb_code(s, g), srgb_code(s, b)]
    } else {
        [unorm_code(r), unorm_code(g), unorm_code(b)]
    };
    r | (g << 8) | (b << 16) | alpha
}

/// [`pack`] of R, G, B as unorm, each at least 0, and above 1 by less than 1/512.
#[inline(always)]
pub(crate) fn pack_color_unclamped<S: Lanes>([r, g, b]: [f32x16<S>; 3]) -> u32x16<S> {
    unorm_code(r) | (unorm_code(g) << 8) | (unorm_code(b) << 16)
}

/// The same of alpha.
#[inline(always)]
pub(crate) fn alpha_code_unclamped<S: Lanes>(alpha: f32x16<S>) -> u32x16<S> {
    unorm_code(alpha) << 24
}

/// The linear values of sRGB codes.
#[inline(always)]
fn linear<S: Lanes>(s: S, code: u32x16<S>) -> f32x16<S> {
    s.gather(&*LINEAR_BITS_FROM_SRGB, code).bitcast()
}

/// Takes four channels apart.
#[inline(always)]
pub(crate) fn unpack<S: Lanes>(s: S, packed: u32x16<S>, is_srgb: bool) -> [f32x16<S>; 4] {
    let byte = |code: u32x16<S>| code & <u32x16<S> as SimdBase<S>>::splat(s, 0xFF);
    let [r, g, b] = [byte(packed), byte(packed >> 8), byte(packed >> 16)];
    let unorm = |code: u32x16<S>| {
        let signed: i32x16<S> = code.bitcast();
        f32x16::float_from(signed) * (1.0 / 255.0)
    };
    let alpha = unorm(packed >> 24);
    if is_srgb {
        return [linear(s, r), linear(s, g), linear(s, b), alpha];
    }
    [unorm(r), unorm(g), unorm(b), alpha]
}

/// Packs one colour, as [`pack`] does sixteen.
pub(crate) fn pack_one(rgba: [f32; 4], is_srgb: bool) -> u32 {
    let saturate = |value: f32| {
        let positive = if value > 0.0 { value } else { 0.0 };
        if positive < 1.0 { positive } else { 1.0 }
    };
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0..=255"
    )]
    let unorm = |value: f32| (saturate(value) * 255.0 + 0.5) as u32;
    let color = |value: f32| {
        if is_srgb {
            u32::from(srgb_from_linear(saturate(value)))
        } else {
            unorm(value)
        }
    };
    let [r, g, b, a] = rgba;
    color(r) | color(g) << 8 | color(b) << 16 | unorm(a) << 24
}

/// Takes one colour apart; the sibling of [`pack_one`], for tests.
#[cfg(test)]
fn unpack_one(packed: u32, is_srgb: bool) -> [f32; 4] {
    let [r, g, b, a] = packed.to_le_bytes();
    let color = |code: u8| {
        if is_srgb {
            estampe_types::srgb::LINEAR_FROM_SRGB[usize::from(code)]
        } else {
            f32::from(code) * (1.0 / 255.0)
        }
    };
    [color(r), color(g), color(b), f32::from(a) * (1.0 / 255.0)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_simd::{LANES, Level, dispatch};

    #[inline(always)]
    fn packed<S: Lanes>(s: S, values: [f32; LANES], is_srgb: bool) -> [u32; LANES] {
        let value = f32x16::load_array(s, values);
        pack(s, [value; 4], is_srgb).to_array()
    }

    #[inline(always)]
    fn unpacked<S: Lanes>(s: S, codes: [u32; LANES], is_srgb: bool) -> [[f32; LANES]; 4] {
        let [r, g, b, a] = unpack(s, u32x16::load_array(s, codes), is_srgb);
        [r.to_array(), g.to_array(), b.to_array(), a.to_array()]
    }

    #[test]
    fn sixteen_colors_pack_like_one() {
        let mut values: Vec<f32> = vec![f32::NAN, f32::INFINITY, -1.0, -0.0, 0.0, 1.0, 2.0, 1e-40];
        values.extend(
            THRESHOLDS
                .iter()
                .flat_map(|&t| [t, t.next_down(), t.next_up()]),
        );
        values.extend((0..5000).map(|i| i as f32 / 4999.0));
        for is_srgb in [false, true] {
            for chunk in values.chunks_exact(LANES) {
                let chunk: [f32; LANES] = chunk.try_into().expect("whole chunks");
                for level in Level::all_available() {
                    let got = dispatch!(level, s => packed(s, chunk, is_srgb));
                    assert_eq!(
                        got,
                        chunk.map(|v| pack_one([v; 4], is_srgb)),
                        "{level:?} {chunk:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn codes_survive_the_round_trip() {
        for is_srgb in [false, true] {
            for first in (0..256u32).step_by(LANES) {
                let mut codes = [0u32; LANES];
                for (code, lane) in codes.iter_mut().zip(first..) {
                    *code = lane * 0x0101_0101;
                }
                for level in Level::all_available() {
                    let channels = dispatch!(level, s => unpacked(s, codes, is_srgb));
                    for (lane, code) in codes.into_iter().enumerate() {
                        let rgba = channels.map(|channel| channel[lane]);
                        assert_eq!(rgba, unpack_one(code, is_srgb), "{level:?}");
                        assert_eq!(pack_one(rgba, is_srgb), code);
                    }
                }
            }
        }
    }
}
