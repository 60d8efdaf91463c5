//! Component-wise functions of numbers and vectors, as free functions.

use super::{Componentwise, scalar};
use crate::Real;
use crate::operand::{Join, Operand};

/// The kind of the result of two operands.
type Joined<A, B> = <A as Join<B>>::Joined;

macro_rules! one_operand {
    ($($(#[$doc:meta])* $name:ident)+) => {$(
        $(#[$doc])*
        #[inline(always)]
        #[must_use]
        pub fn $name<V: Componentwise>(x: V) -> V {
            x.$name()
        }
    )+};
}

macro_rules! two_operands {
    ($($(#[$doc:meta])* $name:ident($x:ident, $y:ident))+) => {$(
        $(#[$doc])*
        #[inline(always)]
        #[must_use]
        pub fn $name<A: Join<B, Joined: Componentwise>, B>($x: A, $y: B) -> Joined<A, B> {
            let (left, right) = $x.join($y);
            left.$name(right)
        }
    )+};
}

super::with_functions! { free_functions }

two_operands! {
    /// `x < y ? x : y`: `y` where either is NaN.
    min(x, y)
    /// `x > y ? x : y`: `y` where either is NaN.
    max(x, y)
    /// 1 where `x ≥ edge`, else 0 (also for NaN).
    step(edge, x)
}

/// xⁿ by repeated squaring, from the lowest bit of n on.
#[inline(always)]
#[must_use]
pub fn powi<R: Real>(x: R, n: u32) -> R {
    scalar::powi(x, n)
}

/// `x` clamped to `low..=high`: `max(low)` then `min(high)`; NaN gives `low`.
#[inline(always)]
#[must_use]
pub fn clamp<V: Componentwise>(x: V, low: impl Operand<V>, high: impl Operand<V>) -> V {
    x.max(low.operand(x)).min(high.operand(x))
}

/// Linear interpolation `a + (b − a)·t`: `a` at t = 0; at t = 1 the rounding of `a + (b − a)`.
#[inline(always)]
#[must_use]
pub fn mix<A, B, T>(a: A, b: B, t: T) -> Joined<Joined<A, B>, T>
where
    A: Join<B, Joined: Join<T, Joined: Componentwise>>,
    T: Copy,
{
    let (a, b) = a.join(b);
    let (a, wide) = a.join(t);
    let (b, _) = b.join(t);
    a.mix(b, wide)
}

/// 0 where `x ≤ low`, 1 where `x ≥ high`, between them t²·(3 − 2t) with t = (x − low) ÷ (high −
/// low) clamped to 0..=1. With low = high, NaN of 0 ÷ 0 counts as 0.
#[inline(always)]
#[must_use]
pub fn smoothstep<V: Componentwise>(low: impl Operand<V>, high: impl Operand<V>, x: V) -> V {
    low.operand(x).smoothstep(high.operand(x), x)
}

/// `yes` in the lanes where the mask is true, `no` in the others: WGSL's order of arguments.
///
/// [`Real::select`] has the mask first.
#[inline(always)]
#[must_use]
pub fn select<A: Join<B, Joined: Componentwise>, B>(
    no: A,
    yes: B,
    mask: <Joined<A, B> as Componentwise>::SelectMask,
) -> Joined<A, B> {
    let (no, yes) = no.join(yes);
    Componentwise::select(mask, yes, no)
}
