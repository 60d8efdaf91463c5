//! Axis-aligned bounds of a set of points.

use glam::Vec3;

/// An axis-aligned box; empty until a point is added.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The least coordinate on each axis; +∞ when empty.
    pub min: Vec3,
    /// The greatest coordinate on each axis; −∞ when empty.
    pub max: Vec3,
}

impl Bounds {
    /// The box that contains no point.
    pub const EMPTY: Self = Self {
        min: Vec3::INFINITY,
        max: Vec3::NEG_INFINITY,
    };

    /// The smallest box around all finite points; points with a NaN or infinite coordinate are left
    /// out.
    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Self {
        let mut bounds = Self::EMPTY;
        for point in points {
            if point.is_finite() {
                bounds.min = bounds.min.min(point);
                bounds.max = bounds.max.max(point);
            }
        }
        bounds
    }

    /// True if no point was added.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The smallest box around both boxes.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// The middle of the box; the origin when empty. The corners are halved before they are added,
    /// so that the sum cannot overflow.
    #[must_use]
    pub fn center(&self) -> Vec3 {
        if self.is_empty() {
            Vec3::ZERO
        } else {
            self.min * 0.5 + self.max * 0.5
        }
    }

    /// Length of the diagonal; 0 when empty.
    #[must_use]
    pub fn diagonal(&self) -> f32 {
        if self.is_empty() {
            0.0
        } else {
            (self.max - self.min).length()
        }
    }
}
