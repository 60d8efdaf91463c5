//! Lookups of the light from all around (`environment` of the crate).

use crate::environment::{ALBEDO_SIDE, EnvironmentMap, directional_albedos};
use crate::shading::lighting::luminance;
use crate::shading::shadow::Visibilities;
use estampe::{
    AddressMode, Device, Mat4, Real, SampledTexture, SamplerDescriptor, TextureDescriptor,
    TextureError, TextureFormat, TextureViewDescriptor, Vec2, Vec3, ViewDimension,
};

/// Light from all around, as shaders read it.
#[derive(Debug, Clone)]
pub struct EnvironmentLight {
    /// Radiance by direction, a level for each roughness.
    pub specular: SampledTexture,
    /// The level of roughness 1.
    pub roughest_level: f32,
    /// Coefficients of irradiance ÷ π.
    pub diffuse: [[f32; 3]; 9],
    /// From view space to that of the map; a rotation.
    pub map_from_view: Mat4,
    /// Reflected shares, by n·v and roughness.
    pub albedos: SampledTexture,
    /// What casts a shadow, if something does.
    pub key: Option<KeyLight>,
}

/// The part of the light that comes from about one direction: parallel light with the same vector
/// irradiance (the linear coefficients of the spherical harmonics).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KeyLight {
    /// Unit direction towards it, in view space.
    pub towards_view: [f32; 3],
    /// Irradiance ÷ π of a surface that faces it.
    pub color: [f32; 3],
    /// The number of its shadow map.
    pub shadow_map: usize,
}

/// The light from all around where a key light is in shadow.
#[derive(Debug, Clone, Copy)]
pub struct Shaded<R> {
    /// The share of the key light that does not arrive.
    hidden: R,
    key: KeyLight,
}

/// Shares of the light of uniform surroundings that lobes reflect.
#[derive(Debug, Clone, Copy)]
pub struct DirectionalAlbedo<R> {
    /// Of GGX, times F0.
    pub scale: R,
    /// Of GGX, times F90.
    pub bias: R,
    /// Of a sheen.
    pub sheen: R,
}

impl EnvironmentLight {
    /// The textures of a map whose radiance is multiplied by `intensity`.
    pub fn new(
        device: &Device,
        map: &EnvironmentMap,
        map_from_view: Mat4,
        intensity: f32,
    ) -> Result<Self, TextureError> {
        let levels = map.specular_texels(intensity);
        let side = levels.first().map_or(1, |(side, _)| *side);
        let level_count = u8::try_from(levels.len()).unwrap_or(u8::MAX);
        let mut descriptor = TextureDescriptor::new_2d(side, side, TextureFormat::Rgba32Float);
        descriptor.size.depth_or_array_layers = 6;
        descriptor.mip_level_count = u32::from(level_count);
        let bytes: Vec<&[u8]> = levels.iter().map(|(_, bytes)| &bytes[..]).collect();
        let cube = device.create_texture_with_data(&descriptor, &bytes)?;
        let view = cube.create_view(&TextureViewDescriptor {
            dimension: Some(ViewDimension::Cube),
            ..TextureViewDescriptor::default()
        })?;
        let trilinear = device.create_sampler(&SamplerDescriptor::trilinear_repeat())?;
        let diffuse = map.diffuse().map(|c| c.map(|channel| channel * intensity));
        Ok(Self {
            specular: device.sampled_texture(&view, &trilinear)?,
            roughest_level: f32::from(level_count.max(1) - 1),
            diffuse,
            map_from_view,
            albedos: albedo_texture(device)?,
            key: None,
        })
    }

    /// The direction of the key light in the map's space, and the light that it gives to a surface
    /// that faces it: irradiance ÷ π. `None` if all directions are as bright as the opposite ones.
    ///
    /// Parallel light of irradiance C has the linear coefficients C/2 times its direction.
    pub fn brightest(&self) -> Option<(glam::Vec3, [f32; 3])> {
        /// The least share of the light that is worth a shadow.
        const LEAST: f32 = 0.02;
        let [constant, x, y, z, ..] = self.diffuse;
        let vector = glam::Vec3::new(luminance(x), luminance(y), luminance(z));
        if vector.length() <= LEAST * luminance(constant) {
            return None;
        }
        let direction = vector.normalize();
        let color = std::array::from_fn(|c| {
            let along = glam::Vec3::new(x[c], y[c], z[c]).dot(direction);
            (2.0 * along).max(0.0)
        });
        Some((direction, color))
    }

    /// Says which part casts a shadow.
    pub fn set_key(&mut self, key: KeyLight) {
        self.key = Some(key);
    }

    /// What is in shadow at a point, if something casts one.
    #[inline(always)]
    pub fn shaded<R: Real>(&self, visibilities: &Visibilities<R>) -> Option<Shaded<R>> {
        let key = self.key?;
        let visible = visibilities.of(Some(key.shadow_map))?;
        Some(Shaded {
            hidden: 1.0 - visible,
            key,
        })
    }

    /// The shares that lobes of a roughness reflect.
    #[inline(always)]
    pub fn albedo<R: Real>(&self, n_dot_v: R, roughness: R) -> DirectionalAlbedo<R> {
        let side = f32::from(ALBEDO_SIDE);
        // The first and the last entry are 0 and 1.
        let (scale, offset) = ((side - 1.0) / side, 0.5 / side);
        let at = Vec2::new(n_dot_v * scale + offset, roughness * scale + offset);
        let zero = n_dot_v.splat(0.0);
        let entry = self.albedos.sample_level(at, zero);
        DirectionalAlbedo {
            scale: entry.x,
            bias: entry.y,
            sheen: entry.z,
        }
    }

    /// The mean radiance in the lobe of a roughness around a direction in view space.
    #[inline(always)]
    pub fn radiance<R: Real>(&self, direction_view: Vec3<R>, roughness: R) -> Vec3<R> {
        let direction = self.map_from_view.transform_vector(direction_view);
        let level = roughness * self.roughest_level;
        self.specular.sample_level(direction, level).xyz()
    }

    /// The irradiance ÷ π of a unit normal in view space.
    #[inline(always)]
    pub fn irradiance<R: Real>(&self, normal_view: Vec3<R>) -> Vec3<R> {
        let n = self.map_from_view.transform_vector(normal_view);
        let values = [
            n.x,
            n.y,
            n.z,
            n.x * n.y,
            n.y * n.z,
            n.z * n.x,
            n.z * n.z * 3.0 - 1.0,
            n.x * n.x - n.y * n.y,
        ];
        let mut sum = Vec3::uniform(n.x, self.diffuse[0]);
        for (index, &value) in values.iter().enumerate() {
            sum += Vec3::uniform(n.x, self.diffuse[index + 1]) * value;
        }
        let zero = n.x.splat(0.0);
        Vec3::new(sum.x.max(zero), sum.y.max(zero), sum.z.max(zero))
    }
}

impl<R: Real> Shaded<R> {
    /// The irradiance without what is hidden of the key light.
    #[inline(always)]
    pub fn irradiance(&self, whole: Vec3<R>, normal_view: Vec3<R>) -> Vec3<R> {
        let zero = self.hidden.splat(0.0);
        let lit = normal_view.dot_uniform(self.key.towards_view).max(zero);
        let rest = whole - Vec3::uniform(zero, self.key.color) * (lit * self.hidden);
        Vec3::new(rest.x.max(zero), rest.y.max(zero), rest.z.max(zero))
    }

    /// The share of the light around a direction that remains, given the irradiance of a surface
    /// that faces there.
    #[inline(always)]
    pub fn mirrored(&self, irradiance: Vec3<R>, direction_view: Vec3<R>) -> R {
        const LEAST: f32 = 1e-6;
        let rest = self.irradiance(irradiance, direction_view);
        let one = self.hidden.splat(1.0);
        let weights = [0.2126, 0.7152, 0.0722];
        ((rest.dot_uniform(weights) + LEAST) / (irradiance.dot_uniform(weights) + LEAST)).min(one)
    }
}

/// The table of directional albedos as a texture.
fn albedo_texture(device: &Device) -> Result<SampledTexture, TextureError> {
    let side = u32::from(ALBEDO_SIDE);
    let bytes: Vec<u8> = directional_albedos()
        .iter()
        .flatten()
        .flat_map(|number| number.to_le_bytes())
        .collect();
    let descriptor = TextureDescriptor::new_2d(side, side, TextureFormat::Rgba32Float);
    let texture = device.create_texture_with_data(&descriptor, &[&bytes])?;
    let sampler = device.create_sampler(&SamplerDescriptor {
        address_mode_u: AddressMode::ClampToEdge,
        address_mode_v: AddressMode::ClampToEdge,
        ..SamplerDescriptor::linear()
    })?;
    device.sampled_texture(&texture.view(), &sampler)
}
