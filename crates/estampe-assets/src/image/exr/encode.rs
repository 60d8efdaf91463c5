//! The writer.

use crate::AssetError;
use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image, WritableImage};
use std::io::Cursor;

/// A channel of an image.
#[derive(Debug, Clone, PartialEq)]
pub struct ExrChannel {
    /// The name; those of a layer begin with its name and a point, as in `normal.X`.
    pub name: String,
    /// A sample for each pixel, row by row from the top.
    pub samples: ExrSamples,
}

/// The samples of a channel.
#[derive(Debug, Clone, PartialEq)]
pub enum ExrSamples {
    /// 32-bit floats.
    Float(Vec<f32>),
    /// 32-bit integers.
    Uint(Vec<u32>),
}

impl ExrSamples {
    fn len(&self) -> usize {
        match self {
            Self::Float(samples) => samples.len(),
            Self::Uint(samples) => samples.len(),
        }
    }
}

/// The bytes of an OpenEXR of one part, compressed without loss. Channels are sorted by their
/// names, as the format demands.
///
/// # Errors
/// `Malformed` if there are no pixels or channels, two channels of one name, or not a sample for
/// each pixel.
pub fn encode_exr(
    (width, height): (u32, u32),
    channels: Vec<ExrChannel>,
) -> Result<Vec<u8>, AssetError> {
    let malformed = |what: String| {
        AssetError::malformed(
            what,
            "give each channel a name of its own and a sample a pixel",
        )
    };
    let expected = u64::from(width) * u64::from(height);
    if expected == 0 || channels.is_empty() {
        let what = format!(
            "an image of {width}x{height} pixels and {} channels",
            channels.len()
        );
        return Err(malformed(what));
    }
    let mut names: Vec<&str> = channels
        .iter()
        .map(|channel| channel.name.as_str())
        .collect();
    names.sort_unstable();
    if let Some(pair) = names.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(malformed(format!("two channels are called {:?}", pair[0])));
    }
    for channel in &channels {
        let count = channel.samples.len();
        if count as u64 != expected || channel.name.is_empty() || !channel.name.is_ascii() {
            let name = &channel.name;
            let what = format!("channel {name:?} has {count} samples of {expected}");
            return Err(malformed(what));
        }
    }
    let channels = channels.into_iter().map(|channel| {
        let samples = match channel.samples {
            ExrSamples::Float(samples) => FlatSamples::F32(samples),
            ExrSamples::Uint(samples) => FlatSamples::U32(samples),
        };
        AnyChannel::new(channel.name.as_str(), samples)
    });
    let size = (width as usize, height as usize);
    let image = Image::from_encoded_channels(
        size,
        exr::prelude::Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(channels.collect()),
    );
    let mut bytes = Cursor::new(Vec::new());
    let written = image.write().non_parallel().to_buffered(&mut bytes);
    written.map_err(|error| malformed(format!("the image cannot be written: {error}")))?;
    Ok(bytes.into_inner())
}
