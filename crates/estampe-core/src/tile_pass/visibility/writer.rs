//! The visibility pass's writes: tests triangles at samples, and writes the ids of those that pass.
//!
//! *In* coverage and depth of triangles · *Out* depth, stencil, ids · *Space* window.
//!
//! The order of triangles decides only between equal depths where the comparison orders depths and
//! nothing else is tested; then they may come in any order, ids breaking ties: large triangles
//! front to back.

use super::ONLY_WIDE;
use super::buffer::{ShownSamples, VisibilityBuffer};
use crate::depth_format::StoredDepth;
use crate::fragment::interpolate::{DepthPlane, PlaneBlock, evaluate};
use crate::per_sample::compare::prefers_less;
use crate::per_sample::sample_tests::{SampleTests, StoredSamples};
use crate::per_sample::stencil::FaceLanes;
use crate::raster::{Covered, MAX_PACKETS, SampleSet, TileShape, packet_origin};
use crate::tile_pass::TileJob;
use estampe_simd::{
    Bytes, LANES, Lanes, Level, SimdBase, dispatch, f32x16, i32x16, mask32x16, u32x16,
};
use estampe_types::state::CompareFunction;

/// A triangle of the visibility pass.
#[derive(Debug, Clone, Copy)]
pub(super) struct VisibilityTriangle {
    pub(super) plane: DepthPlane,
    pub(super) id: u32,
    pub(super) front: bool,
}

impl VisibilityTriangle {
    /// Returns true if no depth in the tile needs clamping. The plane is monotone in x and in y,
    /// rounding included, so its extremes are at corners. A depth at an end of the range counts as
    /// outside, because of −0.
    #[inline(always)]
    fn is_within(&self, tile: TileShape, [low, high]: [f32; 2]) -> bool {
        let DepthPlane { origin, z } = self.plane;
        let side = tile.side() as f32;
        let (x, y) = (tile.x as f32 - origin.x, tile.y as f32 - origin.y);
        // Samples lie between the pixel's edges, which are corners of a somewhat larger square.
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
        corners.iter().all(|[right, lower]| {
            let (x, y) = (x + right * side, y + lower * side);
            let depth = z.origin + (x * z.dx + y * z.dy);
            depth > low && depth < high
        })
    }
}

/// The kinds of sample test that are known at compile time, with a copy of the loops for each.
mod test_kind {
    /// *Less* in order, with writes, depth alone: most draws.
    pub(super) const LESS: u8 = 0;
    /// Any tests, in order.
    pub(super) const IN_ORDER: u8 = 1;
    /// Depth alone, in any order: ids break ties.
    pub(super) const ANY_ORDER: u8 = 2;
}

/// A tile's attachments during the visibility pass.
pub(super) struct VisibilityWriter<'a, const N: usize> {
    pub(super) tests: &'a SampleTests,
    pub(super) samples: SampleSet<N>,
    pub(super) tile: TileShape,
    /// Empty where there is none.
    pub(super) depth: &'a mut [[f32; LANES]],
    /// Empty where there is none.
    pub(super) stencil: &'a mut [[u8; LANES]],
    /// The ids; empty where fragments have no colours.
    pub(super) ids: &'a mut [[u32; LANES]],
    pub(super) unresolved: &'a mut [[u16; N]; MAX_PACKETS],
    pub(super) shown: &'a mut ShownSamples,
    /// Samples that passed all tests, where a query counts them.
    pub(super) passed: Option<&'a mut u64>,
}

/// The storage of a triangle's IDs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum IdStorage {
    /// Fragments have no colours.
    None,
    /// In the first colour attachment.
    Attachment,
    /// Beside the attachments.
    BufferData,
}

impl<'a, const N: usize> VisibilityWriter<'a, N> {
    /// The writer of a tile.
    pub(super) fn new(
        (tests, samples, tile): (&'a SampleTests, SampleSet<N>, TileShape),
        storage: IdStorage,
        job: &'a mut TileJob<'_>,
        buffer: &'a mut VisibilityBuffer<N>,
        passed: Option<&'a mut u64>,
    ) -> Self {
        let ids: &mut [[u32; LANES]] = match storage {
            IdStorage::None => &mut [],
            IdStorage::Attachment => job.colors[0],
            IdStorage::BufferData => &mut buffer.ids[..],
        };
        Self {
            tests,
            samples,
            tile,
            depth: job.depth,
            stencil: job.stencil,
            ids,
            unresolved: &mut buffer.unresolved,
            shown: &mut buffer.shown,
            passed,
        }
    }

    /// Returns true if triangles have ids: their fragments have colours.
    pub(super) fn has_ids(&self) -> bool {
        !self.ids.is_empty()
    }

    /// Returns the index of the line that stores the depths and IDs of a packet's sample.
    #[inline(always)]
    fn line_of(&self, packet: usize, sample: usize) -> usize {
        packet * self.samples.count() + sample
    }

    /// Adds a triangle in whole blocks of 16×16 pixels and in a list of packets. `in_order` says
    /// that all triangles come in the order of submission.
    pub(super) fn triangle(
        &mut self,
        level: Level,
        triangle: &VisibilityTriangle,
        blocks: u16,
        list: &[Covered<N>],
        in_order: bool,
    ) {
        use test_kind::{ANY_ORDER, IN_ORDER, LESS};
        let unreachable = || unreachable!("{ONLY_WIDE}");
        if !in_order {
            dispatch!(@wide level, s => self.lanes::<_, ANY_ORDER>(s, triangle, blocks, list),
                scalar => unreachable());
        } else if self.tests_less_alone() && self.passed.is_none() {
            dispatch!(@wide level, s => self.lanes::<_, LESS>(s, triangle, blocks, list),
                scalar => unreachable());
        } else {
            dispatch!(@wide level, s => self.lanes::<_, IN_ORDER>(s, triangle, blocks, list),
                scalar => unreachable());
        }
    }

    /// Returns true if the only test is *less* of depth, with writes.
    #[inline(always)]
    pub(super) fn tests_less_alone(&self) -> bool {
        let state = self.tests.depth;
        self.tests.is_depth_alone()
            && state
                .is_some_and(|state| state.write_enabled && state.compare == CompareFunction::Less)
    }

    #[inline(always)]
    fn lanes<S: Lanes, const KIND: u8>(
        &mut self,
        s: S,
        triangle: &VisibilityTriangle,
        blocks: u16,
        list: &[Covered<N>],
    ) {
        // The stencil test of the triangle's face.
        let face = match &self.tests.stencil {
            Some(test) if KIND == test_kind::IN_ORDER => Some(test.face(triangle.front).lanes(s)),
            _ => None,
        };
        let face = face.as_ref();
        self.blocks::<S, KIND>(s, triangle, face, blocks);
        let plane = &triangle.plane;
        let offsets = self.samples.offsets();
        for item in list {
            let (x, y) = packet_origin(u32::from(item.packet));
            let pixel = [self.tile.x + x, self.tile.y + y];
            for (sample, &offset) in offsets.iter().enumerate().take(self.samples.count()) {
                let distances = plane.origin.distances(s, pixel, offset);
                let depth = evaluate(s, &plane.z, distances);
                let z = if KIND == test_kind::IN_ORDER {
                    self.tests.comparable(s, depth)
                } else {
                    self.tests.stored.of(s, depth)
                };
                let at = [usize::from(item.packet), sample];
                self.packet::<S, KIND>(s, at, z, item.masks[sample], (triangle, face));
            }
        }
    }

    /// Adds a triangle in blocks that it covers whole.
    #[inline(always)]
    fn blocks<S: Lanes, const KIND: u8>(
        &mut self,
        s: S,
        triangle: &VisibilityTriangle,
        face: Option<&FaceLanes<S>>,
        mut blocks: u16,
    ) {
        if blocks == 0 {
            return;
        }
        let needs_clamp = !triangle.is_within(self.tile, self.tests.stored.range);
        while blocks != 0 {
            let block = blocks.trailing_zeros();
            blocks &= blocks - 1;
            let offsets = self.samples.offsets();
            for (sample, &offset) in offsets.iter().enumerate().take(self.samples.count()) {
                let depths = self.block_depths(s, &triangle.plane, block, offset);
                for packet in 0..LANES {
                    let z = if KIND == test_kind::IN_ORDER {
                        self.tests.comparable(s, depths.at(packet))
                    } else {
                        block_depth(s, self.tests.stored, &depths, packet, needs_clamp)
                    };
                    let at = [block as usize * LANES + packet, sample];
                    self.packet::<S, KIND>(s, at, z, u16::MAX, (triangle, face));
                }
            }
        }
    }

    #[inline(always)]
    fn block_depths<S: Lanes>(
        &self,
        s: S,
        plane: &DepthPlane,
        block: u32,
        offset: [f32; 2],
    ) -> PlaneBlock<S> {
        let (x, y) = packet_origin(block * 16);
        let pixel = [self.tile.x + x, self.tile.y + y];
        PlaneBlock::new(s, &plane.origin, &plane.z, pixel, offset)
    }

    /// Writes a triangle's depths to blocks in which all of its samples pass.
    pub(super) fn write_depths(
        &mut self,
        level: Level,
        triangle: &VisibilityTriangle,
        blocks: u16,
    ) {
        dispatch!(@wide level, s => self.write_depth_lanes(s, triangle, blocks),
            scalar => unreachable!("{ONLY_WIDE}"));
    }

    #[inline(always)]
    fn write_depth_lanes<S: Lanes>(
        &mut self,
        s: S,
        triangle: &VisibilityTriangle,
        mut blocks: u16,
    ) {
        let needs_clamp = !triangle.is_within(self.tile, self.tests.stored.range);
        while blocks != 0 {
            let block = blocks.trailing_zeros();
            blocks &= blocks - 1;
            let offsets = self.samples.offsets();
            for (sample, &offset) in offsets.iter().enumerate().take(self.samples.count()) {
                let depths = self.block_depths(s, &triangle.plane, block, offset);
                let stored = self.tests.stored;
                // From the sample's first line on, a packet's lines apart.
                let first = self.line_of(block as usize * LANES, sample);
                let (lines, step) = (&mut self.depth[first..], self.samples.count());
                let lines = &mut lines[..(LANES - 1) * step + 1];
                if triangle.plane.is_level() {
                    let z = block_depth(s, stored, &depths, 0, needs_clamp);
                    for line in lines.iter_mut().step_by(step) {
                        z.store_array(line);
                    }
                    continue;
                }
                for packet in 0..LANES {
                    let z = block_depth(s, stored, &depths, packet, needs_clamp);
                    z.store_array(&mut lines[packet * step]);
                }
            }
        }
    }

    /// Tests sixteen samples, and writes the id of the triangle where it passes.
    #[inline(always)]
    fn packet<S: Lanes, const KIND: u8>(
        &mut self,
        s: S,
        [packet, sample]: [usize; 2],
        new: f32x16<S>,
        lanes: u16,
        (triangle, face): (&VisibilityTriangle, Option<&FaceLanes<S>>),
    ) {
        let line = self.line_of(packet, sample);
        let unresolved = &mut self.unresolved[packet % MAX_PACKETS][sample];
        let passes = match (KIND, self.tests.depth, self.depth.get_mut(line)) {
            (test_kind::LESS, _, Some(stored)) => {
                let old = f32x16::load_array_ref(s, stored);
                let passes = s.mask_from_bits(lanes) & new.simd_lt(old);
                s.replace_masked_f32(stored, passes, new);
                passes
            }
            (test_kind::ANY_ORDER, Some(state), Some(stored)) => {
                let old = f32x16::load_array_ref(s, stored);
                let ids = self.ids.get(line).map_or([0; LANES], |ids| *ids);
                let ids = (u32x16::load_array(s, ids), *unresolved);
                let wins = nearer_or_first(s, state.compare, [new, old], ids, triangle.id);
                let passes = s.mask_from_bits(lanes) & wins;
                if state.write_enabled {
                    s.replace_masked_f32(stored, passes, new);
                }
                passes
            }
            (_, _, stored) => {
                let stored = StoredSamples {
                    depth: stored,
                    stencil: self.stencil.get_mut(line),
                };
                let passed = self.tests.run_face(s, new, lanes, face, stored);
                if let Some(count) = &mut self.passed {
                    **count += u64::from(passed.count_ones());
                }
                s.mask_from_bits(passed)
            }
        };
        if let Some(ids) = self.ids.get_mut(line) {
            let id = <u32x16<S> as SimdBase<S>>::splat(s, triangle.id);
            s.replace_masked(ids, passes, id);
            *unresolved |= s.bits_of_mask(passes);
        }
    }

    /// Writes the ids of whole blocks, by block.
    pub(super) fn write_ids(&mut self, level: Level, blocks: u16, ids: &[u32; LANES]) {
        dispatch!(@wide level, s => self.write_id_lanes(s, blocks, ids),
            scalar => unreachable!("{ONLY_WIDE}"));
    }

    #[inline(always)]
    fn write_id_lanes<S: Lanes>(&mut self, s: S, mut blocks: u16, ids: &[u32; LANES]) {
        while blocks != 0 {
            let block = blocks.trailing_zeros() as usize % LANES;
            blocks &= blocks - 1;
            let id = <u32x16<S> as SimdBase<S>>::splat(s, ids[block]);
            for packet in block * LANES..(block + 1) * LANES {
                self.unresolved[packet] = self.samples.whole();
                let first = self.line_of(packet, 0);
                for line in &mut self.ids[first..][..self.samples.count()] {
                    id.store_array(line);
                }
            }
        }
    }
}

/// The depths of a block's packet as they are stored.
#[inline(always)]
fn block_depth<S: Lanes>(
    s: S,
    stored: StoredDepth,
    depths: &PlaneBlock<S>,
    packet: usize,
    needs_clamp: bool,
) -> f32x16<S> {
    let z = depths.at(packet);
    if needs_clamp {
        stored.of(s, z)
    } else {
        stored.format.stored_lanes(s, z)
    }
}

/// The lanes in which a triangle wins, in whatever order triangles come: nearer, or as near and
/// submitted at the right time. With *less* the first of equal ones wins, with *less or equal* the
/// last; a stored depth of no triangle of the run is older than all of them.
#[inline(always)]
fn nearer_or_first<S: Lanes>(
    s: S,
    function: CompareFunction,
    [new, old]: [f32x16<S>; 2],
    (ids, unresolved): (u32x16<S>, u16),
    id: u32,
) -> mask32x16<S> {
    let nearer = if prefers_less(function) {
        new.simd_lt(old)
    } else {
        new.simd_gt(old)
    };
    let unresolved = s.mask_from_bits(unresolved);
    // Signed, so that shaded fragments, which belong to earlier chunks, count as older.
    let (mine, ids) = (
        <i32x16<S> as SimdBase<S>>::splat(s, id.cast_signed()),
        ids.bitcast::<i32x16<S>>(),
    );
    let wins_tie = match function {
        CompareFunction::Less | CompareFunction::Greater => unresolved & mine.simd_lt(ids),
        _ => !unresolved | mine.simd_gt(ids),
    };
    nearer | (new.simd_eq(old) & wins_tie)
}
