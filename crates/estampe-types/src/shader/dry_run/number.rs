//! The number that a shader computes with in a dry run: a quad that records the operations on it.

use super::recorder::{Facts, Recorder};
use crate::operand::join_number;
use crate::{Int, Operand, Quad, Real, ShaderError, maths};
use std::marker::PhantomData;
use std::ops::{
    Add, AddAssign, BitAnd, BitOr, BitXor, Div, DivAssign, Mul, MulAssign, Neg, Not, Shl, Shr, Sub,
    SubAssign,
};

/// A quad with the input that it is, if it is one. The first operation on it records that the input
/// is used; results of operations are no inputs.
///
/// The lanes lie in the [`Recorder`], and this is their number there. So a shader's dry run is a
/// chain of calls with numbers in registers: with the lanes in here, it copied them from memory to
/// memory, and the renderer took a quarter longer to build. Nothing but the calls is inlined into
/// shaders.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Recorded<'a, T = f32> {
    /// The number of the value in the record.
    at: u32,
    recorder: &'a Recorder,
    kind: PhantomData<T>,
}

impl<'a, T: Word> Recorded<'a, T> {
    pub(super) fn new(quad: Quad<T>, input: Facts, recorder: &'a Recorder) -> Self {
        Self {
            at: recorder.add(quad.0.map(T::to_word), input),
            recorder,
            kind: PhantomData,
        }
    }

    fn quad(self) -> Quad<T> {
        Quad(self.recorder.lanes(self.at).map(T::of_word))
    }

    fn input(self) -> Facts {
        self.recorder.input(self.at)
    }

    /// The value. Records that it is used.
    pub(super) fn used(self) -> Quad<T> {
        self.recorder.note(self.input());
        self.quad()
    }

    /// True if this is an input as it was given, and that one.
    pub(super) fn is(self, input: Facts) -> bool {
        self.input() == input
    }

    /// Another value of the same run.
    fn made<U: Word>(self, quad: Quad<U>) -> Recorded<'a, U> {
        Recorded::new(quad, Facts::NONE, self.recorder)
    }

    fn noted(self, facts: Facts) -> Self {
        self.recorder.note(facts);
        self
    }
}

/// A lane as it is stored in the record.
pub(crate) trait Word: Copy {
    fn to_word(self) -> u32;
    fn of_word(word: u32) -> Self;
}

impl Word for f32 {
    fn to_word(self) -> u32 {
        self.to_bits()
    }
    fn of_word(word: u32) -> Self {
        Self::from_bits(word)
    }
}

impl Word for i32 {
    fn to_word(self) -> u32 {
        self.cast_unsigned()
    }
    fn of_word(word: u32) -> Self {
        word.cast_signed()
    }
}

impl Word for bool {
    fn to_word(self) -> u32 {
        u32::from(self)
    }
    fn of_word(word: u32) -> Self {
        word != 0
    }
}

macro_rules! operators {
    ($kind:ty; $($trait:ident $method:ident)*) => {$(
        impl $trait for Recorded<'_, $kind> {
            type Output = Self;
            #[inline(never)]
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
            #[inline(never)]
            fn $method(self, other: f32) -> Self {
                self.made($trait::$method(self.used(), other))
            }
        }
        impl<'a> $trait<Recorded<'a>> for f32 {
            type Output = Recorded<'a>;
            #[inline(never)]
            fn $method(self, other: Recorded<'a>) -> Recorded<'a> {
                other.made($trait::$method(self, other.used()))
            }
        }
        impl $assign for Recorded<'_> {
            #[inline(always)]
            fn $assign_method(&mut self, other: Self) {
                *self = $trait::$method(*self, other);
            }
        }
        impl $assign<f32> for Recorded<'_> {
            #[inline(always)]
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
    #[inline(never)]
    fn neg(self) -> Self {
        self.made(-self.used())
    }
}

macro_rules! shifts {
    ($($trait:ident $method:ident)*) => {$(
        impl $trait<u32> for Recorded<'_, i32> {
            type Output = Self;
            #[inline(never)]
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
            #[inline(never)]
            fn $method(self, other: Self) -> Self {
                let quad = $trait::$method(self.quad(), other.quad());
                Self::new(quad, self.input().and(other.input()), self.recorder)
            }
        }
    )*};
}
masks! { BitAnd bitand BitOr bitor }

impl Not for Recorded<'_, bool> {
    type Output = Self;
    #[inline(never)]
    fn not(self) -> Self {
        Self::new(!self.quad(), self.input(), self.recorder)
    }
}

join_number! { ['a] Recorded<'a> }

/// Methods that act on the quad.
macro_rules! on_quads {
    ($($name:ident($($argument:ident: $type:ty),*) -> $out:ty;)*) => {$(
        #[inline(never)]
        fn $name(self $(, $argument: $type)*) -> Recorded<'a, $out> {
            self.made(self.used().$name($($argument),*))
        }
    )*};
    (derivatives $($name:ident($($argument:ident: $type:ty),*);)*) => {$(
        #[inline(never)]
        fn $name(self $(, $argument: $type)*) -> Self {
            self.noted(Facts::DERIVATIVES).made(self.used().$name($($argument),*))
        }
    )*};
    (with_other $($name:ident -> $out:ty;)*) => {$(
        #[inline(never)]
        fn $name(self, other: Self) -> Recorded<'a, $out> {
            self.made(Int::$name(self.used(), other.used()))
        }
    )*};
    (with_operand $($name:ident -> $out:ty;)*) => {$(
        fn $name(self, other: impl Operand<Self>) -> Recorded<'a, $out> {
            #[inline(never)]
            fn of_two<'a>(a: Recorded<'a>, b: Recorded<'a>) -> Recorded<'a, $out> {
                a.made(Real::$name(a.used(), b.used()))
            }
            of_two(self, other.operand(self))
        }
    )*};
}

impl<'a> Real for Recorded<'a> {
    type SelectMask = Recorded<'a, bool>;
    type Int = Recorded<'a, i32>;
    const LANES: usize = 4;
    const EMULATED_LANES: bool = true;

    #[inline(never)]
    fn splat(self, value: f32) -> Self {
        self.made(Quad([value; 4]))
    }
    #[inline(never)]
    fn splat_int(self, value: i32) -> Self::Int {
        self.made(Quad([value; 4]))
    }
    #[inline(never)]
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
    #[inline(never)]
    fn select(mask: Self::SelectMask, yes: Self, no: Self) -> Self {
        yes.made(<Quad as Real>::select(mask.used(), yes.used(), no.used()))
    }
    #[inline(never)]
    fn any(mask: Self::SelectMask) -> bool {
        mask.recorder.note(Facts::UNKNOWN);
        mask.recorder.answer(Quad::any(mask.used()))
    }
    #[inline(never)]
    fn mask_bits(mask: Self::SelectMask) -> u64 {
        mask.recorder.note(Facts::UNKNOWN);
        let bits = Quad::mask_bits(mask.used());
        if mask.input().has(Facts::HELPER) {
            // A store: the answer must be true, or helpers would store.
            mask.recorder.note(Facts::STORES);
            return bits;
        }
        mask.recorder.answer_bits(bits)
    }
    #[inline(never)]
    fn lane(self, index: usize) -> f32 {
        self.noted(Facts::UNKNOWN.and(Facts::UNTRIED))
            .used()
            .lane(index)
    }
    #[inline(never)]
    fn lane_to_store(self, index: usize) -> f32 {
        self.used().lane(index)
    }
    fn with_lanes(self, value: impl FnMut(usize) -> f32) -> Self {
        self.made(self.quad().with_lanes(value))
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

    #[inline(never)]
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
    #[inline(never)]
    fn select(mask: Self::SelectMask, yes: Self, no: Self) -> Self {
        yes.made(Int::select(mask.used(), yes.used(), no.used()))
    }
    #[inline(never)]
    fn lane(self, index: usize) -> i32 {
        self.noted(Facts::UNKNOWN.and(Facts::UNTRIED))
            .used()
            .lane(index)
    }
    #[inline(never)]
    fn lane_to_store(self, index: usize) -> i32 {
        self.used().lane(index)
    }
}
