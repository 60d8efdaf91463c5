//! Crate edges: who may use whom, and behind which crate a heavy dependency lives.
//!
//! The tables restate ARCHITECTURE.md's. Every crate and every outside dependency must have a row: a
//! new one is a decision, not an accident.

use toml::{Table, Value};

use crate::manifests::{Kind, Manifest, value_at};
use crate::{Finding, Repository};

/// What one crate of ours may use.
struct Room {
    name: &'static str,
    /// Our crates that it may link.
    uses: &'static [&'static str],
    /// Our crates that its tests and examples may link besides.
    tests_use: &'static [&'static str],
}

/// One row per crate, in the order in which data flows.
const ROOMS: &[Room] = &[
    Room {
        name: "estampe-simd",
        uses: &[],
        tests_use: &[],
    },
    Room {
        name: "estampe-types",
        uses: &["estampe-simd"],
        tests_use: &[],
    },
    Room {
        name: "estampe-texture",
        uses: &["estampe-types", "estampe-simd"],
        tests_use: &[],
    },
    Room {
        name: "estampe-core",
        uses: &["estampe-types", "estampe-simd", "estampe-texture"],
        tests_use: &[],
    },
    Room {
        name: "estampe-shapes",
        uses: &["estampe-types"],
        tests_use: &[],
    },
    Room {
        name: "estampe",
        uses: &[
            "estampe-types",
            "estampe-simd",
            "estampe-texture",
            "estampe-core",
        ],
        tests_use: &[],
    },
    Room {
        name: "estampe-scene",
        uses: &["estampe-types"],
        tests_use: &[],
    },
    Room {
        name: "estampe-assets",
        uses: &["estampe-types", "estampe-scene", "estampe-shapes"],
        tests_use: &[],
    },
    Room {
        name: "estampe-renderer",
        uses: &[
            "estampe",
            "estampe-scene",
            "estampe-simd",
            "estampe-texture",
        ],
        tests_use: &["estampe-shapes"],
    },
    Room {
        name: "estampe-cli",
        uses: LIBRARIES,
        tests_use: &[],
    },
    // The oracle's independence is its value: it shares the contract and no code.
    Room {
        name: "estampe-reference",
        uses: &["estampe-types"],
        tests_use: &[],
    },
    Room {
        name: "estampe-tests",
        uses: LIBRARIES,
        tests_use: &["estampe-reference"],
    },
    Room {
        name: "estampe-bench",
        uses: LIBRARIES,
        tests_use: &[],
    },
    Room {
        name: "xtask",
        uses: &[],
        tests_use: &[],
    },
];

/// Everything that a program may be built from.
const LIBRARIES: &[&str] = &[
    "estampe-simd",
    "estampe-types",
    "estampe-texture",
    "estampe-core",
    "estampe-shapes",
    "estampe",
    "estampe-scene",
    "estampe-assets",
    "estampe-renderer",
];

/// Who may use a dependency from outside.
enum Homes {
    /// Small, without influence on a picture, and of use anywhere.
    Any,
    /// These crates only.
    Only(&'static [&'static str]),
}

/// One row per dependency from outside, with what confines it.
const OUTSIDE: &[(&str, Homes)] = &[
    // Threads: the scheduler of the pipeline owns them (see also the stage order).
    ("rayon", Homes::Only(&["estampe-core"])),
    // The lanes' one implementation.
    ("fearless_simd", Homes::Only(&["estampe-simd"])),
    // Never on a path to a pixel: lane code does that work.
    (
        "glam",
        Homes::Only(&[
            "estampe-types",
            "estampe-shapes",
            "estampe",
            "estampe-scene",
            "estampe-assets",
            "estampe-renderer",
            "estampe-cli",
            "estampe-tests",
            "estampe-bench",
        ]),
    ),
    // Blocks of compressed textures, decoded when a texture is made.
    ("bcdec_rs", Homes::Only(&["estampe-texture"])),
    ("earcut", Homes::Only(&["estampe-shapes"])),
    // File formats: everyone else sees decoded images.
    ("png", Homes::Only(&["estampe-assets", "estampe-bench"])),
    ("image", Homes::Only(&["estampe-assets"])),
    // CPU time of the process.
    ("rustix", Homes::Only(&["estampe-bench"])),
    // The command line.
    ("clap", Homes::Only(&["estampe-cli", "estampe-bench"])),
    ("indicatif", Homes::Only(&["estampe-cli", "estampe-bench"])),
    (
        "serde",
        Homes::Only(&["estampe-cli", "estampe-bench", "estampe-tests"]),
    ),
    (
        "serde_json",
        Homes::Only(&["estampe-cli", "estampe-bench", "estampe-tests"]),
    ),
    // The repository's chores.
    ("toml", Homes::Only(&["xtask"])),
    ("rustc-demangle", Homes::Only(&["xtask"])),
    ("libm", Homes::Any),
    ("thiserror", Homes::Any),
    ("proptest", Homes::Any),
];

/// Features without which a dependency would change pictures, with the reason.
const REQUIRED_FEATURES: &[(&str, &[&str], &str)] = &[
    (
        "glam",
        &["libm", "scalar-math"],
        "its SIMD types round differently from platform to platform",
    ),
    (
        "fearless_simd",
        &["force_support_fallback"],
        "the scalar level must exist on every machine",
    ),
];

/// Checks every manifest against the tables.
#[must_use]
pub fn check_edges(repository: &Repository) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut seen = Vec::new();
    for file in repository
        .files()
        .filter(|file| file.path.ends_with("Cargo.toml"))
    {
        if file.path.components().count() == 1 {
            findings.extend(check_workspace(
                file.path.to_string_lossy().as_ref(),
                &file.text,
            ));
            continue;
        }
        let error = |message: String| Finding::error(&file.path, 0, message);
        let manifest = match Manifest::parse(file) {
            Ok(manifest) => manifest,
            Err(message) => {
                findings.push(error(message));
                continue;
            }
        };
        let folder = file.path.parent().and_then(|folder| folder.file_name());
        if folder.is_none_or(|folder| folder != manifest.name.as_str()) {
            findings.push(error(format!(
                "`{}` must lie in a folder of its name",
                manifest.name
            )));
        }
        findings.extend(objections(&manifest).into_iter().map(error));
        seen.push(manifest.name);
    }
    findings.extend(
        ROOMS
            .iter()
            .filter(|room| !seen.iter().any(|name| name == room.name))
            .map(|room| {
                let message = format!(
                    "the table has a row for `{}`, which does not exist",
                    room.name
                );
                Finding::error("xtask/src/edges.rs", 0, message)
            }),
    );
    findings
}

fn objections(manifest: &Manifest) -> Vec<String> {
    let name = manifest.name.as_str();
    let Some(room) = ROOMS.iter().find(|room| room.name == name) else {
        return vec![format!(
            "`{name}` has no row in the table of xtask/src/edges.rs"
        )];
    };
    let mut objections = Vec::new();
    for keys in [
        ["lints", "workspace"].as_slice(),
        &["package", "license", "workspace"],
    ] {
        if !manifest.is_true(keys) {
            objections.push(format!("`{} = true` is missing", keys.join(".")));
        }
    }
    for dependency in &manifest.dependencies {
        let package = dependency.package.as_str();
        let may_use = if ROOMS.iter().any(|room| room.name == package) {
            let in_tests = dependency.kind == Kind::Dev && room.tests_use.contains(&package);
            // The tests' own crate links the oracle as a normal dependency: all of it is tests.
            let is_oracle = name == "estampe-tests" && room.tests_use.contains(&package);
            // A crate's examples and tests may always name the crate itself.
            room.uses.contains(&package) || in_tests || is_oracle || package == name
        } else {
            match OUTSIDE.iter().find(|(outside, _)| *outside == package) {
                Some((_, Homes::Any)) => true,
                Some((_, Homes::Only(homes))) => homes.contains(&name),
                None => {
                    objections.push(format!(
                        "`{package}` has no row among the outside dependencies of \
                         xtask/src/edges.rs: say there who may use it"
                    ));
                    true
                }
            }
        };
        if !may_use {
            objections.push(format!(
                "`{name}` may not use `{package}`: see ARCHITECTURE.md"
            ));
        }
    }
    objections
}

fn check_workspace(path: &str, text: &str) -> Vec<Finding> {
    let table: Table = match text.parse() {
        Ok(table) => table,
        Err(error) => return vec![Finding::error(path, 0, format!("{error}"))],
    };
    let mut findings = Vec::new();
    for (name, required, reason) in REQUIRED_FEATURES {
        let Some(entry) = value_at(&table, &["workspace", "dependencies", name]) else {
            continue;
        };
        let features = entry.get("features").and_then(Value::as_array);
        let has = |feature: &str| {
            features.is_some_and(|list| list.iter().any(|entry| entry.as_str() == Some(feature)))
        };
        findings.extend(
            required
                .iter()
                .filter(|feature| !has(feature))
                .map(|feature| {
                    Finding::error(
                        path,
                        0,
                        format!("`{name}` needs its feature `{feature}`: {reason}"),
                    )
                }),
        );
    }
    findings
}

#[cfg(test)]
mod tests;
