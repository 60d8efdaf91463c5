//! The raster stage: the barycentric coordinates of the visible pieces as colours.

use super::heat::{NOTHING, Rgb, code, mix};
use super::sheet::{Legend, Panel, Sheet};
use super::totals::Totals;
use estampe::PassStages;

/// Pixels that a line or point shows.
const OTHER: Rgb = [90, 96, 106];

/// The mean number of pixels of a visible piece from which on edges are drawn.
const EDGED: usize = 16;

/// The sheet and the totals.
pub(super) fn sheet(stages: &PassStages) -> (Sheet, Totals) {
    let counts = || stages.pixels.iter();
    let visible = |pixel: [u32; 2]| stages.pixel(pixel).and_then(|counts| counts.visible);
    let mut shown: Vec<u32> = counts().filter_map(|pixel| pixel.visible).collect();
    let pixels = shown.len();
    shown.sort_unstable();
    shown.dedup();
    // Edges around small pieces would hide them.
    let has_edges = pixels > EDGED * shown.len();
    let color = |pixel: [u32; 2]| {
        let [x, y] = pixel;
        let piece = visible(pixel);
        let color = match (piece, stages.barycentrics(pixel)) {
            (None, _) => NOTHING,
            (Some(_), None) => OTHER,
            // In proportion to the greatest, so that the middle is white.
            (Some(_), Some(shares)) => {
                let greatest = shares.into_iter().fold(0.0, f64::max);
                let color = shares.map(|share| code(share.max(0.0) / greatest * 255.0));
                mix(color, [255; 3], 0.15)
            }
        };
        let differs = |beside: [u32; 2]| visible(beside) != piece;
        let is_edge =
            has_edges && ((x > 0 && differs([x - 1, y])) || (y > 0 && differs([x, y - 1])));
        if is_edge {
            mix(color, [0; 3], 0.55)
        } else {
            color
        }
    };
    let covered: u64 = counts().map(|pixel| u64::from(pixel.covered)).sum();
    let drawn = stages.pieces.iter().filter(|piece| !piece.is_culled);
    let totals = Totals::default()
        .count("pieces", "pieces", drawn.count() as u64)
        .count("covered", "covered pixels of pieces", covered)
        .count("visible_pieces", "pieces visible", shown.len() as u64)
        .count("visible_pixels", "pixels show one", pixels as u64);
    let sheet = Sheet {
        title: format!("raster: {}", totals.text()),
        columns: 1,
        panels: vec![Panel::of_pixels(
            "barycentric coordinates of the visible piece".to_owned(),
            stages.size,
            color,
        )],
        legend: Legend::Names(vec![
            ([255, 38, 38], "first vertex"),
            ([38, 255, 38], "second"),
            ([38, 38, 255], "third"),
            ([40, 40, 40], "edge"),
            (NOTHING, "nothing"),
        ]),
    };
    (sheet, totals)
}
