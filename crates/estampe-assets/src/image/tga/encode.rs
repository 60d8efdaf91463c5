//! The TGA writer: true colour, top-left origin, run-length encoded by default.

use estampe_scene::Image;

use super::footer::plain_footer;
use super::header::HEADER_LEN;
use super::packets::MAX_PACKET;
use crate::AssetError;
use crate::image::AlphaChannel;
use crate::image::fault::{check_texels, too_large};

/// Options of the TGA writer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TgaOptions {
    /// If set, texels are run-length encoded. Default: true.
    pub rle: bool,
    /// Rule for 32 instead of 24 bits per texel. Default: if a texel is not opaque.
    pub alpha: AlphaChannel,
}

impl Default for TgaOptions {
    fn default() -> Self {
        Self {
            rle: true,
            alpha: AlphaChannel::WhenNeeded,
        }
    }
}

/// Writes a TGA 2 file.
///
/// # Errors
/// `LimitExceeded` for sides over 65535, `Malformed` if the image's bytes do not fit its size.
pub fn encode(image: &Image, options: TgaOptions) -> Result<Vec<u8>, AssetError> {
    check_texels(image)?;
    let (Ok(width), Ok(height)) = (u16::try_from(image.width), u16::try_from(image.height)) else {
        return Err(too_large(image, "TGA", u32::from(u16::MAX)));
    };
    let has_alpha = options.alpha.is_written_for(image);
    let texel_len = if has_alpha { 4 } else { 3 };

    let mut header = [0; HEADER_LEN];
    header[2] = if options.rle { 10 } else { 2 };
    header[12..14].copy_from_slice(&width.to_le_bytes());
    header[14..16].copy_from_slice(&height.to_le_bytes());
    header[16] = if has_alpha { 32 } else { 24 };
    header[17] = 0b10_0000 | if has_alpha { 8 } else { 0 };

    let texels = image.rgba.len() / 4;
    let mut out = Vec::with_capacity(HEADER_LEN + texels * texel_len + plain_footer().len());
    out.extend_from_slice(&header);
    for row in image
        .rgba
        .as_chunks::<4>()
        .0
        .chunks_exact(usize::from(width))
    {
        if options.rle {
            push_packets(&mut out, row, texel_len);
        } else {
            push_texels(&mut out, row, texel_len);
        }
    }
    out.extend_from_slice(&plain_footer());
    Ok(out)
}

/// Appends a row in packets that end with the row, as TGA 2 requires.
///
/// Two equal texels already make a run: at 3 or 4 bytes per texel it is never longer than the same
/// texels in a raw packet, even if another raw packet must follow.
fn push_packets(out: &mut Vec<u8>, row: &[[u8; 4]], texel_len: usize) {
    let mut rest = row;
    while let Some(first) = rest.first() {
        let run = rest
            .iter()
            .take(MAX_PACKET)
            .take_while(|&t| same(t, first, texel_len))
            .count();
        let (packet_len, taken) = if run > 1 {
            out.push(0x80 | count_bits(run));
            (run, &rest[..1])
        } else {
            let pairs = rest.windows(2).take(MAX_PACKET);
            let different = pairs.take_while(|p| !same(&p[0], &p[1], texel_len)).count();
            // The last texel of a row has no right neighbour and belongs to the raw packet.
            let raw = if different + 1 == rest.len() {
                different + 1
            } else {
                different
            };
            let raw = raw.min(MAX_PACKET);
            out.push(count_bits(raw));
            (raw, &rest[..raw])
        };
        push_texels(out, taken, texel_len);
        rest = &rest[packet_len..];
    }
}

/// The low seven bits of a packet's first byte.
#[expect(
    clippy::cast_possible_truncation,
    reason = "a packet stands for 1 to 128 texels"
)]
fn count_bits(texels: usize) -> u8 {
    debug_assert!(
        (1..=MAX_PACKET).contains(&texels),
        "a packet of {texels} texels"
    );
    (texels - 1) as u8
}

/// True if two texels are stored alike: alpha counts only if it is written.
fn same(a: &[u8; 4], b: &[u8; 4], texel_len: usize) -> bool {
    a[..texel_len] == b[..texel_len]
}

/// Appends texels as B, G, R and, with four bytes, A.
fn push_texels(out: &mut Vec<u8>, texels: &[[u8; 4]], texel_len: usize) {
    for &[red, green, blue, alpha] in texels {
        out.extend_from_slice(&[blue, green, red, alpha][..texel_len]);
    }
}
