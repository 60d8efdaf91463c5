//! Drawing in submission order: blending, shaders that discard or write depth, lines and points.
//!
//! For every primitive the stages are called in order: raster, depth bounds and early depth test, fragment,
//! per-sample. What many primitives queue is shaded together, and written in the order of the queue.

use super::{BOUNDED_PACKETS, ChunkInTile, TileJob, TileScratch};
use crate::fragment::interpolate::{
    DepthPlane, LineSurface, PlaneOrigin, PointSurface, Surface, TriangleSurface, VaryingPlanes,
    VaryingSource, set_planes,
};
use crate::fragment::queue::{Needs, clamp_depth};
use crate::geometry::line_style::LineStyle;
use crate::per_sample::color::ColorTarget;
use crate::per_sample::depth::{DepthTest, line_mut, test_early, test_late};
use crate::per_sample::depth_bounds::Judgement;
use crate::per_sample::source_over::{ColorPlanes, blend_block, test_block};
use crate::per_sample::visibility::ONLY_WIDE;
use crate::pipeline::StageKey;
use crate::raster::triangle::TileTriangle;
use crate::raster::{line, packet_origin, point};
use crate::tiles::{BinEntry, LinePrimitive, PointPrimitive, TrianglePacket};
use estampe_simd::{Lanes, Level, SimdBase, dispatch, f32x16};
use estampe_types::Interpolation;
use estampe_types::shader::DepthOutput;
use estampe_types::state::CompareFunction;

/// Draws the tile's primitives of one chunk.
#[inline(always)]
pub(super) fn draw_chunk<S: Lanes, const N: usize>(
    s: S,
    work: &ChunkInTile<'_>,
    entries: &[BinEntry],
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) {
    let pipeline = work.item.pipeline;
    scratch.queue.configure(pipeline);
    let interface = pipeline.interface();
    let StageKey { early_depth, .. } = pipeline.key();
    let mut drawing = Drawing {
        work,
        source: work.varyings(work.chunk),
        test: work.test,
        early: early_depth,
        depth_output: interface.depth_output != DepthOutput::None,
        blends_blocks: N == 1
            && !matches!(work.level, Level::Scalar(_))
            && pipeline.key().passes_color
            && interface.varyings[..4] == [Interpolation::Smooth; 4]
            && work.item.targets[0]
                .as_ref()
                .is_some_and(ColorTarget::is_source_over),
        needs: Needs {
            position: interface.reads_position,
            depth: !early_depth,
            depth_range: work.item.depth_range,
        },
        planes: std::mem::take(&mut scratch.planes),
        smooth: None,
        job,
        scratch,
    };
    let planes = VaryingPlanes::size(interface.varyings.len());
    drawing.planes.resize(planes, 0.0);
    for entry in entries {
        match *entry {
            BinEntry::Triangles { packet, lanes } => {
                let packet = &work.chunk.triangles[packet as usize];
                let mut lanes = lanes;
                while lanes != 0 {
                    let lane = lanes.trailing_zeros() as usize;
                    lanes &= lanes - 1;
                    drawing.triangle(s, packet, lane);
                }
            }
            BinEntry::Line(number) => drawing.line(&work.chunk.lines[number as usize]),
            BinEntry::Point(number) => drawing.point(&work.chunk.points[number as usize]),
        }
    }
    drawing.flush();
    let planes = std::mem::take(&mut drawing.planes);
    scratch.planes = planes;
}

/// A chunk being drawn into a tile.
struct Drawing<'a, 'j, 't, const N: usize> {
    work: &'a ChunkInTile<'a>,
    source: VaryingSource<'a>,
    test: Option<DepthTest>,
    /// Whether depth is tested, and written, before shading.
    early: bool,
    depth_output: bool,
    /// Whether whole blocks of triangles without perspective are blended from their planes.
    blends_blocks: bool,
    needs: Needs,
    /// Planes of the triangle at hand.
    planes: Vec<f32>,
    /// The line at hand, if it is a smooth one.
    smooth: Option<LineSurface<'a>>,
    job: &'j mut TileJob<'t>,
    scratch: &'j mut TileScratch<N>,
}

impl<'a, const N: usize> Drawing<'a, '_, '_, N> {
    #[inline(always)]
    fn triangle<S: Lanes>(&mut self, s: S, packet: &TrianglePacket, lane: usize) {
        let ChunkInTile {
            shape,
            rect,
            is_whole,
            blocks,
            level,
            ..
        } = *self.work;
        let Some(triangle) = TileTriangle::<N>::new(packet, lane, shape, &rect) else {
            return;
        };
        let plane = DepthPlane::new(packet, lane);
        // Leave out the blocks where everything is nearer already.
        let mut judged = Judgement::of_all(0, 0);
        if !self.depth_output
            && triangle.packets() > BOUNDED_PACKETS
            && let Some(test) = &self.test
        {
            let bounds = &mut self.scratch.bounds;
            judged = bounds.judge::<N>(level, test, &plane, false, self.job.depth);
            if judged.hidden == u16::MAX {
                return;
            }
        }
        self.scratch.list.clear();
        let blends_blocks = self.blends_blocks && packet.equal_w >> lane & 1 == 1;
        let blocks = if blends_blocks { blocks } else { 0 };
        let list = &mut self.scratch.list;
        let whole = triangle.cover(s, shape, judged.hidden, blocks, list);
        if !is_whole {
            self.scratch.list.confine(&rect);
        }
        let mut surface = TriangleSurface {
            origin: PlaneOrigin::new(packet, lane),
            z: plane.z,
            iw: packet.iw.lane(lane),
            equal_w: packet.equal_w >> lane & 1 == 1,
            planes: VaryingPlanes::default(),
            modes: self.source.modes,
            all_smooth: self.work.item.all_smooth,
        };
        let is_seen = self.tested(s, &surface);
        if !is_seen && whole == 0 {
            return;
        }
        // Moved out for the call, because the surface borrows them.
        let mut planes = std::mem::take(&mut self.planes);
        let all_smooth = self.work.item.all_smooth;
        set_planes(s, &mut planes, (packet, lane), &self.source, all_smooth);
        surface.planes = VaryingPlanes::new(&planes);
        if whole != 0 {
            // What is queued lies below.
            self.flush();
            let colors = ColorPlanes::new(surface.origin, &surface.planes, shape);
            let certain = judged.certain;
            dispatch!(@wide level, s => self.blend_blocks(s, &plane, &colors, [whole, certain]),
                scalar => unreachable!("{ONLY_WIDE}"));
        }
        self.shaded(s, &surface, packet.front >> lane & 1 == 1);
        self.planes = planes;
    }

    /// Blends a triangle over blocks that it covers whole.
    #[inline(always)]
    fn blend_blocks<S: Lanes>(
        &mut self,
        s: S,
        plane: &DepthPlane,
        colors: &ColorPlanes,
        [mut blocks, certain]: [u16; 2],
    ) {
        let writes = |test: &DepthTest| test.state.write_enabled;
        let writes = self.test.as_ref().is_some_and(writes);
        if writes {
            self.scratch.bounds.invalidate(blocks);
        }
        while blocks != 0 {
            let block = blocks.trailing_zeros() as usize;
            blocks &= blocks - 1;
            let (mut masks, mut fragments) = ([u16::MAX; 16], 256);
            if let Some(test) = &self.test
                && (writes || certain >> block & 1 == 0)
            {
                masks = test_block(s, test, plane, block, self.job.depth);
                let counts = masks.iter().map(|mask| u64::from(mask.count_ones()));
                fragments = counts.sum();
            }
            self.scratch.statistics.fragments_shaded += fragments;
            let at = (self.work.shape, block);
            blend_block(s, colors, at, &masks, self.job.colors[0]);
        }
    }

    /// Lines and points enter the level one by one: they are few, and their code is kept out of the
    /// triangles' way.
    fn line(&mut self, line: &'a LinePrimitive) {
        let ChunkInTile { shape, rect, .. } = self.work;
        self.scratch.list.clear();
        let style = LineStyle::new(&self.work.item.pipeline.descriptor().primitive.line);
        line::cover(line, &style, *shape, rect, &mut self.scratch.list);
        let surface = LineSurface::new(line, &style, self.source);
        if style.is_smooth() {
            self.smooth = Some(surface);
        }
        dispatch!(self.work.level, s => self.covered(s, &surface, line.front));
        if style.is_smooth() {
            // Alpha is that of this line alone.
            self.flush();
            self.smooth = None;
        }
    }

    fn point(&mut self, point: &PointPrimitive) {
        let ChunkInTile { shape, rect, .. } = self.work;
        self.scratch.list.clear();
        let is_round = self.work.item.pipeline.descriptor().primitive.round_points;
        point::cover(point, is_round, *shape, rect, &mut self.scratch.list);
        let surface = PointSurface {
            point,
            source: self.source,
        };
        dispatch!(self.work.level, s => self.covered(s, &surface, point.front));
    }

    /// A line's or point's list: test, then shade.
    #[inline(always)]
    fn covered<S: Lanes>(&mut self, s: S, surface: &impl Surface<S>, front: bool) {
        if self.tested(s, surface) {
            self.shaded(s, surface, front);
        }
    }

    /// The early depth test; false when nothing is left.
    #[inline(always)]
    fn tested<S: Lanes>(&mut self, s: S, surface: &impl Surface<S>) -> bool {
        // Without a depth output depth is known before shading; it is written then only if nothing is
        // discarded.
        if let (false, Some(test)) = (self.depth_output, &self.test) {
            // What waits in the queue may change the stored depth by then: as other comparisons let it, towards
            // where fewer pass; with this one, towards anything.
            if !self.early && test.state.compare == CompareFunction::NotEqual {
                return !self.scratch.list.items().is_empty();
            }
            let list = &mut self.scratch.list;
            let writes = self.early && test.state.write_enabled;
            let written = test_early(s, test, writes, surface, self.job.depth, list);
            self.scratch.bounds.invalidate(written);
        }
        !self.scratch.list.items().is_empty()
    }

    /// Queues what is left of the list, shading whenever the queue is full.
    #[inline(always)]
    fn shaded<S: Lanes>(&mut self, s: S, surface: &impl Surface<S>, front: bool) {
        for at in 0..self.scratch.list.items().len() {
            if self.scratch.queue.is_full() {
                self.flush();
            }
            let covered = self.scratch.list.items()[at];
            let (x, y) = packet_origin(u32::from(covered.packet));
            let pixel = [self.work.shape.x + x, self.work.shape.y + y];
            self.scratch
                .queue
                .push(s, surface, (covered, pixel), front, self.needs);
        }
    }

    /// Shades what is queued and hands it to the attachments, in order.
    fn flush(&mut self) {
        if self.scratch.queue.is_empty() {
            return;
        }
        let queue = &mut self.scratch.queue;
        let fragments = queue.shade(
            self.work.level,
            self.work.item.pipeline,
            self.work.item.bindings,
        );
        self.scratch.statistics.fragments_shaded += fragments;
        if let Some(line) = &self.smooth {
            let (x, y) = (self.work.shape.x, self.work.shape.y);
            self.scratch.queue.scale_alpha(|packet| {
                let (right, below) = packet_origin(u32::from(packet));
                line.coverage([x + right, y + below])
            });
        }
        dispatch!(self.work.level, s => self.store(s));
    }

    #[inline(always)]
    fn store<S: Lanes>(&mut self, s: S) {
        let (range, level) = (self.work.item.depth_range, self.work.level);
        let mut written = 0;
        for shaded in self.scratch.queue.drain(self.depth_output) {
            let packet = usize::from(shaded.covered.packet);
            let mut masks = shaded.covered.masks;
            if let (false, Some(test)) = (self.early, &self.test) {
                for (sample, mask) in masks.iter_mut().enumerate() {
                    let depth = shaded.depth_out.unwrap_or(&shaded.depths[sample]);
                    let new = clamp_depth(s, f32x16::load_array_ref(s, &depth.0), range);
                    if let Some(line) = line_mut(self.job.depth, packet * N + sample) {
                        *mask = test_late(s, test.state, new, *mask, line);
                    }
                }
                written |= 1u16 << ((packet >> 4) & 15);
            }
            let targets = self
                .work
                .item
                .targets
                .iter()
                .flatten()
                .zip(&mut self.job.colors);
            for ((target, stored), colors) in targets.zip(shaded.colors.chunks_exact(4)) {
                for (sample, &mask) in masks.iter().enumerate() {
                    if mask != 0
                        && let Some(line) = line_mut(stored, packet * N + sample)
                    {
                        target.write(s, level, colors, mask, line);
                    }
                }
            }
        }
        self.scratch.bounds.invalidate(written);
    }
}
