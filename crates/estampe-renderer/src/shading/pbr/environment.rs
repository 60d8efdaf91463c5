//! Lookups of the light from all around ([`crate::environment`]).

use crate::environment::{ALBEDO_SIDE, EnvironmentMap, directional_albedos};
use estampe::{
    AddressMode, Device, Mat4, Real, SampledTexture, SamplerDescriptor, TextureDescriptor,
    TextureError, TextureFormat, TextureViewDescriptor, Vec2, Vec3, ViewDimension,
};

/// Light from all around, as shaders read it.
#[derive(Debug, Clone)]
pub(crate) struct EnvironmentLight {
    /// Radiance by direction, a level for each roughness.
    specular: SampledTexture,
    /// The level of roughness 1.
    roughest_level: f32,
    /// Coefficients of irradiance ÷ π.
    diffuse: [[f32; 3]; 9],
    /// From view space to that of the map; a rotation.
    map_from_view: Mat4,
    /// Reflected shares, by n·v and roughness.
    albedos: SampledTexture,
}

/// Shares of the light of uniform surroundings that lobes reflect.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DirectionalAlbedo<R> {
    /// Of GGX, times F0.
    pub(crate) scale: R,
    /// Of GGX, times F90.
    pub(crate) bias: R,
    /// Of a sheen.
    pub(crate) sheen: R,
}

impl EnvironmentLight {
    /// The textures of a map whose radiance is multiplied by `intensity`.
    pub(crate) fn new(
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
        })
    }

    /// The shares that lobes of a roughness reflect.
    #[inline(always)]
    pub(crate) fn albedo<R: Real>(&self, n_dot_v: R, roughness: R) -> DirectionalAlbedo<R> {
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
    pub(crate) fn radiance<R: Real>(&self, direction_view: Vec3<R>, roughness: R) -> Vec3<R> {
        let direction = self.map_from_view.transform_vector(direction_view);
        let level = roughness * self.roughest_level;
        self.specular.sample_level(direction, level).xyz()
    }

    /// The irradiance ÷ π of a unit normal in view space.
    #[inline(always)]
    pub(crate) fn irradiance<R: Real>(&self, normal_view: Vec3<R>) -> Vec3<R> {
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
