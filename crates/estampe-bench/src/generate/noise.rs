//! Tileable value noise in integers.

use super::hash32;

/// Three octaves of noise at a texel, 0..=255, their weights 4 : 2 : 1.
///
/// `size` is the texture's side: a power of two, at least 256.
pub(super) fn fractal_noise(x: u32, y: u32, size: u32, seed: u32) -> u32 {
    let octave = |cells: u32, number: u32| {
        let lattice = Lattice {
            cells,
            cell_size: size / cells,
            seed: seed + number,
        };
        lattice.value(x, y)
    };
    (octave(16, 0) * 4 + octave(64, 1) * 2 + octave(256, 2)) / 7
}

/// Random bytes at the corners of square cells, interpolated bilinearly.
struct Lattice {
    /// Cells along each side; the noise repeats after them.
    cells: u32,
    /// A cell's side in texels.
    cell_size: u32,
    seed: u32,
}

impl Lattice {
    fn value(&self, x: u32, y: u32) -> u32 {
        let (column, row) = (x / self.cell_size, y / self.cell_size);
        let (right, down) = (x % self.cell_size, y % self.cell_size);
        let along = |row: u32| {
            self.corner(column, row) * (self.cell_size - right)
                + self.corner(column + 1, row) * right
        };
        // The rounding of the division between the two directions is part of the definition.
        let (upper, lower) = (along(row) / self.cell_size, along(row + 1) / self.cell_size);
        (upper * (self.cell_size - down) + lower * down) / self.cell_size
    }

    fn corner(&self, column: u32, row: u32) -> u32 {
        let place = column % self.cells + row % self.cells * self.cells;
        // Knuth's multiplicative constant: 2³² ÷ golden ratio.
        hash32(self.seed ^ place.wrapping_mul(0x9E37_79B9)) & 255
    }
}
