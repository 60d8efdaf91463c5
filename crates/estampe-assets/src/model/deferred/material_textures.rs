//! The textures of a material, each with the meaning of its texels.

use crate::image::TexelContent::{self, Color, Number};
use estampe_scene::{Material, NormalTexture, PbrMaterial, TextureRef};

/// Calls `keep` with the image of each texture, which it may change, and removes the textures for
/// which it returns false.
pub(in crate::model) fn retain_textures(
    material: &mut Material,
    mut keep: impl FnMut(&mut usize, TexelContent) -> bool,
) {
    for (slot, content) in [
        (&mut material.base_color_texture, Color),
        (&mut material.bump_texture, Number),
    ] {
        if slot.as_mut().is_some_and(|image| !keep(image, content)) {
            *slot = None;
        }
    }
    if let Some(pbr) = &mut material.pbr {
        retain_pbr_textures(pbr, |texture, content| keep(&mut texture.image, content));
    }
}

/// [`retain_textures`] of the physically based description.
pub(in crate::model) fn retain_pbr_textures(
    pbr: &mut PbrMaterial,
    mut keep: impl FnMut(&mut TextureRef, TexelContent) -> bool,
) {
    let mut of = |slot: &mut Option<TextureRef>, content| {
        if slot.as_mut().is_some_and(|texture| !keep(texture, content)) {
            *slot = None;
        }
    };
    of(&mut pbr.base_color_texture, Color);
    of(&mut pbr.metallic_roughness_texture, Number);
    of(&mut pbr.occlusion_texture, Number);
    of(&mut pbr.emissive_texture, Color);
    if let Some(specular) = &mut pbr.specular {
        of(&mut specular.texture, Number);
        of(&mut specular.color_texture, Color);
    }
    if let Some(transmission) = &mut pbr.transmission {
        of(&mut transmission.texture, Number);
    }
    if let Some(volume) = &mut pbr.volume {
        of(&mut volume.thickness_texture, Number);
    }
    if let Some(sheen) = &mut pbr.sheen {
        of(&mut sheen.color_texture, Color);
        of(&mut sheen.roughness_texture, Number);
    }
    if let Some(anisotropy) = &mut pbr.anisotropy {
        of(&mut anisotropy.texture, Number);
    }
    if let Some(iridescence) = &mut pbr.iridescence {
        of(&mut iridescence.texture, Number);
        of(&mut iridescence.thickness_texture, Number);
    }
    let mut of_normals = |slot: &mut Option<NormalTexture>| {
        if slot
            .as_mut()
            .is_some_and(|normal| !keep(&mut normal.texture, Number))
        {
            *slot = None;
        }
    };
    of_normals(&mut pbr.normal_texture);
    if let Some(clearcoat) = &mut pbr.clearcoat {
        of_normals(&mut clearcoat.normal_texture);
        for slot in [&mut clearcoat.texture, &mut clearcoat.roughness_texture] {
            if slot.as_mut().is_some_and(|texture| !keep(texture, Number)) {
                *slot = None;
            }
        }
    }
}
