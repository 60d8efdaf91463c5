//! The subdivision of an edge by its level (V3).
//!
//! *In* a level and a spacing · *Out* the places of the points, in units of 2⁻²⁴ · *Spec* Vulkan
//! §Tessellator Spacing.
//!
//! An edge of n segments at the level f has its point j, 0 < j < n, at (f − n + 2j) / 2f: with
//! equal spacing, f = n, that is j/n; with fractional spacing the first and the last segment are
//! shorter. Places up to ½ are rounded to multiples of 2⁻²⁴, those above are 1 − the place of the
//! point that lies symmetrically. So 1 − u is exact, and an edge has the same points from both
//! ends.

use estampe_types::state::TessellationSpacing;

/// The unit interval, in the units of places.
pub(crate) const ONE: u32 = 1 << 24;

/// The bits of a level's fraction: levels are multiples of 2⁻²³, as every f32 from 1 to 64 is.
const LEVEL_BITS: u32 = 23;

/// An edge that is divided into segments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Subdivision {
    /// The number of segments, at most 64.
    pub(crate) segments: u32,
    /// The level, in units of 2⁻²³.
    level: u64,
}

impl Subdivision {
    /// The subdivision at a level. NaN counts as the least level.
    pub(crate) fn new(spacing: TessellationSpacing, level: f32) -> Self {
        let (least, greatest) = match spacing {
            TessellationSpacing::Equal => (1.0, 64.0),
            TessellationSpacing::FractionalOdd => (1.0, 63.0),
            TessellationSpacing::FractionalEven => (2.0, 64.0),
        };
        let level = if level > least {
            level.min(greatest)
        } else {
            least
        };
        let whole = small(level.ceil());
        let segments = match spacing {
            TessellationSpacing::Equal => whole,
            TessellationSpacing::FractionalOdd => whole | 1,
            TessellationSpacing::FractionalEven => whole + whole % 2,
        };
        if spacing == TessellationSpacing::Equal {
            return Self::equal(segments);
        }
        Self {
            segments,
            level: u64::from(small(level * (1 << LEVEL_BITS) as f32)),
        }
    }

    /// Segments of the same length.
    pub(crate) fn equal(segments: u32) -> Self {
        Self {
            segments,
            level: u64::from(segments) << LEVEL_BITS,
        }
    }

    /// An inner subdivision of one segment where something else has more: its level counts as 1 +
    /// ε, which is rounded up to two or three segments.
    pub(crate) fn divided(self, spacing: TessellationSpacing) -> Self {
        match (self.segments, spacing) {
            (1, TessellationSpacing::FractionalOdd) => Self {
                segments: 3,
                level: 1 << LEVEL_BITS,
            },
            (1, _) => Self::equal(2),
            _ => self,
        }
    }

    /// Twice the level: the denominator of [`Subdivision::numerator`].
    pub(super) fn denominator(self) -> u64 {
        2 * self.level
    }

    /// The exact place of point `j` between the ends, times the denominator.
    pub(super) fn numerator(self, j: u32) -> u64 {
        // level − (n − 2j), which is not negative: the level is at least n − 2, and j at least 1.
        self.level + (u64::from(2 * j) << LEVEL_BITS) - (u64::from(self.segments) << LEVEL_BITS)
    }

    /// The place of point `j`, in 0..=[`ONE`].
    pub(crate) fn place(self, j: u32) -> u32 {
        if j == 0 {
            0
        } else if 2 * j > self.segments {
            ONE - self.place(self.segments - j)
        } else {
            rounded(self.numerator(j), self.denominator())
        }
    }
}

/// A fraction in units of 2⁻²⁴, to the nearest, halves up.
pub(super) fn rounded(numerator: u64, denominator: u64) -> u32 {
    // The numerator is below 2³³, twice three times the greatest level.
    let twice = (numerator << 25) + denominator;
    u32::try_from(twice / (2 * denominator)).unwrap_or(ONE)
}

/// An integer that a float holds.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "levels are 1 to 64, and multiples of 2⁻²³"
)]
fn small(value: f32) -> u32 {
    value as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use TessellationSpacing as S;

    #[test]
    fn levels_are_clamped_and_rounded_up() {
        let segments = |spacing, level| Subdivision::new(spacing, level).segments;
        for (level, [equal, odd, even]) in [
            (f32::NAN, [1, 1, 2]),
            (-3.0, [1, 1, 2]),
            (1.0, [1, 1, 2]),
            (1.000_001, [2, 3, 2]),
            (3.0, [3, 3, 4]),
            (3.5, [4, 5, 4]),
            (63.0, [63, 63, 64]),
            (63.5, [64, 63, 64]),
            (f32::INFINITY, [64, 63, 64]),
        ] {
            assert_eq!(segments(S::Equal, level), equal, "{level}");
            assert_eq!(segments(S::FractionalOdd, level), odd, "{level}");
            assert_eq!(segments(S::FractionalEven, level), even, "{level}");
        }
    }

    #[test]
    fn places_are_symmetric_and_ascend() {
        for spacing in [S::Equal, S::FractionalOdd, S::FractionalEven] {
            for step in 0..=630 {
                let edge = Subdivision::new(spacing, 1.0 + step as f32 * 0.1);
                let n = edge.segments;
                for j in 0..n {
                    assert_eq!(edge.place(j), ONE - edge.place(n - j));
                    assert!(edge.place(j) < edge.place(j + 1), "{edge:?} {j}");
                }
            }
        }
    }
}
