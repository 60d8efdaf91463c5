//! The functions of vectors as methods: component-wise ones, and those of geometry.
//!
//! [`maths`] has them as free functions, in the order of arguments of WGSL.

use crate::maths::{self, Componentwise};
use crate::{Operand, Real, Vec2, Vec3, Vec4};

macro_rules! functions {
    ($name:ident $n:literal: $first:ident $($rest:ident)+) => {
        impl<R: Real> $name<R> {
            maths::with_functions! { methods_of_vectors }

            /// Each component by [`Real::min`].
            #[inline(always)]
            #[must_use]
            pub fn min(self, other: impl Operand<Self>) -> Self {
                Componentwise::min(self, other.operand(self))
            }

            /// Each component by [`Real::max`].
            #[inline(always)]
            #[must_use]
            pub fn max(self, other: impl Operand<Self>) -> Self {
                Componentwise::max(self, other.operand(self))
            }

            /// Each component by [`Real::clamp`].
            #[inline(always)]
            #[must_use]
            pub fn clamp(self, low: impl Operand<Self>, high: impl Operand<Self>) -> Self {
                self.max(low).min(high)
            }

            /// `self + (other − self)·t`.
            #[inline(always)]
            #[must_use]
            pub fn mix(self, other: impl Operand<Self>, t: impl Operand<Self>) -> Self {
                self + (other.operand(self) - self) * t.operand(self)
            }

            /// `yes` in the lanes of the mask, `no` in the others.
            #[inline(always)]
            pub fn select(mask: R::SelectMask, yes: Self, no: Self) -> Self {
                Self {
                    $first: R::select(mask, yes.$first, no.$first),
                    $($rest: R::select(mask, yes.$rest, no.$rest)),+
                }
            }

            /// Inner product, summed from the first component on.
            #[inline(always)]
            pub fn dot(self, other: impl Operand<Self>) -> R {
                let products = self * other.operand(self);
                products.$first $(+ products.$rest)+
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

            /// The length of `self − other`.
            #[inline(always)]
            pub fn distance(self, other: impl Operand<Self>) -> R {
                (self - other.operand(self)).length()
            }

            /// The vector times 1 ÷ √(v·v). The zero vector gives NaN.
            #[inline(always)]
            #[must_use]
            pub fn normalize(self) -> Self {
                self * (1.0 / self.length())
            }

            /// The direction `self` mirrored at the plane with unit normal `n`: v − n·2(n·v).
            #[inline(always)]
            #[must_use]
            pub fn reflect(self, n: impl Operand<Self>) -> Self {
                let n = n.operand(self);
                self - n * (n.dot(self) * 2.0)
            }

            /// The unit direction `self` refracted at the plane with unit normal `n`; `eta` is the
            /// ratio of the refractive indices, incident side ÷ other side.
            ///
            /// With d = n·v and k = 1 − eta·eta·(1 − d·d): eta·v − n·(eta·d + √k), or zero where k
            /// is negative (total internal reflection).
            #[inline(always)]
            #[must_use]
            pub fn refract(self, n: impl Operand<Self>, eta: impl Operand<R>) -> Self {
                let (n, eta) = (n.operand(self), eta.operand(self.x));
                let d = n.dot(self);
                let k = 1.0 - eta * eta * (1.0 - d * d);
                let direction = self * eta - n * (eta * d + k.sqrt());
                Self::select(k.lt(0.0), Self::repeat(k.splat(0.0)), direction)
            }

            /// `self` if `reference · incident` is negative, else `−self`: a normal that faces the
            /// viewer.
            #[inline(always)]
            #[must_use]
            pub fn face_forward(
                self,
                incident: impl Operand<Self>,
                reference: impl Operand<Self>,
            ) -> Self {
                let facing = reference.operand(self).dot(incident.operand(self)).lt(0.0);
                Self::select(facing, self, -self)
            }
        }
    };
}
functions! { Vec2 2: x y }
functions! { Vec3 3: x y z }
functions! { Vec4 4: x y z w }

impl<R: Real> Vec3<R> {
    /// Cross product.
    #[inline(always)]
    #[must_use]
    pub fn cross(self, other: impl Operand<Self>) -> Self {
        let other = other.operand(self);
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }
}
