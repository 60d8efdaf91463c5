//! The textures of a material with the channels that are read, and its extensions.

use estampe_scene::{Material, PbrMaterial};

/// A texture of a material.
#[derive(Debug, Clone, Copy)]
pub(super) struct Use {
    /// The property, in glTF's words.
    pub(super) slot: &'static str,
    /// Index into the scene's images.
    pub(super) image: usize,
    /// The channels that the property reads.
    pub(super) channels: &'static str,
}

/// The textures of a material.
pub(super) fn textures(material: &Material) -> Vec<Use> {
    let mut uses = Vec::new();
    let mut add = |slot, image: Option<usize>, channels| {
        uses.extend(image.map(|image| Use {
            slot,
            image,
            channels,
        }));
    };
    let Some(pbr) = material.pbr.as_deref() else {
        add("base color", material.base_color_texture, "rgba");
        add("bump", material.bump_texture, "rgb");
        return uses;
    };
    add(
        "base color",
        pbr.base_color_texture.map(|found| found.image),
        "rgba",
    );
    let metal = pbr.metallic_roughness_texture.map(|found| found.image);
    add("metallic-roughness", metal, "gb");
    add(
        "normal",
        pbr.normal_texture.map(|found| found.texture.image),
        "rgb",
    );
    add(
        "occlusion",
        pbr.occlusion_texture.map(|found| found.image),
        "r",
    );
    add(
        "emissive",
        pbr.emissive_texture.map(|found| found.image),
        "rgb",
    );
    if let Some(layer) = pbr.specular {
        add("specular", layer.texture.map(|found| found.image), "a");
        add(
            "specular color",
            layer.color_texture.map(|found| found.image),
            "rgb",
        );
    }
    if let Some(layer) = pbr.transmission {
        add("transmission", layer.texture.map(|found| found.image), "r");
    }
    if let Some(layer) = pbr.volume {
        add(
            "thickness",
            layer.thickness_texture.map(|found| found.image),
            "g",
        );
    }
    if let Some(layer) = pbr.clearcoat {
        add("clearcoat", layer.texture.map(|found| found.image), "r");
        let rough = layer.roughness_texture.map(|found| found.image);
        add("clearcoat roughness", rough, "g");
        let normal = layer.normal_texture.map(|found| found.texture.image);
        add("clearcoat normal", normal, "rgb");
    }
    if let Some(layer) = pbr.sheen {
        add(
            "sheen color",
            layer.color_texture.map(|found| found.image),
            "rgb",
        );
        add(
            "sheen roughness",
            layer.roughness_texture.map(|found| found.image),
            "a",
        );
    }
    if let Some(layer) = pbr.anisotropy {
        add("anisotropy", layer.texture.map(|found| found.image), "rgb");
    }
    if let Some(layer) = pbr.iridescence {
        add("iridescence", layer.texture.map(|found| found.image), "r");
        let thick = layer.thickness_texture.map(|found| found.image);
        add("iridescence thickness", thick, "g");
    }
    uses
}

/// The extensions of glTF by which a material differs from the core's, without `KHR_materials_`.
pub(super) fn extensions(material: &Material) -> Vec<&'static str> {
    let Some(pbr) = material.pbr.as_deref() else {
        return Vec::new();
    };
    let core = PbrMaterial::default();
    let differs = |value: f32, other: f32| value.to_bits() != other.to_bits();
    let found = [
        (pbr.anisotropy.is_some(), "anisotropy"),
        (pbr.clearcoat.is_some(), "clearcoat"),
        (differs(pbr.dispersion, core.dispersion), "dispersion"),
        (
            differs(pbr.emissive_strength, core.emissive_strength),
            "emissive_strength",
        ),
        (differs(pbr.ior, core.ior), "ior"),
        (pbr.iridescence.is_some(), "iridescence"),
        (pbr.sheen.is_some(), "sheen"),
        (pbr.specular.is_some(), "specular"),
        (pbr.transmission.is_some(), "transmission"),
        (pbr.is_unlit, "unlit"),
        (pbr.volume.is_some(), "volume"),
    ];
    found
        .into_iter()
        .filter(|(is_there, _)| *is_there)
        .map(|(_, name)| name)
        .collect()
}
