//! Unused dependencies: each declared one is named by the crate's sources.
//!
//! The check looks for the crate's name among the identifiers, as cargo-machete does, so that it
//! needs no build. A name in a comment or a string does not count.

use std::collections::BTreeSet;

use crate::packages::{Package, Packages};
use crate::rust_source::RustSource;
use crate::{Finding, Repository};

/// Checks that the sources of every crate of ours name each of its dependencies: those of the
/// library or program in `src`, those of tests anywhere.
#[must_use]
pub fn check_unused(repository: &Repository) -> Vec<Finding> {
    match Packages::of(repository) {
        Ok(packages) => check_packages(repository, &packages.workspace),
        Err(cause) => vec![Finding::error("Cargo.toml", 0, cause.to_string())],
    }
}

fn check_packages(repository: &Repository, packages: &[Package]) -> Vec<Finding> {
    let mut findings = Vec::new();
    for package in packages {
        let mut in_product = BTreeSet::new();
        let mut anywhere = BTreeSet::new();
        let files = repository.rust_files();
        for file in files.filter(|file| file.path.starts_with(&package.folder)) {
            // The check of files reports what cannot be parsed.
            let Ok(source) = RustSource::parse(&file.text) else {
                continue;
            };
            if file.path.starts_with(package.folder.join("src")) && !file.is_test() {
                let names = source.without_test_items().identifiers();
                in_product.extend(names.into_iter().map(|found| found.name));
            }
            anywhere.extend(source.identifiers().into_iter().map(|found| found.name));
        }
        for dependency in &package.dependencies {
            let message = match (dependency.is_dev, dependency.crate_name.as_str()) {
                (false, name) if in_product.contains(name) => continue,
                (true, name) if anywhere.contains(name) => continue,
                (false, name) if anywhere.contains(name) => {
                    format!("only tests use `{name}`: declare it among `dev-dependencies`")
                }
                (_, name) => format!("nothing uses `{name}`: remove it"),
            };
            findings.push(Finding::error(
                package.folder.join("Cargo.toml"),
                0,
                message,
            ));
        }
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packages::Dependency;

    fn messages_of(path: &str, source: &str, is_dev: bool) -> Vec<String> {
        let package = Package::synthetic("a", vec![Dependency::synthetic("b-c", is_dev)]);
        let repository =
            Repository::synthetic(&[(path, source), ("crates/d/src/lib.rs", "use b_c;")]);
        let findings = check_packages(&repository, &[package]);
        findings
            .into_iter()
            .map(|finding| finding.message)
            .collect()
    }

    #[test]
    fn dependencies_that_are_named_pass() {
        assert_eq!(
            messages_of("crates/a/src/x.rs", "m! { b_c::f() }", false),
            [""; 0]
        );
        assert_eq!(
            messages_of("crates/a/tests/x.rs", "use b_c::f;", true),
            [""; 0]
        );
        let test = "#[cfg(test)] mod tests { use b_c::f; }";
        assert_eq!(messages_of("crates/a/src/lib.rs", test, true), [""; 0]);
    }

    #[test]
    fn dependencies_that_only_comments_name_fail() {
        for is_dev in [false, true] {
            let found = messages_of(
                "crates/a/src/x.rs",
                "/// See [`b_c`].\nfn f() { \"b_c\" }",
                is_dev,
            );
            assert_eq!(found, ["nothing uses `b_c`: remove it"]);
        }
    }

    #[test]
    fn dependencies_that_only_tests_name_are_for_tests() {
        let test = "#[cfg(test)] mod tests { use b_c::f; }";
        let found = messages_of("crates/a/src/lib.rs", test, false);
        assert!(found[0].starts_with("only tests use `b_c`"), "{found:?}");
    }
}
