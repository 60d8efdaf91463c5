//! Fragments that were shaded before the run's end: their texels take the place of their ids.

use super::TileScratch;
use super::ids::ids_of;
use crate::tile_pass::TileJob;
use crate::tile_pass::visibility::VisibilityScratch;
use crate::tile_pass::visibility::buffer::SHADED;
use crate::tile_pass::visibility::writer::IdStorage;
use estampe_simd::{Bytes, LANES, Lanes, Select, SimdBase, i32x16, u32x16};

/// Stores the texels of fragments that are shaded already where their ids stand. They have one
/// sample a pixel and one target.
#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "a texel has at most four words of sixteen lanes"
)]
pub(super) fn write_cross_triangle<S: Lanes, const N: usize>(
    s: S,
    (storage, words): (IdStorage, usize),
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) {
    let VisibilityScratch { buffer, cross, .. } = &mut scratch.visibility;
    let texels = cross.words();
    for (packet, unresolved) in buffer.unresolved.iter_mut().enumerate() {
        if unresolved[0] == 0 {
            continue;
        }
        let line = packet * N;
        let ids = u32x16::load_array_ref(s, &ids_of(storage, job, &buffer.ids)[line]);
        let signed: i32x16<S> = ids.bitcast();
        let mask = s.sign_bits(signed) & unresolved[0];
        if mask == 0 {
            continue;
        }
        unresolved[0] &= !mask;
        let fragment = ids & <u32x16<S> as SimdBase<S>>::splat(s, !SHADED);
        let lane = fragment & <u32x16<S> as SimdBase<S>>::splat(s, 15);
        // A packet's words follow each other.
        let first = (fragment - lane) * (words as u32) + lane;
        for word in 0..words {
            let at = first + (word * LANES) as u32;
            let texel = s.gather(texels, at);
            let stored = &mut job.colors[0][line * words + word];
            let old = u32x16::load_array_ref(s, stored);
            let new = s.mask_from_bits(mask).select(texel, old);
            new.store_array(stored);
        }
    }
}
