//! Varyings of a 2×2 quad: four lanes of a packet that is shared by quads of several triangles.
//!
//! Small triangles cover parts of packets. Their quads, whatever triangle and place they come from, fill
//! packets together, so that the shader's lanes are busy; a quad is what derivatives need. Four quads of one
//! triangle are interpolated at once.

use super::interpolate::TriangleSurface;
use crate::tiles::Plane;
use estampe_simd::{Lanes, Packet, Select, SimdBase, f32x4, f32x16};

/// Lanes of a quad.
pub(crate) const QUAD: usize = 4;

impl TriangleSurface<'_> {
    /// The distances of four quads' pixels' centres from the planes' origin, given their first pixels.
    #[inline(always)]
    pub(crate) fn distances_of_quads<S: Lanes>(
        &self,
        s: S,
        [a, b, c, d]: [[i32; 2]; 4],
    ) -> [f32x16<S>; 2] {
        let [ax, ay] = self.quad_distances(s, a);
        let [bx, by] = self.quad_distances(s, b);
        let [cx, cy] = self.quad_distances(s, c);
        let [dx, dy] = self.quad_distances(s, d);
        [
            s.combine_f32x8(s.combine_f32x4(ax, bx), s.combine_f32x4(cx, dx)),
            s.combine_f32x8(s.combine_f32x4(ay, by), s.combine_f32x4(cy, dy)),
        ]
    }

    /// Distances of a quad's pixels' centres from the origin.
    #[inline(always)]
    fn quad_distances<S: Lanes>(&self, s: S, [x, y]: [i32; 2]) -> [f32x4<S>; 2] {
        let splat = |value: f32| <f32x4<S> as SimdBase<S>>::splat(s, value);
        let columns = f32x4::load_array(s, [0.0, 1.0, 0.0, 1.0]);
        let rows = f32x4::load_array(s, [0.0, 0.0, 1.0, 1.0]);
        [
            columns + splat(x as f32 + 0.5 - self.origin.x),
            rows + splat(y as f32 + 0.5 - self.origin.y),
        ]
    }

    /// Window position (x, y, z, 1/w) at a quad's pixels, z confined to a range.
    #[inline(always)]
    pub(crate) fn quad_position<S: Lanes>(
        &self,
        s: S,
        [x, y]: [i32; 2],
        place: usize,
        [low, high]: [f32; 2],
        out: &mut [Packet<f32>; 4],
    ) {
        let splat = |value: f32| <f32x4<S> as SimdBase<S>>::splat(s, value);
        let [dx, dy] = self.quad_distances(s, [x, y]);
        let value =
            |plane: &Plane| splat(plane.origin) + (dx * splat(plane.dx) + dy * splat(plane.dy));
        let at = place % QUAD * QUAD;
        let (x, y) = (x as f32 + 0.5, y as f32 + 0.5);
        let z = value(&self.z);
        let z = z.simd_gt(splat(low)).select(z, splat(low));
        let z = z.simd_lt(splat(high)).select(z, splat(high));
        let iw = if self.equal_w {
            splat(self.iw.origin)
        } else {
            value(&self.iw)
        };
        out[0].0[at..at + QUAD].copy_from_slice(&[x, x + 1.0, x, x + 1.0]);
        out[1].0[at..at + QUAD].copy_from_slice(&[y, y, y + 1.0, y + 1.0]);
        z.store_slice(&mut out[2].0[at..at + QUAD]);
        iw.store_slice(&mut out[3].0[at..at + QUAD]);
    }
}
