//! The blocks of compressed textures as they were written: copies and the host read them, while
//! shaders sample the rows of texels that are decoded from them.

use super::{ImageKey, Texture};
use estampe_texture::region::RowSpan;
use std::collections::BTreeMap;

/// The blocks of the images that were written. Those of other images are zero bytes.
#[derive(Debug, Default)]
pub(super) struct Blocks {
    images: BTreeMap<ImageKey, Vec<u8>>,
}

impl Blocks {
    /// Sets all blocks of an image.
    pub(super) fn set(&mut self, key: ImageKey, blocks: &[u8]) {
        self.images.insert(key, blocks.to_vec());
    }

    /// Sets all blocks of some images to zero bytes.
    pub(super) fn clear(&mut self, keys: &[ImageKey]) {
        self.images.retain(|key, _| !keys.contains(key));
    }

    /// Writes a row of blocks from the span's first one on.
    pub(super) fn write(&mut self, texture: &Texture, span: RowSpan, bytes: &[u8]) {
        let place = Place::of(texture, span);
        let image = self.images.entry(place.key);
        let image = image.or_insert_with(|| vec![0; place.image_bytes]);
        image[place.first..][..bytes.len()].copy_from_slice(bytes);
    }

    /// Reads a row of blocks from the span's first one on.
    pub(super) fn read(&self, texture: &Texture, span: RowSpan, bytes: &mut [u8]) {
        let place = Place::of(texture, span);
        match self.images.get(&place.key) {
            Some(image) => bytes.copy_from_slice(&image[place.first..][..bytes.len()]),
            None => bytes.fill(0),
        }
    }
}

/// The place of a row of blocks.
struct Place {
    key: ImageKey,
    /// Bytes of all blocks of the image.
    image_bytes: usize,
    /// The first byte of the row in its image.
    first: usize,
}

impl Place {
    fn of(texture: &Texture, span: RowSpan) -> Self {
        let format = texture.format();
        let [width, height] = format.block_size().map(|side| side as usize);
        let each = format.block_bytes() as usize;
        let level = u32::try_from(span.level).unwrap_or_default();
        let size = texture.level_size(level);
        let columns = (size.width as usize).div_ceil(width);
        let rows = (size.height as usize).div_ceil(height);
        Self {
            key: ImageKey {
                level,
                layer: u32::try_from(span.slice).unwrap_or_default(),
            },
            image_bytes: columns * rows * each,
            first: (span.y / height * columns + span.x / width) * each,
        }
    }
}
