//! Points (R4): squares, or the discs inside them.

use super::{CoverageList, TileShape, rect_mask};
use crate::bounds::pixel_rect::PixelRect;
use crate::bounds::primitives::PointPrimitive;
use estampe_simd::{LANE_X, LANE_Y, LANES};

/// Lists the packets of which a point covers samples; `rect` is in the tile's own pixels.
pub(crate) fn cover<const N: usize>(
    point: &PointPrimitive,
    is_round: bool,
    tile: TileShape,
    rect: &PixelRect,
    out: &mut CoverageList<N>,
) {
    let (x, y, half) = (point.center.x, point.center.y, point.half);
    // For each sample the pixels with low ≤ 256·i + offset < high.
    let first = |low: i32, offset: i32| (low - offset + 255) >> 8;
    let positions = out.samples().subpixels();
    let by_sample = positions.map(|[sx, sy]| PixelRect {
        x0: (first(x - half, sx) - tile.x).max(rect.x0),
        y0: (first(y - half, sy) - tile.y).max(rect.y0),
        x1: (first(x + half, sx) - tile.x).min(rect.x1),
        y1: (first(y + half, sy) - tile.y).min(rect.y1),
    });
    let all = by_sample.iter().fold(by_sample[0], |all, one| PixelRect {
        x0: all.x0.min(one.x0),
        y0: all.y0.min(one.y0),
        x1: all.x1.max(one.x1),
        y1: all.y1.max(one.y1),
    });
    if all.is_empty() {
        return;
    }
    for row in all.y0 >> 2..=(all.y1 - 1) >> 2 {
        for column in all.x0 >> 2..=(all.x1 - 1) >> 2 {
            let mut masks = by_sample.map(|rect| {
                if rect.is_empty() {
                    0
                } else {
                    rect_mask(&rect, column * 4, row * 4)
                }
            });
            if is_round {
                let pixel = [tile.x + column * 4, tile.y + row * 4];
                for (mask, sample) in masks.iter_mut().zip(positions) {
                    *mask &= disc_mask(point, pixel, sample);
                }
            }
            if masks != [0; N] {
                let packet = crate::layout::morton(column.cast_unsigned(), row.cast_unsigned());
                out.push(packet, masks);
            }
        }
    }
}

/// The lanes of a packet whose sample lies no farther from a point's centre than half its size.
fn disc_mask(point: &PointPrimitive, [x, y]: [i32; 2], [sx, sy]: [i32; 2]) -> u16 {
    let square = |a: i32| i64::from(a) * i64::from(a);
    let radius = square(point.half);
    (0..LANES).fold(0, |mask, lane| {
        let right = (x + i32::from(LANE_X[lane])) * 256 + sx - point.center.x;
        let below = (y + i32::from(LANE_Y[lane])) * 256 + sy - point.center.y;
        mask | u16::from(square(right) + square(below) <= radius) << lane
    })
}
