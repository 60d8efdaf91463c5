#![forbid(unsafe_code)]
//! Whole-pipeline tests: the fast path (`estampe`) against the oracle (`estampe-reference`), bit
//! for bit.
//!
//! A [`Case`] is a target and the draws into it, random from a seed. [`check`] draws cases with the
//! oracle, and with the fast path at every SIMD level, the scalar one in every third case, and at
//! 1, 2 and 7 threads. It compares the bytes of the colours and the bits of the depths, and shrinks
//! and prints a case that fails.
//!
//! ```text
//!   seed ─▶ random ─▶ geometry ─▶ case ─┬▶ oracle ────┐
//!                       shaders ────────┘             ├▶ compare ─▶ equal, or a smaller case
//!                                       └▶ fast_path ─┘
//! ```
//!
//! Of each case, [`inspection`] compares the history of a pixel with the image too.
//!
//! The topics are the files of `tests`. A topic can name the [tile paths](ExpectedPaths) that its
//! cases must reach. Two environment variables change a run: `ESTAMPE_TEST_FACTOR=20` draws twenty
//! times as many cases, each on every level at every number of threads; `ESTAMPE_TEST_SEED=7` draws
//! only the case of that seed.

pub mod amplification;
pub mod case;
pub mod compare;
pub mod expected_paths;
pub mod fast_path;
pub mod fragment_ops;
pub mod fuzz;
pub mod geometry;
pub mod inspection;
pub mod mixed_draws;
pub mod oracle;
pub mod random;
pub mod readback;
pub mod shaders;
pub mod shared_edges;
pub mod target;
pub mod transfers;

/// The snippet of the repository's README, compiled and run as a test.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;

pub use case::{Case, CaseDraw};
pub use compare::{check, check_one, check_paths, check_some, check_with_small_bins};
pub use expected_paths::ExpectedPaths;
pub use random::Random;
pub use shaders::TestShader;
