//! Edges that are divided by a level.

use super::Fraction;
use estampe_types::state::TessellationSpacing;

/// The unit interval, as a number of multiples of 2⁻²⁴.
pub(super) const ONE: u32 = 1 << 24;

/// A divided edge: the exact places of its points from 0 to 1, ascending.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Edge {
    /// The places.
    pub places: Vec<Fraction>,
}

impl Edge {
    /// An edge at a level. `is_above_one`: the level counts as 1 + ε if it is clamped to 1.
    #[must_use]
    pub fn new(spacing: TessellationSpacing, level: f32, is_above_one: bool) -> Self {
        let (low, high) = match spacing {
            TessellationSpacing::Equal => (1.0, 64.0),
            TessellationSpacing::FractionalOdd => (1.0, 63.0),
            TessellationSpacing::FractionalEven => (2.0, 64.0),
        };
        let clamped = if level.is_nan() {
            low
        } else {
            level.clamp(low, high)
        };
        let level = Fraction::of_level(clamped);
        let above = is_above_one && level == Fraction::whole(1);
        let mut segments = level.ceil() + i128::from(above);
        match spacing {
            TessellationSpacing::Equal => {}
            TessellationSpacing::FractionalOdd => segments += 1 - segments % 2,
            TessellationSpacing::FractionalEven => segments += segments % 2,
        }
        let (whole, one) = (Fraction::whole, Fraction::whole(1));
        let (first, length) = match spacing {
            TessellationSpacing::Equal => (one / whole(segments), one / whole(segments)),
            _ if segments == 1 => (one, one),
            // What the others leave, halved.
            _ => ((one - whole(segments - 2) / level) / whole(2), one / level),
        };
        let mut places = vec![whole(0), first];
        for _ in 2..segments {
            places.push(places[places.len() - 1] + length);
        }
        if segments > 1 {
            places.push(one);
        }
        Self { places }
    }

    /// The number of segments.
    #[must_use]
    pub fn segments(&self) -> usize {
        self.places.len() - 1
    }

    /// The place of point `j` as a number of multiples of 2⁻²⁴: rounded in the lower half, and 1
    /// minus that of its mirror image in the upper one.
    #[must_use]
    pub fn place(&self, j: usize) -> u32 {
        let mirrored = self.segments() - j;
        if j > mirrored {
            ONE - self.places[mirrored].rounded()
        } else {
            self.places[j].rounded()
        }
    }
}
