//! `estampe shader dump`: what the compiler makes of a shader.

use super::source::{ShaderFile, SourceArgs, stage_name};
use super::values::{Via, via};
use crate::failure::Failure;
use clap::Args;
use estampe::ShaderErrors;
use estampe_ir::interpreter;
use estampe_ir::lanes::Kernel;
use estampe_shader::front::{EntryPoint, Module};
use estampe_shader::lower::lower;
use estampe_x86::{Code, Isa, Tier};
use std::path::PathBuf;

/// Writes what the compiler makes of a shader: lane IR, bytecode or machine code.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  estampe shader dump sky.wgsl --stage ir
  estampe shader dump model.vert --stage bytecode
  estampe shader dump sky.wgsl --stage asm --via avx2
  estampe shader dump sky.wgsl --stage asm --optimised

The stages of an entry point, in the order in which they are made:

  tree      structured SSA as one invocation sees it: calls inlined, vectors taken apart into words
  ir        SSA for many lanes: a flow graph in which masks are values
  bytecode  what the interpreter runs
  asm       machine code of AVX2 or AVX-512: the address, the bytes, the instruction

In the text of the IR, v is a word, m is a mask, and a u before it says that it is the same in all lanes. Machine code \
is made at once, and again with more care for a shader that runs often: --optimised writes the latter.

Exit codes: 0 success, 1 the shader is wrong, cannot be compiled, or the file cannot be read, 2 wrong usage, 3 the \
text cannot be written.")]
pub(crate) struct DumpArgs {
    /// The shader, or - for standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,

    /// What is written: tree, ir, bytecode or asm
    #[arg(long, value_name = "STAGE", value_enum, hide_possible_values = true)]
    stage: CompilerStage,

    /// The entry point [default: the only one]
    #[arg(long, value_name = "NAME")]
    entry: Option<String>,

    #[command(flatten)]
    source: SourceArgs,

    /// The instruction set of asm: auto, avx2 or avx512
    #[arg(long, value_name = "MACHINE", default_value = "auto", value_parser = via)]
    via: Via,

    /// Write the machine code of shaders that run often
    #[arg(long)]
    optimised: bool,
}

/// What the compiler makes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum CompilerStage {
    /// One invocation's view
    Tree,
    /// Many lanes' view
    Ir,
    /// For the interpreter
    Bytecode,
    /// Machine code
    Asm,
}

/// Runs the command.
pub(crate) fn run(args: &DumpArgs) -> Result<(), Failure> {
    let file = ShaderFile::read(&args.file, None, &args.source)?.with_main();
    if args.optimised && args.stage != CompilerStage::Asm {
        return Err(Failure::Usage(
            "--optimised is for --stage asm; omit it".to_owned(),
        ));
    }
    let text = text(args, &file)?;
    crate::output::print(&text)
}

fn text(args: &DumpArgs, file: &ShaderFile) -> Result<String, Failure> {
    let wrong = |errors: ShaderErrors| Failure::Input(errors.to_string());
    let module = file.front().map_err(wrong)?;
    let constants = file.constants([&module.reflection])?;
    let constants = constants
        .iter()
        .map(|(name, value)| ((*name).to_owned(), *value));
    let constants: Vec<(String, f64)> = constants.collect();
    let entry = entry_point(args, file, &module)?;
    let special = module.specialize(Some((entry.stage, &entry.name)), &constants);
    let special = special.map_err(wrong)?;
    let is_entry = |one: &EntryPoint| one.stage == entry.stage && one.name == entry.name;
    let number = special.entry_points.iter().position(is_entry);
    let lowered = lower(&special.module, &special.info, number.unwrap_or(usize::MAX));
    let refused = |error: &dyn std::fmt::Display| {
        Failure::Input(format!(
            "{}: entry point `{}`: {error}",
            file.name, entry.name
        ))
    };
    let tree = lowered.map_err(|error| refused(&error))?.tree;
    let kernel = || Kernel::from_tree(&tree);
    Ok(match args.stage {
        CompilerStage::Tree => tree.to_string(),
        CompilerStage::Ir => kernel().to_string(),
        CompilerStage::Bytecode => interpreter::Code::new(&kernel()).to_string(),
        CompilerStage::Asm => {
            let level = args.via.level_name();
            let isa = level.and_then(|name| Isa::ALL.into_iter().find(|isa| isa.name() == name));
            let isa = isa.ok_or_else(|| {
                Failure::Usage(
                    "machine code is made for avx2 and avx512 alone: choose one by --via, on a \
                     processor that has it"
                        .to_owned(),
                )
            })?;
            let tier = if args.optimised {
                Tier::Optimised
            } else {
                Tier::Fast
            };
            let listing = Code::listing(&kernel(), isa, tier);
            listing.map_err(|error| refused(&error))?
        }
    })
}

/// The entry point of the options, or the only one.
fn entry_point<'a>(
    args: &DumpArgs,
    file: &ShaderFile,
    module: &'a Module,
) -> Result<&'a EntryPoint, Failure> {
    let entries = &module.entry_points;
    let shown = |entry: &EntryPoint| format!("{} `{}`", stage_name(entry.stage), entry.name);
    let names: Vec<String> = entries.iter().map(shown).collect();
    let (file, names) = (&file.name, names.join(", "));
    match (&args.entry, &entries[..]) {
        (_, []) => Err(Failure::Input(format!("{file}: there is no entry point"))),
        (None, [one]) => Ok(one),
        (None, _) => Err(Failure::Usage(format!(
            "{file}: which entry point is meant? There are {names}: name one by --entry"
        ))),
        (Some(name), _) => {
            let found = entries.iter().find(|entry| entry.name == *name);
            found.ok_or_else(|| {
                Failure::Usage(format!(
                    "--entry {name}: {file} has no such entry point; there are {names}"
                ))
            })
        }
    }
}
