//! Textures as PNG files: the feature `png`.

use crate::{Device, Texture, TextureError, rgba};
use png::{BitDepth, ColorType, Compression, Encoder, Filter};
use std::path::{Path, PathBuf};

/// The reason why a texture was not written as PNG.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PngError {
    /// The texture is of another format, or cannot be read.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// The encoder refuses the picture.
    #[error("the picture cannot be encoded: {0}")]
    Encoding(String),
    /// The file cannot be written.
    #[error("{} cannot be written: {error}", path.display())]
    File {
        /// The path of the file.
        path: PathBuf,
        /// The reason.
        error: std::io::Error,
    },
}

/// # PNG files
///
/// With the feature `png`.
impl Device {
    /// The first mip level and layer of a texture as a PNG file of 8-bit RGBA, or of RGB if every
    /// texel is opaque. The same texels give the same bytes on every machine.
    ///
    /// The codes are written as they are. Viewers take them for sRGB, so render into
    /// [`TextureFormat::Rgba8UnormSrgb`](crate::TextureFormat), and divide premultiplied colours by alpha.
    ///
    /// ```
    /// # use estampe::{Device, DeviceDescriptor, TextureDescriptor, TextureFormat};
    /// let device = Device::new(&DeviceDescriptor::default())?;
    /// let format = TextureFormat::Rgba8UnormSrgb;
    /// let black = device.create_texture(&TextureDescriptor::new_2d(4, 4, format))?;
    /// assert_eq!(device.encode_png(&black)?[..4], *b"\x89PNG");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`PngError`] if the format is not rgba8unorm, bgra8unorm or their sRGB counterparts, or the
    /// texture cannot be read, as for [`Device::read_texture`].
    pub fn encode_png(&self, texture: &Texture) -> Result<Vec<u8>, PngError> {
        let texels = rgba::read(self, texture)?;
        encode(texture.width(), texture.height(), &texels)
    }

    /// Writes [`Device::encode_png`] to a file.
    ///
    /// # Errors
    /// [`PngError`] as for [`Device::encode_png`], or if the file cannot be written.
    pub fn write_png(&self, texture: &Texture, path: impl AsRef<Path>) -> Result<(), PngError> {
        let (bytes, path) = (self.encode_png(texture)?, path.as_ref());
        std::fs::write(path, bytes).map_err(|error| PngError::File {
            path: path.to_owned(),
            error,
        })
    }
}

/// Encodes RGBA with constant settings: the default compression of the `png` crate and an adaptive
/// filter per row. Its fastest compression takes a twentieth of the time, and twice the bytes.
fn encode(width: u32, height: u32, rgba: &[u8]) -> Result<Vec<u8>, PngError> {
    let texels = rgba.as_chunks::<4>().0;
    let is_opaque = texels.iter().all(|texel| texel[3] == 255);
    let rgb: Vec<u8>;
    let (color, samples) = if is_opaque {
        let channels = texels.iter().flat_map(|&[r, g, b, _]| [r, g, b]);
        rgb = channels.collect();
        (ColorType::Rgb, rgb.as_slice())
    } else {
        (ColorType::Rgba, rgba)
    };
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(color);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    encoder.set_filter(Filter::Adaptive);
    let written = encoder.write_header().and_then(|mut writer| {
        writer.write_image_data(samples)?;
        writer.finish()
    });
    match written {
        Ok(()) => Ok(bytes),
        Err(error) => Err(PngError::Encoding(error.to_string())),
    }
}
