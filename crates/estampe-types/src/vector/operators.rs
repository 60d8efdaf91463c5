//! The operators of vectors: component-wise, with numbers and constants on either side.

use super::Joined;
use crate::maths::Componentwise;
use crate::operand::Join;
use crate::{Real, Vec2, Vec3, Vec4};
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// Implements [`Join`] and the operators of one size of vector.
macro_rules! operators {
    ($name:ident: $($field:ident)+) => {
        impl<A: Real + Join<B, Joined: Real>, B: Real> Join<$name<B>> for $name<A> {
            type Joined = $name<Joined<A, B>>;
            #[inline(always)]
            fn join(self, other: $name<B>) -> (Self::Joined, Self::Joined) {
                $(let $field = self.$field.join(other.$field);)+
                ($name { $($field: $field.0),+ }, $name { $($field: $field.1),+ })
            }
        }

        impl<A: Real + Join<B, Joined: Real>, B: Real> Join<B> for $name<A> {
            type Joined = $name<Joined<A, B>>;
            #[inline(always)]
            fn join(self, other: B) -> (Self::Joined, Self::Joined) {
                $(let $field = self.$field.join(other);)+
                ($name { $($field: $field.0),+ }, $name { $($field: $field.1),+ })
            }
        }

        impl<B: Real> Join<$name<B>> for f32 {
            type Joined = $name<B>;
            #[inline(always)]
            fn join(self, other: $name<B>) -> (Self::Joined, Self::Joined) {
                ($name::repeat(other.x.splat(self)), other)
            }
        }

        impl<R: Real> Neg for $name<R> {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self { $($field: -self.$field),+ }
            }
        }

        operators! { @binary $name
            Add add AddAssign add_assign plus;
            Sub sub SubAssign sub_assign minus;
            Mul mul MulAssign mul_assign times;
            Div div DivAssign div_assign over;
        }
    };
    (@binary $name:ident $(
        $trait:ident $method:ident $assign:ident $assigning:ident $each:ident;
    )+) => {$(
        impl<A: Real, B> $trait<B> for $name<A>
        where
            Self: Join<B, Joined: Componentwise>,
        {
            type Output = Joined<Self, B>;
            #[inline(always)]
            fn $method(self, other: B) -> Self::Output {
                let (left, right) = self.join(other);
                left.$each(right)
            }
        }

        impl<A: Real, B> $assign<B> for $name<A>
        where
            Self: Join<B, Joined = Self>,
        {
            #[inline(always)]
            fn $assigning(&mut self, other: B) {
                let (left, right) = self.join(other);
                *self = left.$each(right);
            }
        }

        impl<B: Real> $trait<$name<B>> for f32 {
            type Output = $name<B>;
            #[inline(always)]
            fn $method(self, other: $name<B>) -> $name<B> {
                $name::repeat(other.x.splat(self)).$each(other)
            }
        }
    )+};
}
operators! { Vec2: x y }
operators! { Vec3: x y z }
operators! { Vec4: x y z w }

/// Implements the operators that have a number of one kind on the left and a vector on the right.
macro_rules! left_of_vectors {
    ([$($generics:tt)*] $kind:ty) => {
        $crate::vector::left_of_vectors! { @size [$($generics)*] $kind; Vec2 }
        $crate::vector::left_of_vectors! { @size [$($generics)*] $kind; Vec3 }
        $crate::vector::left_of_vectors! { @size [$($generics)*] $kind; Vec4 }
    };
    (@size [$($generics:tt)*] $kind:ty; $name:ident) => {
        impl<$($generics)*> $crate::operand::Join<$crate::$name<$kind>> for $kind {
            type Joined = $crate::$name<$kind>;
            #[inline(always)]
            fn join(self, other: $crate::$name<$kind>) -> (Self::Joined, Self::Joined) {
                ($crate::$name::repeat(self), other)
            }
        }

        $crate::vector::left_of_vectors! { @operator [$($generics)*] $kind; $name Add add }
        $crate::vector::left_of_vectors! { @operator [$($generics)*] $kind; $name Sub sub }
        $crate::vector::left_of_vectors! { @operator [$($generics)*] $kind; $name Mul mul }
        $crate::vector::left_of_vectors! { @operator [$($generics)*] $kind; $name Div div }

        impl<$($generics)*> std::ops::Mul<$crate::$name<f32>> for $kind {
            type Output = $crate::$name<$kind>;
            #[inline(always)]
            fn mul(self, other: $crate::$name<f32>) -> Self::Output {
                $crate::$name::repeat(self) * other
            }
        }
    };
    (@operator [$($generics:tt)*] $kind:ty; $name:ident $trait:ident $method:ident) => {
        impl<$($generics)*> std::ops::$trait<$crate::$name<$kind>> for $kind {
            type Output = $crate::$name<$kind>;
            #[inline(always)]
            fn $method(self, other: $crate::$name<$kind>) -> Self::Output {
                std::ops::$trait::$method($crate::$name::repeat(self), other)
            }
        }
    };
}
pub(crate) use left_of_vectors;
