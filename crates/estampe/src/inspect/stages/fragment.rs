//! The fragment and blend stages: counts of each pixel as heat.

use super::heat::heat;
use super::sheet::{Legend, Panel, Sheet};
use super::totals::Totals;
use estampe::{PassStages, PixelCounts};

/// Runs of the fragment shader: the sheet and the totals.
pub(super) fn runs(stages: &PassStages) -> (Sheet, Totals) {
    let count = |pixel: &PixelCounts| pixel.shaded;
    let Sums { sum, most, pixels } = Sums::of(stages, count);
    let discarded: u64 = stages
        .pixels
        .iter()
        .map(|pixel| u64::from(pixel.discarded))
        .sum();
    let totals = Totals::default()
        .count("runs", "runs of the shader", sum)
        .count("pixels", "pixels", pixels)
        .mean("mean", "runs a pixel", sum, pixels)
        .count("most", "at most", most)
        .count("discarded", "discarded", discarded);
    let sheet = Sheet {
        title: format!("fragment: {}", totals.text()),
        columns: 1,
        panels: vec![panel(
            stages,
            "runs of the fragment shader, piece after piece",
            count,
        )],
        legend: Legend::Counts(most, "runs at a pixel"),
    };
    (sheet, totals)
}

/// Colours that were stored or blended: the sheet and the totals.
pub(super) fn stored(stages: &PassStages) -> (Sheet, Totals) {
    let count = |pixel: &PixelCounts| pixel.stored;
    let Sums { sum, most, pixels } = Sums::of(stages, count);
    let covered: u64 = stages
        .pixels
        .iter()
        .map(|pixel| u64::from(pixel.covered))
        .sum();
    let totals = Totals::default()
        .count("stored", "colours stored or blended", sum)
        .count("pixels", "pixels", pixels)
        .mean("mean", "a pixel", sum, pixels)
        .count("most", "at most", most)
        .count(
            "not_stored",
            "covered but not stored",
            covered.saturating_sub(sum),
        );
    let sheet = Sheet {
        title: format!("blend: {}", totals.text()),
        columns: 1,
        panels: vec![panel(stages, "colours that are stored or blended", count)],
        legend: Legend::Counts(most, "colours stored at a pixel"),
    };
    (sheet, totals)
}

/// The sum of a count over all pixels, the greatest, and the number of pixels that have one.
struct Sums {
    sum: u64,
    most: u32,
    pixels: u64,
}

impl Sums {
    fn of(stages: &PassStages, count: impl Fn(&PixelCounts) -> u32) -> Self {
        let counts = || stages.pixels.iter().map(&count);
        Self {
            sum: counts().map(u64::from).sum(),
            most: counts().max().unwrap_or(0),
            pixels: counts().filter(|&count| count > 0).count() as u64,
        }
    }
}

fn panel(stages: &PassStages, caption: &str, count: impl Fn(&PixelCounts) -> u32) -> Panel {
    let most = stages.pixels.iter().map(&count).max().unwrap_or(0);
    Panel::of_pixels(caption.to_owned(), stages.size, |pixel| {
        heat(stages.pixel(pixel).map_or(0, &count), most)
    })
}
