//! Lists of zeros for the bytes of files, and for what is read from them.

use estampe_simd::advise_huge_pages;

/// A list of zeros. A large one is the system's fresh memory, which the threads that fill it are
/// first to touch, in huge pages: otherwise a PLY file of a million triangles takes 15,000 page
/// faults.
pub(crate) fn zeros<T: Copy + Default>(len: usize) -> Vec<T> {
    let mut zeros = vec![T::default(); len];
    advise_huge_pages(&mut zeros);
    zeros
}
