//! Exact predicates: no rounding, so that no two of them contradict each other.
//!
//! Corners in f32 have exact orientations ([`orientation`]). The points at which edges of a polygon
//! cross are not representable; they are computed from corners on an integer grid, as fractions
//! ([`ExactPoint`]). With corners of at most 2²⁸ every intermediate result fits 256 bits
//! ([`Wide`]):
//!
//! | value | bound |
//! |---|---|
//! | coordinate | 2²⁸ |
//! | difference of coordinates | 2²⁹ |
//! | cross product of edges: the denominator w of a crossing | 2⁵⁹ |
//! | numerators of a crossing, x₀ w + t dx | 2⁸⁹ |
//! | 2 × 2 minor of two points' numerators | 2¹⁷⁹ |
//! | orientation of three points, a 3 × 3 determinant | 2²⁴⁰ |

mod orientation;
mod point;
mod wide;

pub(super) use orientation::orientation;
pub(super) use point::{ExactPoint, MAX_COORDINATE, cross};
use wide::Wide;
