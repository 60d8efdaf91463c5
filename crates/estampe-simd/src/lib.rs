#![deny(unsafe_code)]
//! Sixteen lanes at every SIMD level.
//!
//! All lane code of estampe is written once, generic over a level token `S: Lanes`, with the fixed
//! 16-lane types [`f32x16`], [`i32x16`], [`u32x16`] and [`mask32x16`] at every SIMD level: one
//! AVX-512 register, two AVX2 registers, four SSE2 or NEON registers, or plain scalars. A [`Level`]
//! is chosen once, at run time, and [`dispatch!`] enters the code that was compiled for it.
//!
//! The crate is a thin layer over `fearless_simd`. It adds:
//!
//! * [`Lanes`]: operations that give the same bits at every SIMD level (`min`/`max` as `a < b ? a :
//!   b`), and `gather`, whose indices are clamped, so that it is sound for any input;
//! * a [`Level`] that a caller can name, list and request, with a true scalar level;
//! * [`dispatch!`], which keeps the token's type (and with it the extension trait).
//!
//! **Every function that is generic over lanes is `#[inline(always)]`.** A function that is not
//! inlined into its `dispatch!` is compiled without the level's instructions, which was measured to
//! cost 5 to 14 times. `[T; N]::map`, `from_fn` and attributes on `let` closures break inlining:
//! use loops.
//!
//! **x86-64's baseline is compiled for size.** It has four lanes per register and few of the
//! instructions, so one operation of sixteen lanes is up to a hundred instructions. Gathers,
//! permutations and [`outline!`]d kernels are functions there, and code of which there are many
//! copies for special cases is entered by `dispatch!(@specialized …)`, which leaves it out: of
//! sampling, two copies in place of fifteen. All the same, results are the same bits.
//!
//! Lane `i` of a packet is the pixel at ([`LANE_X`]`[i]`, [`LANE_Y`]`[i]`): Morton order, so that
//! each four neighbouring lanes are one 2×2 quad and derivatives stay inside 128 bits.

mod block;
mod gather;
#[cfg(target_arch = "x86_64")]
mod half;
mod huge_pages;
mod index;
mod lanes;
mod level;
#[cfg(target_arch = "x86_64")]
mod lookup;
#[cfg(target_arch = "x86_64")]
mod masks;
mod packing;
mod paired;
mod permute;
#[cfg(target_arch = "x86_64")]
mod prefetch;
mod streaming;
mod table;

pub use block::Columns;
pub use fearless_simd::{
    Bytes, ExtractToken, Select, Simd, SimdBase, SimdCvtFloat, SimdCvtTruncate, SimdFloat, SimdInt,
    SimdInto, SimdMask, SimdSplit, f32x4, f32x16, f64x2, i32x16, mask8x16, mask32x16, u8x16, u8x32,
    u16x8, u32x4, u32x8, u32x16,
};
#[cfg(target_arch = "x86_64")]
#[doc(hidden)]
pub use gather::SquareLoads;
pub use gather::{
    bits_of, bits_of_mut, bits_of_packets, floats_of, floats_of_mut, ints_of, words_of,
};
pub use huge_pages::advise_huge_pages;
pub use index::{Lane, LanesOf, PacketIndex};
pub use lanes::Lanes;
pub use level::{Level, LevelError};
pub use packing::{Packing, Window};
pub use streaming::Stream;
pub use table::ByteTable;

/// Number of lanes of a packet: 4×4 pixels.
pub const LANES: usize = 16;

/// Column of each lane's pixel inside its 4×4 packet.
pub const LANE_X: [u8; LANES] = [0, 1, 0, 1, 2, 3, 2, 3, 0, 1, 0, 1, 2, 3, 2, 3];

/// Row of each lane's pixel inside its 4×4 packet.
pub const LANE_Y: [u8; LANES] = [0, 0, 1, 1, 0, 0, 1, 1, 2, 2, 3, 3, 2, 2, 3, 3];

/// Sixteen values in memory, one cache line.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub struct Packet<T>(pub [T; LANES]);

macro_rules! uniform_packets {
    ($($word:ty),*) => {$(
        impl Packet<$word> {
            /// Returns true if all lanes hold the same word.
            #[inline(always)]
            #[must_use]
            pub fn is_uniform(&self) -> bool {
                // Without branches, so that lanes are compared side by side.
                self.0.iter().fold(0, |others, word| others | (word ^ self.0[0])) == 0
            }
        }
    )*};
}
uniform_packets!(i32, u32);

impl<T: Default + Copy> Default for Packet<T> {
    fn default() -> Self {
        Self([T::default(); LANES])
    }
}

#[doc(hidden)]
pub mod token {
    //! Names that `dispatch!` uses.
    pub use fearless_simd::Simd;
}

#[cfg(test)]
mod tests;
