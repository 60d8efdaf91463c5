//! The varyings of vertices, and the planes of a triangle's varyings.

use super::planes::pixels;
use crate::bounds::plane::Plane;
use crate::bounds::primitives::{Triangle, VertexRef};
use crate::bounds::transpose::components_of_f32;
use estampe_simd::{Bytes, LANES, Lanes, SimdBase, bits_of, f32x4, f32x16, u32x16};
use estampe_types::Interpolation;

/// The varyings of a draw's vertices.
#[derive(Debug, Clone, Copy)]
pub(crate) struct VaryingSource<'a> {
    /// Of the item's vertices.
    pub(crate) shaded: &'a [f32],
    /// Of the chunk's own, made by clipping.
    pub(crate) clipped: &'a [f32],
    /// The interpolation of each scalar.
    pub(crate) modes: &'a [Interpolation],
    /// The scalars whose derivatives fragments read.
    pub(crate) gradients: &'a [usize],
}

impl<'a> VaryingSource<'a> {
    #[inline(always)]
    pub(crate) fn of(&self, vertex: VertexRef) -> &'a [f32] {
        let n = self.modes.len();
        let (from, number) = if vertex.0 & VertexRef::CLIPPED == 0 {
            (self.shaded, vertex.0)
        } else {
            (self.clipped, vertex.0 & !VertexRef::CLIPPED)
        };
        &from[number as usize * n..][..n]
    }

    /// Four scalars of sixteen vertices, from scalar `at` on; of vertices with fewer than four, all
    /// of them and whatever follows. There must be two at least.
    #[inline(always)]
    pub(crate) fn four_of<S: Lanes>(&self, s: S, vertices: u32x16<S>, at: usize) -> [f32x16<S>; 4] {
        if let Some(found) = self.four_of_shaded(s, vertices, at) {
            return found;
        }
        let rows = self.rows_of(&vertices.to_array(), at);
        components_of_f32(s, &rows.each_ref())
    }

    /// Four scalars of each vertex by itself. A function of its own: inlined, its addresses are
    /// computed in any case.
    #[inline(never)]
    fn rows_of(&self, vertices: &[u32; LANES], at: usize) -> [[f32; 4]; LANES] {
        let n = self.modes.len();
        // Only the last vertex of a list may have fewer than four scalars from there on.
        let (mut end, mut clipped_end) = ([0.0; 4], [0.0; 4]);
        for (end, list) in [(&mut end, self.shaded), (&mut clipped_end, self.clipped)] {
            if let Some(last) = list.last_chunk::<2>()
                && n == 2
            {
                end[..2].copy_from_slice(last);
            } else if let Some(last) = list.last_chunk::<3>() {
                end[..3].copy_from_slice(last);
            }
        }
        let mut rows = [end; LANES];
        for (row, vertex) in rows.iter_mut().zip(vertices) {
            let (from, end) = if vertex & VertexRef::CLIPPED == 0 {
                (self.shaded, end)
            } else {
                (self.clipped, clipped_end)
            };
            let first = (vertex & !VertexRef::CLIPPED) as usize * n + at;
            let found = from.get(first..).and_then(<[f32]>::first_chunk);
            *row = *found.unwrap_or(&end);
        }
        rows
    }

    /// [`VaryingSource::four_of`], if clipping made none of the vertices and each has four scalars,
    /// or others follow: one check for all of them.
    #[inline(always)]
    fn four_of_shaded<S: Lanes>(
        &self,
        s: S,
        vertices: u32x16<S>,
        at: usize,
    ) -> Option<[f32x16<S>; 4]> {
        let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
        // Numbers of vertices that are in a shorter list are below 2³² after the product.
        let len = u32::try_from(self.shaded.len()).ok()?;
        let last = splat(len.checked_sub(4)?);
        let (n, at) = (
            u32::try_from(self.modes.len()).ok()?,
            u32::try_from(at).ok()?,
        );
        let first = vertices * splat(n) + splat(at);
        let is_found = first.simd_le(last) & vertices.simd_lt(splat(VertexRef::CLIPPED));
        if s.bits_of_mask(is_found) != u16::MAX {
            return None;
        }
        let [a, b, c, d] = s.gather_four(bits_of(self.shaded), first);
        Some([a.bitcast(), b.bitcast(), c.bitcast(), d.bitcast()])
    }
}

/// Planes of a triangle's varyings: scalar `k` is `origin[k]`, `dx[k]`, `dy[k]`.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct VaryingPlanes<'a> {
    pub(super) origin: &'a [f32],
    dx: &'a [f32],
    dy: &'a [f32],
}

impl<'a> VaryingPlanes<'a> {
    /// Numbers that the planes of `scalars` varyings take.
    #[inline(always)]
    pub(crate) fn size(scalars: usize) -> usize {
        scalars * 3
    }

    /// Interprets the numbers that [`set_planes`] wrote.
    #[inline(always)]
    pub(crate) fn new(numbers: &'a [f32]) -> Self {
        let n = numbers.len() / 3;
        let (origin, rest) = numbers.split_at(n);
        let (dx, rest) = rest.split_at(n);
        Self {
            origin,
            dx,
            dy: &rest[..n],
        }
    }

    /// The number of planes.
    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.origin.len()
    }

    /// Returns true if no plane rises or falls, and none is at −0, to which adding 0 gives 0.
    #[inline(always)]
    pub(super) fn are_constant(&self) -> bool {
        let slopes = self.dx.iter().chain(self.dy);
        let are_level = slopes.fold(true, |all, slope| all & (*slope == 0.0));
        let negative_zero = (-0.0_f32).to_bits();
        let origins = self.origin.iter();
        are_level && origins.fold(true, |all, at| all & (at.to_bits() != negative_zero))
    }

    /// The planes' values at their origin.
    #[inline(always)]
    pub(crate) fn origins(&self) -> &'a [f32] {
        self.origin
    }

    /// The plane of scalar `k`.
    #[inline(always)]
    pub(crate) fn of(&self, k: usize) -> Plane {
        Plane {
            origin: self.origin[k],
            dx: self.dx[k],
            dy: self.dy[k],
        }
    }
}

/// Writes the planes of a triangle's varyings to [`VaryingPlanes::size`] numbers.
#[inline(always)]
pub(crate) fn set_planes<S: Lanes>(
    s: S,
    out: &mut [f32],
    triangle: &Triangle,
    source: &VaryingSource<'_>,
    all_smooth: bool,
) {
    let vertex = |corner: usize| source.of(triangle.vertex[corner]);
    let (a0, a1, a2) = (vertex(0), vertex(1), vertex(2));
    let n = source.modes.len();
    let (origin, rest) = out.split_at_mut(n);
    let (dx, dy) = rest.split_at_mut(n);
    let dy = &mut dy[..n];
    let iw = triangle.iw_at;
    let perspective = !triangle.equal_w;
    let difference = |of: &[i32; 3], corner: usize| pixels(of[corner] - of[0]);
    let (dx1, dy1) = (difference(&triangle.x, 1), difference(&triangle.y, 1));
    let (dx2, dy2) = (difference(&triangle.x, 2), difference(&triangle.y, 2));
    let r = triangle.r;
    // Four scalars at a time where all are treated alike.
    let fours = if all_smooth { n - n % 4 } else { 0 };
    let splat = |value: f32| <f32x4<S> as SimdBase<S>>::splat(s, value);
    for k in (0..fours).step_by(4) {
        let four = k..k + 4;
        let mut p = [
            f32x4::from_slice(s, &a0[four.clone()]),
            f32x4::from_slice(s, &a1[four.clone()]),
            f32x4::from_slice(s, &a2[four.clone()]),
        ];
        if perspective {
            p = [
                p[0] * splat(iw[0]),
                p[1] * splat(iw[1]),
                p[2] * splat(iw[2]),
            ];
        }
        let (e1, e2) = (p[1] - p[0], p[2] - p[0]);
        p[0].store_slice(&mut origin[four.clone()]);
        ((e1 * splat(dy2) - e2 * splat(dy1)) * splat(r)).store_slice(&mut dx[four.clone()]);
        ((e2 * splat(dx1) - e1 * splat(dx2)) * splat(r)).store_slice(&mut dy[four]);
    }
    for k in fours..n {
        // The factor of modes without perspective is 1, and a product with 1 changes nothing.
        let by_w = perspective && source.modes[k] == Interpolation::Smooth;
        let w = if by_w { iw } else { [1.0; 3] };
        let (p0, p1, p2) = (a0[k] * w[0], a1[k] * w[1], a2[k] * w[2]);
        let (e1, e2) = (p1 - p0, p2 - p0);
        origin[k] = p0;
        dx[k] = (e1 * dy2 - e2 * dy1) * r;
        dy[k] = (e2 * dx1 - e1 * dx2) * r;
    }
    if all_smooth {
        return;
    }
    if source.modes.contains(&Interpolation::Flat) {
        let provoking = source.of(triangle.provoking);
        for (k, &value) in provoking.iter().enumerate().take(n) {
            if source.modes[k] == Interpolation::Flat {
                (origin[k], dx[k], dy[k]) = (value, 0.0, 0.0);
            }
        }
    }
}
