//! The cells of a sheet: how many in a row, and where each is.

use crate::values::MAX_SIDE;

/// Sizes of a sheet in pixels.
///
/// ```text
///   gap │ picture │ gap │ picture │ gap        cell = picture above its label
///       │ label   │     │ label   │
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Layout {
    pub(super) columns: u32,
    pub(super) rows: u32,
    /// Of a picture.
    pub(super) picture: [u32; 2],
    /// Of the strip for the label below a picture; 0 without labels.
    pub(super) label_height: u32,
    pub(super) gap: u32,
}

impl Layout {
    /// The layout of this number of cells. Without a number of columns, the greater side of the
    /// sheet is as small as possible.
    ///
    /// # Errors
    /// The least sides that are necessary, if one exceeds [`MAX_SIDE`].
    pub(super) fn new(
        cells: usize,
        columns: Option<u32>,
        (picture, label_height, gap): ([u32; 2], u32, u32),
    ) -> Result<Self, [u64; 2]> {
        let cells = u32::try_from(cells).unwrap_or(u32::MAX).max(1);
        let of = |columns: u32| Self {
            columns,
            rows: cells.div_ceil(columns),
            picture,
            label_height,
            gap,
        };
        let layout = match columns {
            Some(columns) => of(columns.min(cells)),
            None => {
                // More columns than pixels do not fit anyway.
                let choices = (1..=cells.min(MAX_SIDE)).map(of);
                let cost = |layout: &Self| {
                    let [width, height] = layout.sides();
                    let empty = u64::from(layout.columns) * u64::from(layout.rows);
                    (width.max(height), empty, width.abs_diff(height))
                };
                choices.min_by_key(cost).unwrap_or(of(1))
            }
        };
        let sides = layout.sides();
        if sides.iter().all(|&side| side <= u64::from(MAX_SIDE)) {
            Ok(layout)
        } else {
            Err(sides)
        }
    }

    fn sides(&self) -> [u64; 2] {
        let side = |count: u32, cell: u64| {
            let gap = u64::from(self.gap);
            (cell + gap).saturating_mul(u64::from(count)) + gap
        };
        let [width, height] = self.picture.map(u64::from);
        [
            side(self.columns, width),
            side(self.rows, height + u64::from(self.label_height)),
        ]
    }

    /// Width and height of the sheet.
    pub(super) fn size(&self) -> [u32; 2] {
        self.sides()
            .map(|side| u32::try_from(side).unwrap_or(MAX_SIDE))
    }

    /// The upper left corner of a cell.
    pub(super) fn corner(&self, cell: usize) -> [u32; 2] {
        let cell = u32::try_from(cell).unwrap_or(u32::MAX);
        let [width, height] = self.picture;
        let (column, row) = (cell % self.columns, cell / self.columns);
        [
            self.gap + column * (width + self.gap),
            self.gap + row * (height + self.label_height + self.gap),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::Layout;

    #[test]
    fn sheets_are_nearly_square() {
        let columns = |cells, picture| {
            let layout = Layout::new(cells, None, (picture, 0, 0)).expect("small");
            (layout.columns, layout.rows)
        };
        for (cells, picture, expected) in [
            (1, [256, 192], (1, 1)),
            (2, [256, 192], (1, 2)),
            (3, [256, 192], (2, 2)),
            (4, [100, 100], (2, 2)),
            (6, [100, 100], (2, 3)),
            (9, [256, 192], (3, 3)),
            (12, [100, 100], (3, 4)),
            (12, [100, 50], (2, 6)),
            (3, [300, 10], (1, 3)),
        ] {
            assert_eq!(columns(cells, picture), expected, "{cells} of {picture:?}");
        }
    }

    #[test]
    fn cells_are_beside_each_other_with_gaps() {
        let layout = Layout::new(5, Some(3), ([100, 50], 20, 8)).expect("small");
        assert_eq!((layout.rows, layout.size()), (2, [332, 164]));
        assert_eq!(layout.corner(0), [8, 8]);
        assert_eq!(layout.corner(4), [116, 86]);
        let few = Layout::new(2, Some(9), ([10, 10], 0, 0)).expect("small");
        assert_eq!(few.size(), [20, 10]);
    }

    #[test]
    fn sheets_that_are_too_large_say_their_size() {
        let sizes = ([16_384, 16_384], 0, 0);
        assert!(Layout::new(1, None, sizes).is_ok());
        assert_eq!(Layout::new(2, Some(2), sizes), Err([32_768, 16_384]));
        assert!(Layout::new(usize::MAX, None, sizes).is_err());
        assert!(Layout::new(usize::MAX, None, ([1, 1], 0, 0)).is_err());
    }
}
