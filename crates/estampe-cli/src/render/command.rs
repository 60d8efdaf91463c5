//! Runs `estampe render`, from arguments to a written image, stage by stage.

use super::arguments::RenderArgs;
use super::report::{Encoded, Report};
use crate::failure::Failure;
use crate::input::{self, Model};
use crate::output;
use crate::progress::Progress;
use crate::values::shown;
use estampe::{Device, DeviceDescriptor};
use estampe_assets::Limits;
use estampe_assets::image::{ImageFormat, decode, encode};
use estampe_renderer::{
    CameraOptions, Eye, Frame, ProjectionKind, RenderOptions, ViewDirection, composite_over, render,
};
use estampe_scene::{Image, Light, Scene};
use glam::Vec3;
use std::time::{Duration, Instant};

/// Number of stages of the progress bar.
const STAGES: u64 = 5;

/// Runs the command.
pub(crate) fn run(args: &RenderArgs) -> Result<(), Failure> {
    let start = Instant::now();
    let format = image_format(args)?;
    output::check(&args.output)?;
    let progress = Progress::new(STAGES, args.quiet);

    let limits = Limits {
        threads: args.threads.map_or(0, usize::from),
        ..Limits::default()
    };
    let model = Model::read(&args.model, args.format, &limits, |stage| {
        progress.stage(stage);
    })?;
    check_drawable(&model)?;
    let texture_start = Instant::now();
    let texture = args
        .texture
        .as_deref()
        .map(|path| read_texture(path, &model))
        .transpose()?;
    let texture_time = texture_start.elapsed();

    progress.stage("drawing");
    let device_start = Instant::now();
    let device = device(args)?;
    let device_time = device_start.elapsed();
    let frame = render(&model.scene, &options(args, texture), &device)?;

    progress.stage("encoding");
    let encode_start = Instant::now();
    let bytes = encoded(&frame, format)?;
    let encode_time = encode_start.elapsed();

    progress.stage("writing");
    let write_start = Instant::now();
    output::write(&args.output, &bytes)?;
    drop(progress);

    let written = Encoded {
        format,
        bytes: bytes.len(),
        texture: texture_time,
        device: device_time,
        encode: encode_time,
        write: write_start.elapsed(),
        total: start.elapsed(),
    };
    let report = Report {
        args,
        model: &model,
        frame: &frame,
        device: &device,
        written,
    };
    if !args.quiet {
        model.print_warnings();
    }
    if args.json {
        report.write_json()
    } else {
        if !args.quiet {
            report.write_summary();
        }
        Ok(())
    }
}

fn image_format(args: &RenderArgs) -> Result<ImageFormat, Failure> {
    let named = args.output_format.map(ImageFormat::from);
    named.or_else(|| args.output.image_format()).ok_or_else(|| {
        Failure::Usage(
            "OUT's name does not show the image's format; name it .png, .jpg or .tga, or add \
             --output-format"
                .to_owned(),
        )
    })
}

/// Refuses a model without anything to draw, which would give an empty image.
fn check_drawable(model: &Model) -> Result<(), Failure> {
    let has_primitives = |scene: &Scene| {
        let meshes = &mut scene.meshes.iter();
        meshes.any(|m| !(m.triangles.is_empty() && m.lines.is_empty() && m.points.is_empty()))
    };
    if has_primitives(&model.scene) {
        return Ok(());
    }
    let name = &model.name;
    let advice = "check that the export was complete";
    Err(Failure::Input(format!(
        "{name}: the model has no triangle, line or point to draw; {advice}"
    )))
}

fn read_texture(path: &std::path::Path, model: &Model) -> Result<Image, Failure> {
    let limits = Limits::default();
    let bytes = input::read_file(path, &limits)?;
    let image = decode(&bytes, &limits).map_err(|error| error.in_file(&shown(path)))?;
    if model.scene.meshes.iter().all(|mesh| mesh.uvs.is_empty()) {
        let name = &model.name;
        return Err(Failure::Input(format!(
            "{name}: the model has no texture coordinates, so --texture has no effect; omit it"
        )));
    }
    Ok(image)
}

fn device(args: &RenderArgs) -> Result<Device, Failure> {
    let descriptor = DeviceDescriptor {
        threads: args.threads.map_or(0, usize::from),
        level: args.simd,
        ..DeviceDescriptor::default()
    };
    Device::new(&descriptor)
        .map_err(|error| Failure::Output(format!("{error}; try fewer --threads")))
}

fn options(args: &RenderArgs, texture: Option<Image>) -> RenderOptions {
    let default = ViewDirection::default();
    let direction = match args.view {
        Some(view) => view.into(),
        None => ViewDirection {
            azimuth_deg: args.azimuth.unwrap_or(default.azimuth_deg),
            elevation_deg: args.elevation.unwrap_or(default.elevation_deg),
        },
    };
    let light = |towards: &glam::DVec3| Light {
        // Normalised, because f64's range exceeds f32's; only the direction matters.
        towards_light_world: towards.normalize_or(glam::DVec3::Y).as_vec3(),
        color: Vec3::ONE,
    };
    RenderOptions {
        width: args.size.0,
        height: args.size.1,
        samples: if args.samples == "1" { 1 } else { 4 },
        camera: CameraOptions {
            eye: args.eye.map_or(Eye::Fitted(direction), Eye::At),
            target_world: args.target,
            projection: if args.ortho {
                ProjectionKind::Orthographic
            } else {
                ProjectionKind::Perspective {
                    fov_y_deg: args.fov,
                }
            },
            margin: args.margin,
        },
        up: args.up,
        shading: args.shading.into(),
        lights: args.light.iter().map(light).collect(),
        ambient: args.ambient,
        texture,
        background: args.background.0,
        cull: args.cull.into(),
    }
}

/// The image's file; formats without alpha get the default background behind transparency.
fn encoded(frame: &Frame, format: ImageFormat) -> Result<Vec<u8>, Failure> {
    let opaque;
    let image = if format.has_alpha() {
        &frame.image
    } else {
        opaque = composite_over(&frame.image, RenderOptions::DEFAULT_BACKGROUND);
        &opaque
    };
    encode(image, format).map_err(|error| Failure::Output(error.to_string()))
}

/// Milliseconds, for text and JSON.
pub(super) fn milliseconds(duration: Duration) -> f64 {
    duration.as_secs_f64() * 1e3
}
