//! The configuration file: where it is, and its tables.

use super::PresetArgs;
use crate::batch::OptionTable;
use crate::failure::Failure;
use crate::input::read_file;
use crate::values::shown;
use estampe_assets::Limits;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The table that always applies.
pub(super) const DEFAULT: &str = "default";

/// The file of a working folder.
const LOCAL: &str = "estampe.toml";

/// The greatest configuration file, in bytes.
const MOST_BYTES: u64 = 1 << 20;

/// A configuration file that was read.
#[derive(Debug)]
pub(super) struct Config {
    pub(super) path: PathBuf,
    pub(super) tables: BTreeMap<String, OptionTable>,
}

impl Config {
    /// The file of the options, else that of the working folder, else the user's; `None` if there
    /// is none and no preset is wanted.
    pub(super) fn find(args: &PresetArgs) -> Result<Option<Self>, Failure> {
        if args.no_config {
            return Ok(None);
        }
        if let Some(path) = &args.config {
            return Self::read(path).map(Some);
        }
        let places: Vec<PathBuf> = [Some(PathBuf::from(LOCAL)), of_user()]
            .into_iter()
            .flatten()
            .collect();
        if let Some(path) = places.iter().find(|path| path.is_file()) {
            return Self::read(path).map(Some);
        }
        match &args.preset {
            None => Ok(None),
            Some(name) => {
                let places: Vec<String> = places.iter().map(|path| shown(path)).collect();
                Err(Failure::Usage(format!(
                    "--preset {name}: there is no configuration file ({}); write one, or name it by \
                     --config",
                    places.join(", ")
                )))
            }
        }
    }

    fn read(path: &Path) -> Result<Self, Failure> {
        let name = shown(path);
        let limits = Limits {
            max_file_bytes: MOST_BYTES,
            ..Limits::default()
        };
        let bytes = read_file(path, &limits)?;
        let text = std::str::from_utf8(&bytes)
            .map_err(|error| Failure::Usage(format!("{name}: {error}; write it as UTF-8")))?;
        let tables = toml::from_str(text).map_err(|error| {
            let start = error.span().map_or(0, |span| span.start);
            let before = text.as_bytes().get(..start).unwrap_or_default();
            let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
            Failure::Usage(format!("{name}:{line}: {}", error.message()))
        })?;
        Ok(Self {
            path: path.to_owned(),
            tables,
        })
    }

    /// The options of the default table, and of a preset, which replace them.
    pub(super) fn table(&self, preset: Option<&str>) -> Result<OptionTable, Failure> {
        let default = self.tables.get(DEFAULT).cloned().unwrap_or_default();
        let Some(name) = preset else {
            return Ok(default);
        };
        if let Some(table) = self.tables.get(name) {
            return Ok(default.overridden_by(table));
        }
        let names: Vec<&str> = { self.tables.keys() }.map(String::as_str).collect();
        let file = shown(&self.path);
        let has = if names.is_empty() {
            format!("{file} has no presets")
        } else {
            format!("{file} has {}", names.join(", "))
        };
        Err(Failure::Usage(format!(
            "--preset {name}: there is no such preset; {has}"
        )))
    }
}

/// The user's configuration file.
fn of_user() -> Option<PathBuf> {
    let folder = |name: &str| {
        let path = std::env::var_os(name).map(PathBuf::from);
        path.filter(|path| path.is_absolute())
    };
    let base = if cfg!(windows) {
        folder("APPDATA")
    } else {
        folder("XDG_CONFIG_HOME").or_else(|| Some(folder("HOME")?.join(".config")))
    };
    Some(base?.join("estampe").join("config.toml"))
}
