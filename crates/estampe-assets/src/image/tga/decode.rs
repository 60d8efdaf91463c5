//! The TGA reader.

use estampe_scene::{Image, Workers};

use super::footer;
use super::header::{HEADER_LEN, Header, TexelKind};
use super::packets::Stream;
use super::texel::{AlphaUse, TexelFormat};
use crate::image::fault::{allocate_texels, check_size, malformed};
use crate::image::reduce::{Reduced, Reducer, Reduction, RowOrder, reduce};
use crate::image::transform::{flip_horizontal, flip_vertical};
use crate::{AssetError, Limits};

/// Reads a TGA file of any kind that the module documentation lists; the footer is optional.
///
/// # Errors
/// `Malformed` with a byte offset if the file is truncated, contradicts itself or uses a colour
/// that its map lacks; `Unsupported` for types that no program writes; `LimitExceeded` before any
/// texel is stored.
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<Image, AssetError> {
    let file = File::open(bytes, limits)?;
    let mut rgba = allocate_texels(file.stream.texels)?;
    file.for_each(|color, times| push(&mut rgba, color, times))?;
    let (width, height) = file.size();
    let image = Image {
        width,
        height,
        rgba,
    };
    Ok(upright(image, &file.header))
}

/// [`decode`] of a level of the image, row by row unless rows or columns are stored out of order.
pub(in crate::image) fn decode_reduced(
    bytes: &[u8],
    reduction: Reduction,
    limits: &Limits,
) -> Result<Reduced, AssetError> {
    let file = File::open(bytes, limits)?;
    let header = &file.header;
    if header.right_to_left || header.row_step != 1 {
        return reduce(
            &decode(bytes, limits)?,
            reduction,
            Workers::new(limits.threads),
        );
    }
    let order = match header.top_to_bottom {
        true => RowOrder::TopDown,
        false => RowOrder::BottomUp,
    };
    let width = file.size().0 as usize;
    let mut reducer = Reducer::new(file.size(), reduction, order)?;
    let mut row = Vec::with_capacity(width);
    file.for_each(|color, mut times| {
        // A packet may cross rows.
        while times > 0 {
            let here = times.min(width - row.len());
            row.resize(row.len() + here, u32::from_le_bytes(color));
            times -= here;
            if row.len() == width {
                reducer.push(&row);
                row.clear();
            }
        }
    })?;
    Ok(reducer.finish())
}

/// Width and height from the header.
pub(in crate::image) fn stated_size(bytes: &[u8]) -> Option<(u32, u32)> {
    let header = Header::parse(bytes).ok()?;
    Some((u32::from(header.width), u32::from(header.height)))
}

/// A file whose header and length were checked.
struct File<'b> {
    bytes: &'b [u8],
    header: Header,
    attributes: Option<footer::AttributesType>,
    /// Where the colour map begins.
    map_start: usize,
    stream: Stream,
}

impl<'b> File<'b> {
    fn open(bytes: &'b [u8], limits: &Limits) -> Result<Self, AssetError> {
        let header = Header::parse(bytes)?;
        check_size(u32::from(header.width), u32::from(header.height), limits)?;
        let attributes = footer::attributes_type(bytes);

        // Other kinds of image may contain a colour map without using it.
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
            texels: usize::from(header.width) * usize::from(header.height),
            is_rle: header.is_rle,
        };
        stream.check_length(bytes)?;
        Ok(Self {
            bytes,
            header,
            attributes,
            map_start,
            stream,
        })
    }

    fn size(&self) -> (u32, u32) {
        (u32::from(self.header.width), u32::from(self.header.height))
    }

    /// Calls `put` with all colours in file order and their repetitions, which add up to the number
    /// of texels.
    fn for_each(&self, mut put: impl FnMut([u8; 4], usize)) -> Result<(), AssetError> {
        let (header, attributes) = (&self.header, self.attributes);
        let format = match header.kind {
            TexelKind::Mapped => None,
            TexelKind::Grey if header.depth_bits == 8 => Some(TexelFormat::Grey8),
            TexelKind::Grey => Some(TexelFormat::GreyAlpha16),
            TexelKind::TrueColor => TexelFormat::of_color(header.depth_bits),
        };
        if let Some(format) = format {
            let alpha = AlphaUse::decide(format, header.alpha_bits, attributes);
            return self.stream.for_each(self.bytes, |_, texel, times| {
                put(format.rgba(texel, alpha), times);
                Ok(())
            });
        }
        let map = &self.bytes[self.map_start..self.stream.start];
        let palette = Palette::read(header, map, attributes);
        self.stream.for_each(self.bytes, |at, texel, times| {
            put(palette.color(at, texel)?, times);
            Ok(())
        })
    }
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
