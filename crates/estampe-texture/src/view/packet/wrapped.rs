//! Integer texel coordinates of lanes, wrapped as the scalar code wraps them (`axis::wrapped`): for
//! gathers, and for samples with an offset.

use estampe_types::{AddressMode, Int, Real};

/// Wraps integer texel coordinates and the next ones, each by itself, into a level of `count`
/// texels: 1 to 16,384. Texels are within ±(2²⁴ + 1024). Borders are not found here:
/// [`AddressMode::ClampToBorder`] clamps to the edge.
///
/// It is a function of its own, which all axes and all kinds of texels share.
#[inline(always)]
pub(super) fn wrapped<R: Real>(
    like: R,
    first: R::Int,
    count: i32,
    mode: AddressMode,
) -> [R::Int; 2] {
    like.out_of_line(
        #[inline(always)]
        || wrapped_inline(first, count, mode),
    )
}

#[inline(always)]
fn wrapped_inline<I: Int>(first: I, count: i32, mode: AddressMode) -> [I; 2] {
    let (zero, one) = (first.splat(0), first.splat(1));
    let last = first.splat(count - 1);
    match mode {
        AddressMode::ClampToEdge | AddressMode::ClampToBorder => {
            let next = first + one;
            [first.max(zero).min(last), next.max(zero).min(last)]
        }
        AddressMode::MirrorOnce => {
            let next = first + one;
            [mirrored(first).min(last), mirrored(next).min(last)]
        }
        AddressMode::Repeat => {
            let first = remainder(first, count);
            [first, following(first, count)]
        }
        AddressMode::MirrorRepeat => {
            let period = 2 * count;
            let first = remainder(first, period);
            let next = following(first, period);
            let side = first.splat(count);
            [last - mirrored(first - side), last - mirrored(next - side)]
        }
    }
}

/// Mirrors negative texels: −1 is texel 0.
#[inline(always)]
fn mirrored<I: Int>(texel: I) -> I {
    // All bits of negative numbers are inverted, which gives −1 − texel.
    texel ^ (texel >> 31)
}

/// The texel after one of a period, which begins again after its last texel.
#[inline(always)]
fn following<I: Int>(texel: I, period: i32) -> I {
    let next = texel + texel.splat(1);
    I::select(next.eq(next.splat(period)), next.splat(0), next)
}

/// The remainder in 0..period, exactly, of texels within ±(2²⁴ + 1024), for periods of 1 to 32,768.
///
/// The quotient of floats is off by less than 1, so that its floor is the exact one or a neighbour
/// of it. Beyond 2²⁴ a texel is rounded by 1 at most, and of a period of 1 or 2 the division is
/// exact: the quotient is off by at most 1 there, and an integer, or by ½. Of longer periods, the
/// quotient is below 2²⁴ ÷ 3 + 342, and two roundings of 2⁻²⁴ make an error below 0.67.
#[inline(always)]
fn remainder<I: Int>(texel: I, period: i32) -> I {
    let (zero, side) = (texel.splat(0), texel.splat(period));
    let quotient = (texel.to_real() / side.to_real()).floor();
    // Within ±(2²⁴ + 1024 + period): nothing overflows.
    let rest = texel - quotient.to_int_within_range() * side;
    let rest = I::select(rest.lt(zero), rest + side, rest);
    I::select(rest.lt(side), rest, rest - side)
}
