//! A cross of the file's axes in the image's lower left corner, with their letters.

use super::{AXIS_COLORS, marks};
use crate::canvas::Canvas;
use crate::scene_view::SceneView;
use crate::text::{TextHeight, TextStyle, text_width_px, write_text};
use glam::{DVec2, DVec3};

const LETTERS: [&str; 3] = ["X", "Y", "Z"];

/// Draws the cross; the axes that point away from the eye first.
pub(super) fn mark_axes(image: &mut impl Canvas, view: &SceneView) {
    let [width_px, height_px] = image.size();
    let shorter = width_px.min(height_px);
    let length = f64::from(shorter / 9).clamp(14.0, 64.0);
    let height = TextHeight::at_most(shorter / 20);
    let letter = f64::from(height.px());
    let border = length + letter * 0.9;
    let origin = DVec2::new(border, f64::from(height_px) - border);
    let frame = &view.camera.frame;
    let in_view = |axis: usize| {
        let world = view.space.world_from_object * DVec3::AXES[axis];
        [frame.right_world, frame.up_world, frame.back_world].map(|to| world.dot(to))
    };
    let mut axes: Vec<(usize, [f64; 3])> = (0..3).map(|axis| (axis, in_view(axis))).collect();
    axes.sort_by(|a, b| a.1[2].total_cmp(&b.1[2]));
    for (axis, [right, up, _]) in axes {
        let direction = DVec2::new(right, -up);
        let tip = origin + direction * length;
        marks::line(
            image,
            [origin, tip],
            (length / 16.0).max(1.5),
            AXIS_COLORS[axis],
        );
        // An axis towards the eye has its letter beside the origin.
        let aside = direction.try_normalize().unwrap_or(DVec2::new(-0.7, 0.7));
        let middle = tip + aside * (letter * 0.55);
        let width = f64::from(text_width_px(LETTERS[axis], height));
        let corner = middle - DVec2::new(width, letter) / 2.0;
        let style = TextStyle {
            height,
            color: AXIS_COLORS[axis],
            outline: None,
        };
        write_text(image, rounded(corner), LETTERS[axis], style);
    }
}

/// The pixel at a place in the image.
#[expect(
    clippy::cast_possible_truncation,
    reason = "places are near the image, which has at most 16384 pixels a side"
)]
pub(super) fn rounded(place: DVec2) -> (i64, i64) {
    let place = place.clamp(DVec2::splat(-1e6), DVec2::splat(1e6));
    (
        libm::floor(place.x + 0.5) as i64,
        libm::floor(place.y + 0.5) as i64,
    )
}
