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
use estampe_renderer::ViewDirection;
use estampe_scene::{Camera, Projection};
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
    let (sources, camera) = Sources::draw(&passes, model, picture, (&options, &device))?;

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
            let mut camera_object = camera.as_ref().map_or(Value::Null, camera_json);
            if let Some(camera) = &camera {
                camera_object["pinhole"] = pinhole(camera, picture.size);
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
/// forward. `Null` of a parallel projection.
fn pinhole(camera: &Camera, (width, height): (u32, u32)) -> Value {
    let Projection::Perspective { fov_y_rad, .. } = camera.projection else {
        return Value::Null;
    };
    let eye = camera.eye_world.as_dvec3();
    let forward = (camera.target_world.as_dvec3() - eye).normalize_or_zero();
    let right = forward
        .cross(camera.up_world.as_dvec3())
        .normalize_or_zero();
    let down = forward.cross(right);
    let rows = [right, down, forward];
    let (width, height) = (f64::from(width), f64::from(height));
    let focal_px = height / 2.0 / libm::tan(f64::from(fov_y_rad) / 2.0);
    json!({
        "K": [[focal_px, 0.0, width / 2.0], [0.0, focal_px, height / 2.0], [0.0, 0.0, 1.0]],
        "R": rows.map(|row| row.to_array()),
        "t": rows.map(|row| -row.dot(eye)),
    })
}
