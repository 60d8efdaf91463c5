//! The options of `estampe compute` and their help.

use crate::shader::resources::ResourceArgs;
use crate::shader::source::SourceArgs;
use crate::shader::values::{self, MachineArgs, Slot};
use crate::values::Destination;
use clap::Args;
use std::path::PathBuf;

/// Runs a compute shader: WGSL, GLSL or SPIR-V.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  estampe compute squares.wgsl --groups 4 --buffer 0,0=zeros:1024 --write 0,0=squares.bin
  estampe compute blur.comp --groups 40,30 --buffer 0,0=in.bin --buffer 0,1=zeros:4915200 --write 0,1=out.bin
  estampe compute scale.wgsl --groups 16 --buffer 0,0=in.bin --immediates hex:0000003f --write 0,0=half.bin
  estampe compute steps.wgsl --entry count --groups 8,8,2 -D width=64 --set scale=0.5 --buffer 0,0=zeros:4096

Buffers are bytes: 32-bit words are little-endian, as on all machines on which estampe runs. Each storage buffer that \
the entry point uses must be given; uniform blocks are zeros, but for the uniforms that --set names. Immediates (push \
constants) that it reads must be given, too. --write writes \
the bytes of a buffer as they are after all work-groups have run. Textures are sampled as `estampe shader image` has \
them; their first row is the file's.

The results are the same for any number of threads: work-groups whose order could be seen run in order.

Exit codes: 0 success, 1 the shader or another input is missing or wrong, or the shader was stopped because it does \
not end, 2 wrong usage, 3 a file cannot be written.")]
pub(crate) struct ComputeArgs {
    /// The shader, or - for standard input
    #[arg(value_name = "FILE")]
    pub(super) file: PathBuf,

    /// The entry point [default: the only compute shader]
    #[arg(long, value_name = "NAME")]
    pub(super) entry: Option<String>,

    /// The number of work-groups along x, y and z
    #[arg(long, value_name = "X[,Y[,Z]]", value_parser = values::groups)]
    pub(super) groups: [u32; 3],

    /// A buffer to write afterwards, by group and binding, to a file or - ; repeatable
    #[arg(long, value_name = "G,B=OUT", value_parser = values::written)]
    pub(super) write: Vec<(Slot, Destination)>,

    #[command(flatten)]
    pub(super) source: SourceArgs,

    #[command(flatten)]
    pub(super) resources: ResourceArgs,

    #[command(flatten)]
    pub(super) machine: MachineArgs,

    /// Write no summary
    #[arg(short, long, help_heading = "Report")]
    pub(super) quiet: bool,
}
