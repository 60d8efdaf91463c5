//! Images that wait until the geometry is known, because it decides how large they need to be.
//!
//! ```text
//!   readers -> DeferredImages   encoded bytes, and sizes from headers, within all limits
//!           -> TextureDetail    by scene and camera: the first mip level that is sampled
//!           -> decode           by several threads, each image to its level
//!           -> materials        alpha modes from what the images contain; images that fail
//! ```

mod decode;
mod detail;
mod material_textures;

pub(super) use decode::decode_all;
pub use detail::{FullDetail, LeastDetail, TextureDetail};
pub(super) use material_textures::{retain_pbr_textures, retain_textures};

use super::options::TextureAlpha;
use crate::error::Location;
use crate::image::stated_size;
use crate::warning::Warnings;
use crate::{AssetError, Limits};
use glam::Vec3;
use std::borrow::Cow;

/// The images that a reader has found, by their index in the scene.
#[derive(Debug)]
pub(super) struct DeferredImages<'a> {
    images: Vec<Deferred<'a>>,
    alpha_rules: Vec<AlphaRule>,
    pixels_left: u64,
    bytes_left: u64,
}

/// An image that is not decoded yet.
#[derive(Debug)]
struct Deferred<'a> {
    source: Source<'a>,
    /// Width and height of the whole image.
    size: (u32, u32),
}

/// Where an image's texels come from.
#[derive(Debug)]
enum Source<'a> {
    /// A file, as it is.
    File(Encoded<'a>),
    /// A file whose alpha is unused if it is 0 everywhere.
    Texture(Encoded<'a>),
    /// A texture, white without a colour, and the file whose brightness is its alpha.
    WithOpacity(Option<Encoded<'a>>, Encoded<'a>),
    /// The roughness of specular-glossiness materials, from another image's alpha.
    Roughness { of: usize, glossiness: f32 },
}

/// A file's bytes, whose header was read.
#[derive(Debug)]
pub(super) struct Encoded<'a> {
    bytes: Cow<'a, [u8]>,
    size: (u32, u32),
    origin: Origin,
}

/// Where an image is named, for warnings.
#[derive(Debug, Clone)]
pub(super) enum Origin {
    /// A place in a file, and the image's name.
    Named {
        file: String,
        location: Option<Location>,
        name: String,
    },
    /// An image of a glTF file.
    Json { file: String, pointer: String },
}

/// A material whose use of alpha depends on the contents of its base-colour texture.
#[derive(Debug)]
pub(super) struct AlphaRule {
    pub(super) material: usize,
    pub(super) chosen: TextureAlpha,
    /// The base colour if the texture cannot be decoded; `None` is the material's.
    pub(super) color_without: Option<Vec3>,
}

impl<'a> DeferredImages<'a> {
    pub(super) fn new(limits: &Limits) -> Self {
        Self {
            images: Vec::new(),
            alpha_rules: Vec::new(),
            pixels_left: limits.max_total_image_pixels,
            bytes_left: limits.max_file_bytes,
        }
    }

    /// Encoded bytes that may still be kept.
    pub(super) fn bytes_left(&self) -> u64 {
        self.bytes_left
    }

    /// Takes a file's bytes if they and the image in them are within the limits of all images
    /// together.
    pub(super) fn encoded(
        &mut self,
        bytes: Cow<'a, [u8]>,
        origin: Origin,
        limits: &Limits,
    ) -> Result<Encoded<'a>, AssetError> {
        // Decoding takes time for bytes that add no pixels, too.
        Limits::check("bytes", bytes.len() as u64, self.bytes_left)?;
        self.bytes_left -= bytes.len() as u64;
        let Some(size) = stated_size(&bytes) else {
            // Nothing is allocated for an image without a size.
            return Err(match crate::image::decode(&bytes, limits) {
                Err(error) => error,
                Ok(_) => AssetError::malformed("the image has no size", "save it again"),
            });
        };
        self.take_pixels(size, limits)?;
        Ok(Encoded {
            bytes,
            size,
            origin,
        })
    }

    fn take_pixels(&mut self, size: (u32, u32), limits: &Limits) -> Result<(), AssetError> {
        let pixels = u64::from(size.0) * u64::from(size.1);
        let most = limits.max_image_pixels.min(self.pixels_left);
        Limits::check("pixels", pixels, most)?;
        self.pixels_left -= pixels;
        Ok(())
    }

    /// Adds a file as it is; returns its index in the scene.
    pub(super) fn add_file(&mut self, file: Encoded<'a>) -> usize {
        let size = file.size;
        self.add(Source::File(file), size)
    }

    /// Adds a texture of a colour, of an opacity, or of both; `None` if there is neither. An alpha
    /// that is 0 everywhere becomes 255: some programs write it into an unused channel.
    pub(super) fn add_texture(
        &mut self,
        color: Option<Encoded<'a>>,
        opacity: Option<Encoded<'a>>,
    ) -> Option<usize> {
        let (source, size) = match (color, opacity) {
            (None, None) => return None,
            (Some(color), None) => {
                let size = color.size;
                (Source::Texture(color), size)
            }
            (color, Some(opacity)) => {
                let size = color.as_ref().map_or(opacity.size, |color| color.size);
                (Source::WithOpacity(color, opacity), size)
            }
        };
        Some(self.add(source, size))
    }

    /// Adds the roughness that image `of` and a factor make; `None` if that is more than the limits
    /// allow.
    pub(super) fn add_roughness(
        &mut self,
        of: usize,
        glossiness: f32,
        limits: &Limits,
    ) -> Option<usize> {
        let size = self.images.get(of)?.size;
        self.take_pixels(size, limits).ok()?;
        Some(self.add(Source::Roughness { of, glossiness }, size))
    }

    /// Sets the use of a material's alpha when its texture is decoded.
    pub(super) fn add_alpha_rule(&mut self, rule: AlphaRule) {
        self.alpha_rules.push(rule);
    }

    fn add(&mut self, source: Source<'a>, size: (u32, u32)) -> usize {
        self.images.push(Deferred { source, size });
        self.images.len() - 1
    }
}

impl Origin {
    /// Adds the warning that the image is left out.
    pub(super) fn warn(&self, error: &AssetError, warnings: &mut Warnings) {
        match self {
            Self::Named {
                file,
                location,
                name,
            } => warnings.add(file, *location, || {
                format!("the texture `{name}` is omitted: {error}")
            }),
            Self::Json { file, pointer } => warnings.add_at_json(file, || {
                (pointer.clone(), format!("the image is left out: {error}"))
            }),
        }
    }
}
