//! Numbers and vectors of numbers, as the operands of component-wise functions.

use super::scalar;
use crate::{Real, Vec2, Vec3, Vec4};

/// Declares [`Componentwise`] and implements it: functions of one operand, then those of two.
macro_rules! componentwise {
    ($($(#[$one_doc:meta])* $one:ident)+; $($(#[$two_doc:meta])* $two:ident)+) => {
        /// A number or a vector of numbers, on which component-wise functions act.
        ///
        /// It is implemented for every [`Real`] and its vectors. Call the functions of
        /// [`maths`](super), or the methods of [`Real`] and of vectors.
        #[diagnostic::on_unimplemented(
            message = "`{Self}` is neither a number nor a vector of numbers",
            label = "component-wise functions take `R: Real`, `f32`, and vectors of them",
            note = "write constants as `f32` (`2.0`, not `2`)"
        )]
        pub trait Componentwise: Copy {
            /// A boolean in each lane.
            type SelectMask: Copy;
            $($(#[$one_doc])* #[doc(hidden)] #[must_use] fn $one(self) -> Self;)+
            $($(#[$two_doc])* #[doc(hidden)] #[must_use] fn $two(self, other: Self) -> Self;)+
            /// `self + (other − self)·t`.
            #[doc(hidden)]
            #[must_use]
            fn mix(self, other: Self, t: Self) -> Self;
            /// 0 below `self`, 1 above `high`, smooth between.
            #[doc(hidden)]
            #[must_use]
            fn smoothstep(self, high: Self, x: Self) -> Self;
            /// `yes` in the lanes of the mask, `no` in the others.
            #[doc(hidden)]
            #[must_use]
            fn select(mask: Self::SelectMask, yes: Self, no: Self) -> Self;
        }

        impl<R: Real> Componentwise for R {
            type SelectMask = <R as Real>::SelectMask;
            $(
                #[inline(always)]
                fn $one(self) -> Self {
                    Real::$one(self)
                }
            )+
            $(
                #[inline(always)]
                fn $two(self, other: Self) -> Self {
                    of_numbers::$two(self, other)
                }
            )+
            #[inline(always)]
            fn mix(self, other: Self, t: Self) -> Self {
                Real::mix(self, other, t)
            }
            #[inline(always)]
            fn smoothstep(self, high: Self, x: Self) -> Self {
                let t = Real::saturate((x - self) / (high - self));
                t * t * (3.0 - t * 2.0)
            }
            #[inline(always)]
            fn select(mask: Self::SelectMask, yes: Self, no: Self) -> Self {
                <R as Real>::select(mask, yes, no)
            }
        }

        componentwise! { @vector Vec2 (x y) ($($one)+) ($($two)+) }
        componentwise! { @vector Vec3 (x y z) ($($one)+) ($($two)+) }
        componentwise! { @vector Vec4 (x y z w) ($($one)+) ($($two)+) }
    };
    (@vector $name:ident $fields:tt ($($one:ident)+) ($($two:ident)+)) => {
        impl<R: Real> Componentwise for $name<R> {
            type SelectMask = <R as Real>::SelectMask;
            $(componentwise! { @one $one $fields })+
            $(componentwise! { @two $two $fields })+
            componentwise! { @three $fields }
        }
    };
    (@one $one:ident ($($field:ident)+)) => {
        #[inline(always)]
        fn $one(self) -> Self {
            Self { $($field: Real::$one(self.$field)),+ }
        }
    };
    (@two $two:ident ($($field:ident)+)) => {
        #[inline(always)]
        fn $two(self, other: Self) -> Self {
            Self { $($field: Componentwise::$two(self.$field, other.$field)),+ }
        }
    };
    (@three ($($field:ident)+)) => {
        #[inline(always)]
        fn mix(self, other: Self, t: Self) -> Self {
            Self { $($field: Real::mix(self.$field, other.$field, t.$field)),+ }
        }
        #[inline(always)]
        fn smoothstep(self, high: Self, x: Self) -> Self {
            Self { $($field: Componentwise::smoothstep(self.$field, high.$field, x.$field)),+ }
        }
        #[inline(always)]
        fn select(mask: Self::SelectMask, yes: Self, no: Self) -> Self {
            Self { $($field: <R as Real>::select(mask, yes.$field, no.$field)),+ }
        }
    };
}
super::with_functions! { trait_componentwise }

mod of_numbers {
    //! The functions of two numbers.

    pub(super) use super::scalar::{atan2, modulo, pow, remainder};
    use crate::Real;

    #[inline(always)]
    pub(super) fn plus<R: Real>(a: R, b: R) -> R {
        a + b
    }
    #[inline(always)]
    pub(super) fn minus<R: Real>(a: R, b: R) -> R {
        a - b
    }
    #[inline(always)]
    pub(super) fn times<R: Real>(a: R, b: R) -> R {
        a * b
    }
    #[inline(always)]
    pub(super) fn over<R: Real>(a: R, b: R) -> R {
        a / b
    }
    #[inline(always)]
    pub(super) fn min<R: Real>(a: R, b: R) -> R {
        a.min(b)
    }
    #[inline(always)]
    pub(super) fn max<R: Real>(a: R, b: R) -> R {
        a.max(b)
    }
    #[inline(always)]
    pub(super) fn step<R: Real>(edge: R, x: R) -> R {
        R::select(edge.le(x), x.splat(1.0), x.splat(0.0))
    }
}
