//! The check must fail on manifests that break the tables, and only on those.

use super::*;

/// The findings about one crate with these dependency sections.
fn messages_of(name: &str, sections: &str) -> Vec<String> {
    let manifest = format!(
        "[package]\nname = \"{name}\"\nlicense.workspace = true\n[lints]\nworkspace = true\n{sections}"
    );
    let path = format!("crates/{name}/Cargo.toml");
    check_edges(&Repository::synthetic(&[(&path, &manifest)]))
        .iter()
        .map(ToString::to_string)
        .filter(|message| message.contains(&path))
        .collect()
}

#[test]
fn allowed_edges_pass() {
    let core = "[dependencies]\nestampe-simd.workspace = true\nrayon = \"1\"\n\
                [dev-dependencies]\nproptest = \"1\"";
    assert_eq!(messages_of("estampe-core", core), [""; 0]);
    let tests =
        "[dependencies]\nestampe-core = { path = \"x\" }\nestampe-reference = { path = \"y\" }";
    assert_eq!(messages_of("estampe-tests", tests), [""; 0]);
}

#[test]
fn forbidden_edges_fail() {
    for (name, package) in [
        ("estampe-reference", "estampe-core"),
        ("estampe-core", "estampe-scene"),
        ("estampe-core", "estampe-reference"),
        ("estampe-types", "estampe-texture"),
        ("estampe-cli", "estampe-bench"),
        ("estampe-cli", "xtask"),
        ("estampe-renderer", "rayon"),
        ("estampe-core", "glam"),
        ("estampe-core", "fearless_simd"),
        ("estampe-scene", "png"),
        ("estampe", "clap"),
    ] {
        let found = messages_of(name, &format!("[dependencies]\n{package} = \"1\""));
        assert_eq!(found.len(), 1, "{name} -> {package}: {found:?}");
        assert!(found[0].contains(&format!("`{name}` may not use `{package}`")));
    }
}

#[test]
fn a_forbidden_edge_cannot_hide() {
    for section in [
        "[target.'cfg(unix)'.dependencies]\nrayon = \"1\"",
        "[dependencies]\nthreads = { package = \"rayon\", version = \"1\" }",
        "[dev-dependencies]\nestampe-reference.workspace = true",
        "[build-dependencies]\nrayon = \"1\"",
    ] {
        assert_eq!(
            messages_of("estampe-texture", section).len(),
            1,
            "{section}"
        );
    }
}

#[test]
fn what_has_no_row_fails() {
    assert_eq!(messages_of("estampe-attic", "").len(), 1);
    assert_eq!(
        messages_of("estampe-core", "[dependencies]\nleft-pad = \"1\"").len(),
        1
    );
}

#[test]
fn a_row_without_a_crate_fails() {
    let found = check_edges(&Repository::synthetic(&[]));
    assert_eq!(found.len(), ROOMS.len());
}

#[test]
fn manifests_must_inherit_lints_and_lie_in_their_folder() {
    let bare = "[package]\nname = \"estampe-simd\"\nlicense.workspace = true";
    let findings = check_edges(&Repository::synthetic(&[("crates/simd/Cargo.toml", bare)]));
    let about: Vec<_> = findings
        .iter()
        .filter(|f| f.path.starts_with("crates"))
        .collect();
    assert_eq!(about.len(), 2, "{about:?}");
}

#[test]
fn features_that_keep_pictures_the_same_are_required() {
    let found = check_workspace(
        "Cargo.toml",
        "[workspace.dependencies]\nglam = { version = \"1\" }",
    );
    assert_eq!(found.len(), 2);
    let glam = "[workspace.dependencies]\nglam = { features = [\"libm\", \"scalar-math\"] }";
    assert!(check_workspace("Cargo.toml", glam).is_empty());
}

#[test]
fn every_row_names_known_crates() {
    let are_known = |names: &[&str]| {
        names
            .iter()
            .all(|name| ROOMS.iter().any(|room| room.name == *name))
    };
    for room in ROOMS {
        assert!(are_known(room.uses), "{}", room.name);
        assert!(are_known(room.tests_use), "{}", room.name);
    }
    for (outside, homes) in OUTSIDE {
        if let Homes::Only(homes) = homes {
            assert!(are_known(homes), "{outside}");
        }
    }
}
