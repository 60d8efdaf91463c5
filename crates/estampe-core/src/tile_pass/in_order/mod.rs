//! The in-order path: primitive by primitive, in the order of submission, with any state.
//!
//! For every primitive the stages are called in order: coverage, hierarchical z, early tests,
//! fragments. Packets of many primitives are queued and shaded together; late tests and colours
//! follow in the order of the queue.
//!
//! ```text
//!   coverage ─▶ early tests (`alpha`, too) ─▶ queue ─▶ shader ─▶ late tests ─▶ colours
//!      ├─ large triangles, blended from their planes (`layers`)
//!      ├─ two triangles that are a rectangle (`boxes`)
//!      ├─ triangles of one colour that share sides (`fan`)
//!      └─ small triangles and lines, sixteen at a time (`small`, `small_lines`)
//! ```

/// Enters the SIMD level in code that is generic over `N`, the number of samples: the scalar level
/// is compiled for [`MAX_SAMPLES`](crate::raster::MAX_SAMPLES) alone, which serves any number,
/// because it takes the compiler so long.
macro_rules! dispatch_samples {
    ($n:expr, $level:expr, $simd:ident => $op:expr) => {
        if const { $n == crate::raster::MAX_SAMPLES } {
            estampe_simd::dispatch!($level, $simd => $op)
        } else {
            estampe_simd::dispatch!(@wide $level, $simd => $op,
                scalar => unreachable!("the scalar level draws tiles of any number of samples"))
        }
    };
}

mod ahead;
mod alpha;
mod boxes;
mod dense;
mod fan;
mod flush;
mod layers;
mod line_or_point;
mod listed;
mod shade;
mod small;
mod small_lines;
mod solid;
mod solid_colors;
mod tests;
mod triangle;

use super::fragments::Fragments;
use super::{TileJob, TilePass, TileScratch, TileWork};
use crate::bounds::bins::BinEntry;
use crate::bounds::primitives::{PackedTriangle, PackedTriangles};
use crate::fragment::interpolate::{LineInterpolant, VaryingPlanes, VaryingSource};
use crate::fragment::last_packet::LastPacket;
use crate::fragment::queue::{Survivors, packets_of_call};
use crate::per_sample::source_over::Layers;
use crate::plan::tile_plan::{TestTiming, TilePlan};
use crate::raster::clip_masks::ClipMasks;
use crate::raster::{CoverageList, SampleSet};
use crate::tile_path::TilePath;
pub(super) use ahead::Ahead;
use estampe_simd::{LANES, Lane};
use estampe_types::state::ConservativeMode;
use fan::{Fan, joins_triangles};
use shade::PendingQuads;
use small::{Batch, Listing, SmallScratch};
use small_lines::LineBatch;
use solid::Solid;
use solid_colors::SolidColors;

/// Memory of one worker.
#[derive(Debug)]
pub(super) struct InOrderScratch<const N: usize> {
    list: CoverageList<N>,
    /// What lists are clipped to.
    clip: ClipMasks,
    /// The list before early tests, where shading depends on it.
    covered: CoverageList<N>,
    /// Planes of one triangle's varyings.
    planes: Vec<f32>,
    /// The chunk and the sub-draw of what waits in the queue for the next run.
    waiting: Option<[u32; 2]>,
    pending: PendingQuads,
    solid: Solid<N>,
    fan: Box<Fan<N>>,
    solid_colors: SolidColors,
    small: Box<SmallScratch<N>>,
    fragments: Box<Fragments>,
    last_packet: Box<LastPacket>,
    /// What shading leaves of packets.
    survivors: Box<Survivors>,
    /// Large triangles that wait to be blended.
    layers: Box<Layers>,
}

impl<const N: usize> Default for InOrderScratch<N> {
    fn default() -> Self {
        Self {
            list: CoverageList::default(),
            clip: ClipMasks::default(),
            covered: CoverageList::default(),
            planes: Vec::new(),
            waiting: None,
            pending: PendingQuads::default(),
            solid: Solid::default(),
            fan: Box::default(),
            solid_colors: SolidColors::default(),
            small: Box::default(),
            fragments: Box::default(),
            last_packet: Box::default(),
            survivors: Box::default(),
            layers: Box::default(),
        }
    }
}

/// Draws the tile's primitives of one run of a chunk. The SIMD level is entered for each batch of
/// triangles, each line and each point, and again for what is queued of a primitive: all of it in
/// one function took the compiler half of the crate's time.
///
/// What is queued at the end waits for the next run, if its fragments are drawn alike: draws of a
/// user interface differ in their scissors alone. [`finish`] ends it.
pub(super) fn draw<const N: usize>(
    pass: &TilePass<'_>,
    (work, entries): (&TileWork<'_>, &[BinEntry]),
    to: FragmentsTo,
    (job, ahead): (&mut TileJob<'_>, &mut Ahead<'_>),
    scratch: &mut TileScratch<N>,
) {
    let plan = work.plan;
    begin_queue(pass, work, job, scratch);
    let scalars = plan.pipeline.interface().varyings.len();
    let mut planes = std::mem::take(&mut scratch.in_order.planes);
    planes.resize(VaryingPlanes::size(scalars), 0.0);
    let is_scalar = work.level.is_scalar();
    let mut drawing = InOrder::new(work, entries.first().copied(), job, scratch);
    drawing.to = to;
    // The scalar level draws triangles from their packets.
    drawing.ahead = (!is_scalar).then_some(ahead);
    drawing.planes = planes;
    let (mut batch, mut lines) = (Batch::default(), LineBatch::default());
    let mut rectangles = 0;
    for entry in entries {
        match *entry {
            BinEntry::Triangles { packet, lanes } if is_scalar => {
                for lane in Lane::all_of(lanes) {
                    let packet = &work.packets.triangles[packet as usize];
                    let triangle = PackedTriangle::of_lane(packet, lane.get());
                    drawing.batch(&mut Batch::of(&triangle));
                }
            }
            BinEntry::Triangles { packet, lanes } => {
                let PackedTriangles(triangles) = &work.packets.one_by_one[packet as usize];
                let pairs = work.chunk.rectangles(packet);
                rectangles += u64::from((pairs & lanes).count_ones());
                for lane in Lane::all_of(lanes) {
                    drawing.step(1);
                    let next = (lane.get() + 1) % LANES;
                    let second = lane.is_in(pairs).then(|| &triangles[next]);
                    let triangle = &triangles[lane.get()];
                    if !batch.add(triangle, second) {
                        drawing.batch(&mut batch);
                        batch.add(triangle, second);
                    }
                }
            }
            BinEntry::Lines { packet, lanes } => {
                drawing.step(entry.count() as usize);
                drawing.add_lines(&mut lines, &work.packets.lines[packet as usize], lanes);
            }
            BinEntry::Point(number) => drawing.point(&work.chunk.points[number as usize]),
        }
    }
    drawing.batch(&mut batch);
    drawing.draw_lines(&mut lines);
    drawing.end_fan();
    drawing.end_solid();
    drawing.blend_layers();
    if plan.query.is_some() || to == FragmentsTo::Visibility {
        drawing.flush();
    }
    let (passed, planes) = (drawing.passed, std::mem::take(&mut drawing.planes));
    scratch.in_order.planes = planes;
    scratch.in_order.waiting = (!scratch.queue.is_empty()).then_some([work.number, work.sub_draw]);
    scratch.statistics.rectangles_in_order += rectangles;
    if let (Some(queries), Some(query)) = (work.queries, plan.query) {
        queries.add(query, passed);
    }
}

/// Makes the queue ready for a run: what waits in it stays if it is drawn alike.
fn begin_queue<const N: usize>(
    pass: &TilePass<'_>,
    work: &TileWork<'_>,
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) {
    let plan = work.plan;
    let pipeline = plan.pipeline;
    let samples = SampleSet::new(work.samples);
    let range = plan.tests.stored.range;
    let tests_late = plan.timing != TestTiming::Early && !plan.tests.is_empty();
    let room = packets_of_call(pipeline.interface());
    scratch.in_order.list.set_samples(samples);
    if let Some([_, sub_draw]) = scratch.in_order.waiting
        && pass.plans[sub_draw as usize].queues_like(plan)
    {
        scratch.statistics.queues_kept += 1;
        return;
    }
    finish(pass, job, scratch);
    scratch
        .queue
        .configure(pipeline, samples, range, (tests_late, room));
    if pipeline.interface().stores {
        // Colours may depend on what it stores.
        scratch.in_order.solid_colors.clear();
    }
    if gathers(plan) {
        scratch
            .solid_queue
            .configure(pipeline, samples, range, (tests_late, room));
        let colors = &mut scratch.in_order.solid_colors;
        let before = colors.sub_draw().map(|of| &pass.plans[of as usize]);
        if pipeline.key().color_passthrough {
            // Colours that are varyings need no program.
            colors.clear();
        } else if before.is_none_or(|of| !of.shades_like(plan)) {
            let interface = pipeline.interface();
            colors.begin(
                work.sub_draw,
                interface.varyings.len(),
                interface.colors() * 4,
            );
        }
    }
}

impl<const N: usize> InOrderScratch<N> {
    /// Forgets what is kept from tile to tile of a pass.
    pub(super) fn end_pass(&mut self) {
        self.solid_colors.clear();
    }
}

/// Draws what waits in the queue.
pub(super) fn finish<const N: usize>(
    pass: &TilePass<'_>,
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) {
    if let Some(of) = scratch.in_order.waiting.take() {
        let work = TileWork::new(pass, of, job.tile);
        InOrder::new(&work, None, job, scratch).flush();
    }
}

/// Returns true if triangles over which nothing varies have one colour, whatever their place.
fn gathers(plan: &TilePlan<'_>) -> bool {
    plan.pipeline.key().depends_on_varyings_alone
        && plan.timing == TestTiming::Early
        && plan.path != TilePath::InOrderBlocks
}

/// Where the fragments of a run go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FragmentsTo {
    /// To the attachments, in order.
    Attachments,
    /// To the run of visibility: those of opaque lines that pass their tests.
    Visibility,
}

/// A run being drawn into a tile.
struct InOrder<'a, 'j, 't, 'p, const N: usize> {
    work: &'a TileWork<'a>,
    to: FragmentsTo,
    samples: SampleSet<N>,
    source: VaryingSource<'a>,
    conservative: ConservativeMode,
    /// True if blocks that hierarchical z rejects are skipped.
    uses_hiz: bool,
    /// True if triangles without perspective that cover blocks are blended from their planes.
    blends_blocks: bool,
    /// True if quads or pixels of several primitives share packets.
    shares_packets: bool,
    /// True if fragments are shaded without looking at others of their quad.
    needs_no_quads: bool,
    /// One of the primitives, which are all of one kind.
    primitives: Option<BinEntry>,
    /// True if triangles of one colour are gathered.
    gathers: bool,
    /// True if those of them that share sides are covered together.
    joins_triangles: bool,
    /// True if shaders store in an order that can be seen.
    stores_in_order: bool,
    /// What is listed of small triangles.
    listing: Listing,
    /// What is prefetched.
    ahead: Option<&'j mut Ahead<'p>>,
    /// Samples that passed all tests, where a query counts them.
    passed: u64,
    /// Planes of the triangle at hand.
    planes: Vec<f32>,
    /// The line at hand, if it is a smooth one.
    smooth: Option<LineInterpolant<'a>>,
    job: &'j mut TileJob<'t>,
    scratch: &'j mut TileScratch<N>,
}

impl<'a, 'j, 't, const N: usize> InOrder<'a, 'j, 't, '_, N> {
    /// A run whose first primitive is given.
    fn new(
        work: &'a TileWork<'a>,
        first: Option<BinEntry>,
        job: &'j mut TileJob<'t>,
        scratch: &'j mut TileScratch<N>,
    ) -> Self {
        let plan = work.plan;
        let key = plan.pipeline.key();
        // A run is of one kind of primitive, and notes of the queue serve triangles alone.
        let gathers = gathers(plan) && matches!(first, Some(BinEntry::Triangles { .. }));
        let is_special = work.level.is_scalar() || const { N > 4 };
        Self {
            work,
            to: FragmentsTo::Attachments,
            samples: SampleSet::new(work.samples),
            source: work.varyings(),
            conservative: plan.pipeline.descriptor().primitive.conservative,
            uses_hiz: plan.timing != TestTiming::Late,
            blends_blocks: plan.path == TilePath::InOrderBlocks,
            shares_packets: plan.path != TilePath::InOrderPackets,
            needs_no_quads: key.needs_no_quads,
            primitives: first,
            gathers,
            joins_triangles: gathers && !is_special && joins_triangles(plan),
            stores_in_order: key.stores_in_order,
            listing: if is_special {
                Listing::None
            } else {
                Listing::of(plan)
            },
            ahead: None,
            passed: 0,
            planes: Vec::new(),
            smooth: None,
            job,
            scratch,
        }
    }
}

impl<const N: usize> InOrder<'_, '_, '_, '_, N> {
    /// True if fragments go to the run of visibility.
    #[inline(always)]
    fn is_shown(&self) -> bool {
        // Its fragments have one sample.
        N == 1 && self.to == FragmentsTo::Visibility
    }

    /// Notes that so many more primitives are drawn next.
    #[inline(always)]
    fn step(&mut self, primitives: usize) {
        if let Some(ahead) = &mut self.ahead {
            ahead.step(self.work.level, primitives);
        }
    }
}
