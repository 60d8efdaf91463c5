//! Copies between buffers and textures, clears, mip levels, blits.

use crate::buffer::{read_bytes, with_bytes, with_bytes_mut, write_bytes};
use crate::texture::{self, ImageKey, TexelCopyLayout, Texture, TextureCopy};
use crate::{
    Buffer, BufferError, BufferUsages, Context, Extent3d, TextureError, TextureUsages, TextureView,
};
use estampe_types::TextureDimension;
use std::ops::Range;

/// The reason why nothing was copied.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CopyError {
    /// A buffer cannot be copied from or to.
    #[error(transparent)]
    Buffer(#[from] BufferError),
    /// A texture cannot be copied from or to.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// Textures whose texels differ in size or kind.
    #[error("{from} and {into} have formats that differ in more than sRGB: convert with a blit")]
    Formats {
        /// The source.
        from: String,
        /// The destination.
        into: String,
    },
}

/// The ranges of bytes of a copy between buffers.
pub(crate) fn check_buffer_to_buffer(
    from: (&Buffer, u64),
    into: (&Buffer, u64),
    size: u64,
) -> Result<(Range<usize>, Range<usize>), CopyError> {
    from.0.require(BufferUsages::COPY_SRC)?;
    into.0.require(BufferUsages::COPY_DST)?;
    Ok((from.0.range(from.1, size)?, into.0.range(into.1, size)?))
}

/// Copies bytes between buffers, which may be the same.
pub(crate) fn buffer_to_buffer(
    from: (&Buffer, u64),
    into: (&Buffer, u64),
    size: u64,
) -> Result<(), CopyError> {
    let (source, destination) = check_buffer_to_buffer(from, into, size)?;
    // The source is read as it is now, so that neither buffer waits for the other.
    let data = from.0.data();
    let mut bytes = vec![0; source.len()];
    read_bytes(data.words(), source.start, &mut bytes);
    drop(data);
    write_bytes(into.0.lock().words_mut(), destination.start, &bytes);
    Ok(())
}

/// The range of bytes of a write.
pub(crate) fn check_write(
    buffer: &Buffer,
    offset: u64,
    size: u64,
) -> Result<Range<usize>, BufferError> {
    buffer.require(BufferUsages::COPY_DST)?;
    buffer.range(offset, size)
}

/// Sets bytes of a buffer to zero.
pub(crate) fn clear_buffer(buffer: &Buffer, offset: u64, size: u64) -> Result<(), CopyError> {
    let range = check_write(buffer, offset, size)?;
    let zeros = vec![0; range.len()];
    write_bytes(buffer.lock().words_mut(), range.start, &zeros);
    Ok(())
}

/// Checks a copy of texels out of a buffer.
pub(crate) fn check_buffer_to_texture(
    (from, layout): (&Buffer, &TexelCopyLayout),
    into: &TextureCopy<'_>,
    size: Extent3d,
) -> Result<(), CopyError> {
    from.require(BufferUsages::COPY_SRC)?;
    Ok(texture::check_write(into, from.size(), layout, size)?)
}

/// Copies texels out of a buffer.
pub(crate) fn buffer_to_texture(
    context: &Context,
    (from, layout): (&Buffer, &TexelCopyLayout),
    into: &TextureCopy<'_>,
    size: Extent3d,
) -> Result<(), CopyError> {
    from.require(BufferUsages::COPY_SRC)?;
    let _reserved = into.texture.reserve();
    let data = from.data();
    let len = data.len_bytes();
    with_bytes(data.words(), |bytes| {
        Ok(texture::write(context, into, &bytes[..len], layout, size)?)
    })
}

/// Checks a copy of texels into a buffer.
pub(crate) fn check_texture_to_buffer(
    from: &TextureCopy<'_>,
    (into, layout): (&Buffer, &TexelCopyLayout),
    size: Extent3d,
) -> Result<(), CopyError> {
    into.require(BufferUsages::COPY_DST)?;
    Ok(texture::check_read(from, into.size(), layout, size)?)
}

/// Copies texels into a buffer.
pub(crate) fn texture_to_buffer(
    context: &Context,
    from: &TextureCopy<'_>,
    (into, layout): (&Buffer, &TexelCopyLayout),
    size: Extent3d,
) -> Result<(), CopyError> {
    into.require(BufferUsages::COPY_DST)?;
    let _reserved = from.texture.reserve();
    let mut data = into.lock();
    let len = data.len_bytes();
    with_bytes_mut(data.words_mut(), |bytes| {
        Ok(texture::read(
            context,
            from,
            &mut bytes[..len],
            layout,
            size,
        )?)
    })
}

/// Checks a copy of texels between textures.
pub(crate) fn check_texture_to_texture(
    from: &TextureCopy<'_>,
    into: &TextureCopy<'_>,
    size: Extent3d,
) -> Result<(), CopyError> {
    let format = |copy: &TextureCopy<'_>| copy.texture.format().with_srgb(false);
    if format(from) != format(into) || from.aspect != into.aspect {
        return Err(CopyError::Formats {
            from: from.texture.name(),
            into: into.texture.name(),
        });
    }
    texture::check_copy(from, into, size)?;
    Ok(())
}

/// Copies texels between textures, which may be the same.
pub(crate) fn texture_to_texture(
    context: &Context,
    from: &TextureCopy<'_>,
    into: &TextureCopy<'_>,
    size: Extent3d,
) -> Result<(), CopyError> {
    check_texture_to_texture(from, into, size)?;
    let mut both = [from.texture, into.texture];
    both.sort_by_key(|texture| texture.id());
    let _first = both[0].reserve();
    let _second = (!both[0].is_same(both[1])).then(|| both[1].reserve());
    Ok(texture::copy(context, from, into, size)?)
}

/// Checks that the texels of a view can be set.
pub(crate) fn check_clear(view: &TextureView) -> Result<(), TextureError> {
    view.texture().require(TextureUsages::COPY_DST)
}

/// Sets all texels of a view to zero, of one aspect if the view has one.
pub(crate) fn clear_texture(context: &Context, view: &TextureView) -> Result<(), TextureError> {
    check_clear(view)?;
    let texture = view.texture();
    let _reserved = texture.reserve();
    let keys: Vec<ImageKey> = levels(view)
        .flat_map(|level| layers(view, level).map(move |layer| ImageKey { level, layer }))
        .collect();
    texture::zero(context, texture, &keys, view.aspect())
}

fn levels(view: &TextureView) -> impl Iterator<Item = u32> {
    let [first, count] = view.mip_levels();
    first..first + count
}

fn layers(view: &TextureView, level: u32) -> std::ops::Range<u32> {
    let texture = view.texture();
    if texture.dimension() == TextureDimension::D3 {
        return 0..texture.level_size(level).depth_or_array_layers;
    }
    let [first, count] = view.array_layers();
    first..first + count
}

/// Checks that the mip levels of a texture can be made.
pub(crate) fn check_mips(texture: &Texture) -> Result<(), TextureError> {
    let shape = texture.descriptor().without_texels();
    if !estampe_texture::can_generate(&shape) || texture.format().is_compressed() {
        return Err(TextureError::Unsupported {
            texture: texture.name(),
            format: texture.format(),
            samples: texture.sample_count(),
            rule: "mip levels are made of colours that can be filtered, and not of compressed blocks",
        });
    }
    Ok(())
}

/// Makes each mip level from the one above, from level 1 on.
pub(crate) fn generate_mips(context: &Context, texture: &Texture) -> Result<(), TextureError> {
    check_mips(texture)?;
    let _reserved = texture.reserve();
    let levels = 1..texture.mip_level_count();
    let keys = levels.clone().flat_map(|level| {
        let layers = texture.level_size(level).depth_or_array_layers;
        (0..layers).map(move |layer| ImageKey { level, layer })
    });
    let keys: Vec<ImageKey> = keys.collect();
    let mut contents = texture.lock();
    contents.write_rows(texture, context, keys.into_iter(), |data, words| {
        for level in levels {
            estampe_texture::generate_level(data, level as usize, words);
        }
    })
}
