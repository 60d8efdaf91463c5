//! The checks of `cargo run -p xtask -- check` as ordinary tests, one each.

use xtask::{Finding, Repository};

fn passes(check: fn(&Repository) -> Vec<Finding>) {
    let repository = Repository::of_this_build().expect("the repository can be read");
    let errors: Vec<String> = check(&repository)
        .iter()
        .filter(|f| f.is_error())
        .map(ToString::to_string)
        .collect();
    assert!(errors.is_empty(), "\n{}", errors.join("\n"));
}

#[test]
fn crate_edges_are_those_of_the_architecture() {
    passes(xtask::check_edges);
}

#[test]
fn every_dependency_is_used() {
    passes(xtask::check_unused);
}

/// Rows: U4.
#[test]
fn outside_packages_are_pure_rust_from_crates_io() {
    passes(xtask::check_outside);
}

#[test]
fn no_stage_names_a_later_one() {
    passes(xtask::check_stages);
}

#[test]
fn files_keep_the_rules_of_style() {
    passes(xtask::check_files);
}

#[test]
fn words_are_those_of_the_glossary() {
    passes(xtask::check_words);
}

#[test]
fn documents_point_at_what_exists() {
    passes(xtask::check_documents);
}

#[test]
fn the_book_shows_what_tests_keep() {
    passes(xtask::check_book);
}

#[test]
fn every_row_of_the_pipeline_has_its_tests() {
    passes(xtask::check_conformance);
}
