//! A scene's materials, prepared for shaders; textures are created when a surface first needs them.

use crate::alpha_levels::{self, has_alpha};
use crate::behind::alpha_of;
use crate::options::{RenderOptions, Shading, SpecularModel};
use crate::pbr_materials::images_of;
use crate::render_error::RenderError;
use crate::scene_view::SceneView;
use crate::shading::bump::BumpMap;
use crate::shading::lighting::{Gloss, Highlight};
use crate::surface_pipelines::{SurfaceAlpha, SurfaceStyle};
use estampe::{
    Device, SampledTexture, SamplerDescriptor, Texture, TextureDescriptor, TextureError,
    TextureFormat, srgb,
};
use estampe_scene::{AlphaMode, Image, Material, Mesh, Scene, Workers};
use std::collections::hash_map::Entry;
use std::collections::{BTreeSet, HashMap};

/// Creates the styles of surfaces from materials.
pub(crate) struct Materials<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) options: &'a RenderOptions,
    device: &'a Device,
    /// The length in world units of a unit of view space.
    pub(crate) world_per_unit: f64,
    /// Textures by index into the scene's images (`None` is the texture of the options), and what
    /// their texels are.
    textures: HashMap<(Option<usize>, Texels), Texture>,
}

/// What the texels of an image are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Texels {
    /// Colours; alpha is ignored.
    Colors,
    /// Colours whose alpha is their coverage.
    Covering,
    /// Colours that are cut out where the code of alpha is less.
    CutOut(u8),
    /// Heights, normals and other numbers.
    Numbers,
}

impl Texels {
    /// Of base colours.
    pub(crate) fn of_alpha(mode: AlphaMode, cutoff: f32) -> Self {
        match mode {
            AlphaMode::Opaque => Self::Colors,
            AlphaMode::Blend => Self::Covering,
            AlphaMode::Mask => Self::CutOut(code(cutoff)),
        }
    }

    fn format(self) -> TextureFormat {
        match self {
            Self::Colors | Self::Covering | Self::CutOut(_) => TextureFormat::Rgba8UnormSrgb,
            Self::Numbers => TextureFormat::Rgba8Unorm,
        }
    }
}

/// The index of an image, and what its texels are.
pub(crate) type TextureKey = (usize, Texels);

impl<'a> Materials<'a> {
    pub(crate) fn new(
        scene: &'a Scene,
        options: &'a RenderOptions,
        view: &SceneView,
        device: &'a Device,
    ) -> Self {
        Self {
            scene,
            options,
            device,
            world_per_unit: view.space.world_per_unit(),
            textures: HashMap::new(),
        }
    }

    /// The textures of all surfaces, which can be [created](Self::create) by several threads: the
    /// index of each image with its texels, the largest images first. None if there is one thread:
    /// a texture is created as fast when it is first needed.
    pub(crate) fn missing_textures<'m>(
        &self,
        meshes: impl Iterator<Item = &'m Mesh>,
        workers: Workers,
    ) -> Vec<TextureKey> {
        let scene = self.scene;
        if workers.count() < 2 {
            return Vec::new();
        }
        let with_uvs = meshes.filter(|mesh| !mesh.uvs.is_empty());
        let used = with_uvs.flat_map(|mesh| &mesh.surfaces);
        let used: BTreeSet<usize> = used.filter_map(|surface| surface.material).collect();
        let materials = used.into_iter().filter_map(|at| scene.materials.get(at));
        let mut keys = Vec::new();
        for material in materials {
            for key in self.images_of(material) {
                if !keys.contains(&key) && key.0 < scene.images.len() {
                    keys.push(key);
                }
            }
        }
        keys.sort_by_key(|&(index, _)| std::cmp::Reverse(scene.images[index].rgba.len()));
        keys
    }

    /// Creates one of the [missing textures](Self::missing_textures) with its mip levels.
    pub(crate) fn create(&self, (index, texels): TextureKey) -> Result<Texture, TextureError> {
        with_levels(self.device, texels, &self.scene.images[index])
    }

    /// Keeps a texture that was [created](Self::create).
    pub(crate) fn keep(&mut self, (index, texels): TextureKey, texture: Texture) {
        self.textures.insert((Some(index), texels), texture);
    }

    /// The images that surfaces of a material sample, with what their texels are.
    fn images_of(&self, material: &Material) -> Vec<TextureKey> {
        if !self.reads_textures() || self.options.texture.is_some() {
            return Vec::new();
        }
        match &material.pbr {
            Some(pbr) if self.options.shading == Shading::Pbr => {
                images_of(pbr, alpha_of(material).0)
            }
            _ => {
                let colors = Texels::of_alpha(material.alpha_mode, CUTOFF);
                let color = material.base_color_texture.map(|index| (index, colors));
                let bump = material.bump_texture.map(|index| (index, Texels::Numbers));
                color.into_iter().chain(bump).collect()
            }
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
        let has_vertex_colors = !mesh.colors.is_empty() && self.options.color.is_none();
        let is_overridden = self.options.texture.is_some() && !mesh.uvs.is_empty();
        // A texture of the options, or vertex colours without a material, replace the default grey.
        let is_painted = is_overridden || own.is_none() && has_vertex_colors;
        let color = if let Some(color) = self.options.linear_color() {
            self.visible(color.truncate())
        } else if is_painted {
            glam::Vec3::ONE
        } else {
            self.visible(material.base_color)
        };
        let (alpha_mode, opacity) = match self.options.shading {
            Shading::Pbr => alpha_of(material),
            _ => (material.alpha_mode, material.opacity),
        };
        let alpha = match alpha_mode {
            _ if self.options.is_clear() => SurfaceAlpha::Blended,
            _ if is_overridden || self.options.color.is_some() => SurfaceAlpha::Opaque,
            AlphaMode::Opaque => SurfaceAlpha::Opaque,
            AlphaMode::Mask => SurfaceAlpha::Masked,
            AlphaMode::Blend => SurfaceAlpha::Blended,
        };
        // Faces are numbered where they are not cut out.
        let is_cut_out = alpha == SurfaceAlpha::Masked && self.options.shading == Shading::FaceId;
        let texture = if self.reads_textures() || is_cut_out {
            self.texture(material, mesh)?
        } else {
            None
        };
        let opacity = { self.options.linear_color() }.map_or(opacity, |color| color.w);
        Ok(SurfaceStyle {
            gloss: self.gloss(material),
            base: [color.x, color.y, color.z, opacity],
            texture,
            bump: self.bump(material, mesh)?,
            has_vertex_colors,
            alpha,
            is_single_sided: self.is_single_sided(material, mesh),
            pbr: self.physically_based(material, mesh, is_overridden)?,
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

    /// Reflection and emission: the options', else the material's.
    fn gloss(&self, material: &Material) -> Gloss {
        let options = self.options;
        let strength = options.specular.strength.map(|strength| [strength; 3]);
        let specular = strength.unwrap_or(material.specular.to_array());
        let exponent = options.shininess.map(|exponent| exponent.clamp(1, 10_000));
        Gloss {
            specular: match options.specular.model {
                SpecularModel::None => [0.0; 3],
                SpecularModel::Phong | SpecularModel::Blinn => specular,
            },
            shininess: exponent.unwrap_or_else(|| whole_exponent(material.shininess)),
            emissive: material.emissive.to_array(),
            highlight: match options.specular.model {
                SpecularModel::Blinn => Highlight::HalfVector,
                SpecularModel::None | SpecularModel::Phong => Highlight::Reflection,
            },
        }
    }

    /// The bump map of a surface, where light is computed at fragments.
    fn bump(&mut self, material: &Material, mesh: &Mesh) -> Result<Option<BumpMap>, RenderError> {
        let bends_normals = matches!(self.options.shading, Shading::Phong | Shading::Toon);
        let Some(index) = material.bump_texture else {
            return Ok(None);
        };
        let Some(image) = self.scene.images.get(index) else {
            return Ok(None);
        };
        if !bends_normals || mesh.uvs.is_empty() {
            return Ok(None);
        }
        Ok(Some(BumpMap {
            texture: self.shared(Some(index), Texels::Numbers, image)?,
            height: material.bump_scale * BumpMap::UNIT_HEIGHT,
        }))
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
        let own = material.base_color_texture;
        let own = own.filter(|_| self.options.color.is_none());
        let (key, image) = match (&self.options.texture, own) {
            (Some(image), _) => (None, image),
            (None, Some(index)) => match scene.images.get(index) {
                Some(image) => (Some(index), image),
                None => return Ok(None),
            },
            (None, None) => return Ok(None),
        };
        let texels = match key {
            Some(_) => Texels::of_alpha(material.alpha_mode, CUTOFF),
            None => Texels::Colors,
        };
        self.shared(key, texels, image).map(Some)
    }

    /// The texture of an image, repeated and filtered.
    fn shared(
        &mut self,
        key: Option<usize>,
        texels: Texels,
        image: &Image,
    ) -> Result<SampledTexture, RenderError> {
        let sampler = SamplerDescriptor::trilinear_repeat();
        self.sampled(key, texels, image, &sampler)
    }

    /// The texture of an image, which is created once for each kind of texels, with a sampler.
    pub(crate) fn sampled(
        &mut self,
        key: Option<usize>,
        texels: Texels,
        image: &Image,
        sampler: &SamplerDescriptor,
    ) -> Result<SampledTexture, RenderError> {
        let texture = match self.textures.entry((key, texels)) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(unknown) => unknown.insert(with_levels(self.device, texels, image)?),
        };
        let sampler = self.device.create_sampler(sampler)?;
        Ok(self.device.sampled_texture(&texture.view(), &sampler)?)
    }
}

impl RenderOptions {
    /// The base colour of everything: linear RGB, and alpha.
    pub(crate) fn linear_color(&self) -> Option<glam::Vec4> {
        let [r, g, b, alpha] = self.color?;
        let rgb = [r, g, b].map(srgb::decode);
        Some(glam::Vec3::from(rgb).extend(f32::from(alpha) / 255.0))
    }

    /// True if the base colour of everything is transparent.
    pub(crate) fn is_clear(&self) -> bool {
        self.color.is_some_and(|[.., alpha]| alpha < 255)
    }
}

/// The texture of an image with its mip levels.
fn with_levels(device: &Device, texels: Texels, image: &Image) -> Result<Texture, TextureError> {
    let descriptor = TextureDescriptor::new_2d(image.width, image.height, texels.format());
    let descriptor = descriptor.with_all_levels();
    let cutoff = match texels {
        Texels::Covering => None,
        Texels::CutOut(cutoff) => Some(cutoff),
        Texels::Colors | Texels::Numbers => {
            return device.create_texture_with_data(&descriptor, &[&image.rgba]);
        }
    };
    if !has_alpha(image) {
        return device.create_texture_with_data(&descriptor, &[&image.rgba]);
    }
    let levels = alpha_levels::levels(image, cutoff);
    let bytes: Vec<&[u8]> = levels.iter().map(Vec::as_slice).collect();
    device.create_texture_with_data(&descriptor, &bytes)
}

/// The cutoff of materials without one.
const CUTOFF: f32 = 0.5;

/// The least code that is not below a cutoff.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to 0..=255"
)]
fn code(cutoff: f32) -> u8 {
    libm::ceilf(cutoff.clamp(0.0, 1.0) * 255.0) as u8
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
