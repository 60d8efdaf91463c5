//! Prefetches: asking for a cache line before it is read.
#![expect(unsafe_code, reason = "the prefetch intrinsic takes a raw pointer")]

/// Asks for the cache line of `table[index]`, which may be beyond the table: nothing is read. It
/// does nothing on processors for which the standard library has no such function.
#[inline(always)]
pub fn prefetch(table: &[u32], index: usize) {
    #[cfg(target_arch = "x86_64")]
    {
        use core::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        let place = table.as_ptr().wrapping_add(index).cast();
        // SAFETY: x86-64 has the instruction, which takes any address and gives no faults.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(place) }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (table, index);
}
