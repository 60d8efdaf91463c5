//! `estampe info`: describes the contents of a model.

mod material;
mod memory;
mod tree;

use crate::choice::ChoiceArgs;
use crate::failure::Failure;
use crate::input::{Model, Reading};
use crate::render::counts;
use crate::terminal::one_line;
use crate::values::{FormatName, Source};
use clap::Args;
use estampe_assets::Limits;
use estampe_assets::model::LeastDetail;
use estampe_scene::{
    AlphaMode, Bounds, Material, Mesh, NamedCamera, Projection, PunctualLight, PunctualLightKind,
    Scene, UpAxis,
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

Bounds are in the file's own space; lengths are metres in glTF and millimetres in 3MF, other formats state no unit. \
Vertices are counted as they are drawn: corners of faces that differ in a normal or texture coordinate are separate \
vertices. Normals and tangents are the file's, or made: normals while reading, tangents where a normal texture needs \
them. Memory is that of the decoded model: vertices and indices, and textures without mip levels. The tree of nodes is \
listed to 40 lines and a depth of 8.

Exit codes: 0 success, 1 the model is missing or invalid, 2 wrong usage, 3 the report cannot be written.

With --json one object is written: model, format, up, unit or null, counts {meshes, vertices, triangles, lines, \
points, materials, textures}, bounds {min, max, size} or null, memory {geometry, textures} in bytes, nodes [{name, \
depth, mesh, instances, skin, camera, light}] (at most 10000), extensions [name], meshes [{name, vertices, triangles, \
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
        format!("{:#}\n", json(&model))
    } else {
        text(&model)
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

/// The attributes of a mesh besides positions.
fn attributes(mesh: &Mesh) -> Vec<&'static str> {
    let has = [
        ("normals", !mesh.normals.is_empty()),
        ("tangents", mesh.attribute(Mesh::TANGENT).is_some()),
        ("uvs", !mesh.uvs.is_empty()),
        ("uvs1", mesh.attribute(Mesh::UV1).is_some()),
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
    let meshes = scene.meshes.iter().enumerate().map(|(at, mesh)| {
        json!({
            "name": mesh.name,
            "vertices": mesh.positions.len(),
            "triangles": mesh.triangles.len(),
            "lines": mesh.lines.len(),
            "points": mesh.points.len(),
            "attributes": attributes(mesh),
            "normals": memory::normals(model, at),
            "tangents": memory::tangents(model, at),
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
            "textures": material::textures(material).into_iter().map(|found| json!({
                "slot": found.slot,
                "texture": found.image,
                "channels": found.channels,
            })).collect::<Vec<_>>(),
            "extensions": material::extensions(material),
        })
    });
    let images = model.contents.image_sizes.iter();
    let textures = images.map(|&(width, height)| {
        json!({
            "width": width,
            "height": height,
            "format": TEXTURE_FORMAT,
            "bytes": memory::image_bytes((width, height)),
        })
    });
    let lights = scene.lights.iter().map(light_json);
    let animations = model.choices.animations.iter();
    let animations =
        animations.map(|clip| json!({ "name": clip.name, "duration": clip.duration_s }));
    json!({
        "model": model.name,
        "format": model.format.map(|format| format.name()),
        "up": up_name(scene.up),
        "unit": memory::unit(model),
        "memory": {
            "geometry": memory::geometry_bytes(scene),
            "textures": memory::texture_bytes(model),
        },
        "nodes": tree::json(model),
        "extensions": model.contents.extensions,
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
    let (angle, height, near, far) = match camera.projection {
        Projection::Perspective {
            fov_y_rad,
            near,
            far,
        } => (Some(fov_y_rad.to_degrees()), None, near, far),
        Projection::Orthographic {
            half_height,
            near,
            far,
        } => (None, Some(half_height), near, far),
    };
    json!({
        "name": named.name,
        "fov_y_degrees": angle,
        "half_height": height,
        "near": near,
        "far": far.is_finite().then_some(far),
        "aspect": named.aspect,
        "projection": projection_name(&camera.projection),
        "eye": camera.eye_world.to_array(),
        "target": camera.target_world.to_array(),
        "up": camera.up_world.to_array(),
    })
}

fn light_json(light: &PunctualLight) -> Value {
    let (position, direction, range) = match light.kind {
        PunctualLightKind::Directional { direction_world } => (None, Some(direction_world), None),
        PunctualLightKind::Point {
            position_world,
            range,
        } => (Some(position_world), None, range),
        PunctualLightKind::Spot {
            position_world,
            direction_world,
            range,
            ..
        } => (Some(position_world), Some(direction_world), range),
    };
    json!({
        "name": light.name,
        "kind": light_name(&light.kind),
        "color": light.color.to_array(),
        "intensity": light.intensity,
        "position": position.map(|point| point.to_array()),
        "direction": direction.map(|vector| vector.to_array()),
        "range": range,
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
        let lens = match camera.camera.projection {
            Projection::Perspective { fov_y_rad, .. } => {
                format!("perspective, {} degrees", fov_y_rad.to_degrees())
            }
            Projection::Orthographic { half_height, .. } => {
                format!("orthographic, height {}", 2.0 * half_height)
            }
        };
        let _ = writeln!(out, "  camera {}: {lens}", numbered(at, &camera.name));
    }
    list_rest(out, scene.cameras.len(), LISTED, "cameras");
    for (at, light) in scene.lights.iter().enumerate().take(LISTED) {
        let kind = light_name(&light.kind);
        let unit = match light.kind {
            PunctualLightKind::Directional { .. } => "lux",
            _ => "candela",
        };
        let (name, strength) = (numbered(at, &light.name), light.intensity);
        let _ = writeln!(out, "  light {name}: {kind}, {strength} {unit}");
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
        let unit = memory::unit(model).map_or(String::new(), |unit| format!(" {unit}"));
        let _ = writeln!(out, "  bounds {a} to {b}, size {size}{unit}");
    } else {
        let _ = writeln!(out, "  bounds: none, nothing to draw");
    }
    let (geometry, textures) = (memory::geometry_bytes(scene), memory::texture_bytes(model));
    let _ = writeln!(
        out,
        "  memory: geometry {geometry} bytes, textures {textures} bytes"
    );
    if !model.contents.extensions.is_empty() {
        let names = model.contents.extensions.iter().take(LISTED);
        let names: Vec<_> = names.map(|name| one_line(name)).collect();
        let _ = writeln!(out, "  extensions: {}", names.join(", "));
    }
    tree::text(&mut out, model);
    for (at, mesh) in scene.meshes.iter().enumerate().take(LISTED) {
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
        let sources = [
            ("normals", memory::normals(model, at)),
            ("tangents", memory::tangents(model, at)),
        ];
        let made = sources
            .into_iter()
            .filter(|(_, source)| *source == Some(memory::MADE));
        let made: Vec<&str> = made.map(|(name, _)| name).collect();
        let made = match &*made {
            [] => String::new(),
            names => format!("; made: {}", names.join(", ")),
        };
        let _ = writeln!(out, "  mesh {name}: {}{with}{made}", kinds.join(", "));
    }
    list_rest(&mut out, scene.meshes.len(), LISTED, "meshes");
    for material in scene.materials.iter().take(LISTED) {
        let extensions = match &*material::extensions(material) {
            [] => String::new(),
            names => format!(", {}", names.join(", ")),
        };
        let opacity = match material.alpha_mode {
            AlphaMode::Blend => format!(", opacity {}", material.opacity),
            AlphaMode::Mask => ", cut out by alpha".to_owned(),
            AlphaMode::Opaque => String::new(),
        };
        let _ = writeln!(
            out,
            "  material {}: colour {}{opacity}{extensions}",
            one_line(&material.name),
            material.base_color
        );
        for found in material::textures(material) {
            let (slot, image, channels) = (found.slot, found.image, found.channels);
            let _ = writeln!(out, "    {slot}: texture {image}, {channels}");
        }
    }
    list_rest(&mut out, scene.materials.len(), LISTED, "materials");
    let sizes = model.contents.image_sizes.iter();
    for (at, (width, height)) in sizes.enumerate().take(LISTED) {
        let _ = writeln!(out, "  texture {at}: {width}x{height} {TEXTURE_FORMAT}");
    }
    list_rest(&mut out, scene.images.len(), LISTED, "textures");
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
