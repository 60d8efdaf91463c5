//! glTF 2.0: `.gltf` with its files or data URIs, and `.glb`.
//!
//! ```text
//! bytes -> glb (chunks) -> json -> document           plain data, still unchecked
//!       -> extensions                                 refuses what is required and not read
//!       -> choice                                     scene, animation, time, variant
//!       -> buffers -> views (meshopt) -> accessor     checked, copied in bulk
//!       -> hierarchy, pose (interpolation)            world transforms at the time
//!       -> meshes: vertices (morph targets) -> connectivity -> placed (instances, skin)
//!       -> material (images), cameras_lights
//!       -> rules                                      warnings of the whole document
//! ```
//!
//! All meshes are in world space: one for each primitive of each node. Errors have the JSON Pointer
//! of the value (`/accessors/3/count`). What cannot be interpreted is an error; what is merely
//! forbidden, or missing for a better picture, is a warning.
//!
//! Source: Khronos Group, "glTF 2.0 Specification", 2021 (ISO/IEC 12113:2022), and its registry of
//! extensions.

mod accessor;
mod buffers;
mod cameras_lights;
mod choice;
mod connectivity;
mod contents;
mod data_uri;
mod document;
mod extensions;
mod fault;
mod glb;
mod hierarchy;
mod images;
mod instances;
mod interpolation;
mod json;
mod json_pointer;
mod material;
mod meshes;
mod meshopt;
mod placed;
mod pose;
mod rules;
mod skin;
mod vertices;

pub(super) use data_uri::percent_decoded;
pub(super) use glb::MAGIC;

use super::joined;
use super::load::{Context, Parsed};
use super::options::{AnimationClip, ModelChoices, ModelOptions};
use crate::{AssetError, Limits};
use accessor::Accessors;
use buffers::{Buffers, Views};
use choice::Choice;
use document::Document;
use estampe_scene::{Material, Mesh, Scene, UpAxis};
use glam::Vec3;
use hierarchy::Hierarchy;
use meshes::{Meshes, Source};
use pose::Pose;

/// Reads a glTF file.
pub(super) fn parse<'a>(
    bytes: &'a [u8],
    options: &ModelOptions,
    context: &mut Context<'a>,
) -> Result<Parsed, AssetError> {
    let container = glb::split(bytes, context)?;
    let document = json::parse(&container)?;
    check_version(&document)?;
    extensions::check(&document, context)?;
    let material_count = document.materials.len() as u64;
    Limits::check("materials", material_count, context.limits.max_materials)
        .map_err(|error| error.at_json("/materials"))?;
    let choice = Choice::of(&document, options)?;
    let hierarchy = Hierarchy::new(&document)?;
    let nodes = hierarchy.nodes_of_scene(choice.scene, &document)?;

    let buffers = Buffers::read(&document, container.bin, context);
    let views = Views::new(&document, &buffers, context.limits, context.workers);
    let accessors = Accessors::new(&document, &views, context.limits);
    let pose = Pose::sample(&document, &accessors, &choice, context.limits)?;
    let world_from_node = hierarchy.world_transforms(&document, &pose);

    let source = Source {
        document: &document,
        accessors: &accessors,
        choice: &choice,
        pose: &pose,
        world_from_node: &world_from_node,
    };
    let Meshes {
        mut meshes,
        materials: material_of_mesh,
        ..
    } = Meshes::of_nodes(&nodes, &source, context)?;
    let mut is_used = vec![false; document.materials.len()];
    for &index in material_of_mesh.iter().flatten() {
        is_used[index] = true;
    }
    let needs_default = material_of_mesh.contains(&None);
    let stored = (&views, container.bin);
    let materials = material::read(&document, &is_used, needs_default, stored, context)?;
    for (mesh, material) in meshes.iter_mut().zip(material_of_mesh) {
        // The default material comes after those of the file.
        let index = material.unwrap_or(document.materials.len());
        for surface in &mut mesh.surfaces {
            surface.material = Some(index);
        }
        paint_lines_and_points(mesh, &materials[index]);
    }
    rules::check(&document, context);
    joined::join_beyond(&mut meshes, context.limits.max_meshes);
    let limits = context.limits;
    Ok(Parsed {
        scene: Scene {
            meshes,
            materials,
            images: Vec::new(),
            up: UpAxis::Y,
            cameras: cameras_lights::cameras(&nodes, &document, &world_from_node, limits)?,
            lights: cameras_lights::lights(&nodes, &document, &world_from_node, limits)?,
        },
        // The specification asks for it (§3.7.2.1).
        has_flat_normals: true,
        choices: choices(&document, &accessors),
        contents: contents::of(&nodes, &hierarchy, &document, &accessors),
        ..Parsed::default()
    })
}

/// Files of version 2, whatever follows the dot.
fn check_version(document: &Document<'_>) -> Result<(), AssetError> {
    let asset = &document.asset;
    let minimum = asset.min_version.as_deref();
    let unsupported = |property: &str, version: &str| {
        AssetError::unsupported(
            format!("version {version} of glTF is not read, version 2 is"),
            "convert the file to glTF 2.0",
        )
        .at_json(format!("/asset/{property}"))
    };
    if asset.version.split('.').next() != Some("2") {
        return Err(unsupported("version", &asset.version));
    }
    match minimum {
        Some(minimum) if minimum != "2.0" => Err(unsupported("minVersion", minimum)),
        _ => Ok(()),
    }
}

/// Multiplies the colours of vertices by the material's, where there are lines or points: they
/// have no surfaces that refer to it.
fn paint_lines_and_points(mesh: &mut Mesh, material: &Material) {
    if !mesh.triangles.is_empty() {
        return;
    }
    let Vec3 { x, y, z } = material.base_color;
    let factor = [x, y, z, material.opacity];
    mesh.colors.resize(mesh.positions.len(), [1.0; 4]);
    for color in &mut mesh.colors {
        *color = std::array::from_fn(|i| color[i] * factor[i]);
    }
    mesh.surfaces.clear();
}

fn choices(document: &Document<'_>, accessors: &Accessors<'_>) -> ModelChoices {
    let scenes = document.scenes.iter();
    let variants = document.extensions.variants().iter();
    let animations = document.animations.iter().enumerate();
    ModelChoices {
        scenes: scenes.map(|scene| scene.name.clone()).collect(),
        animations: animations
            .map(|(at, animation)| AnimationClip {
                name: animation.name.clone(),
                duration_s: pose::duration(document, accessors, at),
            })
            .collect(),
        variants: variants.map(|variant| variant.name.clone()).collect(),
    }
}
