//! The reader of colours.

use crate::image::fault::{check_size, malformed};
use crate::{AssetError, Limits};
use estampe_scene::HdrImage;
use exr::meta::MetaData;
use exr::prelude::{ReadChannels, ReadLayers};
use std::io::Cursor;

/// The greatest finite half: what infinite light becomes.
const MOST: f32 = 65_504.0;

/// The most channels and parts of a file, whose samples are decoded even if no colour needs them.
const MOST_CHANNELS: u64 = 64;

/// Reads the first part that has the channels R, G and B; they are linear. Negative numbers and NaN
/// become 0, and infinity 65504.
///
/// # Errors
/// `Malformed` if the file is cut off or contradicts itself, `Unsupported` for files without these
/// channels, deep data and compressions other than none, RLE, ZIP, PIZ, PXR24, B44 and B44A,
/// `LimitExceeded` before any sample is stored.
pub fn decode_exr(bytes: &[u8], limits: &Limits) -> Result<HdrImage, AssetError> {
    // The decoder reports no location, so the error names the end of the file.
    let refuse = |error: exr::error::Error| match error {
        exr::error::Error::NotSupported(what) => unsupported(format!("OpenEXR with {what}")),
        error => malformed(bytes.len(), format!("the OpenEXR is not valid: {error}")),
    };
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(refuse)?;
    let mut samples = 0_u64;
    for header in &meta.headers {
        let size = header.layer_size;
        let side = |side: usize| u32::try_from(side).unwrap_or(u32::MAX);
        check_size(side(size.width()), side(size.height()), limits)?;
        let channels = header.channels.list.len() as u64;
        let pixels = size.width() as u64 * size.height() as u64;
        samples = samples.saturating_add(pixels.saturating_mul(channels));
        Limits::check("channels", channels, MOST_CHANNELS)?;
    }
    let most = limits.max_image_pixels.saturating_mul(MOST_CHANNELS);
    Limits::check("samples", samples, most)?;
    let has = |header: &exr::meta::header::Header, name: &str| {
        { header.channels.list.iter() }.any(|channel| channel.name.eq(name))
    };
    let is_color = |header: &_| ["R", "G", "B"].iter().all(|name| has(header, name));
    if !meta.headers.iter().any(is_color) {
        return Err(unsupported(
            "OpenEXR without the channels R, G and B".to_owned(),
        ));
    }
    let read = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| Texels {
                width: size.width(),
                rgb: vec![0.0; size.area() * 3],
            },
            |texels: &mut Texels, at, (r, g, b): (f32, f32, f32)| {
                let first = (at.y() * texels.width + at.x()) * 3;
                if let Some(texel) = texels.rgb.get_mut(first..first + 3) {
                    texel.copy_from_slice(&[r, g, b].map(light));
                }
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes));
    let layer = read.map_err(refuse)?.layer_data;
    let side = |side: usize| u32::try_from(side).unwrap_or(u32::MAX);
    Ok(HdrImage {
        width: side(layer.size.width()),
        height: side(layer.size.height()),
        rgb: layer.channel_data.pixels.rgb,
    })
}

/// The texels that are read.
struct Texels {
    width: usize,
    rgb: Vec<f32>,
}

fn light(value: f32) -> f32 {
    if value.is_nan() {
        0.0
    } else {
        value.clamp(0.0, MOST)
    }
}

fn unsupported(what: String) -> AssetError {
    AssetError::unsupported(
        format!("{what} cannot be read"),
        "save it with channels R, G, B and ZIP compression, or as Radiance HDR",
    )
}
