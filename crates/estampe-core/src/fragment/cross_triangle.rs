//! Varyings of sixteen small triangles, one fragment of each at a time.
//!
//! If fragments need no neighbours, a packet need not be 4×4 pixels of one triangle: in a *row*,
//! lane `i` is a pixel of triangle `i`, and interpolation costs no more than it does for one
//! triangle.

use super::interpolate::VaryingSource;
use crate::bounds::primitives::TrianglePacket;
use crate::raster::small::PIXELS;
use estampe_simd::{LANES, Lanes, Packet, Select, SimdBase, SimdCvtFloat, f32x16, i32x16, u32x16};
use estampe_types::Interpolation;

/// Fragments of one packet's small triangles: row `r` holds the `r`-th fragment that each lane's
/// triangle has.
#[derive(Debug)]
#[repr(C, align(64))]
pub(crate) struct CrossFragments {
    /// By row and lane: the fragment's pixel in its triangle's box, 8·row + column.
    pixels: [[i32; LANES]; PIXELS],
    /// By row: the lanes that have a fragment.
    pub(crate) lanes: [u16; PIXELS],
    /// The number of rows.
    pub(crate) count: usize,
}

impl Default for CrossFragments {
    fn default() -> Self {
        Self {
            pixels: [[0; LANES]; PIXELS],
            lanes: [0; PIXELS],
            count: 0,
        }
    }
}

impl CrossFragments {
    /// Adds a lane's next fragment, its `row`-th. Lanes begin in order, and rows grow one by one.
    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        reason = "a pixel is below 64"
    )]
    pub(crate) fn push(&mut self, lane: usize, row: usize, pixel: usize) {
        let row = row % PIXELS;
        if row == self.count {
            self.lanes[row] = 0;
            self.count += 1;
        }
        self.lanes[row] |= 1 << lane;
        self.pixels[row][lane % LANES] = pixel as i32;
    }

    /// The columns and rows of a row's pixels in their boxes.
    #[inline(always)]
    pub(crate) fn steps<S: Lanes>(&self, s: S, row: usize) -> [f32x16<S>; 2] {
        let pixels = i32x16::load_array_ref(s, &self.pixels[row % PIXELS]);
        let seven = <i32x16<S> as SimdBase<S>>::splat(s, 7);
        [
            f32x16::float_from(pixels & seven),
            f32x16::float_from(pixels >> 3),
        ]
    }
}

/// Planes of all varyings of sixteen triangles: by scalar, then by lane.
#[derive(Debug, Default)]
pub(crate) struct CrossPlanes {
    /// Values at the three vertices; their first is the planes' origin once [`CrossPlanes::set`] is
    /// done.
    corners: [Vec<Packet<f32>>; 3],
    dx: Vec<Packet<f32>>,
    dy: Vec<Packet<f32>>,
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
        let [dx1, dx2] = differences(s, &packet.x);
        let [dy1, dy2] = differences(s, &packet.y);
        let r = f32x16::load_array_ref(s, &packet.r);
        let equal_w = s.mask_from_bits(packet.equal_w);
        let one = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
        let mut iw = [one; 3];
        for (iw, values) in iw.iter_mut().zip(&packet.iw_at) {
            // A product with 1 changes nothing.
            *iw = equal_w.select(one, f32x16::load_array_ref(s, values));
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
            let (e1, e2) = (p[1] - p[0], p[2] - p[0]);
            ((e1 * dy2 - e2 * dy1) * r).store_array(&mut dx.0);
            ((e2 * dx1 - e1 * dx2) * r).store_array(&mut dy.0);
        }
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
        let n = source.modes.len();
        if n < 2 {
            for (rows, vertices) in self.corners.iter_mut().zip(&packet.vertex) {
                for row in rows {
                    for (to, vertex) in row.0.iter_mut().zip(vertices) {
                        *to = source.of(*vertex)[0];
                    }
                }
            }
        } else {
            let wanted = s.mask_from_bits(lanes);
            let lane = lanes.trailing_zeros() as usize % LANES;
            for (rows, vertices) in self.corners.iter_mut().zip(&packet.vertex) {
                // Lanes that are not wanted repeat one that is: theirs may be far away.
                let one = <u32x16<S> as SimdBase<S>>::splat(s, vertices[lane].0);
                let all = u32x16::load_array(s, vertices.map(|vertex| vertex.0));
                let vertices = wanted.select(all, one).to_array();
                let mut first = 0;
                while first < n {
                    // The last four columns overlap those before them.
                    let at = first.min(n.saturating_sub(4));
                    let columns = source.four_of(s, &vertices, at);
                    for (row, column) in rows[at..].iter_mut().zip(columns) {
                        column.store_array(&mut row.0);
                    }
                    first += 4;
                }
            }
        }
        if source.modes.contains(&Interpolation::Flat) {
            self.fetch_flat(packet, lanes, source);
        }
    }

    /// Flat varyings are the provoking vertex's.
    #[inline(never)]
    fn fetch_flat(&mut self, packet: &TrianglePacket, lanes: u16, source: &VaryingSource<'_>) {
        let mut left = lanes;
        while left != 0 {
            let lane = left.trailing_zeros() as usize % LANES;
            left &= left - 1;
            let values = source.of(packet.provoking[lane]);
            let rows = self.corners[0].iter_mut().zip(values);
            for ((row, value), mode) in rows.zip(source.modes) {
                if *mode == Interpolation::Flat {
                    row.0[lane] = *value;
                }
            }
        }
    }

    /// The varyings at one pixel of each triangle, given by its centre's distance from the planes'
    /// origin.
    #[inline(always)]
    pub(crate) fn varyings<S: Lanes>(
        &self,
        s: S,
        packet: &TrianglePacket,
        modes: &[Interpolation],
        [x, y]: [f32x16<S>; 2],
        out: &mut [Packet<f32>],
    ) {
        let one = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
        let iw = f32x16::load_array_ref(s, &packet.iw.origin)
            + (x * f32x16::load_array_ref(s, &packet.iw.dx)
                + y * f32x16::load_array_ref(s, &packet.iw.dy));
        let w = s.mask_from_bits(packet.equal_w).select(one, one / iw);
        let planes = self.corners[0].iter().zip(self.dx.iter().zip(&self.dy));
        for ((mode, out), (origin, (dx, dy))) in modes.iter().zip(out).zip(planes) {
            if *mode == Interpolation::Flat {
                *out = *origin;
                continue;
            }
            let mut value = f32x16::load_array_ref(s, &origin.0)
                + (x * f32x16::load_array_ref(s, &dx.0) + y * f32x16::load_array_ref(s, &dy.0));
            if *mode == Interpolation::Smooth {
                value *= w;
            }
            value.store_array(&mut out.0);
        }
    }
}

/// Differences of the second and the third vertex from the first, in pixels: exact.
#[inline(always)]
fn differences<S: Lanes>(s: S, of: &[[i32; LANES]; 3]) -> [f32x16<S>; 2] {
    let first = i32x16::load_array_ref(s, &of[0]);
    [
        f32x16::float_from(i32x16::load_array_ref(s, &of[1]) - first) * (1.0 / 256.0),
        f32x16::float_from(i32x16::load_array_ref(s, &of[2]) - first) * (1.0 / 256.0),
    ]
}
