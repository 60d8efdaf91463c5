//! Reading Cargo manifests: the dependencies that a crate declares, by kind.

use toml::{Table, Value};

use crate::repository::TextFile;

/// What a dependency is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Linked into the crate.
    Normal,
    /// Linked into its tests, examples and benches.
    Dev,
    /// Linked into its build script.
    Build,
}

/// One declared dependency.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Dependency {
    /// The package's name, also where the manifest renames it.
    pub(crate) package: String,
    /// What it is for.
    pub(crate) kind: Kind,
}

/// A parsed manifest of a package.
#[derive(Debug, Clone)]
pub(crate) struct Manifest {
    /// The package's name.
    pub(crate) name: String,
    /// Every dependency, target-specific ones included.
    pub(crate) dependencies: Vec<Dependency>,
    table: Table,
}

impl Manifest {
    /// Parses the manifest of a package; the message says what is wrong with it.
    pub(crate) fn parse(file: &TextFile) -> Result<Self, String> {
        let table: Table = file.text.parse().map_err(|error| format!("{error}"))?;
        let name = text_at(&table, &["package", "name"])
            .ok_or("the manifest names no package")?
            .to_owned();
        let mut dependencies = Vec::new();
        collect(&table, &mut dependencies);
        for target in table
            .get("target")
            .and_then(Value::as_table)
            .into_iter()
            .flatten()
        {
            if let Some(target) = target.1.as_table() {
                collect(target, &mut dependencies);
            }
        }
        Ok(Self {
            name,
            dependencies,
            table,
        })
    }

    /// Whether the value at `keys` is `true`.
    pub(crate) fn is_true(&self, keys: &[&str]) -> bool {
        value_at(&self.table, keys).and_then(Value::as_bool) == Some(true)
    }
}

/// The value at the end of a chain of tables.
pub(crate) fn value_at<'t>(table: &'t Table, keys: &[&str]) -> Option<&'t Value> {
    let (last, tables) = keys.split_last()?;
    let mut table = table;
    for key in tables {
        table = table.get(*key)?.as_table()?;
    }
    table.get(*last)
}

fn text_at<'t>(table: &'t Table, keys: &[&str]) -> Option<&'t str> {
    value_at(table, keys)?.as_str()
}

fn collect(table: &Table, dependencies: &mut Vec<Dependency>) {
    const KINDS: [(&str, Kind); 3] = [
        ("dependencies", Kind::Normal),
        ("dev-dependencies", Kind::Dev),
        ("build-dependencies", Kind::Build),
    ];
    for (key, kind) in KINDS {
        for (name, value) in table
            .get(key)
            .and_then(Value::as_table)
            .into_iter()
            .flatten()
        {
            let package = value
                .as_table()
                .and_then(|table| text_at(table, &["package"]));
            dependencies.push(Dependency {
                package: package.unwrap_or(name).to_owned(),
                kind,
            });
        }
    }
}
