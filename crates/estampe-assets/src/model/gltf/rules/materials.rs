//! Factors of materials within their ranges, names and numbers, and texture coordinates that meshes
//! lack.
//!
//! Validator: `VALUE_NOT_IN_RANGE`, `VALUE_NOT_IN_LIST`, `MESH_PRIMITIVE_TOO_FEW_TEXCOORDS`.

use super::super::document::{Document, Material, MaterialExtensions, Sampler, TextureInfo};
use super::Report;

/// Warns of factors that are clamped, and of textures that vertices have no coordinates for.
pub(super) fn check(document: &Document<'_>, report: &mut Report<'_, '_>) {
    for (at, material) in document.materials.iter().enumerate() {
        for_each_factor(material, |property, values, range| {
            let is_inside = |value: &f32| range.contains(*value);
            if !values.iter().all(is_inside) {
                report.warn(
                    || format!("/materials/{at}/{property}"),
                    || {
                        format!(
                            "a value is not {}; the nearest such value is used",
                            range.text()
                        )
                    },
                );
            }
        });
        if let Some(ior) = ior(material)
            && ior != 0.0
            && ior < 1.0
        {
            report.warn(
                || format!("/materials/{at}/extensions/KHR_materials_ior/ior"),
                || format!("{ior} is neither 0 nor at least 1; 1 is used"),
            );
        }
    }
    for (at, material) in document.materials.iter().enumerate() {
        if let Some(mode) = material.alpha_mode.as_deref()
            && !matches!(mode, "OPAQUE" | "MASK" | "BLEND")
        {
            report.warn(
                || format!("/materials/{at}/alphaMode"),
                || format!("`{mode}` is not one of OPAQUE, MASK and BLEND; OPAQUE is used"),
            );
        }
    }
    for (at, sampler) in document.samplers.iter().enumerate() {
        check_sampler(sampler, at, report);
    }
    texture_coordinates(document, report);
}

/// OpenGL's numbers of filters and address modes.
fn check_sampler(sampler: &Sampler, at: usize, report: &mut Report<'_, '_>) {
    const MAGNIFY: [usize; 2] = [9728, 9729];
    const MINIFY: [usize; 6] = [9728, 9729, 9984, 9985, 9986, 9987];
    const WRAP: [usize; 3] = [33071, 33648, 10497];
    for (property, value, known) in [
        ("magFilter", sampler.mag_filter, &MAGNIFY[..]),
        ("minFilter", sampler.min_filter, &MINIFY),
        ("wrapS", sampler.wrap_s, &WRAP),
        ("wrapT", sampler.wrap_t, &WRAP),
    ] {
        if let Some(value) = value
            && !known.contains(&value.0)
        {
            report.warn(
                || format!("/samplers/{at}/{property}"),
                || format!("{value} is not a value of this property; the default is used"),
            );
        }
    }
}

/// Sets of texture coordinates that are read.
const SETS: [&str; 2] = ["TEXCOORD_0", "TEXCOORD_1"];

fn texture_coordinates(document: &Document<'_>, report: &mut Report<'_, '_>) {
    let needed: Vec<[Option<&str>; 2]> = document.materials.iter().map(needed_sets).collect();
    for (at, mesh) in document.meshes.iter().enumerate() {
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let material = primitive.material.and_then(|index| needed.get(index.0));
            let needed = material.copied().unwrap_or_default();
            for (set, property) in SETS.into_iter().zip(needed) {
                if let Some(property) = property
                    && !primitive.attributes.contains_key(set)
                {
                    report.warn(
                        || format!("/meshes/{at}/primitives/{i}/attributes"),
                        || format!("{set} is missing, which {property} of the material needs"),
                    );
                }
            }
        }
    }
}

/// The first texture that needs each set of coordinates.
fn needed_sets(material: &Material) -> [Option<&'static str>; 2] {
    let mut needed = [None; 2];
    for_each_texture(material, |property, texture| {
        let transform = texture.extensions.transform.as_deref();
        let other = transform.and_then(|transform| transform.tex_coord);
        if let Some(set) = needed.get_mut(other.unwrap_or(texture.tex_coord).0) {
            set.get_or_insert(property);
        }
    });
    needed
}

/// Calls `visit` with each texture of a material and the property that has it.
pub(super) fn for_each_texture(
    material: &Material,
    mut visit: impl FnMut(&'static str, &TextureInfo),
) {
    macro_rules! visit {
        ($($texture:expr => $property:literal),* $(,)?) => {
            $(if let Some(texture) = &$texture { visit($property, texture); })*
        };
    }
    let base = &material.pbr_metallic_roughness;
    visit! {
        base.base_color_texture => "pbrMetallicRoughness/baseColorTexture",
        base.metallic_roughness_texture => "pbrMetallicRoughness/metallicRoughnessTexture",
        material.normal_texture => "normalTexture",
        material.occlusion_texture => "occlusionTexture",
        material.emissive_texture => "emissiveTexture",
    }
    let Some(extensions) = material.extensions.as_deref() else {
        return;
    };
    if let Some(layer) = &extensions.specular {
        visit! {
            layer.specular_texture => "extensions/KHR_materials_specular/specularTexture",
            layer.specular_color_texture => "extensions/KHR_materials_specular/specularColorTexture",
        }
    }
    if let Some(layer) = &extensions.transmission {
        visit! {
            layer.transmission_texture =>
                "extensions/KHR_materials_transmission/transmissionTexture",
        }
    }
    if let Some(layer) = &extensions.volume {
        visit! { layer.thickness_texture => "extensions/KHR_materials_volume/thicknessTexture" }
    }
    if let Some(layer) = &extensions.clearcoat {
        visit! {
            layer.clearcoat_texture => "extensions/KHR_materials_clearcoat/clearcoatTexture",
            layer.clearcoat_roughness_texture =>
                "extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture",
            layer.clearcoat_normal_texture =>
                "extensions/KHR_materials_clearcoat/clearcoatNormalTexture",
        }
    }
    if let Some(layer) = &extensions.sheen {
        visit! {
            layer.sheen_color_texture => "extensions/KHR_materials_sheen/sheenColorTexture",
            layer.sheen_roughness_texture => "extensions/KHR_materials_sheen/sheenRoughnessTexture",
        }
    }
    if let Some(layer) = &extensions.anisotropy {
        visit! {
            layer.anisotropy_texture => "extensions/KHR_materials_anisotropy/anisotropyTexture",
        }
    }
    if let Some(layer) = &extensions.iridescence {
        visit! {
            layer.iridescence_texture => "extensions/KHR_materials_iridescence/iridescenceTexture",
            layer.iridescence_thickness_texture =>
                "extensions/KHR_materials_iridescence/iridescenceThicknessTexture",
        }
    }
    if let Some(layer) = &extensions.specular_glossiness {
        visit! {
            layer.diffuse_texture => "extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture",
            layer.specular_glossiness_texture =>
                "extensions/KHR_materials_pbrSpecularGlossiness/specularGlossinessTexture",
        }
    }
}

/// The range of a factor.
#[derive(Debug, Clone, Copy)]
enum Range {
    Unit,
    NotNegative,
    Positive,
    AtLeastOne,
}

impl Range {
    fn contains(self, value: f32) -> bool {
        match self {
            Self::Unit => (0.0..=1.0).contains(&value),
            Self::NotNegative => value >= 0.0,
            Self::Positive => value > 0.0,
            Self::AtLeastOne => value >= 1.0,
        }
    }

    fn text(self) -> &'static str {
        match self {
            Self::Unit => "from 0 to 1",
            Self::NotNegative => "at least 0",
            Self::Positive => "above 0",
            Self::AtLeastOne => "at least 1",
        }
    }
}

/// Calls `visit` with each factor that the material states, its property and its range.
fn for_each_factor(material: &Material, mut visit: impl FnMut(&'static str, &[f32], Range)) {
    use Range::{NotNegative, Unit};
    let base = &material.pbr_metallic_roughness;
    let mut one = |property, value: Option<f32>, range| {
        if let Some(value) = value {
            visit(property, &[value], range);
        }
    };
    one("alphaCutoff", material.alpha_cutoff, NotNegative);
    one(
        "pbrMetallicRoughness/metallicFactor",
        base.metallic_factor,
        Unit,
    );
    one(
        "pbrMetallicRoughness/roughnessFactor",
        base.roughness_factor,
        Unit,
    );
    let occlusion = material.occlusion_texture.as_ref();
    let strength = occlusion.and_then(|texture| texture.strength);
    one("occlusionTexture/strength", strength, Unit);
    if let Some(color) = &base.base_color_factor {
        visit("pbrMetallicRoughness/baseColorFactor", color, Unit);
    }
    if let Some(color) = &material.emissive_factor {
        visit("emissiveFactor", color, Unit);
    }
    if let Some(extensions) = material.extensions.as_deref() {
        factors_of_layers(extensions, &mut visit);
        factors_of_body(extensions, &mut visit);
    }
}

/// The factors of layers on the surface.
fn factors_of_layers(
    extensions: &MaterialExtensions,
    visit: &mut impl FnMut(&'static str, &[f32], Range),
) {
    use Range::{AtLeastOne, NotNegative, Unit};
    let mut one = |property, value: Option<f32>, range| {
        if let Some(value) = value {
            visit(property, &[value], range);
        }
    };
    if let Some(layer) = &extensions.clearcoat {
        let at = "extensions/KHR_materials_clearcoat/clearcoatFactor";
        one(at, layer.clearcoat_factor, Unit);
        let at = "extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor";
        one(at, layer.clearcoat_roughness_factor, Unit);
    }
    if let Some(layer) = &extensions.anisotropy {
        let at = "extensions/KHR_materials_anisotropy/anisotropyStrength";
        one(at, layer.anisotropy_strength, Unit);
    }
    if let Some(layer) = &extensions.iridescence {
        let at = "extensions/KHR_materials_iridescence/iridescenceFactor";
        one(at, layer.iridescence_factor, Unit);
        let at = "extensions/KHR_materials_iridescence/iridescenceIor";
        one(at, layer.iridescence_ior, AtLeastOne);
        let at = "extensions/KHR_materials_iridescence/iridescenceThicknessMinimum";
        one(at, layer.iridescence_thickness_minimum, NotNegative);
        let at = "extensions/KHR_materials_iridescence/iridescenceThicknessMaximum";
        one(at, layer.iridescence_thickness_maximum, NotNegative);
    }
    if let Some(layer) = &extensions.emissive_strength {
        let at = "extensions/KHR_materials_emissive_strength/emissiveStrength";
        one(at, layer.emissive_strength, NotNegative);
    }
    if let Some(layer) = &extensions.specular {
        let at = "extensions/KHR_materials_specular/specularFactor";
        one(at, layer.specular_factor, Unit);
        if let Some(color) = &layer.specular_color_factor {
            let at = "extensions/KHR_materials_specular/specularColorFactor";
            visit(at, color, NotNegative);
        }
    }
    if let Some(layer) = &extensions.sheen {
        if let Some(color) = &layer.sheen_color_factor {
            visit(
                "extensions/KHR_materials_sheen/sheenColorFactor",
                color,
                Unit,
            );
        }
        if let Some(rough) = layer.sheen_roughness_factor {
            let at = "extensions/KHR_materials_sheen/sheenRoughnessFactor";
            visit(at, &[rough], Unit);
        }
    }
}

/// The factors of what light does below the surface, and of the older model.
fn factors_of_body(
    extensions: &MaterialExtensions,
    visit: &mut impl FnMut(&'static str, &[f32], Range),
) {
    use Range::{NotNegative, Positive, Unit};
    let mut one = |property, value: Option<f32>, range| {
        if let Some(value) = value {
            visit(property, &[value], range);
        }
    };
    if let Some(layer) = &extensions.transmission {
        let at = "extensions/KHR_materials_transmission/transmissionFactor";
        one(at, layer.transmission_factor, Unit);
    }
    if let Some(layer) = &extensions.dispersion {
        let at = "extensions/KHR_materials_dispersion/dispersion";
        one(at, layer.dispersion, NotNegative);
    }
    if let Some(layer) = &extensions.volume {
        let at = "extensions/KHR_materials_volume/thicknessFactor";
        one(at, layer.thickness_factor, NotNegative);
        let at = "extensions/KHR_materials_volume/attenuationDistance";
        one(at, layer.attenuation_distance, Positive);
        if let Some(color) = &layer.attenuation_color {
            visit(
                "extensions/KHR_materials_volume/attenuationColor",
                color,
                Unit,
            );
        }
    }
    if let Some(layer) = &extensions.specular_glossiness {
        let at = "extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor";
        if let Some(color) = &layer.diffuse_factor {
            visit(at, color, Unit);
        }
        let at = "extensions/KHR_materials_pbrSpecularGlossiness/specularFactor";
        if let Some(color) = &layer.specular_factor {
            visit(at, color, Unit);
        }
        let at = "extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor";
        if let Some(glossiness) = layer.glossiness_factor {
            visit(at, &[glossiness], Unit);
        }
    }
}

fn ior(material: &Material) -> Option<f32> {
    material.extensions.as_deref()?.ior.as_ref()?.ior
}
