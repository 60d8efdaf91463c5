//! Functions as lists of steps, for compilers.
//!
//! [`steps`] runs a function on numbers that record what is done to them. So the functions of this
//! module are defined once, and machine code has the same bits as the lanes.

use crate::operand::join_number;
use crate::{Int, Operand, Real};
use std::ops::{
    Add, AddAssign, BitAnd, BitOr, BitXor, Div, DivAssign, Mul, MulAssign, Neg, Not, Shl, Shr, Sub,
    SubAssign,
};
use std::sync::{Mutex, PoisonError};

/// A step of a function. Operands are positions of earlier steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// An argument of the function.
    Argument(u32),
    /// A number or integer, by its bits.
    Word(u32),
    /// A mask that is the same in all lanes.
    Mask(bool),
    /// An operation on a number, an integer or a mask.
    One(One, u32),
    /// An operation on two of them.
    Two(Two, [u32; 2]),
    /// A shift of an integer by so many bits.
    Shift(Shift, u32, u32),
    /// A mask, then the number or integer where it is set, then the one where it is not.
    Select([u32; 3]),
}

/// Steps of one operand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum One {
    /// [`Real`]'s negation.
    Neg,
    /// [`Real::sqrt`].
    Sqrt,
    /// [`Real::abs`].
    Abs,
    /// [`Real::floor`].
    Floor,
    /// [`Real::to_int`].
    ToInt,
    /// [`Real::to_int_within_range`].
    ToIntWithinRange,
    /// [`Int::to_real`].
    ToReal,
    /// A mask's negation.
    Not,
}

/// Steps of two operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Two {
    /// Sum of numbers.
    Add,
    /// Difference of numbers.
    Sub,
    /// Product of numbers.
    Mul,
    /// Quotient of numbers.
    Div,
    /// [`Real::min`].
    Min,
    /// [`Real::max`].
    Max,
    /// [`Real::lt`].
    Lt,
    /// [`Real::le`].
    Le,
    /// [`Real::eq`].
    Eq,
    /// Sum of integers.
    IntAdd,
    /// Difference of integers.
    IntSub,
    /// Product of integers, modulo 2³².
    IntMul,
    /// Bits that both integers have.
    IntAnd,
    /// Bits that either integer has.
    IntOr,
    /// Bits that one integer has.
    IntXor,
    /// [`Int::min`].
    IntMin,
    /// [`Int::max`].
    IntMax,
    /// [`Int::lt`].
    IntLt,
    /// [`Int::eq`].
    IntEq,
    /// Lanes of both masks.
    MaskAnd,
    /// Lanes of either mask.
    MaskOr,
}

/// Shifts of integers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shift {
    /// To the left.
    Left,
    /// To the right, with copies of the sign.
    Right,
    /// To the right, with zeros.
    RightUnsigned,
}

/// The steps of a function of two numbers, of which it may ignore the second one. The last step is
/// the result.
///
/// # Panics
/// If the function asks for lanes: where it branches on a mask, reads or sets one lane, takes a
/// derivative or reads a table. No function of [`maths`](crate::maths) does.
pub fn steps(function: impl FnOnce([Traced<'_>; 2]) -> Traced<'_>) -> Vec<Step> {
    let list = List::default();
    let arguments = [0, 1].map(|at| list.push::<f32>(Step::Argument(at)));
    let result = function(arguments).at as usize;
    let mut steps = list.0.into_inner().unwrap_or_else(PoisonError::into_inner);
    steps.truncate(result + 1);
    steps
}

/// The steps so far.
#[derive(Debug, Default)]
struct List(Mutex<Vec<Step>>);

impl List {
    fn push<T>(&self, step: Step) -> Traced<'_, T> {
        let mut steps = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        steps.push(step);
        Traced {
            at: u32::try_from(steps.len() - 1).expect("functions have few steps"),
            list: self,
            kind: std::marker::PhantomData,
        }
    }
}

/// A number (`f32`), an integer (`i32`) or a mask (`bool`) that records what is done to it.
#[derive(Debug, Clone, Copy)]
pub struct Traced<'a, T = f32> {
    at: u32,
    list: &'a List,
    kind: std::marker::PhantomData<T>,
}

impl<'a, T: Copy> Traced<'a, T> {
    fn step<U>(self, step: Step) -> Traced<'a, U> {
        self.list.push(step)
    }

    fn one<U>(self, kind: One) -> Traced<'a, U> {
        self.step(Step::One(kind, self.at))
    }

    fn two<U>(self, kind: Two, other: Self) -> Traced<'a, U> {
        self.step(Step::Two(kind, [self.at, other.at]))
    }
}

macro_rules! operators {
    ($($kind:ty: $trait:ident $method:ident $step:ident;)*) => {$(
        impl $trait for Traced<'_, $kind> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self.two(Two::$step, other)
            }
        }
    )*};
}
operators! {
    f32: Add add Add;
    f32: Sub sub Sub;
    f32: Mul mul Mul;
    f32: Div div Div;
    i32: Add add IntAdd;
    i32: Sub sub IntSub;
    i32: Mul mul IntMul;
    i32: BitAnd bitand IntAnd;
    i32: BitOr bitor IntOr;
    i32: BitXor bitxor IntXor;
    bool: BitAnd bitand MaskAnd;
    bool: BitOr bitor MaskOr;
}

macro_rules! with_scalar {
    ($($trait:ident $method:ident $assign:ident $assign_method:ident;)*) => {$(
        impl $trait<f32> for Traced<'_> {
            type Output = Self;
            fn $method(self, other: f32) -> Self {
                $trait::$method(self, self.splat(other))
            }
        }
        impl<'a> $trait<Traced<'a>> for f32 {
            type Output = Traced<'a>;
            fn $method(self, other: Traced<'a>) -> Traced<'a> {
                $trait::$method(other.splat(self), other)
            }
        }
        impl $assign for Traced<'_> {
            fn $assign_method(&mut self, other: Self) {
                *self = $trait::$method(*self, other);
            }
        }
        impl $assign<f32> for Traced<'_> {
            fn $assign_method(&mut self, other: f32) {
                *self = $trait::$method(*self, other);
            }
        }
    )*};
}
with_scalar! { Add add AddAssign add_assign; Sub sub SubAssign sub_assign;
Mul mul MulAssign mul_assign; Div div DivAssign div_assign; }

impl Neg for Traced<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.one(One::Neg)
    }
}

impl Not for Traced<'_, bool> {
    type Output = Self;
    fn not(self) -> Self {
        self.one(One::Not)
    }
}

impl Shl<u32> for Traced<'_, i32> {
    type Output = Self;
    fn shl(self, by: u32) -> Self {
        self.step(Step::Shift(Shift::Left, self.at, by))
    }
}

impl Shr<u32> for Traced<'_, i32> {
    type Output = Self;
    fn shr(self, by: u32) -> Self {
        self.step(Step::Shift(Shift::Right, self.at, by))
    }
}

join_number! { ['a] Traced<'a> }

/// Why a function has no list of steps.
fn no_lanes() -> ! {
    panic!("a traced function has no lanes, derivatives or tables")
}

impl<'a> Real for Traced<'a> {
    type SelectMask = Traced<'a, bool>;
    type Int = Traced<'a, i32>;
    const LANES: usize = 1;
    const EMULATED_LANES: bool = true;

    fn splat(self, value: f32) -> Self {
        self.step(Step::Word(value.to_bits()))
    }
    fn splat_int(self, value: i32) -> Self::Int {
        self.step(Step::Word(value.cast_unsigned()))
    }
    fn splat_mask(self, value: bool) -> Self::SelectMask {
        self.step(Step::Mask(value))
    }
    fn sqrt(self) -> Self {
        self.one(One::Sqrt)
    }
    fn abs(self) -> Self {
        self.one(One::Abs)
    }
    fn floor(self) -> Self {
        self.one(One::Floor)
    }
    fn min(self, other: impl Operand<Self>) -> Self {
        self.two(Two::Min, other.operand(self))
    }
    fn max(self, other: impl Operand<Self>) -> Self {
        self.two(Two::Max, other.operand(self))
    }
    fn lt(self, other: impl Operand<Self>) -> Self::SelectMask {
        self.two(Two::Lt, other.operand(self))
    }
    fn le(self, other: impl Operand<Self>) -> Self::SelectMask {
        self.two(Two::Le, other.operand(self))
    }
    fn eq(self, other: impl Operand<Self>) -> Self::SelectMask {
        self.two(Two::Eq, other.operand(self))
    }
    fn select(mask: Self::SelectMask, yes: Self, no: Self) -> Self {
        yes.step(Step::Select([mask.at, yes.at, no.at]))
    }
    fn any(_: Self::SelectMask) -> bool {
        no_lanes()
    }
    fn mask_bits(_: Self::SelectMask) -> u64 {
        no_lanes()
    }
    fn to_int(self) -> Self::Int {
        self.one(One::ToInt)
    }
    fn to_int_within_range(self) -> Self::Int {
        self.one(One::ToIntWithinRange)
    }
    fn to_bits(self) -> Self::Int {
        Traced {
            at: self.at,
            list: self.list,
            kind: std::marker::PhantomData,
        }
    }
    fn ddx(self) -> Self {
        no_lanes()
    }
    fn ddy(self) -> Self {
        no_lanes()
    }
    fn ddx_coarse(self) -> Self {
        no_lanes()
    }
    fn ddy_coarse(self) -> Self {
        no_lanes()
    }
    fn quad_lane(self, _: u8) -> Self {
        no_lanes()
    }
    fn lane(self, _: usize) -> f32 {
        no_lanes()
    }
    fn with_lanes(self, _: impl FnMut(usize) -> f32) -> Self {
        no_lanes()
    }
}

impl<'a> Int for Traced<'a, i32> {
    type Real = Traced<'a>;
    type SelectMask = Traced<'a, bool>;

    fn splat(self, value: i32) -> Self {
        self.step(Step::Word(value.cast_unsigned()))
    }
    fn wrapping_mul(self, other: Self) -> Self {
        self.two(Two::IntMul, other)
    }
    fn shr_unsigned(self, by: u32) -> Self {
        self.step(Step::Shift(Shift::RightUnsigned, self.at, by))
    }
    fn to_real(self) -> Self::Real {
        self.one(One::ToReal)
    }
    fn to_real_bits(self) -> Self::Real {
        Traced {
            at: self.at,
            list: self.list,
            kind: std::marker::PhantomData,
        }
    }
    fn min(self, other: Self) -> Self {
        self.two(Two::IntMin, other)
    }
    fn max(self, other: Self) -> Self {
        self.two(Two::IntMax, other)
    }
    fn lt(self, other: Self) -> Self::SelectMask {
        self.two(Two::IntLt, other)
    }
    fn eq(self, other: Self) -> Self::SelectMask {
        self.two(Two::IntEq, other)
    }
    fn is_outside(self, count: i32) -> Self::SelectMask {
        let (zero, last) = (Int::splat(self, 0), Int::splat(self, count - 1));
        Int::lt(self, zero) | Int::lt(last, self)
    }
    fn select(mask: Self::SelectMask, yes: Self, no: Self) -> Self {
        yes.step(Step::Select([mask.at, yes.at, no.at]))
    }
    fn gather(self, _: &[u32]) -> Self {
        no_lanes()
    }
    fn lane(self, _: usize) -> i32 {
        no_lanes()
    }
}
