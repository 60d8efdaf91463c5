//! Lines among visible triangles: the edges of a mesh over its faces.
//!
//! Faces below an opaque line need not be shaded. So lines that follow triangles of a run do not
//! end it: [in order](crate::tile_pass::in_order), they are covered and tested against the run's
//! depths, and a fragment that passes takes its sample, as small triangles' fragments do that are
//! shaded [at once](super::cross_triangle): its texel waits under an ID until the run is resolved.
//!
//! ```text
//!   triangles ─▶ depths, ids ─────────────▶ resolve: shade what is still visible
//!   lines ─▶ tests ─▶ ids ─▶ shade, texels ──────┘
//! ```

use super::MAX_RUN;
use super::buffer::TILE_SAMPLES;
use super::rasterize::{rasterize_waiting, storage_of};
use super::resolve::resolve;
use super::writer::{IdStorage, VisibilityWriter};
use crate::plan::tile_plan::TilePlan;
use crate::tile_pass::{TileJob, TilePass, TileScratch, TileWork};
use crate::tile_path::TilePath;
use estampe_simd::{LANES, Level};
use std::hint::select_unpredictable;

/// Makes the run of visibility ready for the lines of a run of a chunk. Returns false if they are
/// to be drawn in order instead: because no triangle waits to be shaded, or they may not join.
#[inline(never)]
pub(in crate::tile_pass) fn takes_lines<const N: usize>(
    pass: &TilePass<'_>,
    work: &TileWork<'_>,
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) -> bool {
    let plan = work.plan;
    let may_join = const { N == 1 }
        && pass.grid.tiles_are_blocks()
        && plan.pipeline.key().is_opaque_lines
        && plan.path == TilePath::InOrderQuads
        && plan.cut_samples.is_none();
    if !may_join || !has_ids(pass, scratch) {
        return false;
    }
    if scratch.visibility.cross.texels() > MAX_RUN {
        resolve(pass, job, scratch);
        return false;
    }
    rasterize_waiting(pass, job, scratch);
    let buffer = &mut scratch.visibility.buffer;
    let mut single = std::mem::take(&mut buffer.single);
    let target = (&plan.tests, pass.sample_set(), work.shape);
    let mut writer = VisibilityWriter::new(target, storage_of(plan), job, buffer, None);
    single.write_out(work.level, u16::MAX, &mut writer);
    scratch.visibility.buffer.single = single;
    true
}

/// Returns true if triangles with colours wait to be shaded.
fn has_ids<const N: usize>(pass: &TilePass<'_>, scratch: &TileScratch<N>) -> bool {
    let mut groups = scratch.visibility.buffer.groups.iter();
    groups.any(|group| storage_of(&pass.plans[group.sub_draw as usize]) != IdStorage::None)
}

impl<const N: usize> TileScratch<N> {
    /// Makes the fragments in some lanes of the packet that was queued last visible at their
    /// pixels; `begins` says that they are its first.
    #[inline(always)]
    pub(in crate::tile_pass) fn show_pixels(
        &mut self,
        plan: &TilePlan<'_>,
        job: &mut TileJob<'_>,
        (places, lanes): (&[u32; LANES], u16),
        begins: bool,
    ) {
        self.statistics.line_fragments_shown += u64::from(lanes.count_ones());
        let cross = &mut self.visibility.cross;
        if begins {
            cross.begin_packet();
        }
        let buffer = &mut self.visibility.buffer;
        let ids = match storage_of(plan) {
            IdStorage::Attachment => job.colors[0].as_flattened_mut(),
            IdStorage::BufferData | IdStorage::None => buffer.ids.as_flattened_mut(),
        };
        let ids: Option<&mut [u32; TILE_SAMPLES]> = ids.first_chunk_mut();
        debug_assert!(ids.is_some(), "a tile of 64×64 pixels of one sample");
        let Some(ids) = ids else {
            return;
        };
        let shown = buffer.shown.begin::<TILE_SAMPLES>();
        for ((lane, place), id) in places.iter().enumerate().zip(cross.first_id_of_last()..) {
            let place = *place as usize % TILE_SAMPLES;
            let is_shown = lanes >> lane & 1 == 1;
            ids[place] = select_unpredictable(is_shown, id, ids[place]);
            shown[place] |= u8::from(is_shown);
        }
    }

    /// Shades the queued packets of lines, and keeps their texels until the run is resolved.
    #[inline(never)]
    pub(in crate::tile_pass) fn shade_shown(&mut self, plan: &TilePlan<'_>, level: Level) {
        if !self.queue.is_empty() {
            let cross = &mut self.visibility.cross;
            self.statistics.fragments_shaded += cross.shade(&mut self.queue, plan, level);
        }
    }
}
