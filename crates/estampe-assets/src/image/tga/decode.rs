//! The TGA reader.

use estampe_scene::Image;

use super::footer;
use super::header::{HEADER_LEN, Header, TexelKind};
use super::packets::Stream;
use super::texel::{AlphaUse, TexelFormat};
use crate::image::fault::{allocate_texels, check_size, malformed};
use crate::image::transform::{flip_horizontal, flip_vertical};
use crate::{AssetError, Limits};

/// Reads a TGA file of any kind that the module documentation lists; the footer is optional.
///
/// # Errors
/// `Malformed` with a byte offset if the file is truncated, contradicts itself or uses a colour
/// that its map lacks; `Unsupported` for types that no program writes; `LimitExceeded` before any
/// texel is stored.
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<Image, AssetError> {
    let header = Header::parse(bytes)?;
    let (width, height) = (u32::from(header.width), u32::from(header.height));
    check_size(width, height, limits)?;
    let attributes = footer::attributes_type(bytes);

    // Read the colour map. Other kinds of image may contain one without using it.
    let map_start = HEADER_LEN + usize::from(header.id_len);
    let map_len = header.color_map.map_or(0, |map| {
        usize::from(map.len) * usize::from(map.entry_bits).div_ceil(8)
    });
    let texels_start = map_start + map_len;
    if texels_start > bytes.len() {
        return Err(malformed(
            bytes.len(),
            "the file ends before the TGA texels",
        ));
    }

    let stream = Stream {
        start: texels_start,
        texel_len: header.texel_len(),
        texels: width as usize * height as usize,
        is_rle: header.is_rle,
    };
    stream.check_length(bytes)?;
    let mut rgba = allocate_texels(stream.texels)?;
    let format = match header.kind {
        TexelKind::Mapped => None,
        TexelKind::Grey if header.depth_bits == 8 => Some(TexelFormat::Grey8),
        TexelKind::Grey => Some(TexelFormat::GreyAlpha16),
        TexelKind::TrueColor => TexelFormat::of_color(header.depth_bits),
    };
    if let Some(format) = format {
        let alpha = AlphaUse::decide(format, header.alpha_bits, attributes);
        stream.for_each(bytes, |_, texel, times| {
            push(&mut rgba, format.rgba(texel, alpha), times);
            Ok(())
        })?;
    } else {
        let palette = Palette::read(&header, &bytes[map_start..texels_start], attributes);
        stream.for_each(bytes, |at, texel, times| {
            push(&mut rgba, palette.color(at, texel)?, times);
            Ok(())
        })?;
    }
    Ok(upright(
        Image {
            width,
            height,
            rgba,
        },
        &header,
    ))
}

/// True if a file without a known signature is likely TGA: it ends in the footer of TGA 2, or its
/// header is one that this module reads.
pub(in crate::image) fn looks_like_tga(bytes: &[u8]) -> bool {
    footer::find(bytes).is_some() || Header::parse(bytes).is_ok()
}

/// Stores `color` `times` times.
#[inline]
fn push(rgba: &mut Vec<u8>, color: [u8; 4], times: usize) {
    for _ in 0..times {
        rgba.extend_from_slice(&color);
    }
}

/// The colours of a mapped image.
struct Palette {
    /// The index of the first colour.
    first: usize,
    /// The colours, in index order.
    colors: Vec<[u8; 4]>,
}

impl Palette {
    /// Reads the entries from `bytes`.
    fn read(header: &Header, bytes: &[u8], attributes: Option<footer::AttributesType>) -> Self {
        let map = header
            .color_map
            .expect("Header::check demands a map for mapped images");
        let Some(format) = TexelFormat::of_color(map.entry_bits) else {
            return Self {
                first: 0,
                colors: Vec::new(),
            };
        };
        let alpha = AlphaUse::decide(format, header.alpha_bits, attributes);
        let entries = bytes.chunks_exact(format.len_bytes());
        Self {
            first: usize::from(map.first),
            colors: entries.map(|entry| format.rgba(entry, alpha)).collect(),
        }
    }

    /// The colour of the index `texel`, which is stored at byte `at`.
    fn color(&self, at: usize, texel: &[u8]) -> Result<[u8; 4], AssetError> {
        let index = texel
            .iter()
            .rev()
            .fold(0, |index, &byte| index << 8 | usize::from(byte));
        let color = index
            .checked_sub(self.first)
            .and_then(|entry| self.colors.get(entry));
        color.copied().ok_or_else(|| {
            malformed(
                at,
                format!(
                    "colour {index} of a TGA colour map that holds {} to {}",
                    self.first,
                    self.first + self.colors.len()
                ),
            )
        })
    }
}

/// The image with its first row at the top and its first column at the left.
fn upright(image: Image, header: &Header) -> Image {
    let mut image = deinterleaved(image, usize::from(header.row_step));
    if header.right_to_left {
        image = flip_horizontal(&image);
    }
    if !header.top_to_bottom {
        image = flip_vertical(&image);
    }
    image
}

/// The rows in order: with step s they are stored as 0, s, 2s … 1, s + 1 … s − 1, 2s − 1 …
fn deinterleaved(image: Image, step: usize) -> Image {
    if step == 1 {
        return image;
    }
    let row_len = image.width as usize * 4;
    let mut rgba = vec![0; image.rgba.len()];
    let rows = (0..step).flat_map(|first| (first..image.height as usize).step_by(step));
    for (row, stored) in rows.zip(image.rgba.chunks_exact(row_len)) {
        rgba[row * row_len..(row + 1) * row_len].copy_from_slice(stored);
    }
    Image { rgba, ..image }
}
