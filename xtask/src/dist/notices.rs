//! The licences of the packages from outside that the program contains: their authors ask that
//! copies carry them.

use cargo_metadata::{DependencyKind, Metadata, MetadataCommand, Package, PackageId, TargetKind};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use super::located;

/// How names of files begin that hold a licence, in capitals.
const NAMES: &[&str] = &[
    "LICENSE",
    "LICENCE",
    "COPYING",
    "COPYRIGHT",
    "NOTICE",
    "UNLICENSE",
];

/// The text with all notices for a target.
pub(super) fn of(root: &Path, target: &str) -> Result<String, Box<dyn Error>> {
    let options = ["--locked", "--filter-platform", target];
    let metadata = MetadataCommand::new()
        .current_dir(root)
        .other_options(options.map(str::to_owned))
        .exec()?;
    let mut text = "\
This program contains estampe, under LICENSE-MIT or LICENSE-APACHE, the standard library of Rust, under
MIT OR Apache-2.0 (https://www.rust-lang.org/policies/licenses), and these packages of https://crates.io.
"
    .to_owned();
    // A licence that several packages have is written once.
    let mut known = HashMap::new();
    for package in contained(&metadata) {
        let title = format!("{} {}", package.name, package.version);
        let license = package.license.as_deref().unwrap_or("see below");
        write!(text, "\n{}\n{title}: {license}\n", "=".repeat(80))?;
        let licences = licences(package)?;
        if licences.is_empty() {
            let (authors, url) = (package.authors.join(", "), package.repository.as_deref());
            let url = url.unwrap_or("https://crates.io");
            writeln!(text, "\nThe package has no licence file. {url}, {authors}")?;
        }
        for (name, licence) in licences {
            match known.get(&licence) {
                Some(first) => writeln!(text, "\n{name}: the same as {first}.")?,
                None => {
                    write!(text, "\n{name}:\n\n{licence}\n")?;
                    known.insert(licence, format!("{name} of {title}"));
                }
            }
        }
    }
    Ok(text)
}

/// The packages from outside whose code is in the program, by name and version. Build scripts and
/// procedural macros run in the compiler.
fn contained(metadata: &Metadata) -> Vec<&Package> {
    let packages: HashMap<&PackageId, &Package> = metadata
        .packages
        .iter()
        .map(|package| (&package.id, package))
        .collect();
    let nodes = metadata.resolve.iter().flat_map(|resolve| &resolve.nodes);
    let nodes: HashMap<&PackageId, _> = nodes.map(|node| (&node.id, node)).collect();
    let is_start = |package: &&Package| package.name.as_str() == "estampe";
    let start = metadata.packages.iter().find(is_start);
    let mut to_visit: Vec<&PackageId> = start.map(|package| &package.id).into_iter().collect();
    let mut visited: HashSet<&PackageId> = to_visit.iter().copied().collect();
    let mut found = BTreeMap::new();
    while let Some(id) = to_visit.pop() {
        let (Some(package), Some(node)) = (packages.get(id), nodes.get(id)) else {
            continue;
        };
        let mut targets = package.targets.iter();
        if targets.any(|target| target.kind.contains(&TargetKind::ProcMacro)) {
            continue;
        }
        if package.source.is_some() {
            found.insert(
                (package.name.to_string(), package.version.clone()),
                *package,
            );
        }
        for dependency in &node.deps {
            let mut kinds = dependency.dep_kinds.iter();
            if kinds.any(|info| info.kind == DependencyKind::Normal)
                && visited.insert(&dependency.pkg)
            {
                to_visit.push(&dependency.pkg);
            }
        }
    }
    found.into_values().collect()
}

/// The names and texts of the licences in a package, by name.
fn licences(package: &Package) -> Result<BTreeMap<String, String>, Box<dyn Error>> {
    let folder = package.manifest_path.parent().ok_or("no folder")?;
    let folder = folder.as_std_path();
    let mut licences = BTreeMap::new();
    for entry in fs::read_dir(folder).map_err(|error| located(folder, error))? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let in_capitals = name.to_uppercase();
        if path.is_file() && NAMES.iter().any(|start| in_capitals.starts_with(start)) {
            let bytes = fs::read(&path).map_err(|error| located(&path, error))?;
            let text = String::from_utf8_lossy(&bytes).replace("\r\n", "\n");
            licences.insert(name.into_owned(), text.trim_end().to_owned());
        }
    }
    Ok(licences)
}

#[cfg(test)]
mod tests {
    use crate::dist::build::host;
    use xtask::Repository;

    #[test]
    fn notices_are_those_of_the_packages_in_the_program() {
        let repository = Repository::of_this_build().expect("the repository can be read");
        let host = host().expect("cargo names the host");
        let text = super::of(repository.root(), &host).expect("packages can be read");
        // Titles are a name and a version.
        let names = |name: &str| {
            let versions = text.lines().filter_map(|line| line.strip_prefix(name));
            let mut versions = versions.filter_map(|rest| rest.strip_prefix(' '));
            versions.any(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
        };
        assert!(names("clap"), "a library of the command");
        assert!(names("naga"), "a library of a library of the command");
        assert!(!names("serde_derive"), "it runs in the compiler");
        assert!(!names("trybuild"), "tests are not in the program");
        assert!(!names("pulldown-cmark"), "xtask is not in the program");
        assert!(
            text.contains("Permission is hereby granted"),
            "the text of MIT"
        );
    }
}
