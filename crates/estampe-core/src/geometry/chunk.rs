//! One worker's share of geometry: primitives of an item, assembled, culled, clipped, set up, binned.

use super::assembly::{ElementSource, PrimitiveKind, kind_of};
use super::clip::{ClipPolygon, is_point_visible};
use super::cull::{CullState, Verdict, WindowTriangles, cull};
use super::setup::{BinState, Setup, SetupTriangle};
use super::shading::NEEDS_CLIPPING;
use super::viewport::{ViewportTransform, snap};
use crate::tiles::{Chunk, LinePrimitive, PointPrimitive, VertexRef, WindowVertex};
use estampe_simd::{LANES, Level, dispatch};
use estampe_types::state::PolygonMode;

/// The shaded vertices of one item.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ItemVertices<'a> {
    pub(crate) window: &'a [u32],
    pub(crate) depth: &'a [[f32; 2]],
    pub(crate) clip: &'a [[f32; 4]],
    pub(crate) varyings: &'a [f32],
    pub(crate) varying_scalars: usize,
    /// Empty where the shader sets no size.
    pub(crate) point_size: &'a [f32],
}

impl ItemVertices<'_> {
    fn varyings_of(&self, vertex: u32) -> &[f32] {
        &self.varyings[vertex as usize * self.varying_scalars..][..self.varying_scalars]
    }

    /// A vertex in the window, or `None` when it needs clipping.
    fn window_vertex(&self, vertex: u32) -> Option<WindowVertex> {
        let at = vertex as usize;
        let x = self.window[at * 2].cast_signed();
        let y = self.window[at * 2 + 1].cast_signed();
        let [z, iw] = self.depth[at];
        (x != NEEDS_CLIPPING).then_some(WindowVertex {
            x,
            y,
            z,
            iw,
            vertex: VertexRef(vertex),
        })
    }
}

/// What a chunk works on, and under which state.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChunkWork<'a> {
    pub(crate) elements: ElementSource<'a>,
    pub(crate) vertices: ItemVertices<'a>,
    pub(crate) transform: &'a ViewportTransform,
    pub(crate) cull: CullState,
    pub(crate) bins: BinState,
    pub(crate) polygon_mode: PolygonMode,
    /// Vertices and primitives of one instance.
    pub(crate) instance_vertices: u32,
    pub(crate) instance_primitives: u32,
    /// The primitives of this chunk, instances one after the other; half-open.
    pub(crate) primitives: [u32; 2],
}

/// Memory of one worker.
#[derive(Debug, Default)]
pub(crate) struct ChunkScratch {
    corners: [[u32; LANES]; 3],
    window: WindowTriangles,
    polygon: ClipPolygon,
    /// Clipped vertices in the window.
    clipped: Vec<WindowVertex>,
}

/// Processes a chunk.
pub(crate) fn process(
    level: Level,
    work: &ChunkWork<'_>,
    chunk: &mut Chunk,
    scratch: &mut ChunkScratch,
) {
    let [from, to] = work.primitives;
    chunk.statistics.primitives_in += u64::from(to - from);
    let kind = kind_of(work.elements.topology);
    let mut worker = Worker {
        level,
        work,
        setup: Setup::new(level, work.bins, chunk),
    };
    let mut next = from;
    while next < to {
        // A group never spans two instances.
        let (turn, local) = (
            next / work.instance_primitives,
            next % work.instance_primitives,
        );
        let left = (to - next).min(work.instance_primitives - local);
        let count = left.min(16) as usize;
        work.elements.assemble(local, count, &mut scratch.corners);
        if turn > 0 {
            let base = turn * work.instance_vertices;
            // Only the lanes in use: the others hold what is left of earlier groups.
            let used = scratch.corners.iter_mut().flat_map(|c| &mut c[..count]);
            used.for_each(|vertex| *vertex += base);
        }
        match (kind, work.polygon_mode) {
            (PrimitiveKind::Triangles, PolygonMode::Fill) => worker.triangles(count, scratch),
            (PrimitiveKind::Triangles, mode) => worker.outlines(count, mode, scratch),
            (PrimitiveKind::Lines, _) => worker.lines(count, scratch),
            (PrimitiveKind::Points, _) => worker.points(count, scratch),
        }
        next += u32::try_from(count).unwrap_or(16);
    }
    worker.setup.finish_packet();
    chunk.bins.sort();
}

struct Worker<'a, 'c> {
    level: Level,
    work: &'a ChunkWork<'a>,
    setup: Setup<'c>,
}

impl Worker<'_, '_> {
    fn triangles(&mut self, count: usize, scratch: &mut ChunkScratch) {
        let live = mask_of(count);
        let (state, window) = (&self.work.cull, self.work.vertices.window);
        let Verdict { small, large, clip } = dispatch!(self.level, s => cull(
            s, state, window, &scratch.corners, live, &mut scratch.window
        ));
        let mut rest = small | large | clip;
        self.setup.chunk().statistics.primitives_culled += u64::from((live & !rest).count_ones());
        while rest != 0 {
            let lane = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            let corners = [0, 1, 2].map(|corner| scratch.corners[corner][lane]);
            if clip >> lane & 1 == 1 {
                self.clip_triangle(corners, scratch);
                continue;
            }
            let area = i64::from(scratch.window.doubled_area[lane]);
            let vertices = [0, 1, 2].map(|corner| {
                let at = corners[corner] as usize;
                let [z, iw] = self.work.vertices.depth[at];
                let (x, y) = (
                    scratch.window.x[corner][lane],
                    scratch.window.y[corner][lane],
                );
                WindowVertex {
                    x,
                    y,
                    z,
                    iw,
                    vertex: VertexRef(corners[corner]),
                }
            });
            let area = if large >> lane & 1 == 1 {
                doubled_area(&vertices)
            } else {
                area
            };
            self.push(&vertices, vertices[0].vertex, area);
        }
    }

    /// Sets up a triangle of known area, unless it faces the wrong way.
    #[inline(always)]
    fn push(&mut self, vertices: &[WindowVertex; 3], provoking: VertexRef, doubled_area: i64) {
        let facing = self.work.cull.facing;
        if facing.drops(doubled_area) {
            self.setup.chunk().statistics.primitives_culled += 1;
            return;
        }
        let front = facing.is_front(doubled_area);
        let vertices = *vertices;
        self.setup.push(&SetupTriangle {
            vertices,
            provoking,
            doubled_area,
            front,
        });
    }

    fn clip_triangle(&mut self, corners: [u32; 3], scratch: &mut ChunkScratch) {
        self.setup.chunk().statistics.primitives_clipped += 1;
        if !self.clip(&corners, scratch) {
            return;
        }
        for last in 2..scratch.clipped.len() {
            let fan = [
                scratch.clipped[0],
                scratch.clipped[last - 1],
                scratch.clipped[last],
            ];
            if fan.iter().all(|vertex| vertex.vertex != DROPPED) && self.is_on_target(&fan) {
                self.push(&fan, VertexRef(corners[0]), doubled_area(&fan));
            }
        }
    }

    /// Whether a triangle's box touches the rectangle of pixels; the wide path tests the same.
    fn is_on_target(&self, vertices: &[WindowVertex; 3]) -> bool {
        let rect = self.work.cull.rect;
        let [first, last] = self.work.cull.sample_range;
        let span = |of: fn(&WindowVertex) -> i32, low: i32, high: i32| {
            let [a, b, c] = [of(&vertices[0]), of(&vertices[1]), of(&vertices[2])];
            let from = (a.min(b).min(c) - last + 255) >> 8;
            let to = (a.max(b).max(c) - first) >> 8;
            from <= to && to >= low && from < high
        };
        span(|v| v.x, rect.x0, rect.x1) && span(|v| v.y, rect.y0, rect.y1)
    }

    /// Clips a polygon or line into `scratch.clipped`; false when nothing is left.
    fn clip(&mut self, corners: &[u32], scratch: &mut ChunkScratch) -> bool {
        let vertices = &self.work.vertices;
        scratch.polygon.begin(vertices.varying_scalars);
        for &corner in corners {
            scratch
                .polygon
                .push(vertices.clip[corner as usize], vertices.varyings_of(corner));
        }
        scratch.clipped.clear();
        if !scratch.polygon.clip(self.work.transform) {
            return false;
        }
        for vertex in scratch.polygon.vertices() {
            let projected = self
                .work
                .transform
                .project([vertex[0], vertex[1], vertex[2], vertex[3]]);
            let usable = vertex[3] > 0.0 && projected.iw.is_finite();
            let chunk = self.setup.chunk();
            // A chunk's clipped vertices are few: 4096 primitives of at most nine.
            let number = chunk.clipped_varyings.len() / vertices.varying_scalars.max(1);
            let number = u32::try_from(number).unwrap_or(u32::MAX);
            chunk.clipped_varyings.extend_from_slice(&vertex[4..]);
            scratch.clipped.push(WindowVertex {
                x: snap(projected.x),
                y: snap(projected.y),
                z: projected.z,
                iw: projected.iw,
                vertex: if usable {
                    VertexRef(number | VertexRef::CLIPPED)
                } else {
                    DROPPED
                },
            });
        }
        true
    }

    fn lines(&mut self, count: usize, scratch: &mut ChunkScratch) {
        for lane in 0..count {
            let ends = [scratch.corners[0][lane], scratch.corners[1][lane]];
            self.line(ends, VertexRef(ends[0]), true, scratch);
        }
    }

    fn line(
        &mut self,
        corners: [u32; 2],
        provoking: VertexRef,
        front: bool,
        scratch: &mut ChunkScratch,
    ) {
        let vertices = &self.work.vertices;
        let ends = corners.map(|corner| vertices.window_vertex(corner));
        if let [Some(a), Some(b)] = ends {
            self.setup.push_line(LinePrimitive {
                ends: [a, b],
                provoking,
                front,
            });
            return;
        }
        self.setup.chunk().statistics.primitives_clipped += 1;
        if self.clip(&corners, scratch)
            && let [a, b] = scratch.clipped[..]
            && a.vertex != DROPPED
            && b.vertex != DROPPED
        {
            self.setup.push_line(LinePrimitive {
                ends: [a, b],
                provoking,
                front,
            });
        }
    }

    fn points(&mut self, count: usize, scratch: &ChunkScratch) {
        for lane in 0..count {
            let vertex = scratch.corners[0][lane];
            self.point(vertex, VertexRef(vertex), true);
        }
    }

    fn point(&mut self, vertex: u32, provoking: VertexRef, front: bool) {
        let vertices = &self.work.vertices;
        if !is_point_visible(vertices.clip[vertex as usize]) {
            self.setup.chunk().statistics.primitives_clipped += 1;
            return;
        }
        let Some(center) = vertices.window_vertex(vertex) else {
            return;
        };
        let size = vertices
            .point_size
            .get(vertex as usize)
            .copied()
            .unwrap_or(1.0);
        self.setup.push_point(PointPrimitive {
            center,
            provoking,
            half: half_size(size),
            front,
        });
    }

    /// Triangles as their edges or vertices (A5).
    fn outlines(&mut self, count: usize, mode: PolygonMode, scratch: &mut ChunkScratch) {
        for lane in 0..count {
            let corners = [0, 1, 2].map(|corner| scratch.corners[corner][lane]);
            let area = self.area_of(corners, scratch);
            if self.work.cull.facing.drops(area) {
                self.setup.chunk().statistics.primitives_culled += 1;
                continue;
            }
            let front = self.work.cull.facing.is_front(area);
            let [a, b, c] = corners;
            if mode == PolygonMode::Line {
                for edge in [[a, b], [b, c], [c, a]] {
                    self.line(edge, VertexRef(a), front, scratch);
                }
            } else {
                corners
                    .into_iter()
                    .for_each(|corner| self.point(corner, VertexRef(a), front));
            }
        }
    }

    /// The doubled area of a triangle, clipped if it must be: of the first piece that has any.
    fn area_of(&mut self, corners: [u32; 3], scratch: &mut ChunkScratch) -> i64 {
        let vertices = &self.work.vertices;
        let whole = corners.map(|corner| vertices.window_vertex(corner));
        if let [Some(a), Some(b), Some(c)] = whole {
            return doubled_area(&[a, b, c]);
        }
        if !self.clip(&corners, scratch) {
            return 0;
        }
        let fan = |last| {
            [
                scratch.clipped[0],
                scratch.clipped[last - 1],
                scratch.clipped[last],
            ]
        };
        (2..scratch.clipped.len())
            .map(fan)
            .filter(|fan| fan.iter().all(|vertex| vertex.vertex != DROPPED))
            .map(|fan| doubled_area(&fan))
            .find(|area| *area != 0)
            .unwrap_or(0)
    }
}

/// A clipped vertex that has no place in the window.
const DROPPED: VertexRef = VertexRef(u32::MAX);

/// The lowest `count` of sixteen bits.
fn mask_of(count: usize) -> u16 {
    if count >= LANES {
        u16::MAX
    } else {
        (1 << count) - 1
    }
}

/// Twice the signed area in 1/256 pixel²; positive is clockwise as seen, y pointing down. Exact:
/// differences are below 2²⁴.
fn doubled_area([a, b, c]: &[WindowVertex; 3]) -> i64 {
    let x = |v: &WindowVertex| i64::from(v.x);
    let y = |v: &WindowVertex| i64::from(v.y);
    (x(b) - x(a)) * (y(c) - y(a)) - (x(c) - x(a)) * (y(b) - y(a))
}

/// Half a point's side in 1/256 pixel, half to even; sizes are 1 to 1024 pixels, NaN is 1.
#[expect(clippy::cast_possible_truncation, reason = "at most 131072")]
fn half_size(pixels: f32) -> i32 {
    let pixels = if pixels >= 1.0 {
        pixels.min(1024.0)
    } else {
        1.0
    };
    (pixels * 128.0).round_ties_even() as i32
}
