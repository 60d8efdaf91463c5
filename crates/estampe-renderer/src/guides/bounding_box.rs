//! The model's box as lines, and its sizes beside three of its edges.

use super::axis_cross::rounded;
use super::{AXIS_COLORS, BoundingBox, axis_of};
use crate::canvas::Canvas;
use crate::options::RenderOptions;
use crate::scene_view::SceneView;
use crate::strokes::{Stroke, Window};
use crate::text::{TextHeight, TextStyle, text_width_px, write_text};
use glam::{DVec2, DVec3};

/// The numbers of the corners at the ends of the twelve edges: those along x, y and z.
fn edges() -> impl Iterator<Item = (usize, [usize; 2])> {
    (0..3).flat_map(|axis| {
        let bit = 1 << axis;
        let starts = (0..8).filter(move |corner| corner & bit == 0);
        starts.map(move |corner| (axis, [corner, corner | bit]))
    })
}

/// The strokes of the box.
pub(crate) fn box_strokes(view: &SceneView) -> Vec<Stroke> {
    let corners = view.space.corners();
    let stroke = |(axis, [a, b]): (usize, [usize; 2])| {
        // The faces at an edge go on along the other two axes.
        let others = [(axis + 1) % 3, (axis + 2) % 3];
        Stroke {
            ends: [corners[a], corners[b]],
            faces: others.map(|other| Some(corners[a ^ (1 << other)])),
            alphas: [1.0; 2],
        }
    };
    edges().map(stroke).collect()
}

/// Writes the lengths of the box beside one edge of each direction: that which is the furthest from
/// the box's middle in the image, for nothing else is there.
pub(super) fn mark_sizes(
    image: &mut impl Canvas,
    view: &SceneView,
    bounding_box: &BoundingBox,
    options: &RenderOptions,
) {
    let window = Window {
        clip_from_unit: view.clip_from_unit(),
        size_px: DVec2::new(options.width.into(), options.height.into()),
    };
    let corners = view.space.corners();
    let at = |unit: DVec3| window.point(unit).map(|point| point.at_px);
    let Some(middle) = at(DVec3::ZERO) else {
        return;
    };
    let height = TextHeight::at_most(options.width.min(options.height) / 24);
    for axis in 0..3 {
        let size = (corners[7] - corners[0])[axis] * view.space.world_per_unit();
        let places = edges()
            .filter(|(of, _)| *of == axis)
            .filter_map(|(_, [a, b])| {
                let (a, b) = (at(corners[a])?, at(corners[b])?);
                let center = (a + b) / 2.0;
                // The direction across the edge that leads away from the middle.
                let across = (b - a).try_normalize()?.perp();
                let across = if across.dot(center - middle) < 0.0 {
                    -across
                } else {
                    across
                };
                Some((across.dot(center - middle), center, across))
            });
        // The lowest of edges that are equally far, for there is more room.
        let order = |(far, center, _): &(f64, DVec2, DVec2)| far + center.y * 1e-3;
        let outermost = places.max_by(|a, b| order(a).total_cmp(&order(b)));
        let Some((_, center, across)) = outermost else {
            continue;
        };
        let text = label(size, bounding_box.unit.as_deref());
        let text_size = DVec2::new(text_width_px(&text, height).into(), height.px().into());
        // So far away that the text's box does not touch the edge.
        let away = (text_size / 2.0).dot(across.abs()) + 3.0;
        let corner = center + across * away - text_size / 2.0;
        let most = (window.size_px - text_size).max(DVec2::ZERO);
        let color = axis_of(view, DVec3::AXES[axis]).map_or([0x40; 3], |axis| AXIS_COLORS[axis]);
        let style = TextStyle {
            height,
            color,
            outline: Some([0xff; 3]),
        };
        write_text(
            image,
            rounded(corner.clamp(DVec2::ZERO, most)),
            &text,
            style,
        );
    }
}

/// A length with four digits and its unit.
pub(super) fn label(length: f64, unit: Option<&str>) -> String {
    let number = if length != 0.0 && !(1e-3..1e6).contains(&length) {
        format!("{length:.3e}")
    } else {
        let decimals = [1.0, 10.0, 100.0, 1000.0];
        let digits = decimals.iter().filter(|&&bound| length >= bound).count();
        let text = format!("{length:.0$}", 4_usize.saturating_sub(digits));
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        }
    };
    match unit {
        Some(unit) => format!("{number} {unit}"),
        None => number,
    }
}
