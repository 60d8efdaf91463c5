//! The header: lines of text, an empty one, and the size.

use crate::image::fault::{check_size, malformed, unsupported};
use crate::{AssetError, Limits};

/// What precedes the rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Header {
    pub(super) width: u32,
    pub(super) height: u32,
    /// Rows come from the bottom.
    pub(super) is_upside_down: bool,
    /// Columns come from the right.
    pub(super) is_mirrored: bool,
    /// By which colours are divided: the product of all EXPOSURE lines.
    pub(super) exposure: f32,
    /// Where the rows begin.
    pub(super) end: usize,
}

/// The longest header: a file without an empty line is none.
const MOST_BYTES: usize = 1 << 16;

impl Header {
    pub(super) fn parse(bytes: &[u8], limits: &Limits) -> Result<Self, AssetError> {
        let mut lines = Lines { bytes, at: 0 };
        if !lines.next()?.starts_with(b"#?") {
            return Err(malformed(0, "a Radiance HDR begins with #?"));
        }
        let mut exposure = 1.0_f32;
        loop {
            let start = lines.at;
            let line = lines.next()?;
            if line.is_empty() {
                break;
            }
            let text = String::from_utf8_lossy(line);
            match text.split_once('=') {
                Some(("FORMAT", format)) if format.trim() == "32-bit_rle_xyze" => {
                    return Err(unsupported("a Radiance HDR of XYZ colours"));
                }
                Some(("FORMAT", format)) if format.trim() != "32-bit_rle_rgbe" => {
                    return Err(malformed(
                        start,
                        format!("the format {format:?} is unknown"),
                    ));
                }
                Some(("EXPOSURE", value)) => {
                    let value: Option<f32> = value.trim().parse().ok();
                    let value = value.filter(|value| value.is_finite() && *value > 0.0);
                    let Some(value) = value else {
                        return Err(malformed(start, "EXPOSURE is no number above 0"));
                    };
                    exposure *= value;
                }
                _ => {}
            }
        }
        let start = lines.at;
        let size = String::from_utf8_lossy(lines.next()?).into_owned();
        let words: Vec<&str> = size.split_ascii_whitespace().collect();
        let [first, rows, second, columns] = words[..] else {
            return Err(malformed(start, "there is no size such as -Y 512 +X 1024"));
        };
        let side = |text: &str| text.parse::<u32>().ok().filter(|&side| side > 0);
        let (Some(height), Some(width)) = (side(rows), side(columns)) else {
            return Err(malformed(start, format!("{size:?} is no size")));
        };
        if !matches!(first, "-Y" | "+Y") || !matches!(second, "-X" | "+X") {
            return Err(unsupported(format!(
                "a Radiance HDR turned by {first} {second}"
            )));
        }
        check_size(width, height, limits)?;
        Ok(Self {
            width,
            height,
            is_upside_down: first == "+Y",
            is_mirrored: second == "-X",
            exposure: exposure.clamp(f32::MIN_POSITIVE, f32::MAX),
            end: lines.at,
        })
    }
}

/// The lines of the header.
struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Lines<'a> {
    /// The next line, without its end.
    fn next(&mut self) -> Result<&'a [u8], AssetError> {
        let rest = &self.bytes[self.at..self.bytes.len().min(MOST_BYTES).max(self.at)];
        let Some(length) = rest.iter().position(|&byte| byte == b'\n') else {
            return Err(malformed(
                self.at,
                "the header of the Radiance HDR has no end",
            ));
        };
        self.at += length + 1;
        let line = &rest[..length];
        Ok(line.strip_suffix(b"\r").unwrap_or(line))
    }
}
