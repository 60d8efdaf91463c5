#![forbid(unsafe_code)]
//! Checks that people would otherwise have to remember: of sources, documents, dependencies and
//! machine code.
//!
//! ```text
//! cargo run -p xtask -- check        every check of sources, documents and dependencies
//! cargo run -p xtask -- asm          the check of the hot functions' machine code
//! cargo run -p xtask -- book         checks the book and writes its pages
//! cargo run -p xtask -- dist         writes the package of the command into target/dist
//! cargo run -p xtask -- conformance  writes which tests prove which row of the pipeline
//! cargo run -p xtask -- fuzz raster  random triangles that share edges, for long
//! ```
//!
//! Each check is a function from the [`Repository`] to [`Finding`]s. A finding that is an error
//! fails the command and a test of `tests/repository.rs`, so `cargo test` runs all checks. The
//! rules of a check are a table at the head of its module: to change a rule, change its row and say
//! why in the commit.

mod assembly;
mod book;
mod conformance;
mod documents;
mod edges;
mod files;
mod finding;
mod markdown;
mod outside;
mod packages;
mod repository;
mod rust_source;
mod stages;
mod unused;
mod words;

pub use assembly::{AssemblyError, AssemblyReport, check_binary};
pub use book::{BookError, check_book, write_book};
pub use conformance::{check_conformance, conformance_document};
pub use documents::check_documents;
pub use edges::check_edges;
pub use files::check_files;
pub use finding::{Finding, Severity};
pub use outside::check_outside;
pub use repository::{Repository, RepositoryError};
pub use stages::check_stages;
pub use unused::check_unused;
pub use words::check_words;

/// The name of a check and the function that makes it.
pub type Check = (&'static str, fn(&Repository) -> Vec<Finding>);

/// Every check that reads sources and documents, in the order in which they are printed.
pub const CHECKS: &[Check] = &[
    ("crate edges", check_edges),
    ("unused dependencies", check_unused),
    ("outside packages", check_outside),
    ("stage order", check_stages),
    ("files", check_files),
    ("words", check_words),
    ("documents", check_documents),
    ("book", check_book),
    ("conformance", check_conformance),
];
