//! The command line of `estampe diff`: read, compare, report, return the exit code.

use std::fs::File;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use estampe_assets::image::{ImageFormat, decode, encode};
use estampe_assets::{AssetError, Limits};
use estampe_scene::Image;

use super::compare::compare;
use super::flip::{FlipMap, flip};
use super::heatmap;
use super::report::{Report, write_json, write_text};

/// The images are the same, within the limit.
pub(crate) const EXIT_SAME: u8 = 0;
/// The images differ, or have different sizes.
pub(crate) const EXIT_DIFFERENT: u8 = 1;
/// The command line is invalid.
pub(crate) const EXIT_USAGE: u8 = 2;
/// An image cannot be read, or the heat map or the report cannot be written.
pub(crate) const EXIT_UNREADABLE: u8 = 3;

/// Compares two images (PNG, JPEG, WebP, TGA, BMP, DDS, KTX2) and reports their difference.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
The result is exact: the images are the same if no channel of any pixel (alpha included) differs \
by more than --max. FLIP measures the difference that an observer perceives when the two images alternate on \
a screen, from 0 (none) to 1 (the greatest).

Exit codes: 0 same within the limit, 1 different, 2 wrong usage, 3 a file cannot be read or written.

Examples:
  estampe diff expected.png actual.png
  estampe diff expected.png actual.png --max 2 --heatmap where.png
  estampe diff a.tga b.png --json | jq .flip

With --json one object is written: a, b {path, width, height}; same, identical (booleans); limit; pixels, \
differing_pixels, pixels_over_limit; max, mean {r, g, b, a, all} in steps of 8 bits; flip {mean, max}; \
heatmap (path or null). If the sizes differ, all fields from pixels on are null. A file that cannot be read \
gives {error}.")]
pub(crate) struct DiffArgs {
    /// The reference image, for example the expected one
    #[arg(value_name = "A")]
    pub(crate) a: PathBuf,

    /// The image to test
    #[arg(value_name = "B")]
    pub(crate) b: PathBuf,

    /// The largest difference of a channel that still counts as the same, in steps of 8 bits (0 to
    /// 255)
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) max: u8,

    /// Write the perceived difference of each pixel as an image (.png, .tga, .webp, .jpg): black
    /// for none, over purple, red and orange to pale yellow for the greatest
    #[arg(long, value_name = "OUT")]
    pub(crate) heatmap: Option<PathBuf>,

    /// Write the numbers as one JSON object to standard output
    #[arg(long)]
    pub(crate) json: bool,
}

/// Runs the command; the report goes to `out`, errors to `err`. Returns the exit code.
pub(crate) fn run(args: &DiffArgs, out: &mut dyn Write, err: &mut dyn Write) -> u8 {
    let (code, message) = match compare_files(args, out) {
        Ok(is_same) => return if is_same { EXIT_SAME } else { EXIT_DIFFERENT },
        Err(Failure::Usage(message)) => (EXIT_USAGE, message),
        Err(Failure::Unreadable(message)) => {
            if args.json {
                // The exit code reports the failure; an error on a closed pipe cannot be reported.
                let _ = writeln!(out, "{}", serde_json::json!({ "error": message }));
            }
            (EXIT_UNREADABLE, message)
        }
    };
    // An error on standard error cannot be reported.
    let _ = writeln!(err, "estampe diff: {message}");
    code
}

/// Reasons why the images could not be compared.
enum Failure {
    Usage(String),
    Unreadable(String),
}

/// Compares the files; true if the images are the same within the limit.
fn compare_files(args: &DiffArgs, out: &mut dyn Write) -> Result<bool, Failure> {
    let heatmap = match &args.heatmap {
        None => None,
        Some(path) => Some((path.as_path(), heatmap_format(path)?)),
    };
    let a = read(&args.a)?;
    let b = read(&args.b)?;

    // Identical images have no perceived difference to compute.
    let comparison = compare(&a, &b, args.max);
    let flip = comparison.map(|comparison| {
        if comparison.is_identical() {
            FlipMap {
                width: a.width,
                height: a.height,
                values: vec![0.0; a.rgba.len() / 4],
            }
        } else {
            flip(&a, &b)
        }
    });
    let painted = match (&flip, heatmap) {
        (Some(map), Some((path, format))) => {
            let unwritable = |reason: String| {
                Failure::Unreadable(format!(
                    "cannot write the heat map {}: {reason}",
                    path.display()
                ))
            };
            let bytes = encode(&heatmap::paint(map), format)
                .map_err(|error| unwritable(error.to_string()))?;
            write_whole(path, &bytes).map_err(|error| unwritable(error.to_string()))?;
            Some(path)
        }
        _ => None,
    };

    let report = Report {
        args,
        a: &a,
        b: &b,
        comparison,
        flip: flip.as_ref(),
        heatmap: painted,
    };
    let write = if args.json { write_json } else { write_text };
    write(&report, out)
        .and_then(|()| out.flush())
        .map_err(|error| Failure::Unreadable(format!("cannot write the report: {error}")))?;
    Ok(report.is_same())
}

/// The format of the heat map, by its file name.
fn heatmap_format(path: &Path) -> Result<ImageFormat, Failure> {
    ImageFormat::from_path(path).ok_or_else(|| {
        Failure::Usage(format!(
            "the heat map {} has no known extension; name it .png, .tga, .webp or .jpg",
            path.display()
        ))
    })
}

/// Reads an image, of any length up to the limit even if the file states none.
fn read(path: &Path) -> Result<Image, Failure> {
    let limits = Limits::default();
    let unreadable = |reason: String| Failure::Unreadable(reason);
    let io = |error: io::Error| unreadable(format!("{}: {error}; check the name", path.display()));
    let file = File::open(path).map_err(io)?;
    let mut bytes = Vec::new();
    file.take(limits.max_file_bytes.saturating_add(1))
        .read_to_end(&mut bytes)
        .map_err(io)?;
    decode(&bytes, &limits)
        .map_err(|error: AssetError| unreadable(error.in_file(&path.to_string_lossy()).to_string()))
}

/// Writes a file completely or not at all: to a temporary name in the same folder, then renamed.
fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.part", std::process::id()));
    let part = path.with_file_name(name);
    let written = std::fs::write(&part, bytes).and_then(|()| std::fs::rename(&part, path));
    if written.is_err() {
        // The first error is reported; removing the temporary file may fail.
        let _ = std::fs::remove_file(&part);
    }
    written
}

#[cfg(test)]
mod tests;
