//! Operands of different kinds in one operation: numbers, `f32` constants, and vectors of either.
//!
//! In a shader, `R` is the kind of number, and constants are `f32`. `light * color * 0.5`, `1.0 -
//! x` and `mix(0.2, color, t)` mix them. One trait says what comes out: [`Join`], with three rules.
//!
//! | left and right | result |
//! |---|---|
//! | `R` and `R`, `R` and `f32`, `f32` and `R` | `R` |
//! | `VecN<A>` and `VecN<B>` | `VecN` of what `A` and `B` give |
//! | `VecN<A>` and the number `B`, or the reverse | `VecN` of what `A` and `B` give |
//!
//! # Operators with an `f32` on the left
//!
//! `1.0 - x` needs `f32: Sub<R>`. A `where f32: Sub<R>` on the trait [`Real`] would have to be
//! repeated at every function with a bound `R: Real`, because the compiler implies bounds of
//! supertraits only if their subject is `Self` or an associated type. [`Implied`] makes `f32` an
//! associated type of every type: its bounds follow from `R: Real` and are then bounds of `f32`.
//! (The crate `imply-hack` describes this device.)
//!
//! [`LeftOfReal`] contains `f32: Sub<f32>` too. Without it the compiler would take `f32: Sub<R>`
//! for the only subtraction of `f32` in a generic function, and refuse `self.k - 2.0`.

use crate::{Real, Vec2, Vec3, Vec4};
use std::ops::{Add, Div, Mul, Sub};

/// Two operands that may meet in one operation, for example `R` and `f32`, or a vector and a
/// number.
#[diagnostic::on_unimplemented(
    message = "`{Self}` and `{B}` cannot be operands of one operation",
    label = "no operation takes these two together",
    note = "operands are numbers `R`, `f32` constants (write `2.0`, not `2`), and vectors of the \
            same number of components"
)]
pub trait Join<B>: Copy {
    /// The kind of the result.
    type Joined: Copy;
    /// Converts both operands to the kind of the result: repeats constants in every lane, and
    /// numbers in every component.
    fn join(self, other: B) -> (Self::Joined, Self::Joined);
}

/// A value that may be used where `V` is wanted: `V` itself, an `f32` constant, or for a vector `V`
/// a number that is repeated in every component.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be used where `{V}` is wanted",
    label = "this must be `{V}`, or a constant or number that can be repeated to make one",
    note = "write constants as `f32` (`2.0`, not `2`)"
)]
pub trait Operand<V>: Copy {
    /// This value as a `V`; `like` supplies the lanes.
    fn operand(self, like: V) -> V;
}

impl<V, T: Join<V, Joined = V>> Operand<V> for T {
    #[inline(always)]
    fn operand(self, like: V) -> V {
        self.join(like).0
    }
}

/// `T` as an associated type of any type; see the [module](self).
#[doc(hidden)]
pub trait Implied<T> {
    /// `T`.
    type Is;
}

impl<S: ?Sized, T> Implied<T> for S {
    type Is = T;
}

/// `f32` as the left operand of `R`, and of `f32`.
#[doc(hidden)]
pub trait LeftOfReal<R>:
    Add<R, Output = R>
    + Sub<R, Output = R>
    + Mul<R, Output = R>
    + Div<R, Output = R>
    + Add<f32, Output = f32>
    + Sub<f32, Output = f32>
    + Mul<f32, Output = f32>
    + Div<f32, Output = f32>
{
}

impl<R> LeftOfReal<R> for f32 where
    Self: Add<R, Output = R> + Sub<R, Output = R> + Mul<R, Output = R> + Div<R, Output = R>
{
}

/// A number as the left operand of vectors: `r * v`, `r - v`, and `r * c` with a constant vector
/// `c`.
#[doc(hidden)]
pub trait ScaleVectors:
    LeftOf<Vec2<Self>, Vec2<f32>> + LeftOf<Vec3<Self>, Vec3<f32>> + LeftOf<Vec4<Self>, Vec4<f32>>
{
}

/// A number as the left operand of a vector `V` of its kind, and of a vector `C` of constants.
#[doc(hidden)]
pub trait LeftOf<V, C>:
    Sized
    + Join<V, Joined = V>
    + Add<V, Output = V>
    + Sub<V, Output = V>
    + Mul<V, Output = V>
    + Div<V, Output = V>
    + Mul<C, Output = V>
{
}

impl<T, V, C> LeftOf<V, C> for T where
    T: Join<V, Joined = V>
        + Add<V, Output = V>
        + Sub<V, Output = V>
        + Mul<V, Output = V>
        + Div<V, Output = V>
        + Mul<C, Output = V>
{
}

impl<T> ScaleVectors for T where
    T: LeftOf<Vec2<T>, Vec2<f32>> + LeftOf<Vec3<T>, Vec3<f32>> + LeftOf<Vec4<T>, Vec4<f32>>
{
}

impl<R: Real> Join<R> for f32 {
    type Joined = R;
    #[inline(always)]
    fn join(self, other: R) -> (R, R) {
        (other.splat(self), other)
    }
}

/// Implements [`Join`] for a kind of number other than `f32`.
///
/// Each kind has its own implementation: one for every `R: Real` would overlap with that of `f32`.
macro_rules! join_number {
    ([$($generics:tt)*] $kind:ty) => {
        impl<$($generics)*> $crate::operand::Join<$kind> for $kind {
            type Joined = Self;
            #[inline(always)]
            fn join(self, other: $kind) -> (Self, Self) {
                (self, other)
            }
        }

        impl<$($generics)*> $crate::operand::Join<f32> for $kind {
            type Joined = Self;
            #[inline(always)]
            fn join(self, other: f32) -> (Self, Self) {
                (self, $crate::Real::splat(self, other))
            }
        }

        $crate::vector::left_of_vectors! { [$($generics)*] $kind }
    };
}
pub(crate) use join_number;
