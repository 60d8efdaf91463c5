//! The numbers that shaders compute with.

use crate::operand::{Implied, Join, LeftOfReal, Operand, ScaleVectors};
use crate::{Int, ShaderError, maths};
use estampe_simd::Level;
use std::fmt::Debug;
use std::ops::{
    Add, AddAssign, BitAnd, BitOr, Div, DivAssign, Mul, MulAssign, Neg, Not, Sub, SubAssign,
};

/// Real numbers in f32 arithmetic: one (`f32`), the four of a 2×2 quad ([`Quad`](crate::Quad)), the
/// sixteen of a packet (`f32x16<S>`), the thirty-two of a packet pair ([`Pair`](crate::Pair)), or the
/// sixty-four of a pair of pairs.
///
/// Each operation acts on every lane alone and gives the same bits for every implementation.
/// Constants are made from an existing number, because sixteen lanes need the token of their SIMD
/// level. An `f32` may be an operand on either side, and an argument of most methods: `1.0 - x *
/// 0.5`, `x.max(0.0)`, `x.lt(0.5)`. Elsewhere, `x.splat(0.5)` is the constant in every lane.
///
/// # Conditions
///
/// A comparison gives a [mask](Real::SelectMask): a boolean in each lane. Rust's `if`, `&&` and
/// `||` take one `bool`, and `<` and `==` give one, so the compiler refuses them for lanes:
/// "expected `bool`, found associated type `<R as Real>::SelectMask`", "binary operation `<` cannot
/// be applied to type `R`". Compute both branches, and let [`Real::select`] choose in each lane:
///
/// ```
/// use estampe_types::Real;
///
/// /// Instead of `if x < 0.0 { -x } else { x * 2.0 }`.
/// fn fold<R: Real>(x: R) -> R {
///     R::select(x.lt(0.0), -x, x * 2.0)
/// }
/// assert_eq!(fold(-3.0), 3.0);
/// ```
///
/// ```compile_fail
/// # use estampe_types::Real;
/// fn fold<R: Real>(x: R) -> R {
///     if x.lt(0.0) { -x } else { x * 2.0 } // write R::select(x.lt(0.0), -x, x * 2.0)
/// }
/// ```
///
/// Masks are combined by `&`, `|` and `!`. [`Real::any`] and [`Real::all`] give one boolean for all
/// lanes, for example to leave a loop.
///
/// # Functions
///
/// The functions of [`maths`] are methods too; their documentation calls `self` x. In code that is
/// not generic, `f32`'s own methods of the same names come first: `x.sin()` of an `f32` is the
/// system's sine, and `x.clamp(a, b)` keeps NaN. The functions of [`maths`] are always ours.
///
/// # Associated types
///
/// The operators with an `f32` on the left are implied by a bound `R: Real` of a type parameter. A
/// trait of your own with `type Number: Real` must restate them, as [`Int`] does.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a number that shaders compute with",
    note = "numbers are `R: Real`, `f32`, `Quad` and packets; write constants as `f32` (`2.0`, not \
            `2`)"
)]
pub trait Real:
    Copy
    + Debug
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f32, Output = Self>
    + Sub<f32, Output = Self>
    + Mul<f32, Output = Self>
    + Div<f32, Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
    + AddAssign<f32>
    + SubAssign<f32>
    + MulAssign<f32>
    + DivAssign<f32>
    + Join<Self, Joined = Self>
    + Join<f32, Joined = Self>
    + ScaleVectors
    + Implied<f32, Is = f32>
    + Implied<f32, Is: LeftOfReal<Self>>
{
    /// A boolean in each lane. It cannot be the condition of an `if`: see [`Real::select`].
    type SelectMask: Copy
        + Debug
        + BitAnd<Output = Self::SelectMask>
        + BitOr<Output = Self::SelectMask>
        + Not<Output = Self::SelectMask>;
    /// A 32-bit integer for each lane.
    type Int: Int<Real = Self, SelectMask = Self::SelectMask>;

    /// The number of lanes: 1, 4, 16, 32 or 64.
    const LANES: usize;
    /// True if several lanes are emulated by scalar instructions. Long code with many table
    /// look-ups should then loop over the lanes with `f32` numbers.
    const EMULATED_LANES: bool;

    /// `value` in every lane.
    #[must_use]
    fn splat(self, value: f32) -> Self;
    /// `value` in every lane, as integers.
    #[must_use]
    fn splat_int(self, value: i32) -> Self::Int;
    /// `value` in every lane of a mask.
    #[must_use]
    fn splat_mask(self, value: bool) -> Self::SelectMask;

    /// Square root, correctly rounded.
    #[must_use]
    fn sqrt(self) -> Self;
    /// Absolute value.
    #[must_use]
    fn abs(self) -> Self;
    /// The greatest integer that is not above `self`.
    #[must_use]
    fn floor(self) -> Self;
    /// `self < other ? self : other`: `other` where either is NaN.
    #[must_use]
    fn min(self, other: impl Operand<Self>) -> Self;
    /// `self > other ? self : other`: `other` where either is NaN.
    #[must_use]
    fn max(self, other: impl Operand<Self>) -> Self;

    /// True in the lanes where `self < other`.
    fn lt(self, other: impl Operand<Self>) -> Self::SelectMask;
    /// True in the lanes where `self <= other`.
    fn le(self, other: impl Operand<Self>) -> Self::SelectMask;
    /// True in the lanes where `self == other`.
    fn eq(self, other: impl Operand<Self>) -> Self::SelectMask;
    /// True in the lanes where `self > other`.
    #[inline(always)]
    fn gt(self, other: impl Operand<Self>) -> Self::SelectMask {
        other.operand(self).lt(self)
    }
    /// True in the lanes where `self >= other`.
    #[inline(always)]
    fn ge(self, other: impl Operand<Self>) -> Self::SelectMask {
        other.operand(self).le(self)
    }

    /// `yes` in the lanes of the mask, `no` in the others.
    #[must_use]
    fn select(mask: Self::SelectMask, yes: Self, no: Self) -> Self;
    /// True if the mask is true in any lane.
    fn any(mask: Self::SelectMask) -> bool;
    /// True if the mask is true in every lane.
    #[inline(always)]
    fn all(mask: Self::SelectMask) -> bool {
        !Self::any(!mask)
    }
    /// The mask as bits: lane `i` is bit `i`.
    fn mask_bits(mask: Self::SelectMask) -> u64;

    /// Rounds towards zero. NaN gives 0; values out of range give the least or the greatest
    /// integer.
    fn to_int(self) -> Self::Int;
    /// Rounds numbers within ±2³⁰ towards zero. The result for any other number is unspecified and
    /// may differ between SIMD levels. This is one instruction where [`Real::to_int`] takes
    /// several.
    fn to_int_within_range(self) -> Self::Int;
    /// The bits of each lane as an integer.
    fn to_bits(self) -> Self::Int;

    /// Fine partial derivative in x: right minus left neighbour in the lane's row of its 2×2 quad.
    /// 0 for a single fragment (`f32`), which has no neighbours.
    #[must_use]
    fn ddx(self) -> Self;
    /// Fine partial derivative in y: lower minus upper neighbour in the lane's column of its quad.
    /// 0 for a single fragment (`f32`), which has no neighbours.
    #[must_use]
    fn ddy(self) -> Self;

    /// Coarse partial derivative in x: that of the quad's first row, in all four lanes. 0 for a
    /// single fragment (`f32`), which has no neighbours.
    #[must_use]
    fn ddx_coarse(self) -> Self;
    /// Coarse partial derivative in y: that of the quad's first column, in all four lanes. 0 for a
    /// single fragment (`f32`), which has no neighbours.
    #[must_use]
    fn ddy_coarse(self) -> Self;

    /// Broadcasts one fragment of each 2×2 quad to all four lanes: 0 is top left, 1 top right, 2
    /// bottom left, 3 bottom right. A single fragment (`f32`) is returned unchanged.
    #[must_use]
    fn quad_lane(self, index: u8) -> Self;

    /// Calls `work` in a separate function that is compiled for this kind of number. For code that
    /// many shaders share, which then do not each contain it, and for the parts of a long shader:
    /// the compiler's time grows faster than the length of a function. A call takes a few
    /// nanoseconds for a packet. A closure must be inlined into that function:
    ///
    /// ```
    /// use estampe_types::{Real, Vec3};
    ///
    /// #[inline(always)]
    /// fn shaded<R: Real>(normal: Vec3<R>, lights: &[[f32; 3]]) -> R {
    ///     let mut sum = normal.x.splat(0.0);
    ///     for light in lights {
    ///         sum += normal.x.out_of_line(
    ///             #[inline(always)]
    ///             || normal.dot_uniform(*light).saturate(),
    ///         );
    ///     }
    ///     sum
    /// }
    /// let up = Vec3::new(0.0, 1.0, 0.0);
    /// assert_eq!(shaded(up, &[[0.0, 0.5, 0.0], [0.0, -1.0, 0.0]]), 0.5);
    /// ```
    #[inline(never)]
    fn out_of_line<T>(self, work: impl FnOnce() -> T) -> T {
        work()
    }

    /// The SIMD level of packets, at which code that is compiled once for all shaders is entered;
    /// `None` for a single fragment and for a quad.
    #[inline(always)]
    fn level(self) -> Option<Level> {
        None
    }

    /// Called where a shader breaks a rule that only its values show. The dry run records it, so
    /// that no pipeline is made; elsewhere the broken call has no effect, and debug builds stop.
    #[doc(hidden)]
    #[inline(always)]
    fn report(self, misuse: ShaderError) {
        debug_assert!(false, "{misuse}");
    }

    /// Called where something depends on the quad's derivatives without taking them of a number: a
    /// texture's level of detail. The dry run records it.
    #[doc(hidden)]
    #[inline(always)]
    fn takes_derivatives(self) {
        crate::derivatives::note();
    }

    /// One lane's value; `index` is below [`Real::LANES`].
    fn lane(self, index: usize) -> f32;
    /// [`Real::lane`] for a sampler that stores all lanes: nothing but colours comes of them, so
    /// the dry run takes no note of it.
    #[doc(hidden)]
    #[inline(always)]
    fn lane_to_store(self, index: usize) -> f32 {
        self.lane(index)
    }
    /// A number of the same kind, whose lanes are computed from their index.
    #[must_use]
    fn with_lanes(self, value: impl FnMut(usize) -> f32) -> Self;

    /// `self` clamped to `low..=high`: `max(low)` then `min(high)`; NaN gives `low`.
    #[inline(always)]
    #[must_use]
    fn clamp(self, low: impl Operand<Self>, high: impl Operand<Self>) -> Self {
        self.max(low).min(high)
    }

    /// `self` clamped to 0..=1; NaN gives 0.
    #[inline(always)]
    #[must_use]
    fn saturate(self) -> Self {
        self.clamp(0.0, 1.0)
    }

    /// `self − floor(self)`.
    #[inline(always)]
    #[must_use]
    fn fract(self) -> Self {
        self - self.floor()
    }

    /// `self + (other − self)·t`.
    #[inline(always)]
    #[must_use]
    fn mix(self, other: impl Operand<Self>, t: impl Operand<Self>) -> Self {
        self + (other.operand(self) - self) * t.operand(self)
    }

    maths::with_functions! { methods_of_real }
}
