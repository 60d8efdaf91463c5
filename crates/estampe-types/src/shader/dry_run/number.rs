//! The number that a shader computes with in a dry run: a quad that records the operations on it.

use super::recorder::{Facts, Recorder};
use crate::operand::join_number;
use crate::{Int, Operand, Quad, Real, ShaderError, maths};
use std::ops::{
    Add, AddAssign, BitAnd, BitOr, BitXor, Div, DivAssign, Mul, MulAssign, Neg, Not, Shl, Shr, Sub,
    SubAssign,
};

/// A quad with the input that it is, if it is one. The first operation on it records that the input
/// is used; results of operations are no inputs.
///
/// Nothing here is generic or inlined into shaders, so that a shader's dry run compiles fast.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Recorded<'a, T = f32> {
    quad: Quad<T>,
    input: Facts,
    recorder: &'a Recorder,
}

impl<'a, T: Copy> Recorded<'a, T> {
    pub(super) fn new(quad: Quad<T>, input: Facts, recorder: &'a Recorder) -> Self {
        Self {
            quad,
            input,
            recorder,
        }
    }

    /// The value. Records that it is used.
    pub(super) fn used(self) -> Quad<T> {
        self.recorder.note(self.input);
        self.quad
    }

    /// True if this is an input as it was given, and that one.
    pub(super) fn is(self, input: Facts) -> bool {
        self.input == input
    }

    /// Another value of the same run.
    fn made<U: Copy>(self, quad: Quad<U>) -> Recorded<'a, U> {
        Recorded::new(quad, Facts::NONE, self.recorder)
    }

    fn noted(self, facts: Facts) -> Self {
        self.recorder.note(facts);
        self
    }
}

macro_rules! operators {
    ($kind:ty; $($trait:ident $method:ident)*) => {$(
        impl $trait for Recorded<'_, $kind> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self.made($trait::$method(self.used(), other.used()))
            }
        }
    )*};
}
operators! { f32; Add add Sub sub Mul mul Div div }
operators! { i32; Add add Sub sub Mul mul BitAnd bitand BitOr bitor BitXor bitxor }

macro_rules! with_scalar {
    ($($trait:ident $method:ident $assign:ident $assign_method:ident;)*) => {$(
        impl $trait<f32> for Recorded<'_> {
            type Output = Self;
            fn $method(self, other: f32) -> Self {
                self.made($trait::$method(self.used(), other))
            }
        }
        impl<'a> $trait<Recorded<'a>> for f32 {
            type Output = Recorded<'a>;
            fn $method(self, other: Recorded<'a>) -> Recorded<'a> {
                other.made($trait::$method(self, other.used()))
            }
        }
        impl $assign for Recorded<'_> {
            fn $assign_method(&mut self, other: Self) {
                *self = $trait::$method(*self, other);
            }
        }
        impl $assign<f32> for Recorded<'_> {
            fn $assign_method(&mut self, other: f32) {
                *self = $trait::$method(*self, other);
            }
        }
    )*};
}
with_scalar! { Add add AddAssign add_assign; Sub sub SubAssign sub_assign;
Mul mul MulAssign mul_assign; Div div DivAssign div_assign; }

impl Neg for Recorded<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.made(-self.used())
    }
}

macro_rules! shifts {
    ($($trait:ident $method:ident)*) => {$(
        impl $trait<u32> for Recorded<'_, i32> {
            type Output = Self;
            fn $method(self, by: u32) -> Self {
                self.made($trait::$method(self.used(), by))
            }
        }
    )*};
}
shifts! { Shl shl Shr shr }

/// Masks that are combined stay inputs: which lanes are helpers shows in what they do.
macro_rules! masks {
    ($($trait:ident $method:ident)*) => {$(
        impl $trait for Recorded<'_, bool> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                let quad = $trait::$method(self.quad, other.quad);
                Self { quad, input: self.input.and(other.input), ..self }
            }
        }
    )*};
}
masks! { BitAnd bitand BitOr bitor }

impl Not for Recorded<'_, bool> {
    type Output = Self;
    fn not(self) -> Self {
        Self {
            quad: !self.quad,
            ..self
        }
    }
}

join_number! { ['a] Recorded<'a> }

/// Methods that act on the quad.
macro_rules! on_quads {
    ($($name:ident($($argument:ident: $type:ty),*) -> $out:ty;)*) => {$(
        fn $name(self $(, $argument: $type)*) -> Recorded<'a, $out> {
            self.made(self.used().$name($($argument),*))
        }
    )*};
    (derivatives $($name:ident($($argument:ident: $type:ty),*);)*) => {$(
        fn $name(self $(, $argument: $type)*) -> Self {
            self.noted(Facts::DERIVATIVES).made(self.used().$name($($argument),*))
        }
    )*};
    (with_other $($name:ident -> $out:ty;)*) => {$(
        fn $name(self, other: Self) -> Recorded<'a, $out> {
            self.made(Int::$name(self.used(), other.used()))
        }
    )*};
    (with_operand $($name:ident -> $out:ty;)*) => {$(
        fn $name(self, other: impl Operand<Self>) -> Recorded<'a, $out> {
            self.made(Real::$name(self.used(), other.operand(self).used()))
        }
    )*};
}

impl<'a> Real for Recorded<'a> {
    type SelectMask = Recorded<'a, bool>;
    type Int = Recorded<'a, i32>;
    const LANES: usize = 4;
    const EMULATED_LANES: bool = true;

    fn splat(self, value: f32) -> Self {
        self.made(Quad([value; 4]))
    }
    fn splat_int(self, value: i32) -> Self::Int {
        self.made(Quad([value; 4]))
    }
    fn splat_mask(self, value: bool) -> Self::SelectMask {
        self.made(Quad([value; 4]))
    }
    on_quads! {
        sqrt() -> f32;
        abs() -> f32;
        floor() -> f32;
        to_int() -> i32;
        to_int_within_range() -> i32;
        to_bits() -> i32;
    }
    on_quads! { with_operand
        min -> f32;
        max -> f32;
        lt -> bool;
        le -> bool;
        eq -> bool;
    }
    on_quads! { derivatives
        ddx();
        ddy();
        ddx_coarse();
        ddy_coarse();
        quad_lane(index: u8);
    }
    fn select(mask: Self::SelectMask, yes: Self, no: Self) -> Self {
        yes.made(<Quad as Real>::select(mask.used(), yes.used(), no.used()))
    }
    fn any(mask: Self::SelectMask) -> bool {
        mask.recorder.note(Facts::UNKNOWN);
        mask.recorder.answer(Quad::any(mask.used()))
    }
    fn mask_bits(mask: Self::SelectMask) -> u32 {
        mask.recorder.note(Facts::UNKNOWN);
        let bits = Quad::mask_bits(mask.used());
        if mask.input.has(Facts::HELPER) {
            // A store: the answer must be true, or helpers would store.
            mask.recorder.note(Facts::STORES);
            return bits;
        }
        mask.recorder.answer_bits(bits)
    }
    fn lane(self, index: usize) -> f32 {
        self.noted(Facts::UNKNOWN).used().lane(index)
    }
    fn with_lanes(self, value: impl FnMut(usize) -> f32) -> Self {
        self.made(self.quad.with_lanes(value))
    }
    fn report(self, misuse: ShaderError) {
        self.recorder.report(misuse);
    }
    fn takes_derivatives(self) {
        self.recorder.note(Facts::DERIVATIVES);
    }

    maths::with_functions! { methods_of_recorded }
}

impl<'a> Int for Recorded<'a, i32> {
    type Real = Recorded<'a>;
    type SelectMask = Recorded<'a, bool>;

    fn splat(self, value: i32) -> Self {
        self.made(Quad([value; 4]))
    }
    on_quads! {
        shr_unsigned(by: u32) -> i32;
        to_real() -> f32;
        to_real_bits() -> f32;
        is_outside(count: i32) -> bool;
        gather(table: &[u32]) -> i32;
    }
    on_quads! { with_other
        wrapping_mul -> i32;
        min -> i32;
        max -> i32;
        lt -> bool;
        eq -> bool;
    }
    fn select(mask: Self::SelectMask, yes: Self, no: Self) -> Self {
        yes.made(Int::select(mask.used(), yes.used(), no.used()))
    }
    fn lane(self, index: usize) -> i32 {
        self.noted(Facts::UNKNOWN).used().lane(index)
    }
}
