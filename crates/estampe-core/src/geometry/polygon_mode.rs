//! Polygon mode (A5): triangles that are drawn as their edges or their corners.

use super::clip_detour::{ClipDetour, doubled_area};
use super::lines::{LineWalk, Outline};
use super::points::draw_point;
use super::run::RunWork;
use super::setup::Setup;
use super::vertex_order::sorted;
use crate::bounds::primitives::{VertexRef, WindowVertex};
use estampe_types::state::PolygonMode;

/// Draws the outlines of triangles.
pub(super) fn draw(
    work: &RunWork<'_>,
    triangles: &[[u32; 3]],
    lines: &mut LineWalk,
    setup: &mut Setup<'_>,
    clip: &mut ClipDetour,
) {
    let plan = work.plan;
    for &corners in triangles {
        let piece = first_piece(work, corners, setup, clip);
        let area = piece.map_or(0, |piece| doubled_area(&piece));
        if plan.facing.drops(area) {
            setup.chunk.statistics.primitives_culled += 1;
            continue;
        }
        let bias = plan.depth_bias.zip(piece).map(|(bias, piece)| {
            let (order, odd) = sorted(&piece);
            let area = if odd { -area } else { area };
            bias.of_triangle(order.map(|from| piece[from]), area)
        });
        let [a, b, c] = corners;
        let outline = Outline {
            provoking: VertexRef(a),
            front: plan.facing.is_front(area),
            bias,
        };
        if plan.polygon_mode == PolygonMode::Line {
            lines.restart();
            for edge in [[a, b], [b, c], [c, a]] {
                lines.draw_line(work, edge, outline, setup, clip);
            }
        } else {
            for corner in corners {
                draw_point(work, corner, outline, setup, clip);
            }
        }
    }
}

/// A triangle in the window; the first piece with an area if the triangle must be clipped.
fn first_piece(
    work: &RunWork<'_>,
    corners: [u32; 3],
    setup: &mut Setup<'_>,
    clip: &mut ClipDetour,
) -> Option<[WindowVertex; 3]> {
    let whole = corners.map(|corner| work.vertices.window_vertex(corner));
    if let [Some(a), Some(b), Some(c)] = whole {
        return Some([a, b, c]);
    }
    if clip.is_culled_by_distance(work, &corners) || !clip.clip(work, &corners, setup) {
        return None;
    }
    clip.fans().find(|fan| doubled_area(fan) != 0)
}
