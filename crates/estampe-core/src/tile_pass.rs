//! The page of the tile side: one tile, from its bins to its attachments.
//!
//! A worker owns the tile's slices of the attachments, clears them if the pass says so, and consumes the
//! chunks in submission order, so an image does not depend on who draws which tile. For every primitive
//! the stages are called in order: raster, depth bounds and early depth test, fragment, per-sample.

use crate::fragment::interpolate::{
    LineSurface, PlaneOrigin, PointSurface, Surface, TriangleSurface, VaryingPlanes, VaryingSource,
};
use crate::fragment::queue::{FragmentQueue, Needs, clamp_depth};
use crate::geometry::viewport::PixelRect;
use crate::layout::TileGrid;
use crate::per_sample::color::{ColorTarget, write_code};
use crate::per_sample::depth::{DepthTest, line_mut, test_early, test_late};
use crate::per_sample::depth_bounds::DepthBounds;
use crate::pipeline::RenderPipeline;
use crate::raster::triangle::TileTriangle;
use crate::raster::{CoverageList, TileShape, line, packet_origin, point};
use crate::statistics::Statistics;
use crate::tiles::{BinEntry, Chunk, LinePrimitive, PointPrimitive, TrianglePacket};
use estampe_simd::{Lanes, Level, SimdBase, dispatch, f32x16};
use estampe_types::Bindings;
use estampe_types::shader::DepthOutput;

/// The most colour targets of a pass.
pub(crate) const MAX_TARGETS: usize = 8;

/// Boxes of fewer packets than this are not worth asking the depth bounds for.
const BOUNDED_PACKETS: i32 = 16;

/// Planes of a triangle whose varyings are not needed yet.
static NO_PLANES: VaryingPlanes = VaryingPlanes::ZERO;

/// An item of a wave as its fragments need it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TileItem<'a> {
    pub(crate) pipeline: &'a RenderPipeline,
    pub(crate) bindings: &'a Bindings,
    pub(crate) varyings: &'a [f32],
    pub(crate) rect: PixelRect,
    pub(crate) depth_range: [f32; 2],
    pub(crate) targets: [Option<ColorTarget>; MAX_TARGETS],
    pub(crate) all_smooth: bool,
}

/// What every tile of a pass shares.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TilePass<'a> {
    pub(crate) level: Level,
    pub(crate) grid: TileGrid,
    pub(crate) items: &'a [TileItem<'a>],
    pub(crate) chunks: &'a [Chunk],
    /// Codes to clear the colour attachments to.
    pub(crate) clear_colors: Option<[u32; MAX_TARGETS]>,
    pub(crate) clear_depth: Option<f32>,
}

/// One tile's share of the attachments.
#[derive(Debug, Default)]
pub(crate) struct TileJob<'a> {
    pub(crate) tile: u32,
    pub(crate) colors: [&'a mut [u32]; MAX_TARGETS],
    pub(crate) depth: &'a mut [f32],
}

/// Memory of one worker, for `N` samples.
#[derive(Debug, Default)]
pub(crate) struct TileScratch<const N: usize> {
    list: CoverageList<N>,
    planes: Option<Box<VaryingPlanes>>,
    queue: FragmentQueue<N>,
    bounds: DepthBounds,
    pub(crate) statistics: Statistics,
}

/// Draws a tile.
pub(crate) fn draw<const N: usize>(
    pass: &TilePass<'_>,
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) {
    if let Some(codes) = &pass.clear_colors {
        for (colors, code) in job.colors.iter_mut().zip(codes) {
            colors.fill(*code);
        }
    }
    if let Some(depth) = pass.clear_depth {
        job.depth.fill(depth);
    }
    scratch.bounds.begin(pass.clear_depth);
    for chunk in pass.chunks {
        let entries = chunk.bins.of_tile(job.tile);
        if !entries.is_empty() {
            dispatch!(pass.level, s => draw_chunk(s, pass, chunk, entries, job, scratch));
        }
    }
}

/// The tile's primitives of one chunk.
#[inline(always)]
fn draw_chunk<S: Lanes, const N: usize>(
    s: S,
    pass: &TilePass<'_>,
    chunk: &Chunk,
    entries: &[BinEntry],
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) {
    let item = &pass.items[chunk.item];
    scratch.queue.configure(item.pipeline);
    let (x, y) = pass.grid.tile_origin(job.tile);
    let log2 = pass.grid.tile_log2();
    let shape = TileShape {
        x: x.cast_signed(),
        y: y.cast_signed(),
        log2,
    };
    let rect = shape.local(&item.rect);
    let key = item.pipeline.key();
    let interface = item.pipeline.interface();
    let depth = key.depth.filter(|_| !job.depth.is_empty());
    let mut drawing = Drawing {
        pass,
        item,
        source: VaryingSource {
            shaded: item.varyings,
            clipped: &chunk.clipped_varyings,
            modes: &interface.varyings,
        },
        shape,
        rect,
        is_whole: shape.is_whole(&rect),
        test: depth.map(|state| DepthTest {
            state,
            range: item.depth_range,
            origin: [shape.x, shape.y],
        }),
        early: key.early_depth,
        depth_output: interface.depth_output != DepthOutput::None,
        needs: Needs {
            position: interface.reads_position,
            depth: !key.early_depth,
            depth_range: item.depth_range,
        },
        uniform: key.uniform_over_primitive
            && item.targets.iter().flatten().all(ColorTarget::replaces),
        planes: scratch.planes.take(),
        job,
        scratch,
    };
    for entry in entries {
        match *entry {
            BinEntry::Triangles { packet, lanes } => {
                let packet = &chunk.triangles[packet as usize];
                let mut lanes = lanes;
                while lanes != 0 {
                    let lane = lanes.trailing_zeros() as usize;
                    lanes &= lanes - 1;
                    drawing.triangle(s, packet, lane);
                }
            }
            BinEntry::Line(number) => drawing.line(&chunk.lines[number as usize]),
            BinEntry::Point(number) => drawing.point(&chunk.points[number as usize]),
        }
    }
    drawing.flush();
    let planes = drawing.planes.take();
    scratch.planes = planes;
}

/// A chunk being drawn into a tile.
struct Drawing<'a, 'j, 't, const N: usize> {
    pass: &'a TilePass<'a>,
    item: &'a TileItem<'a>,
    source: VaryingSource<'a>,
    shape: TileShape,
    /// Where pixels may change, in the tile's own pixels.
    rect: PixelRect,
    is_whole: bool,
    test: Option<DepthTest>,
    /// Whether depth is tested, and written, before shading.
    early: bool,
    depth_output: bool,
    needs: Needs,
    /// Whether a primitive's colour is the same everywhere.
    uniform: bool,
    /// Planes of the triangle at hand.
    planes: Option<Box<VaryingPlanes>>,
    job: &'j mut TileJob<'t>,
    scratch: &'j mut TileScratch<N>,
}

impl<const N: usize> Drawing<'_, '_, '_, N> {
    #[inline(always)]
    fn triangle<S: Lanes>(&mut self, s: S, packet: &TrianglePacket, lane: usize) {
        let Some(triangle) = TileTriangle::<N>::new(packet, lane, self.shape, &self.rect) else {
            return;
        };
        let mut surface = TriangleSurface {
            origin: PlaneOrigin::new(packet, lane),
            z: packet.z.lane(lane),
            iw: packet.iw.lane(lane),
            equal_w: packet.equal_w >> lane & 1 == 1,
            planes: &NO_PLANES,
            modes: self.source.modes,
            all_smooth: self.item.all_smooth,
        };
        // Leave out the blocks where everything is nearer already.
        let mut hidden = 0;
        if !self.depth_output
            && triangle.packets() > BOUNDED_PACKETS
            && let Some(test) = &self.test
        {
            hidden =
                self.scratch
                    .bounds
                    .hidden::<N>(self.pass.level, test, &surface, self.job.depth);
            if hidden == u16::MAX {
                return;
            }
        }
        self.scratch.list.clear();
        triangle.cover(s, self.shape, hidden, &mut self.scratch.list);
        if !self.is_whole {
            self.scratch.list.confine(&self.rect);
        }
        if !self.tested(s, &surface) {
            return;
        }
        // Moved out for the call, because the surface borrows it; the box moves, not the planes.
        let mut planes = std::mem::take(&mut self.planes).unwrap_or_default();
        planes.set(packet, lane, &self.source);
        surface.planes = &planes;
        self.shaded(s, &surface, packet.front >> lane & 1 == 1);
        self.planes = Some(planes);
    }

    /// Lines and points enter the level one by one: they are few, and their code is kept out of the
    /// triangles' way.
    fn line(&mut self, line: &LinePrimitive) {
        self.scratch.list.clear();
        line::cover(line, self.shape, &self.rect, &mut self.scratch.list);
        let surface = LineSurface::new(line, self.source);
        dispatch!(self.pass.level, s => self.covered(s, &surface, line.front));
    }

    fn point(&mut self, point: &PointPrimitive) {
        self.scratch.list.clear();
        point::cover(point, self.shape, &self.rect, &mut self.scratch.list);
        let surface = PointSurface {
            point,
            source: self.source,
        };
        dispatch!(self.pass.level, s => self.covered(s, &surface, point.front));
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
        let list = &mut self.scratch.list;
        // Without a depth output depth is known before shading; it is written then only if nothing is
        // discarded.
        if let (false, Some(test)) = (self.depth_output, &self.test) {
            let writes = self.early && test.state.write_enabled;
            let written = test_early(s, test, writes, surface, self.job.depth, list);
            self.scratch.bounds.invalidate(written);
        }
        !list.items().is_empty()
    }

    /// Queues what is left of the list, shading whenever the queue is full. Where a primitive has one
    /// colour, one packet is queued and shaded for all.
    #[inline(always)]
    fn shaded<S: Lanes>(&mut self, s: S, surface: &impl Surface<S>, front: bool) {
        let all = self.scratch.list.items().len();
        for at in 0..if self.uniform { 1 } else { all } {
            if self.scratch.queue.is_full() {
                self.flush();
            }
            let covered = self.scratch.list.items()[at];
            let (x, y) = packet_origin(u32::from(covered.packet));
            let pixel = [self.shape.x + x, self.shape.y + y];
            self.scratch
                .queue
                .push(s, surface, (covered, pixel), front, self.needs);
        }
        if self.uniform {
            self.flush_uniform();
        }
    }

    /// Shades the one packet that is queued; its first lane's colour goes to all of the list.
    fn flush_uniform(&mut self) {
        let queue = &mut self.scratch.queue;
        queue.shade(self.pass.level, self.item.pipeline, self.item.bindings);
        dispatch!(self.pass.level, s => self.store_uniform(s));
    }

    #[inline(always)]
    fn store_uniform<S: Lanes>(&mut self, s: S) {
        let items = self.scratch.list.items();
        let fragments = items.iter().map(|item| u64::from(item.any().count_ones()));
        self.scratch.statistics.fragments_shaded += fragments.sum::<u64>();
        for shaded in self.scratch.queue.drain(false) {
            let targets = self.item.targets.iter().flatten().zip(&mut self.job.colors);
            for ((target, stored), colors) in targets.zip(shaded.colors.chunks_exact(4)) {
                let code = target.code([0, 1, 2, 3].map(|channel| colors[channel].0[0]));
                for item in items {
                    for (sample, &mask) in item.masks.iter().enumerate() {
                        let number = usize::from(item.packet) * N + sample;
                        if let Some(line) = line_mut(stored, number) {
                            write_code(s, code, mask, line);
                        }
                    }
                }
            }
        }
    }

    /// Shades what is queued and hands it to the attachments, in order.
    fn flush(&mut self) {
        if self.scratch.queue.is_empty() {
            return;
        }
        let queue = &mut self.scratch.queue;
        let fragments = queue.shade(self.pass.level, self.item.pipeline, self.item.bindings);
        self.scratch.statistics.fragments_shaded += fragments;
        dispatch!(self.pass.level, s => self.store(s));
    }

    #[inline(always)]
    fn store<S: Lanes>(&mut self, s: S) {
        let (range, level) = (self.item.depth_range, self.pass.level);
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
            let targets = self.item.targets.iter().flatten().zip(&mut self.job.colors);
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
