//! The SIMD levels: the known ones, the ones that this processor has, and entering code at a level.

#[cfg(scalar_level)]
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
    /// Plain scalar code, for every processor. Built in with the feature `scalar-level`, and on
    /// targets without SIMD instructions.
    #[cfg(scalar_level)]
    Scalar(Fallback),
    /// x86-64's baseline: 4 lanes per register.
    #[cfg(target_arch = "x86_64")]
    Sse2(Sse2),
    /// AVX2 (x86-64-v3): 8 lanes per register.
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    /// AVX-512 as in Ice Lake and Zen 4: 16 lanes per register. A dev build by a processor that
    /// lacks it has no code of this level.
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
    /// AArch64's baseline: 4 lanes per register.
    #[cfg(target_arch = "aarch64")]
    Neon(Neon),
    /// WebAssembly's 128-bit SIMD: 4 lanes per register.
    #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
    Simd128(WasmSimd128),
}

/// The reason why a SIMD level cannot be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LevelError {
    /// No level has this name.
    Unknown(String),
    /// The level exists, but this build does not contain it.
    NotBuiltIn {
        /// The requested level.
        name: &'static str,
        /// The Cargo feature that includes the level.
        feature: &'static str,
    },
    /// The level exists, but this processor does not support it.
    Missing {
        /// The requested level.
        name: &'static str,
        /// The widest level that this processor supports.
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
            Self::NotBuiltIn { name, feature } => {
                write!(
                    f,
                    "the SIMD level {name} is not built in; build with the feature `{feature}`"
                )
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

/// Levels are equal if they are of one kind: there is one value of each.
impl PartialEq for Level {
    fn eq(&self, other: &Self) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }
}

impl Eq for Level {}

impl Level {
    /// The names that [`Level::named`] accepts, narrowest level first within each architecture.
    pub const NAMES: [&'static str; 6] = ["scalar", "sse2", "avx2", "avx512", "neon", "simd128"];

    /// True for the scalar level.
    #[must_use]
    #[inline]
    pub fn is_scalar(self) -> bool {
        #[cfg(scalar_level)]
        return matches!(self, Self::Scalar(_));
        #[cfg(not(scalar_level))]
        false
    }

    /// True if long code has copies for special cases at this level: at all but the scalar one and
    /// x86-64's baseline. See the arm `@specialized_move` of [`dispatch!`](crate::dispatch!).
    #[must_use]
    #[inline]
    pub fn is_specialized(self) -> bool {
        #[cfg(target_arch = "x86_64")]
        return !self.is_scalar() && !matches!(self, Self::Sse2(_));
        #[cfg(not(target_arch = "x86_64"))]
        !self.is_scalar()
    }

    /// The widest level that this processor supports.
    #[must_use]
    pub fn best() -> Self {
        *Self::all_available()
            .last()
            .expect("every target has its baseline's level, or the scalar one")
    }

    /// Every level that this processor supports and this build contains, narrowest first.
    #[must_use]
    pub fn all_available() -> Vec<Self> {
        let detected = fearless_simd::Level::new();
        let mut levels = Vec::new();
        #[cfg(scalar_level)]
        levels.push(Self::Scalar(Fallback::new()));
        #[cfg(target_arch = "x86_64")]
        {
            levels.extend(detected.as_sse2().map(Self::Sse2));
            levels.extend(detected.as_avx2().map(Self::Avx2));
            #[cfg(avx512_level)]
            levels.extend(detected.as_avx512().map(Self::Avx512));
        }
        #[cfg(target_arch = "aarch64")]
        levels.extend(detected.as_neon().map(Self::Neon));
        #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
        levels.extend(detected.as_wasm_simd128().map(Self::Simd128));
        let _ = detected;
        #[cfg(target_arch = "x86_64")]
        crate::gather::decide(&levels);
        levels
    }

    /// The level's name, one of [`Level::NAMES`].
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            #[cfg(scalar_level)]
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

    /// The level with this name, or the widest level for `auto`.
    ///
    /// # Errors
    /// [`LevelError`] if no level has this name, or if this processor or this build lacks it.
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
            Some(name @ "scalar") => Err(LevelError::NotBuiltIn {
                name,
                feature: "scalar-level",
            }),
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
/// `dispatch!(level, s => work(s, input))` calls `work` once. `work`, and every function with lanes
/// that it calls, must be generic over `S: Lanes` and `#[inline(always)]`. Dispatch once per batch
/// or tile: an entry costs a few nanoseconds, and nothing is inlined across it.
#[macro_export]
macro_rules! dispatch {
    ($level:expr, $simd:ident => $op:expr) => {
        match $level {
            #[cfg(target_arch = "x86_64")]
            $crate::Level::Sse2(token) => $crate::dispatch!(@enter token, $simd => $op),
            #[cfg(target_arch = "x86_64")]
            $crate::Level::Avx2(token) => $crate::dispatch!(@enter token, $simd => $op),
            #[cfg(target_arch = "x86_64")]
            $crate::Level::Avx512(token) => $crate::dispatch_avx512!(@enter token, $simd => $op),
            #[cfg(target_arch = "aarch64")]
            $crate::Level::Neon(token) => $crate::dispatch!(@enter token, $simd => $op),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            $crate::Level::Simd128(token) => $crate::dispatch!(@enter token, $simd => $op),
            #[allow(unreachable_patterns, reason = "reached by the scalar level, where it is built in")]
            other => $crate::dispatch_scalar!(other, $simd => $op),
        }
    };
    // Every SIMD level except the scalar one, for code that has a separate scalar form.
    (@wide $level:expr, $simd:ident => $op:expr, scalar => $scalar:expr) => {
        match $level {
            #[cfg(target_arch = "x86_64")]
            $crate::Level::Sse2(token) => $crate::dispatch!(@enter token, $simd => $op),
            #[allow(unreachable_patterns, reason = "reached where the baseline is not the only level")]
            other => $crate::dispatch!(@specialized other, $simd => $op, others => $scalar),
        }
    };
    // The same, where what the expression uses is moved into it: two references are then passed in
    // registers, and not by way of memory.
    (@wide_move $level:expr, $simd:ident => $op:expr, scalar => $scalar:expr) => {
        match $level {
            #[cfg(target_arch = "x86_64")]
            $crate::Level::Sse2(token) => $crate::dispatch!(@enter_move token, $simd => $op),
            #[allow(unreachable_patterns, reason = "reached where the baseline is not the only level")]
            other => $crate::dispatch!(@specialized_move other, $simd => $op, others => $scalar),
        }
    };
    // As `@wide`, without x86-64's baseline too, for code that is compiled many times, for special
    // cases. Processors without AVX2 are rare, and four lanes per register make code so long that
    // this would be most of what the compiler has to do.
    (@specialized $level:expr, $simd:ident => $op:expr, others => $others:expr) => {
        match $level {
            #[cfg(target_arch = "x86_64")]
            $crate::Level::Avx2(token) => $crate::dispatch!(@enter token, $simd => $op),
            #[cfg(target_arch = "x86_64")]
            $crate::Level::Avx512(token) => $crate::dispatch_avx512!(@enter token, $simd => $op),
            #[cfg(target_arch = "aarch64")]
            $crate::Level::Neon(token) => $crate::dispatch!(@enter token, $simd => $op),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            $crate::Level::Simd128(token) => $crate::dispatch!(@enter token, $simd => $op),
            #[allow(unreachable_patterns, reason = "reached by the scalar level, where it is built in")]
            _ => $others,
        }
    };
    (@specialized_move $level:expr, $simd:ident => $op:expr, others => $others:expr) => {
        match $level {
            #[cfg(target_arch = "x86_64")]
            $crate::Level::Avx2(token) => $crate::dispatch!(@enter_move token, $simd => $op),
            #[cfg(target_arch = "x86_64")]
            $crate::Level::Avx512(token) => $crate::dispatch_avx512!(@enter_move token, $simd => $op),
            #[cfg(target_arch = "aarch64")]
            $crate::Level::Neon(token) => $crate::dispatch!(@enter_move token, $simd => $op),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            $crate::Level::Simd128(token) => $crate::dispatch!(@enter_move token, $simd => $op),
            #[allow(unreachable_patterns, reason = "reached by the scalar level, where it is built in")]
            _ => $others,
        }
    };
    (@enter_move $token:ident, $simd:ident => $op:expr) => {{
        let $simd = $token;
        $crate::token::Simd::vectorize($simd, #[inline(always)] move || $op)
    }};
    (@enter $token:ident, $simd:ident => $op:expr) => {{
        let $simd = $token;
        $crate::token::Simd::vectorize($simd, #[inline(always)] || $op)
    }};
}

/// Evaluates an expression of lane code: `outline!(s, expression)`. At the scalar level it becomes
/// a function of its own, which the compiler compiles once for all places that reach it.
///
/// Sixteen scalar lanes are sixteen times the instructions, and inlining copies them to every
/// caller. With the longest kernels outlined, the scalar level of `estampe-core` is a third of the
/// code, and the crate compiles in a quarter of the time.
#[macro_export]
macro_rules! outline {
    ($simd:expr, $expression:expr) => {
        $crate::Lanes::outline(
            $simd,
            #[inline(always)]
            || $expression,
        )
    };
}

/// The scalar arm of [`dispatch!`]. It is a separate macro because a `cfg` inside a macro tests the
/// features of the crate that expands it, not of this crate.
#[cfg(scalar_level)]
#[doc(hidden)]
#[macro_export]
macro_rules! dispatch_scalar {
    ($level:expr, $simd:ident => $op:expr) => {
        match $level {
            $crate::Level::Scalar(token) => $crate::dispatch!(@enter token, $simd => $op),
            _ => ::core::unreachable!("a SIMD level that `dispatch!` does not know"),
        }
    };
}

/// The scalar arm of [`dispatch!`] in builds without the scalar level.
#[cfg(not(scalar_level))]
#[doc(hidden)]
#[macro_export]
macro_rules! dispatch_scalar {
    ($level:expr, $simd:ident => $op:expr) => {{
        let _ = $level;
        ::core::unreachable!("a SIMD level that `dispatch!` does not know")
    }};
}

/// The AVX-512 arms of [`dispatch!`].
#[cfg(avx512_level)]
#[doc(hidden)]
#[macro_export]
macro_rules! dispatch_avx512 {
    ($($entry:tt)*) => {
        $crate::dispatch!($($entry)*)
    };
}

/// The AVX-512 arms of [`dispatch!`] in builds without this level.
#[cfg(all(target_arch = "x86_64", not(avx512_level)))]
#[doc(hidden)]
#[macro_export]
macro_rules! dispatch_avx512 {
    (@$entry:ident $token:ident, $simd:ident => $op:expr) => {{
        let _ = $token;
        ::core::unreachable!("a level that this build leaves out")
    }};
}
