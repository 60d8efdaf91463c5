#![forbid(unsafe_code)]
//! Benchmarks: the scenes of `peerbench`, drawn natively and timed in the same way as lavapipe and
//! SwiftShader, with a comparison of the pictures; and the costs of stages, states and growing
//! loads.
//!
//! ```sh
//! cargo run --release -p estampe-bench -- \
//!     --scenes fill,mid_tris --sizes 1280x720 --threads 2 --json ours.json
//! ```
//!
//! * [`generate`] makes the scenes' data, equal to `peerbench`'s bit for bit, as their fingerprints
//!   prove;
//! * [`scene`] has one file per scene: its data, its shader, its pipeline; or, for the scenes of
//!   real programs, its [passes](scene::passes) in WGSL;
//! * [`frame`] draws a scene once, with the objects of `resources`; [`measure`] draws it many
//!   times and measures with the [`clock`];
//! * [`picture`] writes, reads and compares pictures; [`report`] writes tables and JSON;
//! * [`stages`] has loads that stress one stage each; [`states`] measures the cost of each state of
//!   the pipeline, [`operations`] that of each operation of shaders as text, and [`growth`] how
//!   cost grows with triangles, pixels and cores;
//! * `models` writes the files with which the whole process, `estampe render`, is measured;
//! * [`versus`] runs estampe and lavapipe in turn; [`document`] writes tables into PERFORMANCE.md,
//!   under a line of [`provenance`];
//! * [`command`] is the command line.

pub mod clock;
pub mod command;
pub mod document;
pub mod frame;
pub mod generate;
pub mod growth;
pub mod measure;
mod models;
pub mod operations;
pub mod picture;
pub mod provenance;
pub mod report;
pub mod scene;
pub mod stages;
pub mod states;
pub mod versus;

mod error;
mod process;
mod resources;
mod target;

pub use error::BenchError;

#[cfg(test)]
mod tests;
