//! Rectangles of pixels.

use estampe_types::state::ScissorRect;

/// A half-open rectangle of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PixelRect {
    pub(crate) x0: i32,
    pub(crate) y0: i32,
    pub(crate) x1: i32,
    pub(crate) y1: i32,
}

impl PixelRect {
    /// Scissor ∩ target.
    pub(crate) fn of_target(scissor: Option<ScissorRect>, width: u32, height: u32) -> Self {
        let size = |pixels: u32| i32::try_from(pixels).unwrap_or(i32::MAX);
        let target = Self {
            x0: 0,
            y0: 0,
            x1: size(width),
            y1: size(height),
        };
        match scissor {
            Some(scissor) => target.intersection(Self {
                x0: size(scissor.x),
                y0: size(scissor.y),
                x1: size(scissor.x.saturating_add(scissor.width)),
                y1: size(scissor.y.saturating_add(scissor.height)),
            }),
            None => target,
        }
    }

    /// The pixels of both rectangles.
    pub(crate) fn intersection(self, other: Self) -> Self {
        Self {
            x0: self.x0.max(other.x0),
            y0: self.y0.max(other.y0),
            x1: self.x1.min(other.x1),
            y1: self.y1.min(other.y1),
        }
    }

    /// Returns true if the rectangle contains no pixels.
    pub(crate) fn is_empty(&self) -> bool {
        self.x0 >= self.x1 || self.y0 >= self.y1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scissor_is_cut_to_the_target() {
        let scissor = ScissorRect {
            x: 3,
            y: u32::MAX,
            width: u32::MAX,
            height: 1,
        };
        let rect = PixelRect::of_target(Some(scissor), 10, 20);
        assert_eq!([rect.x0, rect.x1, rect.y1], [3, 10, 20]);
        assert!(rect.is_empty());
        assert!(!PixelRect::of_target(None, 10, 20).is_empty());
    }
}
