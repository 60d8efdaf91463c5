//! Extensions are declared: those in use are in `extensionsUsed`, required ones too.
//!
//! Validator: `UNDECLARED_EXTENSION`, `UNUSED_EXTENSION_REQUIRED`, `NON_REQUIRED_EXTENSION`.

use super::super::document::{Document, Material};
use super::{Report, materials};
use std::collections::BTreeSet;

/// Extensions without which nothing else of a file is valid.
const NEVER_OPTIONAL: [&str; 1] = ["KHR_mesh_quantization"];

/// Warns of extensions that a file uses without a word.
pub(super) fn check(document: &Document<'_>, report: &mut Report<'_, '_>) {
    let declared: BTreeSet<&str> = document
        .extensions_used
        .iter()
        .map(|name| &**name)
        .collect();
    for name in found(document) {
        if !declared.contains(name) {
            report.warn(
                || "/extensionsUsed".to_owned(),
                || format!("the extension `{name}` is not declared; it is read all the same"),
            );
        }
    }
    for (at, name) in document.extensions_required.iter().enumerate() {
        if !declared.contains(&**name) {
            report.warn(
                || format!("/extensionsRequired/{at}"),
                || format!("the extension `{name}` is not in `extensionsUsed`"),
            );
        }
    }
    for name in NEVER_OPTIONAL {
        let is_required = document
            .extensions_required
            .iter()
            .any(|found| found == name);
        if declared.contains(name) && !is_required {
            report.warn(
                || "/extensionsUsed".to_owned(),
                || format!("the extension `{name}` must be required"),
            );
        }
    }
}

/// The extensions that objects of the document have, of those that are read.
fn found(document: &Document<'_>) -> BTreeSet<&'static str> {
    let mut found = BTreeSet::new();
    let mut add = |is_there: bool, name: &'static str| {
        if is_there {
            found.insert(name);
        }
    };
    add(document.extensions.lights.is_some(), "KHR_lights_punctual");
    add(
        document.extensions.variants.is_some(),
        "KHR_materials_variants",
    );
    for node in &document.nodes {
        add(node.extensions.light.is_some(), "KHR_lights_punctual");
        add(
            node.extensions.instancing.is_some(),
            "EXT_mesh_gpu_instancing",
        );
    }
    for primitive in document.meshes.iter().flat_map(|mesh| &mesh.primitives) {
        add(
            primitive.extensions.variants.is_some(),
            "KHR_materials_variants",
        );
    }
    for view in &document.buffer_views {
        add(view.extensions.meshopt.is_some(), "EXT_meshopt_compression");
    }
    for texture in &document.textures {
        add(texture.extensions.webp.is_some(), "EXT_texture_webp");
        add(texture.extensions.dds.is_some(), "MSFT_texture_dds");
    }
    for material in &document.materials {
        of_material(material, &mut add);
    }
    found
}

fn of_material(material: &Material, add: &mut impl FnMut(bool, &'static str)) {
    materials::for_each_texture(material, |_, texture| {
        add(
            texture.extensions.transform.is_some(),
            "KHR_texture_transform",
        );
    });
    let Some(own) = material.extensions.as_deref() else {
        return;
    };
    for (is_there, name) in [
        (own.anisotropy.is_some(), "KHR_materials_anisotropy"),
        (own.clearcoat.is_some(), "KHR_materials_clearcoat"),
        (own.dispersion.is_some(), "KHR_materials_dispersion"),
        (
            own.emissive_strength.is_some(),
            "KHR_materials_emissive_strength",
        ),
        (own.ior.is_some(), "KHR_materials_ior"),
        (own.iridescence.is_some(), "KHR_materials_iridescence"),
        (own.sheen.is_some(), "KHR_materials_sheen"),
        (own.specular.is_some(), "KHR_materials_specular"),
        (
            own.specular_glossiness.is_some(),
            "KHR_materials_pbrSpecularGlossiness",
        ),
        (own.transmission.is_some(), "KHR_materials_transmission"),
        (own.unlit.is_some(), "KHR_materials_unlit"),
        (own.volume.is_some(), "KHR_materials_volume"),
    ] {
        add(is_there, name);
    }
}
