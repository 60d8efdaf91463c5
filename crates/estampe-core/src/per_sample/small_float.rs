//! Floats of fewer than 32 bits, as attachments store them.
//!
//! *Spec* IEEE 754 binary16; Vulkan §Unsigned 11-Bit and 10-Bit Floating-Point Numbers. Rounded to nearest, ties to
//! even; NaN becomes the quiet one without sign. See `docs/NUMERICS.md`, *Formats*.

/// A float's exponent and mantissa in a format with five bits of exponent, bias 15, and `MANTISSA` bits of mantissa,
/// of a magnitude's bits (sign 0, not NaN).
#[inline(always)]
fn magnitude<const MANTISSA: u32>(bits: u32) -> u32 {
    let infinity = 31 << MANTISSA;
    let dropped = 23 - MANTISSA;
    // The least normal number is 2⁻¹⁴; the format's exponent field is the float's less 112.
    if bits >= 113 << 23 {
        let rebased = bits - (112 << 23);
        let half = (1 << (dropped - 1)) - 1;
        let rounded = (rebased + half + (rebased >> dropped & 1)) >> dropped;
        return rounded.min(infinity);
    }
    // Below it, a multiple of the least one, 2^(−14 − MANTISSA): its mantissa is shifted right.
    let exponent = bits >> 23;
    let shift = dropped + 113 - exponent;
    if shift > 25 {
        return 0;
    }
    let mantissa = bits & 0x007F_FFFF | 0x0080_0000;
    let half = (1 << (shift - 1)) - 1;
    (mantissa + half + (mantissa >> shift & 1)) >> shift
}

/// A magnitude's float: the inverse of [`magnitude`], exact.
#[inline(always)]
fn widened<const MANTISSA: u32>(bits: u32) -> f32 {
    let dropped = 23 - MANTISSA;
    let (exponent, mantissa) = (bits >> MANTISSA, bits & ((1 << MANTISSA) - 1));
    match exponent {
        // A multiple of a power of two: exact.
        0 => mantissa as f32 * f32::from_bits((127 - 14 - MANTISSA) << 23),
        31 if mantissa != 0 => f32::NAN,
        31 => f32::INFINITY,
        _ => f32::from_bits((exponent + 112) << 23 | mantissa << dropped),
    }
}

/// The half float nearest to a number.
#[inline(always)]
pub(crate) fn half_of(value: f32) -> u32 {
    if value.is_nan() {
        return 0x7E00;
    }
    let bits = value.to_bits();
    bits >> 16 & 0x8000 | magnitude::<10>(bits & 0x7FFF_FFFF)
}

/// A half float's number.
#[inline(always)]
pub(crate) fn float_of_half(half: u32) -> f32 {
    let value = widened::<10>(half & 0x7FFF);
    if half & 0x8000 != 0 { -value } else { value }
}

/// The unsigned float of `MANTISSA` (6 or 5) bits of mantissa nearest to a number; 0 of negative ones, the greatest
/// finite one of those that are larger.
#[inline(always)]
pub(crate) fn unsigned_of<const MANTISSA: u32>(value: f32) -> u32 {
    if value.is_nan() {
        return 31 << MANTISSA | 1 << (MANTISSA - 1);
    }
    if value <= 0.0 {
        return 0;
    }
    let infinity = 31 << MANTISSA;
    if value == f32::INFINITY {
        return infinity;
    }
    magnitude::<MANTISSA>(value.to_bits()).min(infinity - 1)
}

/// An unsigned float's number.
#[inline(always)]
pub(crate) fn float_of_unsigned<const MANTISSA: u32>(bits: u32) -> f32 {
    widened::<MANTISSA>(bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_half_survives_and_neighbours_round_to_the_nearer() {
        for half in 0..0x8000_u32 {
            let value = float_of_half(half);
            if value.is_nan() {
                assert_eq!(half_of(value), 0x7E00);
                continue;
            }
            assert_eq!(half_of(value), half);
            assert_eq!(half_of(-value), half | 0x8000);
            let next = float_of_half(half + 1);
            if next.is_finite() {
                let middle = (value + next) / 2.0;
                assert_eq!(half_of(middle), half + (half & 1), "ties to even");
                assert_eq!(half_of(middle.next_down()), half);
                assert_eq!(half_of(middle.next_up()), half + 1);
            }
        }
        assert_eq!(half_of(65_519.0), 0x7BFF);
        assert_eq!(half_of(65_520.0), 0x7C00);
        assert_eq!(half_of(f32::MAX), 0x7C00);
        assert_eq!(half_of(1.0), 0x3C00);
    }

    #[test]
    fn unsigned_floats_survive() {
        for bits in 0..31 << 6 {
            assert_eq!(unsigned_of::<6>(float_of_unsigned::<6>(bits)), bits);
        }
        for bits in 0..31 << 5 {
            assert_eq!(unsigned_of::<5>(float_of_unsigned::<5>(bits)), bits);
        }
        assert_eq!(unsigned_of::<6>(-3.0), 0);
        assert_eq!(float_of_unsigned::<6>(unsigned_of::<6>(1.0)), 1.0);
        assert_eq!(float_of_unsigned::<5>(unsigned_of::<5>(64_512.0)), 64_512.0);
        assert_eq!(unsigned_of::<6>(f32::INFINITY), 0x7C0);
        assert_eq!(unsigned_of::<6>(f32::MAX), 0x7BF);
        assert_eq!(unsigned_of::<5>(1e9), 0x3DF);
        assert_eq!(unsigned_of::<5>(f32::NAN), 0x3F0);
        assert!(float_of_unsigned::<5>(unsigned_of::<5>(f32::NAN)).is_nan());
    }
}
