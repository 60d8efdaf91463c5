//! One worker's share of geometry: primitives of an item, assembled, culled, clipped, set up, binned.

use super::assembly::{ElementSource, PrimitiveKind, kind_of};
use super::binning::BinState;
use super::clip::{ClipPolygon, is_point_visible};
use super::cull::{CullState, TriangleGroup, WindowTriangles, cull};
use super::depth_bias::DepthBias;
use super::line_style::LineRun;
use super::positions::PositionCache;
use super::setup::{Setup, SetupLanes, sorted};
use super::shading::{NEEDS_CLIPPING, VertexSource, WindowRow};
use super::viewport::{ViewportTransform, snap};
use crate::pipeline::RenderPipeline;
use crate::tiles::{Chunk, LinePrimitive, PointPrimitive, VertexRef, WindowVertex};
use estampe_simd::{LANES, Lanes, Level, SimdBase, SimdCvtFloat, dispatch, f32x16, u32x16};
use estampe_types::shader::MAX_DISTANCES;
use estampe_types::state::PolygonMode;

/// The shaded vertices of one item.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ItemVertices<'a> {
    pub(crate) window: &'a [WindowRow],
    /// Empty where clip-space positions are not kept.
    pub(crate) clip: &'a [[u32; 4]],
    pub(crate) varyings: &'a [f32],
    pub(crate) varying_scalars: usize,
    /// Empty where the shader sets no size.
    pub(crate) point_size: &'a [f32],
}

impl ItemVertices<'_> {
    fn varyings_of(&self, vertex: u32) -> &[f32] {
        &self.varyings[vertex as usize * self.varying_scalars..][..self.varying_scalars]
    }

    /// A vertex's clip-space position, if they are kept.
    fn clip_position(&self, vertex: u32) -> Option<[f32; 4]> {
        let position = self.clip.get(vertex as usize)?;
        Some(position.map(f32::from_bits))
    }

    /// A vertex in the window, or `None` when it needs clipping.
    fn window_vertex(&self, vertex: u32) -> Option<WindowVertex> {
        let [x, y, z, iw] = self.window[vertex as usize];
        let (x, y) = (x.cast_signed(), y.cast_signed());
        (x != NEEDS_CLIPPING).then_some(WindowVertex {
            x,
            y,
            z: f32::from_bits(z),
            iw: f32::from_bits(iw),
            vertex: VertexRef(vertex),
        })
    }
}

/// What a chunk works on, and under which state.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChunkWork<'a> {
    pub(crate) elements: ElementSource<'a>,
    pub(crate) vertices: ItemVertices<'a>,
    /// Where the vertices came from.
    pub(crate) source: &'a VertexSource<'a>,
    pub(crate) pipeline: &'a RenderPipeline,
    pub(crate) transform: &'a ViewportTransform,
    pub(crate) cull: CullState,
    pub(crate) bins: BinState,
    pub(crate) polygon_mode: PolygonMode,
    pub(crate) depth_bias: Option<DepthBias>,
    /// How lines are drawn, and where one in a strip follows the one before.
    pub(crate) lines: LineRun<'a>,
    /// Vertices and primitives of one instance.
    pub(crate) instance_vertices: u32,
    pub(crate) instance_primitives: u32,
    /// The primitives of this chunk, instances one after the other; half-open.
    pub(crate) primitives: [u32; 2],
}

/// Memory of one worker.
#[derive(Debug, Default)]
pub(crate) struct ChunkScratch {
    groups: [TriangleGroup; 2],
    polygon: ClipPolygon,
    /// Clipped vertices in the window: of the polygon at hand, and all of the chunk's.
    clipped: Vec<WindowVertex>,
    clipped_rows: Vec<WindowRow>,
    clip_positions: PositionCache,
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
    scratch.clipped_rows.clear();
    scratch.clip_positions.clear();
    let rows = std::mem::take(&mut scratch.clipped_rows);
    let state = (work.bins, work.depth_bias);
    let setup = Setup::new(level, state, work.vertices.window, chunk, rows);
    let mut worker = Worker {
        level,
        work,
        setup,
        stipple: 0,
    };
    match (kind_of(work.elements.topology), work.polygon_mode) {
        (PrimitiveKind::Triangles, PolygonMode::Fill) => {
            dispatch!(level, s => worker.fill(s, scratch));
        }
        (kind, mode) => {
            let mut groups = Groups::new(work);
            let mut corners = [[0; 3]; LANES];
            loop {
                let first = groups.local;
                let Some(count) = groups.next(work, &mut corners) else {
                    break;
                };
                let corners = &corners[..count];
                match kind {
                    PrimitiveKind::Triangles => worker.outlines(corners, mode, scratch),
                    PrimitiveKind::Lines => worker.lines(first, corners, scratch),
                    PrimitiveKind::Points => worker.points(corners, scratch),
                }
            }
        }
    }
    scratch.clipped_rows = worker.setup.finish();
    chunk.bins.sort();
}

/// The primitives of a chunk, sixteen at a time; a group never spans two instances.
struct Groups {
    /// The primitive, counted in its instance, and that instance's first vertex.
    local: u32,
    base: u32,
    left: u32,
}

impl Groups {
    fn new(work: &ChunkWork<'_>) -> Self {
        let [from, to] = work.primitives;
        Self {
            local: from % work.instance_primitives,
            base: from / work.instance_primitives * work.instance_vertices,
            left: to - from,
        }
    }

    /// Assembles the next group, and says how many primitives it has; at the end none.
    #[inline(always)]
    fn next(&mut self, work: &ChunkWork<'_>, out: &mut [[u32; 3]; LANES]) -> Option<usize> {
        if self.left == 0 {
            return None;
        }
        let count = self.left.min(work.instance_primitives - self.local).min(16);
        work.elements
            .assemble(self.local, count as usize, self.base, out);
        self.left -= count;
        self.local += count;
        if self.local == work.instance_primitives {
            self.local = 0;
            self.base = self.base.wrapping_add(work.instance_vertices);
        }
        Some(count as usize)
    }
}

struct Worker<'a, 'c> {
    level: Level,
    work: &'a ChunkWork<'a>,
    setup: Setup<'c>,
    /// How many fragments of a stippled strip lie behind.
    stipple: u32,
}

/// What a line or point has besides its vertices: that of the triangle which it outlines, or its own.
#[derive(Debug, Clone, Copy)]
struct Outline {
    /// The vertex that flat varyings come from.
    provoking: VertexRef,
    front: bool,
    /// What is added to its depth.
    bias: Option<f32>,
}

impl Outline {
    fn own(provoking: u32) -> Self {
        Self {
            provoking: VertexRef(provoking),
            front: true,
            bias: None,
        }
    }

    /// A vertex with the depth that it has in this outline.
    fn moved(&self, vertex: WindowVertex) -> WindowVertex {
        match self.bias {
            Some(bias) => WindowVertex {
                z: vertex.z + bias,
                ..vertex
            },
            None => vertex,
        }
    }
}

impl Worker<'_, '_> {
    /// Filled triangles: culled and put in order sixteen at a time. In a closed mesh most groups end here,
    /// all facing away.
    #[inline(always)]
    fn fill<S: Lanes>(&mut self, s: S, scratch: &mut ChunkScratch) {
        let (work, facing) = (self.work, self.work.cull.facing);
        let mut groups = Groups::new(work);
        let mut culled = 0;
        let window = work.vertices.window;
        let mut memory = std::mem::take(&mut scratch.groups);
        let [mut group, mut ahead] = memory.each_mut();
        let mut coming = groups.next(work, &mut ahead.vertices);
        if coming.is_some() {
            ahead.read_positions(window);
        }
        // One group's positions are read before the last one is judged: vectors cannot be loaded from what was
        // just stored lane by lane, and meanwhile there is something to do.
        while let Some(count) = coming {
            std::mem::swap(&mut group, &mut ahead);
            coming = groups.next(work, &mut ahead.vertices);
            if coming.is_some() {
                ahead.read_positions(window);
            }
            let live = u16::MAX >> (LANES - count);
            let triangles = WindowTriangles::new(s, group);
            let (verdict, area) = cull(s, &work.cull, &triangles, live);
            let mut kept = verdict.small;
            let mut area = f32x16::float_from(area);
            if verdict.large != 0 {
                let mut areas = area.to_array();
                let mut rest = verdict.large;
                while rest != 0 {
                    let lane = rest.trailing_zeros() as usize;
                    rest &= rest - 1;
                    let exact = triangles.doubled_area(lane);
                    // One rounding.
                    areas[lane] = exact as f32;
                    kept |= u16::from(!facing.drops(exact)) << lane;
                }
                area = f32x16::load_array(s, areas);
            }
            culled += (live & !(kept | verdict.clip)).count_ones();
            if kept | verdict.clip == 0 {
                continue;
            }
            let mut vertices = [<u32x16<S> as SimdBase<S>>::splat(s, 0); 3];
            for (corner, vertices) in vertices.iter_mut().enumerate() {
                let mut lanes = [0; LANES];
                for (lane, to) in lanes.iter_mut().enumerate() {
                    *to = group.vertices[lane][corner];
                }
                *vertices = u32x16::load_array(s, lanes);
            }
            let lanes = SetupLanes {
                vertices,
                doubled_area: area,
            };
            let front = facing.clockwise_is_front;
            // Those between two that need clipping keep their place in the order.
            let mut clip = verdict.clip;
            while clip != 0 {
                let lane = clip.trailing_zeros() as usize;
                clip &= clip - 1;
                let before = kept & ((1 << lane) - 1);
                kept &= !before;
                if before != 0 {
                    self.setup.push_lanes(s, &triangles, &lanes, front, before);
                }
                self.clip_triangle(group.vertices[lane], scratch);
            }
            if kept != 0 {
                self.setup.push_lanes(s, &triangles, &lanes, front, kept);
            }
        }
        scratch.groups = memory;
        self.setup.chunk().statistics.primitives_culled += u64::from(culled);
    }

    /// Sets up a triangle of known area, unless it faces the wrong way.
    fn push(&mut self, vertices: &[WindowVertex; 3], provoking: u32, doubled_area: i64) {
        let facing = self.work.cull.facing;
        if facing.drops(doubled_area) {
            self.setup.chunk().statistics.primitives_culled += 1;
            return;
        }
        let front = facing.is_front(doubled_area);
        self.setup.push(vertices, provoking, doubled_area, front);
    }

    #[inline(never)]
    fn clip_triangle(&mut self, corners: [u32; 3], scratch: &mut ChunkScratch) {
        self.setup.chunk().statistics.primitives_clipped += 1;
        if self.is_distant(&corners, scratch) || !self.clip(&corners, scratch) {
            return;
        }
        for last in 2..scratch.clipped.len() {
            let fan = [
                scratch.clipped[0],
                scratch.clipped[last - 1],
                scratch.clipped[last],
            ];
            if fan.iter().all(|vertex| vertex.vertex != DROPPED) && self.is_on_target(&fan) {
                self.push(&fan, corners[0], doubled_area(&fan));
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

    /// Whether all of some vertices are negative in one cull distance.
    fn is_distant(&self, corners: &[u32], scratch: &mut ChunkScratch) -> bool {
        let interface = self.work.pipeline.interface();
        let first = interface.clip_distances;
        // A bit for each; a pipeline has at most eight.
        let mut negative = (1u32 << interface.cull_distances.min(MAX_DISTANCES)) - 1;
        for &corner in corners {
            if negative == 0 {
                break;
            }
            self.position_of(corner, scratch);
            let distances = scratch
                .clip_positions
                .distances_of(self.work.pipeline, corner);
            let mut of_corner = 0;
            for (bit, distance) in distances.skip(first).enumerate() {
                of_corner |= u32::from(distance < 0.0) << bit;
            }
            negative &= of_corner;
        }
        negative != 0
    }

    /// A vertex's clip-space position, computed again; its distances are then at hand, too.
    fn position_of(&self, vertex: u32, scratch: &mut ChunkScratch) -> [f32; 4] {
        let (pipeline, source) = (self.work.pipeline, self.work.source);
        let positions = &mut scratch.clip_positions;
        positions.position_of(self.level, pipeline, source, vertex)
    }

    /// Clips a polygon or line into `scratch.clipped`; false when nothing is left.
    fn clip(&mut self, corners: &[u32], scratch: &mut ChunkScratch) -> bool {
        let vertices = &self.work.vertices;
        let pipeline = self.work.pipeline;
        let distances = pipeline.interface().clip_distances;
        let varying_scalars = vertices.varying_scalars;
        scratch.polygon.begin(varying_scalars, distances);
        for &corner in corners {
            let position = match vertices.clip_position(corner) {
                Some(position) if distances == 0 => position,
                _ => self.position_of(corner, scratch),
            };
            let distances = scratch
                .clip_positions
                .distances_of(pipeline, corner)
                .take(distances);
            scratch
                .polygon
                .push(position, vertices.varyings_of(corner), distances);
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
            let (x, y) = (snap(projected.x), snap(projected.y));
            let (z, iw) = (projected.z, projected.iw);
            let row = [
                x.cast_unsigned(),
                y.cast_unsigned(),
                z.to_bits(),
                iw.to_bits(),
            ];
            let made = self.setup.push_clipped(row);
            let varyings = &mut self.setup.chunk().clipped_varyings;
            varyings.extend_from_slice(&vertex[4..4 + varying_scalars]);
            let vertex = if usable { made } else { DROPPED };
            scratch.clipped.push(WindowVertex {
                x,
                y,
                z,
                iw,
                vertex,
            });
        }
        true
    }

    /// Lines of which the first one is this of its instance.
    fn lines(&mut self, first: u32, lines: &[[u32; 3]], scratch: &mut ChunkScratch) {
        for (number, &[a, b, provoking]) in (first..).zip(lines) {
            if self.work.lines.begins(number) {
                self.stipple = 0;
            }
            if !self.is_distant(&[a, b], scratch) {
                self.line([a, b], Outline::own(provoking), scratch);
            }
        }
    }

    fn line(&mut self, corners: [u32; 2], outline: Outline, scratch: &mut ChunkScratch) {
        let vertices = &self.work.vertices;
        let ends = corners.map(|corner| vertices.window_vertex(corner));
        if let [Some(a), Some(b)] = ends {
            self.push_line([a, b], outline);
            return;
        }
        self.setup.chunk().statistics.primitives_clipped += 1;
        if self.clip(&corners, scratch)
            && let [a, b] = scratch.clipped[..]
            && a.vertex != DROPPED
            && b.vertex != DROPPED
        {
            self.push_line([a, b], outline);
        }
    }

    fn push_line(&mut self, ends: [WindowVertex; 2], outline: Outline) {
        let line = LinePrimitive {
            ends: ends.map(|end| outline.moved(end)),
            provoking: outline.provoking,
            front: outline.front,
            stipple: self.stipple,
        };
        let style = &self.work.lines.style;
        if style.stipple.is_some() {
            self.stipple = self.stipple.wrapping_add(style.fragments(&line));
        }
        self.setup.push_line(line, style);
    }

    fn points(&mut self, points: &[[u32; 3]], scratch: &mut ChunkScratch) {
        for &[vertex, ..] in points {
            if !self.is_distant(&[vertex], scratch) {
                self.point(vertex, Outline::own(vertex), scratch);
            }
        }
    }

    fn point(&mut self, vertex: u32, outline: Outline, scratch: &mut ChunkScratch) {
        let vertices = &self.work.vertices;
        let is_visible = |position| is_point_visible(self.work.transform, position);
        if !vertices.clip_position(vertex).is_some_and(is_visible) {
            self.setup.chunk().statistics.primitives_clipped += 1;
            return;
        }
        let center = vertices.window_vertex(vertex);
        let Some(center) = center.or_else(|| self.undistant_center(vertex, scratch)) else {
            return;
        };
        let size = vertices
            .point_size
            .get(vertex as usize)
            .copied()
            .unwrap_or(1.0);
        self.setup.push_point(PointPrimitive {
            center: outline.moved(center),
            provoking: outline.provoking,
            half: half_size(size),
            front: outline.front,
        });
    }

    /// A visible point's place where a cull distance, which concerns the triangle that it is a corner of, is
    /// negative; none where a clip distance is.
    fn undistant_center(&self, vertex: u32, scratch: &mut ChunkScratch) -> Option<WindowVertex> {
        let interface = self.work.pipeline.interface();
        if interface.cull_distances == 0 {
            return None;
        }
        let position = self.position_of(vertex, scratch);
        let distances = scratch
            .clip_positions
            .distances_of(self.work.pipeline, vertex);
        let mut clip = distances.take(interface.clip_distances);
        let is_inside = clip.all(|distance| (0.0..f32::INFINITY).contains(&distance))
            && position.iter().all(|component| component.is_finite());
        let at = self.work.transform.project(position);
        (is_inside && at.iw.is_finite()).then_some(WindowVertex {
            x: snap(at.x),
            y: snap(at.y),
            z: at.z,
            iw: at.iw,
            vertex: VertexRef(vertex),
        })
    }

    /// Triangles as their edges or vertices (A5).
    fn outlines(&mut self, triangles: &[[u32; 3]], mode: PolygonMode, scratch: &mut ChunkScratch) {
        for &corners in triangles {
            let piece = self.first_piece(corners, scratch);
            let area = piece.map_or(0, |piece| doubled_area(&piece));
            if self.work.cull.facing.drops(area) {
                self.setup.chunk().statistics.primitives_culled += 1;
                continue;
            }
            let bias = self.work.depth_bias.zip(piece).map(|(bias, piece)| {
                let (order, odd) = sorted(&piece);
                let area = if odd { -area } else { area };
                bias.of_triangle(order.map(|from| piece[from]), area)
            });
            let [a, b, c] = corners;
            let outline = Outline {
                provoking: VertexRef(a),
                front: self.work.cull.facing.is_front(area),
                bias,
            };
            self.stipple = 0;
            if mode == PolygonMode::Line {
                for edge in [[a, b], [b, c], [c, a]] {
                    self.line(edge, outline, scratch);
                }
            } else {
                for corner in corners {
                    self.point(corner, outline, scratch);
                }
            }
        }
    }

    /// A triangle in the window; the first piece with an area if it must be clipped.
    fn first_piece(
        &mut self,
        corners: [u32; 3],
        scratch: &mut ChunkScratch,
    ) -> Option<[WindowVertex; 3]> {
        let vertices = &self.work.vertices;
        let whole = corners.map(|corner| vertices.window_vertex(corner));
        if let [Some(a), Some(b), Some(c)] = whole {
            return Some([a, b, c]);
        }
        if self.is_distant(&corners, scratch) || !self.clip(&corners, scratch) {
            return None;
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
            .find(|fan| doubled_area(fan) != 0)
    }
}

/// A clipped vertex that has no place in the window.
const DROPPED: VertexRef = VertexRef(u32::MAX);

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
