//! `estampe shader reflect`: what a shader exchanges with the program that runs it.

mod json;
mod text;

use super::source::{ShaderFile, SourceArgs, StageName};
use crate::failure::Failure;
use clap::Args;
use estampe::{Device, DeviceDescriptor, ShaderStage};
use std::path::PathBuf;

/// Describes a shader: entry points, inputs and outputs, bindings, uniforms, constants.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  estampe shader reflect sky.wgsl
  estampe shader reflect model.vert --json | jq '.bindings[].members'

Inputs and outputs are by location; built-in variables are not listed. Sizes and offsets are bytes; an array whose \
length the buffer's size tells counts as one element in the size of its binding.

Exit codes: 0 success, 1 the shader is wrong, or the file cannot be read, 2 wrong usage, 3 the report cannot be \
written.

With --json one object is written: shader, entry_points [{name, stage, workgroup_size (null but for compute), inputs, \
outputs [{name, location, type, flat}]}], bindings [{group, binding, name, kind, type, size (null but for buffers), \
read_only, stages, members [{name, type, offset, array_length (null if it is no array, 0 if the buffer's size tells), \
array_stride, matrix_stride, initial_value}]}], samplers (GLSL's textures with samplers) [{name, texture, sampler [group, binding]}], \
push_constants (immediates) {name, size, members}, constants [{name, id, type, default}]. An error gives {error, exit_code}.")]
pub(crate) struct ReflectArgs {
    /// The shader, or - for standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,

    #[command(flatten)]
    source: SourceArgs,

    /// The stage of GLSL: vertex, fragment or compute [default: by FILE's name, else by its text]
    #[arg(long, value_name = "STAGE", value_enum, hide_possible_values = true)]
    stage: Option<StageName>,

    /// Write one JSON object
    #[arg(long, help_heading = "Report")]
    pub(crate) json: bool,
}

/// Runs the command.
pub(crate) fn run(args: &ReflectArgs) -> Result<(), Failure> {
    let stage = args.stage.map(ShaderStage::from);
    let file = ShaderFile::read(&args.file, stage, &args.source)?.with_main();
    // Nothing is drawn.
    let device = Device::new(&DeviceDescriptor {
        threads: 1,
        ..DeviceDescriptor::default()
    });
    let device = device.map_err(|error| Failure::Output(error.to_string()))?;
    let module = file.module(&device)?;
    let report = if args.json {
        format!("{:#}\n", json::object(&file.name, &module))
    } else {
        text::text(&module)
    };
    crate::output::print(&report)
}
