//! The packages of the workspace and those that it is built from, as `cargo metadata` lists them.

use cargo_metadata::{DependencyKind, MetadataCommand};
use std::path::PathBuf;

use crate::Repository;

/// A package and the dependencies that its manifest declares.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Package {
    pub(crate) name: String,
    /// The folder of the manifest; for our packages relative to the repository's root.
    pub(crate) folder: PathBuf,
    /// The licence as an SPDX expression.
    pub(crate) license: Option<String>,
    /// Every declared dependency, those for other targets included.
    pub(crate) dependencies: Vec<Dependency>,
}

/// A declared dependency.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Dependency {
    /// The package's name, also where the manifest renames it.
    pub(crate) package: String,
    /// The name by which sources name the crate: `-` has become `_`.
    pub(crate) crate_name: String,
    /// True if only tests, examples and benchmarks may use the package.
    pub(crate) is_dev: bool,
    pub(crate) features: Vec<String>,
    pub(crate) has_default_features: bool,
}

/// Every package of a build for this machine.
#[derive(Debug, Clone)]
pub(crate) struct Packages {
    /// Ours, by name.
    pub(crate) workspace: Vec<Package>,
    /// The others, by name.
    pub(crate) outside: Vec<Package>,
}

impl Packages {
    /// Asks cargo. Packages for other machines are left out, so that nothing is downloaded which a
    /// build does not need.
    ///
    /// # Errors
    /// The error of cargo if it cannot read a manifest or the lock file is not up to date.
    pub(crate) fn of(repository: &Repository) -> Result<Self, cargo_metadata::Error> {
        let options = ["--locked", "--filter-platform", "host-tuple"];
        let metadata = MetadataCommand::new()
            .current_dir(repository.root())
            .other_options(options.map(str::to_owned))
            .exec()?;
        let members = &metadata.workspace_members;
        let (workspace, outside): (Vec<_>, Vec<_>) = metadata
            .packages
            .iter()
            .partition(|package| members.contains(&package.id));
        let sorted = |mut packages: Vec<Package>| {
            packages.sort_by(|a, b| a.name.cmp(&b.name));
            packages
        };
        let root = metadata.workspace_root.as_std_path();
        let read = |package: &cargo_metadata::Package| Package::new(package, root);
        Ok(Self {
            workspace: sorted(workspace.into_iter().map(read).collect()),
            outside: sorted(outside.into_iter().map(read).collect()),
        })
    }
}

impl Package {
    /// A package that exists only in memory, in the folder where the checks expect it.
    #[cfg(test)]
    pub(crate) fn synthetic(name: &str, dependencies: Vec<Dependency>) -> Self {
        Self {
            name: name.to_owned(),
            folder: std::path::Path::new("crates").join(name),
            license: Some("MIT OR Apache-2.0".to_owned()),
            dependencies,
        }
    }

    fn new(package: &cargo_metadata::Package, root: &std::path::Path) -> Self {
        let folder = package
            .manifest_path
            .parent()
            .map(|folder| folder.as_std_path());
        let folder = folder.unwrap_or(root);
        Self {
            name: package.name.to_string(),
            folder: folder.strip_prefix(root).unwrap_or(folder).to_owned(),
            license: package.license.clone(),
            dependencies: package.dependencies.iter().map(Dependency::new).collect(),
        }
    }
}

impl Dependency {
    /// A dependency of a synthetic package.
    #[cfg(test)]
    pub(crate) fn synthetic(package: &str, is_dev: bool) -> Self {
        Self {
            package: package.to_owned(),
            crate_name: package.replace('-', "_"),
            is_dev,
            features: Vec::new(),
            has_default_features: false,
        }
    }

    fn new(dependency: &cargo_metadata::Dependency) -> Self {
        let name = dependency.rename.as_ref().unwrap_or(&dependency.name);
        Self {
            package: dependency.name.clone(),
            crate_name: name.replace('-', "_"),
            is_dev: dependency.kind == DependencyKind::Development,
            features: dependency.features.clone(),
            has_default_features: dependency.uses_default_features,
        }
    }
}
