//! Copies between textures: whole images that a pass rendered last in tiles, all other texels in
//! rows, compressed ones as blocks.

use super::contents::{Contents, Image, Needs};
use super::region::{Region, TexelCopyLayout, TextureCopy, unsupported};
use super::{Extent3d, ImageKey, TextureError, TextureUsages, host_access};
use crate::Context;
use estampe_texture::region::{copy_row, row_words};
use estampe_types::{TexelData, TextureAspect};

/// Checks a copy; its regions, and whether both are whole images.
fn regions(
    from: &TextureCopy<'_>,
    into: &TextureCopy<'_>,
    size: Extent3d,
) -> Result<(Region, Region, bool), TextureError> {
    from.texture.require(TextureUsages::COPY_SRC)?;
    into.texture.require(TextureUsages::COPY_DST)?;
    let source = Region::new(from, size)?;
    let destination = Region::new(into, size)?;
    let samples = from.texture.sample_count();
    let are_whole = source.is_whole(from.texture) && destination.is_whole(into.texture);
    if samples != into.texture.sample_count() || samples != 1 && !are_whole {
        let rule = "a multisampled texture is copied to one of as many samples, whole images at a \
                    time: resolve it to copy a part";
        return Err(unsupported(into.texture, rule));
    }
    Ok((source, destination, are_whole))
}

/// Checks a copy of texels between textures of formats that differ at most in sRGB.
pub(crate) fn check_copy(
    from: &TextureCopy<'_>,
    into: &TextureCopy<'_>,
    size: Extent3d,
) -> Result<(), TextureError> {
    regions(from, into, size).map(drop)
}

/// Copies texels between textures, which may be the same, of formats that differ at most in sRGB.
/// The sources are read before anything is written.
pub(crate) fn copy(
    context: &Context,
    from: &TextureCopy<'_>,
    into: &TextureCopy<'_>,
    size: Extent3d,
) -> Result<(), TextureError> {
    let (source, destination, are_whole) = regions(from, into, size)?;
    if from.texture.format().is_compressed() {
        let bytes = host_access::read_tight(context, from, size)?;
        return host_access::write(context, into, &bytes, &TexelCopyLayout::default(), size);
    }
    if from.texture.is_same(into.texture) {
        return copy_inside(context, [from, into], [source, destination]);
    }
    let mut source_contents = from.texture.lock();
    let mut contents = into.texture.lock();
    let is_all = from.aspect == TextureAspect::All;
    for (read, written) in source.images().zip(destination.images()) {
        if are_whole
            && is_all
            && let Some(tiles) = source_contents.newest_tiles(read)
        {
            copy_tiles(context, tiles, (&mut contents, into, written))?;
            continue;
        }
        let data = source_contents.rows(from.texture, context)?;
        let images = std::iter::once(written);
        contents.write_rows(into.texture, context, images, |target, words| {
            let spans = source.spans_of(read).zip(destination.spans_of(written));
            for (read, written) in spans {
                let texels = &data.texels[row_words(&data, read)];
                let copies = &mut words[row_words(target, written)];
                copy_row(target.format, into.aspect, texels, copies);
            }
        })?;
    }
    Ok(())
}

/// Replaces an image of a texture by one in tiles.
fn copy_tiles(
    context: &Context,
    tiles: &Image,
    (contents, into, key): (&mut Contents, &TextureCopy<'_>, ImageKey),
) -> Result<(), TextureError> {
    let (mut image, _) = contents.take(into.texture, context, key, Needs::Memory)?;
    match (&mut image, tiles) {
        (Image::Color(image), Image::Color(tiles)) => image.copy_from(tiles),
        (Image::DepthStencil(image), Image::DepthStencil(tiles)) => image.copy_from(tiles),
        _ => unreachable!("textures of the same format"),
    }
    contents.put(key, image);
    Ok(())
}

/// Copies texels inside a texture, where the regions may overlap.
fn copy_inside(
    context: &Context,
    [from, into]: [&TextureCopy<'_>; 2],
    [source, destination]: [Region; 2],
) -> Result<(), TextureError> {
    let texture = into.texture;
    let mut contents = texture.lock();
    let mut copies: Vec<u32> = Vec::new();
    {
        let data: &TexelData = &*contents.rows(texture, context)?;
        let spans = source.images().flat_map(|key| source.spans_of(key));
        let rows = spans.map(|span| &data.texels[row_words(data, span)]);
        let rows: Vec<&[u32]> = rows.collect();
        let len = rows.iter().map(|row| row.len()).sum();
        let short = |_| TextureError::OutOfMemory {
            bytes: len as u64 * 4,
        };
        copies.try_reserve_exact(len).map_err(short)?;
        rows.iter().for_each(|row| copies.extend_from_slice(row));
    }
    let images = destination.images();
    contents.write_rows(texture, context, images, |target, words| {
        let mut left = &copies[..];
        let spans = destination
            .images()
            .flat_map(|key| destination.spans_of(key));
        for span in spans {
            let words = &mut words[row_words(target, span)];
            let (row, rest) = left.split_at(words.len());
            copy_row(target.format, from.aspect, row, words);
            left = rest;
        }
    })
}
