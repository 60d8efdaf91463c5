//! Crate edges: which crate may use which, and behind which crates an outside dependency lives.
//!
//! The tables restate ARCHITECTURE.md's. Every crate and every outside dependency must have a row:
//! a new one is a decision, not an accident.

use toml::{Table, Value};

use crate::packages::{Package, Packages};
use crate::{Finding, Repository};

/// The workspace crates that each crate may use, in the order in which data flows.
const CRATES: &[(&str, &[&str])] = &[
    ("estampe-simd", &[]),
    ("estampe-types", &["estampe-simd"]),
    ("estampe-format", &["estampe-types", "estampe-simd"]),
    (
        "estampe-texture",
        &["estampe-types", "estampe-simd", "estampe-format"],
    ),
    (
        "estampe-core",
        &["estampe-types", "estampe-simd", "estampe-format"],
    ),
    (
        "estampe-ir",
        &["estampe-types", "estampe-simd", "estampe-format"],
    ),
    (
        "estampe-shader",
        &[
            "estampe-ir",
            "estampe-types",
            "estampe-simd",
            "estampe-texture",
            "estampe-x86",
        ],
    ),
    (
        "estampe-x86",
        &["estampe-ir", "estampe-types", "estampe-simd"],
    ),
    // `Device::inspect` runs a pass with the oracle, for one pixel.
    (
        "estampe-gpu",
        &[
            "estampe-ir",
            "estampe-shader",
            "estampe-reference",
            "estampe-types",
            "estampe-simd",
            "estampe-format",
            "estampe-texture",
            "estampe-core",
        ],
    ),
    ("estampe-shapes", &[]),
    ("estampe-scene", &[]),
    // Images are halved with the mean of the pipeline's mip levels, and blocks of KTX2 decoded as
    // those of textures; large lists are in huge pages, as textures are.
    (
        "estampe-assets",
        &[
            "estampe-simd",
            "estampe-format",
            "estampe-scene",
            "estampe-shapes",
            "estampe-texture",
        ],
    ),
    ("estampe-transparency", &["estampe-gpu"]),
    // The inside of a section is a polygon, which is triangulated.
    (
        "estampe-renderer",
        &[
            "estampe-gpu",
            "estampe-scene",
            "estampe-shapes",
            "estampe-transparency",
        ],
    ),
    // Depths are rounded by the codec of the pipeline.
    (
        "estampe-visibility",
        &[
            "estampe-gpu",
            "estampe-format",
            "estampe-scene",
            "estampe-transparency",
        ],
    ),
    // The oracle is a second opinion: it shares the types of the interface and no algorithm.
    ("estampe-reference", &["estampe-types"]),
    // The one library that shows the teaching code of the oracle.
    (
        "estampe-ladder",
        &[
            "estampe-gpu",
            "estampe-shapes",
            "estampe-scene",
            "estampe-assets",
            "estampe-renderer",
            "estampe-reference",
        ],
    ),
    ("estampe", LIBRARIES),
    ("estampe-tests", LIBRARIES),
    ("estampe-bench", LIBRARIES),
    ("xtask", &[]),
];

/// The crates that a program may be built from.
const LIBRARIES: &[&str] = &[
    "estampe-simd",
    "estampe-types",
    "estampe-format",
    "estampe-texture",
    "estampe-ir",
    "estampe-shader",
    "estampe-x86",
    "estampe-core",
    "estampe-gpu",
    "estampe-shapes",
    "estampe-scene",
    "estampe-assets",
    "estampe-transparency",
    "estampe-renderer",
    "estampe-visibility",
    "estampe-ladder",
];

/// The workspace crates that only the tests and examples of a crate may use.
const TESTS: &[(&str, &[&str])] = &[
    ("estampe-gpu", &["estampe-shapes"]),
    ("estampe-renderer", &["estampe-reference"]),
    // Texels of storage textures are checked with the oracle's codec.
    ("estampe-shader", &["estampe-reference"]),
    // Pictures of examples and tests as files.
    ("estampe-visibility", &["estampe-assets"]),
    // All of this crate is tests.
    ("estampe-tests", &["estampe-reference"]),
];

/// The crates that may use a dependency from outside.
enum Users {
    /// Every crate: the dependency is small and has no influence on a picture.
    Any,
    /// These crates.
    Only(&'static [&'static str]),
}

/// One row per dependency from outside.
const OUTSIDE: &[(&str, Users)] = &[
    // Threads belong to the scheduler of the pipeline (see also the stage order).
    ("rayon-core", Users::Only(&["estampe-core"])),
    // Texels as words and as bytes, without a copy.
    ("bytemuck", Users::Only(&["estampe-gpu", "estampe-core"])),
    // Sets of buffer and texture usages.
    ("bitflags", Users::Only(&["estampe-gpu"])),
    // The one implementation of the lanes.
    ("fearless_simd", Users::Only(&["estampe-simd"])),
    // Matrices and vectors of applications. Lane code computes what reaches a pixel.
    (
        "glam",
        Users::Only(&[
            "estampe-types",
            "estampe-gpu",
            "estampe-shapes",
            "estampe-scene",
            "estampe-assets",
            "estampe-renderer",
            "estampe-ladder",
            "estampe",
        ]),
    ),
    // Blocks of compressed textures, decoded when a texture is made or a DDS file is read.
    (
        "bcdec_rs",
        Users::Only(&["estampe-texture", "estampe-assets"]),
    ),
    // Shaders as text.
    ("naga", Users::Only(&["estampe-shader"])),
    ("earcut", Users::Only(&["estampe-shapes"])),
    // File formats: all other crates see decoded images. `estampe` writes PNG as an option.
    (
        "png",
        Users::Only(&["estampe-gpu", "estampe-assets", "estampe-bench", "estampe"]),
    ),
    // Images of other programs, as an option.
    ("image", Users::Only(&["estampe-gpu"])),
    ("zune-jpeg", Users::Only(&["estampe-assets"])),
    // Zstandard of KTX2 textures.
    ("ruzstd", Users::Only(&["estampe-assets"])),
    ("jpeg-encoder", Users::Only(&["estampe-assets"])),
    // The tests of the command read what it wrote.
    ("image-webp", Users::Only(&["estampe-assets", "estampe"])),
    ("exr", Users::Only(&["estampe-assets", "estampe"])),
    ("gif", Users::Only(&["estampe-assets", "estampe"])),
    // CPU time of the process; pages of machine code; huge pages.
    (
        "rustix",
        Users::Only(&["estampe-bench", "estampe-simd", "estampe-x86"]),
    ),
    // Registers of machine code.
    ("regalloc2", Users::Only(&["estampe-x86"])),
    // A second opinion on machine code, in tests.
    ("iced-x86", Users::Only(&["estampe-x86"])),
    // Command lines.
    ("clap", Users::Only(&["estampe", "estampe-bench", "xtask"])),
    // Completion scripts and manual pages of the command.
    ("clap_complete", Users::Only(&["estampe"])),
    ("clap_mangen", Users::Only(&["estampe"])),
    // The size of the terminal, for previews; clap uses it too.
    ("terminal_size", Users::Only(&["estampe"])),
    ("indicatif", Users::Only(&["estampe", "estampe-bench"])),
    (
        "serde",
        Users::Only(&[
            "estampe-assets",
            "estampe",
            "estampe-bench",
            "estampe-tests",
        ]),
    ),
    (
        "serde_json",
        Users::Only(&[
            "estampe-assets",
            "estampe",
            "estampe-bench",
            "estampe-tests",
            "estampe-shader",
        ]),
    ),
    // Tangents of normal maps.
    ("bevy_mikktspace", Users::Only(&["estampe-renderer"])),
    // Labels in pictures: rasterized letters.
    ("noto-sans-mono-bitmap", Users::Only(&["estampe-renderer"])),
    // Files of a batch: their names, and whether they have changed.
    ("glob", Users::Only(&["estampe"])),
    // Interrupts: no temporary files stay.
    ("signal-hook", Users::Only(&["estampe"])),
    ("twox-hash", Users::Only(&["estampe"])),
    // The XML of 3MF packages.
    ("quick-xml", Users::Only(&["estampe-assets"])),
    // Packed parts of 3MF packages; the data of tests; the package of the command, and its
    // checksum.
    (
        "flate2",
        Users::Only(&["estampe-assets", "estampe-shader", "xtask"]),
    ),
    ("sha2", Users::Only(&["xtask"])),
    // The checks of the repository.
    ("cargo_metadata", Users::Only(&["xtask"])),
    ("object", Users::Only(&["xtask"])),
    ("proc-macro2", Users::Only(&["xtask"])),
    ("pulldown-cmark", Users::Only(&["xtask"])),
    ("rustc-demangle", Users::Only(&["xtask"])),
    ("spdx", Users::Only(&["xtask"])),
    ("toml", Users::Only(&["estampe", "xtask"])),
    // Programs that must not compile.
    ("trybuild", Users::Only(&["estampe-gpu"])),
    ("libm", Users::Any),
    ("thiserror", Users::Any),
    ("fastrand", Users::Any),
];

/// The licence of each of our crates.
const LICENSE: &str = "MIT OR Apache-2.0";

/// The features that keep the pictures the same on every platform, in place of the default ones.
const REQUIRED_FEATURES: &[(&str, &[&str], &str)] = &[(
    "glam",
    &["libm", "scalar-math"],
    "its SIMD types round differently from platform to platform",
)];

/// Checks the packages of the workspace against the tables.
#[must_use]
pub fn check_edges(repository: &Repository) -> Vec<Finding> {
    let packages = match Packages::of(repository) {
        Ok(packages) => packages.workspace,
        Err(cause) => return vec![Finding::error("Cargo.toml", 0, cause.to_string())],
    };
    let mut findings = check_packages(&packages);
    for package in &packages {
        let path = package.folder.join("Cargo.toml");
        let inherits = repository
            .file(&path)
            .is_some_and(|file| inherits_lints(&file.text));
        if !inherits {
            findings.push(Finding::error(
                path,
                0,
                "`lints.workspace = true` is missing",
            ));
        }
    }
    findings
}

fn check_packages(packages: &[Package]) -> Vec<Finding> {
    let mut findings: Vec<Finding> = packages
        .iter()
        .flat_map(|package| {
            let path = package.folder.join("Cargo.toml");
            objections(package)
                .into_iter()
                .map(move |message| Finding::error(&path, 0, message))
        })
        .collect();
    for (name, _) in CRATES {
        if !packages.iter().any(|package| package.name == *name) {
            let message = format!("the table has a row for `{name}`, which does not exist");
            findings.push(Finding::error(file!(), 0, message));
        }
    }
    findings
}

fn objections(package: &Package) -> Vec<String> {
    let name = package.name.as_str();
    let mut objections = Vec::new();
    if package.folder.file_name() != Some(name.as_ref()) {
        objections.push(format!("`{name}` must be in a folder of its name"));
    }
    if package.license.as_deref() != Some(LICENSE) {
        objections.push("`license.workspace = true` is missing".to_owned());
    }
    let Some((_, uses)) = CRATES.iter().find(|(row, _)| *row == name) else {
        objections.push(format!("`{name}` has no row in the table of {}", file!()));
        return objections;
    };
    let tests_use = TESTS.iter().find(|(row, _)| *row == name);
    let tests_use = tests_use.map_or(&[][..], |(_, tests_use)| tests_use);
    for dependency in &package.dependencies {
        let used = dependency.package.as_str();
        let may_use = if CRATES.iter().any(|(row, _)| *row == used) {
            let is_for_tests = dependency.is_dev || name == "estampe-tests";
            // A crate's examples and tests may name the crate itself.
            uses.contains(&used) || is_for_tests && tests_use.contains(&used) || used == name
        } else {
            match OUTSIDE.iter().find(|(row, _)| *row == used) {
                Some((_, Users::Any)) => true,
                Some((_, Users::Only(users))) => users.contains(&name),
                None => {
                    objections.push(format!(
                        "`{used}` has no row among the outside dependencies of {}: say there which \
                         crates may use it",
                        file!()
                    ));
                    continue;
                }
            }
        };
        if !may_use {
            objections.push(format!(
                "`{name}` may not use `{used}`: see ARCHITECTURE.md"
            ));
        }
        for (_, required, reason) in REQUIRED_FEATURES.iter().filter(|(row, ..)| *row == used) {
            let has = |feature: &&str| dependency.features.iter().any(|found| found == feature);
            if dependency.has_default_features || !required.iter().all(has) {
                objections.push(format!(
                    "`{used}` needs the features {} in place of the default ones: {reason}",
                    required.join(", ")
                ));
            }
        }
    }
    objections
}

/// Returns true if the manifest says `lints.workspace = true`. The output of `cargo metadata` does
/// not contain this.
fn inherits_lints(manifest: &str) -> bool {
    let table: Table = manifest.parse().unwrap_or_default();
    let lints = table.get("lints").and_then(|lints| lints.get("workspace"));
    lints.and_then(Value::as_bool) == Some(true)
}

#[cfg(test)]
mod tests;
