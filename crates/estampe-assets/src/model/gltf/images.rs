//! Images: their bytes from files, data URIs and buffer views, each decoded once.

use super::buffers::{Views, find_side_file};
use super::data_uri;
use super::document::{Document, Image as ImageSource, Index};
use super::fault::warn;
use crate::model::load::Context;
use crate::{AssetError, Limits};
use estampe_scene::Image;
use std::borrow::Cow;
use std::collections::HashMap;

/// The images of the scene, and where those of the file are among them.
#[derive(Debug, Default)]
pub(super) struct Images {
    pub(super) images: Vec<Image>,
    /// By index in the file; `None` was not used, or could not be read.
    pub(super) of_file: Vec<Option<usize>>,
    pixels_left: u64,
    /// Encoded bytes that may still be read.
    bytes_left: u64,
}

/// Where an image's bytes are; images with the same place are decoded once.
#[derive(Debug, PartialEq, Eq, Hash)]
enum Place {
    /// A side file, by its resolved name.
    File(String),
    View(Index),
    /// A data URI of the image with this index.
    Uri(usize),
}

impl Images {
    /// Decodes the images that are used, by several threads. Failures are warnings.
    pub(super) fn read(
        document: &Document<'_>,
        is_used: &[bool],
        views: &Views<'_>,
        context: &mut Context<'_>,
    ) -> Self {
        let mut images = Self {
            images: Vec::new(),
            of_file: vec![None; document.images.len()],
            pixels_left: context.limits.max_total_image_pixels,
            bytes_left: context.limits.max_file_bytes,
        };
        let mut first_at: HashMap<Place, usize> = HashMap::new();
        let mut copies = Vec::new();
        let mut encoded = Vec::new();
        for (at, source) in document.images.iter().enumerate() {
            if !is_used[at] {
                continue;
            }
            let found = Place::of(source, at, context).and_then(|place| {
                if let Some(&first) = first_at.get(&place) {
                    copies.push((at, first));
                    return Ok(None);
                }
                let bytes = images.bytes_at(&place, source, views, context);
                first_at.insert(place, at);
                images.within_limits(bytes?, context.limits).map(Some)
            });
            match found {
                Ok(Some(bytes)) => encoded.push((at, bytes)),
                Ok(None) => {}
                Err(error) => warn_omitted(at, &error, context),
            }
        }
        let limits = context.limits;
        // The longest first, so that no thread begins it when the others have finished.
        encoded.sort_by_key(|(_, bytes)| std::cmp::Reverse(bytes.len()));
        let mut decoded = context.workers.map(encoded, |(at, bytes)| {
            (at, crate::image::decode(&bytes, limits))
        });
        decoded.sort_by_key(|&(at, _)| at);
        for (at, decoded) in decoded {
            match decoded {
                Ok(image) => {
                    images.of_file[at] = Some(images.images.len());
                    images.images.push(image);
                }
                Err(error) => warn_omitted(at, &error, context),
            }
        }
        for (at, first) in copies {
            images.of_file[at] = images.of_file[first];
        }
        images
    }

    fn bytes_at<'b>(
        &self,
        place: &Place,
        source: &ImageSource<'_>,
        views: &'b Views<'_>,
        context: &Context<'_>,
    ) -> Result<Cow<'b, [u8]>, AssetError> {
        let bytes = match *place {
            Place::File(ref name) => context
                .resources
                .read(name, self.bytes_left)
                .map_err(|error| AssetError::io(error.to_string(), ""))?,
            Place::View(view) => {
                let place = || "/images".to_owned();
                return views.bytes(view, place).map(Cow::Borrowed);
            }
            Place::Uri(_) => {
                let uri = source.uri.as_ref().map_or("", |uri| &uri.0);
                data_uri::data(uri).unwrap_or_else(|| Ok(Vec::new()))?
            }
        };
        Ok(Cow::Owned(bytes))
    }

    /// Passes the bytes on if the image in them is within the limits of all images together, which
    /// must be known before several are decoded at once.
    fn within_limits<'b>(
        &mut self,
        bytes: Cow<'b, [u8]>,
        limits: &Limits,
    ) -> Result<Cow<'b, [u8]>, AssetError> {
        // Decoding takes time for bytes that add no pixels, too.
        Limits::check("bytes", bytes.len() as u64, self.bytes_left)?;
        self.bytes_left -= bytes.len() as u64;
        let Some((width, height)) = crate::image::stated_size(&bytes) else {
            return Err(AssetError::unsupported(
                "an image that is neither PNG, JPEG, WebP, BMP nor DDS cannot be read",
                "save it as an 8-bit PNG",
            ));
        };
        let pixels = u64::from(width) * u64::from(height);
        Limits::check(
            "pixels",
            pixels,
            limits.max_image_pixels.min(self.pixels_left),
        )?;
        self.pixels_left -= pixels;
        Ok(bytes)
    }

    /// Adds an image that is made of another one, unless that is more than the limits allow.
    pub(super) fn add_derived(
        &mut self,
        from: usize,
        derive: impl FnOnce(&Image) -> Image,
    ) -> Option<usize> {
        let source = self.images.get(from)?;
        let pixels = u64::from(source.width) * u64::from(source.height);
        self.pixels_left = self.pixels_left.checked_sub(pixels)?;
        let derived = derive(source);
        self.images.push(derived);
        Some(self.images.len() - 1)
    }
}

impl Place {
    fn of(
        source: &ImageSource<'_>,
        at: usize,
        context: &mut Context<'_>,
    ) -> Result<Self, AssetError> {
        match (&source.uri, source.buffer_view) {
            (Some(uri), _) if data_uri::is_data(&uri.0) => Ok(Self::Uri(at)),
            (Some(uri), _) => {
                let unreadable = |error| AssetError::io(format!("`{}`: {error}", uri.0), "");
                let name = data_uri::percent_decoded(&uri.0);
                let name = String::from_utf8_lossy(&name);
                find_side_file(&uri.0, context)
                    .or_else(|error| context.search_texture(&name, error))
                    .map(Self::File)
                    .map_err(unreadable)
            }
            (None, Some(view)) => Ok(Self::View(view)),
            (None, None) => Err(AssetError::malformed(
                "the image has neither `uri` nor `bufferView`",
                "",
            )),
        }
    }
}

fn warn_omitted(at: usize, error: &AssetError, context: &mut Context<'_>) {
    let what = format!("the image is left out: {error}");
    warn(context, format!("/images/{at}"), what);
}
