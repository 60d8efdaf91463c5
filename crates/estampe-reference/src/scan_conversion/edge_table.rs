//! Scan conversion by edge table: each edge is walked separately and records, in each row that it
//! meets, the least and the greatest x; then the rows are filled.
//!
//! It fills any convex polygon, because a row meets its border in two points.

use super::{fill, first_column, rows};
use crate::viewport::PixelBounds;
use std::collections::BTreeMap;

/// The least and the greatest x of each row.
type Table = BTreeMap<i64, [i64; 2]>;

fn note(table: &mut Table, row: i64, x: i64) {
    let [least, greatest] = table.entry(row).or_insert([x, x]);
    *least = (*least).min(x);
    *greatest = (*greatest).max(x);
}

/// The textbook form: whole coordinates, edges with both ends, x rounded to the nearest pixel.
#[must_use]
pub fn printed(corners: [[i32; 2]; 3]) -> Vec<[i32; 2]> {
    let [a, b, c] = corners.map(|corner| corner.map(i64::from));
    let mut table = Table::new();
    for [from, to] in [[a, b], [b, c], [c, a]] {
        note(&mut table, from[1], from[0]);
        note(&mut table, to[1], to[0]);
        let [upper, lower] = if from[1] <= to[1] {
            [from, to]
        } else {
            [to, from]
        };
        for y in upper[1]..=lower[1] {
            let height = (lower[1] - upper[1]).max(1);
            // ⌊x + ½⌋ of x = x₀ + (y − y₀)·Δx/Δy.
            let doubled = 2 * (y - upper[1]) * (lower[0] - upper[0]) + height;
            note(&mut table, y, upper[0] + doubled.div_euclid(2 * height));
        }
    }
    let narrow = |at: i64| i32::try_from(at).expect("between the corners");
    let row = |(y, [least, greatest]): (i64, [i64; 2])| {
        (least..=greatest).map(move |x| [narrow(x), narrow(y)])
    };
    table.into_iter().flat_map(row).collect()
}

/// The repaired form: centres at ½, the top-left rule; corners in 1/256 pixel.
#[must_use]
pub fn repaired(corners: [[i32; 2]; 3], bounds: &PixelBounds) -> Vec<[u32; 2]> {
    let [a, b, c] = corners.map(|corner| corner.map(i64::from));
    let mut table = Table::new();
    for [from, to] in [[a, b], [b, c], [c, a]] {
        // A horizontal edge has no rows.
        let [upper, lower] = if from[1] <= to[1] {
            [from, to]
        } else {
            [to, from]
        };
        for row in rows(upper[1], lower[1], bounds) {
            note(&mut table, row, first_column(upper, lower, row));
        }
    }
    let row = |(row, [left, right]): (i64, [i64; 2])| fill(left..right, row, bounds);
    table.into_iter().flat_map(row).collect()
}
