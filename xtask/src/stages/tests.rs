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
        messages_of(
            "raster/edge",
            "use crate::bounds::bins::BinEntry; use super::Block;"
        ),
        [""; 0]
    );
    assert_eq!(
        messages_of("raster/mod", "use crate::geometry::setup::SetupPrimitive;"),
        [""; 0]
    );
}

#[test]
fn a_later_stage_may_not() {
    let found = messages_of(
        "geometry/fetch",
        "\nuse super::{assembly::A, setup::Setup};",
    );
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        found[0]
            .starts_with("error: crates/estampe-core/src/geometry/fetch.rs:2: `geometry::fetch`")
    );
    assert!(found[0].contains("`geometry::setup::Setup`"));
    assert_eq!(
        messages_of("bounds", "fn f() { crate::raster::run() }").len(),
        1
    );
    assert_eq!(
        messages_of("geometry/mod", "use crate::raster::Coverage;").len(),
        1
    );
    assert_eq!(
        messages_of("raster/edge/walk", "use super::super::super::fragment::F;").len(),
        1
    );
}

#[test]
fn a_re_export_does_not_hide_a_later_stage() {
    for (module, source) in [
        ("bounds", "use crate::Coverage;"),
        ("geometry/fetch", "use super::SetupPrimitive;"),
        ("geometry/fetch", "use crate::geometry::*;"),
    ] {
        assert_eq!(messages_of(module, source).len(), 1, "{source}");
    }
}

#[test]
fn the_last_layer_names_all_and_is_named_by_none() {
    let source = "use crate::{geometry::fetch, raster, attachment::Attachment, Limits};";
    assert_eq!(messages_of("transfer", source), [""; 0]);
    assert_eq!(messages_of("raster", "use crate::draw::Draw;").len(), 1);
    assert_eq!(
        messages_of("statistics", "use crate::raster::Edge;").len(),
        1
    );
}

#[test]
fn every_module_has_a_layer() {
    let found = messages_of("unknown", "fn f() {}");
    assert_eq!(found.len(), 1);
    assert!(found[0].contains("has no layer"));
    assert_eq!(
        messages_of("lib", "mod unknown; pub use crate::draw::Draw;"),
        [""; 0]
    );
}

#[test]
fn a_module_without_a_row_has_the_layer_of_its_folder() {
    assert_eq!(
        messages_of("geometry/new", "use super::setup::Setup;"),
        [""; 0]
    );
    assert_eq!(
        messages_of("geometry/new", "use crate::raster::Edge;").len(),
        1
    );
    assert_eq!(
        messages_of("geometry/clip", "use super::new::New;").len(),
        1
    );
}

#[test]
fn comments_strings_and_tests_are_free() {
    let source = "//! See [`crate::raster`].\nfn f() { g(\"crate::raster::x\") }\n\
                  #[cfg(test)]\nmod tests { use crate::raster::Edge; use rayon::Scope; }";
    assert_eq!(messages_of("bounds", source), [""; 0]);
    assert_eq!(
        messages_of("bounds/tests", "use crate::attachment::A;"),
        [""; 0]
    );
}

#[test]
fn only_the_scheduler_names_rayon() {
    assert_eq!(
        messages_of("schedule/pool", "use rayon::ThreadPool;"),
        [""; 0]
    );
    assert_eq!(
        messages_of("raster", "fn f() { rayon::join(a, b) }").len(),
        1
    );
}
