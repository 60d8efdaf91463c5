//! `estampe shader check`: parses, validates and lowers a shader.

use super::place::function;
use super::source::{ShaderFile, SourceArgs, StageName, stage_name};
use crate::failure::{DONE, Failure};
use clap::Args;
use estampe::{
    Device, DeviceDescriptor, EntryPointDescriptor, ProgramDescriptor, ShaderErrors, ShaderModule,
    ShaderModuleDescriptor, ShaderModuleError, ShaderSource, ShaderSourceError, ShaderStage,
};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// The exit code of a shader with errors.
const WRONG: u8 = 1;

/// Checks a shader: WGSL, GLSL or SPIR-V.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  estampe shader check sky.wgsl
  estampe shader check water.frag -D WAVES=4 --json
  estampe shader check noise.glsl --stage compute
  estampe shader check --vertex model.vert --fragment model.frag

The shader is right if it can be run: it is parsed, validated, and every entry point is compiled as far as no \
processor matters. With --vertex and --fragment, what one stage writes and the other reads must fit, too.

The language is that of the name: .wgsl; .spv; .vert, .frag and .comp (also .vs, .fs, .cs), and .glsl, whose stage \
is in the name as in sky.frag.glsl, or is that of the built-in variables that it uses.

Errors are written to standard error, each with its line and a caret below the place. Constants of WGSL without a \
default are 1 unless -D says another value.

Exit codes: 0 right, 1 wrong, or the file cannot be read, 2 wrong usage, 3 the output cannot be written.

With --json one object is written to standard output: ok (a boolean), errors [{line, column, length, message, help, \
file}]; line and column count from 1 and are 0 if an error has no place in the text, help may be null. A file that \
cannot be read gives {error, exit_code}.")]
pub(crate) struct CheckArgs {
    /// The shader, or - for standard input
    #[arg(value_name = "FILE", required_unless_present_any = ["vertex", "fragment"])]
    #[arg(conflicts_with_all = ["vertex", "fragment"])]
    file: Option<PathBuf>,

    /// The vertex shader of a program in GLSL
    #[arg(long, value_name = "FILE", requires = "fragment")]
    vertex: Option<PathBuf>,

    /// The fragment shader of a program in GLSL
    #[arg(long, value_name = "FILE", requires = "vertex")]
    fragment: Option<PathBuf>,

    #[command(flatten)]
    source: SourceArgs,

    /// The stage of GLSL: vertex, fragment or compute [default: by FILE's name, else by its text]
    #[arg(long, value_name = "STAGE", value_enum, hide_possible_values = true)]
    #[arg(conflicts_with_all = ["vertex", "fragment"])]
    stage: Option<StageName>,

    /// Write the errors as one JSON object
    #[arg(long, help_heading = "Report")]
    pub(crate) json: bool,

    /// Write nothing but errors
    #[arg(short, long, help_heading = "Report")]
    quiet: bool,
}

/// Runs the command. Returns the exit code.
pub(crate) fn run(args: &CheckArgs) -> Result<u8, Failure> {
    // Nothing is drawn.
    let device = Device::new(&DeviceDescriptor {
        threads: 1,
        ..DeviceDescriptor::default()
    });
    let device = device.map_err(|error| Failure::Output(error.to_string()))?;
    let (checked, subject) = match (&args.vertex, &args.fragment) {
        (Some(vertex), Some(fragment)) => {
            let files = [
                glsl(vertex, ShaderStage::Vertex, args)?,
                glsl(fragment, ShaderStage::Fragment, args)?,
            ];
            let subject = format!("{}, {}", files[0].name, files[1].name);
            (check_pair(&device, &files), subject)
        }
        _ => {
            let path = args.file.as_deref().unwrap_or(Path::new("-"));
            let stage = args.stage.map(ShaderStage::from);
            let file = ShaderFile::read(path, stage, &args.source)?.with_main();
            let checked = match file.load(&device) {
                Ok(module) => check_entry_points(&module, &file)?,
                Err(errors) => Err(errors),
            };
            (checked, file.name)
        }
    };
    report(args, &subject, &checked)
}

/// A shader of a program in GLSL.
fn glsl(path: &Path, stage: ShaderStage, args: &CheckArgs) -> Result<ShaderFile, Failure> {
    let file = ShaderFile::read(path, None, &args.source)?;
    if !file.is_glsl() {
        let name = &file.name;
        return Err(Failure::Usage(format!(
            "{name}: --vertex and --fragment take GLSL; give other languages as FILE"
        )));
    }
    Ok(file.with_stage(stage))
}

/// The module if it is right.
type Checked = Result<ShaderModule, ShaderErrors>;

fn check_entry_points(module: &ShaderModule, file: &ShaderFile) -> Result<Checked, Failure> {
    let constants = file.constants(module.reflections())?;
    let found = module.check_entry_points(&constants);
    Ok(right_unless(module, found, |error| placed(file, error)))
}

/// Checks both stages, and that they fit each other.
fn check_pair(device: &Device, files: &[ShaderFile; 2]) -> Checked {
    let [vertex, fragment] = files.each_ref().map(|file| file.text().unwrap_or_default());
    let loaded = device.create_shader_module(&ShaderModuleDescriptor {
        defines: &files[0].macros(),
        ..ShaderModuleDescriptor::new(ShaderSource::Glsl { vertex, fragment })
    });
    let module = loaded.map_err(|mut errors| {
        for error in &mut errors.errors {
            let is_vertex = error.file.as_deref() == Some("vertex shader");
            let file = &files[usize::from(!is_vertex)];
            error.file = Some(file.name.clone());
        }
        errors
    })?;
    let mut found = module.check_entry_points(&[]);
    if found.is_empty() {
        let descriptor = ProgramDescriptor {
            vertex: EntryPointDescriptor::new(&module),
            fragment: Some(EntryPointDescriptor::new(&module)),
        };
        found.extend(device.create_program(&descriptor).err());
    }
    right_unless(&module, found, |error| {
        plain(&files[1].name, error.to_string())
    })
}

fn right_unless(
    module: &ShaderModule,
    found: Vec<ShaderModuleError>,
    place: impl Fn(&ShaderModuleError) -> ShaderSourceError,
) -> Checked {
    if found.is_empty() {
        return Ok(module.clone());
    }
    let mut errors = Vec::new();
    for error in found {
        match error {
            ShaderModuleError::Source(source) => errors.extend(source.errors),
            error => errors.push(place(&error)),
        }
    }
    Err(ShaderErrors { errors })
}

/// An error without a place.
fn plain(file: &str, message: String) -> ShaderSourceError {
    ShaderSourceError {
        file: Some(file.to_owned()),
        message,
        ..ShaderSourceError::default()
    }
}

/// An error of an entry point, at the function in the text.
fn placed(file: &ShaderFile, error: &ShaderModuleError) -> ShaderSourceError {
    let unplaced = plain(&file.name, error.to_string());
    let (ShaderModuleError::Lower { name, .. }, Some(text)) = (error, file.text()) else {
        return unplaced;
    };
    let keyword = if file.is_glsl() { "void" } else { "fn" };
    let Some((line, column)) = function(text, keyword, name) else {
        return unplaced;
    };
    let count = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
    let line_text = text.lines().nth(line).unwrap_or_default();
    ShaderSourceError {
        line: count(line + 1),
        column: count(column + 1),
        length: count(name.chars().count()),
        line_text: line_text.to_owned(),
        ..unplaced
    }
}

fn report(args: &CheckArgs, subject: &str, checked: &Checked) -> Result<u8, Failure> {
    let errors = checked.as_ref().err();
    if args.json {
        let object = errors.cloned().unwrap_or_default().to_json();
        crate::output::print(&format!("{object}\n"))?;
    } else if let Some(errors) = errors {
        // If standard error is closed, only the exit code tells.
        let _ = writeln!(io::stderr(), "{errors}");
    } else if let (false, Ok(module)) = (args.quiet, checked) {
        let entries = module.entry_points();
        let entries = entries.map(|entry| format!("{} `{}`", stage_name(entry.stage), entry.name));
        let mut entries: Vec<String> = entries.collect();
        if entries.is_empty() {
            entries.push("no entry points".to_owned());
        }
        let _ = writeln!(io::stderr(), "{subject}: right: {}", entries.join(", "));
    }
    Ok(if errors.is_some() { WRONG } else { DONE })
}
