//! Memory that a list's reader or writer comes to next, brought to the cache.
//!
//! Vertices, what shaders make of them, and packets of triangles are more than the caches hold.
//! They are read and written from the first to the last, but in steps: while a batch is shaded
//! nothing else is read, and stores to lines that are not in the cache wait for one another. So a
//! list is prefetched as far ahead as one batch, or a few packets, goes.

use estampe_simd::Lanes;

/// Bytes of a cache line.
const LINE: usize = 64;

/// Prefetches part of a list: `len` elements from one on, as far as there are so many.
#[inline(always)]
pub(super) fn prefetch<S: Lanes, T>(s: S, list: &[T], from: usize, len: usize) {
    if let Some(part) = list.get(from..from.saturating_add(len)) {
        for line in part.chunks(const { LINE.div_ceil(size_of::<T>()) }) {
            s.prefetch(&line[0]);
        }
    }
}
