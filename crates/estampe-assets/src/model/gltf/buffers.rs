//! Buffers: the bytes of files, of data URIs and of the binary chunk; and views of them.
//!
//! A buffer that cannot be read is no error until something needs it: a picture may be the only
//! thing in it.

use super::data_uri;
use super::document::{Buffer, Document, Index};
use super::fault::{element, malformed};
use super::meshopt;
use crate::model::load::Context;
use crate::model::resources::ResourceError;
use crate::{AssetError, Limits};
use estampe_scene::Workers;
use std::borrow::Cow;
use std::collections::HashMap;
use std::rc::Rc;

/// The bytes of each buffer, or the reason why there are none.
pub(super) struct Buffers<'a> {
    buffers: Vec<Result<Bytes<'a>, AssetError>>,
}

/// The bytes of a buffer. Two buffers of one file share them.
#[derive(Clone)]
enum Bytes<'a> {
    Borrowed(&'a [u8]),
    Shared(Rc<Vec<u8>>),
}

/// Files read so far, by resolved name, and the bytes that may still be read.
struct Files {
    known: HashMap<String, Rc<Vec<u8>>>,
    bytes_left: u64,
}

impl<'a> Buffers<'a> {
    /// Reads all buffers; `bin` is the binary chunk.
    pub(super) fn read(
        document: &'a Document<'a>,
        bin: Option<&'a [u8]>,
        context: &mut Context<'_>,
    ) -> Self {
        let mut files = Files {
            known: HashMap::new(),
            bytes_left: context.limits.max_file_bytes,
        };
        let read = |(at, buffer)| {
            let pointer = format!("/buffers/{at}");
            let bin = bin.filter(|_| at == 0);
            read_buffer(buffer, bin, &mut files, context)
                .and_then(|bytes| checked_length(bytes, buffer))
                .map_err(|error| error.at_json(pointer))
        };
        Self {
            buffers: document.buffers.iter().enumerate().map(read).collect(),
        }
    }

    /// A range of a buffer. `pointer` is the place of the range.
    pub(super) fn range(
        &self,
        buffer: Index,
        offset: Index,
        length: Index,
        pointer: &str,
    ) -> Result<&[u8], AssetError> {
        let place = || format!("{pointer}/buffer");
        let bytes = element(&self.buffers, buffer, "buffer", place)?
            .as_ref()
            .map_err(AssetError::clone)?
            .bytes();
        let range = offset
            .0
            .checked_add(length.0)
            .and_then(|end| bytes.get(offset.0..end));
        range.ok_or_else(|| {
            let end = offset.0.saturating_add(length.0);
            let what = format!(
                "bytes {offset} to {end} are outside of buffer {buffer}, which has {}",
                bytes.len()
            );
            malformed(pointer, what)
        })
    }
}

impl Bytes<'_> {
    fn bytes(&self) -> &[u8] {
        match self {
            Self::Borrowed(bytes) => bytes,
            Self::Shared(bytes) => bytes,
        }
    }
}

fn read_buffer<'a>(
    buffer: &Buffer<'_>,
    bin: Option<&'a [u8]>,
    files: &mut Files,
    context: &mut Context<'_>,
) -> Result<Bytes<'a>, AssetError> {
    let Some(uri) = &buffer.uri else {
        return bin.map(Bytes::Borrowed).ok_or_else(|| {
            AssetError::malformed(
                "the buffer has no `uri`, and the file has no binary chunk for it",
                "keep the .bin file beside the model, or export a .glb file",
            )
        });
    };
    if let Some(data) = data_uri::data(&uri.0) {
        return Ok(Bytes::Shared(Rc::new(data?)));
    }
    let unreadable = |error: ResourceError| {
        AssetError::io(
            format!("the file `{}` of the buffer is missing: {error}", uri.0),
            "keep it beside the model, or export a .glb file",
        )
    };
    let resolved = find_side_file(&uri.0, context).map_err(unreadable)?;
    if let Some(known) = files.known.get(&resolved) {
        return Ok(Bytes::Shared(Rc::clone(known)));
    }
    let bytes = context
        .resources
        .read(&resolved, files.bytes_left)
        .map_err(unreadable)?;
    files.bytes_left -= bytes.len() as u64;
    let bytes = Rc::new(bytes);
    files.known.insert(resolved, Rc::clone(&bytes));
    Ok(Bytes::Shared(bytes))
}

/// Finds the file that a URI names: with escapes decoded, else as it is written.
pub(super) fn find_side_file(
    uri: &str,
    context: &mut Context<'_>,
) -> Result<String, ResourceError> {
    let decoded = data_uri::percent_decoded(uri);
    match (
        decoded,
        std::str::from_utf8(&data_uri::percent_decoded(uri)),
    ) {
        (Cow::Owned(_), Ok(name)) => match context.find_side_file(name) {
            Err(ResourceError::NotFound) => context.find_side_file(uri),
            found => found,
        },
        _ => context.find_side_file(uri),
    }
}

fn checked_length<'a>(bytes: Bytes<'a>, buffer: &Buffer<'_>) -> Result<Bytes<'a>, AssetError> {
    let (stated, actual) = (buffer.byte_length.0, bytes.bytes().len());
    if actual < stated {
        return Err(AssetError::malformed(
            format!("the buffer has {actual} bytes instead of the {stated} of its `byteLength`"),
            "its file is cut off or of another model; export both again",
        ));
    }
    Ok(bytes)
}

/// The bytes of each buffer view, decompressed where necessary.
pub(super) struct Views<'a> {
    document: &'a Document<'a>,
    views: Vec<Result<Cow<'a, [u8]>, AssetError>>,
}

impl<'a> Views<'a> {
    /// Finds the bytes of all views; compressed ones are decompressed by several threads.
    pub(super) fn new(
        document: &'a Document<'a>,
        buffers: &'a Buffers<'a>,
        limits: &Limits,
        workers: Workers,
    ) -> Self {
        let mut bytes_left = limits.max_file_bytes;
        let sources = document.buffer_views.iter().enumerate().map(|(at, view)| {
            let pointer = format!("/bufferViews/{at}");
            if let Some(meshopt) = &view.extensions.meshopt {
                let pointer = format!("{pointer}/extensions/EXT_meshopt_compression");
                let source =
                    meshopt::Compressed::new(meshopt, view.byte_length.0, buffers, &pointer)?;
                let length = source.decoded_length();
                bytes_left = bytes_left.checked_sub(length).ok_or_else(|| {
                    let limit = limits.max_file_bytes;
                    AssetError::limit_exceeded(
                        format!("decompressed, the views need more than {limit} bytes"),
                        "split the file, or raise the limit if you trust it",
                    )
                    .at_json(&pointer)
                })?;
                return Ok((Some(source), &[][..], pointer));
            }
            let bytes = buffers.range(view.buffer, view.byte_offset, view.byte_length, &pointer)?;
            Ok((None, bytes, pointer))
        });
        let sources: Vec<_> = sources.collect();
        let views = workers.map(sources, |source| {
            let (compressed, bytes, pointer) = source?;
            match compressed {
                Some(source) => {
                    let bytes = source.decode().map_err(|error| error.at_json(pointer))?;
                    Ok(Cow::Owned(bytes))
                }
                None => Ok(Cow::Borrowed(bytes)),
            }
        });
        Self { document, views }
    }

    /// The bytes of a view. `pointer` is the place of the index.
    pub(super) fn bytes(
        &self,
        view: Index,
        pointer: impl FnOnce() -> String,
    ) -> Result<&[u8], AssetError> {
        let bytes = element(&self.views, view, "buffer view", pointer)?;
        bytes.as_deref().map_err(AssetError::clone)
    }

    /// The stride of a view, if it states one.
    pub(super) fn stride(&self, view: Index) -> Option<usize> {
        let view = self.document.buffer_views.get(view.0)?;
        match (&view.extensions.meshopt, view.byte_stride) {
            (Some(meshopt), None) if meshopt.mode == "ATTRIBUTES" => Some(meshopt.byte_stride.0),
            (_, stride) => stride.map(|stride| stride.0),
        }
    }
}
