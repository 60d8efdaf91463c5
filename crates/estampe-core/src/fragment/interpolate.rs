//! From vertices to fragments: depth and varyings of triangles, lines and points at sixteen pixels.
//!
//! Each kind of primitive is a [`Surface`]: a value that knows its depth at any sample and its varyings at
//! any pixel. Planes are evaluated anew at each pixel, from the first sorted vertex:
//! `p₀ + ((X − x₀)·∂p/∂x + (Y − y₀)·∂p/∂y)`.

use crate::geometry::line_style::{
    LineAxis, LineRectangle, LineShape, LineStyle, along, length_squared,
};
use crate::geometry::rows::columns_of_reals;
use crate::tiles::{LinePrimitive, Plane, PointPrimitive, TrianglePacket, VertexRef};
use estampe_simd::{
    LANE_X, LANE_Y, LANES, Lanes, Packet, SimdBase, SimdCvtFloat, f32x4, f32x16, i32x16,
};
use estampe_types::Interpolation;

/// The varyings of a draw's vertices.
#[derive(Debug, Clone, Copy)]
pub(crate) struct VaryingSource<'a> {
    /// Of the item's vertices.
    pub(crate) shaded: &'a [f32],
    /// Of the chunk's own, made by clipping.
    pub(crate) clipped: &'a [f32],
    /// How each scalar is interpolated.
    pub(crate) modes: &'a [Interpolation],
}

impl<'a> VaryingSource<'a> {
    #[inline(always)]
    pub(super) fn of(&self, vertex: VertexRef) -> &'a [f32] {
        let n = self.modes.len();
        let (from, number) = if vertex.0 & VertexRef::CLIPPED == 0 {
            (self.shaded, vertex.0)
        } else {
            (self.clipped, vertex.0 & !VertexRef::CLIPPED)
        };
        &from[number as usize * n..][..n]
    }

    /// Four scalars of sixteen vertices, from scalar `at` on; of vertices with fewer than four, all of them and
    /// whatever follows. There must be two at least.
    #[inline(always)]
    pub(super) fn four_of<S: Lanes>(
        &self,
        s: S,
        vertices: &[u32; LANES],
        at: usize,
    ) -> [f32x16<S>; 4] {
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
        let mut rows = [&end; LANES];
        for (row, &vertex) in rows.iter_mut().zip(vertices) {
            let (from, end) = if vertex & VertexRef::CLIPPED == 0 {
                (self.shaded, &end)
            } else {
                (self.clipped, &clipped_end)
            };
            let first = (vertex & !VertexRef::CLIPPED) as usize * n + at;
            let found = from.get(first..).and_then(<[f32]>::first_chunk);
            *row = found.unwrap_or(end);
        }
        columns_of_reals(s, &rows)
    }
}

/// A primitive that fragments are made of.
pub(crate) trait Surface<S: Lanes> {
    /// Depth at a sample offset (in pixels) of the packet's sixteen pixels, not yet clamped.
    fn depth(&self, s: S, pixel: [i32; 2], sample: [f32; 2]) -> f32x16<S>;
    /// 1/w at the pixels' centres.
    fn inverse_w(&self, s: S, pixel: [i32; 2]) -> f32x16<S>;
    /// The varyings at the pixels' centres, as many packets as there are scalars.
    fn varyings(&self, s: S, pixel: [i32; 2], out: &mut [Packet<f32>]);

    /// 1/w at a place of each pixel; of lines and points at the centres.
    #[inline(always)]
    fn inverse_w_at(&self, s: S, pixel: [i32; 2], _places: &Places) -> f32x16<S> {
        self.inverse_w(s, pixel)
    }

    /// The varyings at a place of each pixel; of lines and points at the centres.
    #[inline(always)]
    fn varyings_in(&self, s: S, pixel: [i32; 2], _places: &Places, out: &mut [Packet<f32>]) {
        self.varyings(s, pixel, out);
    }
}

/// A place in each of sixteen pixels: offsets in x and in y, in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Places {
    pub(crate) x: [f32; LANES],
    pub(crate) y: [f32; LANES],
}

impl Places {
    /// The same place in every pixel.
    pub(crate) fn all([x, y]: [f32; 2]) -> Self {
        Self {
            x: [x; LANES],
            y: [y; LANES],
        }
    }
}

/// Columns (or rows) of a packet's lanes.
#[inline(always)]
fn lane_steps<S: Lanes>(s: S, lanes: &[u8; LANES]) -> f32x16<S> {
    let mut steps = [0.0; LANES];
    let mut lane = 0;
    while lane < LANES {
        steps[lane] = lanes[lane] as f32;
        lane += 1;
    }
    f32x16::load_array(s, steps)
}

/// The origin of a triangle's planes: its first sorted vertex, in pixels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlaneOrigin {
    pub(crate) x: f32,
    pub(crate) y: f32,
}

impl PlaneOrigin {
    #[inline(always)]
    pub(crate) fn new(packet: &TrianglePacket, lane: usize) -> Self {
        Self {
            x: pixels(packet.x[0][lane]),
            y: pixels(packet.y[0][lane]),
        }
    }

    /// Distances of the packet's pixels (at an offset in each) from the origin.
    ///
    /// Positions and offsets are multiples of 1/256 and distances below 2¹⁶, so every sum here is exact, in
    /// whatever order it is taken.
    #[inline(always)]
    pub(crate) fn distances<S: Lanes>(
        &self,
        s: S,
        [x, y]: [i32; 2],
        [sx, sy]: [f32; 2],
    ) -> [f32x16<S>; 2] {
        [self.columns_from(s, x, sx), self.rows_from(s, y, sy)]
    }

    /// [`PlaneOrigin::distances`] of a place in each pixel.
    #[inline(always)]
    fn distances_of<S: Lanes>(&self, s: S, [x, y]: [i32; 2], places: &Places) -> [f32x16<S>; 2] {
        [
            self.columns_from(s, x, 0.0) + f32x16::load_array_ref(s, &places.x),
            self.rows_from(s, y, 0.0) + f32x16::load_array_ref(s, &places.y),
        ]
    }

    /// [`PlaneOrigin::distances`] of the columns alone.
    #[inline(always)]
    pub(crate) fn columns_from<S: Lanes>(&self, s: S, x: i32, offset: f32) -> f32x16<S> {
        let first = x as f32 + offset - self.x;
        lane_steps(s, &LANE_X) + <f32x16<S> as SimdBase<S>>::splat(s, first)
    }

    /// [`PlaneOrigin::distances`] of the rows alone.
    #[inline(always)]
    pub(crate) fn rows_from<S: Lanes>(&self, s: S, y: i32, offset: f32) -> f32x16<S> {
        let first = y as f32 + offset - self.y;
        lane_steps(s, &LANE_Y) + <f32x16<S> as SimdBase<S>>::splat(s, first)
    }
}

/// The depth of a triangle, over the window.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DepthPlane {
    pub(crate) origin: PlaneOrigin,
    pub(crate) z: Plane,
}

impl DepthPlane {
    #[inline(always)]
    pub(crate) fn new(packet: &TrianglePacket, lane: usize) -> Self {
        Self {
            origin: PlaneOrigin::new(packet, lane),
            z: packet.z.lane(lane),
        }
    }
}

/// 1/256 pixel to pixels: exact below 2²⁴.
#[inline(always)]
fn pixels(subpixels: i32) -> f32 {
    subpixels as f32 * (1.0 / 256.0)
}

/// A plane's value at sixteen pixels.
#[inline(always)]
pub(crate) fn evaluate<S: Lanes>(s: S, plane: &Plane, [dx, dy]: [f32x16<S>; 2]) -> f32x16<S> {
    let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
    splat(plane.origin) + (dx * splat(plane.dx) + dy * splat(plane.dy))
}

/// Planes of a triangle's varyings: scalar `k` is `origin[k]`, `dx[k]`, `dy[k]`.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct VaryingPlanes<'a> {
    origin: &'a [f32],
    dx: &'a [f32],
    dy: &'a [f32],
}

impl<'a> VaryingPlanes<'a> {
    /// Numbers that the planes of `scalars` varyings take.
    #[inline(always)]
    pub(crate) fn size(scalars: usize) -> usize {
        scalars * 3
    }

    /// What [`set_planes`] wrote.
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

    /// How many there are.
    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.origin.len()
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

/// Writes the planes of a lane's triangle to [`VaryingPlanes::size`] numbers.
#[inline(always)]
pub(crate) fn set_planes<S: Lanes>(
    s: S,
    out: &mut [f32],
    (packet, lane): (&TrianglePacket, usize),
    source: &VaryingSource<'_>,
    all_smooth: bool,
) {
    let vertex = |corner: usize| source.of(packet.vertex[corner][lane]);
    let (a0, a1, a2) = (vertex(0), vertex(1), vertex(2));
    let n = source.modes.len();
    let (origin, rest) = out.split_at_mut(n);
    let (dx, dy) = rest.split_at_mut(n);
    let dy = &mut dy[..n];
    let iw = [
        packet.iw_at[0][lane],
        packet.iw_at[1][lane],
        packet.iw_at[2][lane],
    ];
    let perspective = packet.equal_w >> lane & 1 == 0;
    let difference = |of: &[[i32; LANES]; 3], corner: usize| pixels(of[corner][lane] - of[0][lane]);
    let (dx1, dy1) = (difference(&packet.x, 1), difference(&packet.y, 1));
    let (dx2, dy2) = (difference(&packet.x, 2), difference(&packet.y, 2));
    let r = packet.r[lane];
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
        let provoking = source.of(packet.provoking[lane]);
        for (k, &value) in provoking.iter().enumerate().take(n) {
            if source.modes[k] == Interpolation::Flat {
                (origin[k], dx[k], dy[k]) = (value, 0.0, 0.0);
            }
        }
    }
}

/// A triangle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TriangleSurface<'a> {
    pub(crate) origin: PlaneOrigin,
    pub(crate) z: Plane,
    pub(crate) iw: Plane,
    /// Whether the three 1/w are equal in bits.
    pub(crate) equal_w: bool,
    pub(crate) planes: VaryingPlanes<'a>,
    pub(crate) modes: &'a [Interpolation],
    /// Whether every varying is smooth, which needs no look at the modes.
    pub(crate) all_smooth: bool,
}

impl<S: Lanes> Surface<S> for TriangleSurface<'_> {
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
    fn inverse_w_at(&self, s: S, pixel: [i32; 2], places: &Places) -> f32x16<S> {
        if self.equal_w {
            return SimdBase::splat(s, self.iw.origin);
        }
        evaluate(s, &self.iw, self.origin.distances_of(s, pixel, places))
    }

    #[inline(always)]
    fn varyings_in(&self, s: S, pixel: [i32; 2], places: &Places, out: &mut [Packet<f32>]) {
        self.varyings_at(s, self.origin.distances_of(s, pixel, places), out);
    }
}

impl TriangleSurface<'_> {
    /// The varyings at sixteen pixels, given by their centres' distances from the planes' origin.
    #[inline(always)]
    pub(crate) fn varyings_at<S: Lanes>(
        &self,
        s: S,
        distances: [f32x16<S>; 2],
        out: &mut [Packet<f32>],
    ) {
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
    }
}

/// A line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LineSurface<'a> {
    line: &'a LinePrimitive,
    axis: LineAxis,
    /// The rectangle's width, where the line is one.
    rectangle: Option<f32>,
    source: VaryingSource<'a>,
}

impl<'a> LineSurface<'a> {
    pub(crate) fn new(
        line: &'a LinePrimitive,
        style: &LineStyle,
        source: VaryingSource<'a>,
    ) -> Self {
        Self {
            line,
            axis: LineAxis::new(line),
            rectangle: match style.shape {
                LineShape::Columns { .. } => None,
                LineShape::Rectangle { width, .. } => Some(width),
            },
            source,
        }
    }

    /// How much of each pixel a rectangle covers, estimated with sixteen points.
    pub(crate) fn coverage(&self, [x, y]: [i32; 2]) -> Packet<f32> {
        let rectangle = self
            .rectangle
            .and_then(|width| LineRectangle::new(self.line, width));
        let mut covered = Packet([1.0; LANES]);
        if let Some(rectangle) = rectangle {
            for (lane, covered) in covered.0.iter_mut().enumerate() {
                let pixel = [x + i32::from(LANE_X[lane]), y + i32::from(LANE_Y[lane])];
                *covered = rectangle.sixteenths(pixel) as f32 * (1.0 / 16.0);
            }
        }
        covered
    }

    /// The fraction of the way to the end at an offset in the pixels, in pixels: of a rectangle that of the nearest
    /// point of the line.
    #[inline(always)]
    fn fraction_at<S: Lanes>(&self, s: S, pixel: [i32; 2], offset: [f32; 2]) -> f32x16<S> {
        if self.rectangle.is_none() {
            return self.fraction(s, pixel);
        }
        f32x16::load_array(s, self.rectangle_fraction(pixel, offset))
    }

    #[inline(never)]
    #[expect(clippy::cast_possible_truncation, reason = "an offset is below 1")]
    fn rectangle_fraction(&self, [x, y]: [i32; 2], offset: [f32; 2]) -> [f32; LANES] {
        let [right, below] = offset.map(|pixels| (pixels * 256.0) as i32);
        let squared = length_squared(self.line) as f32;
        std::array::from_fn(|lane| {
            let at = [
                (x + i32::from(LANE_X[lane])) * 256 + right,
                (y + i32::from(LANE_Y[lane])) * 256 + below,
            ];
            along(self.line, at) as f32 / squared
        })
    }

    /// The fraction of the way to the end, at the pixels' centres along the major axis.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "coordinates are below 2²⁴")]
    fn fraction<S: Lanes>(&self, s: S, [x, y]: [i32; 2]) -> f32x16<S> {
        let (pixel, lanes) = if self.axis.x_major {
            (x, &LANE_X)
        } else {
            (y, &LANE_Y)
        };
        let mut steps = [0; LANES];
        for (step, lane) in steps.iter_mut().zip(lanes) {
            *step = i32::from(*lane) * 256;
        }
        let first = pixel * 256 + 128 - self.axis.start[0] as i32;
        let along = i32x16::load_array(s, steps) + <i32x16<S> as SimdBase<S>>::splat(s, first);
        let delta = <f32x16<S> as SimdBase<S>>::splat(s, self.axis.delta[0] as f32);
        f32x16::float_from(along) / delta
    }
}

/// `a + (b − a)·t`.
#[inline(always)]
fn mix<S: Lanes>(s: S, a: f32, b: f32, t: f32x16<S>) -> f32x16<S> {
    let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
    splat(a) + splat(b - a) * t
}

impl<S: Lanes> Surface<S> for LineSurface<'_> {
    #[inline(always)]
    fn depth(&self, s: S, pixel: [i32; 2], sample: [f32; 2]) -> f32x16<S> {
        let [a, b] = &self.line.ends;
        mix(s, a.z, b.z, self.fraction_at(s, pixel, sample))
    }

    #[inline(always)]
    fn inverse_w(&self, s: S, pixel: [i32; 2]) -> f32x16<S> {
        let [a, b] = &self.line.ends;
        if a.iw.to_bits() == b.iw.to_bits() {
            return SimdBase::splat(s, a.iw);
        }
        mix(s, a.iw, b.iw, self.fraction_at(s, pixel, [0.5; 2]))
    }

    #[inline(always)]
    fn varyings(&self, s: S, pixel: [i32; 2], out: &mut [Packet<f32>]) {
        let [a, b] = &self.line.ends;
        let (from, to) = (self.source.of(a.vertex), self.source.of(b.vertex));
        let provoking = self.source.of(self.line.provoking);
        let t = self.fraction_at(s, pixel, [0.5; 2]);
        let perspective = a.iw.to_bits() != b.iw.to_bits();
        let one = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
        let w = one / mix(s, a.iw, b.iw, t);
        for (k, packet) in out.iter_mut().enumerate() {
            let value = match self.source.modes[k] {
                Interpolation::Flat => SimdBase::splat(s, provoking[k]),
                Interpolation::Smooth if perspective => mix(s, from[k] * a.iw, to[k] * b.iw, t) * w,
                _ => mix(s, from[k], to[k], t),
            };
            value.store_array(&mut packet.0);
        }
    }
}

/// A point: everything is its vertex's.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PointSurface<'a> {
    pub(crate) point: &'a PointPrimitive,
    pub(crate) source: VaryingSource<'a>,
}

impl<S: Lanes> Surface<S> for PointSurface<'_> {
    #[inline(always)]
    fn depth(&self, s: S, _pixel: [i32; 2], _sample: [f32; 2]) -> f32x16<S> {
        SimdBase::splat(s, self.point.center.z)
    }

    #[inline(always)]
    fn inverse_w(&self, s: S, _pixel: [i32; 2]) -> f32x16<S> {
        SimdBase::splat(s, self.point.center.iw)
    }

    #[inline(always)]
    fn varyings(&self, s: S, _pixel: [i32; 2], out: &mut [Packet<f32>]) {
        let own = self.source.of(self.point.center.vertex);
        let provoking = self.source.of(self.point.provoking);
        for (k, packet) in out.iter_mut().enumerate() {
            let value = match self.source.modes[k] {
                Interpolation::Flat => provoking[k],
                Interpolation::Smooth | Interpolation::NoPerspective => own[k],
            };
            <f32x16<S> as SimdBase<S>>::splat(s, value).store_array(&mut packet.0);
        }
    }
}
