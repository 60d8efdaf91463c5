//! Direct fill of polygons on pixels, row by row, without triangles.
//!
//! The edges that a row of pixel centres crosses are sorted along it; by the fill rule the pixels
//! between two crossings are inside or not (Wylie, Romney, Evans, Erdahl 1967; Foley et al.,
//! "Computer Graphics", §3.6). Corners lie on 1/256 pixel, and crossings are compared with centres
//! in integers, so the result is exact.
//!
//! ```text
//!   y ─·──·──·──·──·──·─   the centres of a row, at y + ½
//!        ╱      ╲           +1 for an edge that runs downwards, −1 upwards;
//!       ╱ filled ╲          a centre on a left or top edge is inside, on a right or
//!      ╱──────────╲         bottom edge outside
//! ```
//!
//! This is the pipeline's rule for triangles (row R1), so a polygon covers the pixels that its
//! triangles cover together, if all of their vertices lie on 1/256 pixel.

use std::ops::Range;

use glam::Vec2;

use super::fill::{PolygonError, check};
use super::measure::FillRule;

/// Sub-pixel steps per pixel.
const SUBPIXELS: i64 = 256;

/// The largest window coordinate: products of two differences of sub-pixels fit i64.
const MAX_WINDOW_COORDINATE: f32 = 4_194_304.0;

/// A row's run of pixels inside a polygon.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PixelSpan {
    /// The row, counted from the top.
    pub y: u32,
    /// The columns.
    pub x: Range<u32>,
}

/// An edge, from its upper to its lower end, in sub-pixels.
#[derive(Clone, Copy, Debug)]
struct Edge {
    top: [i64; 2],
    bottom: [i64; 2],
    /// 1 if the ring runs downwards here, else −1.
    winding: i32,
}

impl Edge {
    /// The first column whose centre is on the edge or right of it, in this row of centres.
    fn first_column(&self, center_y: i64) -> i64 {
        let [dx, dy] = [self.bottom[0] - self.top[0], self.bottom[1] - self.top[1]];
        // column · 256 + 128 ≥ x, where x = top + (center − top) dx / dy; dy is positive, and the
        // product of two differences of at most 2³¹ is at most 2⁶².
        let numerator = (center_y - self.top[1]) * dx;
        let crossing = self.top[0] + ceiling(numerator, dy);
        ceiling(crossing - SUBPIXELS / 2, SUBPIXELS)
    }
}

/// a / b rounded up, for positive b.
fn ceiling(a: i64, b: i64) -> i64 {
    a.div_euclid(b) + i64::from(a.rem_euclid(b) != 0)
}

/// Calls `emit` with each run of pixels inside a polygon of several rings, from top to bottom and
/// from left to right; runs of a row do not touch.
///
/// Corners are in window space: pixels, y down, pixel (i, j) has its centre at (i + ½, j + ½). They
/// are rounded to 1/256 pixel, half to even, as the pipeline does. Pixels outside of `size`, the
/// width and height, are left out.
///
/// # Errors
/// [`PolygonError::Coordinate`] for coordinates that are not finite or beyond ±2²², and
/// [`PolygonError::TooManyCorners`].
pub fn fill_spans(
    rings: &[&[Vec2]],
    rule: FillRule,
    size: [u32; 2],
    mut emit: impl FnMut(PixelSpan),
) -> Result<(), PolygonError> {
    check(rings, MAX_WINDOW_COORDINATE)?;
    let [width, height] = size;
    let mut edges: Vec<Edge> = rings.iter().flat_map(|ring| edges_of(ring)).collect();
    edges.sort_by_key(|edge| edge.top[1]);

    let mut waiting = edges.into_iter().peekable();
    let mut active: Vec<Edge> = Vec::new();
    let mut crossings: Vec<(i64, i32)> = Vec::new();
    for y in 0..height {
        let center_y = i64::from(y) * SUBPIXELS + SUBPIXELS / 2;
        // An edge holds the centres from its upper end to just above the lower.
        while let Some(edge) = waiting.next_if(|edge| edge.top[1] <= center_y) {
            active.push(edge);
        }
        active.retain(|edge| edge.bottom[1] > center_y);

        crossings.clear();
        let columns = active
            .iter()
            .map(|edge| (edge.first_column(center_y), edge.winding));
        crossings.extend(columns);
        crossings.sort_unstable();
        let mut winding = 0;
        let mut start: Option<i64> = None;
        for (i, &(column, change)) in crossings.iter().enumerate() {
            winding += change;
            if crossings.get(i + 1).is_some_and(|next| next.0 == column) {
                continue;
            }
            let is_inside = match rule {
                FillRule::EvenOdd => winding % 2 != 0,
                FillRule::NonZero => winding != 0,
            };
            match start {
                None if is_inside => start = Some(column),
                Some(first) if !is_inside => {
                    start = None;
                    let [first, end] = [first, column]
                        .map(|at| u32::try_from(at.clamp(0, i64::from(width))).unwrap_or(width));
                    if first < end {
                        emit(PixelSpan { y, x: first..end });
                    }
                }
                _ => {}
            }
        }
    }
    Ok(())
}

/// The edges of a ring that are not horizontal; horizontal ones cross no row.
fn edges_of(ring: &[Vec2]) -> impl Iterator<Item = Edge> {
    let nexts = ring.iter().skip(1).chain(ring.first());
    ring.iter().zip(nexts).filter_map(|(from, to)| {
        let (from, to) = (subpixels(*from), subpixels(*to));
        if from[1] < to[1] {
            Some(Edge {
                top: from,
                bottom: to,
                winding: 1,
            })
        } else if from[1] > to[1] {
            Some(Edge {
                top: to,
                bottom: from,
                winding: -1,
            })
        } else {
            None
        }
    })
}

/// The corner in sub-pixels, rounded half to even.
#[expect(
    clippy::cast_possible_truncation,
    reason = "coordinates are at most 2²², checked before"
)]
fn subpixels(corner: Vec2) -> [i64; 2] {
    [corner.x, corner.y].map(|x| libm::rint(f64::from(x) * SUBPIXELS as f64) as i64)
}
