//! The options of `estampe render` and their help.

use super::cameras::CamerasArgs;
use super::passes::{OutputFormatName, PassArgs};
use super::picture::{PictureArgs, ReportArgs};
use crate::choice::ChoiceArgs;
use crate::limits::LimitArgs;
use crate::preview::PreviewArgs;
use crate::values::{Destination, FormatName, Source};
use clap::Args;

/// Renders an image of a model: glTF, OBJ, STL, PLY, OFF or 3MF to PNG, JPEG, TGA, WebP, HDR
/// or OpenEXR.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  estampe render bunny.obj -o bunny.png
  estampe render part.stl -o part.png --view iso --ortho --shading flat
  estampe render head.obj -o head.png --texture head_diffuse.tga --azimuth -20
  estampe render builtin:teapot -o teapot.png --shading toon --background none
  estampe render part.stl --preview
  estampe render scan.ply -o scan.jpg --size 640x480 --samples 1
  estampe render model.obj -o lit.png --light 1,1,1 --light -1,0.3,0:4080ff:0.5 --ambient 0.1
  estampe render model.obj -o lamp.png --light pos:2,3,4 --attenuation 9 --specular blinn:0.6 --shininess 80
  estampe render robot.glb -o robot.png --animation Walk --time 0.5 --camera 0
  estampe render builtin:teapot -o mine.png --shader my.wgsl --set gloss=0.5
  estampe render robot.glb -o light.hdr --shading pbr
  estampe render builtin:teapot -o scene.exr --pass color,depth,normal,object-id
  estampe render builtin:teapot -o 'teapot-{pass}.png' --pass color,depth,normal
  estampe render scene.glb -o 'data/{camera}-{pass}.png' --cameras cameras.json --pass color,depth
  curl -s https://example.org/m.stl | estampe render - -o - > m.png

Built-in models: builtin:teapot, builtin:sphere, builtin:torus, builtin:cube, builtin:plane.

Space: right-handed, Y up. STL files are Z-up and are rotated, (x, y, z) to (x, z, -y). --up z rotates other \
files in the same way, --up y rotates nothing, and --up x,y,z rotates nothing and sets the up direction. --eye, \
--target and --light are in this space, and --attenuation and --fog are lengths in it. The eye's direction from the target is \
(sin a cos e, sin e, cos a cos e) for azimuth a and elevation e.

Exit codes: 0 success, 1 the model is missing or invalid, 2 wrong usage, 3 the image cannot be written.

With --json one object is written to standard output, or to standard error with -o -: model, format, output \
{path, format, width, height, samples, bytes}, shading, transparency {method, layers or null}, threads, simd, \
camera, counts {meshes, vertices, triangles, lines, points, materials, textures}, pipeline {vertices_shaded, primitives_in, \
primitives_clipped, primitives_culled, primitives_binned, fragments_shaded}, timings_ms {read, parse, \
texture, device, prepare, geometry, raster, read_back, encode, write, total}, warnings [text], \
warning_count. The time of parse includes the computation of missing normals, and of OBJ files the reading. \
With --pass it is: model, width, height, depth_unit (of PNG), outputs [{path, passes, bytes}], camera with pinhole {K, R, t} (x right, \
y down, z forward, in pixels), counts, objects [name], materials [name], milliseconds, warnings [text]. With --cameras it has cameras [{name, width, height, pinhole, outputs [{path, bytes}]}] in \
place of size, outputs and camera. An error gives \
{error, exit_code}.")]
pub(crate) struct RenderArgs {
    /// The model: a file, builtin:NAME, or - for standard input
    #[arg(value_name = "MODEL")]
    pub(crate) model: Source,

    /// The image: a file named .png, .jpg, .tga, .webp, .exr or .hdr, or - for standard output
    #[arg(short, long, value_name = "OUT", allow_hyphen_values = true)]
    #[arg(value_parser = crate::values::destination(), required_unless_present = "preview")]
    pub(crate) output: Option<Destination>,

    /// The model's format, if neither name nor content shows it
    #[arg(long, value_name = "FORMAT", value_enum, hide_possible_values = true)]
    #[arg(
        help = "The model's format: gltf, obj, stl, ply, off or 3mf [default: by extension, else by content]"
    )]
    pub(crate) format: Option<FormatName>,

    /// The image's format: png, jpeg, tga, webp, exr or hdr [default: by OUT's extension; png for
    /// -]
    ///
    /// exr and hdr hold light, linear floats above 1 too: after --exposure, before --tone-map. exr
    /// has 32 bits a channel and alpha, hdr 8 bits with a common exponent.
    #[arg(long, value_name = "FORMAT", value_enum, hide_possible_values = true)]
    #[arg(requires = "output")]
    pub(crate) output_format: Option<OutputFormatName>,

    /// Draw again when the model, or a file that it or an option names, changes; Ctrl-C ends it
    #[arg(long, conflicts_with = "timeout")]
    pub(crate) watch: bool,

    #[command(flatten)]
    pub(crate) choice: ChoiceArgs,

    #[command(flatten)]
    pub(crate) picture: PictureArgs,

    #[command(flatten)]
    pub(crate) passes: PassArgs,

    #[command(flatten)]
    pub(crate) cameras: CamerasArgs,

    #[command(flatten)]
    pub(crate) preview: PreviewArgs,

    #[command(flatten)]
    pub(crate) limits: LimitArgs,

    #[command(flatten)]
    pub(crate) report: ReportArgs,
}

impl RenderArgs {
    /// True if the picture or its preview goes to standard output.
    pub(crate) fn is_to_standard_output(&self) -> bool {
        let output = self.output.as_ref();
        output.is_none_or(Destination::is_standard_output)
    }
}
