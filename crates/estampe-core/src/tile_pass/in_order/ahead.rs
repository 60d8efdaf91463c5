//! Reading ahead: the triangles that come next are brought to the cache.
//!
//! The triangles of a tile lie anywhere in a chunk, and so do the varyings of their vertices. The
//! processor would wait for each of them in turn, because the work on one triangle is longer than
//! what it looks ahead. Here it waits once for several entries.

use crate::bounds::bins::BinEntry;
use crate::bounds::chunk::Chunk;
use crate::fragment::interpolate::VaryingSource;
use estampe_simd::Lane;
use std::hint::black_box;

/// Entries that are read together.
pub(super) const ENTRIES: usize = 16;

/// Reads the triangles of the first [`ENTRIES`] entries, then the varyings of their vertices.
#[inline(always)]
pub(super) fn touch(chunk: &Chunk, source: &VaryingSource<'_>, entries: &[BinEntry]) {
    let mut words = 0u32;
    for entry in entries.iter().take(ENTRIES) {
        let BinEntry::Triangles { packet, lanes } = *entry else {
            return;
        };
        let triangles = chunk.taken_apart(packet);
        for lane in Lane::all_of(lanes) {
            // One word of each of its two cache lines.
            let triangle = &triangles[lane.get()];
            words = words.wrapping_add(triangle.x[0].cast_unsigned());
            words = words.wrapping_add(triangle.r.to_bits());
        }
    }
    for entry in entries.iter().take(ENTRIES) {
        let BinEntry::Triangles { packet, lanes } = *entry else {
            return;
        };
        let triangles = chunk.taken_apart(packet);
        for lane in Lane::all_of(lanes) {
            for vertex in triangles[lane.get()].vertex {
                // They may lie in two cache lines.
                let varyings = source.of(vertex);
                for value in [varyings.first(), varyings.last()].into_iter().flatten() {
                    words = words.wrapping_add(value.to_bits());
                }
            }
        }
    }
    black_box(words);
}
