//! The instruction sets for which code is made, and how much care is taken.

use estampe_simd::{LANES, Level};

/// An instruction set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Isa {
    /// AVX2, FMA and F16C (x86-64-v3): 8 lanes a register, masks are vectors.
    Avx2,
    /// AVX-512 as in Ice Lake and Zen 4: 16 lanes a register, mask registers.
    Avx512,
}

impl Isa {
    /// Both, the narrower one first.
    pub const ALL: [Self; 2] = [Self::Avx2, Self::Avx512];

    /// That of a SIMD level of the same instructions, if code is made for it.
    #[must_use]
    pub fn of(level: Level) -> Option<Self> {
        #[cfg(target_arch = "x86_64")]
        match level {
            Level::Avx2(_) => return Some(Self::Avx2),
            Level::Avx512(_) => return Some(Self::Avx512),
            _ => {}
        }
        let _ = level;
        None
    }

    /// The best one of this processor, if it has any.
    #[must_use]
    pub fn best() -> Option<Self> {
        Self::ALL.into_iter().rfind(|isa| isa.is_available())
    }

    /// True if this processor has the instruction set.
    #[must_use]
    pub fn is_available(self) -> bool {
        #[cfg(target_arch = "x86_64")]
        {
            let levels = Level::all_available();
            levels.iter().any(|level| Self::of(*level) == Some(self))
        }
        #[cfg(not(target_arch = "x86_64"))]
        false
    }

    /// The name of the SIMD level of the same instructions.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// The lanes of a register.
    #[must_use]
    pub fn lanes(self) -> usize {
        match self {
            Self::Avx2 => LANES / 2,
            Self::Avx512 => LANES,
        }
    }
}

#[cfg(target_arch = "x86_64")]
impl Isa {
    /// The registers of a packet of words.
    pub(crate) fn registers_of_packet(self) -> usize {
        LANES / self.lanes()
    }
}

/// How much time is spent on making code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Tier {
    /// For shaders that are needed at once: registers are allocated in one pass.
    Fast,
    /// For shaders that run often: instructions are scheduled, registers are allocated with care.
    Optimised,
}
