//! Decimal numbers from bytes, correctly rounded and fast.
//!
//! A decimal is w · 10^e with an integer w of up to 19 digits. The idea is Clinger's (1990):
//! compute d = w · 10^e in f64 and round that to f32. Here w, 10^e and the product are each rounded
//! once, each time by a unit in the last place of d at most, so d is off by little more than 3 such
//! units. Rounding d to f32 gives the right answer unless a point midway between two f32 lies
//! within that error: the 29 bits of d that f32 drops are then near 1000…0. Those cases (one in ten
//! million), and results outside f32's normal range, go to the standard library, which is exact and
//! slow.

/// Powers of ten, each the f64 nearest to it.
const POWERS_OF_TEN: [f64; 39] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22, 1e23, 1e24, 1e25, 1e26, 1e27, 1e28, 1e29, 1e30, 1e31, 1e32,
    1e33, 1e34, 1e35, 1e36, 1e37, 1e38,
];

/// Negative powers of ten, each the f64 nearest to it: a product takes a third of the time of a
/// quotient.
const NEGATIVE_POWERS_OF_TEN: [f64; 39] = [
    1e-0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14,
    1e-15, 1e-16, 1e-17, 1e-18, 1e-19, 1e-20, 1e-21, 1e-22, 1e-23, 1e-24, 1e-25, 1e-26, 1e-27,
    1e-28, 1e-29, 1e-30, 1e-31, 1e-32, 1e-33, 1e-34, 1e-35, 1e-36, 1e-37, 1e-38,
];

/// Bits of an f64 that f32 does not have.
const DROPPED_BITS: u64 = (1 << 29) - 1;
/// Those bits midway between two f32.
const MIDPOINT: u64 = 1 << 28;
/// More than the error of a product.
const ERROR_ULPS: u64 = 4;

/// The number of decimal digits that always fit u64.
const MAX_DIGITS: usize = 19;

/// Reads the number at the start of `text`; also returns its length in bytes.
///
/// `None` if no number starts there. A sign, a leading point and an exponent may be present; values
/// beyond f32 become ±∞. `nan` and `inf` in any case, and the spellings of old C libraries
/// (`-nan(ind)`, `1.#QNAN`), are numbers too.
#[inline]
pub(super) fn parse_f32(text: &[u8]) -> Option<(f32, usize)> {
    let negative = text.first() == Some(&b'-');
    let start = usize::from(negative || text.first() == Some(&b'+'));
    let mut at = start;
    let mut mantissa = 0_u64;
    let mut digits = take_digits(text, &mut at, &mut mantissa);
    let mut exponent = 0_i64;
    if text.get(at) == Some(&b'.') {
        at += 1;
        let before = at;
        digits += take_digits(text, &mut at, &mut mantissa);
        exponent = before as i64 - at as i64;
        if text.get(at) == Some(&b'#') {
            return parse_named(text, start);
        }
    }
    if digits == 0 {
        return parse_named(text, start);
    }
    if let Some(b'e' | b'E') = text.get(at) {
        exponent += take_exponent(text, &mut at);
    }
    if digits > MAX_DIGITS {
        // Leading zeros count as digits, so the number need not be long; other cases are rare.
        return Some((exact(&text[..at]), at));
    }
    let value = rounded(mantissa, exponent).unwrap_or_else(|| exact(&text[start..at]));
    Some((if negative { -value } else { value }, at))
}

/// [`parse_f32`] of a number as nearly all are written: digits, and perhaps a point and digits, at
/// most seven of each. `None` if it is another one, or one that needs the exact way. The caller
/// checks that the number ends there.
#[inline(always)]
pub(super) fn parse_usual_f32(text: &[u8]) -> Option<(f32, usize)> {
    let negative = *text.first()? == b'-';
    let start = usize::from(negative);
    let (whole, digits) = leading_digits(text.get(start..)?)?;
    if digits.wrapping_sub(1) >= 7 {
        return None;
    }
    let mut at = start + digits;
    let (mut mantissa, mut count) = (whole, 0);
    if text.get(at) == Some(&b'.') {
        let fraction;
        (fraction, count) = leading_digits(text.get(at + 1..)?)?;
        if count > 7 {
            return None;
        }
        mantissa = whole * DECIMAL_SHIFTS[count] + fraction;
        at += 1 + count;
    }
    // Below 10^14, and 0 or at least 10^-7: exact in f64, and normal in f32.
    let wide = i64::try_from(mantissa).ok()? as f64 * NEGATIVE_POWERS_OF_TEN[count];
    let from_midpoint = (wide.to_bits() & DROPPED_BITS).abs_diff(MIDPOINT);
    if from_midpoint <= ERROR_ULPS {
        return None;
    }
    #[expect(clippy::cast_possible_truncation, reason = "the rounding is the point")]
    let value = wide as f32;
    let sign = u32::from(negative) << 31;
    Some((f32::from_bits(value.to_bits() | sign), at))
}

/// Appends the digits at `*at` to `mantissa` and returns their number. Wraps after 19.
#[inline]
fn take_digits(text: &[u8], at: &mut usize, mantissa: &mut u64) -> usize {
    let start = *at;
    while let Some((value, count)) = text.get(*at..).and_then(leading_digits) {
        *mantissa = mantissa
            .wrapping_mul(DECIMAL_SHIFTS[count])
            .wrapping_add(value);
        *at += count;
        if count < 8 {
            return *at - start;
        }
    }
    // The last bytes of the text, one by one.
    while let Some(digit) = text
        .get(*at)
        .map(|byte| byte.wrapping_sub(b'0'))
        .filter(|&d| d < 10)
    {
        *mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
        *at += 1;
    }
    *at - start
}

/// 10 to the power of a number of digits.
const DECIMAL_SHIFTS: [u64; 9] = [
    1,
    10,
    100,
    1000,
    10_000,
    100_000,
    1_000_000,
    10_000_000,
    100_000_000,
];

/// The number that the first digits of eight bytes are, up to all eight, and how many they are;
/// `None` if fewer bytes are left. In one register: pairs of digits are added, then pairs of those,
/// then both halves.
#[inline(always)]
pub(super) fn leading_digits(text: &[u8]) -> Option<(u64, usize)> {
    const ZEROS: u64 = u64::from_le_bytes([b'0'; 8]);
    /// Added to a byte above `9`, this sets its highest bit.
    const ABOVE_NINE: u64 = u64::from_le_bytes([0x7F - b'9'; 8]);
    const HIGHEST_BITS: u64 = u64::from_le_bytes([0x80; 8]);
    /// Of each four bytes the first.
    const OF_FOUR: u64 = 0x0000_00FF_0000_00FF;
    let bytes = u64::from_le_bytes(*text.first_chunk()?);
    // Carries and borrows leave bytes that are no digits, which come after the first of these.
    let digits = bytes.wrapping_sub(ZEROS);
    let others = (bytes.wrapping_add(ABOVE_NINE) | digits) & HIGHEST_BITS;
    let count = others.trailing_zeros() as usize / 8;
    // Zeros come before the digits; shifted twice, as 64 bits would be too many at once.
    let unused_bits = 64 - 8 * count;
    let digits = digits << (unused_bits / 2) << (unused_bits / 2);
    let pairs = digits.wrapping_mul(10).wrapping_add(digits >> 8);
    let low = (pairs & OF_FOUR).wrapping_mul(100 + (1_000_000 << 32));
    let high = (pairs >> 16 & OF_FOUR).wrapping_mul(1 + (10_000 << 32));
    Some((low.wrapping_add(high) >> 32, count))
}

/// The exponent whose `e` is at `*at`; 0, with `*at` unmoved, when no digits follow.
#[cold]
fn take_exponent(text: &[u8], at: &mut usize) -> i64 {
    /// Exceeds every float, even with a million digits before the point; sums with it cannot
    /// overflow.
    const LARGEST: i64 = 1 << 40;
    let sign = text.get(*at + 1);
    let first = *at + 1 + usize::from(matches!(sign, Some(b'-' | b'+')));
    let digits = text[first.min(text.len())..]
        .iter()
        .take_while(|byte| byte.is_ascii_digit());
    let mut value = 0_i64;
    let mut count = 0;
    for digit in digits {
        value = (value * 10 + i64::from(digit - b'0')).min(LARGEST);
        count += 1;
    }
    if count == 0 {
        return 0;
    }
    *at = first + count;
    if sign == Some(&b'-') { -value } else { value }
}

/// w · 10^e rounded to f32, if the f64 product determines it.
#[inline]
fn rounded(mantissa: u64, exponent: i64) -> Option<f32> {
    if mantissa == 0 {
        return Some(0.0);
    }
    let powers = if exponent < 0 {
        &NEGATIVE_POWERS_OF_TEN
    } else {
        &POWERS_OF_TEN
    };
    let power = *powers.get(usize::try_from(exponent.unsigned_abs()).ok()?)?;
    let wide = mantissa as f64 * power;
    let is_normal = wide >= f64::from(f32::MIN_POSITIVE) && wide < f64::from(f32::MAX);
    let from_midpoint = (wide.to_bits() & DROPPED_BITS).abs_diff(MIDPOINT);
    #[expect(clippy::cast_possible_truncation, reason = "the rounding is the point")]
    (is_normal && from_midpoint > ERROR_ULPS).then_some(wide as f32)
}

/// The standard library's result.
#[cold]
fn exact(text: &[u8]) -> f32 {
    std::str::from_utf8(text)
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(f32::NAN)
}

/// Values with names instead of digits.
#[cold]
fn parse_named(text: &[u8], start: usize) -> Option<(f32, usize)> {
    let is_end = |byte: &u8| byte.is_ascii_whitespace() || *byte == b'/';
    let length = text[start..]
        .iter()
        .position(is_end)
        .unwrap_or(text.len() - start);
    let word = &text[start..start + length];
    let end = start + length;
    let begins = |name: &[u8]| {
        word.get(..name.len())
            .is_some_and(|head| head.eq_ignore_ascii_case(name))
    };
    if begins(b"nan") || word.contains(&b'#') && !begins(b"1.#inf") {
        // `#` alone would be a comment; only a number before it makes it one of these names.
        return (begins(b"nan") || begins(b"1.#") || begins(b"-1.#")).then_some((f32::NAN, end));
    }
    if begins(b"inf") || begins(b"1.#inf") {
        let is_negative = start == 1 && text[0] == b'-';
        return Some((
            if is_negative {
                f32::NEG_INFINITY
            } else {
                f32::INFINITY
            },
            end,
        ));
    }
    None
}

/// Reads the integer at the start of `text`; also returns its length in bytes. Saturates.
#[inline]
pub(super) fn parse_i64(text: &[u8]) -> Option<(i64, usize)> {
    let negative = text.first() == Some(&b'-');
    let start = usize::from(negative || text.first() == Some(&b'+'));
    let mut at = start;
    let mut value = 0_i64;
    while let Some(digit) = text
        .get(at)
        .map(|byte| byte.wrapping_sub(b'0'))
        .filter(|&d| d < 10)
    {
        value = value.saturating_mul(10).saturating_add(i64::from(digit));
        at += 1;
    }
    (at > start).then_some((if negative { -value } else { value }, at))
}
