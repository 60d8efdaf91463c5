//! The check must fail on packages that break the tables, and only on those.

use super::*;
use crate::packages::Dependency;

/// The objections to a package with these dependencies.
fn objections_of(name: &str, dependencies: Vec<Dependency>) -> Vec<String> {
    objections(&Package::synthetic(name, dependencies))
}

fn used(package: &str) -> Vec<Dependency> {
    vec![Dependency::synthetic(package, false)]
}

fn used_by_tests(package: &str) -> Vec<Dependency> {
    vec![Dependency::synthetic(package, true)]
}

#[test]
fn allowed_edges_pass() {
    for (name, dependencies) in [
        ("estampe-core", used("estampe-simd")),
        ("estampe-core", used("rayon-core")),
        ("estampe-core", used_by_tests("fastrand")),
        ("estampe-renderer", used_by_tests("estampe-shapes")),
        ("estampe-tests", used("estampe-reference")),
        ("estampe-gpu", used_by_tests("estampe-gpu")),
    ] {
        assert_eq!(objections_of(name, dependencies), [""; 0], "{name}");
    }
}

#[test]
fn forbidden_edges_fail() {
    for (name, package) in [
        ("estampe-reference", "estampe-core"),
        ("estampe-core", "estampe-scene"),
        ("estampe-core", "estampe-reference"),
        ("estampe-types", "estampe-texture"),
        ("estampe", "estampe-bench"),
        ("estampe", "xtask"),
        ("estampe-renderer", "rayon-core"),
        ("estampe-renderer", "estampe-assets"),
        ("estampe-core", "fearless_simd"),
        ("estampe-scene", "png"),
        ("estampe-gpu", "clap"),
    ] {
        let found = objections_of(name, used(package));
        let expected = format!("`{name}` may not use `{package}`: see ARCHITECTURE.md");
        assert_eq!(found, [expected]);
    }
    assert_eq!(
        objections_of("estampe-texture", used_by_tests("estampe-reference")).len(),
        1
    );
}

#[test]
fn a_package_without_a_row_fails() {
    assert_eq!(objections_of("estampe-unknown", Vec::new()).len(), 1);
    let found = objections_of("estampe-core", used("left-pad"));
    assert!(found[0].contains("`left-pad` has no row"), "{found:?}");
    assert_eq!(found.len(), 1);
}

#[test]
fn a_row_without_a_package_fails() {
    assert_eq!(check_packages(&[]).len(), CRATES.len());
}

#[test]
fn packages_must_inherit_and_be_in_their_folder() {
    let mut package = Package::synthetic("estampe-simd", Vec::new());
    package.folder = "crates/simd".into();
    package.license = None;
    assert_eq!(objections(&package).len(), 2);
    assert!(inherits_lints("[lints]\nworkspace = true"));
    assert!(!inherits_lints("[package]\nname = \"a\""));
}

#[test]
fn features_that_keep_pictures_the_same_are_required() {
    let mut glam = Dependency::synthetic("glam", false);
    assert_eq!(objections_of("estampe-types", vec![glam.clone()]).len(), 1);
    glam.features = vec!["libm".to_owned(), "scalar-math".to_owned()];
    assert_eq!(objections_of("estampe-types", vec![glam.clone()]), [""; 0]);
    glam.has_default_features = true;
    assert_eq!(objections_of("estampe-types", vec![glam]).len(), 1);
}

#[test]
fn every_row_names_known_crates() {
    let are_known = |names: &[&str]| {
        let is_known = |name: &&str| CRATES.iter().any(|(row, _)| row == name);
        names.iter().all(is_known)
    };
    for (name, uses) in CRATES.iter().chain(TESTS) {
        assert!(are_known(uses), "{name}");
    }
    for (outside, users) in OUTSIDE {
        if let Users::Only(users) = users {
            assert!(are_known(users), "{outside}");
        }
    }
}
