//! Drawing with any state, in submission order: what the common paths leave out.
//!
//! Stencil, targets of any format, several of them with several samples, 2, 8 and 16 samples, shading by sample,
//! centroids, sample masks, alpha to coverage, logic operations, dual source, depth bounds, fixed-point depth,
//! conservative coverage, occlusion queries. The stages are those of [`immediate`](super::immediate), written
//! for any number of samples and one after the other; a draw is here because its pipeline or its target says so
//! ([`is_general`](crate::pipeline::StageKey)), and the common paths know nothing of it.

mod queue;

use super::{ChunkInTile, MAX_TARGETS, TileJob};
use crate::commands::OcclusionQueries;
use crate::fragment::interpolate::{
    DepthPlane, LineSurface, PlaneOrigin, PointSurface, Surface, TriangleSurface, VaryingPlanes,
    VaryingSource, set_planes,
};
use crate::fragment::queue::clamp_depth;
use crate::geometry::line_style::LineStyle;
use crate::per_sample::depth::line_mut;
use crate::per_sample::general::{GeneralTarget, SampleTests, StencilTest};
use crate::raster::general::{
    GeneralTriangle, MAX_SAMPLES, SampleCoverage, cover_line, cover_point, positions,
};
use crate::raster::packet_origin;
use crate::statistics::Statistics;
use crate::tiles::{BinEntry, LinePrimitive, PointPrimitive, TrianglePacket};
use estampe_simd::{LANES, Lanes, SimdBase, dispatch};
use estampe_types::shader::DepthOutput;
use estampe_types::state::CompareFunction;
use queue::{GeneralQueue, Place, Shaded};

/// Memory of one worker.
#[derive(Debug, Default)]
pub(super) struct GeneralScratch {
    covered: Vec<SampleCoverage>,
    /// Planes of one triangle's varyings.
    planes: Vec<f32>,
    queue: GeneralQueue,
}

/// Draws the tile's primitives of one chunk.
pub(super) fn draw_chunk(
    work: &ChunkInTile<'_>,
    entries: &[BinEntry],
    (samples, queries): (usize, Option<&OcclusionQueries>),
    job: &mut TileJob<'_>,
    (scratch, statistics): (&mut GeneralScratch, &mut Statistics),
) {
    let item = work.item;
    let (draw, pipeline) = (item.draw, item.pipeline);
    let (descriptor, interface) = (pipeline.descriptor(), pipeline.interface());
    let tests = SampleTests {
        bounds: draw.depth_bounds,
        stencil: descriptor.stencil.map(|state| StencilTest {
            state,
            reference: draw.stencil_reference,
        }),
        depth: pipeline.key().depth,
        format: item.depth_format,
    };
    let mut targets = [None; MAX_TARGETS];
    for (target, state) in targets.iter_mut().zip(&descriptor.targets) {
        let logic = descriptor.logic_operation;
        *target = Some(GeneralTarget::new(state, logic, draw.blend_constant));
    }
    let alpha_to_coverage =
        descriptor.alpha_to_coverage && targets[0].is_some_and(|target| !target.is_integer());
    let early = !interface.discards
        && !interface.stores
        && interface.depth_output == DepthOutput::None
        && !alpha_to_coverage
        && !interface.writes_sample_mask;
    let per_sample = samples > 1 && (descriptor.sample_shading || interface.per_sample);
    let mut offsets = [[0.5; 2]; MAX_SAMPLES];
    for (offset, [x, y]) in offsets.iter_mut().zip(positions(samples)) {
        *offset = [x as f32 * (1.0 / 256.0), y as f32 * (1.0 / 256.0)];
    }
    scratch.queue.configure(pipeline, samples);
    scratch
        .planes
        .resize(VaryingPlanes::size(interface.varyings.len()), 0.0);
    let mut drawing = Drawing {
        work,
        samples,
        offsets,
        tests,
        targets,
        alpha_to_coverage,
        early,
        rejects_early: !early
            && !interface.stores
            && can_reject_early(&tests, interface.depth_output),
        per_sample,
        source: work.varyings(work.chunk),
        smooth: None,
        passed: 0,
        job,
        scratch,
        statistics,
    };
    for entry in entries {
        match *entry {
            BinEntry::Triangles { packet, lanes } => {
                let packet = &work.chunk.triangles[packet as usize];
                let mut lanes = lanes;
                while lanes != 0 {
                    let lane = lanes.trailing_zeros() as usize;
                    lanes &= lanes - 1;
                    dispatch!(work.level, s => drawing.triangle(s, packet, lane));
                }
            }
            BinEntry::Line(number) => drawing.line(&work.chunk.lines[number as usize]),
            BinEntry::Point(number) => drawing.point(&work.chunk.points[number as usize]),
        }
    }
    drawing.flush();
    let passed = drawing.passed;
    if let (Some(queries), Some(query)) = (queries, draw.occlusion_query) {
        queries.add(query, passed);
    }
}

/// Whether a fragment whose interpolated depth fails now would fail after shading, and leave nothing behind (O9).
///
/// Fragments that wait in the queue may have changed the stored depth by then, but only as the comparison lets them:
/// towards where fewer pass. (Not so for "not equal".) A declared direction of the shader's depth is away from
/// where more pass.
fn can_reject_early(tests: &SampleTests, output: DepthOutput) -> bool {
    use CompareFunction as C;
    let Some(depth) = tests.depth else {
        return false;
    };
    let keeps = tests.stencil.is_none_or(|test| test.failing_keeps());
    let is_certain = match output {
        DepthOutput::None => depth.compare != C::NotEqual,
        DepthOutput::Greater => matches!(depth.compare, C::Less | C::LessEqual),
        DepthOutput::Less => matches!(depth.compare, C::Greater | C::GreaterEqual),
        DepthOutput::Any => false,
    };
    keeps && is_certain
}

/// A chunk being drawn into a tile.
struct Drawing<'a, 'j, 't> {
    work: &'a ChunkInTile<'a>,
    samples: usize,
    /// The samples' offsets in their pixel, in pixels.
    offsets: [[f32; 2]; MAX_SAMPLES],
    tests: SampleTests,
    targets: [Option<GeneralTarget>; MAX_TARGETS],
    alpha_to_coverage: bool,
    /// Whether all tests are made, and their results written, before shading.
    early: bool,
    /// Whether fragments that fail the depth test are dropped before shading, nothing being written.
    rejects_early: bool,
    per_sample: bool,
    source: VaryingSource<'a>,
    /// The line at hand, if it is a smooth one.
    smooth: Option<LineSurface<'a>>,
    /// Samples that passed all tests.
    passed: u64,
    job: &'j mut TileJob<'t>,
    scratch: &'j mut GeneralScratch,
    statistics: &'j mut Statistics,
}

impl<'a> Drawing<'a, '_, '_> {
    #[inline(always)]
    fn triangle<S: Lanes>(&mut self, s: S, packet: &TrianglePacket, lane: usize) {
        let ChunkInTile { shape, rect, .. } = *self.work;
        let mode = self.work.item.pipeline.descriptor().primitive.conservative;
        let triangle = GeneralTriangle::new(packet, lane, shape, &rect, mode);
        self.scratch.covered.clear();
        triangle.cover(self.samples, &mut self.scratch.covered);
        if self.scratch.covered.is_empty() {
            return;
        }
        let mut planes = std::mem::take(&mut self.scratch.planes);
        let all_smooth = self.work.item.all_smooth;
        set_planes(s, &mut planes, (packet, lane), &self.source, all_smooth);
        let surface = TriangleSurface {
            origin: PlaneOrigin::new(packet, lane),
            z: DepthPlane::new(packet, lane).z,
            iw: packet.iw.lane(lane),
            equal_w: packet.equal_w >> lane & 1 == 1,
            planes: VaryingPlanes::new(&planes),
            modes: self.source.modes,
            all_smooth,
        };
        self.covered(s, &surface, packet.front >> lane & 1 == 1);
        self.scratch.planes = planes;
    }

    fn line(&mut self, line: &'a LinePrimitive) {
        let ChunkInTile { shape, rect, .. } = self.work;
        self.scratch.covered.clear();
        let style = LineStyle::new(&self.work.item.pipeline.descriptor().primitive.line);
        let covered = &mut self.scratch.covered;
        cover_line(line, &style, *shape, rect, self.samples, covered);
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
        self.scratch.covered.clear();
        let is_round = self.work.item.pipeline.descriptor().primitive.round_points;
        let covered = &mut self.scratch.covered;
        cover_point(point, is_round, *shape, rect, self.samples, covered);
        let surface = PointSurface {
            point,
            source: self.source,
        };
        dispatch!(self.work.level, s => self.covered(s, &surface, point.front));
    }

    /// A primitive's packets: early tests, then into the queue.
    #[inline(always)]
    fn covered<S: Lanes>(&mut self, s: S, surface: &impl Surface<S>, front: bool) {
        let sample_mask = self.work.item.pipeline.descriptor().sample_mask;
        for at in 0..self.scratch.covered.len() {
            let mut coverage = self.scratch.covered[at];
            for (sample, mask) in coverage.masks.iter_mut().enumerate() {
                *mask &= 0_u16.wrapping_sub((sample_mask >> sample & 1) as u16);
            }
            if coverage.any() == 0 {
                continue;
            }
            let (x, y) = packet_origin(u32::from(coverage.packet));
            let pixel = [self.work.shape.x + x, self.work.shape.y + y];
            let mut alive = coverage;
            if self.early && !self.tests.is_empty() || self.rejects_early {
                self.test_before_shading(s, surface, (pixel, front), &mut alive);
            } else if self.early {
                self.passed += alive.count();
            }
            if alive.any() == 0 {
                continue;
            }
            let place = Place {
                coverage,
                alive,
                pixel,
                front,
                sample: None,
            };
            if !self.per_sample {
                self.queue(s, surface, &place);
                continue;
            }
            for (sample, &mask) in (0u32..).zip(&alive.masks).take(self.samples) {
                if mask != 0 {
                    let sample = Some(sample);
                    self.queue(s, surface, &Place { sample, ..place });
                }
            }
        }
    }

    #[inline(always)]
    fn test_before_shading<S: Lanes>(
        &mut self,
        s: S,
        surface: &impl Surface<S>,
        (pixel, front): ([i32; 2], bool),
        alive: &mut SampleCoverage,
    ) {
        let range = self.work.item.depth_range;
        for sample in 0..self.samples.min(MAX_SAMPLES) {
            let mask = alive.masks[sample];
            if mask == 0 {
                continue;
            }
            let depth = surface.depth(s, pixel, self.offsets[sample]);
            let mut depth = clamp_depth(s, depth, range).to_array();
            for depth in &mut depth {
                *depth = self.tests.format.stored(*depth);
            }
            let number = usize::from(alive.packet) * self.samples + sample;
            let stored_depth = line_mut(self.job.depth, number);
            alive.masks[sample] = if self.early {
                let stored = (stored_depth, line_mut(self.job.stencil, number));
                self.tests.run(&depth, mask, front, stored)
            } else {
                // A target without depth passes.
                stored_depth.map_or(mask, |stored| mask & self.tests.would_pass(&depth, stored))
            };
        }
        if self.early {
            self.passed += alive.count();
        }
    }

    #[inline(always)]
    fn queue<S: Lanes>(&mut self, s: S, surface: &impl Surface<S>, place: &Place) {
        if self.scratch.queue.is_full() {
            self.flush();
        }
        let depth_range = self.work.item.depth_range;
        let offsets = &self.offsets[..self.samples];
        self.scratch
            .queue
            .push(s, surface, place, (offsets, !self.early, depth_range));
    }

    /// Shades what is queued and hands it to the attachments, in order.
    fn flush(&mut self) {
        if self.scratch.queue.is_empty() {
            return;
        }
        let item = self.work.item;
        let queue = &mut self.scratch.queue;
        let fragments = queue.shade(self.work.level, item.pipeline, item.bindings);
        self.statistics.fragments_shaded += fragments;
        if let Some(line) = &self.smooth {
            queue.scale_alpha(|pixel| line.coverage(pixel));
        }
        dispatch!(self.work.level, s => self.store(s));
    }

    #[inline(always)]
    fn store<S: Lanes>(&mut self, _s: S) {
        let mut queue = std::mem::take(&mut self.scratch.queue);
        for slot in 0..queue.len() {
            let mut shaded = queue.shaded(slot);
            if self.alpha_to_coverage {
                shaded.keep_by_alpha(self.samples);
            }
            shaded.keep_by_mask();
            if !self.early {
                self.test_after_shading(&mut shaded);
            }
            self.write_colors(&shaded);
        }
        queue.clear();
        self.scratch.queue = queue;
    }

    #[inline(always)]
    fn test_after_shading(&mut self, shaded: &mut Shaded<'_>) {
        let packet = usize::from(shaded.alive.packet);
        for sample in 0..self.samples.min(MAX_SAMPLES) {
            let mask = shaded.alive.masks[sample];
            if mask == 0 {
                continue;
            }
            if !self.tests.is_empty() {
                let mut depth = shaded.depth_of(sample, self.work.item.depth_range);
                for depth in &mut depth {
                    *depth = self.tests.format.stored(*depth);
                }
                let number = packet * self.samples + sample;
                let stored = (
                    line_mut(self.job.depth, number),
                    line_mut(self.job.stencil, number),
                );
                shaded.alive.masks[sample] = self.tests.run(&depth, mask, shaded.front, stored);
            }
        }
        self.passed += shaded.alive.count();
    }

    #[inline(always)]
    fn write_colors(&mut self, shaded: &Shaded<'_>) {
        let packet = usize::from(shaded.alive.packet);
        let second = shaded.second();
        for (index, (target, stored)) in self.targets.iter().zip(&mut self.job.colors).enumerate() {
            let Some(target) = target else {
                break;
            };
            let source = shaded.color(index);
            for (sample, &mask) in shaded.alive.masks.iter().enumerate().take(self.samples) {
                if mask == 0 {
                    continue;
                }
                let size = target.words() * LANES;
                let from = (packet * self.samples + sample) * size;
                if let Some(stored) = stored.get_mut(from..from + size) {
                    target.write(&source, &second, mask, stored);
                }
            }
        }
    }
}
