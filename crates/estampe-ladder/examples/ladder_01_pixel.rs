//! Rung 1: one red pixel at (52, 41) in a TGA file of 100×100 pixels.
//!
//! Look at the middle: one pixel is red. With `-o pixel.tga` the file is 18 bytes of size and
//! format, then runs of equal pixels.
//!
//! `cargo run --release --example ladder_01_pixel -- -o pixel.tga`

use estampe_assets::Limits;
use estampe_assets::image::{ImageFormat, decode};
use estampe_ladder::{Course, LadderError, Picture};

/// Sets the pixel in column 52 and row 41, counted from the top left.
///
/// The picture goes through a TGA file, the simplest format there is: a header of 18 bytes with
/// the size, then the pixels, blue before green before red, here run-length encoded. Ten thousand
/// pixels that are all black but one are little more than a hundred bytes.
///
/// # Errors
/// If the file cannot be made or read.
pub fn draw(_course: &Course) -> Result<Picture, LadderError> {
    let mut picture = Picture::new(100, 100);
    picture.set([52, 41], Picture::RED);

    let file: Vec<u8> = picture.encode(ImageFormat::Tga)?;
    let read = decode(&file, &Limits::default())?;
    Ok(read.into())
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(1, draw)
}
