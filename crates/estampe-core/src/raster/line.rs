//! Pipeline lines (R3): Vulkan's Bresenham rule, one pixel wide or more, and rectangles.
//!
//! ```text
//!     x-major:  in every column whose centre lies between the ends (the start's included, the
//!     end's not), the pixel whose row holds the line's y at that centre; y-major lines likewise
//! ```
//!
//! *Precision* exact 64-bit integers · *Spec* Vulkan §Bresenham Line Segment Rasterization,
//! §Rectangular.

use super::triangle::TilePolygon;
use super::{CoverageList, MAX_PACKETS, TileShape};
use crate::bounds::lines::LinePrimitive;
use crate::bounds::pixel_rect::PixelRect;
use crate::geometry::line_style::{LineAxis, LineRectangle, LineShape, LineStyle, along, length};
use estampe_simd::{LANE_X, LANE_Y, LANES, Lanes};

/// Lists the packets that a line covers which is a rectangle of a width in pixels and [nothing
/// else](LineStyle::plain_rectangle); packets at the border of `rect`, which is in the tile's own
/// pixels, are not clipped.
#[inline(always)]
pub(crate) fn cover_rectangle<S: Lanes, const N: usize>(
    s: S,
    (line, width): (&LinePrimitive, f32),
    tile: TileShape,
    rect: &PixelRect,
    out: &mut CoverageList<N>,
) {
    if let Some(rectangle) = LineRectangle::new(line, width)
        && let Some(polygon) =
            TilePolygon::<N, 4>::of_corners(rectangle.corners, tile, rect, out.samples())
    {
        polygon.cover(s, tile, 0, 0, out);
    }
}

/// Lists the packets that any other line covers; `rect` is in the tile's own pixels.
pub(crate) fn cover<const N: usize>(
    line: &LinePrimitive,
    style: &LineStyle,
    tile: TileShape,
    rect: &PixelRect,
    out: &mut CoverageList<N>,
) {
    match style.shape {
        LineShape::Columns { width: 1 } if style.stipple.is_none() => {
            cover_thin(line, tile, rect, out)
        }
        LineShape::Columns { width } => cover_columns(line, style, width, (tile, rect), out),
        LineShape::Rectangle { width, .. } => {
            if let Some(rectangle) = LineRectangle::new(line, width) {
                cover_rectangle_by_sample(line, style, &rectangle, (tile, rect), out);
            }
        }
    }
}

/// The units of the major axis inside a rectangle of a tile, and the rows that may be covered
/// there.
fn ranges(axis: &LineAxis, tile: TileShape, rect: &PixelRect) -> [std::ops::Range<i64>; 2] {
    let origin = [i64::from(tile.x), i64::from(tile.y)];
    let (low, high) = ([rect.x0, rect.y0], [rect.x1, rect.y1]);
    let [major, minor] = if axis.x_major { [0, 1] } else { [1, 0] };
    let [first, last] = axis.span();
    let first = first.max(origin[major] + i64::from(low[major]));
    let last = last.min(origin[major] + i64::from(high[major]) - 1);
    let rows = origin[minor] + i64::from(low[minor])..origin[minor] + i64::from(high[minor]);
    [first..last + 1, rows]
}

/// The packet of a tile's pixel at (major, minor) in the target, and the pixel's bit in it.
fn lane_at(axis: &LineAxis, tile: TileShape, unit: i64, row: i64) -> (u32, u16) {
    let (x, y) = if axis.x_major {
        (unit, row)
    } else {
        (row, unit)
    };
    lane_of(x - i64::from(tile.x), y - i64::from(tile.y))
}

/// A line of one pixel's width, all samples of a pixel alike.
fn cover_thin<const N: usize>(
    line: &LinePrimitive,
    tile: TileShape,
    rect: &PixelRect,
    out: &mut CoverageList<N>,
) {
    let axis = LineAxis::new(line);
    if axis.delta[0] == 0 {
        return;
    }
    let [units, rows] = ranges(&axis, tile, rect);
    // A monotone line leaves a packet for good, so only the newest one can get another pixel.
    let mut current: Option<(u32, u16)> = None;
    for unit in units {
        let row = axis.minor_at(unit);
        if !rows.contains(&row) {
            continue;
        }
        let (packet, bit) = lane_at(&axis, tile, unit, row);
        match &mut current {
            Some((at, mask)) if *at == packet => *mask |= bit,
            _ => {
                if let Some((at, mask)) = current {
                    out.push(at, [mask; N]);
                }
                current = Some((packet, bit));
            }
        }
    }
    if let Some((at, mask)) = current {
        out.push(at, [mask; N]);
    }
}

/// Columns of several pixels, or those of a pattern.
fn cover_columns<const N: usize>(
    line: &LinePrimitive,
    style: &LineStyle,
    width: i32,
    (tile, rect): (TileShape, &PixelRect),
    out: &mut CoverageList<N>,
) {
    let axis = LineAxis::new(line).moved(i64::from(width - 1) * -128);
    if axis.delta[0] == 0 {
        return;
    }
    let mut masks = [0u16; MAX_PACKETS];
    let [units, rows] = ranges(&axis, tile, rect);
    let [first, last] = axis.span();
    for unit in units {
        let number = if axis.delta[0] > 0 {
            unit - first
        } else {
            last - unit
        };
        let number = u64::try_from(number).unwrap_or(0);
        if !style.shows(u64::from(line.stipple) + number) {
            continue;
        }
        let row = axis.minor_at(unit);
        for row in row.max(rows.start)..(row + i64::from(width)).min(rows.end) {
            let (packet, bit) = lane_at(&axis, tile, unit, row);
            masks[packet as usize % MAX_PACKETS] |= bit;
        }
    }
    for (packet, mask) in (0..).zip(masks) {
        if mask != 0 {
            out.push(packet, [mask; N]);
        }
    }
}

/// A rectangle with a pattern, or a smooth one: its samples, or with a smooth line all samples of
/// every pixel that it touches.
fn cover_rectangle_by_sample<const N: usize>(
    line: &LinePrimitive,
    style: &LineStyle,
    rectangle: &LineRectangle,
    (tile, rect): (TileShape, &PixelRect),
    out: &mut CoverageList<N>,
) {
    let samples = out.samples().subpixels();
    let [x0, y0, x1, y1] = rectangle.bounds.map(|at| at >> 8);
    let columns = (x0 - tile.x).max(rect.x0)..(x1 + 1 - tile.x).min(rect.x1);
    let rows = (y0 - tile.y).max(rect.y0)..(y1 + 1 - tile.y).min(rect.y1);
    let length = length(line);
    // The packets that the box touches; the rectangle of a short line touches one or two.
    let first = [columns.start & !3, rows.start & !3];
    let places = (first[1]..rows.end).step_by(4).flat_map(|py| {
        let columns = (first[0]..columns.end).step_by(4);
        columns.map(move |px| [px, py])
    });
    for [px, py] in places {
        if misses(rectangle, [tile.x + px, tile.y + py]) {
            continue;
        }
        let (packet, _) = lane_of(i64::from(px), i64::from(py));
        let mut masks = [0u16; N];
        for lane in 0..LANES {
            let (x, y) = (px + i32::from(LANE_X[lane]), py + i32::from(LANE_Y[lane]));
            if !columns.contains(&x) || !rows.contains(&y) {
                continue;
            }
            let pixel = [tile.x + x, tile.y + y];
            let at = |[sx, sy]: [i32; 2]| [pixel[0] * 256 + sx, pixel[1] * 256 + sy];
            if style.stipple.is_some() {
                let distance = along(line, at([128; 2])) as f32 / length;
                if !style.shows_at(line, distance) {
                    continue;
                }
            }
            let is_touched = style.is_smooth() && rectangle.sixteenths(pixel) > 0;
            for (mask, sample) in masks.iter_mut().zip(samples) {
                let is_covered = if style.is_smooth() {
                    is_touched
                } else {
                    rectangle.contains(at(sample))
                };
                *mask |= u16::from(is_covered) << lane;
            }
        }
        if masks != [0; N] {
            out.push(packet, masks);
        }
    }
}

/// Returns true if no point of the packet of 4×4 pixels that begins at a pixel is inside the
/// rectangle.
fn misses(rectangle: &LineRectangle, pixel: [i32; 2]) -> bool {
    let [x, y] = pixel.map(|at| i64::from(at) * 256);
    rectangle.edges.iter().any(|[a, b, c]| {
        let best_x = if *a > 0 { x + 1024 } else { x };
        let best_y = if *b > 0 { y + 1024 } else { y };
        a * best_x + b * best_y + c < 0
    })
}

/// The packet of a tile's pixel and the pixel's bit in it.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "0..64"
)]
fn lane_of(x: i64, y: i64) -> (u32, u16) {
    let (x, y) = (x as u32, y as u32);
    let packet = crate::layout::morton(x / 4, y / 4);
    (packet, 1 << crate::layout::morton(x % 4, y % 4))
}
