//! The sheet: all pictures on one page, each with its number.

use crate::Picture;

/// Width and height of a picture's cell, in pixels.
const CELL: u32 = 200;

/// The digits 0 to 9: five rows of three pixels, the top row in the highest bits.
const DIGITS: [u16; 10] = [
    0b111_101_101_101_111,
    0b010_110_010_010_111,
    0b111_001_111_100_111,
    0b111_001_111_001_111,
    0b101_101_111_001_001,
    0b111_100_111_001_111,
    0b111_100_111_101_111,
    0b111_001_001_001_001,
    0b111_101_111_101_111,
    0b111_101_111_001_111,
];

/// Pictures with their numbers, each reduced until it fits its cell.
#[derive(Debug, Clone, Default)]
pub struct Sheet {
    cells: Vec<Picture>,
}

impl Sheet {
    /// Adds the picture of the rung with this number, below 100.
    pub fn add(&mut self, number: u32, picture: &Picture) {
        let small = picture.fitted(CELL);
        let mut cell = Picture::filled(CELL, CELL, [48, 48, 48]);
        let middle = [small.width(), small.height()].map(|side| ((CELL - side) / 2).cast_signed());
        cell.paste(&small, middle);
        for (place, digit) in (0..).zip([number / 10, number % 10]) {
            cell.paste(&digit_picture(digit), [place * 10, 0]);
        }
        self.cells.push(cell);
    }

    /// The sheet: rows of six pictures.
    #[must_use]
    pub fn picture(&self) -> Picture {
        Picture::in_columns(6, &self.cells)
    }
}

/// A digit of 3×5 squares with a border, black on white.
fn digit_picture(digit: u32) -> Picture {
    let rows = DIGITS[digit as usize % 10];
    let mut picture = Picture::filled(5, 7, Picture::WHITE);
    for bit in 0..15 {
        if rows >> (14 - bit) & 1 == 1 {
            picture.set([bit % 3 + 1, bit / 3 + 1], Picture::BLACK);
        }
    }
    picture.magnified(2)
}
