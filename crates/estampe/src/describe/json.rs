//! The report as one JSON object.

use super::{
    TEXTURE_FORMAT, alpha_name, bounds, light_name, material, materials_of, memory,
    projection_name, tree, up_name,
};
use crate::input::Model;
use crate::render::counts;
use estampe_scene::{Material, NamedCamera, Projection, PunctualLight, PunctualLightKind};
use serde_json::{Value, json};

/// The whole report.
pub(super) fn report(model: &Model) -> Value {
    let scene = &model.scene;
    let meshes = scene.meshes.iter().enumerate().map(|(at, mesh)| {
        json!({
            "name": mesh.name,
            "vertices": mesh.positions.len(),
            "triangles": mesh.triangles.len(),
            "lines": mesh.lines.len(),
            "points": mesh.points.len(),
            "attributes": memory::stored(model, at),
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
        "node_count": model.contents.node_count,
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
