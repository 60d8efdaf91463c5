//! Physically based materials, prepared for shaders.

use crate::behind::{alpha_of, is_transmissive};
use crate::geometry::faces::normals_oppose_winding;
use crate::materials::Texels::{Colors, Numbers};
use crate::materials::{Materials, Texels, TextureKey};
use crate::options::Shading;
use crate::render_error::RenderError;
use crate::shading::pbr::parameters::{
    AnisotropyParameters, ClearcoatParameters, IridescenceParameters, NormalMap, Occlusion,
    PbrParameters, SheenParameters, SpecularParameters,
};
use crate::shading::pbr::textures::{MaterialTexture, UvChoice};
use crate::shading::pbr::transmission::{TransmissionParameters, VolumeParameters};
use crate::transforms::round_to_f32;
use estampe::{AddressMode, FilterMode, SamplerDescriptor};
use estampe_scene::{
    AlphaMode, Material, Mesh, NormalTexture, PbrMaterial, TextureRef, TextureSampler, Volume,
};
use std::sync::Arc;

/// Below the cutoff: an alpha that equals it is kept, though interpolation of equal vertex colours
/// rounds by some 2⁻²⁴ of them. A step of eight bits is 2000 times as much.
const CUTOFF_ROUNDING: f32 = 2e-6;

impl Materials<'_> {
    /// True if the material says that the back of faces is invisible, and the mesh's winding can be
    /// relied on.
    pub(crate) fn is_single_sided(&self, material: &Material, mesh: &Mesh) -> bool {
        let is_pbr = self.options.shading == Shading::Pbr;
        let said = material
            .pbr
            .as_ref()
            .is_some_and(|pbr| !pbr.is_double_sided);
        is_pbr && said && !normals_oppose_winding(mesh)
    }

    /// The parameters of a surface that is drawn by [`Shading::Pbr`].
    pub(crate) fn physically_based(
        &mut self,
        material: &Material,
        mesh: &Mesh,
        is_overridden: bool,
    ) -> Result<Option<Arc<PbrParameters>>, RenderError> {
        if self.options.shading != Shading::Pbr {
            return Ok(None);
        }
        let made;
        let pbr = match &material.pbr {
            Some(pbr) => &**pbr,
            None => {
                made = of_phong(material);
                &made
            }
        };
        let base = Texels::of_alpha(alpha_of(material).0, pbr.alpha_cutoff);
        let mut parameters = self.parameters(pbr, base, mesh)?;
        parameters.base[3] = alpha_of(material).1;
        if let Some(color) = self.options.linear_color() {
            parameters.base = color.to_array();
            parameters.base_texture = None;
            parameters.transmission = None;
        }
        if let Some(roughness) = self.options.roughness {
            parameters.roughness = roughness.clamp(0.0, 1.0);
            parameters.is_roughness_textured = false;
        }
        if let Some(metallic) = self.options.metallic {
            parameters.metallic = metallic.clamp(0.0, 1.0);
            parameters.is_metallic_textured = false;
        }
        if let (true, Some(image)) = (is_overridden, &self.options.texture) {
            let sampler = SamplerDescriptor::trilinear_repeat();
            if self.options.color.is_none() {
                parameters.base = [1.0; 4];
            }
            parameters.transmission = None;
            parameters.base_texture = Some(MaterialTexture {
                texture: self.sampled(None, Colors, image, &sampler)?,
                coordinates: UvChoice::FIRST,
            });
        }
        Ok(Some(Arc::new(parameters)))
    }

    fn parameters(
        &mut self,
        pbr: &PbrMaterial,
        base: Texels,
        mesh: &Mesh,
    ) -> Result<PbrParameters, RenderError> {
        let base_texture = self.material_texture(pbr.base_color_texture, base, mesh)?;
        let emissive_texture = self.material_texture(pbr.emissive_texture, Colors, mesh)?;
        let specular = match &pbr.specular {
            Some(layer) => Some(SpecularParameters {
                factor: layer.factor,
                texture: self.material_texture(layer.texture, Numbers, mesh)?,
                color: layer.color.to_array(),
                color_texture: self.material_texture(layer.color_texture, Colors, mesh)?,
            }),
            None => None,
        };
        let clearcoat = match &pbr.clearcoat {
            Some(coat) if coat.factor > 0.0 => Some(ClearcoatParameters {
                factor: coat.factor,
                texture: self.material_texture(coat.texture, Numbers, mesh)?,
                roughness: coat.roughness,
                roughness_texture: self.material_texture(coat.roughness_texture, Numbers, mesh)?,
                normal: self.normal_map(coat.normal_texture, mesh)?,
            }),
            _ => None,
        };
        let sheen = match &pbr.sheen {
            Some(sheen) if sheen.color != glam::Vec3::ZERO => Some(SheenParameters {
                color: sheen.color.to_array(),
                color_texture: self.material_texture(sheen.color_texture, Colors, mesh)?,
                roughness: sheen.roughness,
                roughness_texture: self.material_texture(sheen.roughness_texture, Numbers, mesh)?,
            }),
            _ => None,
        };
        let anisotropy = match &pbr.anisotropy {
            Some(layer) if layer.strength > 0.0 => {
                let (sin, cos) = libm::sincosf(layer.rotation_rad);
                Some(AnisotropyParameters {
                    strength: layer.strength,
                    rotation: [cos, sin],
                    texture: self.material_texture(layer.texture, Numbers, mesh)?,
                })
            }
            _ => None,
        };
        let iridescence = match &pbr.iridescence {
            Some(film) if film.factor > 0.0 => Some(IridescenceParameters {
                factor: film.factor,
                texture: self.material_texture(film.texture, Numbers, mesh)?,
                ior: film.ior,
                thickness_nm: [film.thickness_min_nm, film.thickness_max_nm].map(film_thickness),
                thickness_texture: self.material_texture(film.thickness_texture, Numbers, mesh)?,
            }),
            _ => None,
        };
        let transmission = self.transmission(pbr, mesh)?;
        let occlusion = self.material_texture(pbr.occlusion_texture, Numbers, mesh)?;
        let reflected = (pbr.ior - 1.0) / (pbr.ior + 1.0);
        Ok(PbrParameters {
            base: pbr.base_color.to_array(),
            base_texture,
            metallic: pbr.metallic,
            roughness: pbr.roughness,
            is_metallic_textured: true,
            is_roughness_textured: true,
            metallic_roughness_texture: self.material_texture(
                pbr.metallic_roughness_texture,
                Numbers,
                mesh,
            )?,
            normal: self.normal_map(pbr.normal_texture, mesh)?,
            occlusion: occlusion.map(|texture| Occlusion {
                texture,
                strength: pbr.occlusion_strength,
            }),
            emissive: (pbr.emissive * pbr.emissive_strength).to_array(),
            emissive_texture,
            dielectric_f0: reflected * reflected,
            specular,
            clearcoat,
            sheen,
            anisotropy,
            iridescence,
            transmission,
            is_unlit: pbr.is_unlit,
            alpha_cutoff: pbr.alpha_cutoff - CUTOFF_ROUNDING,
        })
    }

    fn transmission(
        &mut self,
        pbr: &PbrMaterial,
        mesh: &Mesh,
    ) -> Result<Option<TransmissionParameters>, RenderError> {
        let Some(layer) = pbr.transmission.filter(|_| is_transmissive(pbr)) else {
            return Ok(None);
        };
        let volume = match &pbr.volume {
            Some(volume) if volume.thickness > 0.0 => Some(VolumeParameters {
                thickness: self.in_view_space(volume.thickness, mesh),
                texture: self.material_texture(volume.thickness_texture, Numbers, mesh)?,
                absorption: self.absorption(volume),
            }),
            _ => None,
        };
        // An index of 0 stands for total reflection, so nothing passes.
        let ior = pbr.ior.clamp(1.0, 1e6);
        // Thin surfaces refract nothing.
        let dispersion = pbr.dispersion.clamp(0.0, 1e6);
        let spread = if volume.is_some() && dispersion > 0.0 {
            (ior - 1.0) * 0.025 * dispersion
        } else {
            0.0
        };
        Ok(Some(TransmissionParameters {
            factor: layer.factor,
            texture: self.material_texture(layer.texture, Numbers, mesh)?,
            iors: [(ior - spread).max(1.0), ior, ior + spread],
            volume,
        }))
    }

    /// A length of the mesh's space in view space.
    fn in_view_space(&self, length: f32, mesh: &Mesh) -> f32 {
        let length_world = f64::from(length) * f64::from(mesh.scale.unwrap_or(1.0));
        let length = round_to_f32(length_world / self.world_per_unit);
        finite(length)
    }

    /// Halvings of light per length in view space: of white light, the attenuation colour is left
    /// after the attenuation distance.
    fn absorption(&self, volume: &Volume) -> [f32; 3] {
        /// A channel that is less is as good as black.
        const DARKEST: f64 = 1e-6;
        let distance = f64::from(volume.attenuation_distance) / self.world_per_unit;
        volume.attenuation_color.to_array().map(|channel| {
            let left = f64::from(channel).clamp(DARKEST, 1.0);
            let halvings = -libm::log2(left) / distance.max(f64::MIN_POSITIVE);
            finite(round_to_f32(halvings))
        })
    }

    fn normal_map(
        &mut self,
        normals: Option<NormalTexture>,
        mesh: &Mesh,
    ) -> Result<Option<NormalMap>, RenderError> {
        let Some(NormalTexture { texture, scale }) = normals else {
            return Ok(None);
        };
        let texture = self.material_texture(Some(texture), Numbers, mesh)?;
        Ok(texture.map(|texture| NormalMap { texture, scale }))
    }

    /// A texture of a material; none if the mesh has no coordinates for it.
    fn material_texture(
        &mut self,
        texture: Option<TextureRef>,
        texels: Texels,
        mesh: &Mesh,
    ) -> Result<Option<MaterialTexture>, RenderError> {
        let Some(texture) = texture else {
            return Ok(None);
        };
        let has_coordinates = match texture.uv_set {
            1 => mesh.attribute(Mesh::UV1).is_some(),
            _ => !mesh.uvs.is_empty(),
        };
        let Some(image) = self.scene.images.get(texture.image) else {
            return Ok(None);
        };
        if !has_coordinates {
            return Ok(None);
        }
        let sampler = sampler(texture.sampler);
        Ok(Some(MaterialTexture {
            texture: self.sampled(Some(texture.image), texels, image, &sampler)?,
            coordinates: UvChoice::new(texture.uv_set, &texture.transform),
        }))
    }
}

/// The textures of a material with what their texels are, base colours as `base`: colours, then
/// numbers.
pub(crate) fn textures_of(
    pbr: &PbrMaterial,
    base: Texels,
) -> impl Iterator<Item = (TextureRef, Texels)> {
    let colors = [
        pbr.emissive_texture,
        pbr.specular.and_then(|layer| layer.color_texture),
        pbr.sheen.and_then(|sheen| sheen.color_texture),
    ];
    let normal = |normals: Option<NormalTexture>| normals.map(|normals| normals.texture);
    let numbers = [
        normal(pbr.normal_texture),
        pbr.metallic_roughness_texture,
        pbr.occlusion_texture,
        pbr.specular.and_then(|layer| layer.texture),
        pbr.sheen.and_then(|sheen| sheen.roughness_texture),
        pbr.clearcoat.and_then(|coat| coat.texture),
        pbr.clearcoat.and_then(|coat| coat.roughness_texture),
        pbr.clearcoat.and_then(|coat| normal(coat.normal_texture)),
        pbr.anisotropy.and_then(|layer| layer.texture),
        pbr.iridescence.and_then(|film| film.texture),
        pbr.iridescence.and_then(|film| film.thickness_texture),
        pbr.transmission.and_then(|layer| layer.texture),
        pbr.volume.and_then(|volume| volume.thickness_texture),
    ];
    let of = |texels| move |texture: Option<TextureRef>| Some((texture?, texels));
    let colors = colors.into_iter().filter_map(of(Colors));
    let numbers = numbers.into_iter().filter_map(of(Numbers));
    let base = of(base)(pbr.base_color_texture);
    base.into_iter().chain(colors).chain(numbers)
}

/// The images of a material with what their texels are: colours, then numbers.
pub(crate) fn images_of(pbr: &PbrMaterial, mode: AlphaMode) -> Vec<TextureKey> {
    textures_of(pbr, Texels::of_alpha(mode, pbr.alpha_cutoff))
        .map(|(texture, texels)| (texture.image, texels))
        .collect()
}

/// A thickness beyond which a film shows no colours, at most.
fn film_thickness(nanometres: f32) -> f32 {
    finite(nanometres).min(1e5)
}

/// The number, 0 instead of negative ones and of NaN, and the greatest instead of ∞.
fn finite(number: f32) -> f32 {
    if number > 0.0 {
        number.min(f32::MAX)
    } else {
        0.0
    }
}

/// A dielectric of the material's colours, whose highlight is as wide as that of the exponent: α =
/// √(2 ÷ (e + 2)).
fn of_phong(material: &Material) -> PbrMaterial {
    let alpha_squared = 2.0 / (material.shininess.max(0.0) + 2.0);
    PbrMaterial {
        base_color: material.base_color.extend(material.opacity),
        base_color_texture: material.base_color_texture.map(TextureRef::new),
        metallic: 0.0,
        roughness: alpha_squared.sqrt().sqrt(),
        emissive: material.emissive,
        is_double_sided: true,
        ..PbrMaterial::default()
    }
}

/// The device's form of a sampler. Mip levels are used even if the file wants none: a picture has
/// no second frame, so texels that flicker would stay.
fn sampler(of: TextureSampler) -> SamplerDescriptor {
    let address = |mode| match mode {
        estampe_scene::AddressMode::Repeat => AddressMode::Repeat,
        estampe_scene::AddressMode::MirrorRepeat => AddressMode::MirrorRepeat,
        estampe_scene::AddressMode::ClampToEdge => AddressMode::ClampToEdge,
    };
    let filter = |filter| match filter {
        estampe_scene::TextureFilter::Nearest => FilterMode::Nearest,
        estampe_scene::TextureFilter::Linear => FilterMode::Linear,
    };
    SamplerDescriptor {
        address_mode_u: address(of.wrap_u),
        address_mode_v: address(of.wrap_v),
        mag_filter: filter(of.magnify),
        min_filter: filter(of.minify),
        ..SamplerDescriptor::trilinear_repeat()
    }
}
