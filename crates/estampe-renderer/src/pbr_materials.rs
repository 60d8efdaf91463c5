//! Physically based materials, prepared for shaders.

use crate::frame::RenderError;
use crate::geometry::faces::normals_oppose_winding;
use crate::materials::{COLORS, Materials, NUMBERS};
use crate::options::Shading;
use crate::shading::pbr::parameters::{
    ClearcoatParameters, NormalMap, Occlusion, PbrParameters, SheenParameters, SpecularParameters,
};
use crate::shading::pbr::textures::{MaterialTexture, UvChoice};
use estampe::{AddressMode, FilterMode, SamplerDescriptor, TextureFormat};
use estampe_scene::{Material, Mesh, NormalTexture, PbrMaterial, TextureRef, TextureSampler};
use std::sync::Arc;

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
        let mut parameters = self.parameters(pbr, mesh)?;
        parameters.base[3] = material.opacity;
        if let (true, Some(image)) = (is_overridden, &self.options.texture) {
            let sampler = SamplerDescriptor::trilinear_repeat();
            parameters.base = [1.0; 4];
            parameters.base_texture = Some(MaterialTexture {
                texture: self.sampled(None, COLORS, image, &sampler)?,
                coordinates: UvChoice::FIRST,
            });
        }
        Ok(Some(Arc::new(parameters)))
    }

    fn parameters(&mut self, pbr: &PbrMaterial, mesh: &Mesh) -> Result<PbrParameters, RenderError> {
        let mut colors = |texture| self.material_texture(texture, COLORS, mesh);
        let base_texture = colors(pbr.base_color_texture)?;
        let emissive_texture = colors(pbr.emissive_texture)?;
        let specular = match &pbr.specular {
            Some(layer) => Some(SpecularParameters {
                factor: layer.factor,
                texture: self.material_texture(layer.texture, NUMBERS, mesh)?,
                color: layer.color.to_array(),
                color_texture: self.material_texture(layer.color_texture, COLORS, mesh)?,
            }),
            None => None,
        };
        let clearcoat = match &pbr.clearcoat {
            Some(coat) if coat.factor > 0.0 => Some(ClearcoatParameters {
                factor: coat.factor,
                texture: self.material_texture(coat.texture, NUMBERS, mesh)?,
                roughness: coat.roughness,
                roughness_texture: self.material_texture(coat.roughness_texture, NUMBERS, mesh)?,
                normal: self.normal_map(coat.normal_texture, mesh)?,
            }),
            _ => None,
        };
        let sheen = match &pbr.sheen {
            Some(sheen) if sheen.color != glam::Vec3::ZERO => Some(SheenParameters {
                color: sheen.color.to_array(),
                color_texture: self.material_texture(sheen.color_texture, COLORS, mesh)?,
                roughness: sheen.roughness,
                roughness_texture: self.material_texture(sheen.roughness_texture, NUMBERS, mesh)?,
            }),
            _ => None,
        };
        let occlusion = self.material_texture(pbr.occlusion_texture, NUMBERS, mesh)?;
        let reflected = (pbr.ior - 1.0) / (pbr.ior + 1.0);
        Ok(PbrParameters {
            base: pbr.base_color.to_array(),
            base_texture,
            metallic: pbr.metallic,
            roughness: pbr.roughness,
            metallic_roughness_texture: self.material_texture(
                pbr.metallic_roughness_texture,
                NUMBERS,
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
            is_unlit: pbr.is_unlit,
            alpha_cutoff: pbr.alpha_cutoff,
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
        let texture = self.material_texture(Some(texture), NUMBERS, mesh)?;
        Ok(texture.map(|texture| NormalMap { texture, scale }))
    }

    /// A texture of a material; none if the mesh has no coordinates for it.
    fn material_texture(
        &mut self,
        texture: Option<TextureRef>,
        format: TextureFormat,
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
            texture: self.sampled(Some(texture.image), format, image, &sampler)?,
            coordinates: UvChoice::new(texture.uv_set, &texture.transform),
        }))
    }
}

/// The textures of a material with their formats: colours, then numbers.
pub(crate) fn textures_of(pbr: &PbrMaterial) -> impl Iterator<Item = (TextureRef, TextureFormat)> {
    let colors = [
        pbr.base_color_texture,
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
    ];
    let colors = colors
        .into_iter()
        .flatten()
        .map(|texture| (texture, COLORS));
    colors.chain(
        numbers
            .into_iter()
            .flatten()
            .map(|texture| (texture, NUMBERS)),
    )
}

/// The images of a material with their formats.
pub(crate) fn images_of(pbr: &PbrMaterial) -> Vec<(usize, TextureFormat)> {
    textures_of(pbr)
        .map(|(texture, format)| (texture.image, format))
        .collect()
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
