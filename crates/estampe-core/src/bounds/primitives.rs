//! Primitives that geometry has set up, as the tile side reads them.
//!
//! Triangles lie in packets of sixteen, structure of arrays, and so do [lines](super::lines);
//! points, which are few, lie one by one.

use super::plane::{Plane, PlanePacket};
use super::triangle_edges::{doubled_area, doubled_area_of_small};
use estampe_simd::{Bytes, LANES, Lanes, SimdBase, f32x16, i32x16, u32x16};

/// A vertex of a sub-draw: an index into its shaded vertices or, with [`VertexRef::CLIPPED`] set,
/// into the vertices of the chunk that clipping made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct VertexRef(pub(crate) u32);

impl VertexRef {
    /// The bit that tells vertices made by clipping.
    pub(crate) const CLIPPED: u32 = 1 << 31;
}

/// Up to sixteen triangles, set up: vertices 0, 1, 2 sorted by (y, x).
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(crate) struct TrianglePacket {
    /// Snapped positions in 1/256 pixel.
    pub(crate) x: [[i32; LANES]; 3],
    pub(crate) y: [[i32; LANES]; 3],
    /// References to the vertices' varyings.
    pub(crate) vertex: [[VertexRef; LANES]; 3],
    /// 1/w at the three vertices.
    pub(crate) iw_at: [[f32; LANES]; 3],
    /// Depth.
    pub(crate) z: PlanePacket,
    /// Bit by lane: the triangle is clockwise in sorted order (its doubled area is positive).
    pub(crate) clockwise: u16,
    /// Bit by lane: it faces the viewer.
    pub(crate) front: u16,
    /// Bit by lane: the three 1/w are equal in bits.
    pub(crate) equal_w: u16,
    /// Bit by lane: it is wider and higher than a block of 16×16 pixels. Known of packets that are
    /// not taken apart.
    pub(crate) large: u16,
    /// The number of lanes in use.
    pub(crate) len: u16,
    /// The vertex that flat varyings come from.
    pub(crate) provoking: FlatVertices,
}

/// The vertices that flat varyings come from, in a cache line that is left alone if none is flat.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(crate) struct FlatVertices(pub(crate) [VertexRef; LANES]);

impl TrianglePacket {
    pub(crate) const EMPTY: Self = Self {
        x: [[0; LANES]; 3],
        y: [[0; LANES]; 3],
        vertex: [[VertexRef(0); LANES]; 3],
        iw_at: [[0.0; LANES]; 3],
        z: PlanePacket::ZERO,
        clockwise: 0,
        front: 0,
        equal_w: 0,
        large: 0,
        len: 0,
        provoking: FlatVertices([VertexRef(0); LANES]),
    };
}

impl Default for TrianglePacket {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl TrianglePacket {
    /// The triangle of a lane.
    #[inline(always)]
    pub(crate) fn triangle(&self, lane: usize) -> Triangle {
        PackedTriangle::of_lane(self, lane).unpack()
    }

    /// Prefetches what coverage and tests use, and, if asked for, what interpolation does.
    #[inline(always)]
    pub(crate) fn prefetch<S: Lanes>(&self, s: S, interpolates: bool) {
        s.prefetch(&self.x);
        s.prefetch(&self.y);
        s.prefetch(&self.z);
        s.prefetch(&self.clockwise);
        if interpolates {
            s.prefetch(&self.vertex);
            s.prefetch(&self.iw_at);
        }
    }
}

impl TrianglePacket {
    /// Copies what coverage and tests read of a triangle: its place in the window and its depth.
    #[inline(always)]
    pub(crate) fn copy_window(&mut self, lane: usize, from: &Self, of: usize) {
        for corner in 0..3 {
            self.x[corner][lane] = from.x[corner][of];
            self.y[corner][lane] = from.y[corner][of];
        }
        self.z.set(lane, from.z.lane(of));
        let copy = |to: u16, from: u16| to & !(1 << lane) | (from >> of & 1) << lane;
        self.clockwise = copy(self.clockwise, from.clockwise);
        self.front = copy(self.front, from.front);
    }

    /// Sets a lane to a triangle. What it does not hold is set by
    /// [`TrianglePacket::complete_small`].
    #[inline(always)]
    pub(crate) fn set(&mut self, lane: usize, triangle: &PackedTriangle) {
        for corner in 0..3 {
            self.x[corner][lane] = triangle.x[corner];
            self.y[corner][lane] = triangle.y[corner];
            self.vertex[corner][lane] = triangle.vertex[corner];
            self.iw_at[corner][lane] = triangle.iw_at[corner];
        }
        self.provoking.0[lane] = triangle.provoking();
        self.z.set(lane, triangle.z);
        self.front = self.front & !(1 << lane) | u16::from(triangle.is_front()) << lane;
    }

    /// Computes the masks that a packed triangle does not hold, of those that are smaller than 128
    /// pixels.
    #[inline(always)]
    pub(crate) fn complete_small<S: Lanes>(&mut self, s: S) {
        let load = |lanes: &[i32; LANES]| i32x16::load_array_ref(s, lanes);
        let x = [load(&self.x[0]), load(&self.x[1]), load(&self.x[2])];
        let y = [load(&self.y[0]), load(&self.y[1]), load(&self.y[2])];
        let area = doubled_area_of_small([&x, &y]);
        let zero = <i32x16<S> as SimdBase<S>>::splat(s, 0);
        self.clockwise = s.bits_of_mask(area.simd_gt(zero));
        let bits = |corner: usize| -> u32x16<S> {
            f32x16::load_array_ref(s, &self.iw_at[corner]).bitcast()
        };
        let first = bits(0);
        let are_equal = first.simd_eq(bits(1)) & first.simd_eq(bits(2));
        self.equal_w = s.bits_of_mask(are_equal);
    }
}

/// A triangle that is drawn by itself, in order: a cache line.
///
/// A lane's values are in sixteen cache lines of its packet. What is computed again in a few
/// operations, with the same bits, is not here.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(crate) struct PackedTriangle {
    pub(crate) x: [i32; 3],
    pub(crate) y: [i32; 3],
    pub(crate) vertex: [VertexRef; 3],
    /// The provoking vertex, which clipping never made, with [`PackedTriangle::FRONT`].
    provoking: u32,
    pub(crate) iw_at: [f32; 3],
    pub(crate) z: Plane,
}

const _: () = assert!(size_of::<PackedTriangle>() == 64);

/// The triangles of a packet's lanes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PackedTriangles(pub(crate) [PackedTriangle; LANES]);

impl Default for PackedTriangles {
    fn default() -> Self {
        Self([PackedTriangle::of_lane(&TrianglePacket::EMPTY, 0); LANES])
    }
}

impl PackedTriangle {
    /// The bit that tells triangles that face the viewer.
    const FRONT: u32 = 1 << 31;

    /// The triangle of a packet's lane.
    #[inline(always)]
    pub(crate) fn of_lane(packet: &TrianglePacket, lane: usize) -> Self {
        let TrianglePacket {
            x,
            y,
            vertex,
            iw_at,
            ..
        } = packet;
        let front = packet.front >> lane & 1 == 1;
        Self {
            x: [x[0][lane], x[1][lane], x[2][lane]],
            y: [y[0][lane], y[1][lane], y[2][lane]],
            vertex: [vertex[0][lane], vertex[1][lane], vertex[2][lane]],
            provoking: packet.provoking.0[lane].0 & !Self::FRONT
                | if front { Self::FRONT } else { 0 },
            iw_at: [iw_at[0][lane], iw_at[1][lane], iw_at[2][lane]],
            z: packet.z.lane(lane),
        }
    }

    #[inline(always)]
    pub(crate) fn provoking(&self) -> VertexRef {
        VertexRef(self.provoking & !Self::FRONT)
    }

    #[inline(always)]
    pub(crate) fn is_front(&self) -> bool {
        self.provoking & Self::FRONT != 0
    }

    /// True if the three 1/w are equal in bits.
    #[inline(always)]
    pub(crate) fn has_equal_w(&self) -> bool {
        let [a, b, c] = self.iw_at.map(f32::to_bits);
        a == b && a == c
    }

    /// The corners, clockwise in a window with y down.
    #[inline(always)]
    pub(crate) fn clockwise_corners(&self) -> [[i32; 2]; 3] {
        let corner = |corner: usize| [self.x[corner], self.y[corner]];
        if doubled_area([self.x, self.y]) > 0 {
            [corner(0), corner(1), corner(2)]
        } else {
            [corner(0), corner(2), corner(1)]
        }
    }

    /// The triangle with all that was set up.
    #[inline(always)]
    pub(crate) fn unpack(&self) -> Triangle {
        let ([x0, x1, x2], [y0, y1, y2]) = (self.x, self.y);
        let (x1, x2, y1, y2) = (x1 - x0, x2 - x0, y1 - y0, y2 - y0);
        let area = doubled_area([self.x, self.y]);
        let r = 65_536.0 / area as f32;
        let pixels = |subpixels: i32| subpixels as f32 * (1.0 / 256.0);
        let [w0, w1, w2] = self.iw_at;
        let (e1, e2) = (w1 - w0, w2 - w0);
        Triangle {
            x: self.x,
            y: self.y,
            vertex: self.vertex,
            provoking: self.provoking(),
            iw_at: self.iw_at,
            z: self.z,
            iw: Plane {
                origin: w0,
                dx: (e1 * pixels(y2) - e2 * pixels(y1)) * r,
                dy: (e2 * pixels(x1) - e1 * pixels(x2)) * r,
            },
            r,
            clockwise: area > 0,
            front: self.is_front(),
            equal_w: self.has_equal_w(),
        }
    }
}

/// One triangle, set up: a lane of a [`TrianglePacket`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Triangle {
    pub(crate) x: [i32; 3],
    pub(crate) y: [i32; 3],
    pub(crate) vertex: [VertexRef; 3],
    pub(crate) provoking: VertexRef,
    pub(crate) iw_at: [f32; 3],
    pub(crate) z: Plane,
    pub(crate) iw: Plane,
    pub(crate) r: f32,
    pub(crate) clockwise: bool,
    pub(crate) front: bool,
    pub(crate) equal_w: bool,
}

/// A line's or point's end: where it is in the window, and where its varyings are.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct WindowVertex {
    /// Snapped position in 1/256 pixel.
    pub(crate) x: i32,
    pub(crate) y: i32,
    pub(crate) z: f32,
    pub(crate) iw: f32,
    pub(crate) vertex: VertexRef,
}

/// A point.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct PointPrimitive {
    pub(crate) center: WindowVertex,
    /// The vertex that flat varyings come from: another one where the point is a triangle's corner.
    pub(crate) provoking: VertexRef,
    /// Half its side in 1/256 pixel.
    pub(crate) half: i32,
    pub(crate) front: bool,
}

// Geometry writes a packet for as few as two triangles and tiles read it again: its size is a cost
// of every draw. What a few operations give is not in it: reciprocal areas and planes of 1/w, which
// took five lines: without them `small_tris` takes 0.88 of its time and `instances` 0.90, with
// prefetching.
const _: () = assert!(size_of::<TrianglePacket>() == 17 * 64);
