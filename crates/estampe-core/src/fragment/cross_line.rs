//! Depth and varyings of fragments of sixteen small lines, sixteen fragments at a time.
//!
//! As of [triangles](super::cross_fragments), each lane of a row is a pixel of any of a packet's
//! lines. The values at a line's start, and what the way to its end changes of them, are computed
//! for the sixteen lines together; a row's lanes take theirs by permutations.

use super::cross_fragments::{Row, bits_of_row};
use super::interpolate::{VaryingSource, smooth_derivatives};
use super::vertex_rows::{fetch_flat, fetch_rows};
use crate::bounds::lines::LinePacket;
use crate::geometry::line_style::LineShape;
use estampe_simd::{
    Bytes, LANES, Lanes, Packet, Select, SimdBase, SimdCvtFloat, f32x16, i32x16, u32x16,
};
use estampe_types::Interpolation;

/// Values of sixteen lines.
#[derive(Debug, Default)]
pub(crate) struct CrossLines {
    /// A fragment's part of the way to the end is `(x·way_x + y·way_y) ÷ divisor`, with its
    /// distance from the start in pixels.
    way: [Packet<f32>; 2],
    divisor: Packet<f32>,
    /// How that part changes from a pixel to the next one on the right, and below.
    slopes: [Packet<f32>; 2],
    /// At the start, and the difference of the end: depth, 1/w; and 1/w for varyings, which is 1
    /// where that of both ends is equal.
    z: [Packet<f32>; 2],
    iw: [Packet<f32>; 2],
    smooth_iw: [Packet<f32>; 2],
    /// The same of each scalar of the varyings, smooth ones times 1/w.
    from: Vec<Packet<f32>>,
    change: Vec<Packet<f32>>,
    /// The lines whose ends have the same 1/w; and whether all have.
    equal_ws: u16,
    equal_w: bool,
    is_columns: bool,
}

impl CrossLines {
    /// Sets the values of the lines in `lanes`.
    #[inline(always)]
    pub(crate) fn set<S: Lanes>(
        &mut self,
        s: S,
        (packet, lanes): (&LinePacket, u16),
        shape: LineShape,
        source: &VaryingSource<'_>,
    ) {
        self.set_way(s, packet, shape);
        let load = |values: &[f32; LANES]| f32x16::load_array_ref(s, values);
        let one = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
        let z = [load(&packet.z[0]), load(&packet.z[1])];
        z[0].store_array(&mut self.z[0].0);
        (z[1] - z[0]).store_array(&mut self.z[1].0);
        let iw = [load(&packet.iw[0]), load(&packet.iw[1])];
        iw[0].store_array(&mut self.iw[0].0);
        (iw[1] - iw[0]).store_array(&mut self.iw[1].0);
        let bits: [u32x16<S>; 2] = [iw[0].bitcast(), iw[1].bitcast()];
        let is_equal = bits[0].simd_eq(bits[1]);
        self.equal_ws = s.bits_of_mask(is_equal) & lanes;
        self.equal_w = self.equal_ws == lanes;
        // A product with 1 changes nothing.
        let iw = [is_equal.select(one, iw[0]), is_equal.select(one, iw[1])];
        iw[0].store_array(&mut self.smooth_iw[0].0);
        (iw[1] - iw[0]).store_array(&mut self.smooth_iw[1].0);

        let n = source.modes.len();
        self.from.resize(n, Packet::default());
        self.change.resize(n, Packet::default());
        fetch_rows(s, &mut self.from, &packet.vertex[0], lanes, source);
        fetch_rows(s, &mut self.change, &packet.vertex[1], lanes, source);
        let rows = self.from.iter_mut().zip(&mut self.change);
        for (mode, (from, change)) in source.modes.iter().zip(rows) {
            let mut ends = [load(&from.0), load(&change.0)];
            if *mode == Interpolation::Smooth {
                ends = [ends[0] * iw[0], ends[1] * iw[1]];
                ends[0].store_array(&mut from.0);
            }
            (ends[1] - ends[0]).store_array(&mut change.0);
        }
        if source.modes.contains(&Interpolation::Flat) {
            fetch_flat(&mut self.from, &packet.provoking.0, lanes, source);
        }
    }

    /// Of a Bresenham line the way along its major axis counts alone, of a rectangle the nearest
    /// point of the line: `(P − a)·(b − a) ÷ (b − a)²`. Both are in 1/256 pixel, but for the
    /// distance, so the divisor is divided by 256, which is exact. Coordinates of small lines are
    /// so short that products are exact, and the sum of two is rounded as the integer is.
    #[inline(always)]
    fn set_way<S: Lanes>(&mut self, s: S, packet: &LinePacket, shape: LineShape) {
        let load = |values: &[i32; LANES]| i32x16::load_array_ref(s, values);
        let x = f32x16::float_from(load(&packet.x[1]) - load(&packet.x[0]));
        let y = f32x16::float_from(load(&packet.y[1]) - load(&packet.y[0]));
        let (zero, one) = (
            <f32x16<S> as SimdBase<S>>::splat(s, 0.0),
            <f32x16<S> as SimdBase<S>>::splat(s, 1.0),
        );
        self.is_columns = matches!(shape, LineShape::Columns { .. });
        let (mut way, mut whole) = ([x, y], x * x + y * y);
        let mut slopes = [x * 256.0 / whole, y * 256.0 / whole];
        if self.is_columns {
            let across = s.max_f32(x, zero - x);
            let down = s.max_f32(y, zero - y);
            let x_major = across.simd_ge(down);
            way = [x_major.select(one, zero), x_major.select(zero, one)];
            whole = x_major.select(x, y);
            let slope = (one * 256.0) / whole;
            slopes = [x_major.select(slope, zero), x_major.select(zero, slope)];
        }
        for axis in 0..2 {
            way[axis].store_array(&mut self.way[axis].0);
            slopes[axis].store_array(&mut self.slopes[axis].0);
        }
        (whole * (1.0 / 256.0)).store_array(&mut self.divisor.0);
    }

    /// The part of the way to the end at the lanes' places, given by their distances from the
    /// start.
    #[inline(always)]
    fn fraction<S: Lanes>(&self, s: S, lane: u32x16<S>, [x, y]: [f32x16<S>; 2]) -> f32x16<S> {
        let along = x * of_lanes(s, &self.way[0], lane) + y * of_lanes(s, &self.way[1], lane);
        along / of_lanes(s, &self.divisor, lane)
    }

    /// Returns true if all samples of a pixel have the depth of its centre.
    #[inline(always)]
    pub(crate) fn has_depths_of_centers(&self) -> bool {
        self.is_columns
    }

    /// Depth, not yet clamped.
    #[inline(always)]
    pub(crate) fn depth<S: Lanes>(
        &self,
        s: S,
        lane: u32x16<S>,
        distances: [f32x16<S>; 2],
    ) -> f32x16<S> {
        mix(s, &self.z, lane, self.fraction(s, lane, distances))
    }

    /// 1/w at the pixels' centres.
    #[inline(always)]
    pub(crate) fn inverse_w<S: Lanes>(
        &self,
        s: S,
        lane: u32x16<S>,
        distances: [f32x16<S>; 2],
    ) -> f32x16<S> {
        // Of equal ends the change is 0.
        mix(s, &self.iw, lane, self.fraction(s, lane, distances))
    }

    /// The varyings of a row's fragments, given by the distances of their pixels' centres.
    #[inline(always)]
    pub(crate) fn varyings<S: Lanes>(
        &self,
        s: S,
        row: Row<S>,
        source: &VaryingSource<'_>,
        distances: [f32x16<S>; 2],
        out: &mut [Packet<f32>],
    ) {
        let lane = row.pixels.lane();
        let kept = s.mask_from_bits(row.lanes);
        let one = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
        let (out, derivatives) = out.split_at_mut(source.modes.len());
        let t = self.fraction(s, lane, distances);
        let w = if self.equal_w {
            one
        } else {
            one / mix(s, &self.smooth_iw, lane, t)
        };
        let values = self.from.iter().zip(&self.change);
        for ((mode, out), (from, change)) in source.modes.iter().zip(&mut *out).zip(values) {
            let mut value = of_lanes(s, from, lane);
            if *mode != Interpolation::Flat {
                value += of_lanes(s, change, lane) * t;
            }
            if *mode == Interpolation::Smooth {
                value *= w;
            }
            if row.is_open {
                value = kept.select(value, f32x16::load_array_ref(s, &out.0));
            }
            value.store_array(&mut out.0);
        }
        if !source.gradients.is_empty() {
            self.derivatives(s, row, (source, w), out, derivatives);
        }
    }

    /// The derivatives of some of a row's varyings, along x, then along y.
    #[inline(always)]
    fn derivatives<S: Lanes>(
        &self,
        s: S,
        row: Row<S>,
        (source, w): (&VaryingSource<'_>, f32x16<S>),
        varyings: &[Packet<f32>],
        out: &mut [Packet<f32>],
    ) {
        let lane = row.pixels.lane();
        let kept = s.mask_from_bits(row.lanes);
        let is_level = s.mask_from_bits(bits_of_row(s, self.equal_ws, row));
        let zero = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
        let slope = [
            of_lanes(s, &self.slopes[0], lane),
            of_lanes(s, &self.slopes[1], lane),
        ];
        let change_of_iw = of_lanes(s, &self.smooth_iw[1], lane);
        let of_iw = [change_of_iw * slope[0], change_of_iw * slope[1]];
        let (along_x, along_y) = out.split_at_mut(source.gradients.len());
        for ((along_x, along_y), &k) in along_x.iter_mut().zip(along_y).zip(source.gradients) {
            let value = f32x16::load_array_ref(s, &varyings[k].0);
            let change = of_lanes(s, &self.change[k], lane);
            let linear = [change * slope[0], change * slope[1]];
            let smooth = smooth_derivatives(linear, value, of_iw, w);
            let [mut x, mut y] = match source.modes[k] {
                Interpolation::Flat => [zero; 2],
                Interpolation::NoPerspective => linear,
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

/// `a + (b − a)·t` of the lanes' lines.
#[inline(always)]
fn mix<S: Lanes>(s: S, of: &[Packet<f32>; 2], lane: u32x16<S>, t: f32x16<S>) -> f32x16<S> {
    of_lanes(s, &of[0], lane) + of_lanes(s, &of[1], lane) * t
}

/// A value of the lanes' primitives.
#[inline(always)]
fn of_lanes<S: Lanes>(s: S, values: &Packet<f32>, lane: u32x16<S>) -> f32x16<S> {
    s.permute_f32(f32x16::load_array_ref(s, &values.0), lane)
}
