//! `estampe info`: describes the contents of a model.

mod json;
mod lines;
mod material;
mod memory;
mod offers;
mod text;
mod tree;

use crate::choice::ChoiceArgs;
use crate::failure::Failure;
use crate::input::{Model, Reading};
use crate::values::{FormatName, Source};
use clap::Args;
use estampe_assets::Limits;
use estampe_assets::model::LeastDetail;
use estampe_scene::{AlphaMode, Bounds, Mesh, Projection, PunctualLightKind, Scene, UpAxis};

/// Describes a model: counts, bounds, attributes, materials, and the reader's warnings.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  estampe info bunny.obj
  estampe info part.stl --json | jq .counts.triangles
  estampe info robot.glb --animation Walk --time 0.5

Bounds are in the file's own space; lengths are metres in glTF and millimetres in 3MF, other formats state no unit. \
Vertices are counted as they are drawn: corners of faces that differ in a normal or texture coordinate are separate \
vertices. Normals and tangents are the file's, or made: normals while reading, tangents where a normal texture or \
anisotropy needs them. Memory is that of the decoded model: vertices and indices, and textures without mip levels. The tree of nodes is \
listed to 40 lines and a depth of 8.

Exit codes: 0 success, 1 the model is missing or invalid, 2 wrong usage, 3 the report cannot be written.

With --json one object is written: model, format, up, unit or null, counts {meshes, vertices, triangles, lines, \
points, materials, textures}, bounds {min, max, size} or null, memory {geometry, textures} in bytes, nodes [{name, \
depth, mesh, instances, skin, camera, light}] (at most 10000), node_count, extensions [name], meshes [{name, vertices, triangles, \
lines, points, attributes, normals, tangents, materials}], materials [{name, base_color, opacity, specular, shininess, \
emissive, texture, bump_texture, bump_scale, alpha, textures [{slot, texture, channels}], extensions [name]}], textures \
[{width, height, format, bytes}], cameras [{name, projection, eye, target, up, fov_y_degrees or half_height, near, far, \
aspect}], lights [{name, kind, color, intensity, position, direction, range}], scenes [name], animations [{name, \
duration}], variants [name], warnings [text], warning_count. Normals and tangents are \"file\", \"made\" or null. An error gives {error, exit_code}.")]
pub(crate) struct InfoArgs {
    /// The model: a file, builtin:NAME, or - for standard input
    #[arg(value_name = "MODEL")]
    pub(crate) model: Source,

    /// The model's format: gltf, obj, stl, ply, off or 3mf [default: by extension, else by content]
    #[arg(long, value_name = "FORMAT", value_enum, hide_possible_values = true)]
    pub(crate) format: Option<FormatName>,

    #[command(flatten)]
    pub(crate) choice: ChoiceArgs,

    /// The time in the animation, in seconds [default: 0]
    #[arg(long, value_name = "S", value_parser = crate::shader::values::seconds)]
    #[arg(allow_hyphen_values = true, help_heading = "Contents")]
    pub(crate) time: Option<f32>,

    /// Write one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

/// Runs the command.
pub(crate) fn run(args: &InfoArgs) -> Result<(), Failure> {
    let read = Reading {
        options: &args.choice.at(args.time),
        limits: &Limits::default(),
        detail: &LeastDetail,
    };
    let folder = args.choice.folder_of(&args.model)?;
    let model = Model::read((&args.model, &folder), args.format, read, |_| {})?;
    let report = if args.json {
        format!("{:#}\n", json::report(&model))
    } else {
        text::report(&model)
    };
    crate::output::print(&report)
}

/// The form of every texture in memory.
const TEXTURE_FORMAT: &str = "rgba8";

fn bounds(scene: &Scene) -> Option<Bounds> {
    let union = scene
        .meshes
        .iter()
        .fold(Bounds::EMPTY, |all, mesh| all.union(&mesh.bounds()));
    (!union.is_empty()).then_some(union)
}

/// The materials that a mesh's surfaces use, each once, in order.
fn materials_of(mesh: &Mesh) -> Vec<usize> {
    let mut named: Vec<usize> = mesh
        .surfaces
        .iter()
        .filter_map(|surface| surface.material)
        .collect();
    named.sort_unstable();
    named.dedup();
    named
}

fn up_name(up: UpAxis) -> &'static str {
    match up {
        UpAxis::Y => "y",
        UpAxis::Z => "z",
    }
}

fn alpha_name(mode: AlphaMode) -> &'static str {
    match mode {
        AlphaMode::Opaque => "opaque",
        AlphaMode::Mask => "mask",
        AlphaMode::Blend => "blend",
    }
}

fn projection_name(projection: &Projection) -> &'static str {
    match projection {
        Projection::Perspective { .. } => "perspective",
        Projection::Orthographic { .. } => "orthographic",
    }
}

fn light_name(kind: &PunctualLightKind) -> &'static str {
    match kind {
        PunctualLightKind::Directional { .. } => "directional",
        PunctualLightKind::Point { .. } => "point",
        PunctualLightKind::Spot { .. } => "spot",
    }
}
