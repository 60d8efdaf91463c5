//! Varyings of fragments of sixteen triangles, sixteen fragments at a time.
//!
//! Planes are made for the sixteen triangles together; the lanes of a
//! [row](super::cross_fragments) take theirs by permutations, so interpolation costs little more
//! than it does for one triangle.

use super::cross_fragments::{Row, bits_of_row};
use super::interpolate::{VaryingSource, smooth_derivatives};
use super::vertex_rows::{fetch_flat, fetch_rows};
use crate::bounds::lane_order::{AnyOrder, LaneOrder};
use crate::bounds::primitives::TrianglePacket;
use crate::bounds::triangle_edges::TriangleEdges;
use estampe_simd::{Bytes, LANES, Lanes, Packet, Select, SimdBase, f32x16, u32x16};
use estampe_types::Interpolation;

/// Planes of all varyings of sixteen triangles: by scalar, then by lane.
#[derive(Debug, Default)]
pub(crate) struct CrossPlanes {
    /// Values at the three vertices; their first is the planes' origin once [`CrossPlanes::set`] is
    /// done.
    pub(super) corners: [Vec<Packet<f32>>; 3],
    pub(super) dx: Vec<Packet<f32>>,
    pub(super) dy: Vec<Packet<f32>>,
    /// 1/w: origin, dx, dy; where a triangle's three are equal, 1.
    pub(super) iw: [Packet<f32>; 3],
    /// True if those of all triangles are equal.
    equal_w: bool,
    /// The triangles whose three are equal.
    equal_ws: u16,
}

impl CrossPlanes {
    /// Sets the planes of the packet's triangles in `lanes`, as `set_planes` does for one.
    #[inline(always)]
    pub(crate) fn set<S: Lanes>(
        &mut self,
        s: S,
        packet: &TrianglePacket,
        lanes: u16,
        source: &VaryingSource<'_>,
    ) {
        let n = source.modes.len();
        for rows in self.corners.iter_mut().chain([&mut self.dx, &mut self.dy]) {
            rows.resize(n, Packet::default());
        }
        self.fetch(s, packet, lanes, source);
        let edges = TriangleEdges::of_packet(s, packet, lanes);
        let equal_w = s.mask_from_bits(packet.equal_w);
        let one = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
        let mut iw = [one; 3];
        for (iw, values) in iw.iter_mut().zip(&packet.iw_at) {
            // A product with 1 changes nothing.
            *iw = equal_w.select(one, f32x16::load_array_ref(s, values));
        }
        self.equal_w = packet.equal_w & lanes == lanes;
        self.equal_ws = packet.equal_w & lanes;
        let zero = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
        let [dx, dy] = edges.slopes(s, iw);
        let planes = [iw[0], equal_w.select(zero, dx), equal_w.select(zero, dy)];
        for (out, values) in self.iw.iter_mut().zip(planes) {
            values.store_array(&mut out.0);
        }
        let [first, second, third] = &mut self.corners;
        let rows = first.iter_mut().zip(second).zip(third);
        let rows = rows.zip(self.dx.iter_mut().zip(&mut self.dy));
        for (mode, (((p0, p1), p2), (dx, dy))) in source.modes.iter().zip(rows) {
            if *mode == Interpolation::Flat {
                continue;
            }
            let mut p = [
                f32x16::load_array_ref(s, &p0.0),
                f32x16::load_array_ref(s, &p1.0),
                f32x16::load_array_ref(s, &p2.0),
            ];
            if *mode == Interpolation::Smooth {
                p = [p[0] * iw[0], p[1] * iw[1], p[2] * iw[2]];
                p[0].store_array(&mut p0.0);
            }
            let [slope_x, slope_y] = edges.slopes(s, p);
            slope_x.store_array(&mut dx.0);
            slope_y.store_array(&mut dy.0);
        }
    }

    /// The planes of a lane's triangle, as `set_planes` writes them.
    #[inline(always)]
    pub(crate) fn copy_lane(&self, lane: usize, modes: &[Interpolation], out: &mut [f32]) {
        let lane = lane % LANES;
        let (origin, rest) = out.split_at_mut(modes.len());
        let (dx, dy) = rest.split_at_mut(modes.len());
        let from = self.corners[0].iter().zip(self.dx.iter().zip(&self.dy));
        let to = origin.iter_mut().zip(dx.iter_mut().zip(dy));
        for ((mode, from), to) in modes.iter().zip(from).zip(to) {
            let ((origin, (dx, dy)), (to, (to_dx, to_dy))) = (from, to);
            *to = origin.0[lane];
            // Slopes of flat ones are not set.
            let slopes = match mode {
                Interpolation::Flat => [0.0; 2],
                _ => [dx.0[lane], dy.0[lane]],
            };
            [*to_dx, *to_dy] = slopes;
        }
    }

    /// The triangles in `lanes` whose varyings have the same bits at all pixels.
    #[inline(always)]
    pub(crate) fn constant<S: Lanes>(&self, s: S, lanes: u16, modes: &[Interpolation]) -> u16 {
        let zero = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
        let negative_zero = <u32x16<S> as SimdBase<S>>::splat(s, 1 << 31);
        let mut constant = s.mask_from_bits(self.equal_ws & lanes);
        let planes = self.corners[0].iter().zip(self.dx.iter().zip(&self.dy));
        for (mode, (origin, (dx, dy))) in modes.iter().zip(planes) {
            // A sum with 0 would turn −0 into 0.
            let origin: u32x16<S> = f32x16::load_array_ref(s, &origin.0).bitcast();
            constant &= !origin.simd_eq(negative_zero);
            if *mode != Interpolation::Flat {
                constant &= f32x16::load_array_ref(s, &dx.0).simd_eq(zero);
                constant &= f32x16::load_array_ref(s, &dy.0).simd_eq(zero);
            }
        }
        s.bits_of_mask(constant)
    }

    /// Transposes the varyings of the lanes' vertices into rows; flat ones are the provoking
    /// vertex's.
    #[inline(always)]
    fn fetch<S: Lanes>(
        &mut self,
        s: S,
        packet: &TrianglePacket,
        lanes: u16,
        source: &VaryingSource<'_>,
    ) {
        for (rows, vertices) in self.corners.iter_mut().zip(&packet.vertex) {
            fetch_rows(s, rows, vertices, lanes, source);
        }
        if source.modes.contains(&Interpolation::Flat) {
            fetch_flat(&mut self.corners[0], &packet.provoking.0, lanes, source);
        }
    }

    /// 1/w of a row's fragments, as [`CrossPlanes::varyings`].
    #[inline(always)]
    pub(crate) fn inverse_w<S: Lanes>(
        &self,
        s: S,
        row: Row<S>,
        packet: &TrianglePacket,
        distances: [f32x16<S>; 2],
    ) -> f32x16<S> {
        let lane = row.pixels.lane();
        let [origin, dx, dy] = &self.iw;
        let of_plane = evaluate(s, [origin, dx, dy], lane, distances);
        let first = s.permute_f32(f32x16::load_array_ref(s, &packet.iw_at[0]), lane);
        let is_equal = s.mask_from_bits(bits_of_row(s, self.equal_ws, row));
        is_equal.select(first, of_plane)
    }

    /// The varyings of a row's fragments, given by the distances of their pixels' centres from the
    /// planes' origins.
    #[inline(always)]
    pub(crate) fn varyings<S: Lanes>(
        &self,
        s: S,
        row: Row<S>,
        source: &VaryingSource<'_>,
        distances: [f32x16<S>; 2],
        out: &mut [Packet<f32>],
    ) {
        match row.order(s) {
            AnyOrder::Window(window) => {
                self.varyings_by(s, (row, window), source, distances, out);
            }
            AnyOrder::Lanes(lane) => self.varyings_by(s, (row, lane), source, distances, out),
        }
    }

    #[inline(always)]
    fn varyings_by<S: Lanes>(
        &self,
        s: S,
        (row, order): (Row<S>, impl LaneOrder<S>),
        source: &VaryingSource<'_>,
        distances: [f32x16<S>; 2],
        out: &mut [Packet<f32>],
    ) {
        let kept = s.mask_from_bits(row.lanes);
        let one = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
        let (out, derivatives) = out.split_at_mut(source.modes.len());
        let [origin, dx, dy] = &self.iw;
        let w = if self.equal_w {
            one
        } else {
            one / evaluate(s, [origin, dx, dy], order, distances)
        };
        let planes = self.corners[0].iter().zip(self.dx.iter().zip(&self.dy));
        for ((mode, out), (origin, (dx, dy))) in source.modes.iter().zip(&mut *out).zip(planes) {
            let mut value = if *mode == Interpolation::Flat {
                order.permuted(s, &origin.0)
            } else {
                evaluate(s, [origin, dx, dy], order, distances)
            };
            if *mode == Interpolation::Smooth {
                value *= w;
            }
            if row.is_open {
                value = kept.select(value, f32x16::load_array_ref(s, &out.0));
            }
            value.store_array(&mut out.0);
        }
        if !source.gradients.is_empty() {
            self.derivatives(s, (row, order), (source, w), out, derivatives);
        }
    }

    /// The derivatives of some of a row's varyings, along x, then along y.
    #[inline(always)]
    fn derivatives<S: Lanes>(
        &self,
        s: S,
        (row, order): (Row<S>, impl LaneOrder<S>),
        (source, w): (&VaryingSource<'_>, f32x16<S>),
        varyings: &[Packet<f32>],
        out: &mut [Packet<f32>],
    ) {
        let kept = s.mask_from_bits(row.lanes);
        let of_iw = [
            order.permuted(s, &self.iw[1].0),
            order.permuted(s, &self.iw[2].0),
        ];
        let is_level = s.mask_from_bits(bits_of_row(s, self.equal_ws, row));
        let zero = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
        let (along_x, along_y) = out.split_at_mut(source.gradients.len());
        for ((along_x, along_y), &k) in along_x.iter_mut().zip(along_y).zip(source.gradients) {
            let value = f32x16::load_array_ref(s, &varyings[k].0);
            let slopes = [
                order.permuted(s, &self.dx[k].0),
                order.permuted(s, &self.dy[k].0),
            ];
            let smooth = smooth_derivatives(slopes, value, of_iw, w);
            // As of one triangle, see `TriangleInterpolant`.
            let linear = [slopes[0] + 0.0, slopes[1] + 0.0];
            let [mut x, mut y] = match source.modes[k] {
                Interpolation::Flat => [zero; 2],
                Interpolation::NoPerspective => linear,
                Interpolation::Smooth if self.equal_w => linear,
                Interpolation::Smooth => [
                    is_level.select(linear[0], smooth[0]),
                    is_level.select(linear[1], smooth[1]),
                ],
            };
            if row.is_open {
                x = kept.select(x, f32x16::load_array_ref(s, &along_x.0));
                y = kept.select(y, f32x16::load_array_ref(s, &along_y.0));
            }
            x.store_array(&mut along_x.0);
            y.store_array(&mut along_y.0);
        }
    }
}

/// The planes of the lanes' triangles at the lanes' pixels.
#[inline(always)]
pub(super) fn evaluate<S: Lanes>(
    s: S,
    [origin, dx, dy]: [&Packet<f32>; 3],
    order: impl LaneOrder<S>,
    [x, y]: [f32x16<S>; 2],
) -> f32x16<S> {
    let (dx, dy) = (order.permuted(s, &dx.0), order.permuted(s, &dy.0));
    order.permuted(s, &origin.0) + (x * dx + y * dy)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::primitives::VertexRef;
    use crate::fragment::interpolate::{VaryingPlanes, set_planes};
    use estampe_simd::{Level, dispatch};

    /// Lanes that are not wanted may be triangles of another draw, which has more vertices.
    #[test]
    fn vertices_of_other_draws_are_not_read() {
        let mut packet = TrianglePacket::EMPTY;
        for (vertices, corner) in packet.vertex.iter_mut().zip(0..) {
            *vertices = [VertexRef(1000); LANES];
            vertices[1] = VertexRef(corner);
            vertices[4] = VertexRef(2 - corner);
        }
        for scalars in [1_usize, 2, 3, 4, 7] {
            let shaded: Vec<f32> = (0..3 * scalars).map(|number| number as f32).collect();
            let source = VaryingSource {
                shaded: &shaded,
                clipped: &[],
                modes: &vec![Interpolation::NoPerspective; scalars],
                gradients: &[],
            };
            for level in Level::all_available() {
                let mut planes = CrossPlanes::default();
                dispatch!(@wide level, s => planes.set(s, &packet, 0b1_0010, &source),
                    scalar => continue);
                for (rows, corner) in planes.corners.iter().zip(0..) {
                    for (row, scalar) in rows.iter().zip(0..) {
                        let values = [row.0[1], row.0[4]];
                        let expected =
                            [corner, 2 - corner].map(|vertex| shaded[vertex * scalars + scalar]);
                        assert_eq!(values, expected, "{level:?}, {scalars} scalars");
                    }
                }
            }
        }
    }

    #[test]
    fn planes_of_a_lane_are_those_of_its_triangle() {
        use Interpolation::{Flat, NoPerspective, Smooth};
        let modes = [Smooth, Flat, NoPerspective, Smooth, Smooth, Flat];
        let shaded: Vec<f32> = (0..48 * modes.len())
            .map(|number| (number * 37 % 101) as f32 / 9.0 - 5.0)
            .collect();
        let source = VaryingSource {
            shaded: &shaded,
            clipped: &[],
            modes: &modes,
            gradients: &[],
        };
        let mut packet = TrianglePacket::EMPTY;
        let vertices = (0_u32..).step_by(3);
        for (lane, (number, first)) in (0_i32..).zip(vertices).enumerate().take(LANES) {
            // Up to 1500 pixels, also beyond what 32 bits hold of an area.
            let extent = 300 + number * number * 1700;
            let corners = [[0, 0], [extent, number], [-number, extent]];
            for (corner, ([x, y], vertex)) in corners.into_iter().zip(first..).enumerate() {
                (packet.x[corner][lane], packet.y[corner][lane]) = (x + 77, y - 9);
                packet.vertex[corner][lane] = VertexRef(vertex);
                let apart = if lane % 3 == 0 { 0.0 } else { corner as f32 };
                packet.iw_at[corner][lane] = 0.5 + apart;
            }
            packet.provoking.0[lane] = VertexRef(first + 1);
        }
        for level in Level::all_available() {
            let mut planes = CrossPlanes::default();
            dispatch!(@wide level, s => {
                packet.complete_small(s);
                planes.set(s, &packet, u16::MAX, &source);
            }, scalar => continue);
            for lane in 0..LANES {
                let mut expected = vec![0.0; VaryingPlanes::size(modes.len())];
                let mut copied = vec![f32::NAN; expected.len()];
                let triangle = packet.triangle(lane);
                dispatch!(level, s => set_planes(s, &mut expected, &triangle, &source, false));
                planes.copy_lane(lane, &modes, &mut copied);
                let bits = |of: &[f32]| -> Vec<u32> { of.iter().map(|x| x.to_bits()).collect() };
                assert_eq!(bits(&copied), bits(&expected), "{level:?}, lane {lane}");
            }
        }
    }
}
