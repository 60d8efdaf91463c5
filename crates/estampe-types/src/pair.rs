//! Packet pairs: two packets as one number.

use crate::operand::join_number;
use crate::{Int, Operand, Real};
use estampe_simd::Level;
use std::ops::{
    Add, AddAssign, BitAnd, BitOr, BitXor, Div, DivAssign, Mul, MulAssign, Neg, Not, Shl, Shr, Sub,
    SubAssign,
};

/// Two numbers (or masks) side by side; the lanes of the first come before those of the second.
///
/// Each operation is done on both halves, which do not depend on each other. Where each operation
/// depends on the previous one, a single packet leaves most of the processor's execution units
/// idle. So fragments are shaded two packets at a time where one register holds a packet. Where
/// they have long loops they are shaded a pair of pairs at a time there, and a pair at a time where
/// two registers hold a packet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair<T>(pub T, pub T);

/// Implements operators for pairs whose halves have them.
macro_rules! operators {
    (assign $($trait:ident $method:ident;)*) => {$(
        impl<T: $trait> $trait for Pair<T> {
            #[inline(always)]
            fn $method(&mut self, other: Self) {
                self.0.$method(other.0);
                self.1.$method(other.1);
            }
        }
        impl<T: $trait<f32>> $trait<f32> for Pair<T> {
            #[inline(always)]
            fn $method(&mut self, other: f32) {
                self.0.$method(other);
                self.1.$method(other);
            }
        }
    )*};
    (left $($trait:ident $method:ident;)*) => {$(
        // By `splat`: a bound `f32: Add<R>` here would send the compiler from pair to pair.
        impl<R: Real> $trait<Pair<R>> for f32 {
            type Output = Pair<R>;
            #[inline(always)]
            fn $method(self, other: Pair<R>) -> Pair<R> {
                $trait::$method(Real::splat(other, self), other)
            }
        }
    )*};
    ($($trait:ident $method:ident;)*) => {$(
        impl<T: $trait<Output = T>> $trait for Pair<T> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0), self.1.$method(other.1))
            }
        }
    )*};
    ($by:ty => $($trait:ident $method:ident;)*) => {$(
        impl<T: $trait<$by, Output = T>> $trait<$by> for Pair<T> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, by: $by) -> Self {
                Self(self.0.$method(by), self.1.$method(by))
            }
        }
    )*};
}
operators! { Add add; Sub sub; Mul mul; Div div; BitAnd bitand; BitOr bitor; BitXor bitxor; }
operators! { f32 => Add add; Sub sub; Mul mul; Div div; }
operators! { u32 => Shl shl; Shr shr; }
operators! { left Add add; Sub sub; Mul mul; Div div; }
operators! { assign AddAssign add_assign; SubAssign sub_assign; MulAssign mul_assign; DivAssign div_assign; }

impl<T: Neg<Output = T>> Neg for Pair<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl<T: Not<Output = T>> Not for Pair<T> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0, !self.1)
    }
}

join_number! { [R: Real] Pair<R> }

/// Implements methods that call the same method on both halves.
macro_rules! both {
    (with_other $($name:ident -> $out:ty;)*) => {$(
        #[inline(always)]
        fn $name(self, other: Self) -> $out {
            Pair(self.0.$name(other.0), self.1.$name(other.1))
        }
    )*};
    (with_operand $($name:ident -> $out:ty;)*) => {$(
        #[inline(always)]
        fn $name(self, other: impl Operand<Self>) -> $out {
            let other = other.operand(self);
            Pair(self.0.$name(other.0), self.1.$name(other.1))
        }
    )*};
    ($($name:ident($($argument:ident: $type:ty),*) -> $out:ty;)*) => {$(
        #[inline(always)]
        fn $name(self $(, $argument: $type)*) -> $out {
            Pair(self.0.$name($($argument),*), self.1.$name($($argument),*))
        }
    )*};
}

impl<R: Real> Real for Pair<R> {
    type SelectMask = Pair<R::SelectMask>;
    type Int = Pair<R::Int>;
    const LANES: usize = 2 * R::LANES;
    // The scalar level shades quads; it never makes pairs.
    const EMULATED_LANES: bool = false;

    both! {
        splat(value: f32) -> Self;
        splat_int(value: i32) -> Pair<R::Int>;
        splat_mask(value: bool) -> Pair<R::SelectMask>;
        sqrt() -> Self;
        abs() -> Self;
        floor() -> Self;
        to_int() -> Pair<R::Int>;
        to_int_within_range() -> Pair<R::Int>;
        to_bits() -> Pair<R::Int>;
        ddx() -> Self;
        ddy() -> Self;
        ddx_coarse() -> Self;
        ddy_coarse() -> Self;
        quad_lane(index: u8) -> Self;
    }
    both! { with_operand
        min -> Self;
        max -> Self;
        lt -> Pair<R::SelectMask>;
        le -> Pair<R::SelectMask>;
        eq -> Pair<R::SelectMask>;
    }
    #[inline(always)]
    fn select(mask: Pair<R::SelectMask>, yes: Self, no: Self) -> Self {
        Self(
            R::select(mask.0, yes.0, no.0),
            R::select(mask.1, yes.1, no.1),
        )
    }
    #[inline(always)]
    fn any(mask: Pair<R::SelectMask>) -> bool {
        R::any(mask.0 | mask.1)
    }
    #[inline(always)]
    fn mask_bits(mask: Pair<R::SelectMask>) -> u64 {
        R::mask_bits(mask.0) | R::mask_bits(mask.1) << R::LANES
    }
    #[inline(always)]
    fn out_of_line<T>(self, work: impl FnOnce() -> T) -> T {
        self.0.out_of_line(work)
    }
    #[inline(always)]
    fn level(self) -> Option<Level> {
        self.0.level()
    }
    #[inline(always)]
    fn lane(self, index: usize) -> f32 {
        if index < R::LANES {
            self.0.lane(index)
        } else {
            self.1.lane(index - R::LANES)
        }
    }
    #[inline(always)]
    fn with_lanes(self, mut value: impl FnMut(usize) -> f32) -> Self {
        Self(
            self.0.with_lanes(&mut value),
            self.1.with_lanes(
                #[inline(always)]
                |lane| value(R::LANES + lane),
            ),
        )
    }
}

impl<I: Int> Int for Pair<I> {
    type Real = Pair<I::Real>;
    type SelectMask = Pair<<I::Real as Real>::SelectMask>;

    both! {
        splat(value: i32) -> Self;
        shr_unsigned(by: u32) -> Self;
        to_real() -> Pair<I::Real>;
        to_real_bits() -> Pair<I::Real>;
        is_outside(count: i32) -> Self::SelectMask;
        gather(table: &[u32]) -> Self;
    }
    both! { with_other
        wrapping_mul -> Self;
        min -> Self;
        max -> Self;
        lt -> Self::SelectMask;
        eq -> Self::SelectMask;
    }
    #[inline(always)]
    fn select(mask: Self::SelectMask, yes: Self, no: Self) -> Self {
        Self(
            I::select(mask.0, yes.0, no.0),
            I::select(mask.1, yes.1, no.1),
        )
    }
    #[inline(always)]
    fn gather_square(self, table: &[u32], stride: i32) -> [Self; 4] {
        let [a, b, c, d] = self.0.gather_square(table, stride);
        let [e, f, g, h] = self.1.gather_square(table, stride);
        [Self(a, e), Self(b, f), Self(c, g), Self(d, h)]
    }
    #[inline(always)]
    fn lane(self, index: usize) -> i32 {
        let lanes = <I::Real as Real>::LANES;
        if index < lanes {
            self.0.lane(index)
        } else {
            self.1.lane(index - lanes)
        }
    }
}
