//! The depth stage: the stored depths as greys, and the blocks in which hierarchical z rejects
//! pieces.

use super::heat::{NOTHING, Rgb, code, mix, share};
use super::sheet::{Legend, Panel, Sheet};
use super::totals::Totals;
use estampe::PassStages;
use serde_json::json;

/// Pixels to which no depth was stored.
const CLEARED: Rgb = [206, 222, 240];

/// The sheet and the totals.
pub(super) fn sheet(stages: &PassStages) -> (Sheet, Totals) {
    let depth = |[x, y]: [u32; 2]| {
        let pixel = y as usize * stages.size[0] as usize + x as usize;
        let is_drawn = stages.pixels[pixel].passed > 0;
        let first = stages.depths.get(pixel * stages.samples as usize);
        first.copied().filter(|depth| is_drawn && depth.is_finite())
    };
    let [width, height] = stages.size;
    let pixels = || (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let depths = || pixels().filter_map(depth).map(f64::from);
    let least = depths().fold(f64::INFINITY, f64::min);
    let greatest = depths().fold(f64::NEG_INFINITY, f64::max);
    let extent = (greatest - least).max(1e-30);
    // Near is light.
    let grey = |pixel: [u32; 2]| {
        depth(pixel).map_or(CLEARED, |depth| {
            [code((greatest - f64::from(depth)) / extent * 225.0 + 15.0); 3]
        })
    };
    let columns = stages.block_columns_rows()[0];
    let block = |[x, y]: [u32; 2]| stages.blocks[(y / 16 * columns + x / 16) as usize];
    let rejected = |pixel: [u32; 2]| {
        let block = block(pixel);
        let color = match (block.tested, block.rejected) {
            (0, _) => NOTHING,
            (_, 0) => [255; 3],
            (tested, rejected) => share(f64::from(rejected) / f64::from(tested)),
        };
        let [x, y] = pixel;
        if x % 16 == 15 || y % 16 == 15 {
            mix(color, [120; 3], 0.25)
        } else {
            color
        }
    };

    let sum = |count: fn(&estampe::PixelCounts) -> u32| -> u64 {
        stages
            .pixels
            .iter()
            .map(|pixel| u64::from(count(pixel)))
            .sum()
    };
    let blocks = |count: fn(&estampe::BlockCounts) -> u32| -> u64 {
        stages
            .blocks
            .iter()
            .map(|block| u64::from(count(block)))
            .sum()
    };
    let range = (least <= greatest).then_some([least, greatest]);
    let totals = Totals::default()
        .count("passed", "samples passed", sum(|pixel| pixel.passed))
        .count("failed", "failed", sum(|pixel| pixel.failed_depth))
        .count(
            "blocks_tested",
            "blocks of triangles tested",
            blocks(|block| block.tested),
        )
        .count(
            "blocks_rejected",
            "rejected",
            blocks(|block| block.rejected),
        )
        .value("failed_stencil", sum(|pixel| pixel.failed_stencil).into())
        .value(
            "failed_depth_bounds",
            sum(|pixel| pixel.failed_depth_bounds).into(),
        )
        .value("range", json!(range));
    let [near, far] = range.unwrap_or([0.0, 1.0]);
    let sheet = Sheet {
        title: format!("depth: {}", totals.text()),
        columns: 2,
        panels: vec![
            Panel::of_pixels("stored depths".to_owned(), stages.size, grey),
            Panel::of_pixels(
                "share that hierarchical z rejects".to_owned(),
                stages.size,
                rejected,
            ),
        ],
        legend: Legend::Greys(
            format!("far {far:.4}"),
            format!("near {near:.4}"),
            vec![
                (CLEARED, "cleared"),
                ([255; 3], "0%"),
                (share(0.0), "few"),
                (share(0.5), "50%"),
                (share(1.0), "100% rejected"),
                (NOTHING, "no triangle"),
            ],
        ),
    };
    (sheet, totals)
}
