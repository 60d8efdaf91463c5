//! Small vectors of [`Real`] numbers with the usual operators.

mod swizzles;

use crate::Real;
use std::ops::{Add, Div, Mul, Neg, Sub};

macro_rules! vector {
    ($(#[$doc:meta])* $name:ident $n:literal: $($field:ident)+) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct $name<R> {
            $(#[doc = concat!("Component ", stringify!($field), ".")] pub $field: R,)+
        }

        impl<R> $name<R> {
            /// The vector of these components.
            #[inline(always)]
            pub const fn new($($field: R),+) -> Self {
                Self { $($field),+ }
            }
        }

        impl<R: Real> $name<R> {
            /// The vector `value` in every lane; `like` is any number of the wanted kind.
            #[inline(always)]
            pub fn uniform(like: R, value: impl Into<[f32; $n]>) -> Self {
                let [$($field),+] = value.into();
                Self { $($field: like.splat($field)),+ }
            }

            /// The vector whose components are all `value`.
            #[inline(always)]
            pub fn repeat(value: R) -> Self {
                Self { $($field: value),+ }
            }

            /// Inner product, summed from the first component on.
            #[inline(always)]
            pub fn dot(self, other: Self) -> R {
                let products = self * other;
                vector!(@sum products $($field)+)
            }

            /// Inner product with a vector that is the same in every lane.
            #[inline(always)]
            pub fn dot_uniform(self, other: impl Into<[f32; $n]>) -> R {
                self.dot(Self::uniform(self.x, other))
            }

            /// Euclidean length: √(v·v).
            #[inline(always)]
            pub fn length(self) -> R {
                self.dot(self).sqrt()
            }

            /// The vector times 1 ÷ √(v·v). The zero vector gives NaN.
            #[inline(always)]
            #[must_use]
            pub fn normalize(self) -> Self {
                let one = self.x.splat(1.0);
                self * (one / self.length())
            }

            /// Each component by [`Real::min`].
            #[inline(always)]
            #[must_use]
            pub fn min(self, other: Self) -> Self {
                Self { $($field: self.$field.min(other.$field)),+ }
            }

            /// Each component by [`Real::max`].
            #[inline(always)]
            #[must_use]
            pub fn max(self, other: Self) -> Self {
                Self { $($field: self.$field.max(other.$field)),+ }
            }

            /// `self + (other − self)·t`.
            #[inline(always)]
            #[must_use]
            pub fn mix(self, other: Self, t: R) -> Self {
                self + (other - self) * t
            }

            /// `yes` in the lanes of the mask, `no` in the others.
            #[inline(always)]
            pub fn select(mask: R::Mask, yes: Self, no: Self) -> Self {
                Self { $($field: R::select(mask, yes.$field, no.$field)),+ }
            }
        }

        vector!(@binary $name Add add + $($field)+);
        vector!(@binary $name Sub sub - $($field)+);
        vector!(@binary $name Mul mul * $($field)+);
        vector!(@binary $name Div div / $($field)+);

        impl<R: Real> Mul<R> for $name<R> {
            type Output = Self;
            #[inline(always)]
            fn mul(self, by: R) -> Self {
                Self { $($field: self.$field * by),+ }
            }
        }

        impl<R: Real> Neg for $name<R> {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self { $($field: -self.$field),+ }
            }
        }

        impl<R> From<[R; $n]> for $name<R> {
            #[inline(always)]
            fn from([$($field),+]: [R; $n]) -> Self {
                Self { $($field),+ }
            }
        }
    };
    (@sum $v:ident $first:ident $($rest:ident)*) => { $v.$first $(+ $v.$rest)* };
    (@binary $name:ident $trait:ident $method:ident $op:tt $($field:ident)+) => {
        impl<R: Real> $trait for $name<R> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self { $($field: self.$field $op other.$field),+ }
            }
        }
    };
}

vector! {
    /// Two numbers, such as a texture coordinate.
    Vec2 2: x y
}
vector! {
    /// Three numbers: a position, direction or colour. Products are component-wise.
    Vec3 3: x y z
}
vector! {
    /// Four numbers: a homogeneous position, or a colour with alpha. Products are component-wise.
    Vec4 4: x y z w
}

impl<R: Real> Vec3<R> {
    /// Cross product.
    #[inline(always)]
    #[must_use]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    /// Appends a fourth component.
    #[inline(always)]
    pub fn extend(self, w: R) -> Vec4<R> {
        Vec4::new(self.x, self.y, self.z, w)
    }

    /// The homogeneous point (x, y, z, 1).
    #[inline(always)]
    pub fn point(self) -> Vec4<R> {
        self.extend(self.x.splat(1.0))
    }

    /// The direction `self` mirrored at the plane with unit normal `n`: v − n·2(n·v).
    #[inline(always)]
    #[must_use]
    pub fn reflect(self, n: Self) -> Self {
        self - n * (n.dot(self) * 2.0)
    }
}
