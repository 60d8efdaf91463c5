//! Pictures in the kitty graphics protocol
//! (<https://sw.kovidgoyal.net/kitty/graphics-protocol/>): a PNG in pieces, which the terminal
//! scales to a number of columns.

use super::base64::base64;
use super::terminal::Terminal;
use crate::failure::Failure;
use crate::render;
use estampe_assets::image::ImageFormat;
use estampe_scene::Image;

/// The most characters of a piece.
const PIECE: usize = 4096;

/// Width and height of a character that are assumed, in pixels.
pub(super) const CHARACTER: [u32; 2] = [8, 16];

/// The bytes that show a picture.
pub(super) fn bytes(image: &Image, terminal: &Terminal) -> Result<Vec<u8>, Failure> {
    let text = base64(&render::encoded(image, ImageFormat::Png)?);
    let mut out = Vec::new();
    let mut pieces = text.as_bytes().chunks(PIECE).peekable();
    // a=T: transmit and show; f=100: PNG; q=2: no answer; m: whether more pieces follow.
    let mut keys = format!("a=T,f=100,q=2,c={},", columns(image, terminal));
    while let Some(piece) = pieces.next() {
        let more = u8::from(pieces.peek().is_some());
        out.extend_from_slice(format!("\x1b_G{keys}m={more};").as_bytes());
        out.extend_from_slice(piece);
        out.extend_from_slice(b"\x1b\\");
        keys.clear();
    }
    out.push(b'\n');
    Ok(out)
}

/// The columns of the picture: as many as it has pixels for, inside of the terminal.
fn columns(image: &Image, terminal: &Terminal) -> u32 {
    let [width, height] = CHARACTER.map(u64::from);
    let own = u64::from(image.width).div_ceil(width);
    let by_rows = u64::from(terminal.rows) * height * u64::from(image.width)
        / (u64::from(image.height.max(1)) * width);
    let columns = own.min(by_rows).min(u64::from(terminal.columns));
    u32::try_from(columns).unwrap_or(1).max(1)
}
