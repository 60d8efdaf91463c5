//! The classic scan conversions of a triangle, each in two forms.
//!
//! In · Out: three corners · pixels, row by row. *Printed* is what courses print: corners at pixels, whose centres have
//! whole coordinates; all edges are drawn, so neighbours share their border. *Repaired* takes corners in 1/256 pixel,
//! puts centres at ½ and keeps the top-left rule, exactly: it covers the very pixels that [`raster`](crate::raster)
//! covers with one sample. Spec: docs/PIPELINE.md row R2.
//!
//! | file | idea | repaired by |
//! |---|---|---|
//! | [`line_sweep`] | sort by y; walk down the long side and the two short ones | rows by their centres, half-open; the sides' places as fractions |
//! | [`edge_table`] | each edge notes in each row the least and greatest x | the first column at or behind the edge, half-open |
//! | [`bounding_box`] | test all pixels of the box by barycentric weights | weights as integers; zero only on top and left edges |
//! | [`scanline`] | the edges' equations, stepped from pixel to pixel | integers, and one less for edges that own no points |
//!
//! The repairs are the same each time: a triangle owns the points on its top and left edges and no others. A row
//! whose centre is y therefore belongs to the edges with y_top ≤ y < y_bottom, and in it the centres x with
//! x_left ≤ x < x_right.

pub mod bounding_box;
pub mod edge_table;
pub mod line_sweep;
pub mod scanline;

use crate::arithmetic::floor_div;
use crate::viewport::PixelBounds;
use std::ops::Range;

/// A pixel's centre in 1/256 pixel from its corner.
const CENTER: i64 = 128;

/// A pixel's width in 1/256 pixel.
const PIXEL: i64 = 256;

/// A corner in 1/256 pixel, widened.
type Corner = [i64; 2];

/// The first pixel whose centre is at or after a place along an axis.
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
/// The edge is at `x = ax + (y − ay)·(bx − ax)/(by − ay)`; the column is ⌈(x − ½ pixel) / pixel⌉, as a fraction
/// of integers. The edge is not horizontal.
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
