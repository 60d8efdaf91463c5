//! Animated WebP: lossless frames in the extended container.
//!
//! ```text
//!   RIFF size WEBP
//!     VP8X  flags, canvas
//!     ANIM  background, loop count
//!     ANMF  x, y, width, height, duration, flags, then the chunk VP8L of a still picture
//! ```
//!
//! (WebP Container Specification, *Animation*.)

use super::{Area, FrameRate, changed_area, check_frame, crop, invalid};
use crate::image::AlphaChannel;
use crate::image::webp::encode_webp;
use estampe_scene::Image;
use std::io;

/// The bytes of a still file before its VP8L chunk: `RIFF`, the size, `WEBP`.
const RIFF_HEADER: usize = 12;

/// Collects the frames of an animated WebP.
#[derive(Debug)]
pub struct WebpAnimation {
    size: (u32, u32),
    rate: FrameRate,
    has_alpha: bool,
    frames: u64,
    before: Option<Image>,
    chunks: Vec<u8>,
}

impl WebpAnimation {
    /// An animation without frames, which will repeat without end. Without alpha every texel is
    /// treated as opaque.
    #[must_use]
    pub fn new(size: (u32, u32), rate: FrameRate, has_alpha: bool) -> Self {
        Self {
            size,
            rate,
            has_alpha,
            frames: 0,
            before: None,
            chunks: Vec::new(),
        }
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// If the frame has another size, or one that WebP cannot hold.
    pub fn add(&mut self, frame: Image) -> io::Result<()> {
        check_frame(&frame, self.size)?;
        let area = match &self.before {
            // Positions are stored halved.
            Some(before) => changed_area(before, &frame).with_even_corner(),
            None => Area::of(&frame),
        };
        let alpha = if self.has_alpha {
            AlphaChannel::Always
        } else {
            AlphaChannel::Never
        };
        let still = encode_webp(&crop(&frame, area), alpha);
        let still = still.map_err(|error| invalid(error.to_string()))?;
        let picture = &still[RIFF_HEADER..];
        let duration = u32::try_from(self.rate.duration(self.frames, 1000)).unwrap_or(u32::MAX);
        let mut header = Vec::with_capacity(16);
        for number in [
            area.x / 2,
            area.y / 2,
            area.width - 1,
            area.height - 1,
            duration.min((1 << 24) - 1),
        ] {
            header.extend_from_slice(&number.to_le_bytes()[..3]);
        }
        // The texels replace those of the canvas, and stay.
        header.push(0b10);
        let size = chunk_size(header.len() + picture.len())?;
        self.chunks.extend_from_slice(b"ANMF");
        self.chunks.extend_from_slice(&size.to_le_bytes());
        self.chunks.extend_from_slice(&header);
        self.chunks.extend_from_slice(picture);
        self.before = Some(frame);
        self.frames += 1;
        Ok(())
    }

    /// The file.
    ///
    /// # Errors
    /// If there is no frame, or the file would be over 4 GiB.
    pub fn finish(self) -> io::Result<Vec<u8>> {
        if self.frames == 0 {
            return Err(invalid("an animation without frames".to_owned()));
        }
        let mut head = Vec::new();
        let flags = 0b10 | u8::from(self.has_alpha) << 4;
        head.extend_from_slice(b"VP8X\x0a\0\0\0");
        head.extend_from_slice(&[flags, 0, 0, 0]);
        for side in [self.size.0, self.size.1] {
            head.extend_from_slice(&(side - 1).to_le_bytes()[..3]);
        }
        // A transparent background, and no end.
        head.extend_from_slice(b"ANIM\x06\0\0\0\0\0\0\0\0\0");
        let size = chunk_size(4 + head.len() + self.chunks.len())?;
        let mut file = Vec::with_capacity(RIFF_HEADER + head.len() + self.chunks.len());
        file.extend_from_slice(b"RIFF");
        file.extend_from_slice(&size.to_le_bytes());
        file.extend_from_slice(b"WEBP");
        file.extend_from_slice(&head);
        file.extend_from_slice(&self.chunks);
        Ok(file)
    }
}

fn chunk_size(bytes: usize) -> io::Result<u32> {
    let most = u32::MAX - 10;
    let size = u32::try_from(bytes).ok().filter(|&size| size <= most);
    size.ok_or_else(|| invalid("WebP holds 4 GiB; draw fewer or smaller frames".to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::samples::{noise, opaque};
    use image_webp::{LoopCount, WebPDecoder};

    /// Rows: I4.
    #[test]
    fn frames_read_back() {
        let mut frames = vec![noise(13, 9, 1), noise(13, 9, 2)];
        let mut third = frames[1].clone();
        third.rgba[4 * 41] ^= 5;
        frames.extend([third.clone(), third, noise(13, 9, 3)]);
        let rate = FrameRate::new(30, 1).expect("not 0");
        for has_alpha in [true, false] {
            let mut animation = WebpAnimation::new((13, 9), rate, has_alpha);
            for frame in &frames {
                animation.add(frame.clone()).expect("a frame");
            }
            let bytes = animation.finish().expect("all frames");
            let mut decoder = WebPDecoder::new(io::Cursor::new(bytes)).expect("a WebP");
            assert_eq!(decoder.dimensions(), (13, 9));
            assert_eq!((decoder.num_frames(), decoder.has_alpha()), (5, has_alpha));
            assert_eq!(decoder.loop_count(), LoopCount::Forever);
            let mut durations = Vec::new();
            for frame in &frames {
                let mut samples = vec![0; decoder.output_buffer_size().expect("small")];
                durations.push(decoder.read_frame(&mut samples).expect("a frame"));
                let expected = if has_alpha {
                    frame.rgba.clone()
                } else {
                    crate::image::png::rgb_from_rgba(&opaque(frame.clone()).rgba)
                };
                assert_eq!(samples, expected);
            }
            assert_eq!(durations, [33, 34, 33, 33, 34]);
        }
    }

    #[test]
    fn wrong_frames_are_errors() {
        let rate = FrameRate::new(10, 1).expect("not 0");
        assert!(WebpAnimation::new((4, 3), rate, true).finish().is_err());
        let added = WebpAnimation::new((4, 3), rate, true).add(noise(3, 4, 1));
        assert!(added.is_err(), "another size");
        let wide = Image::filled(16_385, 1, [0; 4]);
        let added = WebpAnimation::new((16_385, 1), rate, true).add(wide);
        assert!(added.is_err(), "too wide");
    }
}
