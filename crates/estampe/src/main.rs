#![forbid(unsafe_code)]
//! The `estampe` command.
//!
//! * [`render`]: renders a model to an image;
//! * [`batch`]: renders many models;
//! * [`sheet`]: draws many models, or the views of one, as cells of one picture;
//! * [`schema`]: prints the schemas of files;
//! * [`turntable`]: animates a model that turns;
//! * [`shape`]: meshes a function, as a model or an image;
//! * [`inspect`]: explains a pixel of the image;
//! * [`describe`]: describes the contents of a model;
//! * [`diff`]: measures the difference of two images;
//! * [`depth`]: measures the precision of depth buffers;
//! * [`shader`]: checks and draws shaders as text;
//! * [`compute`]: runs a compute shader;
//! * [`presets`]: lists presets of options, which commands that draw have;
//! * [`ladder`]: draws the pictures of the ladder, from one pixel to shapes;
//! * [`completions`]: prints scripts by which a shell completes the command's words;
//! * [`man`]: writes manual pages, hidden from the help.
//!
//! [`advice`] explains unknown words, [`choice`] has the options of files with several scenes,
//! [`input`] reads models from files, standard input or by built-in name, [`output`] writes files
//! completely or not at all, [`preview`] shows pictures in a terminal, [`interrupt`] removes
//! temporary files, [`colors`] parses colours, [`terminal`] escapes names, [`values`] parses the
//! options' values, and [`failure`] has the exit codes.

mod advice;
mod batch;
mod choice;
mod colors;
mod completions;
mod compute;
mod depth;
mod describe;
mod diff;
mod failure;
mod input;
mod inspect;
mod interrupt;
mod ladder;
mod limits;
mod man;
mod output;
mod presets;
mod preview;
mod progress;
mod render;
mod schema;
mod shader;
mod shape;
mod sheet;
mod terminal;
mod turntable;
mod values;

use std::ffi::OsString;
use std::io::{self, BufWriter, Write};
use std::process::ExitCode;
use std::sync::LazyLock;

use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand};
use failure::Failure;

/// Renders 3D models and functions to images, on any machine: no GPU, no display, no system
/// libraries. The same command gives the same bytes everywhere.
#[derive(Debug, Parser)]
#[command(name = "estampe", version = version(), arg_required_else_help = true)]
#[command(after_help = "\
Examples:
  estampe render model.obj -o model.png
  estampe render builtin:teapot -o teapot.png --view iso --shading toon
  estampe batch 'models/*.glb' -o 'thumbnails/{stem}.png' --size 256x256
  estampe sheet 'models/*.glb' -o sheet.png
  estampe turntable builtin:teapot -o teapot.gif
  estampe shape --explicit 'sin(x) + cos(y)' -o waves.png
  estampe inspect builtin:teapot --pixel 500,400
  estampe info model.stl
  estampe depth --near 0.1 --far 1000 --format d24
  estampe diff expected.png actual.png
  estampe shader check sky.wgsl
  estampe shader image sky.wgsl -o sky.png
  estampe compute squares.wgsl --groups 4 --buffer 0,0=zeros:1024 --write 0,0=squares.bin
  estampe ladder all -o ladder
  estampe presets
  estampe completions fish > ~/.config/fish/completions/estampe.fish

`estampe help COMMAND` explains all options of a command.")]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    // Boxed, because it has many options.
    Render(Box<render::RenderArgs>),
    // Boxed, because it has the options of a picture.
    Batch(Box<batch::BatchArgs>),
    // Boxed, because it has the options of a picture.
    Sheet(Box<sheet::SheetArgs>),
    // Boxed, because it has the options of a picture.
    Turntable(Box<turntable::TurntableArgs>),
    Schema(schema::SchemaArgs),
    Shape(Box<shape::ShapeArgs>),
    Info(describe::InfoArgs),
    // Boxed, because it has the options of a picture.
    Inspect(Box<inspect::InspectArgs>),
    Diff(diff::DiffArgs),
    Depth(depth::DepthArgs),
    Shader(shader::ShaderArgs),
    // Boxed, because it has many options.
    Compute(Box<compute::ComputeArgs>),
    Ladder(ladder::LadderArgs),
    Presets(presets::PresetsArgs),
    Completions(completions::CompletionsArgs),
    #[command(hide = true)]
    Man(man::ManArgs),
}

/// The versions of the program and of its images.
fn version() -> &'static str {
    static VERSION: LazyLock<String> = LazyLock::new(|| {
        let pictures = estampe_renderer::PICTURE_VERSION;
        format!("{} (picture version {pictures})", env!("CARGO_PKG_VERSION"))
    });
    &VERSION
}

/// The command line. Mistakes, and requests for help, end the process.
fn parsed(command: clap::Command, words: impl IntoIterator<Item = OsString>) -> Cli {
    let matches = command.try_get_matches_from(words);
    let parsed = matches.and_then(|matches| Cli::from_arg_matches(&matches));
    parsed.unwrap_or_else(|error| advice::advised(error).exit())
}

/// The parser. Every option with a value takes negative numbers, so that its own parser can say
/// what is wrong with them. For `render`, which draws small pictures in some milliseconds, it is
/// that of this command alone: the options of all commands take a millisecond to make.
fn command(name: Option<&str>) -> clap::Command {
    fn with_negative_numbers(command: clap::Command) -> clap::Command {
        let command = command.mut_args(|arg| {
            let is_option = !arg.is_positional() && arg.get_action().takes_values();
            if is_option && !arg.is_allow_hyphen_values_set() {
                arg.allow_negative_numbers(true)
            } else {
                arg
            }
        });
        command.mut_subcommands(with_negative_numbers)
    }
    with_negative_numbers(match name {
        Some("render") => {
            let render = render::RenderArgs::augment_args(clap::Command::new("render"));
            let parent = clap::Command::new("estampe").version(version());
            parent.subcommand(render)
        }
        _ => Cli::command(),
    })
}

fn main() -> ExitCode {
    let words: Vec<OsString> = std::env::args_os().collect();
    let name = words.get(1).map(|name| name.to_string_lossy().into_owned());
    let command = command(name.as_deref());
    let words = match presets::with_presets(&command, words) {
        Ok(words) => words,
        Err(failure) => {
            let code = report(&name.unwrap_or_default(), None, Err(failure));
            return ExitCode::from(code);
        }
    };
    let cli = parsed(command, words);
    let code = match &cli.command {
        Command::Render(args) => report(
            "render",
            args.report.json.then_some(args.is_to_standard_output()),
            render::run(args),
        ),
        Command::Batch(args) => match batch::run(args) {
            Ok(code) => code,
            Err(failure) => report("batch", None, Err(failure)),
        },
        Command::Sheet(args) => match sheet::run(args) {
            Ok(code) => code,
            Err(failure) => report(
                "sheet",
                args.report.json.then_some(args.output.is_standard_output()),
                Err(failure),
            ),
        },
        Command::Turntable(args) => report(
            "turntable",
            args.report.json.then_some(args.output.is_standard_output()),
            turntable::run(args),
        ),
        Command::Schema(args) => report("schema", None, schema::run(args)),
        Command::Shape(args) => report(
            "shape",
            args.report.json.then_some(args.output.is_standard_output()),
            shape::run(args),
        ),
        Command::Inspect(args) => {
            let to = &args.output;
            let on_standard_output = to
                .as_ref()
                .is_some_and(values::Destination::is_standard_output);
            report(
                "inspect",
                args.json.then_some(on_standard_output),
                inspect::run(args),
            )
        }
        Command::Info(args) => report("info", args.json.then_some(false), describe::run(args)),
        Command::Depth(args) => {
            let to = &args.output;
            let on_standard_output = to
                .as_ref()
                .is_some_and(values::Destination::is_standard_output);
            report(
                "depth",
                args.json.then_some(on_standard_output),
                depth::run(args),
            )
        }
        Command::Shader(args) => match shader::run(args) {
            Ok(code) => code,
            Err(failure) => report(args.name(), args.json(), Err(failure)),
        },
        Command::Compute(args) => report("compute", None, compute::run(args)),
        Command::Presets(args) => report("presets", None, presets::run(args)),
        Command::Ladder(args) => report("ladder", None, ladder::run(args)),
        Command::Completions(args) => {
            report("completions", None, completions::run(args, &Cli::command()))
        }
        Command::Man(args) => report("man", None, man::run(args, Cli::command())),
        Command::Diff(args) => {
            let (mut out, mut err) = (BufWriter::new(io::stdout().lock()), io::stderr().lock());
            diff::run(args, &mut out, &mut err)
        }
    };
    ExitCode::from(code)
}

/// Reports the error of a command, if any, and returns its exit code. `json` is set if a JSON
/// object is wanted too; it is true if the object goes to standard error.
fn report(command: &str, json: Option<bool>, result: Result<(), Failure>) -> u8 {
    let Err(failure) = result else {
        return failure::DONE;
    };
    let code = failure.exit_code();
    // If these streams are closed, only the exit code reports the error.
    if let Some(to_standard_error) = json {
        let object = serde_json::json!({ "error": failure.to_string(), "exit_code": code });
        let _ = if to_standard_error {
            writeln!(io::stderr(), "{object}")
        } else {
            writeln!(io::stdout(), "{object}")
        };
    }
    let message = failure.to_string();
    let _ = writeln!(
        io::stderr(),
        "estampe {command}: {}",
        terminal::lines(&message)
    );
    code
}

#[cfg(test)]
mod tests {
    use super::command;

    #[test]
    fn render_alone_is_parsed_as_among_all_commands() {
        let mut alone = command(Some("render"));
        let mut all = command(None);
        for command in [&mut alone, &mut all] {
            command.build();
        }
        let help = |command: &mut clap::Command| {
            let render = command.find_subcommand_mut("render");
            render.map(|render| render.render_long_help().to_string())
        };
        assert!(help(&mut alone).is_some());
        assert_eq!(help(&mut alone), help(&mut all));
        for words in [
            "estampe render",
            "estampe render --help",
            "estampe render -h",
            "estampe render --version",
            "estampe render a.obj --sice 3x3",
            "estampe render a.obj --size 3",
            "estampe render a.obj b.obj",
            "estampe render a.obj -o a.png --azimuth -30 --margin -1",
            "estampe render a.obj --view iso --azimuth 3",
        ] {
            let error = |command: &clap::Command| {
                let matches = command.clone().try_get_matches_from(words.split(' '));
                matches.err().map(|error| error.to_string())
            };
            assert_eq!(error(&alone), error(&all), "{words}");
        }
    }
}
