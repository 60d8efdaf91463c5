//! The check must fail on sources that break the order, and only on those.

use super::*;

fn messages(files: &[(&str, &str)]) -> Vec<String> {
    check_stages(&Repository::synthetic(files))
        .iter()
        .map(ToString::to_string)
        .collect()
}

fn messages_of(module: &str, source: &str) -> Vec<String> {
    messages(&[(&format!("crates/estampe-core/src/{module}.rs"), source)])
}

#[test]
fn an_earlier_stage_may_be_named() {
    let clip =
        "use super::assembly::Primitive;\nuse crate::geometry::cull::Facing;\nuse self::x::Y;";
    assert_eq!(messages_of("geometry/clip", clip), [""; 0]);
    assert_eq!(
        messages_of("raster/edge", "use crate::tiles::Tile; use super::Block;"),
        [""; 0]
    );
    assert_eq!(
        messages_of("raster/mod", "use crate::geometry::setup::SetupPrimitive;"),
        [""; 0]
    );
}

#[test]
fn a_later_stage_may_not() {
    let found = messages_of("geometry/clip", "\nuse super::{assembly::A, setup::Setup};");
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].starts_with("error: crates/estampe-core/src/geometry/clip.rs:2: stage"));
    assert!(found[0].contains("`geometry::setup::Setup`"));
    assert_eq!(
        messages_of("tiles", "fn f() { crate::raster::run() }").len(),
        1
    );
    assert_eq!(
        messages_of("geometry/mod", "use crate::raster::Tiles;").len(),
        1
    );
    assert_eq!(
        messages_of("raster/edge/walk", "use super::super::super::fragment::F;").len(),
        1
    );
}

#[test]
fn a_re_export_does_not_hide_a_later_stage() {
    assert_eq!(messages_of("tiles", "use crate::Coverage;").len(), 1);
    assert_eq!(
        messages_of("geometry/fetch", "use super::SetupPrimitive;").len(),
        1
    );
    assert_eq!(
        messages_of("geometry/fetch", "use crate::geometry::*;").len(),
        1
    );
}

#[test]
fn conductors_name_all_and_are_named_by_none() {
    let source = "use crate::{geometry::fetch, raster, attachment::Attachment, Limits};";
    assert_eq!(messages_of("draw", source), [""; 0]);
    assert_eq!(messages_of("raster", "use crate::draw::Draw;").len(), 1);
    assert_eq!(
        messages_of("statistics", "use crate::raster::Edge;").len(),
        1
    );
}

#[test]
fn every_module_has_a_place() {
    let found = messages_of("geometry/magic", "fn f() {}");
    assert_eq!(found.len(), 1);
    assert!(found[0].contains("no place in the stage order"));
    assert_eq!(messages_of("attic", "fn f() {}").len(), 1);
    assert_eq!(
        messages_of("lib", "mod attic; pub use crate::draw::Draw;"),
        [""; 0]
    );
}

#[test]
fn comments_strings_and_tests_are_free() {
    let source = "//! See [`crate::raster`].\nfn f() { g(\"crate::raster::x\") }\n\
                  #[cfg(test)]\nmod tests { use crate::raster::Edge; use rayon::Scope; }";
    assert_eq!(messages_of("tiles", source), [""; 0]);
    assert_eq!(
        messages_of("tiles/tests", "use crate::attachment::A;"),
        [""; 0]
    );
}

#[test]
fn only_the_scheduler_knows_threads() {
    assert_eq!(
        messages_of("schedule/pool", "use rayon::ThreadPool;"),
        [""; 0]
    );
    assert_eq!(
        messages_of("raster", "fn f() { rayon::join(a, b) }").len(),
        1
    );
}
