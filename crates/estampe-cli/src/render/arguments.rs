//! The options of `estampe render` and their help.

use crate::values::{
    self, Background, CullName, Destination, FormatName, ImageFormatName, ShadingName, Source,
    ViewName,
};
use clap::Args;
use estampe::Level;
use estampe_renderer::Up;
use glam::DVec3;
use std::path::PathBuf;

/// Renders an image of a model: OBJ, STL or PLY to PNG, JPEG or TGA.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  estampe render bunny.obj -o bunny.png
  estampe render part.stl -o part.png --view iso --ortho --shading flat
  estampe render head.obj -o head.png --texture head_diffuse.tga --azimuth -20
  estampe render builtin:teapot -o teapot.png --shading toon --background none
  estampe render scan.ply -o scan.jpg --size 640x480 --samples 1
  estampe render model.obj -o lit.png --light 1,1,1 --light -1,0.3,0 --ambient 0.1
  curl -s https://example.org/m.stl | estampe render - --format stl -o - > m.png

Built-in models: builtin:teapot, builtin:sphere, builtin:torus, builtin:cube, builtin:plane.

Space: right-handed, Y up. STL files are Z-up and are rotated, (x, y, z) to (x, z, -y). --up z rotates other \
files in the same way, --up y rotates nothing, and --up x,y,z rotates nothing and sets the up direction. --eye, \
--target and --light are in this space. The eye's direction from the target is \
(sin a cos e, sin e, cos a cos e) for azimuth a and elevation e.

Exit codes: 0 success, 1 the model is missing or invalid, 2 wrong usage, 3 the image cannot be written.

With --json one object is written to standard output, or to standard error with -o -: model, format, output \
{path, format, width, height, samples, bytes}, shading, threads, simd, camera, counts {meshes, vertices, \
triangles, lines, points, materials, textures}, pipeline {vertices_shaded, primitives_in, \
primitives_clipped, primitives_culled, primitives_binned, fragments_shaded}, timings_ms {read, parse, \
texture, device, prepare, geometry, raster, read_back, encode, write, total}, warnings [text], \
warning_count. The time of parse includes the computation of missing normals. An error gives {error, exit_code}.")]
pub(crate) struct RenderArgs {
    /// The model: a file, builtin:NAME, or - for standard input
    #[arg(value_name = "MODEL")]
    pub(crate) model: Source,

    /// The image: a file named .png, .jpg or .tga, or - for standard output
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: Destination,

    /// The model's format, if neither name nor content shows it; required for standard input
    #[arg(long, value_name = "FORMAT", value_enum, hide_possible_values = true)]
    #[arg(help = "The model's format: obj, stl or ply [default: by extension, else by content]")]
    pub(crate) format: Option<FormatName>,

    /// The image's format: png, jpeg or tga [default: by OUT's extension; png for standard output]
    #[arg(long, value_name = "FORMAT", value_enum, hide_possible_values = true)]
    pub(crate) output_format: Option<ImageFormatName>,

    /// Width and height in pixels, each 1 to 16384
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = values::size)]
    pub(crate) size: (u32, u32),

    /// A named view: iso, front, back, left, right, top or bottom
    #[arg(long, value_name = "NAME", value_enum, hide_possible_values = true)]
    #[arg(conflicts_with_all = ["azimuth", "elevation", "eye"], help_heading = "Camera")]
    pub(crate) view: Option<ViewName>,

    /// Angle around the model in degrees: 0 front, 90 right, 180 back [default: 30]
    #[arg(long, value_name = "DEG", value_parser = values::azimuth, allow_hyphen_values = true)]
    #[arg(conflicts_with = "eye", help_heading = "Camera")]
    pub(crate) azimuth: Option<f64>,

    /// Angle above the model in degrees, -90 to 90 [default: 20]
    #[arg(long, value_name = "DEG", value_parser = values::elevation, allow_hyphen_values = true)]
    #[arg(conflicts_with = "eye", help_heading = "Camera")]
    pub(crate) elevation: Option<f64>,

    /// Position of the eye, instead of a direction and the fit
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    #[arg(help_heading = "Camera")]
    pub(crate) eye: Option<DVec3>,

    /// The point in the middle of the image [default: the best fit; with --eye, the model's middle]
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    #[arg(help_heading = "Camera")]
    pub(crate) target: Option<DVec3>,

    /// The up direction: y, z, a direction x,y,z, or auto (Z for STL, else Y)
    #[arg(long, value_name = "UP", default_value = "auto", value_parser = values::up)]
    #[arg(allow_hyphen_values = true, help_heading = "Camera")]
    pub(crate) up: Up,

    /// Vertical opening angle in degrees, 0.1 to 175
    #[arg(long, value_name = "DEG", default_value = "35", value_parser = values::fov)]
    #[arg(conflicts_with = "ortho", help_heading = "Camera")]
    pub(crate) fov: f64,

    /// Parallel projection: size does not depend on distance
    #[arg(long, help_heading = "Camera")]
    pub(crate) ortho: bool,

    /// Free border around the model, as a fraction of the shorter side, 0 to 0.49
    #[arg(long, value_name = "FRACTION", default_value = "0.05", value_parser = values::margin)]
    #[arg(help_heading = "Camera")]
    pub(crate) margin: f64,

    /// Shading of surfaces: flat, gouraud, phong, toon, unlit, wireframe, normals, depth or uv
    ///
    /// flat: lighting once per face; gouraud: lighting at the vertices; phong: lighting at every
    /// pixel; toon: lighting in four steps; unlit: colours and textures without lighting;
    /// wireframe: edges, hidden by faces; normals: red right, green up, blue towards the eye;
    /// depth: white near, black far; uv: u red, v green. The last three store numbers without sRGB
    /// encoding.
    #[arg(
        long,
        value_name = "STYLE",
        value_enum,
        default_value = "phong",
        hide_possible_values = true
    )]
    #[arg(help_heading = "Appearance")]
    pub(crate) shading: ShadingName,

    /// A direction towards a white light, instead of the default lights; repeatable
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction, allow_hyphen_values = true)]
    #[arg(help_heading = "Appearance")]
    pub(crate) light: Vec<DVec3>,

    /// Ambient light, 0 to 10, times the base colour [default: 0.18]
    #[arg(long, value_name = "AMOUNT", value_parser = values::ambient, help_heading = "Appearance")]
    pub(crate) ambient: Option<f32>,

    /// A base-colour texture (PNG, JPEG, TGA; sRGB), instead of the model's colours and textures
    #[arg(long, value_name = "FILE", help_heading = "Appearance")]
    pub(crate) texture: Option<PathBuf>,

    /// The background: none, or a colour as six hexadecimal digits, with or without #
    #[arg(long, value_name = "none|#RRGGBB", default_value = "#f2f2f2")]
    #[arg(value_parser = values::background, help_heading = "Appearance")]
    pub(crate) background: Background,

    /// Faces that are culled: none, back (facing away) or front
    #[arg(
        long,
        value_name = "FACES",
        value_enum,
        default_value = "none",
        hide_possible_values = true
    )]
    #[arg(help_heading = "Appearance")]
    pub(crate) cull: CullName,

    /// Samples per pixel: 1, or 4 for smooth edges
    #[arg(long, value_name = "N", default_value = "4", value_parser = ["1", "4"])]
    #[arg(hide_possible_values = true, help_heading = "Appearance")]
    pub(crate) samples: String,

    /// Number of threads, 1 to 1024; the image does not depend on it [default: one per processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    #[arg(help_heading = "Machine")]
    pub(crate) threads: Option<u16>,

    /// SIMD level: auto, scalar, sse2, avx2 or avx512; the image does not depend on it
    #[arg(long, value_name = "LEVEL", default_value = "auto", value_parser = values::simd)]
    #[arg(help_heading = "Machine")]
    pub(crate) simd: Level,

    /// Write no warnings, no summary and no progress
    #[arg(short, long, help_heading = "Report")]
    pub(crate) quiet: bool,

    /// Write a report with counts and the time of each stage, as one JSON object
    #[arg(long, help_heading = "Report")]
    pub(crate) json: bool,
}
