//! Four fragments of a 2×2 quad as plain scalars.

use crate::operand::join_number;
use crate::{Int, Operand, Real};
use std::ops::{
    Add, AddAssign, BitAnd, BitOr, BitXor, Div, DivAssign, Mul, MulAssign, Neg, Not, Shl, Shr, Sub,
    SubAssign,
};

/// One value for each fragment of a 2×2 quad: top left, top right, bottom left, bottom right.
///
/// It is the smallest [`Real`] with true derivatives, in code that can be read and stepped through.
/// The scalar level and the oracle shade with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quad<T = f32>(pub [T; 4]);

impl<T: Copy> Quad<T> {
    #[inline(always)]
    fn each<U>(self, f: impl Fn(T) -> U) -> Quad<U> {
        let [a, b, c, d] = self.0;
        Quad([f(a), f(b), f(c), f(d)])
    }

    #[inline(always)]
    fn zip<U: Copy, V>(self, other: Quad<U>, f: impl Fn(T, U) -> V) -> Quad<V> {
        let ([a, b, c, d], [e, g, h, i]) = (self.0, other.0);
        Quad([f(a, e), f(b, g), f(c, h), f(d, i)])
    }
}

macro_rules! operators {
    ($kind:ty; $($trait:ident $method:ident $f:expr;)*) => {$(
        impl $trait for Quad<$kind> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, $f)
            }
        }
    )*};
}
operators! { f32; Add add |a, b| a + b; Sub sub |a, b| a - b; Mul mul |a, b| a * b; Div div |a, b| a / b; }
operators! { i32; Add add i32::wrapping_add; Sub sub i32::wrapping_sub; Mul mul i32::wrapping_mul;
BitAnd bitand |a, b| a & b; BitOr bitor |a, b| a | b; BitXor bitxor |a, b| a ^ b; }
operators! { bool; BitAnd bitand |a, b| a & b; BitOr bitor |a, b| a | b; }

macro_rules! with_scalar {
    ($($trait:ident $method:ident $assign:ident $assign_method:ident;)*) => {$(
        impl $trait<f32> for Quad {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f32) -> Self {
                $trait::$method(self, Quad([other; 4]))
            }
        }
        impl $trait<Quad> for f32 {
            type Output = Quad;
            #[inline(always)]
            fn $method(self, other: Quad) -> Quad {
                $trait::$method(Quad([self; 4]), other)
            }
        }
        impl $assign for Quad {
            #[inline(always)]
            fn $assign_method(&mut self, other: Self) {
                *self = $trait::$method(*self, other);
            }
        }
        impl $assign<f32> for Quad {
            #[inline(always)]
            fn $assign_method(&mut self, other: f32) {
                *self = $trait::$method(*self, other);
            }
        }
    )*};
}
with_scalar! { Add add AddAssign add_assign; Sub sub SubAssign sub_assign;
Mul mul MulAssign mul_assign; Div div DivAssign div_assign; }

impl Neg for Quad {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.each(|a| -a)
    }
}

impl Not for Quad<bool> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        self.each(|a| !a)
    }
}

impl Shl<u32> for Quad<i32> {
    type Output = Self;
    #[inline(always)]
    fn shl(self, by: u32) -> Self {
        self.each(|a| a << by)
    }
}

impl Shr<u32> for Quad<i32> {
    type Output = Self;
    #[inline(always)]
    fn shr(self, by: u32) -> Self {
        self.each(|a| a >> by)
    }
}

join_number! { [] Quad }

impl Real for Quad {
    type SelectMask = Quad<bool>;
    type Int = Quad<i32>;
    const LANES: usize = 4;
    const EMULATED_LANES: bool = true;

    #[inline(always)]
    fn splat(self, value: f32) -> Self {
        Self([value; 4])
    }
    #[inline(always)]
    fn splat_int(self, value: i32) -> Quad<i32> {
        Quad([value; 4])
    }
    #[inline(always)]
    fn splat_mask(self, value: bool) -> Quad<bool> {
        Quad([value; 4])
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.each(f32::sqrt)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.each(f32::abs)
    }
    #[inline(always)]
    fn floor(self) -> Self {
        self.each(f32::floor)
    }
    #[inline(always)]
    fn min(self, other: impl Operand<Self>) -> Self {
        self.zip(other.operand(self), Real::min)
    }
    #[inline(always)]
    fn max(self, other: impl Operand<Self>) -> Self {
        self.zip(other.operand(self), Real::max)
    }
    #[inline(always)]
    fn lt(self, other: impl Operand<Self>) -> Quad<bool> {
        self.zip(other.operand(self), |a, b| a < b)
    }
    #[inline(always)]
    fn le(self, other: impl Operand<Self>) -> Quad<bool> {
        self.zip(other.operand(self), |a, b| a <= b)
    }
    #[inline(always)]
    fn eq(self, other: impl Operand<Self>) -> Quad<bool> {
        self.zip(other.operand(self), |a, b| a == b)
    }
    #[inline(always)]
    fn select(mask: Quad<bool>, yes: Self, no: Self) -> Self {
        mask.zip(
            yes.zip(no, |a, b| (a, b)),
            |mask, (yes, no)| if mask { yes } else { no },
        )
    }
    #[inline(always)]
    fn any(mask: Quad<bool>) -> bool {
        mask.0.contains(&true)
    }
    #[inline(always)]
    fn mask_bits(mask: Quad<bool>) -> u64 {
        let [a, b, c, d] = mask.0.map(u64::from);
        a | b << 1 | c << 2 | d << 3
    }
    #[inline(always)]
    fn to_int(self) -> Quad<i32> {
        self.each(Real::to_int)
    }
    #[inline(always)]
    fn to_int_within_range(self) -> Quad<i32> {
        self.each(Real::to_int)
    }
    #[inline(always)]
    fn to_bits(self) -> Quad<i32> {
        self.each(Real::to_bits)
    }
    #[inline(always)]
    fn ddx(self) -> Self {
        self.takes_derivatives();
        let [a, b, c, d] = self.0;
        Self([b - a, b - a, d - c, d - c])
    }
    #[inline(always)]
    fn ddy(self) -> Self {
        self.takes_derivatives();
        let [a, b, c, d] = self.0;
        Self([c - a, d - b, c - a, d - b])
    }
    #[inline(always)]
    fn ddx_coarse(self) -> Self {
        self.takes_derivatives();
        Self([self.0[1] - self.0[0]; 4])
    }
    #[inline(always)]
    fn ddy_coarse(self) -> Self {
        self.takes_derivatives();
        Self([self.0[2] - self.0[0]; 4])
    }
    #[inline(always)]
    fn quad_lane(self, index: u8) -> Self {
        self.takes_derivatives();
        Self([self.0[usize::from(index & 3)]; 4])
    }
    #[inline(always)]
    fn lane(self, index: usize) -> f32 {
        self.0[index]
    }
    #[inline(always)]
    fn with_lanes(self, mut value: impl FnMut(usize) -> f32) -> Self {
        Self([value(0), value(1), value(2), value(3)])
    }
}

impl Int for Quad<i32> {
    type Real = Quad;
    type SelectMask = Quad<bool>;

    #[inline(always)]
    fn splat(self, value: i32) -> Self {
        Self([value; 4])
    }
    #[inline(always)]
    fn wrapping_mul(self, other: Self) -> Self {
        self * other
    }
    #[inline(always)]
    fn shr_unsigned(self, by: u32) -> Self {
        self.each(|a| Int::shr_unsigned(a, by))
    }
    #[inline(always)]
    fn to_real(self) -> Quad {
        self.each(|a| a as f32)
    }
    #[inline(always)]
    fn to_real_bits(self) -> Quad {
        self.each(Int::to_real_bits)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, Ord::min)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, Ord::max)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Quad<bool> {
        self.zip(other, |a, b| a < b)
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Quad<bool> {
        self.zip(other, |a, b| a == b)
    }
    #[inline(always)]
    fn is_outside(self, count: i32) -> Quad<bool> {
        self.each(|a| Int::is_outside(a, count))
    }
    #[inline(always)]
    fn select(mask: Quad<bool>, yes: Self, no: Self) -> Self {
        mask.zip(
            yes.zip(no, |a, b| (a, b)),
            |mask, (yes, no)| if mask { yes } else { no },
        )
    }
    #[inline(always)]
    fn gather(self, table: &[u32]) -> Self {
        self.each(|at| Int::gather(at, table))
    }
    #[inline(always)]
    fn lane(self, index: usize) -> i32 {
        self.0[index]
    }
}

impl Real for f32 {
    type SelectMask = bool;
    type Int = i32;
    const LANES: usize = 1;
    const EMULATED_LANES: bool = false;

    #[inline(always)]
    fn splat(self, value: f32) -> Self {
        value
    }
    #[inline(always)]
    fn splat_int(self, value: i32) -> i32 {
        value
    }
    #[inline(always)]
    fn splat_mask(self, value: bool) -> bool {
        value
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self::abs(self)
    }
    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "within ±2²³ it drops the fraction alone"
    )]
    fn floor(self) -> Self {
        // `f32::floor` is a slow call on processors that have no instruction for it.
        if Self::abs(self) < 8_388_608.0 {
            let towards_zero = self as i32 as Self;
            let step = if towards_zero > self { 1.0 } else { 0.0 };
            (towards_zero - step).copysign(self)
        } else {
            self
        }
    }
    #[inline(always)]
    fn min(self, other: impl Operand<Self>) -> Self {
        let other = other.operand(self);
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn max(self, other: impl Operand<Self>) -> Self {
        let other = other.operand(self);
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn lt(self, other: impl Operand<Self>) -> bool {
        self < other.operand(self)
    }
    #[inline(always)]
    fn le(self, other: impl Operand<Self>) -> bool {
        self <= other.operand(self)
    }
    #[inline(always)]
    fn eq(self, other: impl Operand<Self>) -> bool {
        self == other.operand(self)
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    #[inline(always)]
    fn any(mask: bool) -> bool {
        mask
    }
    #[inline(always)]
    fn mask_bits(mask: bool) -> u64 {
        u64::from(mask)
    }
    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "`as` saturates, as promised"
    )]
    fn to_int(self) -> i32 {
        self as i32
    }
    #[inline(always)]
    fn to_int_within_range(self) -> i32 {
        Real::to_int(self)
    }
    #[inline(always)]
    fn to_bits(self) -> i32 {
        Self::to_bits(self).cast_signed()
    }
    #[inline(always)]
    fn ddx(self) -> Self {
        0.0
    }
    #[inline(always)]
    fn ddy(self) -> Self {
        0.0
    }
    #[inline(always)]
    fn ddx_coarse(self) -> Self {
        0.0
    }
    #[inline(always)]
    fn ddy_coarse(self) -> Self {
        0.0
    }
    #[inline(always)]
    fn quad_lane(self, _index: u8) -> Self {
        self
    }
    #[inline(always)]
    fn lane(self, index: usize) -> f32 {
        debug_assert_eq!(index, 0, "a single fragment has one lane");
        self
    }
    #[inline(always)]
    fn with_lanes(self, mut value: impl FnMut(usize) -> Self) -> Self {
        value(0)
    }
}

impl Int for i32 {
    type Real = f32;
    type SelectMask = bool;

    #[inline(always)]
    fn splat(self, value: i32) -> Self {
        value
    }
    #[inline(always)]
    fn wrapping_mul(self, other: Self) -> Self {
        Self::wrapping_mul(self, other)
    }
    #[inline(always)]
    fn shr_unsigned(self, by: u32) -> Self {
        (self.cast_unsigned() >> by).cast_signed()
    }
    #[inline(always)]
    fn to_real(self) -> f32 {
        self as f32
    }
    #[inline(always)]
    fn to_real_bits(self) -> f32 {
        f32::from_bits(self.cast_unsigned())
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Ord::min(self, other)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Ord::max(self, other)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn eq(self, other: Self) -> bool {
        self == other
    }
    #[inline(always)]
    fn is_outside(self, count: i32) -> bool {
        self.cast_unsigned() >= count.cast_unsigned()
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    #[inline(always)]
    fn gather(self, table: &[u32]) -> Self {
        let at = self.cast_unsigned() as usize;
        table
            .get(at)
            .or(table.last())
            .copied()
            .unwrap_or_default()
            .cast_signed()
    }
    #[inline(always)]
    fn lane(self, index: usize) -> i32 {
        debug_assert_eq!(index, 0, "a single fragment has one lane");
        self
    }
}
