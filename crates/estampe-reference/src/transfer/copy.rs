//! Copies between memory and textures, and clears.

use super::PlainTexture;
use super::region::{Blocks, Layout, Place, Placed, Rule};
use super::texel::{aspect_of, set_aspect};
use estampe_types::TextureAspect;
use std::ops::Range;

/// Writes a region of a texture from bytes.
///
/// # Errors
/// The rule that is broken; nothing is written then.
pub fn write(
    texture: &mut PlainTexture,
    place: &Place,
    size: [u32; 3],
    (bytes, layout): (&[u8], &Layout),
) -> Result<(), Rule> {
    let placed = Placed::of(texture, place, size, (bytes.len(), layout))?;
    let format = texture.format;
    for (block, range) in placed.all() {
        let texel = texture.block_mut(place.level, block);
        set_aspect(format, place.aspect, texel, &bytes[range]);
    }
    Ok(())
}

/// Reads a region of a texture into bytes; bytes between its rows stay as they are.
///
/// # Errors
/// The rule that is broken; nothing is written then.
pub fn read(
    texture: &PlainTexture,
    place: &Place,
    size: [u32; 3],
    (bytes, layout): (&mut [u8], &Layout),
) -> Result<(), Rule> {
    let placed = Placed::of(texture, place, size, (bytes.len(), layout))?;
    for (block, range) in placed.all() {
        let texel = texture.block(place.level, block);
        bytes[range].copy_from_slice(&aspect_of(texture.format, place.aspect, texel));
    }
    Ok(())
}

/// Copies a region of a texture to another one, or to the same as it was before: `from` is a clone
/// then.
///
/// # Errors
/// The rule that is broken; nothing is copied then.
pub fn copy(
    (from, from_place): (&PlainTexture, &Place),
    (into, into_place): (&mut PlainTexture, &Place),
    size: [u32; 3],
) -> Result<(), Rule> {
    let (format, aspect) = (into.format, into_place.aspect);
    if from.format.with_srgb(false) != format.with_srgb(false) || from_place.aspect != aspect {
        return Err(Rule::Formats);
    }
    let source = Blocks::of(from, from_place, size)?;
    let destination = Blocks::of(into, into_place, size)?;
    let is_whole = |texture: &PlainTexture, place: &Place| {
        let [width, height, _] = texture.level_size(place.level);
        place.origin[..2] == [0, 0] && size[..2] == [width, height]
    };
    let are_whole = is_whole(from, from_place) && is_whole(into, into_place);
    if from.samples != into.samples || from.samples != 1 && !are_whole {
        return Err(Rule::Samples);
    }
    let each = format.block_bytes() as usize;
    for (source, destination) in source.all().zip(destination.all()) {
        let texels = from.block(from_place.level, source).chunks(each);
        let copies = into.block_mut(into_place.level, destination);
        for (texel, copy) in texels.zip(copies.chunks_mut(each)) {
            set_aspect(format, aspect, copy, &aspect_of(format, aspect, texel));
        }
    }
    Ok(())
}

/// One sample of an aspect of each texel of an image, row by row.
///
/// # Panics
/// If the texture does not have the image or the sample.
#[must_use]
pub fn read_sample(
    texture: &PlainTexture,
    [level, slice]: [u32; 2],
    (aspect, sample): (TextureAspect, u32),
) -> Vec<u8> {
    let each = texture.format.block_bytes() as usize;
    let rows = &texture.levels[level as usize][slice as usize].rows;
    let texels = rows
        .iter()
        .flat_map(|row| row.chunks(texture.block_bytes()));
    let samples = texels.map(|texel| &texel[sample as usize * each..][..each]);
    samples
        .flat_map(|sample| aspect_of(texture.format, aspect, sample))
        .collect()
}

/// Sets an aspect of all texels of some levels and slices to zero bytes.
///
/// # Panics
/// If the texture does not have a level or slice.
pub fn clear(
    texture: &mut PlainTexture,
    levels: Range<u32>,
    slices: impl Fn(u32) -> Range<u32>,
    aspect: TextureAspect,
) {
    let format = texture.format;
    let each = format.block_bytes() as usize;
    let zeros = vec![0; each];
    let zeros = aspect_of(format, aspect, &zeros);
    for level in levels {
        for slice in slices(level) {
            let image = &mut texture.levels[level as usize][slice as usize];
            let texels = image.rows.iter_mut().flat_map(|row| row.chunks_mut(each));
            texels.for_each(|texel| set_aspect(format, aspect, texel, &zeros));
        }
    }
}

/// Copies bytes from an offset of one buffer to an offset of another one, or of the same as it was
/// before: `from` is a clone then.
///
/// # Errors
/// [`Rule::Bytes`] if a range ends beyond its buffer.
pub fn copy_bytes(
    (from, from_offset): (&[u8], u64),
    (into, into_offset): (&mut [u8], u64),
    size: u64,
) -> Result<(), Rule> {
    let source = range_of(from.len(), from_offset, size)?;
    let destination = range_of(into.len(), into_offset, size)?;
    into[destination].copy_from_slice(&from[source]);
    Ok(())
}

/// Sets bytes of a buffer to zero.
///
/// # Errors
/// [`Rule::Bytes`] if the range ends beyond the buffer.
pub fn clear_bytes(buffer: &mut [u8], offset: u64, size: u64) -> Result<(), Rule> {
    let range = range_of(buffer.len(), offset, size)?;
    buffer[range].fill(0);
    Ok(())
}

fn range_of(len: usize, offset: u64, size: u64) -> Result<Range<usize>, Rule> {
    let end = u128::from(offset) + u128::from(size);
    if end > len as u128 {
        return Err(Rule::Bytes);
    }
    let within = |at: u128| usize::try_from(at).expect("at most the length");
    Ok(within(offset.into())..within(end))
}
