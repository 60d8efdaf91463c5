//! A scene's materials, prepared for shaders; textures are created when a surface first needs them.

use crate::frame::RenderError;
use crate::options::{RenderOptions, Shading};
use crate::shading::lighting::Gloss;
use crate::surface_pipelines::{SurfaceStyle, Transparency};
use estampe::{Device, SampledTexture, SamplerDescriptor, TextureDescriptor, TextureFormat};
use estampe_scene::{AlphaMode, Image, Material, Mesh, Scene};
use std::collections::HashMap;

/// Creates the styles of surfaces from materials.
pub(crate) struct Materials<'a> {
    scene: &'a Scene,
    options: &'a RenderOptions,
    device: &'a Device,
    /// Textures by index into the scene's images; `None` is the texture of the options.
    textures: HashMap<Option<usize>, SampledTexture>,
}

impl<'a> Materials<'a> {
    pub(crate) fn new(scene: &'a Scene, options: &'a RenderOptions, device: &'a Device) -> Self {
        Self {
            scene,
            options,
            device,
            textures: HashMap::new(),
        }
    }

    /// The style of a surface of `mesh` with this material.
    pub(crate) fn style(
        &mut self,
        material: Option<usize>,
        mesh: &Mesh,
    ) -> Result<SurfaceStyle, RenderError> {
        let own = material.and_then(|index| self.scene.materials.get(index));
        let default = Material::default();
        let material = own.unwrap_or(&default);
        let has_vertex_colors = !mesh.colors.is_empty();
        let is_overridden = self.options.texture.is_some() && !mesh.uvs.is_empty();
        // A texture of the options, or vertex colours without a material, replace the default grey.
        let is_painted = is_overridden || own.is_none() && has_vertex_colors;
        let color = if is_painted {
            glam::Vec3::ONE
        } else {
            self.visible(material.base_color)
        };
        let transparency = match material.alpha_mode {
            _ if is_overridden => Transparency::Opaque,
            AlphaMode::Opaque => Transparency::Opaque,
            AlphaMode::Mask => Transparency::Masked,
            AlphaMode::Blend => Transparency::Blended,
        };
        let texture = if self.reads_textures() {
            self.texture(material, mesh)?
        } else {
            None
        };
        Ok(SurfaceStyle {
            gloss: Gloss {
                specular: material.specular.to_array(),
                shininess: whole_exponent(material.shininess),
                emissive: material.emissive.to_array(),
            },
            base: [color.x, color.y, color.z, material.opacity],
            texture,
            has_vertex_colors,
            transparency,
        })
    }

    /// The colour, at least `DARKEST` per channel: a surface that reflects no light shows no shape,
    /// and exporters often write black for an unset colour.
    fn visible(&self, color: glam::Vec3) -> glam::Vec3 {
        const DARKEST: f32 = 0.03;
        match self.options.shading {
            Shading::Unlit => color,
            _ => color.max(glam::Vec3::splat(DARKEST)),
        }
    }

    fn reads_textures(&self) -> bool {
        !self.options.shading.holds_numbers() && self.options.shading != Shading::Wireframe
    }

    /// The texture of a surface: that of the options, else the material's.
    fn texture(
        &mut self,
        material: &Material,
        mesh: &Mesh,
    ) -> Result<Option<SampledTexture>, RenderError> {
        if mesh.uvs.is_empty() {
            return Ok(None);
        }
        let scene = self.scene;
        let (key, image) = match (&self.options.texture, material.base_color_texture) {
            (Some(image), _) => (None, image),
            (None, Some(index)) => match scene.images.get(index) {
                Some(image) => (Some(index), image),
                None => return Ok(None),
            },
            (None, None) => return Ok(None),
        };
        if let Some(texture) = self.textures.get(&key) {
            return Ok(Some(texture.clone()));
        }
        let texture = self.create(image)?;
        self.textures.insert(key, texture.clone());
        Ok(Some(texture))
    }

    fn create(&self, image: &Image) -> Result<SampledTexture, RenderError> {
        let format = TextureFormat::Rgba8UnormSrgb;
        let descriptor = TextureDescriptor::new_2d(image.width, image.height, format);
        let texture = self
            .device
            .create_texture_with_data(&descriptor.with_all_levels(), &[&image.rgba])?;
        let sampler = SamplerDescriptor::trilinear_repeat();
        let sampler = self.device.create_sampler(&sampler)?;
        Ok(self.device.sampled_texture(&texture.view(), &sampler)?)
    }
}

/// The nearest whole exponent, at least 1; readers keep exponents below 10,000.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to 1..=10,000"
)]
fn whole_exponent(shininess: f32) -> u32 {
    libm::roundf(shininess.clamp(1.0, 10_000.0)) as u32
}
