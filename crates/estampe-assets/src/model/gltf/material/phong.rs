//! A physically based material as the Phong model draws it.
//!
//! | Phong           | from                                                               |
//! |-----------------|--------------------------------------------------------------------|
//! | colour, texture | base colour, of metals too: they have no environment to reflect    |
//! | opacity         | alpha where it counts; · (1 − 0.75 · transmission), which blends   |
//! | specular colour | 0.3 · (1 − roughness) · (white, of metals base colour) · factors   |
//! | shininess       | 2 ÷ roughness⁴ − 2, the exponent whose lobe is as wide as GGX's    |
//! | emitted light   | factor · strength; none with a texture, whose mean is not known    |
//!
//! The exponent follows B. Walter et al., "Microfacet Models for Refraction through Rough
//! Surfaces", 2007, §5.2, with α = roughness².

use estampe_scene::{AlphaMode, Material, PbrMaterial};
use glam::Vec3;

/// Specular colour of a smooth dielectric: 0.15 at a roughness of ½, as the default material has.
const BRIGHTEST_HIGHLIGHT: f32 = 0.3;
/// Part of the opacity that complete transmission takes; the rest shows that something is there.
const CLEAREST: f32 = 0.75;
/// Exponents above look alike.
const SHARPEST: f32 = 1000.0;

/// The material with both descriptions.
pub(super) fn material(name: String, mut pbr: PbrMaterial, alpha_mode: AlphaMode) -> Material {
    let base = pbr.base_color.truncate();
    let transmission = pbr.transmission.map_or(0.0, |layer| layer.factor);
    let alpha = match alpha_mode {
        AlphaMode::Opaque => 1.0,
        AlphaMode::Mask | AlphaMode::Blend => pbr.base_color.w,
    };
    if transmission > 0.0 {
        pbr.alpha_mode = Some(alpha_mode);
    }
    let alpha_mode = match alpha_mode {
        // The texture's alpha means nothing then, so there must be none.
        AlphaMode::Opaque if transmission > 0.0 && pbr.base_color_texture.is_none() => {
            AlphaMode::Blend
        }
        mode => mode,
    };
    let opacity = if alpha_mode == AlphaMode::Blend {
        alpha * (1.0 - CLEAREST * transmission)
    } else {
        alpha
    };
    let specular = if pbr.is_unlit {
        Vec3::ZERO
    } else {
        let layer = pbr
            .specular
            .map_or(Vec3::ONE, |layer| layer.color * layer.factor);
        let color = layer.min(Vec3::ONE).lerp(base, pbr.metallic);
        color * BRIGHTEST_HIGHLIGHT * (1.0 - pbr.roughness)
    };
    Material {
        name,
        base_color: base,
        opacity,
        specular,
        shininess: shininess(pbr.roughness),
        emissive: if pbr.emissive_texture.is_some() {
            Vec3::ZERO
        } else {
            (pbr.emissive * pbr.emissive_strength).min(Vec3::splat(f32::MAX))
        },
        base_color_texture: pbr.base_color_texture.map(|texture| texture.image),
        alpha_mode,
        pbr: Some(Box::new(pbr)),
        ..Material::default()
    }
}

fn shininess(roughness: f32) -> f32 {
    let squared = roughness * roughness;
    (2.0 / (squared * squared) - 2.0).clamp(1.0, SHARPEST)
}
