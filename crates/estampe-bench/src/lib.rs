#![forbid(unsafe_code)]
//! Benchmarks: the scenes of `peerbench`, drawn natively, timed as it times lavapipe and SwiftShader, and
//! compared with their pictures; and the cost of each stage.
//!
//! ```sh
//! cargo run --release -p estampe-bench -- --scenes fill,mid_tris --sizes 1280x720 --threads 2 --json ours.json
//! ```
//!
//! * [`generate`] makes the scenes' data, bit for bit as `peerbench` does: the fingerprint says so;
//! * [`scene`] has one file per scene: its data, its shader, its pipeline;
//! * [`frame`] draws a scene once; [`measure`] draws it often and takes the time by the [`clock`];
//! * [`picture`] writes, reads and compares pictures; [`report`] writes tables and JSON;
//! * [`stages`] has loads that stress one stage each; [`states`] says what each state of the pipeline costs;
//!   [`growth`] says how cost grows with triangles, pixels and cores;
//! * `models` writes the files on which the whole process, `estampe render`, is measured;
//! * [`versus`] runs us and lavapipe in turn; [`document`] puts tables into PERFORMANCE.md, under a line of
//!   [`provenance`];
//! * [`command`] is the command line.

pub mod clock;
pub mod command;
pub mod document;
pub mod frame;
pub mod generate;
pub mod growth;
pub mod measure;
mod models;
pub mod picture;
pub mod provenance;
pub mod report;
pub mod scene;
pub mod stages;
pub mod states;
pub mod versus;

mod error;
mod process;

pub use error::BenchError;
