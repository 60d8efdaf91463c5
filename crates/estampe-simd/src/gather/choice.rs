//! The choice between two ways to load squares of four elements: loads of eight bytes lane by lane
//! (`squares.rs`), or gathers of pairs (`pairs.rs`). Both give the same elements.
//!
//! Which one is faster depends on the processor: on Zen 4 loads are, on Sapphire Rapids gathers of
//! AVX-512, and the gathers of Intel's processors from Skylake to Rocket Lake were slowed down by
//! microcode against Gather Data Sampling (Downfall). Lists of models go out of date, and virtual
//! machines report models that they are not; so each level with gathers is tried once per process,
//! for some microseconds.

use super::{pairs, squares};
use crate::{LANES, Lanes, Level, dispatch};
use fearless_simd::x86::{Avx2, Avx512};
use fearless_simd::{SimdBase, u32x16};
use std::hint::black_box;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// The way in which a SIMD level loads squares: see [`Lanes::gather_square`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SquareLoads {
    /// Loads, lane by lane.
    Loads,
    /// Gathers of pairs.
    Gathers,
}

/// A level's choice. Reading it costs a load and a branch that is always predicted.
pub(crate) struct Choice {
    gathers: AtomicBool,
}

/// The choice of AVX2, and of AVX-512. Loads until [`decide`] has run.
static AVX2: Choice = Choice::new();
static AVX512: Choice = Choice::new();

impl Choice {
    const fn new() -> Self {
        Self {
            gathers: AtomicBool::new(false),
        }
    }

    #[inline(always)]
    fn is_gathers(&self) -> bool {
        self.gathers.load(Ordering::Relaxed)
    }
}

/// True if AVX-512 gathers pairs.
#[inline(always)]
pub(crate) fn gathers_avx512() -> bool {
    AVX512.is_gathers()
}

/// [`Lanes::gather_square`] in the chosen way.
#[inline(always)]
pub(crate) fn square_avx512(
    simd: Avx512,
    table: &[u32],
    index: u32x16<Avx512>,
    stride: u32,
) -> [u32x16<Avx512>; 4] {
    if AVX512.is_gathers() {
        pairs::square_avx512(simd, table, index, stride)
    } else {
        squares::square_avx512(simd, table, index, stride)
    }
}

/// [`Lanes::gather_square`] in the chosen way.
#[inline(always)]
pub(crate) fn square_avx2(
    simd: Avx2,
    table: &[u32],
    index: u32x16<Avx2>,
    stride: u32,
) -> [u32x16<Avx2>; 4] {
    if AVX2.is_gathers() {
        pairs::square_avx2(simd, table, index, stride)
    } else {
        squares::square_avx2(simd, table, index, stride)
    }
}

impl Level {
    fn choice(self) -> Option<&'static Choice> {
        match self {
            Self::Avx2(_) => Some(&AVX2),
            Self::Avx512(_) => Some(&AVX512),
            _ => None,
        }
    }

    /// The way in which this level loads squares on this processor.
    #[doc(hidden)]
    #[must_use]
    pub fn square_loads(self) -> SquareLoads {
        match self.choice() {
            Some(choice) if choice.is_gathers() => SquareLoads::Gathers,
            _ => SquareLoads::Loads,
        }
    }

    /// Sets the way in which this level loads squares, for tests and measurements; levels without
    /// gathers have one way only.
    #[doc(hidden)]
    pub fn set_square_loads(self, loads: SquareLoads) {
        if let Some(choice) = self.choice() {
            let is_gathers = loads == SquareLoads::Gathers;
            choice.gathers.store(is_gathers, Ordering::Relaxed);
        }
    }
}

/// Tries both ways at each of these levels, once per process.
pub(crate) fn decide(levels: &[Level]) {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        for level in levels {
            if level.choice().is_some() {
                level.set_square_loads(faster(*level));
            }
        }
    });
}

/// Trials of each way. The least time of a way counts: whatever else the machine does makes trials
/// longer, never shorter.
const TRIALS: usize = 12;
/// Squares of a trial, in the words of a table that the first-level cache holds.
const SQUARES: u32 = 32;
const TABLE_WORDS: u32 = 4096;
const STRIDE: u32 = 64;
/// The first squares of a trial.
const FIRST: [u32; LANES] = [
    0, 211, 422, 633, 844, 1055, 1266, 1477, 1688, 1899, 2110, 2321, 2532, 2743, 2954, 3165,
];

/// The faster way. Gathers must win by a tenth, so that a close result is not left to chance.
fn faster(level: Level) -> SquareLoads {
    let table: Vec<u32> = (0..TABLE_WORDS).collect();
    let ways = [SquareLoads::Loads, SquareLoads::Gathers];
    let mut least = [Duration::MAX; 2];
    // In turn, so that a change of the clock rate concerns both.
    for _ in 0..TRIALS {
        for (way, least) in ways.into_iter().zip(&mut least) {
            level.set_square_loads(way);
            let start = Instant::now();
            black_box(dispatch!(level, s => trial(s, black_box(&table))));
            *least = start.elapsed().min(*least);
        }
    }
    let [loads, gathers] = least;
    if gathers * 10 < loads * 9 {
        SquareLoads::Gathers
    } else {
        SquareLoads::Loads
    }
}

/// Loads squares that do not depend on each other.
#[inline(always)]
fn trial<S: Lanes>(s: S, table: &[u32]) -> [u32; LANES] {
    let mut index = u32x16::load_array(s, FIRST);
    let mut all = u32x16::splat(s, 0);
    for _ in 0..SQUARES {
        let [a, b, c, d] = s.gather_square(table, index, STRIDE);
        all += a ^ b ^ c ^ d;
        index = (index + u32x16::splat(s, 1187)) & u32x16::splat(s, TABLE_WORDS - 1);
    }
    all.to_array()
}
