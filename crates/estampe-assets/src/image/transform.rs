//! Transforms of whole images: mirroring and nearest-texel scaling.

use estampe_scene::Image;

/// The image mirrored left to right.
#[must_use]
pub fn flip_horizontal(image: &Image) -> Image {
    let mut flipped = image.clone();
    if image.width > 0 {
        for row in flipped.rgba.chunks_exact_mut(image.width as usize * 4) {
            row.as_chunks_mut::<4>().0.reverse();
        }
    }
    flipped
}

/// The image mirrored top to bottom.
#[must_use]
pub fn flip_vertical(image: &Image) -> Image {
    let mut rgba = Vec::with_capacity(image.rgba.len());
    if image.width > 0 {
        for row in image.rgba.chunks_exact(image.width as usize * 4).rev() {
            rgba.extend_from_slice(row);
        }
    }
    Image {
        width: image.width,
        height: image.height,
        rgba,
    }
}

/// The image at another size. Each texel is a copy of the source texel that contains its centre:
/// source column = ⌊(x + ½) · W / `width`⌋, and the row likewise.
///
/// An image without texels gives transparent black.
///
/// # Panics
/// If `width * height * 4` does not fit `usize`.
#[must_use]
pub fn scale_nearest(image: &Image, width: u32, height: u32) -> Image {
    if image.width == 0 || image.height == 0 {
        return Image::filled(width, height, [0; 4]);
    }
    let columns: Vec<usize> = (0..width)
        .map(|x| source_index(x, image.width, width) * 4)
        .collect();
    let mut scaled = Image::filled(width, height, [0; 4]);
    if width > 0 {
        let source_row_len = image.width as usize * 4;
        for (y, row) in (0..height).zip(scaled.rgba.chunks_exact_mut(width as usize * 4)) {
            let start = source_index(y, image.height, height) * source_row_len;
            let source = &image.rgba[start..start + source_row_len];
            for (texel, &at) in row.as_chunks_mut::<4>().0.iter_mut().zip(&columns) {
                texel.copy_from_slice(&source[at..at + 4]);
            }
        }
    }
    scaled
}

/// ⌊(at + ½) · from / to⌋ in integers; below `from` because at ≤ to − 1. The product stays below
/// 2^65 / 2, and is taken in 128 bits.
fn source_index(at: u32, from: u32, to: u32) -> usize {
    ((2 * u128::from(at) + 1) * u128::from(from) / (2 * u128::from(to))) as usize
}

#[cfg(test)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "small pictures have small coordinates"
)]
mod tests {
    use super::*;

    fn numbered(width: u32, height: u32) -> Image {
        let rgba = (0..height)
            .flat_map(|y| (0..width).flat_map(move |x| [x as u8, y as u8, (x ^ y) as u8, 255]))
            .collect();
        Image {
            width,
            height,
            rgba,
        }
    }

    #[test]
    fn flips_move_each_texel_to_its_mirror_place() {
        let image = numbered(5, 3);
        let (across, down) = (flip_horizontal(&image), flip_vertical(&image));
        for y in 0..3 {
            for x in 0..5 {
                assert_eq!(across.texel(4 - x, y), image.texel(x, y));
                assert_eq!(down.texel(x, 2 - y), image.texel(x, y));
            }
        }
        assert_eq!(flip_horizontal(&across), image);
        assert_eq!(flip_vertical(&down), image);
    }

    #[test]
    fn scaling_up_repeats_and_scaling_down_picks_the_centre() {
        let image = numbered(4, 3);
        let doubled = scale_nearest(&image, 8, 6);
        for y in 0..6 {
            for x in 0..8 {
                assert_eq!(doubled.texel(x, y), image.texel(x / 2, y / 2));
            }
        }
        assert_eq!(scale_nearest(&doubled, 4, 3), image);
        assert_eq!(scale_nearest(&image, 1, 1).texel(0, 0), image.texel(2, 1));
        assert_eq!(scale_nearest(&image, 4, 3), image);
    }

    #[test]
    fn empty_pictures_scale_and_flip_without_a_texel() {
        let empty = Image {
            width: 0,
            height: 0,
            rgba: Vec::new(),
        };
        assert_eq!(flip_horizontal(&empty), empty);
        assert_eq!(flip_vertical(&empty), empty);
        assert_eq!(scale_nearest(&empty, 2, 1).rgba, [0; 8]);
        assert_eq!(scale_nearest(&numbered(3, 3), 0, 4).rgba.len(), 0);
    }
}
