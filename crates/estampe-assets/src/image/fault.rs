//! Errors of image files, and the checks that precede allocations.

use estampe_scene::Image;

use crate::error::Location;
use crate::{AssetError, Limits};

/// The image's bytes break their format's rules at byte `offset`.
pub(super) fn malformed(offset: usize, what: impl Into<String>) -> AssetError {
    AssetError::malformed(what, "the image is damaged; save it again from its source")
        .at(Location::Byte(offset as u64))
}

/// The image uses `what`, which is not supported here.
pub(super) fn unsupported(what: impl Into<String>) -> AssetError {
    AssetError::unsupported(
        format!("{} cannot be read", what.into()),
        "save it as an 8-bit PNG",
    )
}

/// Checks the size in an image's header.
pub(super) fn check_size(width: u32, height: u32, limits: &Limits) -> Result<(), AssetError> {
    Limits::check(
        "pixels",
        u64::from(width) * u64::from(height),
        limits.max_image_pixels,
    )
}

/// Reserves memory for `texels` RGBA texels, or returns an error if there is not enough.
pub(super) fn allocate_texels(texels: usize) -> Result<Vec<u8>, AssetError> {
    #[cfg(test)]
    MOST_TEXELS.with(|most| most.set(most.get().max(texels)));
    let mut rgba = Vec::new();
    match texels
        .checked_mul(4)
        .map(|bytes| rgba.try_reserve_exact(bytes))
    {
        Some(Ok(())) => Ok(rgba),
        _ => Err(AssetError::limit_exceeded(
            format!("not enough memory for an image of {texels} pixels"),
            "use a smaller image",
        )),
    }
}

/// Checks that an image to be written has texels, and as many bytes as its size requires.
pub(super) fn check_texels(image: &Image) -> Result<(), AssetError> {
    let expected = (image.width as u128) * (image.height as u128) * 4;
    if expected == 0 {
        return Err(AssetError::malformed(
            format!("{image:?} has no pixels to write"),
            "give both sides at least one pixel",
        ));
    }
    if expected != image.rgba.len() as u128 {
        return Err(AssetError::malformed(
            format!(
                "{image:?} comes with {} bytes instead of {expected}",
                image.rgba.len()
            ),
            "give four bytes to every pixel",
        ));
    }
    Ok(())
}

/// An image to be written has a side over the format's `max_side`.
pub(super) fn too_large(image: &Image, format: &str, max_side: u32) -> AssetError {
    AssetError::limit_exceeded(
        format!("{image:?} has a side over the {max_side} pixels that {format} can hold"),
        "write a PNG, or a smaller picture",
    )
}

#[cfg(test)]
thread_local! {
    static MOST_TEXELS: std::cell::Cell<usize> = const { std::cell::Cell::new(0) };
}

/// The texels of the largest image that `work` allocates on this thread.
#[cfg(test)]
pub(super) fn most_texels(work: impl FnOnce()) -> usize {
    MOST_TEXELS.with(|most| most.set(0));
    work();
    MOST_TEXELS.with(std::cell::Cell::get)
}
