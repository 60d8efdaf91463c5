//! Presets: named tables of options in a configuration file.
//!
//! ```text
//! [default]            # always
//! size = "640x480"
//! [clay]               # with --preset clay
//! color = "tan"
//! roughness = 0.9
//! ```
//!
//! The options of a preset become words of the command line before it is parsed, so that every
//! command that draws has them. Options of the command line replace those of the preset that have
//! the same name, or exclude them.

mod arguments;
mod file;
mod list;
mod words;

pub(crate) use arguments::PresetArgs;
pub(crate) use list::{PresetsArgs, run};
pub(crate) use words::with_presets;

use crate::batch::OptionTable;
use crate::failure::Failure;

/// The options of the default table and of the chosen preset, for commands that merge them
/// themselves.
pub(crate) fn table(args: &PresetArgs) -> Result<OptionTable, Failure> {
    match file::Config::find(args)? {
        Some(config) => config.table(args.preset.as_deref()),
        None => Ok(OptionTable::default()),
    }
}
