//! Animated PNG: lossless, with alpha.

use super::{Area, FrameRate, changed_area, check_frame, crop, invalid};
use crate::image::png::rgb_from_rgba;
use estampe_scene::Image;
use png::{BitDepth, BlendOp, ColorType, Compression, EncodingError, Filter, Writer};
use std::io::{self, Write};

/// Writes an animated PNG frame by frame.
pub struct ApngWriter<W: Write> {
    writer: Writer<W>,
    size: (u32, u32),
    has_alpha: bool,
    before: Option<Image>,
}

impl<W: Write> ApngWriter<W> {
    /// Begins a file of `count` frames that repeats without end. Without alpha every texel is
    /// treated as opaque.
    ///
    /// # Errors
    /// If the size or the count is 0, or `out` fails.
    pub fn new(
        out: W,
        (width, height): (u32, u32),
        (count, rate): (u32, FrameRate),
        has_alpha: bool,
    ) -> io::Result<Self> {
        let mut encoder = png::Encoder::new(out, width, height);
        encoder.set_color(if has_alpha {
            ColorType::Rgba
        } else {
            ColorType::Rgb
        });
        encoder.set_depth(BitDepth::Eight);
        encoder.set_compression(Compression::Balanced);
        encoder.set_filter(Filter::Adaptive);
        encoder.set_animated(count, 0).map_err(error)?;
        let delay = (rate.seconds(), rate.frames());
        encoder.set_frame_delay(delay.0, delay.1).map_err(error)?;
        encoder.set_blend_op(BlendOp::Source).map_err(error)?;
        encoder.validate_sequence(true);
        Ok(Self {
            writer: encoder.write_header().map_err(error)?,
            size: (width, height),
            has_alpha,
            before: None,
        })
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// If the frame has another size, or is one too many, or the output fails.
    pub fn add(&mut self, frame: Image) -> io::Result<()> {
        check_frame(&frame, self.size)?;
        let area = match &self.before {
            Some(before) => changed_area(before, &frame),
            None => Area::of(&frame),
        };
        let part = crop(&frame, area);
        let writer = &mut self.writer;
        // From the top left, where every size fits.
        writer.set_frame_position(0, 0).map_err(error)?;
        let size = writer.set_frame_dimension(area.width, area.height);
        size.map_err(error)?;
        writer.set_frame_position(area.x, area.y).map_err(error)?;
        let written = if self.has_alpha {
            writer.write_image_data(&part.rgba)
        } else {
            writer.write_image_data(&rgb_from_rgba(&part.rgba))
        };
        self.before = Some(frame);
        written.map_err(error)
    }

    /// Ends the file.
    ///
    /// # Errors
    /// If frames are missing, or the output fails.
    pub fn finish(self) -> io::Result<()> {
        self.writer.finish().map_err(error)
    }
}

impl<W: Write> std::fmt::Debug for ApngWriter<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut name = f.debug_struct("ApngWriter");
        name.field("size", &self.size).finish_non_exhaustive()
    }
}

fn error(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        other => invalid(other.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::samples::{noise, opaque};

    /// The frames of a file as a viewer shows them, with its delays.
    fn read(bytes: &[u8]) -> Vec<(Image, u16, u16)> {
        let mut reader = png::Decoder::new(io::Cursor::new(bytes))
            .read_info()
            .expect("a PNG");
        let control = reader.info().animation_control.expect("animated");
        assert_eq!(control.num_plays, 0);
        let (width, height) = (reader.info().width, reader.info().height);
        let mut canvas = Image::filled(width, height, [0; 4]);
        let mut frames = Vec::new();
        for _ in 0..control.num_frames {
            let mut samples = vec![0; reader.output_buffer_size().expect("small")];
            let info = reader.next_frame(&mut samples).expect("a frame");
            let at = *reader.info().frame_control.as_ref().expect("a frame");
            let channels = info.color_type.samples();
            for y in 0..info.height {
                for x in 0..info.width {
                    let texel = &samples[((y * info.width + x) as usize) * channels..][..channels];
                    let to = ((at.y_offset + y) * width + at.x_offset + x) as usize * 4;
                    canvas.rgba[to..to + channels].copy_from_slice(texel);
                    if channels == 3 {
                        canvas.rgba[to + 3] = 255;
                    }
                }
            }
            frames.push((canvas.clone(), at.delay_num, at.delay_den));
        }
        frames
    }

    /// Rows: I4.
    #[test]
    fn frames_read_back() {
        let mut frames = vec![noise(13, 9, 1), noise(13, 9, 2)];
        // One texel, then none.
        let mut third = frames[1].clone();
        third.rgba[4 * 40] ^= 5;
        frames.extend([third.clone(), third, noise(13, 9, 3)]);
        let rate = FrameRate::new(25, 2).expect("not 0");
        for has_alpha in [true, false] {
            let mut out = Vec::new();
            let mut writer =
                ApngWriter::new(&mut out, (13, 9), (5, rate), has_alpha).expect("valid");
            for frame in &frames {
                writer.add(frame.clone()).expect("a frame");
            }
            writer.finish().expect("all frames");
            let read = read(&out);
            assert_eq!(read.len(), 5);
            for (frame, (shown, num, den)) in frames.iter().zip(read) {
                let expected = if has_alpha {
                    frame.clone()
                } else {
                    opaque(frame.clone())
                };
                assert_eq!(shown, expected);
                assert_eq!((num, den), (2, 25));
            }
        }
    }

    #[test]
    fn wrong_frames_are_errors() {
        let rate = FrameRate::new(10, 1).expect("not 0");
        let begin = || ApngWriter::new(Vec::new(), (4, 3), (1, rate), true).expect("valid");
        assert!(begin().finish().is_err(), "a frame is missing");
        assert!(begin().add(noise(3, 4, 1)).is_err(), "another size");
        let mut writer = begin();
        writer.add(noise(4, 3, 1)).expect("the frame");
        assert!(writer.add(noise(4, 3, 1)).is_err(), "one too many");
        assert!(ApngWriter::new(Vec::new(), (4, 3), (0, rate), true).is_err());
    }
}
