//! Triangles: planes of depth, 1/w and varyings, at packets of 4×4 pixels and at quads.

use super::planes::{PlaneOrigin, evaluate};
use super::varyings::VaryingPlanes;
use super::{Interpolant, PixelOffsets};
use crate::bounds::plane::Plane;
use crate::fragment::quad::QUAD;
use estampe_simd::{LANES, Lanes, Packet, Select, SimdBase, f32x4, f32x16, outline};
use estampe_types::Interpolation;

/// A triangle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TriangleInterpolant<'a> {
    pub(crate) origin: PlaneOrigin,
    pub(crate) z: Plane,
    pub(crate) iw: Plane,
    /// True if the three 1/w are equal in bits.
    pub(crate) equal_w: bool,
    pub(crate) planes: VaryingPlanes<'a>,
    pub(crate) modes: &'a [Interpolation],
    /// True if every varying is smooth; `modes` is then not read.
    pub(crate) all_smooth: bool,
}

impl<S: Lanes> Interpolant<S> for TriangleInterpolant<'_> {
    #[inline(always)]
    fn depth(&self, s: S, pixel: [i32; 2], sample: [f32; 2]) -> f32x16<S> {
        evaluate(s, &self.z, self.origin.distances(s, pixel, sample))
    }

    #[inline(always)]
    fn inverse_w(&self, s: S, pixel: [i32; 2]) -> f32x16<S> {
        if self.equal_w {
            return SimdBase::splat(s, self.iw.origin);
        }
        evaluate(s, &self.iw, self.origin.distances(s, pixel, [0.5; 2]))
    }

    #[inline(always)]
    fn varyings(&self, s: S, pixel: [i32; 2], out: &mut [Packet<f32>]) {
        self.varyings_at(s, self.origin.distances(s, pixel, [0.5; 2]), out);
    }

    #[inline(always)]
    fn inverse_w_at(&self, s: S, pixel: [i32; 2], places: &PixelOffsets) -> f32x16<S> {
        if self.equal_w {
            return SimdBase::splat(s, self.iw.origin);
        }
        evaluate(s, &self.iw, self.origin.distances_of(s, pixel, places))
    }

    #[inline(always)]
    fn varyings_in(&self, s: S, pixel: [i32; 2], places: &PixelOffsets, out: &mut [Packet<f32>]) {
        self.varyings_at(s, self.origin.distances_of(s, pixel, places), out);
    }
}

impl TriangleInterpolant<'_> {
    /// Returns true if every varying has the same bits at all pixels.
    #[inline(always)]
    pub(crate) fn is_constant(&self) -> bool {
        self.equal_w && self.planes.are_constant()
    }

    /// The varyings at sixteen pixels, given by their centres' distances from the planes' origin.
    #[inline(always)]
    pub(crate) fn varyings_at<S: Lanes>(
        &self,
        s: S,
        distances: [f32x16<S>; 2],
        out: &mut [Packet<f32>],
    ) {
        outline!(s, {
            let one = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
            let n = out.len().min(self.planes.len());
            let planes = self.planes;
            // Not from the plane, whose sum would turn −0 into 0.
            let is_flat = |k: usize| !self.all_smooth && self.modes[k] == Interpolation::Flat;
            if self.equal_w {
                for (k, packet) in out.iter_mut().enumerate().take(n) {
                    if is_flat(k) {
                        packet.0 = [planes.origin[k]; LANES];
                        continue;
                    }
                    evaluate(s, &planes.of(k), distances).store_array(&mut packet.0);
                }
                return;
            }
            let w = one / evaluate(s, &self.iw, distances);
            for (k, packet) in out.iter_mut().enumerate().take(n) {
                if is_flat(k) {
                    packet.0 = [planes.origin[k]; LANES];
                    continue;
                }
                let mut value = evaluate(s, &planes.of(k), distances);
                if self.all_smooth || self.modes[k] == Interpolation::Smooth {
                    value *= w;
                }
                value.store_array(&mut packet.0);
            }
        })
    }

    /// The distances of four quads' pixels' centres from the planes' origin, given their first
    /// pixels.
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
        let z = clamp_quad(s, z, [low, high]);
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

    /// Depth at an offset in a quad's pixels, clamped to a range.
    #[inline(always)]
    pub(crate) fn quad_depth<S: Lanes>(
        &self,
        s: S,
        [x, y]: [i32; 2],
        [sx, sy]: [f32; 2],
        range: [f32; 2],
        out: &mut [f32],
    ) {
        let splat = |value: f32| <f32x4<S> as SimdBase<S>>::splat(s, value);
        let columns = f32x4::load_array(s, [0.0, 1.0, 0.0, 1.0]);
        let rows = f32x4::load_array(s, [0.0, 0.0, 1.0, 1.0]);
        let dx = columns + splat(x as f32 + sx - self.origin.x);
        let dy = rows + splat(y as f32 + sy - self.origin.y);
        let z = splat(self.z.origin) + (dx * splat(self.z.dx) + dy * splat(self.z.dy));
        clamp_quad(s, z, range).store_slice(out);
    }
}

/// Four depths clamped to a range; NaN becomes its lower end.
#[inline(always)]
fn clamp_quad<S: Lanes>(s: S, z: f32x4<S>, [low, high]: [f32; 2]) -> f32x4<S> {
    let splat = |value: f32| <f32x4<S> as SimdBase<S>>::splat(s, value);
    let z = z.simd_gt(splat(low)).select(z, splat(low));
    z.simd_lt(splat(high)).select(z, splat(high))
}
