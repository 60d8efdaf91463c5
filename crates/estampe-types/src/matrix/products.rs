//! Products of matrices, vectors and numbers.

use super::{Mat2, Mat3, Mat4};
use crate::operand::Join;
use crate::{Real, Vec2, Vec3, Vec4};
use std::ops::Mul;

/// The kind of number that two kinds give.
type Joined<A, B> = <A as Join<B>>::Joined;

// Functions and not closures: the compiler decides whether it inlines a closure, and one that was
// not inlined lost the shader its SIMD level.

/// The product of a vector's component and an element of a matrix.
#[inline(always)]
fn times<B: Join<A, Joined: Real>, A>(component: B, element: A) -> Joined<B, A> {
    let (component, element) = component.join(element);
    component * element
}

/// A row times (v, 0).
#[inline(always)]
fn linear<B: Real + Join<A, Joined: Real>, A: Real>(row: [A; 4], v: Vec3<B>) -> Joined<B, A> {
    times(v.x, row[0]) + times(v.y, row[1]) + times(v.z, row[2])
}

/// A row times (v, 1).
#[inline(always)]
fn affine<B: Real + Join<A, Joined: Real>, A: Real>(row: [A; 4], v: Vec3<B>) -> Joined<B, A> {
    let (_, last) = v.x.join(row[3]);
    linear(row, v) + last
}

impl<A: Real> Mat4<A> {
    /// `m * (v, 1)`: the fourth column is added last, without a product.
    #[inline(always)]
    pub fn transform_point<B: Real + Join<A, Joined: Real>>(
        &self,
        v: Vec3<B>,
    ) -> Vec4<Joined<B, A>> {
        let [x, y, z, w] = self.rows();
        Vec4::new(affine(x, v), affine(y, v), affine(z, v), affine(w, v))
    }

    /// The upper left 3×3 part times `v`: directions, whose w is 0.
    #[inline(always)]
    pub fn transform_vector<B: Real + Join<A, Joined: Real>>(
        &self,
        v: Vec3<B>,
    ) -> Vec3<Joined<B, A>> {
        let [x, y, z, _] = self.rows();
        Vec3::new(linear(x, v), linear(y, v), linear(z, v))
    }
}

/// A row times v, for each size.
#[inline(always)]
fn row2<B: Real + Join<A, Joined: Real>, A: Real>(row: [A; 2], v: Vec2<B>) -> Joined<B, A> {
    times(v.x, row[0]) + times(v.y, row[1])
}
#[inline(always)]
fn row3<B: Real + Join<A, Joined: Real>, A: Real>(row: [A; 3], v: Vec3<B>) -> Joined<B, A> {
    times(v.x, row[0]) + times(v.y, row[1]) + times(v.z, row[2])
}
#[inline(always)]
fn row4<B: Real + Join<A, Joined: Real>, A: Real>(row: [A; 4], v: Vec4<B>) -> Joined<B, A> {
    times(v.x, row[0]) + times(v.y, row[1]) + times(v.z, row[2]) + times(v.w, row[3])
}

macro_rules! products {
    ($name:ident $vector:ident $product:ident: $($row:ident)+) => {
        impl<A: Real, B: Real + Join<A, Joined: Real>> Mul<$vector<B>> for $name<A> {
            type Output = $vector<Joined<B, A>>;
            /// Sums each row's products from the first column on.
            #[inline(always)]
            fn mul(self, v: $vector<B>) -> Self::Output {
                let [$($row),+] = self.rows();
                $vector::new($($product($row, v)),+)
            }
        }

        impl<A: Real, B: Real + Join<A, Joined: Real>> Mul<$name<B>> for $name<A> {
            type Output = $name<Joined<B, A>>;
            /// This matrix times each column of the other.
            #[inline(always)]
            fn mul(self, other: $name<B>) -> Self::Output {
                let [$($row),+] = other.columns();
                $name::from_columns($(self * $row),+)
            }
        }

        impl<A: Real + Join<B, Joined: Real>, B: Real> Mul<B> for $name<A> {
            type Output = $name<Joined<A, B>>;
            /// Each element times a number.
            #[inline(always)]
            fn mul(self, by: B) -> Self::Output {
                let [$($row),+] = self.columns();
                $name::from_columns($($row * by),+)
            }
        }
    };
}
products! { Mat2 Vec2 row2: x y }
products! { Mat3 Vec3 row3: x y z }
products! { Mat4 Vec4 row4: x y z w }
