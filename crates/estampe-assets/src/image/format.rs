//! Detection of an image's format, and dispatch to its reader or writer.

use std::path::Path;

use estampe_scene::{Image, Workers};

use super::fault::{malformed, unsupported};
use super::reduce::{Reduced, Reduction, reduce};
use super::{bmp, dds, jpeg, ktx2, png, tga, webp};
use crate::{AssetError, Limits};

/// A format in which images are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ImageFormat {
    /// Portable Network Graphics: lossless, with alpha.
    Png,
    /// JPEG: small, lossy, without alpha.
    Jpeg,
    /// Truevision TGA: lossless and simple, with alpha.
    Tga,
    /// WebP: lossless, with alpha. Written, not read.
    Webp,
}

impl ImageFormat {
    /// The format of a file name's extension, in either case: `png`, `jpg`, `jpeg`, `jpe`, `jfif`,
    /// `tga`, `icb`, `vda`, `vst`, `webp`.
    #[must_use]
    pub fn from_path(path: &Path) -> Option<Self> {
        Self::from_extension(path.extension()?.to_str()?)
    }

    /// The format of an extension without its dot.
    #[must_use]
    pub fn from_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "png" => Some(Self::Png),
            "jpg" | "jpeg" | "jpe" | "jfif" => Some(Self::Jpeg),
            "tga" | "icb" | "vda" | "vst" => Some(Self::Tga),
            "webp" => Some(Self::Webp),
            _ => None,
        }
    }

    /// True if the format stores alpha. For a format without alpha, [`encode`] treats every pixel
    /// as opaque: composite over a background first.
    #[must_use]
    pub fn has_alpha(self) -> bool {
        match self {
            Self::Png | Self::Tga | Self::Webp => true,
            Self::Jpeg => false,
        }
    }
}

/// Rule by which a writer stores alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum AlphaChannel {
    /// If some pixel is not opaque.
    #[default]
    WhenNeeded,
    /// Even if every pixel is opaque.
    Always,
    /// Never: every pixel is treated as opaque.
    Never,
}

impl AlphaChannel {
    /// True if a file of `image` has alpha.
    pub(super) fn is_written_for(self, image: &Image) -> bool {
        match self {
            Self::WhenNeeded => image
                .rgba
                .as_chunks::<4>()
                .0
                .iter()
                .any(|texel| texel[3] != 255),
            Self::Always => true,
            Self::Never => false,
        }
    }
}

/// Reads an image: PNG, JPEG, WebP, BMP, DDS and KTX2 by their signatures, else TGA by its footer
/// or a plausible header.
///
/// # Errors
/// `LimitExceeded` if the file is larger or has more pixels than `limits` allow, before memory is
/// allocated for them; `Malformed` with a byte offset if the bytes break the format's rules;
/// `Unsupported` for other formats.
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<Image, AssetError> {
    Limits::check("bytes", bytes.len() as u64, limits.max_file_bytes)?;
    if bytes.is_empty() {
        return Err(malformed(0, "the image file is empty"));
    }
    if let Some(format) = Signed::of(bytes) {
        return match format {
            Signed::Png => png::decode(bytes, limits),
            Signed::Jpeg => jpeg::decode(bytes, limits),
            Signed::WebP => webp::decode(bytes, limits),
            Signed::Bmp => bmp::decode(bytes, limits),
            Signed::Dds => dds::decode(bytes, limits),
            Signed::Ktx2 => ktx2::decode(bytes, limits),
        };
    }
    match foreign_format(bytes) {
        Some(name) => Err(unsupported(format!("the {name} format"))),
        None if tga::looks_like_tga(bytes) => tga::decode(bytes, limits),
        None => Err(unsupported(
            "an image that is neither PNG, JPEG, WebP, TGA, BMP, DDS nor KTX2",
        )),
    }
}

/// Reads a mip level of an image: [`decode`] with less memory and time for large images. The level
/// has the bytes that the pipeline's mip levels have; of DDS and KTX2 it is the stored
/// level, if there is one.
///
/// PNG, BMP, TGA, DDS and KTX2 are reduced row by row; JPEG, WebP and interlaced PNG after they are
/// decoded.
///
/// # Errors
/// As of [`decode`], with the same limits on the size in the header. A side beyond
/// `limits.max_texture_side` is no error: the image is reduced further.
pub fn decode_reduced(
    bytes: &[u8],
    reduction: Reduction,
    limits: &Limits,
) -> Result<Image, AssetError> {
    let least = stated_size(bytes).map_or(0, |size| limits.least_level(size));
    let reduction = Reduction {
        level: reduction.level.max(least),
        ..reduction
    };
    if reduction.level == 0 {
        return decode(bytes, limits);
    }
    decode_with_alpha(bytes, reduction, limits).map(|reduced| reduced.image)
}

/// [`decode_reduced`] with the use of the whole image's alpha.
pub(crate) fn decode_with_alpha(
    bytes: &[u8],
    reduction: Reduction,
    limits: &Limits,
) -> Result<Reduced, AssetError> {
    Limits::check("bytes", bytes.len() as u64, limits.max_file_bytes)?;
    match Signed::of(bytes) {
        Some(Signed::Png) => png::decode_reduced(bytes, reduction, limits),
        Some(Signed::Jpeg) => jpeg::decode_reduced(bytes, reduction, limits),
        Some(Signed::Bmp) => bmp::decode_reduced(bytes, reduction, limits),
        Some(Signed::Dds) => dds::decode_reduced(bytes, reduction, limits),
        Some(Signed::Ktx2) => ktx2::decode_reduced(bytes, reduction, limits),
        Some(Signed::WebP) => reduce(
            &decode(bytes, limits)?,
            reduction,
            Workers::new(limits.threads),
        ),
        None if foreign_format(bytes).is_none() && tga::looks_like_tga(bytes) => {
            tga::decode_reduced(bytes, reduction, limits)
        }
        // The error.
        None => reduce(
            &decode(bytes, limits)?,
            reduction,
            Workers::new(limits.threads),
        ),
    }
}

/// A level of an image that is in memory.
pub(crate) fn reduced(
    image: &Image,
    reduction: Reduction,
    limits: &Limits,
) -> Result<Image, AssetError> {
    reduce(image, reduction, Workers::new(limits.threads)).map(|reduced| reduced.image)
}

/// Width and height from the header of an image, of any format that [`decode`] reads. `None` if the
/// header is damaged, or of another format.
#[must_use]
pub fn stated_size(bytes: &[u8]) -> Option<(u32, u32)> {
    match Signed::of(bytes) {
        Some(_) => signed_size(bytes),
        None if foreign_format(bytes).is_none() && tga::looks_like_tga(bytes) => {
            tga::stated_size(bytes)
        }
        None => None,
    }
}

/// Width and height from the header of an image with a signature. `None` if it has none, or is
/// damaged.
pub(crate) fn signed_size(bytes: &[u8]) -> Option<(u32, u32)> {
    match Signed::of(bytes)? {
        Signed::Png => png::stated_size(bytes),
        Signed::Jpeg => jpeg::stated_size(bytes),
        Signed::WebP => webp::stated_size(bytes),
        Signed::Bmp => bmp::stated_size(bytes),
        Signed::Dds => dds::stated_size(bytes),
        Signed::Ktx2 => ktx2::stated_size(bytes),
    }
}

/// Writes an image with the format's default settings: PNG, TGA and WebP store alpha if a pixel
/// needs it, JPEG has quality 90 and treats every pixel as opaque.
///
/// # Errors
/// `LimitExceeded` if the format cannot store the image's size, `Malformed` if the image has no
/// pixels or its bytes do not fit its size.
pub fn encode(image: &Image, format: ImageFormat) -> Result<Vec<u8>, AssetError> {
    match format {
        ImageFormat::Png => png::encode_png(image, AlphaChannel::WhenNeeded),
        ImageFormat::Jpeg => jpeg::encode_jpeg(image, jpeg::DEFAULT_QUALITY),
        ImageFormat::Tga => tga::encode(image, tga::TgaOptions::default()),
        ImageFormat::Webp => webp::encode_webp(image, AlphaChannel::WhenNeeded),
    }
}

/// The formats that are read and start with a signature.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Signed {
    Png,
    Jpeg,
    WebP,
    Bmp,
    Dds,
    Ktx2,
}

impl Signed {
    /// The format whose signature the bytes start with.
    fn of(bytes: &[u8]) -> Option<Self> {
        const SIGNATURES: [(&[u8], Signed); 5] = [
            (png::SIGNATURE, Signed::Png),
            (jpeg::START_OF_IMAGE, Signed::Jpeg),
            (bmp::SIGNATURE, Signed::Bmp),
            (dds::SIGNATURE, Signed::Dds),
            (ktx2::SIGNATURE, Signed::Ktx2),
        ];
        if webp::is_webp(bytes) {
            return Some(Self::WebP);
        }
        SIGNATURES
            .iter()
            .find(|(signature, _)| bytes.starts_with(signature))
            .map(|&(_, format)| format)
    }
}

/// The name of a well-known unsupported format, for the error message.
fn foreign_format(bytes: &[u8]) -> Option<&'static str> {
    const SIGNATURES: [(&[u8], &str); 7] = [
        (b"GIF8", "GIF"),
        (b"II*\0", "TIFF"),
        (b"MM\0*", "TIFF"),
        (b"\xabKTX", "KTX 1"),
        (b"v/1\x01", "OpenEXR"),
        (b"#?", "Radiance HDR"),
        (b"8BPS", "Photoshop"),
    ];
    SIGNATURES
        .iter()
        .find(|(signature, _)| bytes.starts_with(signature))
        .map(|&(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::samples;

    #[test]
    fn extensions_name_formats_in_any_case() {
        for (name, format) in [
            ("a.png", Some(ImageFormat::Png)),
            ("b/c.JPEG", Some(ImageFormat::Jpeg)),
            ("d.e.Jpg", Some(ImageFormat::Jpeg)),
            ("f.TGA", Some(ImageFormat::Tga)),
            ("f.webp", Some(ImageFormat::Webp)),
            ("png", None),
            ("g.gif", None),
            ("h.", None),
        ] {
            assert_eq!(ImageFormat::from_path(Path::new(name)), format, "{name}");
        }
    }

    #[test]
    fn each_format_is_recognised_by_its_content() {
        let image = samples::noise(7, 5, 1);
        for format in [ImageFormat::Png, ImageFormat::Tga] {
            let bytes = encode(&image, format).expect("a valid image");
            assert_eq!(
                decode(&bytes, &Limits::default()),
                Ok(image.clone()),
                "{format:?}"
            );
        }
        let jpeg = encode(&image, ImageFormat::Jpeg).expect("a valid image");
        let decoded = decode(&jpeg, &Limits::default()).expect("our own JPEG");
        assert_eq!((decoded.width, decoded.height), (7, 5));
        assert!(!ImageFormat::Jpeg.has_alpha() && ImageFormat::Png.has_alpha());
    }

    #[test]
    fn sizes_are_found_in_headers() {
        let image = samples::noise(37, 5, 1);
        for (format, size) in [
            (ImageFormat::Png, Some((37, 5))),
            (ImageFormat::Jpeg, Some((37, 5))),
            (ImageFormat::Tga, Some((37, 5))),
        ] {
            let bytes = encode(&image, format).expect("a valid image");
            assert_eq!(stated_size(&bytes), size, "{format:?}");
            assert_eq!(stated_size(&bytes[..10]), None, "{format:?}");
            let is_signed = format != ImageFormat::Tga;
            assert_eq!(signed_size(&bytes).is_some(), is_signed, "{format:?}");
        }
    }

    #[test]
    fn other_files_are_errors_that_name_their_format() {
        let limits = Limits::default();
        let message = |bytes: &[u8]| decode(bytes, &limits).expect_err("no picture").to_string();
        assert!(message(b"").contains("byte 0: the image file is empty"));
        assert!(message(b"GIF89a......................").contains("GIF"));
        assert!(message(b"RIFF\x10\0\0\0WEBPVP8 ").contains("the WebP is not valid"));
        assert!(message(b"BM..").contains("BMP header"));
        assert!(message(b"DDS ").contains("DDS header"));
        assert!(message(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").contains("neither PNG"));
        assert!(matches!(
            decode(&[0xff; 64], &limits),
            Err(AssetError::Unsupported(_))
        ));
    }

    #[test]
    fn limits_hold_for_every_format() {
        let image = samples::noise(9, 8, 1);
        let few_pixels = Limits {
            max_image_pixels: 71,
            ..Limits::default()
        };
        let enough = Limits {
            max_image_pixels: 72,
            ..Limits::default()
        };
        let few_bytes = Limits {
            max_file_bytes: 20,
            ..Limits::default()
        };
        for format in [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Tga] {
            let bytes = encode(&image, format).expect("a valid image");
            for limits in [&few_pixels, &few_bytes] {
                let error = decode(&bytes, limits).expect_err("over the limit");
                assert!(
                    matches!(error, AssetError::LimitExceeded(_)),
                    "{format:?}: {error}"
                );
            }
            assert!(decode(&bytes, &enough).is_ok(), "{format:?}");
        }
    }

    #[test]
    fn invalid_images_are_not_written() {
        let missing = Image {
            width: 2,
            height: 2,
            rgba: vec![0; 15],
        };
        let empty = Image {
            width: 0,
            height: 3,
            rgba: Vec::new(),
        };
        let wide = Image {
            width: 65_536,
            height: 1,
            rgba: vec![9; 65_536 * 4],
        };
        for format in [
            ImageFormat::Png,
            ImageFormat::Jpeg,
            ImageFormat::Tga,
            ImageFormat::Webp,
        ] {
            for image in [&missing, &empty] {
                let error = encode(image, format).expect_err("contradictory");
                assert!(
                    matches!(error, AssetError::Malformed(_)),
                    "{format:?}: {error}"
                );
            }
            let refused = matches!(encode(&wide, format), Err(AssetError::LimitExceeded(_)));
            assert_eq!(refused, format != ImageFormat::Png, "{format:?}");
        }
    }
}
