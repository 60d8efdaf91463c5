//! The eye of a picture.

/// The position of the eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Eye {
    /// A point in world space: perspectives.
    Point([f64; 3]),
    /// The direction towards an eye at infinity: parallel projections.
    Direction([f64; 3]),
}

impl Eye {
    /// A number that grows with the distance of a point from the eye: its square, or the distance
    /// along the direction of view.
    #[must_use]
    pub fn distance(&self, point: [f64; 3]) -> f64 {
        match self {
            Self::Point(eye) => (0..3).fold(0.0, |sum, axis| {
                let offset = point[axis] - eye[axis];
                sum + offset * offset
            }),
            Self::Direction(towards) => {
                (0..3).fold(0.0, |sum, axis| sum - point[axis] * towards[axis])
            }
        }
    }
}
