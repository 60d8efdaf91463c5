//! The end of a run: every visible sample is shaded once, by the triangle that it shows.
//!
//! A packet that shows one triangle is shaded whole. Of others each triangle's quads are shaded in
//! packets that they share with those of other triangles and places (`quads.rs`), or, if fragments
//! need no quads, its pixels (`pixels.rs`). A block of packets that shows one is queued at once
//! (`blocks.rs`). Where smaller triangles may show was noted when they
//! were covered, and is asked first (`touched.rs`). Draws that share a pipeline and bindings are
//! shaded together, and those of one colour come first.

mod blocks;
mod early;
mod groups;
mod ids;
mod per_draw;
mod per_primitive;
mod pixels;
mod quads;
mod touched;
mod visible;

use super::buffer::ShadingGroup;
use super::parts::Parts;
use super::quads::Quads;
use super::rasterize::{rasterize_waiting, storage_of};
use super::shortcuts::PrimitiveTexels;
use super::writer::IdStorage;
use super::{ONLY_WIDE, VisibilityScratch};
use crate::fragment::cross_triangle::CrossPlanes;
use crate::fragment::queue::{PrimitivePacket, packets_of_visibility};
use crate::pipeline::RenderPipeline;
use crate::pipeline::color_target::ColorTarget;
use crate::plan::tile_plan::TilePlan;
use crate::raster::{Covered, MAX_PACKETS, SampleSet, packet_origin};
use crate::tile_pass::fragments::Fragments;
use crate::tile_pass::{PacketSet, TileJob, TilePass, TileScratch, write_colors};
use early::write_cross_triangle;
use estampe_simd::{LANES, Lanes, dispatch};
use estampe_types::Interpolation;
use per_draw::DrawTexels;
use visible::VisibleTriangle;

/// No place in a list.
pub(super) const NONE: u32 = u32::MAX;

/// Parts of packets with as many pixels are shaded alone, of triangles whose packets are not noted.
const FEW_IDLE: u32 = 13;

/// All quads of a packet, by their first lanes.
const ALL_QUADS: u16 = 0x1111;

/// Lines of the next tile that are prefetched for a visible packet, at most.
const MOST_AHEAD: usize = 8;

/// Memory of the resolve.
#[derive(Debug)]
pub(super) struct ResolveScratch<const N: usize> {
    /// By visibility id: the triangle's place in `visible`.
    visible_of: Vec<u32>,
    visible: Vec<VisibleTriangle>,
    planes: Vec<f32>,
    quads: Quads<N>,
    parts: Parts<N>,
    /// Pixels of a packet's triangles, and planes of these.
    fragments: Box<Fragments>,
    cross: CrossPlanes,
    /// By shading group: the packets that show its triangles.
    packets: Vec<PacketSet>,
    texels: PrimitiveTexels,
    draws: DrawTexels,
    /// By visibility id: the number of the triangle's group; empty if there is one group.
    group_of: Vec<u32>,
}

impl<const N: usize> Default for ResolveScratch<N> {
    fn default() -> Self {
        Self {
            visible_of: Vec::new(),
            visible: Vec::new(),
            planes: Vec::new(),
            quads: Quads::default(),
            parts: Parts::default(),
            fragments: Box::default(),
            cross: CrossPlanes::default(),
            packets: Vec::new(),
            texels: PrimitiveTexels::default(),
            draws: DrawTexels::default(),
            group_of: Vec::new(),
        }
    }
}

/// Resolves the run, if there is one, and ends it.
pub(in crate::tile_pass) fn resolve<const N: usize>(
    pass: &TilePass<'_>,
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) {
    rasterize_waiting(pass, job, scratch);
    scratch.visibility.buffer.take_shown(pass.level);
    if scratch.visibility.buffer.groups.is_empty() {
        return;
    }
    clear_others(pass, job, scratch);
    let VisibilityScratch {
        buffer,
        resolve,
        cross,
        ..
    } = &mut scratch.visibility;
    // Draws without colours have no ids; all others have theirs in the same place.
    let mut plans = buffer
        .groups
        .iter()
        .map(|group| &pass.plans[group.sub_draw as usize]);
    if let Some(plan) = plans.find(|plan| storage_of(plan) != IdStorage::None) {
        let storage = storage_of(plan);
        scratch.statistics.visibility_runs += 1;
        let has_one_color_draws = buffer.has_one_color_draws;
        resolve.visible.clear();
        resolve.planes.clear();
        resolve.texels.clear();
        resolve.visible_of.clear();
        resolve.visible_of.resize(buffer.triangles.len(), NONE);
        if const { N <= 4 } {
            resolve.parts.begin_run(buffer.triangles.len());
        }
        let words = plan.pipeline.color_targets()[0].codec.words();
        if !cross.words().is_empty() {
            dispatch!(@wide pass.level, s => write_cross_triangle(s, (storage, words), job, scratch),
                scalar => unreachable!("{ONLY_WIDE}"));
        }
        let groups = std::mem::take(&mut scratch.visibility.buffer.groups);
        let mut resolver = Resolver::new(pass, storage, job, scratch);
        resolver.number_groups(&groups);
        let is_done = has_one_color_draws
            && dispatch!(@wide pass.level, s => resolver.fill_draws(s, &groups),
                scalar => unreachable!("{ONLY_WIDE}"));
        if !is_done {
            dispatch!(@wide pass.level, s => resolver.find_packets(s, &groups),
                scalar => unreachable!("{ONLY_WIDE}"));
            for (number, group) in groups.iter().enumerate() {
                resolver.group(group, number);
            }
        }
        scratch.visibility.buffer.groups = groups;
    }
    scratch.visibility.buffer.clear();
    scratch.visibility.cross.clear();
}

/// Clears the colours that wait for it, but for packets in which triangles that replace all of a
/// texel are shown everywhere. They are shaded next.
fn clear_others<const N: usize>(
    pass: &TilePass<'_>,
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) {
    if !std::mem::take(&mut scratch.colors_wait) {
        return;
    }
    let buffer = &scratch.visibility.buffer;
    let replaces = |sub_draw: u32| {
        let plan = &pass.plans[sub_draw as usize];
        let targets = plan.pipeline.color_targets();
        let replaces_all = targets.iter().all(ColorTarget::replaces)
            && !pass.clear.clears_colors_from(targets.len());
        replaces_all || storage_of(plan) == IdStorage::None
    };
    let mut others = [u64::MAX; MAX_PACKETS / 64];
    if buffer.groups.iter().all(|group| replaces(group.sub_draw)) {
        for packet in 0..MAX_PACKETS {
            let is_shown = buffer.shows_everywhere(packet);
            others[packet / 64] &= !(u64::from(is_shown) << (packet % 64));
            scratch.statistics.packets_shown_uncleared += u64::from(is_shown);
        }
    }
    pass.clear.waiting_colors::<N>(pass, job, Some(&others));
}

/// A run being resolved.
struct Resolver<'a, 'j, 't, const N: usize> {
    pass: &'a TilePass<'a>,
    storage: IdStorage,
    /// The state of the group at hand.
    plan: &'a TilePlan<'a>,
    /// The interpolation of each scalar of the varyings.
    modes: &'a [Interpolation],
    /// True if the run has one group, which every remaining sample shows.
    is_only_group: bool,
    /// The tile's first pixel.
    origin: [i32; 2],
    /// Packets of the tile.
    packets: usize,
    samples: SampleSet<N>,
    /// The pipeline that the queue is ready for, while draws of one colour are shaded.
    shaded_last: Option<&'a RenderPipeline>,
    job: &'j mut TileJob<'t>,
    scratch: &'j mut TileScratch<N>,
}

impl<'a, 'j, 't, const N: usize> Resolver<'a, 'j, 't, N> {
    fn new(
        pass: &'a TilePass<'a>,
        storage: IdStorage,
        job: &'j mut TileJob<'t>,
        scratch: &'j mut TileScratch<N>,
    ) -> Self {
        let (x, y) = pass.grid.tile_origin(job.tile);
        Self {
            pass,
            storage,
            plan: &pass.plans[0],
            modes: &[],
            is_only_group: false,
            origin: [x.cast_signed(), y.cast_signed()],
            packets: pass.grid.tile_pixels() / LANES,
            samples: pass.sample_set(),
            shaded_last: None,
            job,
            scratch,
        }
    }

    /// Shades the samples that show a group's triangles.
    fn group(&mut self, group: &ShadingGroup, number: usize) {
        let packets = self.scratch.visibility.resolve.packets[number];
        if packets == [0; MAX_PACKETS / 64] {
            return;
        }
        self.plan = &self.pass.plans[group.sub_draw as usize];
        self.modes = &self.plan.pipeline.interface().varyings;
        self.scratch.visibility.resolve.quads.begin_group();
        self.scratch.visibility.resolve.parts.begin_group();
        self.scratch.queue.configure(
            self.plan.pipeline,
            self.samples,
            self.plan.tests.stored.range,
            (false, packets_of_visibility(self.plan.pipeline)),
        );
        let level = self.pass.level;
        let key = self.plan.pipeline.key();
        if const { N <= 4 } && key.needs_no_quads && !key.uniform_over_primitive {
            dispatch!(@wide level, s => self.touched(s, group),
                scalar => unreachable!("{ONLY_WIDE}"));
        }
        dispatch!(@wide level, s => self.packets(s, group, packets),
            scalar => unreachable!("{ONLY_WIDE}"));
        let resolve = &self.scratch.visibility.resolve;
        // A shader needs quads, or not.
        if !resolve.quads.is_empty() {
            dispatch!(@wide level, s => self.listed_quads(s, group),
                scalar => unreachable!("{ONLY_WIDE}"));
        } else if !resolve.parts.is_empty() {
            dispatch!(@wide level, s => self.noted_parts(s, group),
                scalar => unreachable!("{ONLY_WIDE}"));
        }
        self.flush();
    }

    /// Queues the visible samples of a group, packet by packet.
    #[inline(always)]
    fn packets<S: Lanes>(&mut self, s: S, group: &ShadingGroup, packets: PacketSet) {
        let key = self.plan.pipeline.key();
        let per_primitive = key.uniform_over_primitive;
        let lists_quads = const { N == 1 } && !key.needs_no_quads && !per_primitive;
        let visible = packets.iter().map(|packets| packets.count_ones() as usize);
        let lines = self.job.next.len().div_ceil(visible.sum::<usize>().max(1));
        let lines = lines.min(MOST_AHEAD);
        for (from, mut packets) in (0..).step_by(64).zip(packets) {
            while packets != 0 {
                let number = from + packets.trailing_zeros() as usize;
                #[expect(clippy::cast_possible_truncation, reason = "a tile has 256 packets")]
                let packet = number as u16;
                let block = 0xFFFF << (number % 64 / LANES * LANES);
                let is_whole = packets & block == block;
                packets &= packets - 1;
                let single = self.scratch.visibility.buffer.single.of_packet(number);
                if let (Some(id), true) = (single, per_primitive)
                    && group.ids.contains(&id)
                {
                    self.fill_block(s, id, number);
                    packets &= !block;
                    continue;
                }
                self.job.next.step(s, lines);
                if let Some(id) = single
                    && group.ids.contains(&id)
                    && is_whole
                    && self.queue_block(id, packet)
                {
                    packets &= !block;
                    self.job.next.step(s, lines * (LANES - 1));
                    continue;
                }
                let mut left = match single {
                    Some(id) if group.ids.contains(&id) => self.samples.whole(),
                    Some(_) => continue,
                    None => self.take_unresolved(s, number, group),
                };
                let mut only = single;
                if lists_quads && single.is_none() {
                    only = self.list_quads(s, number, left);
                    if only.is_none() {
                        continue;
                    }
                }
                while left != [0; N] {
                    let (id, covered) = match only {
                        Some(id) => (id, std::mem::replace(&mut left, [0; N])),
                        None => self.take_first(s, number, &mut left),
                    };
                    let covered = Covered {
                        packet,
                        masks: covered,
                    };
                    if per_primitive {
                        self.fill(s, id, &covered);
                    } else {
                        self.queue(s, id, &covered);
                    }
                }
            }
        }
    }

    /// Queues a triangle's part of a packet if few lanes of it are idle; otherwise notes its
    /// pixels, or its quads.
    #[inline(always)]
    fn queue<S: Lanes>(&mut self, s: S, id: u32, covered: &Covered<N>) {
        let any = covered.any();
        let needs_no_quads = self.plan.pipeline.key().needs_no_quads;
        if const { N <= 4 } && needs_no_quads && any.count_ones() < FEW_IDLE {
            self.scratch.visibility.resolve.parts.add(id, *covered);
            return;
        }
        let quads = quads_of(any);
        if quads != ALL_QUADS && !(const { N <= 4 } && needs_no_quads) {
            let resolve = &mut self.scratch.visibility.resolve;
            resolve.quads.add(id, *covered, quads);
            return;
        }
        let visible = self.visible(id);
        if self.scratch.queue.is_full() {
            self.flush();
        }
        self.push(s, visible, covered);
    }

    /// Queues a packet of a visible triangle.
    #[inline(always)]
    fn push<S: Lanes>(&mut self, s: S, visible: usize, covered: &Covered<N>) {
        let (x, y) = packet_origin(u32::from(covered.packet));
        let pixel = [self.origin[0] + x, self.origin[1] + y];
        let TileScratch {
            queue, visibility, ..
        } = &mut *self.scratch;
        let (triangle, front) = visibility.resolve.interpolant(visible, self.plan);
        let packet = PrimitivePacket {
            alive: *covered,
            covered: covered.masks,
            pixel,
            front,
            sample: None,
        };
        queue.push(s, &triangle, &packet);
    }

    /// Shades the queued packets and stores their colours.
    fn flush(&mut self) {
        let queue = &mut self.scratch.queue;
        if queue.is_empty() {
            return;
        }
        let level = self.pass.level;
        let fragments = queue.shade(level, self.plan.pipeline, self.plan.bindings);
        self.scratch.statistics.fragments_shaded += fragments;
        let batch = queue.batch();
        write_colors(self.plan, level, &batch, &mut self.job.colors);
        queue.clear();
    }
}

/// The quads of which some lane is among these, by their first lanes.
#[inline(always)]
fn quads_of(lanes: u16) -> u16 {
    (lanes | lanes >> 1 | lanes >> 2 | lanes >> 3) & ALL_QUADS
}
