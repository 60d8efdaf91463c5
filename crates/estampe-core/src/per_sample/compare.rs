//! Comparison functions: of depths and stencil values, sixteen or one; and the extremes of many.

use estampe_simd::{LANES, Lanes, SimdBase, f32x16, mask8x16, mask32x16, u8x16};
use estampe_types::state::CompareFunction;

/// Values that a comparison function compares, and what it says of them.
pub(crate) trait Comparable: Copy {
    /// One truth value for each pair that is compared.
    type Outcome;

    fn never(self) -> Self::Outcome;
    fn always(self) -> Self::Outcome;
    fn is_less(self, other: Self) -> Self::Outcome;
    fn is_equal(self, other: Self) -> Self::Outcome;
    fn is_less_equal(self, other: Self) -> Self::Outcome;
    fn is_greater(self, other: Self) -> Self::Outcome;
    fn is_not_equal(self, other: Self) -> Self::Outcome;
    fn is_greater_equal(self, other: Self) -> Self::Outcome;
}

/// Evaluates `new OP stored`.
///
/// The function is selected anew for every packet, where a branch predictor foresees it. A copy of
/// the loops for each of the eight comparisons, at every SIMD level, took the compiler minutes.
#[inline(always)]
pub(crate) fn compare<T: Comparable>(function: CompareFunction, new: T, stored: T) -> T::Outcome {
    match function {
        CompareFunction::Never => new.never(),
        CompareFunction::Less => new.is_less(stored),
        CompareFunction::Equal => new.is_equal(stored),
        CompareFunction::LessEqual => new.is_less_equal(stored),
        CompareFunction::Greater => new.is_greater(stored),
        CompareFunction::NotEqual => new.is_not_equal(stored),
        CompareFunction::GreaterEqual => new.is_greater_equal(stored),
        CompareFunction::Always => new.always(),
    }
}

/// Returns true if a comparison orders depths, so that the order of drawing decides only between
/// equal depths.
#[inline(always)]
pub(crate) fn orders(function: CompareFunction) -> bool {
    matches!(
        function,
        CompareFunction::Less
            | CompareFunction::LessEqual
            | CompareFunction::Greater
            | CompareFunction::GreaterEqual
    )
}

/// Returns true if smaller depths pass and larger ones do not.
#[inline(always)]
pub(crate) fn prefers_less(function: CompareFunction) -> bool {
    matches!(function, CompareFunction::Less | CompareFunction::LessEqual)
}

impl<S: Lanes> Comparable for f32x16<S> {
    type Outcome = mask32x16<S>;

    #[inline(always)]
    fn never(self) -> mask32x16<S> {
        // False of NaN, too.
        self.simd_lt(self)
    }
    #[inline(always)]
    fn always(self) -> mask32x16<S> {
        !self.simd_lt(self)
    }
    #[inline(always)]
    fn is_less(self, other: Self) -> mask32x16<S> {
        self.simd_lt(other)
    }
    #[inline(always)]
    fn is_equal(self, other: Self) -> mask32x16<S> {
        self.simd_eq(other)
    }
    #[inline(always)]
    fn is_less_equal(self, other: Self) -> mask32x16<S> {
        self.simd_le(other)
    }
    #[inline(always)]
    fn is_greater(self, other: Self) -> mask32x16<S> {
        self.simd_gt(other)
    }
    #[inline(always)]
    fn is_not_equal(self, other: Self) -> mask32x16<S> {
        self.simd_ne(other)
    }
    #[inline(always)]
    fn is_greater_equal(self, other: Self) -> mask32x16<S> {
        self.simd_ge(other)
    }
}

impl<S: Lanes> Comparable for u8x16<S> {
    type Outcome = mask8x16<S>;

    #[inline(always)]
    fn never(self) -> mask8x16<S> {
        self.simd_ne(self)
    }
    #[inline(always)]
    fn always(self) -> mask8x16<S> {
        self.simd_eq(self)
    }
    #[inline(always)]
    fn is_less(self, other: Self) -> mask8x16<S> {
        self.simd_lt(other)
    }
    #[inline(always)]
    fn is_equal(self, other: Self) -> mask8x16<S> {
        self.simd_eq(other)
    }
    #[inline(always)]
    fn is_less_equal(self, other: Self) -> mask8x16<S> {
        self.simd_le(other)
    }
    #[inline(always)]
    fn is_greater(self, other: Self) -> mask8x16<S> {
        self.simd_gt(other)
    }
    #[inline(always)]
    fn is_not_equal(self, other: Self) -> mask8x16<S> {
        self.simd_ne(other)
    }
    #[inline(always)]
    fn is_greater_equal(self, other: Self) -> mask8x16<S> {
        self.simd_ge(other)
    }
}

/// Comparisons of one value.
macro_rules! one_value {
    ($type:ty) => {
        impl Comparable for $type {
            type Outcome = bool;

            #[inline(always)]
            fn never(self) -> bool {
                false
            }
            #[inline(always)]
            fn always(self) -> bool {
                true
            }
            #[inline(always)]
            fn is_less(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn is_equal(self, other: Self) -> bool {
                self == other
            }
            #[inline(always)]
            fn is_less_equal(self, other: Self) -> bool {
                self <= other
            }
            #[inline(always)]
            fn is_greater(self, other: Self) -> bool {
                self > other
            }
            #[inline(always)]
            fn is_not_equal(self, other: Self) -> bool {
                self != other
            }
            #[inline(always)]
            fn is_greater_equal(self, other: Self) -> bool {
                self >= other
            }
        }
    };
}

one_value!(f32);
one_value!(u8);

/// The least and the greatest of depths, none of which is NaN. One after the other they would be
/// waited for, so four go side by side.
#[inline(always)]
pub(super) fn extremes(lines: &[[f32; LANES]]) -> [f32; 2] {
    let least = |a: f32, b: f32| if a < b { a } else { b };
    let greatest = |a: f32, b: f32| if a > b { a } else { b };
    let (mut low, mut high) = ([f32::INFINITY; 4], [f32::NEG_INFINITY; 4]);
    for depths in lines.as_flattened().as_chunks::<4>().0 {
        for ((low, high), depth) in low.iter_mut().zip(&mut high).zip(depths) {
            *low = least(*low, *depth);
            *high = greatest(*high, *depth);
        }
    }
    [
        least(least(low[0], low[2]), least(low[1], low[3])),
        greatest(greatest(high[0], high[2]), greatest(high[1], high[3])),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_are_found_in_each_lane() {
        for at in 0..2 * LANES {
            let mut lines = [[0.5; LANES]; 2];
            lines.as_flattened_mut()[at] = 0.25;
            assert_eq!(extremes(&lines), [0.25, 0.5]);
            lines.as_flattened_mut()[at] = 0.75;
            assert_eq!(extremes(&lines), [0.5, 0.75]);
        }
    }
}
