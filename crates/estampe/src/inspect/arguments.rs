//! The options of `estampe inspect` and their help.

use super::stages::StageName;
use crate::choice::ChoiceArgs;
use crate::render::PictureArgs;
use crate::values::{Destination, FormatName, Source};
use clap::Args;

/// Explains a pixel, or draws what a stage of the pipeline made of the whole picture.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  estampe inspect builtin:teapot --pixel 500,400
  estampe inspect part.stl --pixel 10,20 --size 64x48 --samples 1
  estampe inspect head.obj --pixel 300,200 --texture head_diffuse.tga --json | jq .final_rgba8
  estampe inspect builtin:teapot --stage bin -o bins.png
  estampe inspect part.stl --stage all -o stages --size 400x300 --samples 1

Pixels: the picture is that of `estampe render` with the same options, and the history ends with its pixel, bit for bit. \
Primitives are listed in the order in which they are drawn. Of each: its vertices in object, world, eye, clip, \
normalized device (NDC) and window space; the edge functions (in pixels\u{b2}) and barycentric coordinates of the \
pixel's centre; the interpolated depth and varyings; the shader's colour; and for each sample the test that it \
failed, or that it passed, with the stored values before and after. Faces that are culled are listed too.

Stages: vertex draws all vertices in object, world, eye, clip, normalized device and window space; clip the primitives \
that are inside, clipped and dropped, with the edges and vertices that clipping made; bin the tiles, with the number \
of pieces in each; raster the barycentric coordinates of the visible piece as red, green and blue; fragment how often \
the fragment shader ran at each pixel; depth the stored depths, and the share of triangles that hierarchical z \
rejects in each block of 16x16 pixels; blend how many colours were stored to each pixel. A line with totals is written \
to standard output, or to standard error with -o -. Tiles and blocks are those of the fast pipeline's rules.

Exit codes: 0 success, 1 the model is missing or invalid, 2 wrong usage, 3 the history or picture cannot be written.

With --stage and --json one object is written: model, size, samples, stages [{stage, output {path, width, height, \
bytes}, totals}]. With --pixel and --json one object is written: model, pixel, size, samples, initial [sample], history [{draw, primitive, \
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
    #[arg(required_unless_present = "stage", conflicts_with = "stage")]
    pub(crate) pixel: Option<[u32; 2]>,

    /// The stage: vertex, clip, bin, raster, fragment, depth, blend, or all
    #[arg(long, value_name = "STAGE", value_enum, hide_possible_values = true)]
    #[arg(requires = "output")]
    pub(crate) stage: Option<StageName>,

    /// The picture: a file (.png, .jpg, .tga, .webp), or - for standard output; for all a folder
    #[arg(
        short,
        long,
        value_name = "OUT",
        requires = "stage",
        conflicts_with = "pixel"
    )]
    pub(crate) output: Option<Destination>,

    /// The model's format: gltf, obj, stl, ply, off or 3mf [default: by extension, else by content]
    #[arg(long, value_name = "FORMAT", value_enum, hide_possible_values = true)]
    pub(crate) format: Option<FormatName>,

    /// Write one JSON object
    #[arg(long)]
    pub(crate) json: bool,

    #[command(flatten)]
    pub(crate) choice: ChoiceArgs,

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
