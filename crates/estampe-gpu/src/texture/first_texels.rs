//! The texels that a texture is created with.

use super::region::unsupported;
use super::{ImageKey, Texture, TextureError};
use crate::Limits;
use estampe_texture::{LevelData, MipGeneration, TexelDescriptor};
use estampe_texture::{create_texture, create_texture_with_levels};
use estampe_types::TextureFormat;

impl Texture {
    /// Sets the texels to the tight bytes of the first mip levels; the others are generated.
    pub(super) fn fill(&self, levels: &[&[u8]], limits: &Limits) -> Result<(), TextureError> {
        let descriptor = self.descriptor();
        let is_complete = levels.len().max(1) >= descriptor.mip_level_count as usize;
        if descriptor.format.is_compressed() && !is_complete {
            let rule = "give all mip levels: compressed blocks are not generated";
            return Err(unsupported(self, rule));
        }
        let mips = if levels.len() < descriptor.mip_level_count as usize {
            MipGeneration::Full
        } else {
            MipGeneration::None
        };
        let mut contents = self.lock();
        let size = (descriptor.width, descriptor.height);
        let one = TexelDescriptor::new_2d(size.0, size.1, descriptor.format);
        let data = match levels {
            // The common case has code of its own.
            [rgba] if is_rgba8(descriptor.format) && *descriptor == one.with_all_levels() => {
                create_texture(size.0, size.1, descriptor.format, rgba, mips, limits)?
            }
            _ if is_rgba8(descriptor.format) && is_all_of(levels, descriptor) => {
                create_texture_with_levels(size, descriptor.format, levels, limits)?
            }
            _ => {
                let data: Vec<_> = levels.iter().map(|bytes| LevelData::tight(bytes)).collect();
                descriptor.create(&data, mips, limits)?
            }
        };
        if descriptor.format.is_compressed() {
            for (level, bytes) in (0..).zip(levels) {
                let layers = self.level_size(level).depth_or_array_layers;
                let image = (bytes.len() / layers.max(1) as usize).max(1);
                for (layer, bytes) in (0..).zip(bytes.chunks(image)) {
                    let key = ImageKey { level, layer };
                    contents.blocks.set(key, bytes);
                }
            }
        }
        contents.set_rows(data);
        Ok(())
    }
}

/// True if these are all levels of one 2D image.
fn is_all_of(levels: &[&[u8]], descriptor: &TexelDescriptor) -> bool {
    let one = TexelDescriptor::new_2d(descriptor.width, descriptor.height, descriptor.format);
    let is_flat = *descriptor
        == TexelDescriptor {
            mip_level_count: descriptor.mip_level_count,
            ..one
        };
    is_flat && levels.len() == descriptor.mip_level_count as usize
}

fn is_rgba8(format: TextureFormat) -> bool {
    matches!(
        format,
        TextureFormat::Rgba8Unorm | TextureFormat::Rgba8UnormSrgb
    )
}
