//! Primitives that geometry has set up, as the tile side reads them.
//!
//! Triangles lie in packets of sixteen, structure of arrays; lines and points, which are few, lie
//! one by one.

use super::plane::{Plane, PlanePacket};
use estampe_simd::LANES;

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
    /// The vertex that flat varyings come from.
    pub(crate) provoking: [VertexRef; LANES],
    /// 1/w at the three vertices.
    pub(crate) iw_at: [[f32; LANES]; 3],
    /// Depth.
    pub(crate) z: PlanePacket,
    /// 1/w.
    pub(crate) iw: PlanePacket,
    /// 65536 ÷ doubled signed area in 1/256 pixel².
    pub(crate) r: [f32; LANES],
    /// Bit by lane: the triangle is clockwise in sorted order (its doubled area is positive).
    pub(crate) clockwise: u16,
    /// Bit by lane: it faces the viewer.
    pub(crate) front: u16,
    /// Bit by lane: the three 1/w are equal in bits.
    pub(crate) equal_w: u16,
    /// The number of lanes in use.
    pub(crate) len: u16,
}

impl TrianglePacket {
    pub(crate) const EMPTY: Self = Self {
        x: [[0; LANES]; 3],
        y: [[0; LANES]; 3],
        vertex: [[VertexRef(0); LANES]; 3],
        provoking: [VertexRef(0); LANES],
        iw_at: [[0.0; LANES]; 3],
        z: PlanePacket::ZERO,
        iw: PlanePacket::ZERO,
        r: [0.0; LANES],
        clockwise: 0,
        front: 0,
        equal_w: 0,
        len: 0,
    };
}

impl TrianglePacket {
    /// The triangle of a lane.
    #[inline(always)]
    pub(crate) fn triangle(&self, lane: usize) -> Triangle {
        let Self {
            x,
            y,
            vertex,
            iw_at,
            ..
        } = self;
        let is_in = |mask: u16| mask >> lane & 1 == 1;
        Triangle {
            x: [x[0][lane], x[1][lane], x[2][lane]],
            y: [y[0][lane], y[1][lane], y[2][lane]],
            vertex: [vertex[0][lane], vertex[1][lane], vertex[2][lane]],
            provoking: self.provoking[lane],
            iw_at: [iw_at[0][lane], iw_at[1][lane], iw_at[2][lane]],
            z: self.z.lane(lane),
            iw: self.iw.lane(lane),
            r: self.r[lane],
            clockwise: is_in(self.clockwise),
            front: is_in(self.front),
            equal_w: is_in(self.equal_w),
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

    /// Sets a lane.
    #[inline(always)]
    pub(crate) fn set(&mut self, lane: usize, triangle: &Triangle) {
        for corner in 0..3 {
            self.x[corner][lane] = triangle.x[corner];
            self.y[corner][lane] = triangle.y[corner];
            self.vertex[corner][lane] = triangle.vertex[corner];
            self.iw_at[corner][lane] = triangle.iw_at[corner];
        }
        self.provoking[lane] = triangle.provoking;
        self.z.set(lane, triangle.z);
        self.iw.set(lane, triangle.iw);
        self.r[lane] = triangle.r;
        let bit = 1 << lane;
        for (mask, is_in) in [
            (&mut self.clockwise, triangle.clockwise),
            (&mut self.front, triangle.front),
            (&mut self.equal_w, triangle.equal_w),
        ] {
            *mask = *mask & !bit | u16::from(is_in) << lane;
        }
    }
}

/// One triangle, set up: a lane of a [`TrianglePacket`].
///
/// A lane's values are in 21 cache lines of its packet, those of a `Triangle` in two.
#[derive(Debug, Clone, Copy)]
#[repr(align(32))]
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

const _: () = assert!(size_of::<Triangle>() == 96);

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

/// A line, from its first to its second end: a cache line.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(crate) struct LinePrimitive {
    pub(crate) ends: [WindowVertex; 2],
    pub(crate) provoking: VertexRef,
    pub(crate) front: bool,
    /// The phase of the stipple pattern at the line's start, if there is a pattern: the number of
    /// fragments of its strip before the line, modulo the pattern's length; for rectangles in
    /// 1/65536 pixel.
    pub(crate) stipple: u32,
}

/// Sixteen lines, or halves of lines.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(crate) struct LinePacket {
    /// Of both ends: snapped positions in 1/256 pixel, depth, 1/w, references to varyings.
    pub(crate) x: [[i32; LANES]; 2],
    pub(crate) y: [[i32; LANES]; 2],
    pub(crate) z: [[f32; LANES]; 2],
    pub(crate) iw: [[f32; LANES]; 2],
    pub(crate) vertex: [[VertexRef; LANES]; 2],
    /// The vertex that flat varyings come from.
    pub(crate) provoking: [VertexRef; LANES],
    /// Bit by lane: it belongs to something that faces the viewer.
    pub(crate) front: u16,
    /// The lanes that are a half of a line, and of these the second halves.
    pub(crate) halves: u16,
    pub(crate) seconds: u16,
}

impl LinePacket {
    pub(crate) const EMPTY: Self = Self {
        x: [[0; LANES]; 2],
        y: [[0; LANES]; 2],
        z: [[0.0; LANES]; 2],
        iw: [[0.0; LANES]; 2],
        vertex: [[VertexRef(0); LANES]; 2],
        provoking: [VertexRef(0); LANES],
        front: 0,
        halves: 0,
        seconds: 0,
    };

    /// Sets a lane to a line, or to the half of it that has a number.
    #[inline(always)]
    pub(crate) fn set(&mut self, lane: usize, line: &LinePrimitive, half: Option<usize>) {
        for (number, end) in line.ends.iter().enumerate() {
            self.x[number][lane] = end.x;
            self.y[number][lane] = end.y;
            self.z[number][lane] = end.z;
            self.iw[number][lane] = end.iw;
            self.vertex[number][lane] = end.vertex;
        }
        self.provoking[lane] = line.provoking;
        let bit = 1 << lane;
        for (mask, is_in) in [
            (&mut self.front, line.front),
            (&mut self.halves, half.is_some()),
            (&mut self.seconds, half == Some(1)),
        ] {
            *mask = *mask & !bit | u16::from(is_in) << lane;
        }
    }
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
// of every draw.
const _: () = assert!(size_of::<TrianglePacket>() == 21 * 64);
