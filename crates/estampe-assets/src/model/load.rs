//! Entry points: a path, or bytes in memory.

use super::contents::ModelContents;
use super::deferred::{DeferredImages, FullDetail, TextureDetail, decode_all};
use super::input::{
    ModelInput, ModelSource, SourceBytes, check_length, decoded_text, of_stream, read_file,
};
use super::options::{ModelChoices, ModelOptions};
use super::resources::{ResourceError, Resources};
use super::{Folder, ModelFormat, finish, gltf, obj, off, ply, stl, threemf};
use crate::warning::{Warning, Warnings};
use crate::{AssetError, Limits, read_stream};
use estampe_scene::{Scene, Workers};
use glam::Vec3;
use std::path::Path;

/// A model with its warnings.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// The contents of the file. Every mesh with triangles has normals.
    pub scene: Scene,
    /// The format that was read.
    pub format: ModelFormat,
    /// The first warnings, at most `Limits::max_warnings`.
    pub warnings: Vec<Warning>,
    /// Number of all warnings.
    pub warning_count: u64,
    /// OBJ's `vp` statements: points in the parameter space of free-form curves, which are kept but
    /// not drawn.
    pub parameter_points: Vec<Vec3>,
    /// What [`ModelOptions`] can choose in this file.
    pub choices: ModelChoices,
    /// The hierarchy, extensions, and which normals are made.
    pub contents: ModelContents,
}

/// Output of a format's reader, before the final steps.
#[derive(Debug, Default)]
pub(super) struct Parsed {
    pub(super) scene: Scene,
    /// Smoothing group of each triangle of each mesh; empty if the file has none.
    pub(super) smoothing_groups: Vec<Vec<u32>>,
    pub(super) parameter_points: Vec<Vec3>,
    /// Missing normals are those of the triangles, without smooth edges.
    pub(super) has_flat_normals: bool,
    /// No two vertices of any meshes have the same position: a reader has joined those that had.
    pub(super) has_distinct_positions: bool,
    pub(super) choices: ModelChoices,
    pub(super) contents: ModelContents,
}

/// State that all readers share.
pub(super) struct Context<'a> {
    /// Name of the model, for messages.
    pub(super) name: &'a str,
    pub(super) resources: &'a dyn Resources,
    pub(super) options: &'a ModelOptions,
    pub(super) limits: &'a Limits,
    pub(super) warnings: Warnings,
    pub(super) workers: Workers,
    /// The images of the scene, which are decoded at the end.
    pub(super) images: DeferredImages<'a>,
    /// Number of side files that may still be requested.
    side_files_left: u64,
}

impl<'a> Context<'a> {
    pub(super) fn new(
        name: &'a str,
        resources: &'a dyn Resources,
        options: &'a ModelOptions,
        limits: &'a Limits,
    ) -> Self {
        Self {
            name,
            resources,
            options,
            limits,
            warnings: Warnings::new(limits.max_warnings),
            workers: Workers::new(limits.threads),
            images: DeferredImages::new(limits),
            side_files_left: limits.max_side_files,
        }
    }

    /// Finds the side file `name`; returns one name per file for all its spellings.
    pub(super) fn find_side_file(&mut self, name: &str) -> Result<String, ResourceError> {
        let Some(left) = self.side_files_left.checked_sub(1) else {
            let limit = self.limits.max_side_files;
            return Err(ResourceError::Io(format!(
                "the model names more than {limit} side files"
            )));
        };
        self.side_files_left = left;
        self.resources.resolve(name)
    }

    /// Finds the texture `name`, which was not found because of `error`, by its last part.
    pub(super) fn search_texture(
        &self,
        name: &str,
        error: ResourceError,
    ) -> Result<String, ResourceError> {
        match self.resources.search(name) {
            Err(ResourceError::NotFound | ResourceError::Unavailable) => Err(error),
            found => found,
        }
    }

    /// The bytes of a side file that was found, a library of materials.
    pub(super) fn read_side_file(&self, resolved: &str) -> Result<Vec<u8>, ResourceError> {
        self.resources.read(resolved, self.limits.max_file_bytes)
    }
}

/// Reads the model at `path`, and the side files that it names from its own folder.
///
/// Without a `format`, the extension decides, or the content if the extension is unknown.
///
/// # Errors
/// `Io` if the file cannot be read, else as [`parse_model`].
pub fn load_model(
    path: &Path,
    format: Option<ModelFormat>,
    limits: &Limits,
) -> Result<Loaded, AssetError> {
    load_model_with(path, format, &ModelOptions::default(), limits)
}

/// [`load_model`] with a choice of what is read.
///
/// # Errors
/// As [`parse_model_with`], and `Io` if the file cannot be read.
pub fn load_model_with(
    path: &Path,
    format: Option<ModelFormat>,
    options: &ModelOptions,
    limits: &Limits,
) -> Result<Loaded, AssetError> {
    let name = path.display().to_string();
    let bytes = read_file(path, limits).map_err(|error| error.in_file(&name))?;
    let named = format.or_else(|| ModelFormat::from_extension(path));
    let format = named
        .or_else(|| ModelFormat::from_content(&bytes))
        .ok_or_else(|| {
            AssetError::unsupported(
                "neither the extension nor the content is that of a known model format",
                "glTF, OBJ, STL, PLY, OFF and 3MF are read; name the format if it is one of them",
            )
            .in_file(&name)
        })?;
    let input = ModelInput {
        bytes: &bytes,
        format,
        name: &name,
        resources: &Folder::of_model(path),
    };
    parse_model_with(&input, options, limits)
}

/// Reads a model from `bytes`; `name` is its name in messages.
///
/// # Errors
/// `Malformed` if the file has no usable element, `Unsupported` for unsupported formats, and
/// `LimitExceeded` for more than `limits` allow. A side file that is missing, forbidden or broken
/// is a warning, unless it holds the geometry (a buffer of glTF).
pub fn parse_model(
    bytes: &[u8],
    format: ModelFormat,
    name: &str,
    resources: &dyn Resources,
    limits: &Limits,
) -> Result<Loaded, AssetError> {
    let input = ModelInput {
        bytes,
        format,
        name,
        resources,
    };
    parse_model_with(&input, &ModelOptions::default(), limits)
}

/// [`parse_model`] with a choice of what is read.
///
/// # Errors
/// As [`parse_model`], and `Unsupported` if the file does not have what the options name.
pub fn parse_model_with(
    input: &ModelInput<'_>,
    options: &ModelOptions,
    limits: &Limits,
) -> Result<Loaded, AssetError> {
    parse_model_for(input, options, limits, &FullDetail)
}

/// [`parse_model_with`] for a picture that needs its textures in some detail only: textures are
/// reduced while they are decoded.
///
/// # Errors
/// As [`parse_model_with`].
pub fn parse_model_for(
    input: &ModelInput<'_>,
    options: &ModelOptions,
    limits: &Limits,
    detail: &dyn TextureDetail,
) -> Result<Loaded, AssetError> {
    let &ModelInput {
        bytes,
        format,
        name,
        resources,
    } = input;
    check_choices(format, name, options)?;
    let text = decoded_text(format, bytes);
    let bytes = text.as_deref().unwrap_or(bytes);
    let mut context = Context::new(name, resources, options, limits);
    let parsed = check_length(bytes, limits)
        .and_then(|()| match format {
            ModelFormat::Gltf => gltf::parse(bytes, options, &mut context),
            ModelFormat::ThreeMf => threemf::parse(bytes, &mut context),
            _ => parse_geometry(bytes, format, &mut context),
        })
        .map_err(|error| error.in_file(name))?;
    complete(parsed, format, context, detail)
}

/// [`parse_model_for`] of a model whose bytes nobody needs afterwards: that takes less memory, and
/// less time.
///
/// # Errors
/// As [`parse_model_with`], and `Io` if a stream cannot be read.
pub fn read_model_for(
    source: ModelSource<'_>,
    options: &ModelOptions,
    limits: &Limits,
    detail: &dyn TextureDetail,
) -> Result<Loaded, AssetError> {
    let ModelSource {
        bytes,
        format,
        name,
        resources,
    } = source;
    check_choices(format, name, options)?;
    let bytes = match bytes {
        SourceBytes::Stream(stream, _) if format != ModelFormat::Obj => {
            let read = read_stream(stream, limits);
            SourceBytes::Memory(read.map_err(|error| of_stream(&error, limits).in_file(name))?)
        }
        bytes => bytes,
    };
    if let (SourceBytes::Memory(bytes), ModelFormat::Gltf | ModelFormat::ThreeMf) = (&bytes, format)
    {
        // Images stay in the bytes until they are decoded.
        let input = ModelInput {
            bytes,
            format,
            name,
            resources,
        };
        return parse_model_for(&input, options, limits, detail);
    }
    let mut context = Context::new(name, resources, options, limits);
    let parsed = match bytes {
        SourceBytes::Memory(bytes) => {
            let bytes = decoded_text(format, &bytes).unwrap_or(bytes);
            check_length(&bytes, limits).and_then(|()| parse_geometry(&bytes, format, &mut context))
        }
        SourceBytes::Stream(stream, len) => {
            obj::parse(obj::Text::Stream(stream, len), &mut context)
        }
    };
    let parsed = parsed.map_err(|error| error.in_file(name))?;
    complete(parsed, format, context, detail)
}

/// Refuses choices that the format does not offer.
fn check_choices(
    format: ModelFormat,
    name: &str,
    options: &ModelOptions,
) -> Result<(), AssetError> {
    let gltf_choice = options.of_gltf_alone();
    match gltf_choice.filter(|_| format != ModelFormat::Gltf) {
        None => Ok(()),
        Some(choice) => Err(AssetError::unsupported(
            format!(
                "{choice} is not in this file: {} has neither scenes, animations nor variants",
                format.name()
            ),
            "read it without this choice",
        )
        .in_file(name)),
    }
}

/// Parses a format whose images are files of their own, so that nothing stays in the bytes.
fn parse_geometry(
    bytes: &[u8],
    format: ModelFormat,
    context: &mut Context<'_>,
) -> Result<Parsed, AssetError> {
    match format {
        ModelFormat::Obj => obj::parse(obj::Text::Memory(bytes), context),
        ModelFormat::Stl => stl::parse(bytes, context),
        ModelFormat::Ply => ply::parse(bytes, context),
        ModelFormat::Off => off::parse(bytes, context),
        ModelFormat::Gltf | ModelFormat::ThreeMf => unreachable!("its images stay in the bytes"),
    }
}

/// Makes normals, decodes images and collects warnings.
fn complete(
    parsed: Parsed,
    format: ModelFormat,
    mut context: Context<'_>,
    detail: &dyn TextureDetail,
) -> Result<Loaded, AssetError> {
    let mut parsed = finish::finish(parsed, &mut context);
    parsed.contents.image_sizes = decode_all(&mut parsed.scene, detail, &mut context);
    let (warnings, warning_count) = context.warnings.finish();
    if context.options.is_strict
        && let Some(first) = warnings.first()
    {
        return Err(refused(first, warning_count));
    }
    Ok(Loaded {
        scene: parsed.scene,
        format,
        warnings,
        warning_count,
        parameter_points: parsed.parameter_points,
        choices: parsed.choices,
        contents: parsed.contents,
    })
}

/// The error of a strict reader: the first of its warnings.
fn refused(first: &Warning, count: u64) -> AssetError {
    let more = match count {
        0 | 1 => String::new(),
        _ => format!(" (and {} more)", count - 1),
    };
    let error = AssetError::malformed(
        format!("{}{more}", first.message),
        "warnings are errors here: mend the file, or read it without this strictness",
    );
    let error = error
        .in_file(&first.file)
        .at_json(first.json_pointer.clone());
    match first.location {
        Some(location) => error.at(location),
        None => error,
    }
}
