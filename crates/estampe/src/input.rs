//! Models from files, from standard input, or by built-in name.

use crate::failure::Failure;
use crate::terminal::one_line;
use crate::values::{FormatName, Source, shown};
use estampe_assets::model::{
    AnimationName, Folder, ModelChoices, ModelContents, ModelSource, ResourceError, Resources,
    SourceBytes, TextureDetail, read_model_for,
};
use estampe_assets::{AssetError, Limits, Loaded, ModelFormat, ModelOptions, Warning};
use estampe_assets::{read_bytes, read_stream};
use estampe_scene::{Mesh, Scene};
use estampe_shapes::BuiltinShape;
use std::cell::RefCell;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// What is read of a model, within which limits, and in which detail.
#[derive(Clone, Copy)]
pub(crate) struct Reading<'a> {
    pub(crate) options: &'a ModelOptions,
    pub(crate) limits: &'a Limits,
    pub(crate) detail: &'a dyn TextureDetail,
}

/// A model that was read.
#[derive(Debug)]
pub(crate) struct Model {
    pub(crate) scene: Scene,
    /// Name for messages: the path, `standard input`, or the built-in name.
    pub(crate) name: String,
    /// `None` for built-in models.
    pub(crate) format: Option<ModelFormat>,
    /// The scenes, animations and variants of the file.
    pub(crate) choices: ModelChoices,
    /// The hierarchy, extensions, and which normals are made.
    pub(crate) contents: ModelContents,
    /// The model's file and the files that it named, which must not be overwritten.
    pub(crate) files: Vec<PathBuf>,
    /// The first warnings of the reader.
    pub(crate) warnings: Vec<Warning>,
    /// Number of all warnings.
    pub(crate) warning_count: u64,
    /// The counts of a scene that is [taken](Self::take_scene).
    pub(crate) counts_of_taken: Option<SceneCounts>,
    /// Time to read the bytes, but for OBJ, which is read while it is parsed.
    pub(crate) read: Duration,
    /// Time to build a scene from the bytes, normals included.
    pub(crate) parse: Duration,
}

/// The sizes of a scene's contents.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SceneCounts {
    pub(crate) meshes: usize,
    pub(crate) vertices: usize,
    pub(crate) triangles: usize,
    pub(crate) lines: usize,
    pub(crate) points: usize,
    pub(crate) materials: usize,
    pub(crate) textures: usize,
}

impl SceneCounts {
    fn of(scene: &Scene) -> Self {
        let sum = |count: fn(&Mesh) -> usize| -> usize { scene.meshes.iter().map(count).sum() };
        Self {
            meshes: scene.meshes.len(),
            vertices: sum(|mesh| mesh.positions.len()),
            triangles: sum(|mesh| mesh.triangles.len()),
            lines: sum(|mesh| mesh.lines.len()),
            points: sum(|mesh| mesh.points.len()),
            materials: scene.materials.len(),
            textures: scene.images.len(),
        }
    }
}

impl Model {
    /// The sizes of the scene's contents.
    pub(crate) fn counts(&self) -> SceneCounts {
        self.counts_of_taken
            .unwrap_or_else(|| SceneCounts::of(&self.scene))
    }

    /// Takes the scene, for who draws it last; its counts stay.
    pub(crate) fn take_scene(&mut self) -> Scene {
        self.counts_of_taken = Some(self.counts());
        std::mem::take(&mut self.scene)
    }

    /// Reads a model, whose other files are those of `folder`.
    ///
    /// `on_stage` is called before each stage with its name.
    pub(crate) fn read(
        (source, folder): (&Source, &Folder),
        format: Option<FormatName>,
        reading: Reading<'_>,
        on_stage: impl Fn(&'static str),
    ) -> Result<Self, Failure> {
        let format = format.map(ModelFormat::from);
        on_stage("reading");
        let start = Instant::now();
        match source {
            Source::Builtin(name) => Self::builtin(name, reading.options),
            Source::StandardInput => {
                let name = "standard input";
                let bytes = read_stream(io::stdin().lock(), reading.limits).map_err(|error| {
                    unreadable(name, &error, "check the program that writes it")
                })?;
                let read = start.elapsed();
                let format = format.or_else(|| ModelFormat::from_content(&bytes));
                let format = format.ok_or_else(|| {
                    Failure::Input(
                        "standard input: its content is not that of a model; name the format by --format \
                         gltf, obj, stl, ply, off or 3mf if it is one"
                            .to_owned(),
                    )
                })?;
                on_stage("parsing");
                let resources = Noted::new(folder);
                let model = Self::parsed(read, name, || {
                    let file = (SourceBytes::Memory(bytes), format);
                    reading.parse(file, name, &resources)
                })?;
                let files = resources.read.into_inner();
                Ok(Self { files, ..model })
            }
            Source::File(path) => {
                let mut file;
                let known = format.or_else(|| ModelFormat::from_extension(path));
                let bytes = if known == Some(ModelFormat::Obj) {
                    // It is read while it is parsed.
                    let opened = open(path, reading.limits)?;
                    file = opened.file;
                    SourceBytes::Stream(&mut file, opened.len)
                } else {
                    SourceBytes::Memory(read_file(path, reading.limits)?)
                };
                let read = start.elapsed();
                on_stage("parsing");
                let model = Self::of_source((path, bytes), known, reading, folder)?;
                Ok(Self { read, ..model })
            }
        }
    }

    /// The model of a file's bytes, whose other files are those of `resources`.
    pub(crate) fn of_source(
        (path, bytes): (&Path, SourceBytes<'_>),
        format: Option<ModelFormat>,
        reading: Reading<'_>,
        resources: &dyn Resources,
    ) -> Result<Self, Failure> {
        let name = shown(path);
        let format = format
            .or_else(|| ModelFormat::from_extension(path))
            .or_else(|| match &bytes {
                SourceBytes::Memory(bytes) => ModelFormat::from_content(bytes),
                SourceBytes::Stream(..) => None,
            })
            .ok_or_else(|| {
                Failure::Input(format!(
                    "{name}: neither its extension nor its content is that of a model; glTF, \
                     OBJ, STL, PLY, OFF and 3MF are read; name the format by --format if it is one of them"
                ))
            })?;
        let resources = Noted::new(resources);
        resources.read.borrow_mut().push(path.to_owned());
        let model = Self::parsed(Duration::ZERO, &name, || {
            reading.parse((bytes, format), &name, &resources)
        })?;
        let files = resources.read.into_inner();
        Ok(Self { files, ..model })
    }

    fn builtin(name: &str, options: &ModelOptions) -> Result<Self, Failure> {
        let is_choice = !matches!(options.animation, None | Some(AnimationName::First));
        if is_choice || options.scene.is_some() || options.variant.is_some() {
            return Err(Failure::Usage(
                "built-in models have no scenes, animations or variants; omit the option"
                    .to_owned(),
            ));
        }
        let start = Instant::now();
        let shape: BuiltinShape = name
            .parse()
            .map_err(|error: estampe_shapes::UnknownShape| Failure::Input(error.to_string()))?;
        let built = shape.build();
        let mesh = Mesh {
            name: built.name,
            positions: built.positions,
            normals: built.normals,
            uvs: built.uvs,
            triangles: built.triangles,
            ..Mesh::default()
        };
        Ok(Self {
            scene: Scene {
                meshes: vec![mesh],
                ..Scene::default()
            },
            name: format!("builtin:{shape}"),
            format: None,
            choices: ModelChoices::default(),
            contents: ModelContents::default(),
            files: Vec::new(),
            warnings: Vec::new(),
            warning_count: 0,
            counts_of_taken: None,
            read: Duration::ZERO,
            parse: start.elapsed(),
        })
    }

    fn parsed(
        read: Duration,
        name: &str,
        parse: impl FnOnce() -> Result<Loaded, AssetError>,
    ) -> Result<Self, Failure> {
        let start = Instant::now();
        let loaded = parse()?;
        Ok(Self {
            scene: loaded.scene,
            name: name.to_owned(),
            format: Some(loaded.format),
            choices: loaded.choices,
            contents: loaded.contents,
            files: Vec::new(),
            warnings: loaded.warnings,
            warning_count: loaded.warning_count,
            counts_of_taken: None,
            read,
            parse: start.elapsed(),
        })
    }

    /// Writes the first warnings to standard error.
    pub(crate) fn print_warnings(&self) {
        const SHOWN: usize = 5;
        let mut err = io::stderr().lock();
        // If standard error is closed, warnings are lost.
        for warning in self.warnings.iter().take(SHOWN) {
            let _ = writeln!(err, "warning: {}", one_line(&warning.to_string()));
        }
        let shown = self.warnings.len().min(SHOWN) as u64;
        if self.warning_count > shown {
            let more = self.warning_count - shown;
            let _ = writeln!(err, "warning: {more} more; `estampe info` lists them");
        }
    }
}

impl Reading<'_> {
    fn parse(
        self,
        (bytes, format): (SourceBytes<'_>, ModelFormat),
        name: &str,
        resources: &dyn Resources,
    ) -> Result<Loaded, AssetError> {
        let source = ModelSource {
            // Made anew, because the resources live shorter than the stream.
            bytes: match bytes {
                SourceBytes::Memory(bytes) => SourceBytes::Memory(bytes),
                SourceBytes::Stream(stream, len) => SourceBytes::Stream(stream, len),
            },
            format,
            name,
            resources,
        };
        read_model_for(source, self.options, self.limits, self.detail)
    }
}

/// Side files of a model, whose paths are noted.
struct Noted<'r> {
    resources: &'r dyn Resources,
    read: RefCell<Vec<PathBuf>>,
}

impl<'r> Noted<'r> {
    fn new(resources: &'r dyn Resources) -> Self {
        Self {
            resources,
            read: RefCell::default(),
        }
    }
}

impl Resources for Noted<'_> {
    fn resolve(&self, name: &str) -> Result<String, ResourceError> {
        self.resources.resolve(name)
    }

    fn search(&self, name: &str) -> Result<String, ResourceError> {
        self.resources.search(name)
    }

    fn read(&self, resolved: &str, max_bytes: u64) -> Result<Vec<u8>, ResourceError> {
        self.read.borrow_mut().push(PathBuf::from(resolved));
        self.resources.read(resolved, max_bytes)
    }
}

/// A file that the user named, which may be a pipe.
struct Opened {
    file: File,
    /// The length, if it is not a pipe.
    len: Option<u64>,
}

/// Opens a file that is not larger than the limit.
fn open(path: &Path, limits: &Limits) -> Result<Opened, Failure> {
    let failed = |error: io::Error| unreadable(&shown(path), &error, &advice_for(path));
    let metadata = std::fs::metadata(path).map_err(failed)?;
    if metadata.is_dir() {
        return Err(Failure::Input(format!(
            "{}: this is a folder; name a file in it",
            shown(path)
        )));
    }
    if metadata.len() > limits.max_file_bytes {
        return Err(too_large(&shown(path), limits));
    }
    Ok(Opened {
        file: File::open(path).map_err(failed)?,
        len: metadata.is_file().then_some(metadata.len()),
    })
}

/// The bytes of a file that the user named, which may be a pipe; at most the limit.
pub(crate) fn read_file(path: &Path, limits: &Limits) -> Result<Vec<u8>, Failure> {
    let Opened { file, len } = open(path, limits)?;
    read_bytes(file, len.unwrap_or(0), limits).map_err(|error| match error.kind() {
        io::ErrorKind::FileTooLarge => too_large(&shown(path), limits),
        _ => unreadable(&shown(path), &error, &advice_for(path)),
    })
}

/// What to do if a file cannot be read.
fn advice_for(path: &Path) -> String {
    let text = path.to_string_lossy();
    if text.parse::<BuiltinShape>().is_ok() {
        return format!("the built-in model is called builtin:{text}");
    }
    if text.contains(['*', '?']) {
        return "`estampe batch` draws all models that match a pattern".to_owned();
    }
    "check the path and its permissions".to_owned()
}

fn unreadable(name: &str, error: &io::Error, advice: &str) -> Failure {
    let reason = match error.kind() {
        io::ErrorKind::NotFound => "no such file".to_owned(),
        _ => error.to_string(),
    };
    Failure::Input(format!("{name}: {reason}; {advice}"))
}

fn too_large(name: &str, limits: &Limits) -> Failure {
    let limit = limits.max_file_bytes;
    Failure::Limit(format!(
        "{name}: larger than the limit of {limit} bytes; split the file"
    ))
}
