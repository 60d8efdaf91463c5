//! The classic scan conversions of a triangle, each in two forms.
//!
//! In · Out: three corners · pixels, row by row. *Printed* is the textbook form: corners at pixels,
//! whose centres have whole coordinates; all edges are drawn, so neighbours share their border.
//! *Repaired* takes corners in 1/256 pixel, puts centres at ½ and keeps the top-left rule, exactly:
//! it covers the same pixels as [`raster`](crate::raster) with one sample. Spec: docs/PIPELINE.md
//! row R2.
//!
//! | file | idea | repaired by |
//! |---|---|---|
//! | [`line_sweep`] | sort by y; walk down the long side and the two short ones | rows by their centres, half-open; x of the sides as fractions |
//! | [`edge_table`] | each edge records the least and greatest x of each row | the first column at or right of the edge, half-open |
//! | [`bounding_box`] | test all pixels of the box by barycentric weights | weights as integers; zero only on top and left edges |
//! | [`scanline`] | the edges' equations, stepped from pixel to pixel | integers, minus 1 for edges that are neither top nor left |
//!
//! The repair is the same in all four: points on top and left edges belong to the triangle, points
//! on other edges do not. So a row whose centre is y meets the edges with y_top ≤ y < y_bottom, and
//! its pixels are those with centres x_left ≤ x < x_right.

pub mod bounding_box;
pub mod edge_table;
pub mod line_sweep;
pub mod scanline;

use crate::arithmetic::floor_div;
use crate::viewport::PixelBounds;
use std::ops::Range;

/// The distance from a pixel's corner to its centre, in 1/256 pixel.
const CENTER: i64 = 128;

/// The width of a pixel in 1/256 pixel.
const PIXEL: i64 = 256;

/// A corner in 1/256 pixel, in 64 bits so that products fit.
type Corner = [i64; 2];

/// The first pixel whose centre is at or after a coordinate.
fn pixel_at_or_after(place: i64) -> i64 {
    (place - CENTER).div_euclid(PIXEL) + i64::from((place - CENTER).rem_euclid(PIXEL) != 0)
}

/// The rows whose centres lie in a half-open range of y, within bounds.
fn rows(top: i64, bottom: i64, bounds: &PixelBounds) -> Range<i64> {
    let (first, end) = (pixel_at_or_after(top), pixel_at_or_after(bottom));
    first.max(i64::from(bounds.y.start))..end.min(i64::from(bounds.y.end))
}

/// The first column whose centre is at or right of an edge, in the row whose centre is y.
///
/// The edge has `x = ax + (y − ay)·(bx − ax)/(by − ay)`; the column is ⌈(x − ½ pixel) / pixel⌉, as
/// a fraction of integers. The edge must not be horizontal.
fn first_column(a: Corner, b: Corner, row: i64) -> i64 {
    let [a, b] = [a, b].map(|corner| corner.map(i128::from));
    let y = i128::from(row * PIXEL + CENTER);
    let height = b[1] - a[1];
    let numerator = (a[0] - i128::from(CENTER)) * height + (y - a[1]) * (b[0] - a[0]);
    let denominator = i128::from(PIXEL) * height;
    // ⌈n/d⌉ = −⌊−n/d⌋.
    i64::try_from(-floor_div(-numerator, denominator)).expect("a place between the edge's ends")
}

/// The columns of a half-open range, within bounds, as pixels of a row.
fn fill(
    columns: Range<i64>,
    row: i64,
    bounds: &PixelBounds,
) -> impl Iterator<Item = [u32; 2]> + use<> {
    let first = columns.start.max(i64::from(bounds.x.start));
    let end = columns.end.min(i64::from(bounds.x.end));
    let narrow = |at: i64| u32::try_from(at).expect("bounds begin at 0 or later");
    (first..end).map(move |column| [narrow(column), narrow(row)])
}
