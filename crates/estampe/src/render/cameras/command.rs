//! Draws the cameras of a file.

use super::super::draw::{check_output, device, encoded, frame, frame_options, image_format};
use super::super::passes::{Files, OutputFormatName, Sources, pinhole_json};
use super::super::report::{counts, output_path, rounded_milliseconds, write};
use super::file::{NamedCamera, read};
use crate::failure::Failure;
use crate::input::Model;
use crate::limits::Clock;
use crate::output;
use crate::progress::Progress;
use crate::render::{PictureArgs, PictureDetail, RenderArgs};
use crate::values::Destination;
use estampe::Device;
use estampe_assets::image::ImageFormat;
use estampe_renderer::{RenderOptions, ViewDirection};
use serde_json::{Value, json};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// The text in a name that stands for the camera.
const PLACEHOLDER: &str = "{camera}";

/// The cameras, each with its outputs.
pub(in crate::render) struct Shots(Vec<Shot>);

struct Shot {
    camera: NamedCamera,
    outputs: Outputs,
}

enum Outputs {
    Picture(Destination, ImageFormat),
    Passes(Files),
}

impl Shots {
    /// Those of the options; `None` without `--cameras`.
    pub(in crate::render) fn of(args: &RenderArgs) -> Result<Option<Self>, Failure> {
        let Some(path) = &args.cameras.cameras else {
            return Ok(None);
        };
        let cameras = read(path, args.picture.size)?;
        let output = args.output.as_ref().unwrap_or(&Destination::StandardOutput);
        let template = match output {
            Destination::File(path) => path.to_str(),
            Destination::StandardOutput => None,
        };
        let template = template.filter(|name| name.contains(PLACEHOLDER));
        if template.is_none() && cameras.len() > 1 {
            return Err(Failure::Usage(format!(
                "--cameras has {} cameras; add {PLACEHOLDER} to OUT, as in 'view-{{camera}}.png'",
                cameras.len()
            )));
        }
        let named = args.output_format.and_then(OutputFormatName::of_picture);
        let mut folders = HashSet::new();
        let shots = cameras.into_iter().map(|camera| {
            let output = match template {
                Some(name) => Destination::File(name.replace(PLACEHOLDER, &camera.name).into()),
                None => output.clone(),
            };
            let outputs = match Files::of(&args.passes, &output, args.output_format)? {
                Some(files) => Outputs::Passes(files),
                None => Outputs::Picture(output.clone(), image_format(named, &output)?),
            };
            let shot = Shot { camera, outputs };
            for output in shot.outputs() {
                if is_new_folder(output, &mut folders) {
                    output::check(output)?;
                }
                output::check_inputs(output, [path.as_path()])?;
            }
            Ok(shot)
        });
        shots
            .collect::<Result<_, _>>()
            .map(|shots| Some(Self(shots)))
    }

    /// True if some outputs hold light.
    pub(in crate::render) fn hold_light(&self) -> bool {
        let mut outputs = self.0.iter().map(|shot| &shot.outputs);
        outputs.any(|outputs| match outputs {
            Outputs::Passes(files) => files.format.holds_light(),
            Outputs::Picture(..) => false,
        })
    }

    /// The detail of the textures in all pictures.
    pub(in crate::render) fn detail<'a>(&'a self, picture: &'a PictureArgs) -> PictureDetail<'a> {
        PictureDetail::of_cameras(picture, |_, options| {
            let shots = self.0.iter().take(PictureDetail::MOST_PICTURES + 1);
            let options = shots.map(|shot| shot.camera.apply(options.clone()));
            options.collect()
        })
    }

    /// The options with the size of the greatest picture.
    pub(in crate::render) fn greatest(&self, picture: &PictureArgs) -> PictureArgs {
        let sizes = self.0.iter().map(|shot| shot.camera.size);
        let greatest = sizes.max_by_key(|(width, height)| u64::from(*width) * u64::from(*height));
        PictureArgs {
            size: greatest.unwrap_or(picture.size),
            ..picture.clone()
        }
    }
}

/// True for the first file of each folder, which is the only one that is checked: a folder may have
/// many files.
fn is_new_folder(output: &Destination, folders: &mut HashSet<PathBuf>) -> bool {
    match output {
        Destination::File(path) => {
            folders.insert(path.parent().unwrap_or(Path::new("")).to_owned())
        }
        Destination::StandardOutput => true,
    }
}

impl Shot {
    fn outputs(&self) -> Vec<&Destination> {
        match &self.outputs {
            Outputs::Picture(output, _) => vec![output],
            Outputs::Passes(files) => files.files.iter().map(|file| &file.output).collect(),
        }
    }

    /// Draws and encodes the outputs.
    fn draw(
        &self,
        model: &Model,
        args: &RenderArgs,
        (options, device): (&RenderOptions, &Device),
    ) -> Result<Vec<Vec<u8>>, Failure> {
        let size = self.camera.size;
        let options = self.camera.apply(options.clone());
        match &self.outputs {
            Outputs::Picture(_, format) => {
                let frame = frame(model, &args.picture, &options, device)?;
                Ok(vec![encoded(&frame.image, *format)?])
            }
            Outputs::Passes(files) => {
                let drawn = (&options, device);
                let passes = files.passes();
                let of = (passes.as_slice(), files.format);
                let (sources, _) = Sources::draw(of, model, &args.picture, drawn)?;
                let look = (size, args.passes.depth_unit);
                let files_of = files.files.iter();
                files_of
                    .map(|file| sources.encode(file, files.format, look))
                    .collect()
            }
        }
    }

    fn json(&self, encoded: &[Vec<u8>]) -> Value {
        let outputs =
            self.outputs().into_iter().zip(encoded).map(
                |(output, bytes)| json!({ "path": output_path(output), "bytes": bytes.len() }),
            );
        json!({
            "name": self.camera.name,
            "width": self.camera.size.0,
            "height": self.camera.size.1,
            "pinhole": pinhole_json(&self.camera.pinhole),
            "outputs": outputs.collect::<Vec<_>>(),
        })
    }
}

/// Draws the model for each camera, and writes its outputs.
pub(in crate::render) fn run(
    model: &Model,
    args: &RenderArgs,
    Shots(shots): &Shots,
    clock: &Clock,
    progress: Progress,
) -> Result<(), Failure> {
    args.picture.check()?;
    for output in shots.iter().flat_map(Shot::outputs) {
        check_output(output, model, &args.picture)?;
    }
    progress.stage("drawing");
    let device = device(&args.picture)?;
    let options = frame_options(model, &args.picture, ViewDirection::default(), &device)?;
    let mut cameras = Vec::with_capacity(shots.len());
    for shot in shots {
        let encoded = shot.draw(model, args, (&options, &device))?;
        clock.check()?;
        for (output, bytes) in shot.outputs().into_iter().zip(&encoded) {
            output::write(output, bytes)?;
        }
        cameras.push(shot.json(&encoded));
    }
    drop(progress);
    let output = shots
        .first()
        .and_then(|shot| shot.outputs().first().copied());
    let output = output.unwrap_or(&Destination::StandardOutput);
    let subject = format!("{} cameras", shots.len());
    let total = clock.elapsed();
    write(&args.report, model, output, &subject, total, || {
        let warnings = model.warnings.iter().map(ToString::to_string);
        json!({
            "model": model.name,
            "cameras": cameras,
            "counts": counts(model),
            "objects": model.scene.meshes.iter().map(|mesh| &mesh.name).collect::<Vec<_>>(),
            "materials": model.scene.materials.iter().map(|one| &one.name).collect::<Vec<_>>(),
            "milliseconds": rounded_milliseconds(total),
            "warnings": warnings.collect::<Vec<_>>(),
        })
    })
}
