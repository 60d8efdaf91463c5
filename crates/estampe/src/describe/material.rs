//! The textures of a material with the channels that are read, and its extensions.

use estampe_scene::{Material, NormalTexture, PbrMaterial, TextureRef};

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
    let image = |texture: Option<TextureRef>| texture.map(|found| found.image);
    let normal = |texture: Option<NormalTexture>| texture.map(|found| found.texture.image);
    add("base color", image(pbr.base_color_texture), "rgba");
    add(
        "metallic-roughness",
        image(pbr.metallic_roughness_texture),
        "gb",
    );
    add("normal", normal(pbr.normal_texture), "rgb");
    add("occlusion", image(pbr.occlusion_texture), "r");
    add("emissive", image(pbr.emissive_texture), "rgb");
    if let Some(layer) = pbr.specular {
        add("specular", image(layer.texture), "a");
        add("specular color", image(layer.color_texture), "rgb");
    }
    if let Some(layer) = pbr.transmission {
        add("transmission", image(layer.texture), "r");
    }
    if let Some(layer) = pbr.volume {
        add("thickness", image(layer.thickness_texture), "g");
    }
    if let Some(layer) = pbr.clearcoat {
        add("clearcoat", image(layer.texture), "r");
        add("clearcoat roughness", image(layer.roughness_texture), "g");
        add("clearcoat normal", normal(layer.normal_texture), "rgb");
    }
    if let Some(layer) = pbr.sheen {
        add("sheen color", image(layer.color_texture), "rgb");
        add("sheen roughness", image(layer.roughness_texture), "a");
    }
    if let Some(layer) = pbr.anisotropy {
        add("anisotropy", image(layer.texture), "rgb");
    }
    if let Some(layer) = pbr.iridescence {
        add("iridescence", image(layer.texture), "r");
        add("iridescence thickness", image(layer.thickness_texture), "g");
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
