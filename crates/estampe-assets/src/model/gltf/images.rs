//! Images: their bytes from files, data URIs and buffer views, each once.

use super::buffers::{Views, find_side_file};
use super::data_uri;
use super::document::{Document, Image as ImageSource, Index};
use crate::AssetError;
use crate::image::signed_size;
use crate::model::deferred::{Encoded, Origin};
use crate::model::load::Context;
use std::borrow::Cow;
use std::collections::HashMap;

/// Where an image's bytes are; images with the same place are decoded once.
#[derive(Debug, PartialEq, Eq, Hash)]
enum Place {
    /// A side file, by its resolved name.
    File(String),
    View(Index),
    /// A data URI of the image with this index.
    Uri(usize),
}

/// Finds the images that are used, to be decoded later. Returns the index in the scene of each
/// image of the file: `None` was not used, or could not be read. Failures are warnings.
pub(super) fn find<'a>(
    document: &Document<'_>,
    is_used: &[bool],
    (views, bin): (&Views<'_>, Option<&'a [u8]>),
    context: &mut Context<'a>,
) -> Vec<Option<usize>> {
    let mut of_file: Vec<Option<usize>> = vec![None; document.images.len()];
    let mut first_at: HashMap<Place, usize> = HashMap::new();
    for (at, source) in document.images.iter().enumerate() {
        if !is_used[at] {
            continue;
        }
        let origin = Origin::Json {
            file: context.name.to_owned(),
            pointer: format!("/images/{at}"),
        };
        let found = Place::of(source, at, context).and_then(|place| {
            if let Some(&first) = first_at.get(&place) {
                return Ok(of_file[first]);
            }
            let bytes = match in_file(&place, document, bin) {
                Some(bytes) => Ok(Cow::Borrowed(bytes)),
                None => bytes_at(&place, source, views, context).map(Cow::Owned),
            };
            first_at.insert(place, at);
            let file = encoded(bytes?, origin.clone(), context)?;
            Ok(Some(context.images.add_file(file)))
        });
        match found {
            Ok(image) => of_file[at] = image,
            Err(error) => origin.warn(&error, &mut context.warnings),
        }
    }
    of_file
}

/// The bytes of a view that lies in the binary chunk as it is, and need not be copied.
fn in_file<'a>(place: &Place, document: &Document<'_>, bin: Option<&'a [u8]>) -> Option<&'a [u8]> {
    let &Place::View(view) = place else {
        return None;
    };
    let view = document.buffer_views.get(view.0)?;
    let is_plain = view.extensions.meshopt.is_none() && view.buffer.0 == 0;
    if !is_plain || document.buffers.first()?.uri.is_some() {
        return None;
    }
    let (start, length) = (view.byte_offset.0, view.byte_length.0);
    bin?.get(start..start.checked_add(length)?)
}

fn bytes_at(
    place: &Place,
    source: &ImageSource<'_>,
    views: &Views<'_>,
    context: &Context<'_>,
) -> Result<Vec<u8>, AssetError> {
    match *place {
        Place::File(ref name) => context
            .resources
            .read(name, context.images.bytes_left())
            .map_err(|error| AssetError::io(error.to_string(), "")),
        Place::View(view) => {
            let place = || "/images".to_owned();
            views.bytes(view, place).map(<[u8]>::to_vec)
        }
        Place::Uri(_) => {
            let uri = source.uri.as_ref().map_or("", |uri| &uri.0);
            data_uri::data(uri).unwrap_or_else(|| Ok(Vec::new()))
        }
    }
}

/// The bytes, if they are of a format that glTF has: TGA has no signature.
fn encoded<'a>(
    bytes: Cow<'a, [u8]>,
    origin: Origin,
    context: &mut Context<'a>,
) -> Result<Encoded<'a>, AssetError> {
    if signed_size(&bytes).is_none() {
        return Err(AssetError::unsupported(
            "an image that is neither PNG, JPEG, WebP, BMP, DDS nor KTX2 cannot be read",
            "save it as an 8-bit PNG",
        ));
    }
    context.images.encoded(bytes, origin, context.limits)
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
