//! Set-up (R1, R5): sorts a triangle's vertices and makes its planes.
//!
//! *In* triangles that survive culling · *Out* [`TrianglePacket`]s, binned · *Space* window ·
//! *Precision* positions exact, planes f32 in the order of `docs/NUMERICS.md`.
//!
//! Triangles wait as vertex numbers until there are sixteen; then positions, depth and 1/w of their
//! vertices are read and the planes of all computed together. Those of several sub-draws wait
//! together if tiles rasterize these alike. Sorting by (y, x) first makes everything that follows
//! independent of the order in which a triangle's vertices were given.

use super::binning::bin_packet;
use super::cull::WindowTriangles;
use super::cull_uncovered::cull_uncovered;
use super::plan::GeometryPlan;
use super::rectangles::rectangles;
use super::run::RunWork;
use super::shaded_vertices::PackedVertex;
use super::vertex_order::{Order, sorted};
use super::waiting::{FRONT, Waiting, first_half};
use crate::bounds::chunk::{Chunk, number};
use crate::bounds::primitives::{VertexRef, WindowVertex};
use crate::bounds::transpose::components_of;
use crate::bounds::triangle_edges::TriangleEdges;
use estampe_simd::{
    Bytes, LANES, Lanes, Level, Select, SimdBase, bits_of, dispatch, f32x16, i32x16, outline,
    u32x16,
};

/// Memory of one worker.
#[derive(Debug, Default)]
pub(crate) struct SetupScratch {
    waiting: Waiting,
    /// The vertices that clipping made for the run at hand, in the window.
    clipped: Vec<PackedVertex>,
}

/// Fills packets with one sub-draw's triangles in a chunk, and bins them.
#[derive(Debug)]
pub(crate) struct Setup<'a> {
    level: Level,
    plan: &'a GeometryPlan,
    /// The vertices of the batch.
    window: &'a [PackedVertex],
    /// The varyings of the sub-draw's vertices, and how many scalars each has.
    varyings: &'a [f32],
    varying_scalars: usize,
    waiting: &'a mut Waiting,
    clipped: &'a mut Vec<PackedVertex>,
    /// The number of the first of `clipped` in the chunk.
    first_clipped: u32,
    pub(crate) chunk: &'a mut Chunk,
}

/// Sixteen triangles of known area.
pub(crate) struct SetupLanes<S: Lanes> {
    /// The sub-draw's vertices, in the order given.
    pub(crate) vertices: [u32x16<S>; 3],
    /// The number of the sub-draw's first vertex in the batch.
    pub(crate) first_vertex: u32x16<S>,
    /// In the order given, rounded; not 0.
    pub(crate) doubled_area: f32x16<S>,
}

impl SetupScratch {
    /// Triangles of the run at hand that are in no packet yet.
    pub(crate) fn waiting(&self) -> usize {
        self.waiting.len
    }
}

impl<'a> Setup<'a> {
    /// Set-up of a sub-draw, behind the triangles of the run that wait.
    pub(crate) fn new(
        work: &RunWork<'a>,
        chunk: &'a mut Chunk,
        scratch: &'a mut SetupScratch,
    ) -> Self {
        let SetupScratch { waiting, clipped } = scratch;
        let vertices = &work.vertices;
        clipped.clear();
        Self {
            level: work.level,
            plan: work.plan,
            window: vertices.of_group,
            varyings: vertices.varyings,
            varying_scalars: vertices.varying_scalars,
            waiting,
            clipped,
            first_clipped: chunk.align_clipped_varyings(vertices.varying_scalars),
            chunk,
        }
    }

    /// Adds a vertex made by clipping.
    pub(crate) fn push_clipped(&mut self, vertex: PackedVertex, varyings: &[f32]) -> VertexRef {
        let number = self.first_clipped + number(self.clipped.len());
        self.clipped.push(vertex);
        self.chunk.clipped_varyings.extend_from_slice(varyings);
        VertexRef(number | VertexRef::CLIPPED)
    }

    /// Adds the triangles of the lanes in `kept`, but for those that cover no sample. Returns which
    /// are left.
    #[inline(always)]
    pub(crate) fn push_lanes<S: Lanes>(
        &mut self,
        s: S,
        window: &WindowTriangles<S>,
        triangles: &SetupLanes<S>,
        kept: u16,
    ) -> u16 {
        outline!(s, {
            let area = triangles.doubled_area;
            let zero = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
            let provoking = triangles.vertices[0];
            let front = <u32x16<S> as SimdBase<S>>::splat(s, FRONT);
            let is_front = if self.plan.facing.clockwise_is_front {
                area.simd_gt(zero)
            } else {
                area.simd_lt(zero)
            };
            let provoking = is_front.select(provoking | front, provoking);

            let mut order = Order {
                x: window.x,
                y: window.y,
                vertex: triangles.vertices,
            };
            let first = order.exchange::<0, 1>(s);
            let second = order.exchange::<1, 2>(s);
            let third = order.exchange::<0, 1>(s);
            let odd = first ^ second ^ third;
            let mut kept = kept;
            if self.plan.samples_centers() {
                let uncovered = cull_uncovered(s, order.x, order.y, kept);
                kept &= !uncovered;
                self.chunk.statistics.primitives_culled += u64::from(uncovered.count_ones());
            }
            let area = odd.select(-area, area);
            let vertices = (order.vertex, triangles.first_vertex);
            self.waiting
                .append(s, vertices, provoking, area.bitcast(), kept);
            if self.waiting.len >= LANES {
                self.emit();
            }
            kept
        })
    }

    /// Adds one triangle of vertices made by clipping, in the order given, whose area is not 0.
    pub(crate) fn push(
        &mut self,
        vertices: &[WindowVertex; 3],
        provoking: u32,
        doubled_area: i64,
        is_front: bool,
    ) {
        let (order, odd) = sorted(vertices);
        let at = self.waiting.len;
        for (corner, from) in order.into_iter().enumerate() {
            self.waiting.vertex[corner][at] = vertices[from].vertex.0;
        }
        self.waiting.first_vertex[at] = 0;
        self.waiting.provoking[at] = provoking | if is_front { FRONT } else { 0 };
        let area = if odd { -doubled_area } else { doubled_area };
        // One rounding; the division is done for all sixteen.
        self.waiting.doubled_area[at] = area as f32;
        self.waiting.len += 1;
        if self.waiting.len >= LANES {
            self.emit();
        }
    }

    /// Sets up what waits, unless the next sub-draw is of the same run: then its triangles may
    /// share the packet.
    pub(crate) fn finish(mut self, joins_next: bool) {
        // Vertices made by clipping are known for one sub-draw.
        let may_wait = joins_next && self.clipped.is_empty();
        if self.waiting.len > 0 && !may_wait {
            self.emit();
        }
    }

    /// Sets up and bins the first packet of those that wait.
    fn emit(&mut self) {
        let len = self.waiting.len.min(LANES);
        dispatch!(self.level, s => self.set_up(s, len));
        self.chunk.statistics.primitives_binned += len as u64;
        self.waiting.drop_first(len);
    }

    /// Makes a packet of the first `len` triangles that wait.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "at most sixteen lanes")]
    fn set_up<S: Lanes>(&mut self, s: S, len: usize) {
        let waiting = &*self.waiting;
        let [v0, v1, v2] = [0, 1, 2].map(|corner| first_half(&waiting.vertex[corner]));
        let first = u32x16::load_array_ref(s, first_half(&waiting.first_vertex));
        let live = u16::MAX >> (LANES - len);
        if const { !S::IS_SCALAR } && self.plan.draws_one_by_one && self.plan.joins_rectangles {
            self.prefetch_varyings(s, [v0, v2]);
        }
        let [x0, y0, z0, w0] = self.read(s, v0, first, live);
        let [x1, y1, z1, w1] = self.read(s, v1, first, live);
        let [x2, y2, z2, w2] = self.read(s, v2, first, live);

        // The scalar level draws everything one by one, from packets.
        let takes_apart = const { !S::IS_SCALAR } && self.plan.draws_one_by_one;
        let packets = &mut self.chunk.triangles;
        let packet = match takes_apart {
            true => packets.push_passing(),
            false => packets.push_stale(),
        };
        // What is not read is not written: it would go to memory, and come from there before.
        let interpolates = const { S::IS_SCALAR } || self.plan.interpolates;
        let provoking = first_half(&waiting.provoking);
        if interpolates {
            for (corner, from) in [v0, v1, v2].into_iter().enumerate() {
                packet.vertex[corner] = from.map(VertexRef);
            }
            if takes_apart || self.plan.has_flat_varyings {
                packet.provoking.0 = provoking.map(|vertex| VertexRef(vertex & !FRONT));
            }
        }
        let provoking: i32x16<S> = u32x16::load_array_ref(s, provoking).bitcast();
        packet.front = s.sign_bits(provoking) & live;
        let area = f32x16::load_array_ref(s, first_half(&waiting.doubled_area));
        let zero = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
        packet.clockwise = s.bits_of_mask(area.simd_gt(zero)) & live;
        packet.len = len as u16;

        let [x0, x1, x2]: [i32x16<S>; 3] = [x0.bitcast(), x1.bitcast(), x2.bitcast()];
        let [y0, y1, y2]: [i32x16<S>; 3] = [y0.bitcast(), y1.bitcast(), y2.bitcast()];
        let [z0, z1, z2]: [f32x16<S>; 3] = [z0.bitcast(), z1.bitcast(), z2.bitcast()];
        x0.store_array(&mut packet.x[0]);
        x1.store_array(&mut packet.x[1]);
        x2.store_array(&mut packet.x[2]);
        y0.store_array(&mut packet.y[0]);
        y1.store_array(&mut packet.y[1]);
        y2.store_array(&mut packet.y[2]);
        if !takes_apart {
            let block = <i32x16<S> as SimdBase<S>>::splat(s, 16 << 8);
            let width = x0.max(x1).max(x2) - x0.min(x1).min(x2);
            packet.large = s.sign_bits((block - width) & (block - (y2 - y0)));
        }
        let edges = TriangleEdges::new(s, [&[x0, x1, x2], &[y0, y1, y2]], area);
        z0.store_array(&mut packet.z.origin);
        let [dx, dy] = edges.slopes(s, [z0, z1, z2]);
        dx.store_array(&mut packet.z.dx);
        dy.store_array(&mut packet.z.dy);
        if let Some(bias) = &self.plan.depth_bias {
            bias.apply(&mut packet.z, &[z1.to_array(), z2.to_array()]);
        }
        packet.equal_w = s.bits_of_mask(w0.simd_eq(w1) & w0.simd_eq(w2));
        let [w0, w1, w2]: [f32x16<S>; 3] = [w0.bitcast(), w1.bitcast(), w2.bitcast()];
        if interpolates {
            w0.store_array(&mut packet.iw_at[0]);
            w1.store_array(&mut packet.iw_at[1]);
            w2.store_array(&mut packet.iw_at[2]);
        }

        let mut pairs = 0;
        if takes_apart {
            if self.plan.joins_rectangles {
                pairs = self.rectangles_of_last(s);
            }
            self.chunk.take_apart_last(pairs);
        }
        if let (Some(next), false) = (self.chunk.triangles.upcoming(), takes_apart) {
            next.prefetch(s, interpolates);
        }
        let positions = [[x0, x1, x2], [y0, y1, y2]];
        bin_packet(s, self.plan, positions, pairs, self.chunk);
    }

    /// Prefetches the varyings that tell which triangles make rectangles: those of their first and
    /// their last vertices, which each other one is near.
    #[inline(always)]
    fn prefetch_varyings<S: Lanes>(&self, s: S, vertices: [&[u32; LANES]; 2]) {
        let scalars = <u32x16<S> as SimdBase<S>>::splat(s, number(self.varying_scalars));
        for vertices in vertices {
            let vertices = u32x16::load_array_ref(s, vertices);
            s.prefetch_elements(bits_of(self.varyings), vertices * scalars);
        }
    }

    /// The lanes of the last packet whose triangle makes a rectangle with the next one.
    #[inline(always)]
    fn rectangles_of_last<S: Lanes>(&self, s: S) -> u16 {
        let Some((packet, _)) = self.chunk.triangles.last() else {
            return 0;
        };
        let n = self.varying_scalars;
        let (shaded, clipped) = (self.varyings, self.chunk.clipped_varyings.as_slice());
        rectangles(s, packet, |vertex| {
            let (from, number) = match vertex.0 & VertexRef::CLIPPED {
                0 => (shaded, vertex.0),
                _ => (clipped, vertex.0 & !VertexRef::CLIPPED),
            };
            &from[number as usize * n..][..n]
        })
    }

    /// x, y, depth and 1/w of the vertices in the lanes `live`, as bits; their numbers count from
    /// `first` on. Other lanes hold vertices of triangles that waited before, perhaps of another
    /// run: any will do, or zeros.
    #[inline(always)]
    fn read<S: Lanes>(
        &self,
        s: S,
        vertices: &[u32; LANES],
        first: u32x16<S>,
        live: u16,
    ) -> [u32x16<S>; 4] {
        outline!(s, {
            let vertices = u32x16::load_array_ref(s, vertices) + first;
            let words = self.window.as_flattened();
            // References to vertices that clipping made are greater than any number in the group,
            // and products with four stay below 2³².
            let end = u32::try_from(words.len()).unwrap_or(0) / 4;
            let in_group = vertices.simd_lt(<u32x16<S> as SimdBase<S>>::splat(s, end));
            if s.bits_of_mask(in_group) & live == live {
                s.gather_four(words, vertices << 2)
            } else {
                components_of(s, &self.records_of(&vertices.to_array()))
            }
        })
    }

    /// Vertices of which clipping may have made some.
    #[inline(never)]
    fn records_of(&self, vertices: &[u32; LANES]) -> [&PackedVertex; LANES] {
        let mut records = [&[0; 4]; LANES];
        for (record, &vertex) in records.iter_mut().zip(vertices) {
            let found = if vertex & VertexRef::CLIPPED == 0 {
                self.window.get(vertex as usize)
            } else {
                let number = (vertex & !VertexRef::CLIPPED).wrapping_sub(self.first_clipped);
                self.clipped.get(number as usize)
            };
            if let Some(found) = found {
                *record = found;
            }
        }
        records
    }
}
