//! Advice that large memory be backed by huge pages.
//!
//! A row of an image is often longer than a page of 4 kB, so that a block of 4×4 pixels is on four
//! pages, and a filter that reads rows of a tile on a hundred: more than the processor's first
//! table of pages holds. Many systems give huge pages, of 2 MB, only to memory for which a process
//! asks.
//!
//! This module has `unsafe` code: it calls the system.

/// Bytes of a huge page on most systems: smaller memory is left as it is.
#[cfg(target_os = "linux")]
const HUGE_PAGE: usize = 2 << 20;

/// Advises the system to back large memory by huge pages; best before the memory is touched. Its
/// contents do not change. Without effect on systems other than Linux, and where the system does
/// not follow the advice.
///
/// The advice is for all pages on which the memory lies, so that of memory next to each other that
/// is so advised all huge pages but the outermost can be used.
#[cfg(target_os = "linux")]
#[inline]
#[expect(unsafe_code, reason = "the system has no safe function for it")]
pub fn advise_huge_pages<T>(memory: &mut [T]) {
    let bytes = size_of_val(memory);
    if bytes < HUGE_PAGE {
        return;
    }
    let page = rustix::param::page_size();
    let first = memory.as_mut_ptr().cast::<u8>();
    let before = first.addr() % page;
    let start = first.wrapping_sub(before).cast();
    let len = (before + bytes).next_multiple_of(page);
    // SAFETY: these are pages of this process, as each holds some of the memory that is borrowed
    // here, and this advice changes how the system backs them, not what they hold. An error means
    // that nothing changes.
    let advised = unsafe { rustix::mm::madvise(start, len, rustix::mm::Advice::LinuxHugepage) };
    let _ = advised;
}

/// Other systems have no such advice.
#[cfg(not(target_os = "linux"))]
#[inline]
pub fn advise_huge_pages<T>(_: &mut [T]) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advice_changes_no_contents() {
        for len in [0, 1, 5000, 3 << 20] {
            let mut memory: Vec<u32> = (0..len).collect();
            advise_huge_pages(&mut memory);
            assert!(memory.iter().copied().eq(0..len));
            let mut memory = vec![0_u32; len as usize];
            advise_huge_pages(&mut memory);
            assert!(memory.iter().all(|&word| word == 0));
        }
    }
}
