//! Textures that the shaders of a pass store to, as atomic words.

use super::contents::words_of;
use super::{ImageKey, TextureError, TextureView, words};
use crate::{BindGroup, BindingResource, BindingType, Context};
use estampe_texture::is_storable;
use estampe_types::{StorageTexture, ViewDimension};

/// The textures that the shaders of a pass store to.
#[derive(Debug)]
pub(crate) struct StoredTextures {
    stored: Vec<(TextureView, StorageTexture)>,
    /// If set, shaders store to copies, which are dropped.
    copies: bool,
}

impl StoredTextures {
    /// Textures whose texels change.
    pub(crate) fn in_place() -> Self {
        Self {
            stored: Vec::new(),
            copies: false,
        }
    }

    /// Copies of textures, which stay as they are.
    pub(crate) fn copies() -> Self {
        Self {
            stored: Vec::new(),
            copies: true,
        }
    }

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
        let storage = if self.copies {
            let mut storage = zeros(view)?;
            let rows = texture.lock().rows(texture, context)?;
            let level = view.mip_levels()[0];
            let first = words_of(&rows, ImageKey { level, layer: 0 }).start;
            let from = &rows.texels[first..][..storage.len()];
            let is_filled = words::fill(context, &mut storage, from);
            debug_assert!(is_filled, "it was just made");
            storage
        } else {
            texture.lock().stored_level(context, view, zeros)?
        };
        self.stored.push((view.clone(), storage.clone()));
        Ok(storage)
    }

    /// Says to the textures that shaders have stored to them.
    pub(crate) fn finish(self) {
        debug_assert!(!self.copies, "copies are dropped");
        for (view, _) in self.stored {
            let level = view.mip_levels()[0];
            view.texture().lock().put_stored(level);
        }
    }
}

/// A texture that shaders store to and sample in the same pass or dispatch.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "{texture} is stored to as {stored} and sampled as {sampled}: sample another texture or mip \
     level, or do one after the other"
)]
pub struct TextureConflict {
    /// The texture.
    pub texture: String,
    /// The binding by which shaders store to it.
    pub stored: String,
    /// The binding by which they sample it.
    pub sampled: String,
}

/// Checks that no mip level that shaders store to is sampled.
pub(crate) fn check_texture_conflicts(groups: &[&BindGroup]) -> Result<(), TextureConflict> {
    let all = || groups.iter().flat_map(|group| views(group));
    let overlaps = |a: [u32; 2], b: [u32; 2]| a[0] < b[0] + b[1] && b[0] < a[0] + a[1];
    for (stored, view, is_stored) in all() {
        if !is_stored {
            continue;
        }
        let conflict = all().find(|(_, other, is_stored)| {
            !is_stored
                && other.texture().is_same(view.texture())
                && overlaps(other.mip_levels(), view.mip_levels())
        });
        if let Some((sampled, ..)) = conflict {
            let name = |(binding, group): (u32, &BindGroup)| {
                format!("binding {binding} of {}", group.name())
            };
            return Err(TextureConflict {
                texture: view.texture().name(),
                stored: name(stored),
                sampled: name(sampled),
            });
        }
    }
    Ok(())
}

/// The views of a group: binding and group, view, and whether shaders store to it.
fn views(group: &BindGroup) -> impl Iterator<Item = ((u32, &BindGroup), &TextureView, bool)> {
    group
        .entries()
        .iter()
        .filter_map(move |(binding, resource)| {
            let entry = group.layout().entry(*binding)?;
            let is_stored = matches!(entry.ty, BindingType::StorageTexture { .. });
            match resource {
                BindingResource::Texture(view) | BindingResource::SampledTexture(view, _) => {
                    Some(((*binding, group), view, is_stored))
                }
                BindingResource::Buffer(_) | BindingResource::Sampler(_) => None,
            }
        })
}

/// The level of a view in words of zeros, all layers or slices together.
fn zeros(view: &TextureView) -> Result<StorageTexture, TextureError> {
    let texture = view.texture();
    let size = texture.level_size(view.mip_levels()[0]);
    let layers = size.depth_or_array_layers;
    let sides = (size.width, size.height);
    let storage = StorageTexture::zeros(view.format(), sides, texture.dimension(), layers);
    storage.ok_or(TextureError::OutOfMemory {
        bytes: u64::from(size.width) * u64::from(size.height) * u64::from(layers) * 4,
    })
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
