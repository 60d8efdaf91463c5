//! Grids of cells in window space.

use super::SIZE;
use crate::generate::{LittleEndian, hash32};

/// Square cells in window space, of two triangles each, with inner corners moved at random.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grid {
    pub(super) columns: u32,
    pub(super) rows: u32,
    pub(super) cell_px: [f64; 2],
    /// Left and top edge of the grid.
    pub(super) origin_px: [f64; 2],
}

impl Grid {
    /// The greatest number of cells per row: a square grid of these has a million triangles.
    const MAX_CELLS: f64 = 708.0;

    /// A grid of cells of this size that fills the frame, with a million triangles at most.
    pub(super) fn of(cell_px: f64) -> Self {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "1 to 708"
        )]
        let cells = |length_px: u32| (f64::from(length_px) / cell_px).min(Self::MAX_CELLS) as u32;
        Self {
            columns: cells(SIZE.width),
            rows: cells(SIZE.height),
            cell_px: [cell_px; 2],
            origin_px: [0.0; 2],
        }
    }

    /// One cell as large as the frame.
    pub(super) fn whole() -> Self {
        Self {
            columns: 1,
            rows: 1,
            cell_px: [f64::from(SIZE.width), f64::from(SIZE.height)],
            origin_px: [0.0; 2],
        }
    }

    pub(super) fn vertices(&self) -> Vec<u8> {
        let mut vertices = LittleEndian::default();
        for row in 0..=self.rows {
            for column in 0..=self.columns {
                let hash = hash32(row * 65_536 + column);
                let [red, green, blue, alpha] = hash.to_le_bytes();
                // Corners on the border are not moved, so that the grid fills its rectangle.
                let is_inner = |at: u32, count: u32| f64::from(u8::from(at > 0 && at < count));
                let moved = |bits: u8| (f64::from(bits) / 255.0 - 0.5) * 0.5;
                let x = f64::from(column) + moved(red) * is_inner(column, self.columns);
                let y = f64::from(row) + moved(green) * is_inner(row, self.rows);
                let x_px = x * self.cell_px[0] + self.origin_px[0];
                let y_px = y * self.cell_px[1] + self.origin_px[1];
                vertices.reals(&[
                    x_px / f64::from(SIZE.width) * 2.0 - 1.0,
                    1.0 - y_px / f64::from(SIZE.height) * 2.0,
                ]);
                vertices.raw(&[red, green, blue, alpha]);
            }
        }
        vertices.into_bytes()
    }

    /// Two counter-clockwise triangles per cell.
    pub(super) fn triangles(&self) -> Vec<u8> {
        let width = self.columns + 1;
        let mut indices = LittleEndian::default();
        for row in 0..self.rows {
            for upper_left in (0..self.columns).map(|column| row * width + column) {
                let lower_left = upper_left + width;
                indices.words(&[upper_left, lower_left, lower_left + 1]);
                indices.words(&[upper_left, lower_left + 1, upper_left + 1]);
            }
        }
        indices.into_bytes()
    }

    /// Each vertex once.
    pub(super) fn points(&self) -> Vec<u8> {
        let mut indices = LittleEndian::default();
        for index in 0..(self.columns + 1) * (self.rows + 1) {
            indices.words(&[index]);
        }
        indices.into_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_of_whole_pixels_fills_the_frame() {
        let grid = Grid::of(16.0);
        assert_eq!((grid.columns, grid.rows), (80, 45));
        let vertices = grid.vertices();
        let float = |at: usize| f32::from_le_bytes(vertices[at..at + 4].try_into().unwrap());
        let last = vertices.len() - 12;
        assert_eq!([float(0), float(4)], [-1.0, 1.0]);
        assert_eq!([float(last), float(last + 4)], [1.0, -1.0]);
    }
}
