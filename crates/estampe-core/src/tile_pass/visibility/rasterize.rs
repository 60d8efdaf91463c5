//! The visibility pass over the triangles of one bin: coverage, hierarchical z, writes.

use super::buffer::TriangleRef;
use super::gathered::GatheredTriangles;
use super::shortcuts::{OrderKind, WaitingTriangle};
use super::writer::{IdStorage, VisibilityTriangle, VisibilityWriter};
use super::{Ahead, ONLY_WIDE};
use crate::bounds::bins::BinEntry;
use crate::bounds::primitives::TrianglePacket;
use crate::fragment::interpolate::{DepthPlane, VaryingSource};
use crate::per_sample::hiz::{BlockClasses, HierarchicalZ, HizQuery};
use crate::per_sample::packet_ranges::PacketRanges;
use crate::plan::tile_plan::TilePlan;
use crate::raster::SampleSet;
use crate::raster::triangle::TileTriangle;
use crate::tile_pass::{HIZ_PACKETS, TileJob, TilePass, TileScratch, TileWork, clear_blocks};
use crate::tile_path::TilePath;
use estampe_simd::{Lane, dispatch};

/// Lines of the next tile that are prefetched for a packet of triangles.
const AHEAD: usize = 4;

/// Rasterizes the tile's triangles of one run of a chunk in the order of submission; `id` is the
/// first one's.
pub(super) fn rasterize<const N: usize>(
    pass: &TilePass<'_>,
    (work, entries): (&TileWork<'_>, &[BinEntry]),
    mut id: u32,
    (job, ahead): (&mut TileJob<'_>, &mut Ahead<'_>),
    scratch: &mut TileScratch<N>,
) {
    let mut rasterizer = Rasterizer::new(pass, work, OrderKind::Submission, job, scratch);
    // Fragments of small triangles that are shaded at once read more than is gathered.
    let gathers = entries.len() > 1 && !rasterizer.crosses_triangles;
    if rasterizer.crosses_triangles {
        rasterizer.varyings = Some(work.varyings());
    }
    let mut gathered = GatheredTriangles::new();
    for entry in entries {
        ahead.step(work.level);
        let BinEntry::Triangles { packet, lanes } = *entry else {
            unreachable!("lines and points are drawn in order");
        };
        let triangles = &work.packets.triangles[packet as usize];
        if gathers && gathered.add(triangles, lanes) {
            continue;
        }
        id += rasterizer.gathered(&mut gathered, id);
        if !gathers || !gathered.add(triangles, lanes) {
            rasterizer.entry((triangles, packet), lanes, id);
            id += lanes.count_ones();
        }
    }
    rasterizer.gathered(&mut gathered, id);
    rasterizer.flush_cross_triangle();
    if let (Some(queries), Some(query)) = (work.queries, work.plan.query) {
        queries.add(query, rasterizer.passed);
    }
}

/// Rasterizes the large triangles that wait, nearest first. Their ids keep the order of
/// submission.
pub(super) fn rasterize_waiting<const N: usize>(
    pass: &TilePass<'_>,
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) {
    if scratch.visibility.waiting.is_empty() {
        return;
    }
    scratch.visibility.buffer.take_shown(pass.level);
    let mut waiting = std::mem::take(&mut scratch.visibility.waiting);
    let order = waiting.sort();
    let mut work: Option<TileWork<'_>> = None;
    let is_any_order = order == OrderKind::NearestFirst;
    let hidden_from = |hiz: &HierarchicalZ| hiz.hidden_from(waiting.compare(), is_any_order);
    let mut hidden = hidden_from(&scratch.hiz);
    for WaitingTriangle { nearest, id, .. } in waiting.triangles() {
        if hidden.hides(*nearest) {
            continue;
        }
        let id = *id;
        let triangle = scratch.visibility.buffer.triangles[id as usize];
        let run = [triangle.chunk, triangle.sub_draw];
        let work = match &mut work {
            Some(work) if [work.number, work.sub_draw] == run => work,
            work => work.insert(TileWork::new(pass, run, job.tile)),
        };
        let mut rasterizer = Rasterizer::new(pass, work, order, job, scratch);
        rasterizer.waiting(triangle.packet, triangle.lane, id);
        hidden = hidden_from(&scratch.hiz);
    }
    waiting.clear();
    scratch.visibility.waiting = waiting;
    clear_blocks(pass, job, u16::MAX, scratch);
}

/// Returns the storage for the IDs of a sub-draw's triangles.
pub(super) fn storage_of(plan: &TilePlan<'_>) -> IdStorage {
    if plan.path == TilePath::VisibilityDepthOnly {
        return IdStorage::None;
    }
    match plan.pipeline.color_targets() {
        [] => IdStorage::None,
        [first, ..] if first.codec.words() == 1 => IdStorage::Attachment,
        _ => IdStorage::BufferData,
    }
}

/// A run of a chunk in the visibility pass.
pub(super) struct Rasterizer<'a, 'j, 't, const N: usize> {
    pass: &'j TilePass<'j>,
    pub(super) work: &'a TileWork<'a>,
    pub(super) samples: SampleSet<N>,
    order: OrderKind,
    pub(super) storage: IdStorage,
    /// True if fragments of small triangles are shaded immediately, in packets of one fragment of
    /// each of sixteen triangles.
    pub(super) crosses_triangles: bool,
    /// The varyings that these read.
    pub(super) varyings: Option<VaryingSource<'a>>,
    /// True if the packets that triangles touch are noted: their fragments have colours, and need
    /// no quads.
    pub(super) notes_packets: bool,
    /// True if triangles change stencil values and store no depth.
    counts: bool,
    /// Samples that passed all tests, where a query counts them.
    pub(super) passed: u64,
    pub(super) job: &'j mut TileJob<'t>,
    pub(super) scratch: &'j mut TileScratch<N>,
}

impl<'a, 'j, 't, const N: usize> Rasterizer<'a, 'j, 't, N> {
    fn new(
        pass: &'j TilePass<'j>,
        work: &'a TileWork<'a>,
        order: OrderKind,
        job: &'j mut TileJob<'t>,
        scratch: &'j mut TileScratch<N>,
    ) -> Self {
        let storage = storage_of(work.plan);
        let key = work.plan.pipeline.key();
        let is_by_pixels = key.needs_no_quads && !key.uniform_over_primitive;
        Self {
            pass,
            work,
            samples: pass.sample_set(),
            order,
            storage,
            crosses_triangles: work.plan.path == TilePath::VisibilityCrossTriangle,
            varyings: None,
            notes_packets: N <= 4 && is_by_pixels && storage != IdStorage::None,
            counts: PacketRanges::serve(&work.plan.tests),
            passed: 0,
            job,
            scratch,
        }
    }

    /// A triangle that waited, which is large.
    fn waiting(&mut self, packet: u32, lane: u8, id: u32) {
        let packet = &self.work.packets.triangles[packet as usize];
        let lane = usize::from(lane);
        let TileWork { shape, rect, .. } = self.work;
        let triangle = packet.triangle(lane);
        if let Some(covering) = TileTriangle::new(&triangle, *shape, rect, self.samples) {
            self.large((packet, lane), &covering, id);
        }
    }

    /// Triangles that were gathered, the first of which has the id `id`. Returns how many they are.
    fn gathered(&mut self, gathered: &mut GatheredTriangles, id: u32) -> u32 {
        let (packet, lanes) = gathered.triangles();
        if lanes != 0 {
            self.entry((packet, u32::MAX), lanes, id);
            self.scratch.statistics.triangles_gathered_in_tiles += u64::from(lanes.count_ones());
        }
        gathered.clear();
        lanes.count_ones()
    }

    /// Triangles of one packet, small and large; `id` is the first one's. The packet's number is
    /// asked for where fragments have ids of their own.
    fn entry(&mut self, (packet, number): (&TrianglePacket, u32), lanes: u16, mut id: u32) {
        let mut small = 0;
        if const { N <= 4 } {
            let tile = (self.work.shape, &self.work.rect);
            let cover = &mut self.scratch.visibility.small;
            let next = &mut self.job.next;
            small = dispatch!(@wide self.work.level, s => {
                    next.step(s, AHEAD);
                    cover.cover(s, packet, lanes, tile, self.samples)
                },
                scalar => unreachable!("{ONLY_WIDE}"));
        }
        let large = lanes & !small;
        self.set_up_edges(packet, large);
        // Small triangles between large ones go together, and so do large ones that count.
        let first = id;
        let (mut left, mut run, mut counting) = (lanes, 0, 0);
        while left != 0 {
            let lane = left.trailing_zeros() as usize;
            left &= left - 1;
            let bit = 1 << lane;
            if small & bit != 0 {
                self.counting(packet, std::mem::take(&mut counting), (lanes, first));
                run |= bit;
            } else {
                self.small(packet, std::mem::take(&mut run), (lanes, first));
                let lane = Lane::new(lane);
                if self.counts && !self.crosses_triangles {
                    counting |= bit;
                } else if let Some(covering) = self.covering(packet, lane) {
                    let id = if self.crosses_triangles {
                        self.number_large(number, lane.get())
                    } else {
                        id
                    };
                    if self.counts {
                        self.counting(packet, bit, (bit, id));
                    } else {
                        self.large((packet, lane.get()), &covering, id);
                    }
                }
            }
            id += 1;
        }
        self.counting(packet, counting, (lanes, first));
        self.small(packet, run, (lanes, first));
    }

    /// The id of a large triangle among small ones whose fragments have ids of their own.
    #[expect(clippy::cast_possible_truncation, reason = "a lane is below 16")]
    fn number_large(&mut self, packet: u32, lane: usize) -> u32 {
        let buffer = &mut self.scratch.visibility.buffer;
        buffer.add_one(TriangleRef {
            chunk: self.work.number,
            packet,
            sub_draw: self.work.sub_draw,
            lane: lane as u8,
        })
    }

    /// Sets up the edges of a packet's large triangles together, if there are several.
    fn set_up_edges(&mut self, packet: &TrianglePacket, lanes: u16) {
        let edges = &mut self.scratch.visibility.edges;
        edges.clear();
        // Of many samples, an edge has many constants.
        if const { N <= 4 } && lanes & lanes.wrapping_sub(1) != 0 {
            let tile = (self.work.shape, &self.work.rect);
            let set_up = dispatch!(@wide self.work.level, s => edges.set_up(s, packet, lanes, tile, self.samples),
                scalar => unreachable!("{ONLY_WIDE}"));
            self.scratch.statistics.triangles_set_up_in_lanes += u64::from(set_up.count_ones());
        }
    }

    /// The coverage of a large triangle, unless it covers nothing of the tile.
    #[inline(always)]
    pub(super) fn covering(&self, packet: &TrianglePacket, lane: Lane) -> Option<TileTriangle<N>> {
        if let Some(found) = self.scratch.visibility.edges.triangle(lane) {
            return found;
        }
        let TileWork { shape, rect, .. } = self.work;
        TileTriangle::new(&packet.triangle(lane.get()), *shape, rect, self.samples)
    }

    /// Returns true if triangles are not in the order of submission.
    fn is_any_order(&self) -> bool {
        self.order == OrderKind::NearestFirst
    }

    pub(super) fn hiz_query(&self, plane: DepthPlane, front: bool) -> HizQuery<'a, N> {
        let plan = self.work.plan;
        HizQuery {
            tests: &plan.tests,
            plane,
            tile: self.work.shape,
            samples: self.samples,
            passes_in_vain: self.storage == IdStorage::None
                && plan.query.is_none()
                && plan.tests.passing_keeps(front),
        }
    }

    /// Clears what waits for it of the blocks that a triangle touches, but for those all of whose
    /// depths it replaces, and whose colours will be its own.
    fn clear_touched(&mut self, mut touched: u16, certain: u16) {
        // Of several samples, all attachments wait, and triangles may have colours in a few.
        let replaces = const { N == 1 }
            && self.storage != IdStorage::None
            && self.work.plan.tests.writes_depth();
        if replaces {
            let waiting = self.scratch.blocks_wait & certain;
            self.scratch.blocks_wait &= !certain;
            self.scratch.statistics.blocks_uncleared += u64::from(waiting.count_ones());
        } else {
            touched |= certain;
        }
        clear_blocks(self.pass, self.job, touched, self.scratch);
    }

    /// A triangle of any size, by blocks and packets.
    fn large(
        &mut self,
        (packet, lane): (&TrianglePacket, usize),
        triangle: &TileTriangle<N>,
        id: u32,
    ) {
        let TileWork {
            shape,
            rect,
            is_whole,
            blocks,
            level,
            plan,
            ..
        } = *self.work;
        let plane = DepthPlane::of_lane(packet, lane);
        let front = packet.front >> lane & 1 == 1;
        let seen = VisibilityTriangle { plane, id, front };
        let in_order = !self.is_any_order();
        // Leave out the blocks where everything is nearer already.
        let mut classes = BlockClasses::of_all(0, 0);
        if triangle.packets() > HIZ_PACKETS && plan.tests.depth.is_some() {
            // An equal depth that does not come in order may win by its id.
            let look = self.hiz_query(plane, front);
            let hiz = &mut self.scratch.hiz;
            classes = hiz.classify(level, &look, !in_order, self.job.depth);
            if classes.hidden == u16::MAX {
                return;
            }
        }
        let list = &mut self.scratch.visibility.list;
        list.clear();
        let hidden = classes.hidden;
        let whole = dispatch!(@wide level, s => triangle.cover(s, shape, hidden, blocks, list),
            scalar => unreachable!("{ONLY_WIDE}"));
        if !is_whole {
            list.clip(&rect);
        }
        // Without a test everything passes.
        let certain = match plan.tests.depth {
            _ if !plan.tests.is_depth_alone() => 0,
            Some(_) => whole & classes.certain,
            None => whole,
        };
        if plan.query.is_some() {
            self.passed += u64::from(certain.count_ones()) * 256 * self.samples.count() as u64;
        }
        let others = whole & !certain;
        let touched = blocks_of(others, list.items().iter().map(|item| item.packet));
        if self.scratch.blocks_wait != 0 {
            self.clear_touched(touched, certain);
        }
        let visibility = &mut self.scratch.visibility;
        if in_order && self.notes_packets {
            visibility.buffer.touched.add(id, visibility.list.items());
        }
        let mut single = std::mem::take(&mut visibility.buffer.single);
        let counts = plan.query.is_some().then_some(&mut self.passed);
        let target = (&plan.tests, self.samples, shape);
        let buffer = &mut visibility.buffer;
        let mut writer = VisibilityWriter::new(target, self.storage, self.job, buffer, counts);
        if certain != 0 {
            if self.storage != IdStorage::None {
                single.set(certain, id);
            }
            if plan.tests.writes_depth() {
                writer.write_depths(level, &seen, certain);
                if plane.is_level() {
                    let blocks = u64::from(certain.count_ones());
                    self.scratch.statistics.blocks_of_one_depth += blocks;
                }
            }
        }
        if touched != 0 {
            single.write_out(level, touched, &mut writer);
            let list = visibility.list.items();
            writer.triangle(level, &seen, others, list, in_order);
        }
        visibility.buffer.single = single;
        if plan.tests.writes_depth() {
            self.scratch.hiz.invalidate(touched);
            self.scratch.hiz.replace(certain, &classes);
        }
    }
}

/// Blocks of packets and whole ones, one bit each.
pub(super) fn blocks_of(blocks: u16, packets: impl Iterator<Item = u16>) -> u16 {
    packets.fold(blocks, |all, packet| all | 1 << (packet >> 4 & 15))
}
