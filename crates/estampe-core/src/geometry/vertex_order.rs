//! The order of a triangle's vertices by (y, x), of sixteen triangles and of one: everything that
//! follows is then independent of the order in which they were given.

use crate::bounds::primitives::WindowVertex;
use estampe_simd::{Lanes, Select, SimdBase, i32x16, outline, u32x16};

/// Three vertices of sixteen triangles, to be sorted by (y, x).
pub(super) struct Order<S: Lanes> {
    pub(super) x: [i32x16<S>; 3],
    pub(super) y: [i32x16<S>; 3],
    pub(super) vertex: [u32x16<S>; 3],
}

impl<S: Lanes> Order<S> {
    /// Puts two vertices in order; true where they changed places. Equal ones keep theirs.
    #[inline(always)]
    pub(super) fn exchange<const A: usize, const B: usize>(
        &mut self,
        s: S,
    ) -> <i32x16<S> as SimdBase<S>>::Mask {
        outline!(s, {
            let (xa, xb) = (self.x[A], self.x[B]);
            let (ya, yb) = (self.y[A], self.y[B]);
            let (va, vb) = (self.vertex[A], self.vertex[B]);
            let swap = ya.simd_gt(yb) | (ya.simd_eq(yb) & xa.simd_gt(xb));
            self.x[A] = swap.select(xb, xa);
            self.x[B] = swap.select(xa, xb);
            self.y[A] = swap.select(yb, ya);
            self.y[B] = swap.select(ya, yb);
            self.vertex[A] = swap.select(vb, va);
            self.vertex[B] = swap.select(va, vb);
            swap
        })
    }
}

/// The order of three vertices by (y, x), and whether it is an odd permutation. Equal ones keep
/// theirs.
#[inline(always)]
pub(super) fn sorted(vertices: &[WindowVertex; 3]) -> ([usize; 3], bool) {
    let before = |a: usize, b: usize| {
        let (a, b) = (&vertices[a], &vertices[b]);
        (a.y, a.x) <= (b.y, b.x)
    };
    let (mut order, mut odd) = ([0, 1, 2], false);
    for (a, b) in [(0, 1), (1, 2), (0, 1)] {
        if !before(order[a], order[b]) {
            order.swap(a, b);
            odd = !odd;
        }
    }
    (order, odd)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_are_sorted_by_row_then_column() {
        let at = |x, y| WindowVertex {
            x,
            y,
            ..WindowVertex::default()
        };
        let cases = [
            ([at(0, 0), at(1, 0), at(0, 1)], [0, 1, 2], false),
            ([at(1, 0), at(0, 0), at(0, 1)], [1, 0, 2], true),
            ([at(5, 9), at(0, 1), at(9, 0)], [2, 1, 0], true),
            ([at(5, 9), at(9, 0), at(0, 1)], [1, 2, 0], false),
            ([at(3, 3), at(3, 3), at(0, 3)], [2, 0, 1], false),
        ];
        for (vertices, order, odd) in cases {
            assert_eq!(sorted(&vertices), (order, odd), "{vertices:?}");
        }
    }
}
