//! Guides: a grid on the ground, a cross of axes in a corner, and the model's box with its sizes.
//!
//! ```text
//!   grid, bounding_box ── strokes, which the model hides ── drawn before transparent surfaces
//!   axis_cross, dimensions ── marks on the finished image
//! ```

mod axis_cross;
mod bounding_box;
mod grid;
mod marks;

#[cfg(test)]
mod tests;

pub(crate) use bounding_box::box_strokes;
pub(crate) use grid::grid_strokes;

use crate::canvas::Canvas;
use crate::options::RenderOptions;
use crate::scene_view::SceneView;
use glam::DVec3;

/// The model's box as lines, with its sizes.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct BoundingBox {
    /// The unit of the file's lengths, which follows the numbers, as in `mm`. Default none.
    pub unit: Option<String>,
}

/// Colours of the axes x, y and z, sRGB.
pub(crate) const AXIS_COLORS: [[u8; 3]; 3] =
    [[0xd8, 0x3a, 0x3a], [0x2f, 0x9e, 0x44], [0x2f, 0x6f, 0xd8]];

/// The number of the file's axis that a direction in world space runs along, if it does.
fn axis_of(view: &SceneView, direction_world: DVec3) -> Option<usize> {
    let of_file = view.space.world_from_object.transpose() * direction_world;
    let along = of_file.abs();
    (0..3).find(|&axis| along[axis] > 0.9999)
}

/// Draws the marks of the options on a finished image.
pub(crate) fn mark(image: &mut impl Canvas, view: &SceneView, options: &RenderOptions) {
    if let Some(bounding_box) = &options.bounding_box {
        bounding_box::mark_sizes(image, view, bounding_box, options);
    }
    if options.axes {
        axis_cross::mark_axes(image, view);
    }
}
