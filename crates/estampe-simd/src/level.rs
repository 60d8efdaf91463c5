//! The SIMD levels: which exist, which this processor has, and how code is entered at one.

use fearless_simd::Fallback;
#[cfg(target_arch = "aarch64")]
use fearless_simd::aarch64::Neon;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
use fearless_simd::wasm32::WasmSimd128;
#[cfg(target_arch = "x86_64")]
use fearless_simd::x86::{Avx2, Avx512, Sse2};

/// An instruction set that lane code can run with. A value proves that the processor has it.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum Level {
    /// Plain scalar code; on every processor.
    Scalar(Fallback),
    /// x86-64's baseline: 4 lanes a register.
    #[cfg(target_arch = "x86_64")]
    Sse2(Sse2),
    /// AVX2 (x86-64-v3): 8 lanes a register.
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    /// AVX-512 as in Ice Lake and Zen 4: 16 lanes a register.
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
    /// AArch64's baseline: 4 lanes a register.
    #[cfg(target_arch = "aarch64")]
    Neon(Neon),
    /// WebAssembly's 128-bit SIMD: 4 lanes a register.
    #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
    Simd128(WasmSimd128),
}

/// A level that cannot be used here.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LevelError {
    /// No level has this name.
    Unknown(String),
    /// The level exists, but not on this processor.
    Missing {
        /// The level that was asked for.
        name: &'static str,
        /// The best level that this processor has.
        best: &'static str,
    },
}

impl std::fmt::Display for LevelError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Unknown(name) => {
                write!(f, "no SIMD level is named '{name}'; the levels are ")?;
                write!(f, "auto, {}", Level::NAMES.join(", "))
            }
            Self::Missing { name, best } => {
                write!(
                    f,
                    "this processor has no {name}; the best level it has is {best}"
                )
            }
        }
    }
}

impl std::error::Error for LevelError {}

impl Level {
    /// The names that [`Level::named`] knows, from the narrowest to the widest of each architecture.
    pub const NAMES: [&'static str; 6] = ["scalar", "sse2", "avx2", "avx512", "neon", "simd128"];

    /// The scalar level.
    #[must_use]
    pub fn scalar() -> Self {
        Self::Scalar(Fallback::new())
    }

    /// The widest level that this processor has.
    #[must_use]
    pub fn best() -> Self {
        *Self::all_available()
            .last()
            .expect("the scalar level is always there")
    }

    /// Every level that this processor has, scalar first and widest last.
    #[must_use]
    pub fn all_available() -> Vec<Self> {
        let detected = fearless_simd::Level::new();
        let mut levels = vec![Self::scalar()];
        #[cfg(target_arch = "x86_64")]
        {
            levels.extend(detected.as_sse2().map(Self::Sse2));
            levels.extend(detected.as_avx2().map(Self::Avx2));
            levels.extend(detected.as_avx512().map(Self::Avx512));
        }
        #[cfg(target_arch = "aarch64")]
        levels.extend(detected.as_neon().map(Self::Neon));
        #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
        levels.extend(detected.as_wasm_simd128().map(Self::Simd128));
        let _ = detected;
        levels
    }

    /// The level's name, one of [`Level::NAMES`].
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Scalar(_) => "scalar",
            #[cfg(target_arch = "x86_64")]
            Self::Sse2(_) => "sse2",
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => "avx2",
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(_) => "avx512",
            #[cfg(target_arch = "aarch64")]
            Self::Neon(_) => "neon",
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            Self::Simd128(_) => "simd128",
        }
    }

    /// The level of that name, or the widest for `auto`.
    ///
    /// # Errors
    /// [`LevelError`] when there is no such level, or this processor lacks it.
    pub fn named(name: &str) -> Result<Self, LevelError> {
        if name == "auto" {
            return Ok(Self::best());
        }
        if let Some(level) = Self::all_available()
            .into_iter()
            .find(|level| level.name() == name)
        {
            return Ok(level);
        }
        match Self::NAMES.into_iter().find(|known| *known == name) {
            Some(name) => Err(LevelError::Missing {
                name,
                best: Self::best().name(),
            }),
            None => Err(LevelError::Unknown(name.to_owned())),
        }
    }
}

impl Default for Level {
    /// [`Level::best`].
    fn default() -> Self {
        Self::best()
    }
}

/// Runs an expression in code compiled for a [`Level`], with the level's token bound to a name.
///
/// `dispatch!(level, s => work(s, input))` calls `work` once. `work` must be generic over
/// `S: Lanes` and `#[inline(always)]`, as must all that it calls with lanes. Do it once per batch or
/// tile: an entry costs a few nanoseconds, and nothing is inlined across it.
#[macro_export]
macro_rules! dispatch {
    ($level:expr, $simd:ident => $op:expr) => {
        match $level {
            $crate::Level::Scalar(token) => $crate::dispatch!(@enter token, $simd => $op),
            #[cfg(target_arch = "x86_64")]
            $crate::Level::Sse2(token) => $crate::dispatch!(@enter token, $simd => $op),
            #[cfg(target_arch = "x86_64")]
            $crate::Level::Avx2(token) => $crate::dispatch!(@enter token, $simd => $op),
            #[cfg(target_arch = "x86_64")]
            $crate::Level::Avx512(token) => $crate::dispatch!(@enter token, $simd => $op),
            #[cfg(target_arch = "aarch64")]
            $crate::Level::Neon(token) => $crate::dispatch!(@enter token, $simd => $op),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            $crate::Level::Simd128(token) => $crate::dispatch!(@enter token, $simd => $op),
            // `Level` is non-exhaustive for other crates; inside a build its variants are these.
            #[allow(unreachable_patterns, reason = "reached only by a level of a newer version")]
            _ => ::core::unreachable!("a SIMD level that this macro does not know"),
        }
    };
    // Every level but the scalar one, for code that has a scalar form of its own.
    (@wide $level:expr, $simd:ident => $op:expr, scalar => $scalar:expr) => {
        match $level {
            $crate::Level::Scalar(_) => $scalar,
            #[cfg(target_arch = "x86_64")]
            $crate::Level::Sse2(token) => $crate::dispatch!(@enter token, $simd => $op),
            #[cfg(target_arch = "x86_64")]
            $crate::Level::Avx2(token) => $crate::dispatch!(@enter token, $simd => $op),
            #[cfg(target_arch = "x86_64")]
            $crate::Level::Avx512(token) => $crate::dispatch!(@enter token, $simd => $op),
            #[cfg(target_arch = "aarch64")]
            $crate::Level::Neon(token) => $crate::dispatch!(@enter token, $simd => $op),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            $crate::Level::Simd128(token) => $crate::dispatch!(@enter token, $simd => $op),
            #[allow(unreachable_patterns, reason = "reached only by a level of a newer version")]
            _ => ::core::unreachable!("a SIMD level that this macro does not know"),
        }
    };
    (@enter $token:ident, $simd:ident => $op:expr) => {{
        let $simd = $token;
        $crate::token::Simd::vectorize($simd, #[inline(always)] || $op)
    }};
}
