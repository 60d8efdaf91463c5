//! Textures that the shaders of a pass store to: atomic words for the time of the pass.

use super::contents::words_of;
use super::{ImageKey, TextureError, TextureView};
use crate::Context;
use estampe_texture::is_storable;
use estampe_types::{StorageTexture, ViewDimension};

/// The textures that the shaders of a pass store to.
#[derive(Debug, Default)]
pub(crate) struct StoredTextures {
    stored: Vec<(TextureView, StorageTexture)>,
}

impl StoredTextures {
    /// The texture as shaders store to it: one for all views of the same level.
    pub(crate) fn get(
        &mut self,
        context: &Context,
        view: &TextureView,
    ) -> Result<StorageTexture, TextureError> {
        let is_same = |other: &TextureView| {
            other.texture().is_same(view.texture()) && other.mip_levels() == view.mip_levels()
        };
        if let Some((_, storage)) = self.stored.iter().find(|(other, _)| is_same(other)) {
            return Ok(storage.clone());
        }
        let texture = view.texture();
        let level = view.mip_levels()[0];
        let size = texture.level_size(level);
        let layers = size.depth_or_array_layers;
        let sides = (size.width, size.height);
        let storage = StorageTexture::zeros(view.format(), sides, texture.dimension(), layers);
        let storage = storage.ok_or(TextureError::OutOfMemory {
            bytes: u64::from(size.width) * u64::from(size.height) * u64::from(layers) * 4,
        })?;
        let rows = texture.lock().rows(texture, context)?;
        let words = words_of(&rows, ImageKey { level, layer: 0 }).start;
        let all = rows.texels.iter().skip(words).take(storage.len());
        for (index, word) in all.enumerate() {
            storage.store(index, *word);
        }
        self.stored.push((view.clone(), storage.clone()));
        Ok(storage)
    }

    /// Writes what shaders have stored to the textures.
    pub(crate) fn write_back(self, context: &Context) -> Result<(), TextureError> {
        for (view, storage) in self.stored {
            let texture = view.texture();
            let level = view.mip_levels()[0];
            let layers = 0..texture.level_size(level).depth_or_array_layers;
            let keys = layers.map(|layer| ImageKey { level, layer });
            let mut contents = texture.lock();
            contents.write_rows(texture, context, keys, |data, words| {
                let first = words_of(data, ImageKey { level, layer: 0 }).start;
                let words = &mut words[first..][..storage.len()];
                for (index, word) in words.iter_mut().enumerate() {
                    *word = storage.load(index);
                }
            })?;
        }
        Ok(())
    }
}

impl TextureView {
    /// Returns true if shaders can store to the view: one level of all layers, of a format that can
    /// be stored.
    pub(crate) fn is_storable(&self) -> bool {
        let layers = self.texture().level_size(self.mip_levels()[0]);
        let is_whole = self.dimension() == ViewDimension::D3
            || self.array_layers() == [0, layers.depth_or_array_layers];
        let is_cube = matches!(
            self.dimension(),
            ViewDimension::Cube | ViewDimension::CubeArray
        );
        self.mip_levels()[1] == 1
            && is_whole
            && !is_cube
            && self.texture().sample_count() == 1
            && is_storable(self.format())
    }
}
