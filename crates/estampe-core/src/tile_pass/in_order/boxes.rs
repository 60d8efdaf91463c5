//! Two triangles that make a [rectangle](crate::geometry::rectangles), drawn as one box that is not
//! listed with others: a large sprite.
//!
//! Their values are the same planes, so the first one's serve both. The packets on the diagonal are
//! tested and shaded once and not twice, and those of its inside are whole.

use super::InOrder;
use super::triangle::WholeBlocks;
use crate::bounds::primitives::Triangle;
use crate::fragment::interpolate::DepthPlane;
use crate::raster::pixel_box::PixelBox;

impl<const N: usize> InOrder<'_, '_, '_, '_, N> {
    /// Lists the packets of the box of a rectangle's first half, less those that hierarchical z
    /// rejects. `None` if it covers nothing.
    #[inline(always)]
    pub(super) fn cover_box(
        &mut self,
        triangle: &Triangle,
        plane: &DepthPlane,
    ) -> Option<WholeBlocks> {
        let (shape, rect) = (self.work.shape, &self.work.rect);
        self.scratch.in_order.list.clear();
        let ([x0, x1, x2], [top, _, bottom]) = (triangle.x, triangle.y);
        let (left, right) = (x0.min(x1).min(x2), x0.max(x1).max(x2));
        let pixels = PixelBox::between([[left, top], [right, bottom]], shape, rect)?;
        let hidden = self.classify(plane, pixels.packets())?.hidden;
        pixels.cover(hidden, &mut self.scratch.in_order.list);
        self.scratch.statistics.boxes_in_order += 1;
        Some(WholeBlocks::default())
    }
}
