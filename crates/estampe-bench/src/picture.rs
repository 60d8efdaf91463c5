//! Pictures as PNG files, and the differences of two renderers' pictures.

use crate::BenchError;
use crate::frame::FrameSize;
use std::fs::File;
use std::io::{BufReader, BufWriter, Write};
use std::path::Path;

/// A picture in RGBA8, row by row from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// Its size.
    pub size: FrameSize,
    /// Its pixels.
    pub rgba: Vec<u8>,
}

impl Picture {
    /// Writes a PNG.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_png(&self, path: &Path) -> Result<(), BenchError> {
        let file = File::create(path).map_err(|source| file_error(path, source))?;
        let mut file = BufWriter::new(file);
        let mut encoder = png::Encoder::new(&mut file, self.size.width, self.size.height);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Fast);
        encoder
            .write_header()
            .and_then(|mut writer| writer.write_image_data(&self.rgba))
            .map_err(|error| file_error(path, error.into()))?;
        file.flush().map_err(|source| file_error(path, source))
    }

    /// Reads a PNG of 8-bit RGBA, the format that `peerbench` writes.
    ///
    /// # Errors
    /// If the file cannot be read or has another format.
    pub fn read_png(path: &Path) -> Result<Self, BenchError> {
        let refuse = |reason: String| BenchError::Picture {
            path: path.to_owned(),
            reason,
        };
        let file = File::open(path).map_err(|source| file_error(path, source))?;
        let mut reader = png::Decoder::new(BufReader::new(file))
            .read_info()
            .map_err(|error| refuse(error.to_string()))?;
        if reader.output_color_type() != (png::ColorType::Rgba, png::BitDepth::Eight) {
            return Err(refuse("not 8-bit RGBA".to_owned()));
        }
        let len = reader.output_buffer_size();
        let mut rgba = vec![0; len.ok_or_else(|| refuse("too large".to_owned()))?];
        let frame = reader
            .next_frame(&mut rgba)
            .map_err(|error| refuse(error.to_string()))?;
        rgba.truncate(frame.buffer_size());
        let size = FrameSize {
            width: frame.width,
            height: frame.height,
        };
        Ok(Self { size, rgba })
    }
}

fn file_error(path: &Path, source: std::io::Error) -> BenchError {
    BenchError::File {
        path: path.to_owned(),
        source,
    }
}

/// The difference of two pictures of one size.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Difference {
    /// The number of pixels.
    pub pixels: u64,
    /// The number of pixels that differ at all.
    pub differing: u64,
    /// The number of pixels that differ by more than [`Difference::TOLERANCE`] in some channel.
    pub beyond: u64,
    /// The largest difference of a channel.
    pub max: u8,
    /// The mean difference of a channel.
    pub mean: f64,
}

impl Difference {
    /// The greatest difference that is attributed to rounding: of interpolation, filtering and
    /// blending.
    pub const TOLERANCE: u8 = 8;
    /// Pictures with at most this share of pixels beyond the tolerance count as the same: these are
    /// pixels on edges and between mip levels, where the specifications leave a choice.
    pub const GATE: f64 = 0.005;

    /// Compares two pictures; `None` if their sizes differ.
    #[must_use]
    pub fn between(a: &Picture, b: &Picture) -> Option<Self> {
        if a.size != b.size || a.rgba.len() != b.rgba.len() {
            return None;
        }
        let mut difference = Self::default();
        let mut sum = 0_u64;
        for (a, b) in a
            .rgba
            .as_chunks::<4>()
            .0
            .iter()
            .zip(b.rgba.as_chunks::<4>().0)
        {
            let mut worst = 0;
            for (a, b) in a.iter().zip(b) {
                let delta = a.abs_diff(*b);
                worst = worst.max(delta);
                sum += u64::from(delta);
            }
            difference.pixels += 1;
            difference.differing += u64::from(worst > 0);
            difference.beyond += u64::from(worst > Self::TOLERANCE);
            difference.max = difference.max.max(worst);
        }
        difference.mean = sum as f64 / (difference.pixels.max(1) * 4) as f64;
        Some(difference)
    }

    /// The share of pixels beyond the tolerance, 0..=1.
    #[must_use]
    pub fn share_beyond(&self) -> f64 {
        self.beyond as f64 / self.pixels.max(1) as f64
    }

    /// Returns true if the pictures count as equal: at most [`Difference::GATE`] of their pixels
    /// are beyond the tolerance.
    #[must_use]
    pub fn passes(&self) -> bool {
        self.share_beyond() <= Self::GATE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gray(values: &[u8]) -> Picture {
        Picture {
            size: FrameSize {
                width: u32::try_from(values.len()).unwrap(),
                height: 1,
            },
            rgba: values.iter().flat_map(|&v| [v, v, v, 255]).collect(),
        }
    }

    #[test]
    fn differences_are_counted_by_pixel() {
        let difference =
            Difference::between(&gray(&[0, 10, 20, 30]), &gray(&[0, 11, 28, 39])).unwrap();
        let expected = Difference {
            pixels: 4,
            differing: 3,
            beyond: 1,
            max: 9,
            mean: (1.0 + 8.0 + 9.0) * 3.0 / 16.0,
        };
        assert_eq!(difference, expected);
        assert!(!difference.passes());
        assert_eq!(Difference::between(&gray(&[0]), &gray(&[0, 0])), None);
    }

    #[test]
    fn one_pixel_in_two_hundred_may_differ() {
        let mut values = vec![0; 1000];
        values[..5].fill(255);
        assert!(
            Difference::between(&gray(&[0; 1000]), &gray(&values))
                .unwrap()
                .passes()
        );
        values[5] = 255;
        assert!(
            !Difference::between(&gray(&[0; 1000]), &gray(&values))
                .unwrap()
                .passes()
        );
    }

    #[test]
    fn a_png_reads_back_as_it_was_written() {
        let folder = std::env::temp_dir().join(format!("estampe-bench-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("gray.png");
        let picture = gray(&[1, 2, 3, 250]);
        picture.write_png(&path).unwrap();
        assert_eq!(Picture::read_png(&path).unwrap(), picture);
        std::fs::write(&path, b"not a PNG").unwrap();
        assert!(matches!(
            Picture::read_png(&path),
            Err(BenchError::Picture { .. })
        ));
        std::fs::remove_dir_all(&folder).unwrap();
        assert!(matches!(
            Picture::read_png(&path),
            Err(BenchError::File { .. })
        ));
    }
}
