//! `estampe man`: manual pages. It is hidden, because packages contain the pages:
//! `cargo run -p xtask -- dist` writes them with it.

use crate::failure::Failure;
use crate::values::shown;
use clap::{Args, Command};
use clap_mangen::Man;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Writes a manual page of the command and of each of its subcommands.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Example:
  estampe man --output ~/.local/share/man/man1

Exit codes: 0 success, 2 wrong usage, 3 the pages cannot be written.")]
pub(crate) struct ManArgs {
    /// The folder of the pages, which is created if it does not exist
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
}

/// Runs the command, for this command line.
pub(crate) fn run(args: &ManArgs, command: Command) -> Result<(), Failure> {
    // The pages of subcommands take the place of `estampe help COMMAND`.
    let mut command = command.disable_help_subcommand(true);
    command.build();
    let folder = &args.output;
    let written = fs::create_dir_all(folder).and_then(|()| write(&command, folder));
    written.map_err(|error| {
        Failure::Output(format!(
            "{}: {error}; choose a folder that can be written with --output",
            shown(folder)
        ))
    })
}

/// Writes the page of a command, then those of its subcommands that the help lists.
fn write(command: &Command, folder: &Path) -> io::Result<()> {
    Man::new(command.clone())
        .source(concat!("estampe ", env!("CARGO_PKG_VERSION")))
        .manual("estampe")
        .generate_to(folder)?;
    let subcommands = command.get_subcommands();
    subcommands
        .filter(|subcommand| !subcommand.is_hide_set())
        .try_for_each(|subcommand| write(subcommand, folder))
}
