//! What comes from outside: the packages of Cargo.lock against the bans of deny.toml.
//!
//! `cargo deny` judges licences and advisories too, but has to be installed. That nothing compiles C,
//! looks for a system library or comes from elsewhere than crates.io must hold on every machine, so
//! it is checked here from the same table.

use toml::{Table, Value};

use crate::manifests::value_at;
use crate::{Finding, Repository};

const CRATES_IO: &str = "registry+https://github.com/rust-lang/crates.io-index";

/// Checks that no banned package is locked, and that all come from crates.io.
#[must_use]
pub fn check_outside(repository: &Repository) -> Vec<Finding> {
    let lock = repository.root().join("Cargo.lock");
    let bans = repository.file("deny.toml").map(|file| file.text.as_str());
    match (std::fs::read_to_string(lock), bans) {
        (Ok(lock), Some(bans)) => check_lock(&lock, bans)
            .unwrap_or_else(|error| vec![Finding::error("Cargo.lock", 0, error.to_string())]),
        (Err(error), _) => vec![Finding::error("Cargo.lock", 0, error.to_string())],
        (_, None) => vec![Finding::error(
            "deny.toml",
            0,
            "the table of bans is missing",
        )],
    }
}

fn check_lock(lock: &str, deny: &str) -> Result<Vec<Finding>, toml::de::Error> {
    let (lock, deny): (Table, Table) = (lock.parse()?, deny.parse()?);
    let bans = value_at(&deny, &["bans", "deny"]).and_then(Value::as_array);
    let packages = lock.get("package").and_then(Value::as_array);
    let text = |value: &Value, key: &str| value.get(key).and_then(Value::as_str).map(str::to_owned);

    let mut findings = Vec::new();
    for package in packages.into_iter().flatten() {
        let name = text(package, "name").unwrap_or_default();
        let mut object = |message: String| findings.push(Finding::error("Cargo.lock", 0, message));
        if let Some(source) = text(package, "source").filter(|source| source != CRATES_IO) {
            object(format!("`{name}` comes from {source}, not from crates.io"));
        }
        for ban in bans.into_iter().flatten() {
            if text(ban, "crate").as_ref() == Some(&name) {
                let reason = text(ban, "reason").unwrap_or_default();
                object(format!(
                    "`{name}` is banned: {reason}; see `cargo tree -i {name}`"
                ));
            }
        }
    }
    Ok(findings)
}

#[cfg(test)]
mod tests {
    use super::*;

    const BANS: &str = "[bans]\ndeny = [{ crate = \"cc\", reason = \"compiles C\" }]";

    fn messages_of(name: &str, source: &str) -> Vec<String> {
        let lock = format!("[[package]]\nname = \"{name}\"\nsource = \"{source}\"");
        let findings = check_lock(&lock, BANS).expect("both texts are TOML");
        findings.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn bans_and_sources_are_kept() {
        assert_eq!(messages_of("libm", CRATES_IO), [""; 0]);
        assert!(messages_of("cc", CRATES_IO)[0].contains("compiles C"));
        assert!(messages_of("libm", "git+https://example.org/libm")[0].contains("crates.io"));
    }

    #[test]
    fn packages_of_our_own_have_no_source() {
        let findings = check_lock("[[package]]\nname = \"estampe\"", BANS).expect("TOML");
        assert!(findings.is_empty());
    }
}
