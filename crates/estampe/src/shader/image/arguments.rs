//! The options of `estampe shader image` and their help.

use crate::shader::resources::ResourceArgs;
use crate::shader::source::SourceArgs;
use crate::shader::values::{self, MachineArgs};
use crate::values::{Destination, ImageFormatName, size};
use clap::Args;
use std::path::PathBuf;

/// Draws the picture of a fragment shader: WGSL, GLSL or SPIR-V.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  estampe shader image sky.wgsl -o sky.png --size 640x360
  estampe shader image waves.frag -o waves.png --time 2.5 --set tint=1,0.5,0
  estampe shader image toy.glsl -o toy.png --texture iChannel0=noise.png
  estampe shader image plot.spv -o plot.png --buffer 0,0=samples.bin

A triangle that covers the picture is drawn with the fragment shader. An input of it, whatever its name, has the \
components (u, v, 0, 1), as many as its type: u is 0 at the left and 1 at the right edge, v is 0 at the first row \
and 1 at the last one. Inputs that are integers are 0.

The first row, where v and the position's y are 0, is at the top for WGSL and SPIR-V, as in WebGPU and Vulkan, and at \
the bottom for GLSL, as in OpenGL; --origin says otherwise. The first rows of textures are there, too.

Uniforms of these names have values by themselves, in any uniform block, also with the prefixes u, u_ and i as in \
uTime, u_time and iTime: time, globalTime (--time), timeDelta (1/60), frameRate (60), resolution (width, height, 1), \
mouse (zeros). All others are zeros unless --set says their value; a member of a structure or an array has a name as \
in light.color, lights[2].color, weights[3]; an array may be set as a whole. Storage buffers, textures and immediates (push \
constants) must be given. Samplers repeat, and filter linearly between texels and mip levels.

A text of GLSL with mainImage(out vec4, in vec2) and without main is a shader toy: it gets a main, and the uniforms \
of shader toys that it uses need no declaration. Its alpha is 1.

Colours are stored as they are, 8 bits a channel, without sRGB encoding, alpha too.

Exit codes: 0 success, 1 the shader or another input is missing or wrong, 2 wrong usage, 3 the image cannot be \
written.")]
pub(crate) struct ImageArgs {
    /// The shader, or - for standard input
    #[arg(value_name = "FILE")]
    pub(super) file: PathBuf,

    /// The image: a file named .png, .jpg, .tga or .webp, or - for standard output
    #[arg(short, long, value_name = "OUT", allow_hyphen_values = true)]
    #[arg(value_parser = crate::values::destination())]
    pub(super) output: Destination,

    /// The image's format: png, jpeg, tga or webp [default: by OUT's extension; png for -]
    #[arg(long, value_name = "FORMAT", value_enum, hide_possible_values = true)]
    pub(super) output_format: Option<ImageFormatName>,

    /// Width and height in pixels, each 1 to 16384
    #[arg(long, value_name = "WxH", default_value = "640x360", value_parser = size)]
    pub(super) size: (u32, u32),

    /// The fragment shader's entry point [default: the only one]
    #[arg(long, value_name = "NAME")]
    pub(super) entry: Option<String>,

    /// The value of uniforms named time, in seconds
    #[arg(long, value_name = "S", default_value = "0", value_parser = values::seconds)]
    #[arg(allow_hyphen_values = true)]
    pub(super) time: f32,

    /// The first row: top or bottom [default: bottom for GLSL, else top]
    #[arg(long, value_name = "ROW", value_enum, hide_possible_values = true)]
    pub(super) origin: Option<Origin>,

    #[command(flatten)]
    pub(super) source: SourceArgs,

    #[command(flatten)]
    pub(super) resources: ResourceArgs,

    #[command(flatten)]
    pub(super) machine: MachineArgs,

    /// Jumps after which the shader of sixteen fragments is stopped; their colours are undefined
    #[arg(long, value_name = "N", default_value_t = values::FRAGMENT_JUMPS)]
    #[arg(value_parser = clap::value_parser!(u64).range(1..=1 << 40), help_heading = "Machine")]
    pub(super) max_jumps: u64,

    /// Write no summary
    #[arg(short, long, help_heading = "Report")]
    pub(super) quiet: bool,
}

/// The first row of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Origin {
    /// As in WebGPU
    Top,
    /// As in OpenGL
    Bottom,
}
