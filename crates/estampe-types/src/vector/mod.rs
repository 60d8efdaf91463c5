//! Small vectors of [`Real`] numbers, with the operators, functions and swizzles of GLSL and WGSL.
//!
//! `v * w` is component-wise, and a number or an `f32` on either side applies to every component:
//! `2.0 * v`, `v + light`, `1.0 - v`. [`vec2()`], [`vec3()`] and [`vec4()`] make vectors of numbers
//! and constants; see [`vec3()`] for vectors of constants alone.

mod functions;
mod operators;
mod swizzles;

pub(crate) use operators::left_of_vectors;

use crate::operand::Join;
use crate::{Operand, Real};

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
        }

        impl<R> From<[R; $n]> for $name<R> {
            #[inline(always)]
            fn from([$($field),+]: [R; $n]) -> Self {
                Self { $($field),+ }
            }
        }

        impl<R> From<$name<R>> for [R; $n] {
            #[inline(always)]
            fn from(v: $name<R>) -> Self {
                [$(v.$field),+]
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

/// The kind of number that two operands give; see [`Join`].
type Joined<A, B> = <A as Join<B>>::Joined;

/// The vector of two components, each a number or an `f32` constant; see [`vec3()`].
#[inline(always)]
pub fn vec2<A: Join<B>, B>(x: A, y: B) -> Vec2<Joined<A, B>> {
    let (x, y) = x.join(y);
    Vec2 { x, y }
}

/// The vector of three components, each a number or an `f32` constant.
///
/// If one component is a number `R`, this is a `Vec3<R>`. If all are constants it is a `Vec3<f32>`,
/// which can be an operand of any vector or number. Where a function wants a `Vec3<R>`, write
/// [`Vec3::uniform`].
///
/// ```
/// use estampe_types::{Real, Vec3, vec3};
///
/// fn shade<R: Real>(light: R, normal: Vec3<R>) -> Vec3<R> {
///     let warm = light * vec3(1.0, 0.9, 0.7);
///     warm + vec3(0.0, 0.1, 0.2) * (1.0 - light) + vec3(0.0, normal.y, 0.0)
/// }
/// assert_eq!(shade(1.0, Vec3::new(0.0, 0.5, 0.0)), Vec3::new(1.0, 1.4, 0.7));
/// ```
///
/// [`Vec3::new`] stays a `const fn` of three components of one kind. It cannot accept both kinds:
/// the kind of `Vec3::new(x, y, z).length()` is inferred from the arguments, and with conversions
/// there would be none to infer it from.
#[inline(always)]
pub fn vec3<A, B, C>(x: A, y: B, z: C) -> Vec3<Joined<Joined<A, B>, C>>
where
    A: Join<B, Joined: Join<C>>,
    C: Copy,
{
    let (x, y) = x.join(y);
    let (x, last) = x.join(z);
    let (y, _) = y.join(z);
    Vec3 { x, y, z: last }
}

/// The vector of four components, each a number or an `f32` constant; see [`vec3()`].
#[inline(always)]
pub fn vec4<A, B, C, D>(x: A, y: B, z: C, w: D) -> Vec4<Joined<Joined<A, B>, Joined<C, D>>>
where
    A: Join<B, Joined: Join<Joined<C, D>>>,
    C: Join<D>,
{
    let (x, y) = x.join(y);
    let (z, w) = z.join(w);
    let (first, third) = x.join(z);
    let (second, fourth) = y.join(w);
    Vec4 {
        x: first,
        y: second,
        z: third,
        w: fourth,
    }
}

impl<R: Real> Vec2<R> {
    /// Appends a third component.
    #[inline(always)]
    pub fn extend(self, z: impl Operand<R>) -> Vec3<R> {
        Vec3::new(self.x, self.y, z.operand(self.x))
    }
}

impl<R: Real> Vec3<R> {
    /// Appends a fourth component.
    #[inline(always)]
    pub fn extend(self, w: impl Operand<R>) -> Vec4<R> {
        Vec4::new(self.x, self.y, self.z, w.operand(self.x))
    }

    /// The homogeneous point (x, y, z, 1).
    #[inline(always)]
    pub fn point(self) -> Vec4<R> {
        self.extend(1.0)
    }
}
