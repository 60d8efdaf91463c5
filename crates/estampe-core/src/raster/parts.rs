//! Parts of triangles that take several lanes, and rectangles of two triangles, among
//! [small triangles](super::small).

use estampe_simd::{LANES, Lanes, SimdBase, i32x16};

/// What a lane shows of its triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Part {
    /// The part's first column and row in the triangle's box: 0 or [`SIDE`](super::small::SIDE).
    pub(crate) from: [i32; 2],
    /// True if the box is divided into columns and into rows of parts.
    pub(crate) is_divided: [bool; 2],
    /// True if all of the box is covered: two triangles make a rectangle.
    pub(crate) is_rectangle: bool,
}

/// Lanes that are a part of a larger triangle, whose box has up to twice
/// [`SIDE`](super::small::SIDE) columns or rows: a half or a quarter of it, of half as many. And
/// lanes that are rectangles.
#[derive(Debug, Default)]
#[repr(C, align(64))]
pub(crate) struct Parts {
    /// By lane: 0 or [`SIDE`](super::small::SIDE), the part's first column and row in the box.
    right: [i32; LANES],
    below: [i32; LANES],
    /// The lanes whose boxes are divided into columns, and into rows.
    pub(super) divided: [u16; 2],
    /// The lanes of which all of the box is covered.
    pub(super) rectangles: u16,
}

impl Parts {
    /// No lane is a part.
    pub(crate) const WHOLE: Self = Self {
        right: [0; LANES],
        below: [0; LANES],
        divided: [0; 2],
        rectangles: 0,
    };

    /// Sets a lane.
    #[inline(always)]
    pub(crate) fn set(&mut self, lane: usize, part: Part) {
        [self.right[lane], self.below[lane]] = part.from;
        let [columns, rows] = &mut self.divided;
        for (mask, is_in) in [
            (columns, part.is_divided[0]),
            (rows, part.is_divided[1]),
            (&mut self.rectangles, part.is_rectangle),
        ] {
            *mask = *mask & !(1 << lane) | u16::from(is_in) << lane;
        }
    }

    #[inline(always)]
    pub(super) fn offsets<S: Lanes>(&self, s: S) -> (i32x16<S>, i32x16<S>) {
        (
            i32x16::load_array_ref(s, &self.right),
            i32x16::load_array_ref(s, &self.below),
        )
    }
}
