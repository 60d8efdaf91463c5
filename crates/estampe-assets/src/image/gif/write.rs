//! The file.

use super::dither::{Ditherer, OPAQUE};
use super::indexed::MOST_COLORS;
use super::palette::palette;
use crate::image::animation::{Area, FrameRate, area_of, changed_area, check_frame, invalid};
use estampe_scene::Image;
use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use std::borrow::Cow;
use std::io::{self, Write};

/// The most frames in a second that viewers show: shorter delays than 2/100 s are taken for longer
/// ones.
pub const MAX_GIF_RATE: u16 = 50;

/// Writes an animation that repeats without end. Texels with alpha below 128 are transparent, and
/// the others opaque. The frames' delays are in hundredths of a second, and do not drift.
///
/// # Errors
/// If there is no frame, frames differ in size, a side is over 65535, the rate is over
/// [`MAX_GIF_RATE`], or `out` fails.
pub fn write_gif(out: impl Write, frames: &[Image], rate: FrameRate) -> io::Result<()> {
    let Some(first) = frames.first() else {
        return Err(invalid("an animation without frames".to_owned()));
    };
    if u32::from(rate.frames()) > u32::from(MAX_GIF_RATE) * u32::from(rate.seconds()) {
        return Err(invalid(format!(
            "GIF shows at most {MAX_GIF_RATE} frames in a second"
        )));
    }
    for frame in frames {
        check_frame(frame, (first.width, first.height))?;
    }
    let (width, height) = (side(first.width)?, side(first.height)?);
    let colors = palette(frames, MOST_COLORS);
    let mut ditherer = Ditherer::new(&colors);
    let transparent = ditherer.transparent();
    let mut table = colors.as_flattened().to_vec();
    table.extend_from_slice(&[0; 3]);
    let mut encoder = Encoder::new(out, width, height, &table).map_err(error)?;
    encoder.set_repeat(Repeat::Infinite).map_err(error)?;
    let is_clear = |texel: &[u8; 4]| texel[3] < OPAQUE;
    let has_holes = { frames.iter() }.any(|f| f.rgba.as_chunks().0.iter().any(is_clear));
    let mut before: Option<(&Image, Vec<u8>)> = None;
    for (frame, number) in frames.iter().zip(0..) {
        let mut indices = ditherer.indices(frame);
        let texels = frame.rgba.as_chunks::<4>().0;
        let area = match &before {
            None => Area::of(frame),
            // Each frame is removed before the next one.
            Some(_) if has_holes => {
                area_of(frame, |at| texels.get(at).is_some_and(|t| !is_clear(t)))
            }
            Some((before, _)) => changed_area(before, frame),
        };
        let shown = indices.clone();
        if let Some((_, old)) = before.filter(|_| !has_holes) {
            for (index, old) in indices.iter_mut().zip(old) {
                if *index == old {
                    *index = transparent;
                }
            }
        }
        let (x, columns) = (area.x as usize, area.width as usize);
        let rows = indices.chunks_exact(frame.width as usize);
        let rows = rows.skip(area.y as usize).take(area.height as usize);
        let buffer: Vec<u8> = rows.flat_map(|row| &row[x..x + columns]).copied().collect();
        let delay = rate.duration(number, 100);
        let frame_of_file = Frame {
            delay: u16::try_from(delay).unwrap_or(u16::MAX),
            dispose: if has_holes {
                DisposalMethod::Background
            } else {
                DisposalMethod::Keep
            },
            transparent: Some(transparent),
            left: side(area.x)?,
            top: side(area.y)?,
            width: side(area.width)?,
            height: side(area.height)?,
            buffer: Cow::Owned(buffer),
            ..Frame::default()
        };
        encoder.write_frame(&frame_of_file).map_err(error)?;
        before = Some((frame, shown));
    }
    let mut out = encoder.into_inner().map_err(error)?;
    out.flush()
}

fn side(pixels: u32) -> io::Result<u16> {
    u16::try_from(pixels)
        .map_err(|_| invalid(format!("a side of {pixels} pixels; GIF holds 65535")))
}

fn error(error: EncodingError) -> io::Error {
    match error {
        EncodingError::Io(error) => error,
        other => invalid(other.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::samples::{disc, noise, opaque};
    use gif::{ColorOutput, DecodeOptions};

    /// The frames of a file as a viewer shows them, with their delays.
    fn read(bytes: &[u8]) -> Vec<(Image, u16)> {
        let mut options = DecodeOptions::new();
        options.set_color_output(ColorOutput::RGBA);
        let mut decoder = options.read_info(bytes).expect("a GIF");
        assert_eq!(decoder.repeat(), Repeat::Infinite);
        let (width, height) = (u32::from(decoder.width()), u32::from(decoder.height()));
        let mut canvas = Image::filled(width, height, [0; 4]);
        let mut frames = Vec::new();
        while let Some(frame) = decoder.read_next_frame().expect("a frame") {
            for y in 0..frame.height {
                for x in 0..frame.width {
                    let from = (usize::from(y) * usize::from(frame.width) + usize::from(x)) * 4;
                    let texel = &frame.buffer[from..from + 4];
                    let row = usize::from(frame.top + y) * width as usize;
                    let to = (row + usize::from(frame.left + x)) * 4;
                    if texel[3] != 0 {
                        canvas.rgba[to..to + 4].copy_from_slice(texel);
                    }
                }
            }
            frames.push((canvas.clone(), frame.delay));
            if frame.dispose == DisposalMethod::Background {
                canvas = Image::filled(width, height, [0; 4]);
            }
        }
        frames
    }

    fn written(frames: &[Image], rate: (u16, u16)) -> Vec<u8> {
        let mut out = Vec::new();
        let rate = FrameRate::new(rate.0, rate.1).expect("not 0");
        write_gif(&mut out, frames, rate).expect("valid");
        out
    }

    #[test]
    fn frames_of_few_colours_read_back_exactly() {
        let mut frames = vec![Image::filled(9, 7, [1, 2, 3, 255]); 4];
        for (at, frame) in (0_u8..).zip(&mut frames).skip(1) {
            frame.rgba[usize::from(at) * 40..][..4].copy_from_slice(&[200, at, 9, 255]);
        }
        frames.push(frames[3].clone());
        let read = read(&written(&frames, (12, 1)));
        let shown: Vec<Image> = read.iter().map(|(image, _)| image.clone()).collect();
        assert_eq!(shown, frames);
        let delays: Vec<u16> = read.iter().map(|&(_, delay)| delay).collect();
        assert_eq!(delays, [8, 9, 8, 8, 9]);
    }

    #[test]
    fn transparent_frames_are_removed_before_the_next_one() {
        let mut frames = vec![Image::filled(5, 5, [0; 4]); 3];
        for (frame, at) in frames.iter_mut().zip([3, 12, 20]) {
            frame.rgba[at * 4..][..4].copy_from_slice(&[90, 80, 70, 255]);
        }
        let shown: Vec<Image> = { read(&written(&frames, (10, 1))) }
            .into_iter()
            .map(|(image, _)| image)
            .collect();
        assert_eq!(shown, frames);
    }

    #[test]
    fn smooth_frames_stay_near() {
        let frames = [disc(120, 90), disc(120, 90)];
        let read = read(&written(&frames, (25, 1)));
        for ((shown, _), frame) in read.iter().zip(&frames) {
            let pairs = shown.rgba.iter().zip(&frame.rgba);
            let worst = pairs.map(|(a, b)| a.abs_diff(*b)).max();
            assert!(worst <= Some(24), "{worst:?}");
            assert_eq!(shown.texel(0, 0), frame.texel(0, 0), "the background");
        }
        assert_eq!(read[0].0, read[1].0, "what stands still does not flicker");
    }

    #[test]
    fn the_bytes_are_the_same_everywhere() {
        let frames = [
            opaque(noise(40, 30, 1)),
            opaque(noise(40, 30, 2)),
            disc(40, 30),
        ];
        let bytes = written(&frames, (25, 1));
        // FNV-1a.
        let digest = bytes
            .iter()
            .fold(0xcbf2_9ce4_8422_2325, |digest: u64, &byte| {
                (digest ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3)
            });
        assert_eq!((bytes.len(), digest), (4170, 7_118_195_939_203_322_163));
    }

    #[test]
    fn what_gif_cannot_hold_is_an_error() {
        let rate = |frames| FrameRate::new(frames, 1).expect("not 0");
        let frame = Image::filled(2, 2, [0; 4]);
        assert!(write_gif(Vec::new(), &[], rate(10)).is_err());
        assert!(write_gif(Vec::new(), std::slice::from_ref(&frame), rate(51)).is_err());
        let other = Image::filled(2, 3, [0; 4]);
        assert!(write_gif(Vec::new(), &[frame, other], rate(10)).is_err());
        let wide = Image::filled(65_536, 1, [0; 4]);
        assert!(write_gif(Vec::new(), &[wide], rate(10)).is_err());
    }
}
