//! The visibility pass over the triangles of one bin: coverage, hierarchical z, writes.

use super::ONLY_WIDE;
use super::shortcuts::OrderKind;
use super::writer::{IdStorage, VisibilityTriangle, VisibilityWriter};
use crate::bounds::bins::BinEntry;
use crate::bounds::primitives::TrianglePacket;
use crate::fragment::interpolate::DepthPlane;
use crate::per_sample::hiz::{BlockClasses, HizQuery};
use crate::plan::tile_plan::TilePlan;
use crate::raster::SampleSet;
use crate::raster::triangle::TileTriangle;
use crate::tile_pass::{HIZ_PACKETS, TileJob, TilePass, TileScratch, TileWork};
use crate::tile_path::TilePath;
use estampe_simd::dispatch;

/// Rasterizes the tile's triangles of one run of a chunk.
pub(super) fn rasterize<const N: usize>(
    pass: &TilePass<'_>,
    work: &TileWork<'_>,
    entries: &[BinEntry],
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) {
    let mut entry_order = std::mem::take(&mut scratch.visibility.order);
    let order = entry_order.sort(work, entries);
    let mut id = scratch
        .visibility
        .buffer
        .add([work.number, work.sub_draw], entries, pass.plans);
    let path = work.plan.path;
    let mut pass = Rasterizer {
        work,
        samples: pass.sample_set(),
        order,
        storage: storage_of(work.plan),
        crosses_triangles: path == TilePath::VisibilityCrossTriangle,
        passed: 0,
        job,
        scratch,
    };
    let entry_of = |entry: &BinEntry| match *entry {
        BinEntry::Triangles { packet, lanes } => (packet, lanes),
        _ => unreachable!("lines and points are drawn in order"),
    };
    if order == OrderKind::NearestFirst {
        // Ids follow the order of submission, whatever that of rasterization.
        for number in entry_order.numbers() {
            let (packet, lanes) = entry_of(&entries[number as usize]);
            pass.entry(packet, lanes, id + number);
        }
    } else {
        for entry in entries {
            let (packet, lanes) = entry_of(entry);
            pass.entry(packet, lanes, id);
            id += lanes.count_ones();
        }
    }
    pass.flush_cross_triangle();
    if let (Some(queries), Some(query)) = (work.queries, work.plan.query) {
        queries.add(query, pass.passed);
    }
    scratch.visibility.order = entry_order;
}

/// Returns the storage for the IDs of a sub-draw's triangles.
pub(super) fn storage_of(plan: &TilePlan<'_>) -> IdStorage {
    if plan.path == TilePath::VisibilityDepthOnly {
        return IdStorage::None;
    }
    match plan.pipeline.color_targets() {
        [] => IdStorage::None,
        [first, ..] if first.codec.words() == 1 => IdStorage::Attachment,
        _ => IdStorage::Buffer,
    }
}

/// A run of a chunk in the visibility pass.
pub(super) struct Rasterizer<'a, 'j, 't, const N: usize> {
    pub(super) work: &'a TileWork<'a>,
    pub(super) samples: SampleSet<N>,
    order: OrderKind,
    pub(super) storage: IdStorage,
    /// True if fragments of small triangles are shaded immediately, in packets of one fragment of
    /// each of sixteen triangles.
    pub(super) crosses_triangles: bool,
    /// Samples that passed all tests, where a query counts them.
    pub(super) passed: u64,
    pub(super) job: &'j mut TileJob<'t>,
    pub(super) scratch: &'j mut TileScratch<N>,
}

impl<const N: usize> Rasterizer<'_, '_, '_, N> {
    /// Triangles of one packet; `id` is the first one's.
    fn entry(&mut self, packet: u32, lanes: u16, mut id: u32) {
        let packet = &self.work.chunk.triangles[packet as usize];
        if self.order != OrderKind::Submission {
            let lane = lanes.trailing_zeros() as usize;
            let look = self.hiz_query(DepthPlane::new(packet, lane));
            if !self.scratch.hiz.hides(&look, self.is_any_order()) {
                self.large(packet, lane, id);
            }
            return;
        }
        let mut small = 0;
        if const { N == 1 } {
            let (tile, rect) = (self.work.shape, &self.work.rect);
            let stored = self.work.plan.tests.stored;
            let cover = &mut self.scratch.visibility.small;
            small = dispatch!(@wide self.work.level, s => cover.cover(s, packet, lanes, (tile, rect), stored),
                scalar => unreachable!("{ONLY_WIDE}"));
        }
        // Small triangles between large ones go together.
        let first = id;
        let (mut left, mut run) = (lanes, 0);
        while left != 0 {
            let lane = left.trailing_zeros() as usize;
            left &= left - 1;
            if small >> lane & 1 == 1 {
                run |= 1 << lane;
            } else {
                self.small(packet, std::mem::take(&mut run), (lanes, first));
                self.large(packet, lane, id);
            }
            id += 1;
        }
        self.small(packet, run, (lanes, first));
    }

    /// Returns true if triangles are not in the order of submission.
    fn is_any_order(&self) -> bool {
        self.order == OrderKind::NearestFirst
    }

    fn hiz_query(&self, plane: DepthPlane) -> HizQuery<'_, N> {
        HizQuery {
            tests: &self.work.plan.tests,
            plane,
            tile: self.work.shape,
            samples: self.samples,
        }
    }

    /// A triangle of any size, by blocks and packets.
    fn large(&mut self, packet: &TrianglePacket, lane: usize, id: u32) {
        let TileWork {
            shape,
            rect,
            is_whole,
            blocks,
            level,
            plan,
            ..
        } = *self.work;
        let Some(triangle) = TileTriangle::<N>::new(packet, lane, shape, &rect, self.samples)
        else {
            return;
        };
        let plane = DepthPlane::new(packet, lane);
        let in_order = !self.is_any_order();
        // Leave out the blocks where everything is nearer already.
        let mut classes = BlockClasses::of_all(0, 0);
        if triangle.packets() > HIZ_PACKETS && plan.tests.depth.is_some() {
            // An equal depth that does not come in order may win by its id.
            let look = HizQuery {
                tests: &plan.tests,
                plane,
                tile: shape,
                samples: self.samples,
            };
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
        let triangle = VisibilityTriangle {
            plane,
            id,
            front: packet.front >> lane & 1 == 1,
        };
        let visibility = &mut self.scratch.visibility;
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
                writer.write_depths(level, &triangle, certain);
            }
        }
        if touched != 0 {
            single.write_out(level, touched, &mut writer);
            let list = visibility.list.items();
            writer.triangle(level, &triangle, others, list, in_order);
        }
        visibility.buffer.single = single;
        if plan.tests.writes_depth() {
            self.scratch.hiz.invalidate(touched);
            self.scratch.hiz.replace(certain, &classes);
        }
    }
}

/// Blocks of packets and whole ones, one bit each.
fn blocks_of(blocks: u16, packets: impl Iterator<Item = u16>) -> u16 {
    packets.fold(blocks, |all, packet| all | 1 << (packet >> 4 & 15))
}
