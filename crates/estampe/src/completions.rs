//! `estampe completions`: scripts by which a shell completes the command's words.

use crate::failure::Failure;
use crate::output;
use clap::{Args, Command};
use clap_complete::Shell;

/// Prints a script by which a shell completes subcommands and options.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Where each shell looks for the script:
  bash        mkdir -p ~/.local/share/bash-completion/completions
              estampe completions bash > ~/.local/share/bash-completion/completions/estampe
              This needs the package bash-completion; without it:
              echo 'source <(estampe completions bash)' >> ~/.bashrc
  zsh         mkdir -p ~/.zfunc
              estampe completions zsh > ~/.zfunc/_estampe
              and in ~/.zshrc, before compinit: fpath+=~/.zfunc
  fish        mkdir -p ~/.config/fish/completions
              estampe completions fish > ~/.config/fish/completions/estampe.fish
  powershell  in the file that $PROFILE names:
              estampe completions powershell | Out-String | Invoke-Expression
  elvish      in ~/.config/elvish/rc.elv:
              eval (estampe completions elvish | slurp)

The next shell that is started completes the command.

Exit codes: 0 success, 2 wrong usage, 3 the script cannot be written.")]
pub(crate) struct CompletionsArgs {
    /// The shell: bash, zsh, fish, powershell or elvish
    #[arg(value_name = "SHELL", value_enum, hide_possible_values = true)]
    shell: Shell,
}

/// Runs the command, for this command line.
pub(crate) fn run(args: &CompletionsArgs, command: &Command) -> Result<(), Failure> {
    // In memory first: the generator panics if a pipe is closed.
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut shown(command), "estampe", &mut script);
    output::print(&String::from_utf8_lossy(&script))
}

/// The command line without its hidden subcommands, which the generator would list.
fn shown(command: &Command) -> Command {
    let subcommands = command.get_subcommands();
    let subcommands = subcommands.filter(|subcommand| !subcommand.is_hide_set());
    Command::new("estampe")
        .version(env!("CARGO_PKG_VERSION"))
        .subcommands(subcommands.cloned())
}
