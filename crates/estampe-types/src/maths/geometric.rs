//! The geometric functions of vectors, as free functions with WGSL's names.

use crate::operand::{Join, Operand};
use crate::{Real, Vec2, Vec3, Vec4};

/// A vector of two, three or four numbers.
///
/// Call the functions of [`maths`](super), or the vectors' own methods.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a vector of numbers",
    label = "geometric functions take `Vec2`, `Vec3` and `Vec4`"
)]
pub trait Vector: Copy {
    /// The kind of its components.
    type Component: Copy;
    #[doc(hidden)]
    fn first(self) -> Self::Component;
    #[doc(hidden)]
    fn dot(self, other: Self) -> Self::Component;
    #[doc(hidden)]
    fn length(self) -> Self::Component;
    #[doc(hidden)]
    #[must_use]
    fn minus(self, other: Self) -> Self;
    #[doc(hidden)]
    #[must_use]
    fn normalize(self) -> Self;
    #[doc(hidden)]
    #[must_use]
    fn reflect(self, n: Self) -> Self;
    #[doc(hidden)]
    #[must_use]
    fn refract(self, n: Self, eta: Self::Component) -> Self;
    #[doc(hidden)]
    #[must_use]
    fn face_forward(self, incident: Self, reference: Self) -> Self;
}

macro_rules! vector {
    ($($name:ident)+) => {$(
        impl<R: Real> Vector for $name<R> {
            type Component = R;
            #[inline(always)]
            fn first(self) -> R {
                self.x
            }
            #[inline(always)]
            fn dot(self, other: Self) -> R {
                $name::dot(self, other)
            }
            #[inline(always)]
            fn length(self) -> R {
                $name::length(self)
            }
            #[inline(always)]
            fn minus(self, other: Self) -> Self {
                self - other
            }
            #[inline(always)]
            fn normalize(self) -> Self {
                $name::normalize(self)
            }
            #[inline(always)]
            fn reflect(self, n: Self) -> Self {
                $name::reflect(self, n)
            }
            #[inline(always)]
            fn refract(self, n: Self, eta: R) -> Self {
                $name::refract(self, n, eta)
            }
            #[inline(always)]
            fn face_forward(self, incident: Self, reference: Self) -> Self {
                $name::face_forward(self, incident, reference)
            }
        }
    )+};
}
vector! { Vec2 Vec3 Vec4 }

/// The vector that two vectors give, and the kind of its components.
type Joined<A, B> = <A as Join<B>>::Joined;
type Component<A, B> = <Joined<A, B> as Vector>::Component;

/// Inner product, summed from the first component on.
#[inline(always)]
#[must_use]
pub fn dot<A: Join<B, Joined: Vector>, B>(a: A, b: B) -> Component<A, B> {
    let (a, b) = a.join(b);
    a.dot(b)
}

/// Cross product.
#[inline(always)]
#[must_use]
pub fn cross<A, B, R: Real>(a: A, b: B) -> Vec3<R>
where
    A: Join<B, Joined = Vec3<R>>,
{
    let (a, b) = a.join(b);
    a.cross(b)
}

/// Euclidean length: √(v·v).
#[inline(always)]
#[must_use]
pub fn length<V: Vector>(v: V) -> V::Component {
    v.length()
}

/// The length of `a − b`.
#[inline(always)]
#[must_use]
pub fn distance<A: Join<B, Joined: Vector>, B>(a: A, b: B) -> Component<A, B> {
    let (a, b) = a.join(b);
    a.minus(b).length()
}

/// The vector times 1 ÷ √(v·v). The zero vector gives NaN.
#[inline(always)]
#[must_use]
pub fn normalize<V: Vector>(v: V) -> V {
    v.normalize()
}

/// The direction `v` mirrored at the plane with unit normal `n`: v − n·2(n·v).
#[inline(always)]
#[must_use]
pub fn reflect<A: Join<B, Joined: Vector>, B>(v: A, n: B) -> Joined<A, B> {
    let (v, n) = v.join(n);
    v.reflect(n)
}

/// The unit direction `v` refracted at the plane with unit normal `n`, where `eta` is the ratio of
/// the refractive indices. Zero for total internal reflection; see [`Vec3::refract`].
#[inline(always)]
#[must_use]
pub fn refract<V: Vector>(v: V, n: impl Operand<V>, eta: impl Operand<V::Component>) -> V
where
    V::Component: Real,
{
    v.refract(n.operand(v), eta.operand(v.first()))
}

/// `n` if `reference · incident` is negative, else `−n`: a normal that faces the viewer.
#[inline(always)]
#[must_use]
pub fn face_forward<V: Vector>(n: V, incident: impl Operand<V>, reference: impl Operand<V>) -> V {
    n.face_forward(incident.operand(n), reference.operand(n))
}
