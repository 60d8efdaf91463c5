//! Images: their bytes from files, data URIs and buffer views, each once.

use super::buffers::{Views, find_side_file};
use super::data_uri;
use super::document::{Document, Image as ImageSource, Index};
use super::fault::warn;
use crate::AssetError;
use crate::image::{BasisUniversal, signed_size};
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
///
/// # Errors
/// `Unsupported` if an image is Basis Universal, the file requires its extension, and the texture
/// has no other image.
pub(super) fn find<'a>(
    document: &Document<'_>,
    is_used: &[bool],
    (views, bin): (&Views<'_>, Option<&'a [u8]>),
    context: &mut Context<'a>,
) -> Result<Vec<Option<usize>>, AssetError> {
    let mut fallbacks = HashMap::new();
    for texture in &document.textures {
        let basisu = texture.extensions.basisu.as_ref();
        if let (Some(image), Some(other)) = (basisu.and_then(|of| of.source), texture.source) {
            fallbacks.entry(image.0).or_insert(other.0);
        }
    }
    let mut finder = Finder {
        document,
        views,
        bin,
        fallbacks,
        of_file: vec![None; document.images.len()],
        is_found: vec![false; document.images.len()],
        first_at: HashMap::new(),
    };
    for (at, _) in is_used.iter().enumerate().filter(|(_, is_used)| **is_used) {
        finder.find(at, context)?;
    }
    Ok(finder.of_file)
}

struct Finder<'d, 'a> {
    document: &'d Document<'d>,
    views: &'d Views<'d>,
    bin: Option<&'a [u8]>,
    /// The images for programs that do not read KTX2, by those in KTX2.
    fallbacks: HashMap<usize, usize>,
    of_file: Vec<Option<usize>>,
    is_found: Vec<bool>,
    first_at: HashMap<Place, usize>,
}

/// The result of reading an image.
enum Found {
    /// The index in the scene.
    Image(Option<usize>),
    Basis(BasisUniversal),
}

impl<'a> Finder<'_, 'a> {
    /// Finds an image, or the one in its place. Images may stand in each other's places, any number
    /// of them in a row, so there is no recursion.
    fn find(&mut self, at: usize, context: &mut Context<'a>) -> Result<(), AssetError> {
        let mut replaced = Vec::new();
        let mut at = at;
        let image = loop {
            if std::mem::replace(&mut self.is_found[at], true) {
                break self.of_file[at];
            }
            let origin = Origin::Json {
                file: context.name.to_owned(),
                pointer: format!("/images/{at}"),
            };
            match self.read(at, &origin, context) {
                Ok(Found::Image(image)) => break image,
                Ok(Found::Basis(kind)) => match self.other_than(at, kind, &origin, context)? {
                    Some(other) => {
                        replaced.push(at);
                        at = other;
                    }
                    None => break None,
                },
                Err(error) => {
                    origin.warn(&error, &mut context.warnings);
                    break None;
                }
            }
        };
        self.of_file[at] = image;
        for at in replaced {
            self.of_file[at] = image;
        }
        Ok(())
    }

    /// The image in the place of one of Basis Universal, with a warning; an error if there is none
    /// and the file requires one.
    fn other_than(
        &self,
        at: usize,
        kind: BasisUniversal,
        origin: &Origin,
        context: &mut Context<'_>,
    ) -> Result<Option<usize>, AssetError> {
        let what = match &self.document.images[at].uri {
            Some(uri) if !data_uri::is_data(&uri.0) => format!("`{}` is {kind}", uri.0),
            _ => format!("the image is {kind}"),
        };
        let what = format!("{what}, which is not read");
        let other = self.fallbacks.get(&at).copied();
        if let Some(other) = other.filter(|&other| other < self.of_file.len()) {
            let instead = format!("{what}; the texture's other image, /images/{other}, is used");
            warn(context, format!("/images/{at}"), instead);
            return Ok(Some(other));
        }
        let error = AssetError::unsupported(what, BasisUniversal::ADVICE);
        let mut required = self.document.extensions_required.iter();
        if required.any(|name| name == "KHR_texture_basisu") {
            return Err(error.at_json(format!("/images/{at}")));
        }
        origin.warn(&error, &mut context.warnings);
        Ok(None)
    }

    fn read(
        &mut self,
        at: usize,
        origin: &Origin,
        context: &mut Context<'a>,
    ) -> Result<Found, AssetError> {
        let source = &self.document.images[at];
        let place = Place::of(source, at, context)?;
        if let Some(&first) = self.first_at.get(&place) {
            return Ok(Found::Image(self.of_file[first]));
        }
        let bytes = match in_file(&place, self.document, self.bin) {
            Some(bytes) => Ok(Cow::Borrowed(bytes)),
            None => bytes_at(&place, source, self.views, context).map(Cow::Owned),
        };
        self.first_at.insert(place, at);
        let bytes = bytes?;
        if let Some(kind) = BasisUniversal::of(&bytes) {
            return Ok(Found::Basis(kind));
        }
        let file = encoded(bytes, origin.clone(), context)?;
        Ok(Found::Image(Some(context.images.add_file(file))))
    }
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
