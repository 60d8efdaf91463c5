//! Everything that a device holds after a sequence.

use super::Objects;
use crate::transfers::sequence::ImageAt;
use estampe::{Extent3d, SampledTexture, TexelCopyLayout, TextureCopy};
use estampe_types::TextureAspect;

impl Objects<'_> {
    /// The bytes of every sample of every level and slice of a texture, in this order.
    ///
    /// # Panics
    /// If the device refuses to read them.
    #[must_use]
    pub fn read_texture(&self, number: usize) -> Vec<Vec<u8>> {
        let texture = &self.textures[number];
        let mut read = Vec::new();
        for level in 0..texture.mip_level_count() {
            let size = texture.level_size(level);
            for slice in 0..size.depth_or_array_layers {
                if texture.sample_count() > 1 {
                    let at = ImageAt {
                        texture: number,
                        level,
                        slice,
                    };
                    let view = self.view(at, texture.format(), TextureAspect::All);
                    read.extend((0..texture.sample_count()).map(|sample| {
                        let bytes = self.device.read_sample(&view, sample);
                        bytes.expect("a sample that there is")
                    }));
                    continue;
                }
                let [width, height] = texture.format().block_size();
                let columns = size.width.div_ceil(width);
                let blocks = columns * size.height.div_ceil(height);
                let mut bytes = vec![0; (blocks * texture.format().block_bytes()) as usize];
                let from = TextureCopy {
                    mip_level: level,
                    origin: [0, 0, slice],
                    ..texture.into()
                };
                let size = Extent3d::new_2d(size.width, size.height);
                let tight = TexelCopyLayout::default();
                self.device
                    .read_texture_into(from, &mut bytes, &tight, size)
                    .expect("an image that there is");
                read.push(bytes);
            }
        }
        read
    }

    /// The bytes of a buffer.
    ///
    /// # Panics
    /// If the device refuses to read them.
    #[must_use]
    pub fn read_buffer(&self, number: usize) -> Vec<u8> {
        let buffer = &self.buffers[number];
        let bytes = buffer.map_read(0..buffer.size(), <[u8]>::to_vec);
        bytes.expect("all of the buffer")
    }

    /// The views that were held.
    #[must_use]
    pub fn held(&self) -> &[SampledTexture] {
        &self.held
    }
}
