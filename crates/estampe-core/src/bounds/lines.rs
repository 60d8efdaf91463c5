//! Lines that geometry has set up, in packets of sixteen.
//!
//! The sixteen lines of a packet are assembled one after the other, so that most lie in one tile or
//! two: they are binned together, and a tile reads eleven cache lines for all of them.

use super::packets::StalePackets;
use super::primitives::{FlatVertices, VertexRef, WindowVertex};
use super::slabs::{Expected, SharedSlabs, Slabs};
use estampe_simd::{Bytes, LANES, Lane, Lanes, Select, SimdBase, f32x16, i32x16, u32x16};

/// A line, from its first to its second end.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct LinePrimitive {
    pub(crate) ends: [WindowVertex; 2],
    pub(crate) provoking: VertexRef,
    pub(crate) front: bool,
    /// The phase of the stipple pattern at the line's start, if there is a pattern: the number of
    /// fragments of its strip before the line, modulo the pattern's length; for rectangles in
    /// 1/65536 pixel.
    pub(crate) stipple: u32,
}

/// Up to sixteen lines, or halves of lines.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(crate) struct LinePacket {
    /// Of both ends: snapped positions in 1/256 pixel, depth, 1/w, references to varyings.
    pub(crate) x: [[i32; LANES]; 2],
    pub(crate) y: [[i32; LANES]; 2],
    pub(crate) z: [[f32; LANES]; 2],
    pub(crate) iw: [[f32; LANES]; 2],
    pub(crate) vertex: [[VertexRef; LANES]; 2],
    /// Bit by lane: it belongs to something that faces the viewer.
    pub(crate) front: u16,
    /// The vertex that flat varyings come from; anything where none is flat.
    pub(crate) provoking: FlatVertices,
    /// See [`LinePrimitive::stipple`]; anything where there is no pattern.
    stipple: [u32; LANES],
}

impl Default for LinePacket {
    fn default() -> Self {
        Self {
            x: [[0; LANES]; 2],
            y: [[0; LANES]; 2],
            z: [[0.0; LANES]; 2],
            iw: [[0.0; LANES]; 2],
            vertex: [[VertexRef(0); LANES]; 2],
            front: 0,
            provoking: FlatVertices([VertexRef(0); LANES]),
            stipple: [0; LANES],
        }
    }
}

impl LinePacket {
    /// The line in a lane.
    #[inline(always)]
    pub(crate) fn line(&self, lane: Lane) -> LinePrimitive {
        let end = |number: usize| WindowVertex {
            x: lane.of(&self.x[number]),
            y: lane.of(&self.y[number]),
            z: lane.of(&self.z[number]),
            iw: lane.of(&self.iw[number]),
            vertex: lane.of(&self.vertex[number]),
        };
        LinePrimitive {
            ends: [end(0), end(1)],
            provoking: lane.of(&self.provoking.0),
            front: lane.is_in(self.front),
            stipple: lane.of(&self.stipple),
        }
    }

    /// Sets a lane to a line.
    #[inline(always)]
    pub(crate) fn set(&mut self, lane: Lane, line: &LinePrimitive) {
        for (number, end) in line.ends.iter().enumerate() {
            *lane.of_mut(&mut self.x[number]) = end.x;
            *lane.of_mut(&mut self.y[number]) = end.y;
            *lane.of_mut(&mut self.z[number]) = end.z;
            *lane.of_mut(&mut self.iw[number]) = end.iw;
            *lane.of_mut(&mut self.vertex[number]) = end.vertex;
        }
        self.front &= !lane.bit();
        self.front |= if line.front { lane.bit() } else { 0 };
        *lane.of_mut(&mut self.provoking.0) = line.provoking;
        *lane.of_mut(&mut self.stipple) = line.stipple;
    }

    /// Sets some lanes to lines of a packet without pattern: each to that in the lane that `from`
    /// names.
    #[inline(always)]
    pub(crate) fn set_lanes<S: Lanes>(
        &mut self,
        s: S,
        lanes: u16,
        (packet, from): (&Self, u32x16<S>),
        has_flat_varyings: bool,
    ) {
        let is_set = s.mask_from_bits(lanes);
        for end in 0..2 {
            for (to, of) in [
                (&mut self.x[end], &packet.x[end]),
                (&mut self.y[end], &packet.y[end]),
            ] {
                let words = i32x16::load_array_ref(s, of).bitcast();
                let words: i32x16<S> = s.permute(words, from).bitcast();
                let kept = i32x16::load_array_ref(s, to);
                is_set.select(words, kept).store_array(to);
            }
            for (to, of) in [
                (&mut self.z[end], &packet.z[end]),
                (&mut self.iw[end], &packet.iw[end]),
            ] {
                let values = s.permute_f32(f32x16::load_array_ref(s, of), from);
                s.replace_f32(to, lanes, values);
            }
            set_vertices(s, &mut self.vertex[end], &packet.vertex[end], (lanes, from));
        }
        if has_flat_varyings {
            let (to, of) = (&mut self.provoking.0, &packet.provoking.0);
            set_vertices(s, to, of, (lanes, from));
        }
        // Lines of a run face alike, unless they outline triangles.
        let front = match packet.front {
            0 => 0,
            u16::MAX => lanes,
            front => {
                let bits = <u32x16<S> as SimdBase<S>>::splat(s, u32::from(front));
                let one = <u32x16<S> as SimdBase<S>>::splat(s, 1);
                let is_front = ((bits >> from) & one).simd_eq(one);
                s.bits_of_mask(is_front) & lanes
            }
        };
        self.front = self.front & !lanes | front;
    }
}

/// Sets some lanes to the vertices in the lanes that `from` names.
#[inline(always)]
fn set_vertices<S: Lanes>(
    s: S,
    to: &mut [VertexRef; LANES],
    of: &[VertexRef; LANES],
    (lanes, from): (u16, u32x16<S>),
) {
    let load = |vertices: &[VertexRef; LANES]| u32x16::load_array(s, vertices.map(|of| of.0));
    let vertices = s.permute(load(of), from);
    let kept = load(to);
    let set = s.mask_from_bits(lanes).select(vertices, kept);
    *to = set.to_array().map(VertexRef);
}

/// The packets of a chunk's lines.
#[derive(Debug)]
pub(crate) struct LinePackets {
    packets: StalePackets<LinePacket>,
    /// The lanes in use of the last packet, if lines are added to it one by one.
    used: usize,
}

impl Default for LinePackets {
    fn default() -> Self {
        Self {
            packets: StalePackets::default(),
            used: LANES,
        }
    }
}

impl LinePackets {
    /// Adds a packet whose contents are stale: the caller writes what is read.
    #[inline(always)]
    pub(crate) fn push(&mut self) -> &mut LinePacket {
        self.used = LANES;
        self.packets.push()
    }

    /// Removes the last packet.
    pub(crate) fn pop(&mut self) {
        self.packets.pop();
    }

    /// Adds a line behind the last one of its run that was added so; gives its lane in the last
    /// packet.
    pub(crate) fn push_line(&mut self, line: &LinePrimitive) -> Lane {
        let is_open = self.used < LANES;
        let lane = if is_open { self.used } else { 0 };
        self.used = lane + 1;
        let lane = Lane::new(lane);
        let packet = match self.packets.last_mut() {
            Some(packet) if is_open => packet,
            _ => self.packets.push(),
        };
        packet.set(lane, line);
        lane
    }

    /// The next line is of another run, which shares no packet with this one.
    pub(super) fn end_run(&mut self) {
        self.used = LANES;
    }

    /// The last packet.
    #[inline(always)]
    pub(crate) fn last_mut(&mut self) -> Option<&mut LinePacket> {
        self.packets.last_mut()
    }

    /// See [`StalePackets::open`].
    pub(crate) fn open(&mut self, slabs: &SharedSlabs<LinePacket>, expected: Expected) {
        self.packets.open(slabs, expected);
        self.used = LANES;
    }

    /// See [`StalePackets::close`].
    pub(crate) fn close(&mut self, slabs: &SharedSlabs<LinePacket>) {
        self.packets.close(slabs);
    }

    /// The number of packets.
    #[inline(always)]
    pub(crate) fn len(&self) -> usize {
        self.packets.len()
    }

    /// See [`StalePackets::packets`].
    #[inline(always)]
    pub(crate) fn packets<'s>(&self, slabs: &'s Slabs<LinePacket>) -> &'s [LinePacket] {
        self.packets.packets(slabs)
    }
}
