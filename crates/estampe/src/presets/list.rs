//! `estampe presets`: lists the presets.

use super::PresetArgs;
use super::file::{Config, DEFAULT};
use crate::failure::Failure;
use crate::output;
use crate::values::shown;
use clap::Args;
use std::fmt::Write;
use std::path::PathBuf;

/// Lists the presets of the configuration file, which commands that draw take by --preset
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  estampe presets
  estampe presets --config looks.toml
  estampe render model.stl -o model.png --preset clay

The configuration file is FILE, else estampe.toml in the working folder, else estampe/config.toml in $XDG_CONFIG_HOME, \
~/.config or, on Windows, %APPDATA%. It is TOML: each table is a preset, each key an option of `estampe render` by its long \
name, as in job files of `estampe batch`. The table [default] always applies. Options of the command line win. \
Paths are from the working folder.

  [default]
  size = \"800x600\"
  [clay]
  color = \"tan\"
  roughness = 0.9
  light = [\"1,2,3\", \"-1,0.5,1:0.4\"]

Exit codes: 0 success, 1 the file is missing, 2 wrong usage, or the file is wrong.")]
pub(crate) struct PresetsArgs {
    /// The configuration file
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
}

/// Runs the command.
pub(crate) fn run(args: &PresetsArgs) -> Result<(), Failure> {
    let found = Config::find(&PresetArgs {
        config: args.config.clone(),
        ..PresetArgs::default()
    })?;
    let Some(config) = found else {
        return output::print(
            "there is no configuration file; `estampe help presets` says where it is\n",
        );
    };
    let mut text = format!("{}\n", shown(&config.path));
    for (name, table) in &config.tables {
        let note = if name == DEFAULT { " (always)" } else { "" };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {name}{note}");
        for (_, words) in table.entries() {
            for word in words {
                let _ = writeln!(text, "    {word}");
            }
        }
    }
    output::print(&text)
}
