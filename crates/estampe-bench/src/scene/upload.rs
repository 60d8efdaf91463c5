//! Conversion of generated textures to textures for shaders.

use crate::generate::MipChain;
use estampe::{
    Device, DeviceDescriptor, SampledTexture, SamplerDescriptor, TextureDescriptor, TextureFormat,
};

/// The texture with its own mip levels, repeated, linear within and between levels.
pub(super) fn trilinear(chain: &MipChain) -> SampledTexture {
    let create = || -> Result<SampledTexture, Box<dyn std::error::Error>> {
        // Textures for shaders do not depend on the device that made them.
        let device = Device::new(&DeviceDescriptor {
            threads: 1,
            ..DeviceDescriptor::default()
        })?;
        let levels: Vec<&[u8]> = chain.levels.iter().map(Vec::as_slice).collect();
        let format = TextureFormat::Rgba8Unorm;
        let descriptor = TextureDescriptor::new_2d(chain.size, chain.size, format);
        let texture = device.create_texture_with_data(&descriptor.with_all_levels(), &levels)?;
        let sampler = device.create_sampler(&SamplerDescriptor::trilinear_repeat())?;
        Ok(device.sampled_texture(&texture.view(), &sampler)?)
    };
    create().expect("the generators halve a power of two below the limits")
}
