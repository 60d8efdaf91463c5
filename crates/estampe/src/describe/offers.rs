//! What a file offers besides its meshes: cameras, lights, scenes, animations and variants.

use super::light_name;
use super::lines::{Lines, rounded};
use super::text::LISTED;
use crate::input::Model;
use crate::terminal::one_line;
use estampe_scene::{Projection, PunctualLightKind};

/// Writes a line for each.
pub(super) fn add(lines: &mut Lines, model: &Model) {
    let (scene, choices) = (&model.scene, &model.choices);
    for (at, camera) in scene.cameras.iter().enumerate().take(LISTED) {
        let lens = match camera.camera.projection {
            Projection::Perspective { fov_y_rad, .. } => {
                format!("perspective, {} degrees", rounded(fov_y_rad.to_degrees()))
            }
            Projection::Orthographic { half_height, .. } => {
                format!("orthographic, height {}", 2.0 * half_height)
            }
        };
        lines.add("camera", &format!("{}: {lens}", numbered(at, &camera.name)));
    }
    lines.add_rest(scene.cameras.len(), LISTED, "cameras");
    for (at, light) in scene.lights.iter().enumerate().take(LISTED) {
        let kind = light_name(&light.kind);
        let unit = match light.kind {
            PunctualLightKind::Directional { .. } => "lux",
            _ => "candela",
        };
        let (name, strength) = (numbered(at, &light.name), light.intensity);
        lines.add("light", &format!("{name}: {kind}, {strength} {unit}"));
    }
    lines.add_rest(scene.lights.len(), LISTED, "lights");
    if choices.scenes.len() > 1 {
        for (at, name) in choices.scenes.iter().enumerate().take(LISTED) {
            lines.add("scene", &numbered(at, name));
        }
        lines.add_rest(choices.scenes.len(), LISTED, "scenes");
    }
    for (at, clip) in choices.animations.iter().enumerate().take(LISTED) {
        let (name, seconds) = (numbered(at, &clip.name), rounded(clip.duration_s));
        lines.add("animation", &format!("{name}: {seconds} s"));
    }
    lines.add_rest(choices.animations.len(), LISTED, "animations");
    for name in choices.variants.iter().take(LISTED) {
        lines.add("variant", &format!("\"{}\"", one_line(name)));
    }
    lines.add_rest(choices.variants.len(), LISTED, "variants");
}

/// The name of a thing in a list, in quotation marks, or its number alone.
fn numbered(at: usize, name: &str) -> String {
    match name {
        "" => at.to_string(),
        name => format!("{at} \"{}\"", one_line(name)),
    }
}
