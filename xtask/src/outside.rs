//! Packages from outside: where they come from, under which licence, and which are refused.
//!
//! This is what `cargo deny check bans licenses sources` would say. It is checked here because the
//! rules must hold on every machine, and cargo-deny would have to be installed first.

use spdx::{Expression, LicenseItem};
use toml::{Table, Value};

use crate::packages::{Package, Packages};
use crate::{Finding, Repository};

const LOCK: &str = "Cargo.lock";

const CRATES_IO: &str = "registry+https://github.com/rust-lang/crates.io-index";

/// Permissive licences: a program that contains estampe owes a notice and nothing else.
const LICENSES: &[&str] = &[
    "0BSD",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "IJG",
    "ISC",
    "MIT",
    "Unicode-3.0",
    "Zlib",
];

/// Packages that must not be built, and why: one `cargo` command builds everything on a machine
/// with Rust alone.
const REFUSED: &[(&str, &str)] = &[
    ("bindgen", "it needs libclang"),
    ("cc", "it compiles C"),
    ("cmake", "it compiles C and C++"),
    ("cxx-build", "it compiles C++"),
    ("nasm-rs", "it needs an assembler"),
    ("pkg-config", "it looks for system libraries"),
    ("vcpkg", "it looks for system libraries"),
];

/// Checks that every locked package comes from crates.io and is not refused, and that every package
/// of a build for this machine has a permissive licence.
#[must_use]
pub fn check_outside(repository: &Repository) -> Vec<Finding> {
    let error = |message: String| vec![Finding::error(LOCK, 0, message)];
    let mut findings = match std::fs::read_to_string(repository.root().join(LOCK)) {
        Ok(lock) => check_lock(&lock).unwrap_or_else(|cause| error(cause.to_string())),
        Err(cause) => error(cause.to_string()),
    };
    findings.extend(match Packages::of(repository) {
        Ok(packages) => packages.outside.iter().filter_map(check_license).collect(),
        Err(cause) => error(cause.to_string()),
    });
    findings
}

fn check_lock(lock: &str) -> Result<Vec<Finding>, toml::de::Error> {
    let lock: Table = lock.parse()?;
    let packages = lock.get("package").and_then(Value::as_array);
    let mut findings = Vec::new();
    for package in packages.into_iter().flatten() {
        let text = |key: &str| package.get(key).and_then(Value::as_str);
        let name = text("name").unwrap_or_default();
        let mut object = |message: String| findings.push(Finding::error(LOCK, 0, message));
        if let Some(source) = text("source").filter(|source| *source != CRATES_IO) {
            object(format!("`{name}` comes from {source}, not from crates.io"));
        }
        let refused = REFUSED.iter().find(|(refused, _)| *refused == name);
        if let Some((_, reason)) = refused {
            object(format!(
                "`{name}` is refused: {reason}; see `cargo tree -i {name}`"
            ));
        } else if name.ends_with("-sys") && !is_pure_rust(name) {
            object(format!(
                "`{name}` is named like a binding to a system library: if it is none, say so in \
                 xtask/src/outside.rs"
            ));
        }
    }
    Ok(findings)
}

/// Returns true if a `-sys` package only declares the interface of the operating system or the
/// browser.
fn is_pure_rust(name: &str) -> bool {
    matches!(name, "linux-raw-sys" | "windows-sys" | "js-sys" | "web-sys")
}

fn check_license(package: &Package) -> Option<Finding> {
    let Some(license) = &package.license else {
        let message = format!("`{}` names no licence", package.name);
        return Some(Finding::error(LOCK, 0, message));
    };
    let is_permissive = |item: &LicenseItem| match item {
        LicenseItem::Spdx { id, .. } => LICENSES.contains(&id.name),
        LicenseItem::Other { .. } => false,
    };
    let objection = match Expression::parse_mode(license, spdx::ParseMode::LAX) {
        Ok(expression) if expression.evaluate(|found| is_permissive(&found.license)) => {
            return None;
        }
        Ok(_) => "is not among those of xtask/src/outside.rs".to_owned(),
        Err(cause) => format!("is not an SPDX expression: {}", cause.reason),
    };
    let message = format!("the licence of `{}`, {license}, {objection}", package.name);
    Some(Finding::error(LOCK, 0, message))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages_of(name: &str, source: &str) -> Vec<String> {
        let lock = format!("[[package]]\nname = \"{name}\"\nsource = \"{source}\"");
        let findings = check_lock(&lock).expect("the text is TOML");
        findings.iter().map(ToString::to_string).collect()
    }

    fn permits(license: &str) -> bool {
        let mut package = Package::synthetic("a", Vec::new());
        package.license = Some(license.to_owned());
        check_license(&package).is_none()
    }

    #[test]
    fn refused_packages_and_other_sources_are_found() {
        assert_eq!(messages_of("libm", CRATES_IO), [""; 0]);
        assert_eq!(messages_of("linux-raw-sys", CRATES_IO), [""; 0]);
        assert!(messages_of("cc", CRATES_IO)[0].contains("compiles C"));
        assert!(messages_of("libpng-sys", CRATES_IO)[0].contains("system library"));
        assert!(messages_of("libm", "git+https://example.org/libm")[0].contains("crates.io"));
    }

    #[test]
    fn packages_of_our_own_have_no_source() {
        let findings = check_lock("[[package]]\nname = \"estampe\"").expect("the text is TOML");
        assert!(findings.is_empty());
    }

    #[test]
    fn a_choice_of_licences_needs_one_that_is_permissive() {
        assert!(permits("MIT OR GPL-3.0-only"));
        assert!(permits("MIT/Apache-2.0"));
        assert!(permits("(MIT OR Apache-2.0) AND Unicode-3.0"));
        assert!(permits("Apache-2.0 WITH LLVM-exception"));
        assert!(!permits("GPL-3.0-only"));
        assert!(!permits("MIT AND MPL-2.0"));
        assert!(!permits("no licence"));
    }
}
