//! `estampe info`: describes the contents of a model.

use crate::choice::ChoiceArgs;
use crate::failure::Failure;
use crate::input::{Model, Reading};
use crate::render::counts;
use crate::terminal::one_line;
use crate::values::{FormatName, Source};
use clap::Args;
use estampe_assets::Limits;
use estampe_assets::model::FullDetail;
use estampe_scene::{
    AlphaMode, Bounds, Material, Mesh, NamedCamera, Projection, PunctualLightKind, Scene, UpAxis,
};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Describes a model: counts, bounds, attributes, materials, and the reader's warnings.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  estampe info bunny.obj
  estampe info part.stl --json | jq .counts.triangles
  estampe info robot.glb --animation Walk --time 0.5

Bounds are in the file's own space. Vertices are counted as they are drawn: corners of faces that differ in a \
normal or texture coordinate are separate vertices. Missing normals are computed while reading.

Exit codes: 0 success, 1 the model is missing or invalid, 2 wrong usage, 3 the report cannot be written.

With --json one object is written: model, format, up, counts {meshes, vertices, triangles, lines, points, \
materials, textures}, bounds {min, max, size} or null, meshes [{name, vertices, triangles, lines, points, \
attributes, materials}], materials [{name, base_color, opacity, specular, shininess, emissive, texture, \
bump_texture, bump_scale, alpha}], textures [{width, height}], cameras [{name, projection, eye, target, up}], \
lights [{name, kind}], scenes [name], animations [{name, duration}], variants [name], warnings [text], \
warning_count. An error gives {error, exit_code}.")]
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
        detail: &FullDetail,
    };
    let folder = args.choice.folder_of(&args.model)?;
    let model = Model::read((&args.model, &folder), args.format, read, |_| {})?;
    let report = if args.json {
        format!("{:#}\n", json(&model))
    } else {
        text(&model)
    };
    crate::output::print(&report)
}

fn bounds(scene: &Scene) -> Option<Bounds> {
    let union = scene
        .meshes
        .iter()
        .fold(Bounds::EMPTY, |all, mesh| all.union(&mesh.bounds()));
    (!union.is_empty()).then_some(union)
}

/// The attributes of a mesh besides positions.
fn attributes(mesh: &Mesh) -> Vec<&'static str> {
    let has = [
        ("normals", !mesh.normals.is_empty()),
        ("uvs", !mesh.uvs.is_empty()),
        ("colors", !mesh.colors.is_empty()),
    ];
    has.into_iter()
        .filter(|(_, has)| *has)
        .map(|(name, _)| name)
        .collect()
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

fn json(model: &Model) -> Value {
    let scene = &model.scene;
    let meshes = scene.meshes.iter().map(|mesh| {
        json!({
            "name": mesh.name,
            "vertices": mesh.positions.len(),
            "triangles": mesh.triangles.len(),
            "lines": mesh.lines.len(),
            "points": mesh.points.len(),
            "attributes": attributes(mesh),
            "materials": materials_of(mesh),
        })
    });
    let materials = scene.materials.iter().map(|material: &Material| {
        json!({
            "name": material.name,
            "base_color": material.base_color.to_array(),
            "opacity": material.opacity,
            "specular": material.specular.to_array(),
            "shininess": material.shininess,
            "emissive": material.emissive.to_array(),
            "texture": material.base_color_texture,
            "bump_texture": material.bump_texture,
            "bump_scale": material.bump_scale,
            "alpha": alpha_name(material.alpha_mode),
        })
    });
    let images = scene.images.iter();
    let textures = images.map(|image| json!({ "width": image.width, "height": image.height }));
    let lights = scene.lights.iter();
    let lights = lights.map(|light| json!({ "name": light.name, "kind": light_name(&light.kind) }));
    let animations = model.choices.animations.iter();
    let animations =
        animations.map(|clip| json!({ "name": clip.name, "duration": clip.duration_s }));
    json!({
        "model": model.name,
        "format": model.format.map(|format| format.name()),
        "up": up_name(scene.up),
        "counts": counts(model),
        "bounds": bounds(scene).map(|bounds| json!({
            "min": bounds.min.to_array(),
            "max": bounds.max.to_array(),
            "size": (bounds.max - bounds.min).to_array(),
        })),
        "meshes": meshes.collect::<Vec<_>>(),
        "materials": materials.collect::<Vec<_>>(),
        "textures": textures.collect::<Vec<_>>(),
        "cameras": scene.cameras.iter().map(camera_json).collect::<Vec<_>>(),
        "lights": lights.collect::<Vec<_>>(),
        "scenes": model.choices.scenes,
        "animations": animations.collect::<Vec<_>>(),
        "variants": model.choices.variants,
        "warnings": model.warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "warning_count": model.warning_count,
    })
}

fn camera_json(named: &NamedCamera) -> Value {
    let camera = &named.camera;
    json!({
        "name": named.name,
        "projection": projection_name(&camera.projection),
        "eye": camera.eye_world.to_array(),
        "target": camera.target_world.to_array(),
        "up": camera.up_world.to_array(),
    })
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

/// The name of a thing in a list, in quotation marks, or its number alone.
fn numbered(at: usize, name: &str) -> String {
    match name {
        "" => at.to_string(),
        name => format!("{at} \"{}\"", one_line(name)),
    }
}

/// What a file offers besides its meshes: cameras, lights, scenes, animations and variants.
fn list_choices(out: &mut String, model: &Model) {
    const LISTED: usize = 20;
    let (scene, choices) = (&model.scene, &model.choices);
    for (at, camera) in scene.cameras.iter().enumerate().take(LISTED) {
        let projection = projection_name(&camera.camera.projection);
        let _ = writeln!(out, "  camera {}: {projection}", numbered(at, &camera.name));
    }
    list_rest(out, scene.cameras.len(), LISTED, "cameras");
    for (at, light) in scene.lights.iter().enumerate().take(LISTED) {
        let kind = light_name(&light.kind);
        let _ = writeln!(out, "  light {}: {kind}", numbered(at, &light.name));
    }
    list_rest(out, scene.lights.len(), LISTED, "lights");
    if choices.scenes.len() > 1 {
        for (at, name) in choices.scenes.iter().enumerate().take(LISTED) {
            let _ = writeln!(out, "  scene {}", numbered(at, name));
        }
        list_rest(out, choices.scenes.len(), LISTED, "scenes");
    }
    for (at, clip) in choices.animations.iter().enumerate().take(LISTED) {
        let (name, seconds) = (numbered(at, &clip.name), clip.duration_s);
        let _ = writeln!(out, "  animation {name}: {seconds} s");
    }
    list_rest(out, choices.animations.len(), LISTED, "animations");
    for name in choices.variants.iter().take(LISTED) {
        let _ = writeln!(out, "  variant \"{}\"", one_line(name));
    }
    list_rest(out, choices.variants.len(), LISTED, "variants");
}

/// The report as text. Writing into a `String` cannot fail.
fn text(model: &Model) -> String {
    const LISTED: usize = 20;
    let scene = &model.scene;
    let mut out = String::new();
    let format = model.format.map_or("built-in", |format| format.name());
    let _ = writeln!(
        out,
        "{}: {format}, {} up",
        model.name,
        up_name(scene.up).to_uppercase()
    );
    if let Value::Object(counts) = counts(model) {
        let counts = counts.iter().filter(|(_, count)| **count != json!(0));
        let counts: Vec<String> = counts
            .map(|(name, count)| format!("{count} {name}"))
            .collect();
        let _ = writeln!(out, "  {}", counts.join(", "));
    }
    if let Some(bounds) = bounds(scene) {
        let [a, b, size] = [bounds.min, bounds.max, bounds.max - bounds.min];
        let _ = writeln!(out, "  bounds {a} to {b}, size {size}");
    } else {
        let _ = writeln!(out, "  bounds: none, nothing to draw");
    }
    for mesh in scene.meshes.iter().take(LISTED) {
        let name = if mesh.name.is_empty() {
            "(no name)"
        } else {
            &*one_line(&mesh.name)
        };
        let kinds = [
            (mesh.triangles.len(), "triangles"),
            (mesh.lines.len(), "lines"),
            (mesh.points.len(), "points"),
        ];
        let kinds: Vec<String> = kinds
            .iter()
            .filter(|(n, _)| *n > 0)
            .map(|(n, kind)| format!("{n} {kind}"))
            .collect();
        let with = attributes(mesh).join(", ");
        let with = if with.is_empty() {
            String::new()
        } else {
            format!(", with {with}")
        };
        let _ = writeln!(out, "  mesh {name}: {}{with}", kinds.join(", "));
    }
    list_rest(&mut out, scene.meshes.len(), LISTED, "meshes");
    for material in scene.materials.iter().take(LISTED) {
        let texture = if material.base_color_texture.is_some() {
            ", textured"
        } else {
            ""
        };
        let opacity = match material.alpha_mode {
            AlphaMode::Blend => format!(", opacity {}", material.opacity),
            AlphaMode::Mask => ", cut out by alpha".to_owned(),
            AlphaMode::Opaque => String::new(),
        };
        let _ = writeln!(
            out,
            "  material {}: colour {}{opacity}{texture}",
            one_line(&material.name),
            material.base_color
        );
    }
    list_rest(&mut out, scene.materials.len(), LISTED, "materials");
    for image in &scene.images {
        let _ = writeln!(out, "  texture {}x{}", image.width, image.height);
    }
    list_choices(&mut out, model);
    for warning in &model.warnings {
        let _ = writeln!(out, "  warning: {}", one_line(&warning.to_string()));
    }
    let listed = model.warnings.len() as u64;
    if model.warning_count > listed {
        let _ = writeln!(out, "  warning: {} more", model.warning_count - listed);
    }
    out
}

fn list_rest(out: &mut String, count: usize, listed: usize, what: &str) {
    if count > listed {
        let _ = writeln!(out, "  and {} more {what}", count - listed);
    }
}
