//! Texels between the host's bytes and textures: regions, single samples, clears to zero.

use super::region::{Region, TexelCopyLayout, TextureCopy, unsupported};
use super::{Extent3d, Image, ImageKey, Texture, TextureError, TextureUsages, TextureView};
use crate::Context;
use estampe_texture::region::{
    RowSpan, aspect_bytes, read_row, write_blocks, write_row, write_zeros,
};
use estampe_types::TextureAspect;

/// Checks that so many bytes can be written to a region.
pub(crate) fn check_write(
    copy: &TextureCopy<'_>,
    bytes: u64,
    layout: &TexelCopyLayout,
    size: Extent3d,
) -> Result<(), TextureError> {
    copy.texture.require(TextureUsages::COPY_DST)?;
    let bytes = usize::try_from(bytes).unwrap_or(usize::MAX);
    Region::new(copy, size)?.in_memory(copy.texture, layout, bytes)?;
    Ok(())
}

/// Checks that a region can be read into so many bytes.
pub(crate) fn check_read(
    copy: &TextureCopy<'_>,
    bytes: u64,
    layout: &TexelCopyLayout,
    size: Extent3d,
) -> Result<(), TextureError> {
    copy.texture.require(TextureUsages::COPY_SRC)?;
    let bytes = usize::try_from(bytes).unwrap_or(usize::MAX);
    Region::new(copy, size)?.in_memory(copy.texture, layout, bytes)?;
    Ok(())
}

/// Writes a region from bytes.
pub(crate) fn write(
    context: &Context,
    copy: &TextureCopy<'_>,
    bytes: &[u8],
    layout: &TexelCopyLayout,
    size: Extent3d,
) -> Result<(), TextureError> {
    let texture = copy.texture;
    texture.require(TextureUsages::COPY_DST)?;
    let region = Region::new(copy, size)?;
    let rows = region.in_memory(texture, layout, bytes.len())?;
    let mut contents = texture.lock();
    let is_compressed = texture.format().is_compressed();
    if is_compressed {
        for (span, first) in rows.spans() {
            let bytes = &bytes[first..][..region.row_bytes];
            contents.blocks.write(texture, span, bytes);
        }
    }
    contents.write_rows(texture, context, region.images(), |data, words| {
        for (span, first) in rows.spans() {
            let bytes = &bytes[first..][..region.row_bytes];
            if is_compressed {
                write_blocks(data, span, bytes, words);
            } else {
                write_row(data, span, copy.aspect, bytes, words);
            }
        }
    })
}

/// Reads a region into bytes.
pub(crate) fn read(
    context: &Context,
    copy: &TextureCopy<'_>,
    bytes: &mut [u8],
    layout: &TexelCopyLayout,
    size: Extent3d,
) -> Result<(), TextureError> {
    let texture = copy.texture;
    texture.require(TextureUsages::COPY_SRC)?;
    let region = Region::new(copy, size)?;
    let rows = region.in_memory(texture, layout, bytes.len())?;
    let mut contents = texture.lock();
    if texture.format().is_compressed() {
        for (span, first) in rows.spans() {
            let bytes = &mut bytes[first..][..region.row_bytes];
            contents.blocks.read(texture, span, bytes);
        }
        return Ok(());
    }
    let is_tight = *layout == TexelCopyLayout::default() && bytes.len() == region.tight_len();
    if region.is_whole(texture)
        && size.depth_or_array_layers == 1
        && is_tight
        && copy.aspect == TextureAspect::All
        && let Some(Image::Color(image)) = contents.tiles(region.key)
    {
        context.read_color_texels(image, bytes);
        return Ok(());
    }
    let data = contents.rows(texture, context)?;
    for (span, first) in rows.spans() {
        read_row(
            &data,
            span,
            (copy.aspect, 0),
            &mut bytes[first..][..region.row_bytes],
        );
    }
    Ok(())
}

/// Reads a region as bytes without padding.
pub(crate) fn read_tight(
    context: &Context,
    copy: &TextureCopy<'_>,
    size: Extent3d,
) -> Result<Vec<u8>, TextureError> {
    let mut bytes = zeros(Region::new(copy, size)?.tight_len())?;
    read(context, copy, &mut bytes, &TexelCopyLayout::default(), size)?;
    Ok(bytes)
}

/// So many zero bytes; an error if memory is short.
fn zeros(len: usize) -> Result<Vec<u8>, TextureError> {
    let short = |_| TextureError::OutOfMemory { bytes: len as u64 };
    let mut room: Vec<u8> = Vec::new();
    room.try_reserve_exact(len).map_err(short)?;
    drop(std::hint::black_box(room));
    // New pages are zeros already: they are not written here.
    Ok(vec![0; len])
}

/// Reads one sample of each texel of an image.
pub(crate) fn read_sample(
    context: &Context,
    view: &TextureView,
    sample: u32,
) -> Result<Vec<u8>, TextureError> {
    let (texture, format) = (view.texture(), view.texture().format());
    texture.require(TextureUsages::COPY_SRC)?;
    let key = view.image_key(None);
    let Some(key) = key.filter(|_| !format.is_compressed() && sample < texture.sample_count())
    else {
        let rule = "a sample is read of one level of one layer, not compressed, that has it";
        return Err(unsupported(texture, rule));
    };
    let data = texture.lock().rows(texture, context)?;
    let level = data.levels[key.level as usize];
    let (width, height) = (level.width as usize, level.height as usize);
    let each = aspect_bytes(format, view.aspect());
    let mut bytes = zeros(width * height * each)?;
    for (y, row) in bytes.chunks_mut(width * each).enumerate() {
        let span = RowSpan {
            level: key.level as usize,
            slice: key.layer as usize,
            x: 0,
            y,
            width,
        };
        read_row(&data, span, (view.aspect(), sample as usize), row);
    }
    Ok(bytes)
}

/// Sets one aspect or all of every texel of some images to zero; compressed ones to blocks of zero
/// bytes.
pub(crate) fn zero(
    context: &Context,
    texture: &Texture,
    keys: &[ImageKey],
    aspect: TextureAspect,
) -> Result<(), TextureError> {
    let mut contents = texture.lock();
    contents.blocks.clear(keys);
    contents.write_rows(texture, context, keys.iter().copied(), |data, words| {
        for key in keys {
            if aspect == TextureAspect::All {
                write_zeros(data, key.level as usize, key.layer as usize, words);
                continue;
            }
            let level = data.levels[key.level as usize];
            let width = level.width as usize;
            let samples = data.shape.samples as usize;
            let zeros = vec![0; width * samples * aspect_bytes(data.format, aspect)];
            for y in 0..level.height as usize {
                let span = RowSpan {
                    level: key.level as usize,
                    slice: key.layer as usize,
                    x: 0,
                    y,
                    width,
                };
                write_row(data, span, aspect, &zeros, words);
            }
        }
    })
}
