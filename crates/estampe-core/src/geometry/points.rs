//! Points: from assembled vertices to point primitives.

use super::binning::push_point;
use super::clip::is_point_visible;
use super::clip_detour::ClipDetour;
use super::lines::Outline;
use super::run::RunWork;
use super::setup::Setup;
use crate::bounds::primitives::PointPrimitive;

/// Draws points.
pub(super) fn draw(
    work: &RunWork<'_>,
    points: &[[u32; 3]],
    setup: &mut Setup<'_>,
    clip: &mut ClipDetour,
) {
    for &[vertex, ..] in points {
        if !clip.is_culled_by_distance(work, &[vertex]) {
            draw_point(work, vertex, Outline::own(vertex), setup, clip);
        }
    }
}

/// Draws one point, unless its centre is outside the view volume.
pub(super) fn draw_point(
    work: &RunWork<'_>,
    vertex: u32,
    outline: Outline,
    setup: &mut Setup<'_>,
    clip: &mut ClipDetour,
) {
    let vertices = &work.vertices;
    let is_visible = |position| is_point_visible(&work.plan.transform, position);
    if !vertices.clip_position(vertex).is_some_and(is_visible) {
        setup.chunk.statistics.primitives_clipped += 1;
        return;
    }
    let center = vertices.window_vertex(vertex);
    let Some(center) = center.or_else(|| clip.corner_point(work, vertex)) else {
        return;
    };
    let point = PointPrimitive {
        center: outline.biased(center),
        provoking: outline.provoking,
        half: half_size(vertices.point_size(vertex)),
        front: outline.front,
    };
    push_point(work.plan, point, setup.chunk);
}

/// Half a point's side in 1/256 pixel, half to even; sizes are 1 to 1024 pixels, NaN is 1.
#[expect(clippy::cast_possible_truncation, reason = "at most 131072")]
fn half_size(pixels: f32) -> i32 {
    let pixels = if pixels >= 1.0 {
        pixels.min(1024.0)
    } else {
        1.0
    };
    (pixels * 128.0).round_ties_even() as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_clamped_and_rounded_half_to_even() {
        let cases = [
            (1.0, 128),
            (0.0, 128),
            (f32::NAN, 128),
            (2.5, 320),
            (1.0 + 1.0 / 256.0, 128),
            (1.0 + 3.0 / 256.0, 130),
            (5000.0, 131_072),
        ];
        for (pixels, half) in cases {
            assert_eq!(half_size(pixels), half, "{pixels}");
        }
    }
}
