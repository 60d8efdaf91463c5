//! The report as text: a label and a value a line.

use super::lines::{Lines, bytes, counted};
use super::{TEXTURE_FORMAT, bounds, material, memory, offers, tree, up_name};
use crate::input::Model;
use crate::render::counts;
use crate::terminal::one_line;
use estampe_scene::{AlphaMode, Material};
use serde_json::Value;
use std::borrow::Cow;

/// The things of each kind that are listed; further ones are counted.
pub(super) const LISTED: usize = 20;

/// The whole report.
pub(super) fn report(model: &Model) -> String {
    let scene = &model.scene;
    let format = model.format.map_or("built-in", |format| format.name());
    let (name, up) = (&model.name, up_name(scene.up).to_uppercase());
    let mut lines = Lines::new(&format!("{name}: {format}, {up} up"));
    add_sums(&mut lines, model);
    tree::add(&mut lines, model);
    for at in 0..scene.meshes.len().min(LISTED) {
        add_mesh(&mut lines, model, at);
    }
    lines.add_rest(scene.meshes.len(), LISTED, "meshes");
    for material in scene.materials.iter().take(LISTED) {
        add_material(&mut lines, material);
    }
    lines.add_rest(scene.materials.len(), LISTED, "materials");
    let images = &model.contents.image_sizes;
    for (at, (width, height)) in images.iter().enumerate().take(LISTED) {
        lines.add(
            "texture",
            &format!("{at}: {width}x{height} {TEXTURE_FORMAT}"),
        );
    }
    lines.add_rest(images.len(), LISTED, "textures");
    offers::add(&mut lines, model);
    for warning in &model.warnings {
        lines.add("warning", &one_line(&warning.to_string()));
    }
    let more = model
        .warning_count
        .saturating_sub(model.warnings.len() as u64);
    if more > 0 {
        lines.add("", &format!("and {}", counted(more, "more warnings")));
    }
    lines.text
}

/// Counts, bounds, memory and extensions.
fn add_sums(lines: &mut Lines, model: &Model) {
    let scene = &model.scene;
    if let Value::Object(counts) = counts(model) {
        let of = |what: &str| counts.get(what).and_then(Value::as_u64).unwrap_or(0);
        let kinds = [
            "meshes",
            "vertices",
            "triangles",
            "lines",
            "points",
            "materials",
            "textures",
        ];
        let kinds = kinds.into_iter().filter(|what| of(what) > 0);
        let parts: Vec<String> = kinds.map(|what| counted(of(what), what)).collect();
        if !parts.is_empty() {
            lines.add("counts", &parts.join(", "));
        }
    }
    let bounds = bounds(scene).map_or("none, nothing to draw".to_owned(), |bounds| {
        let [a, b, size] = [bounds.min, bounds.max, bounds.max - bounds.min];
        let unit = memory::unit(model).map_or(String::new(), |unit| format!(" {unit}"));
        format!("{a} to {b}, size {size}{unit}")
    });
    lines.add("bounds", &bounds);
    let geometry = bytes(memory::geometry_bytes(scene));
    let textures = bytes(memory::texture_bytes(model));
    lines.add(
        "memory",
        &format!("geometry {geometry}, textures {textures}"),
    );
    let extensions = &model.contents.extensions;
    if !extensions.is_empty() {
        let names: Vec<Cow<'_, str>> = extensions
            .iter()
            .take(LISTED)
            .map(|name| one_line(name))
            .collect();
        lines.add_list("extensions", "", &names);
        lines.add_rest(extensions.len(), LISTED, "extensions");
    }
}

fn add_mesh(lines: &mut Lines, model: &Model, at: usize) {
    let mesh = &model.scene.meshes[at];
    let kinds = [
        (mesh.triangles.len(), "triangles"),
        (mesh.lines.len(), "lines"),
        (mesh.points.len(), "points"),
    ];
    let kinds = kinds.iter().filter(|(count, _)| *count > 0);
    let kinds: Vec<String> = kinds
        .map(|(count, kind)| counted(*count as u64, kind))
        .collect();
    let kinds = match &*kinds {
        [] => "nothing to draw".to_owned(),
        kinds => kinds.join(", "),
    };
    let attributes = memory::attributes(model, at);
    let attributes = attributes.iter().map(|(name, source)| match *source {
        memory::MADE => format!("{name} (made)"),
        _ => (*name).to_owned(),
    });
    let attributes: Vec<String> = attributes.collect();
    let with = match &*attributes {
        [] => String::new(),
        names => format!(", with {}", names.join(", ")),
    };
    lines.add("mesh", &format!("{}: {kinds}{with}", named(&mesh.name)));
}

fn add_material(lines: &mut Lines, material: &Material) {
    let mut facts = vec![format!("colour {}", material.base_color)];
    match material.alpha_mode {
        AlphaMode::Blend => facts.push(format!("opacity {}", material.opacity)),
        AlphaMode::Mask => facts.push("cut out by alpha".to_owned()),
        AlphaMode::Opaque => {}
    }
    facts.extend(
        material::extensions(material)
            .into_iter()
            .map(str::to_owned),
    );
    lines.add_list("material", &format!("{}:", named(&material.name)), &facts);
    for found in material::textures(material) {
        let (slot, image, channels) = (found.slot, found.image, found.channels);
        lines.add("", &format!("  {slot}: texture {image}, {channels}"));
    }
}

/// A name without control characters.
pub(super) fn named(name: &str) -> Cow<'_, str> {
    match name {
        "" => "(no name)".into(),
        name => one_line(name),
    }
}
