//! Draws passes, and writes them.

use super::super::draw::{device, frame_options};
use super::super::report::{camera_json, counts, output_path, rounded_milliseconds, write};
use super::files::{Files, PassFile, PassFormat};
use super::planes::Sources;
use crate::failure::Failure;
use crate::input::Model;
use crate::limits::Clock;
use crate::output;
use crate::progress::Progress;
use crate::render::{RenderArgs, check_output};
use estampe_renderer::{Pinhole, ViewDirection};
use serde_json::{Value, json};

/// Draws the passes of a model.
pub(in crate::render) fn run(
    model: &Model,
    args: &RenderArgs,
    files: &Files,
    clock: &Clock,
    progress: Progress,
) -> Result<(), Failure> {
    let picture = &args.picture;
    picture.check()?;
    for file in &files.files {
        check_output(&file.output, model, picture)?;
    }
    progress.stage("drawing");
    let device = device(picture)?;
    let options = frame_options(model, picture, ViewDirection::default(), &device)?;
    let passes = files.passes();
    let (sources, camera) =
        Sources::draw((&passes, files.format), model, picture, (&options, &device))?;

    progress.stage("encoding");
    let unit = args.passes.depth_unit;
    let encode = |file: &PassFile| sources.encode(file, files.format, (picture.size, unit));
    let encoded: Vec<Vec<u8>> = { files.files.iter().map(encode) }.collect::<Result<_, _>>()?;
    progress.stage("writing");
    clock.check()?;
    for (file, bytes) in files.files.iter().zip(&encoded) {
        output::write(&file.output, bytes)?;
    }
    drop(progress);
    let (width, height) = picture.size;
    let subject = format!("{}: {width}x{height}", files.name());
    let total = clock.elapsed();
    write(
        &args.report,
        model,
        &files.files[0].output,
        &subject,
        total,
        || {
            let outputs = files.files.iter().zip(&encoded).map(|(file, bytes)| {
                json!({
                    "path": output_path(&file.output),
                    "passes": file.passes.iter().map(|pass| pass.name()).collect::<Vec<_>>(),
                    "bytes": bytes.len(),
                })
            });
            let warnings = model.warnings.iter().map(ToString::to_string);
            let mut camera_object = Value::Null;
            if let Some((camera, pinhole)) = &camera {
                camera_object = camera_json(camera);
                camera_object["pinhole"] = pinhole.as_ref().map_or(Value::Null, pinhole_json);
            }
            json!({
                "model": model.name,
                "width": width,
                "height": height,
                "depth_unit": (files.format == PassFormat::Png).then_some(args.passes.depth_unit),
                "outputs": outputs.collect::<Vec<_>>(),
                "camera": camera_object,
                "counts": counts(model),
                "objects": model.scene.meshes.iter().map(|mesh| &mesh.name).collect::<Vec<_>>(),
                "materials": model.scene.materials.iter().map(|one| &one.name).collect::<Vec<_>>(),
                "milliseconds": rounded_milliseconds(total),
                "warnings": warnings.collect::<Vec<_>>(),
            })
        },
    )
}

/// The camera as computer vision writes it: a point p of the world is seen at the pixel
/// (x, y) ∝ K·(R·p + t), x to the right and y down from the upper left corner of the image, and z
/// forward.
pub(in crate::render) fn pinhole_json(pinhole: &Pinhole) -> Value {
    let [fx, fy] = pinhole.intrinsics.focal_px;
    let [cx, cy] = pinhole.intrinsics.principal_px;
    json!({
        "K": [[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]],
        "R": pinhole.rotation.map(|row| row.to_array()),
        "t": pinhole.translation.to_array(),
    })
}
