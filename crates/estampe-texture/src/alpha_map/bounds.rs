//! The greatest alpha that filtering reads in each of 32×32 cells of an image.

use estampe_simd::{LANES, Lanes, Level, SimdBase, dispatch, u32x16};
use estampe_types::shader::ALPHA_CELLS;

/// The cells of an image.
pub(super) const CELLS: usize = ALPHA_CELLS * ALPHA_CELLS;

/// The texels along an axis that linear filtering reads at the places of a cell.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Span {
    first: usize,
    end: usize,
    /// One more texel, across the border.
    more: Option<usize>,
}

/// The spans of the cells along an axis of so many texels.
pub(super) fn spans_of(count: usize, repeats: bool) -> [Span; ALPHA_CELLS] {
    let mut spans = [Span::default(); ALPHA_CELLS];
    for (cell, span) in spans.iter_mut().enumerate() {
        // Coordinates are cell·count/32 − ½, up to the next cell's: in 1/64 texels.
        let edge = |cell: usize| (cell * count * 2) as i64 - ALPHA_CELLS as i64;
        let unit = 2 * ALPHA_CELLS as i64;
        let first = edge(cell).div_euclid(unit);
        let end = (edge(cell + 1) - 1).div_euclid(unit) + 2;
        let count = count as i64;
        let inside = |at: i64| usize::try_from(at.clamp(0, count)).unwrap_or(0);
        *span = Span {
            first: inside(first),
            end: inside(end),
            more: None,
        };
        if repeats && first < 0 {
            span.more = Some(inside(count - 1));
        } else if repeats && end > count {
            span.more = Some(0);
        }
    }
    spans
}

/// A layer of a mip level.
pub(super) struct Layer<'a> {
    /// Words of four bytes, of which the last is alpha.
    pub(super) texels: &'a [u32],
    pub(super) width: usize,
    /// The texels of the cells along both axes.
    pub(super) spans: &'a [[Span; ALPHA_CELLS]; 2],
}

impl Layer<'_> {
    /// The greatest alpha of each cell, row by row.
    pub(super) fn greatest(&self, level: Level) -> [u8; CELLS] {
        let mut cells = [0; CELLS];
        let mut of_columns = vec![0; self.width];
        let mut before = None;
        let (of_rows, _) = cells.as_chunks_mut::<ALPHA_CELLS>();
        for (span, cells) in self.spans[1].iter().zip(of_rows) {
            // Cells are smaller than texels in small images.
            if let Some((same, known)) = before
                && same == span
            {
                *cells = known;
                continue;
            }
            of_columns.fill(0);
            for row in (span.first..span.end).chain(span.more) {
                let texels = &self.texels[row * self.width..][..self.width];
                dispatch!(level, s => raise(s, &mut of_columns, texels));
            }
            for (cell, span) in cells.iter_mut().zip(&self.spans[0]) {
                let texels = of_columns[span.first..span.end].iter();
                let beyond = span.more.map(|at| &of_columns[at]);
                let greatest = texels
                    .chain(beyond)
                    .fold(0, |most: u32, texel| most.max(*texel));
                *cell = (greatest >> 24) as u8;
            }
            before = Some((span, *cells));
        }
        cells
    }
}

/// Raises each word to the texel of its column, if that is greater.
#[inline(always)]
fn raise<S: Lanes>(s: S, greatest: &mut [u32], texels: &[u32]) {
    let (sixteens, rest) = greatest.as_chunks_mut::<LANES>();
    let (texels, last) = texels.as_chunks::<LANES>();
    for (greatest, texels) in sixteens.iter_mut().zip(texels) {
        let both = [&*greatest, texels];
        let raised = u32x16::load_array_ref(s, both[0]).max(u32x16::load_array_ref(s, both[1]));
        raised.store_array(greatest);
    }
    for (greatest, texel) in rest.iter_mut().zip(last) {
        *greatest = (*greatest).max(*texel);
    }
}
