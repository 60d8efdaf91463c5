//! Images: their bytes from files, data URIs and buffer views, each decoded once.

use super::buffers::{Views, find_side_file};
use super::data_uri;
use super::document::{Document, Image as ImageSource};
use super::fault::warn;
use crate::model::load::Context;
use crate::model::resources::ResourceError;
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
        };
        // One image for all that name the same file.
        let mut same_file: HashMap<String, usize> = HashMap::new();
        let mut copies = Vec::new();
        let mut encoded = Vec::new();
        // The files of all images are in memory at once.
        let mut bytes_left = context.limits.max_file_bytes;
        for (at, source) in document.images.iter().enumerate() {
            if !is_used[at] {
                continue;
            }
            let found = match resolved_file(source, context) {
                Some(Ok(name)) => {
                    if let Some(&first) = same_file.get(&name) {
                        copies.push((at, first));
                        continue;
                    }
                    let bytes = context.resources.read(&name, bytes_left);
                    same_file.insert(name, at);
                    if let Ok(bytes) = &bytes {
                        bytes_left -= bytes.len() as u64;
                    }
                    let unreadable = |error: ResourceError| AssetError::io(error.to_string(), "");
                    bytes.map(Cow::Owned).map_err(unreadable)
                }
                Some(Err(error)) => Err(error),
                None => embedded(source, at, views),
            };
            match found.and_then(|bytes| images.within_limits(bytes, context.limits)) {
                Ok(bytes) => encoded.push((at, bytes)),
                Err(error) => warn_omitted(at, &error, context),
            }
        }
        let limits = context.limits;
        let decoded = context.workers.map(encoded, |(at, bytes)| {
            (at, crate::image::decode(&bytes, limits))
        });
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

    /// Passes the bytes on if the image in them is within the limits of all images together, which
    /// must be known before several are decoded at once.
    fn within_limits<'b>(
        &mut self,
        bytes: Cow<'b, [u8]>,
        limits: &Limits,
    ) -> Result<Cow<'b, [u8]>, AssetError> {
        let Some((width, height)) = crate::image::stated_size(&bytes) else {
            return Err(AssetError::unsupported(
                "an image that is neither PNG nor JPEG cannot be read",
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

/// The name of the image's file; `None` if it is in the model.
fn resolved_file(
    source: &ImageSource<'_>,
    context: &mut Context<'_>,
) -> Option<Result<String, AssetError>> {
    let uri = &source.uri.as_ref()?.0;
    if data_uri::is_data(uri) {
        return None;
    }
    let unreadable = |error| AssetError::io(format!("`{uri}`: {error}"), "");
    Some(find_side_file(uri, context).map_err(unreadable))
}

/// The bytes of an image in a data URI or a buffer view.
fn embedded<'a>(
    source: &ImageSource<'_>,
    at: usize,
    views: &'a Views<'_>,
) -> Result<Cow<'a, [u8]>, AssetError> {
    let data = source.uri.as_ref().and_then(|uri| data_uri::data(&uri.0));
    match (data, source.buffer_view) {
        (Some(data), _) => data.map(Cow::Owned),
        (None, Some(view)) => {
            let place = || format!("/images/{at}/bufferView");
            views.bytes(view, place).map(Cow::Borrowed)
        }
        (None, None) => Err(AssetError::malformed(
            "the image has neither `uri` nor `bufferView`",
            "",
        )),
    }
}

fn warn_omitted(at: usize, error: &AssetError, context: &mut Context<'_>) {
    let what = format!("the image is left out: {error}");
    warn(context, format!("/images/{at}"), what);
}
