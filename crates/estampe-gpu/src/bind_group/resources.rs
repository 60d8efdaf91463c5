//! What a bind group binds, as programs read it.

use super::{BindGroup, BindingResource};
use crate::buffer::StoredBuffers;
use crate::texture::{Image, StoredTextures, TextureError, TextureView, sampled_texture};
use crate::{BindingType, BufferSlice, Context};
use estampe_texture::{BoundTexture, TiledTexels, TiledWords};
use estampe_types::bindings::{BoundResource, BoundResources, OtherResource};
use estampe_types::shader::TextureReads;
use estampe_types::{ShadowMap, TextureFormat};
use std::sync::Arc;

impl BindGroup {
    /// The resources as they are now, as programs read them. What shaders store to is shared
    /// through `textures` and `buffers`. `reads` says how shaders read the texture of a binding.
    pub(crate) fn resources(
        &self,
        context: &Context,
        (textures, buffers): (&mut StoredTextures, &StoredBuffers<'_>),
        reads: impl Fn(u32) -> TextureReads,
    ) -> Result<Arc<BoundResources>, TextureError> {
        let layout = &self.inner.layout;
        let entries = self.inner.entries.iter().map(|(binding, resource)| {
            let kind = layout.entry(*binding).map(|entry| entry.ty);
            let bound = match resource {
                BindingResource::Buffer(slice) => {
                    let index = layout.dynamic_offset_index(*binding);
                    bound_buffer(slice, index, buffers)
                }
                BindingResource::Texture(view) => match kind {
                    Some(BindingType::ShadowMap) => shadow_map(context, view)?,
                    Some(BindingType::StorageTexture { .. }) => {
                        BoundResource::StorageTexture(textures.get(context, view)?)
                    }
                    _ => {
                        let bound = bound_texture(context, view, reads(*binding))?;
                        BoundResource::Other(OtherResource(Arc::new(bound)))
                    }
                },
                BindingResource::Sampler(sampler) => BoundResource::Sampler(*sampler.descriptor()),
                BindingResource::SampledTexture(view, sampler) => {
                    let sampled = sampled_texture(context, view, sampler)?;
                    BoundResource::Other(OtherResource(Arc::new(sampled)))
                }
            };
            Ok((*binding, bound))
        });
        let entries: Result<Vec<_>, TextureError> = entries.collect();
        Ok(Arc::new(BoundResources { entries: entries? }))
    }
}

/// The texture of a view, in the order of storage that shaders need: in rows, unless they only
/// compare what a pass has drawn, or load it at their own pixel.
fn bound_texture(
    context: &Context,
    view: &TextureView,
    reads: TextureReads,
) -> Result<BoundTexture, TextureError> {
    let level = context.level();
    let depths = match reads.compares {
        true => newest_depths(context, view)?,
        false => None,
    };
    if !reads.others && (depths.is_some() || !reads.compares) {
        let tiles = match reads.at_pixel {
            true => newest_tiles(context, view),
            false => None,
        };
        if tiles.is_some() || !reads.at_pixel {
            let parts = (depths, tiles);
            return Ok(BoundTexture::without_texels(view.shape()?, parts, level));
        }
    }
    Ok(BoundTexture::new(view.texels(context)?, depths, level))
}

fn bound_buffer(
    slice: &BufferSlice,
    dynamic_offset: Option<usize>,
    stored: &StoredBuffers<'_>,
) -> BoundResource {
    // The slice was checked: it lies in the buffer.
    let bytes = |value: u64| u32::try_from(value).unwrap_or(u32::MAX);
    let (offset, size) = (bytes(slice.offset), bytes(slice.size));
    let dynamic_offset = dynamic_offset.and_then(|index| u8::try_from(index).ok());
    if let Some(buffer) = stored.get(&slice.buffer) {
        return BoundResource::StorageBuffer {
            buffer: buffer.clone(),
            offset,
            size,
            dynamic_offset,
        };
    }
    let data = slice.buffer.data();
    let end = usize::try_from(slice.offset + slice.size).unwrap_or(usize::MAX);
    BoundResource::Buffer {
        // What follows a dynamic binding is checked with the offset of the draw.
        buffer: if dynamic_offset.is_some() {
            data
        } else {
            data.slice(0, end)
        },
        offset,
        size,
        dynamic_offset,
    }
}

fn shadow_map(context: &Context, view: &TextureView) -> Result<BoundResource, TextureError> {
    let texture = view.texture();
    let map = match view.image_key(None) {
        Some(key) => texture.lock().shadow_map(texture, context, key)?,
        None => None,
    };
    Ok(BoundResource::ShadowMap(map.unwrap_or_default()))
}

/// The depths of a view for comparisons, in the attachment's memory: those that a pass has written.
fn newest_depths(context: &Context, view: &TextureView) -> Result<Option<ShadowMap>, TextureError> {
    let texture = view.texture();
    let is_depth = view.format() == TextureFormat::Depth32Float && texture.sample_count() == 1;
    let Some(key) = view.image_key(None).filter(|_| is_depth) else {
        return Ok(None);
    };
    let mut contents = texture.lock();
    if contents.newest_tiles(key).is_none() {
        return Ok(None);
    }
    contents.shadow_map(texture, context, key)
}

/// The texels of a view in the attachment's memory, if it is the newest; none at the scalar level,
/// which loads them from rows.
fn newest_tiles(context: &Context, view: &TextureView) -> Option<TiledTexels> {
    let texture = view.texture();
    let key = view.image_key(None)?;
    if texture.sample_count() > 1 || context.level().is_scalar() {
        return None;
    }
    let contents = texture.lock();
    let words = match contents.tiles(key)? {
        Image::Color(image) => TiledWords::Colors(Arc::clone(image.words())),
        // Where rows are up to date, too, depths in them may be others.
        Image::DepthStencil(image) => {
            contents.newest_tiles(key)?;
            TiledWords::Depths(Arc::clone(image.depths()))
        }
    };
    TiledTexels::new(view.format(), view.size(), words)
}
