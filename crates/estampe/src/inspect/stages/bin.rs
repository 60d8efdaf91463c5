//! The bin stage: the tiles, coloured by the number of their pieces.

use super::heat::{NOTHING, heat, ink_on};
use super::sheet::{Legend, Panel, Sheet, zoom};
use super::totals::Totals;
use crate::failure::Failure;
use estampe::{Device, PassStages};
use estampe_visibility::plot::{Anchor, Text};

/// The sheet and the totals.
pub(super) fn sheet(stages: &PassStages, device: &Device) -> Result<(Sheet, Totals), Failure> {
    let [columns, rows] = stages.tile_columns_rows();
    let most = stages.tiles.iter().copied().max().unwrap_or(0);
    let zoom = zoom(stages.size);
    let side = stages.tile_side * zoom;
    let size = stages.size.map(|side| side * zoom);
    let caption = format!(
        "{} x {} tiles of {} pixels",
        columns, rows, stages.tile_side
    );
    let mut panel = Panel::blank(caption, size, NOTHING);
    let mut texts = Vec::new();
    let tiles = (0..rows).flat_map(|row| (0..columns).map(move |column| [column, row]));
    for ([column, row], &count) in tiles.zip(&stages.tiles) {
        let color = heat(count, most);
        let corner = [column * side, row * side];
        panel.fill(corner, [side; 2], [255; 3]);
        panel.fill(corner, [side - 1; 2], color);
        let shown = [0, 1].map(|axis| side.min(size[axis] - corner[axis]));
        let text = Text {
            at: [
                corner[0] as f32 + shown[0] as f32 * 0.5,
                corner[1] as f32 + shown[1] as f32 * 0.5 + 3.5,
            ],
            anchor: Anchor::Middle,
            height: if side < 48 { 6.0 } else { 8.0 },
            color: ink_on(color),
            text: count.to_string(),
        };
        if text.width() + 2.0 < shown[0] as f32 && shown[1] > 10 {
            texts.push(text);
        }
    }
    panel.write(device, texts)?;

    let drawn = stages.pieces.iter().filter(|piece| !piece.is_culled);
    let entries: u64 = stages.tiles.iter().map(|&count| u64::from(count)).sum();
    let empty = stages.tiles.iter().filter(|&&count| count == 0).count();
    let totals = Totals::default()
        .count("tiles", "tiles", stages.tiles.len() as u64)
        .count("empty", "empty", empty as u64)
        .count("pieces", "pieces", drawn.count() as u64)
        .count("entries", "entries", entries)
        .count("most", "in the fullest tile", most)
        .value("tile_side", stages.tile_side.into());
    let sheet = Sheet {
        title: format!("bin: {}", totals.text()),
        columns: 1,
        panels: vec![panel],
        legend: Legend::Counts(most, "pieces in a tile"),
    };
    Ok((sheet, totals))
}
