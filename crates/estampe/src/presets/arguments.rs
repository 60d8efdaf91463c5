//! The options that choose a preset.

use clap::Args;
use std::path::PathBuf;

/// The preset, and the file that has it.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct PresetArgs {
    /// Options of this name in the configuration file; those of the command line win
    #[arg(long, value_name = "NAME", help_heading = "Presets")]
    pub(crate) preset: Option<String>,

    /// The configuration file [default: estampe.toml here, else the user's; see `estampe presets`]
    #[arg(long, value_name = "FILE", help_heading = "Presets")]
    pub(crate) config: Option<PathBuf>,

    /// Read no configuration file
    #[arg(long, conflicts_with_all = ["config", "preset"], help_heading = "Presets")]
    pub(crate) no_config: bool,
}
