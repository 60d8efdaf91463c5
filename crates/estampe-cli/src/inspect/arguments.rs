//! The options of `estampe inspect` and their help.

use crate::render::PictureArgs;
use crate::values::{FormatName, Source};
use clap::Args;

/// Explains a pixel: every primitive that touched it, and why it won or lost.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  estampe inspect builtin:teapot --pixel 500,400
  estampe inspect part.stl --pixel 10,20 --size 64x48 --samples 1
  estampe inspect head.obj --pixel 300,200 --texture head_diffuse.tga --json | jq .final_rgba8

The picture is that of `estampe render` with the same options, and the history ends with its pixel, bit for bit. \
Primitives are listed in the order in which they are drawn. Of each: its vertices in object, world, eye, clip, \
normalized device (NDC) and window space; the edge functions (in pixels\u{b2}) and barycentric coordinates of the \
pixel's centre; the interpolated depth and varyings; the shader's colour; and for each sample the test that it \
failed, or that it passed, with the stored values before and after. Faces that are culled are listed too.

Exit codes: 0 success, 1 the model is missing or invalid, 2 wrong usage, 3 the history cannot be written.

With --json one object is written: model, pixel, size, samples, initial [sample], history [{draw, primitive, \
instance, kind, front_facing, culled, clipped, vertices [{index, object, world, eye, clip, ndc, varyings}], \
window [{x, y, depth, inverse_w}], edges, barycentrics, fragments [{sample, covered, position, varyings, colors, \
depth, discarded, kept, samples [{sample, depth, outcome, before, after}]}]}], last [sample], final_rgba8. A sample \
is {colors, depth, stencil}; outcome is passed, depth, stencil or depth-bounds. An error gives {error, exit_code}.")]
pub(crate) struct InspectArgs {
    /// The model: a file, builtin:NAME, or - for standard input
    #[arg(value_name = "MODEL")]
    pub(crate) model: Source,

    /// The pixel: column and row, counted from 0 at the top left
    #[arg(long, value_name = "X,Y", value_parser = pixel, allow_hyphen_values = true)]
    pub(crate) pixel: [u32; 2],

    /// The model's format: obj, stl or ply [default: by extension, else by content]
    #[arg(long, value_name = "FORMAT", value_enum, hide_possible_values = true)]
    pub(crate) format: Option<FormatName>,

    /// Write one JSON object
    #[arg(long)]
    pub(crate) json: bool,

    #[command(flatten)]
    pub(crate) picture: PictureArgs,
}

/// Parses a pixel.
fn pixel(text: &str) -> Result<[u32; 2], String> {
    let (x, y) = text.split_once(',').ok_or("expected X,Y, as in 10,20")?;
    let number = |text: &str| {
        let number = text.trim().parse::<u32>();
        number.map_err(|_| format!("`{text}` is not a column or row: expected X,Y, as in 10,20"))
    };
    Ok([number(x)?, number(y)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_are_two_whole_numbers() {
        assert_eq!(pixel("10, 20"), Ok([10, 20]));
        for wrong in ["", "10", "10,", "-1,2", "1.5,2", "1,2,3", "99999999999,0"] {
            let error = pixel(wrong).expect_err(wrong);
            assert!(error.contains("10,20"), "{error}");
        }
    }
}
