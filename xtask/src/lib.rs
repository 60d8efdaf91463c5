#![forbid(unsafe_code)]
//! The repository's chores: checks that people would otherwise have to remember.
//!
//! ```text
//! cargo run -p xtask -- check     every check of the sources and documents
//! cargo run -p xtask -- asm       the check of the hot functions' machine code
//! cargo run -p xtask -- conformance  writes which tests prove which row of the pipeline
//! cargo run -p xtask -- fuzz raster  random triangles that share edges, for long
//! cargo run -p xtask -- models F  the models on which `estampe render` is measured, into folder F
//! ```
//!
//! Each check is a function from the [`Repository`] to [`Finding`]s. A finding that is an error fails
//! the command and the test of the same name in `tests/repository.rs`, so `cargo test` runs them
//! all. What a check enforces is a table at the head of its module: to change a rule, change its row
//! and say why in the commit.

mod assembly;
mod conformance;
mod documents;
mod edges;
mod elf;
mod finding;
mod manifests;
mod markdown;
mod models;
mod outside;
mod repository;
mod rooms;
mod rust_source;
mod stages;
mod words;

pub use assembly::{AssemblyError, AssemblyReport, check_binary};
pub use conformance::{check_conformance, conformance_document};
pub use documents::check_documents;
pub use edges::check_edges;
pub use finding::{Finding, Severity};
pub use models::write_models;
pub use outside::check_outside;
pub use repository::{Repository, RepositoryError};
pub use rooms::check_rooms;
pub use stages::check_stages;
pub use words::check_words;

/// The name of a check and the function that makes it.
pub type Check = (&'static str, fn(&Repository) -> Vec<Finding>);

/// Every check that reads sources and documents, in the order in which they are printed.
pub const CHECKS: &[Check] = &[
    ("crate edges", check_edges),
    ("outside packages", check_outside),
    ("stage order", check_stages),
    ("rooms", check_rooms),
    ("words", check_words),
    ("documents", check_documents),
    ("conformance", check_conformance),
];
