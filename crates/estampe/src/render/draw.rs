//! Draws a model and writes the picture, for all commands that draw.

use super::camera_check;
use super::cameras::NamedCamera;
use super::picture::PictureArgs;
use super::report::Encoded;
use super::texture_detail::level_of_texture;
use crate::choice;
use crate::failure::Failure;
use crate::input::{self, Model};
use crate::limits::Clock;
use crate::output;
use crate::progress::Progress;
use crate::shader::values::{FRAGMENT_JUMPS, Via};
use crate::terminal::one_line;
use crate::values::{Destination, ImageFormatName, shown};
use estampe::{Device, DeviceDescriptor};
use estampe_assets::image::{
    ImageFormat, Reduction, TexelContent, decode_reduced, encode, stated_size,
};
use estampe_assets::{Limits, ModelFormat};
use estampe_renderer::{
    CameraOptions, Eye, Frame, LightImage, ProjectionKind, RenderOptions, Up, ViewDirection,
    composite_over, render, render_light, render_spent,
};
use estampe_scene::{Image, Projection, Scene};
use std::time::Instant;

/// The stages that [`draw`] begins.
pub(crate) const STAGES: u64 = 3;

/// A picture that was written.
pub(crate) struct Drawn {
    pub(super) frame: Frame,
    pub(super) device: Device,
    pub(super) written: Encoded,
}

/// Draws the model, and writes the picture to its destination. `default_view` is the view if no
/// option says another one. The model's scene is taken.
pub(crate) fn draw(
    model: &mut Model,
    args: &PictureArgs,
    default_view: ViewDirection,
    (output, format): (&Destination, ImageFormat),
    clock: &Clock,
    progress: &Progress,
) -> Result<Drawn, Failure> {
    let encode = |image: &Image| encoded(image, format);
    let to = (output, format);
    draw_with(model, args, default_view, to, (clock, progress), encode)
}

/// As [`draw`], with other bytes than those of the format.
pub(super) fn draw_with(
    model: &mut Model,
    args: &PictureArgs,
    default_view: ViewDirection,
    (output, format): (&Destination, ImageFormat),
    (clock, progress): (&Clock, &Progress),
    encode: impl FnOnce(&Image) -> Result<Vec<u8>, Failure>,
) -> Result<Drawn, Failure> {
    args.check()?;
    check_drawable(model)?;
    check_output(output, model, args)?;
    let texture_start = Instant::now();
    let texture = texture_of(model, args, Some(default_view))?;
    let texture_time = texture_start.elapsed();

    progress.stage("drawing");
    let device_start = Instant::now();
    let device = device(args)?;
    let device_time = device_start.elapsed();
    let options = options(model, args, (default_view, texture), &device)?;
    let on_stage = |stage| progress.frame(stage);
    let frame = render_spent(model.take_scene(), &options, &device, &on_stage);
    let frame = frame.map_err(|error| args.shader.failure(error))?;

    progress.stage("encoding");
    let encode_start = Instant::now();
    let bytes = encode(&frame.image)?;
    let encode_time = encode_start.elapsed();

    progress.stage("writing");
    clock.check()?;
    let write_start = Instant::now();
    output::write(output, &bytes)?;
    let written = Encoded {
        format,
        bytes: bytes.len(),
        texture: texture_time,
        device: device_time,
        encode: encode_time,
        write: write_start.elapsed(),
        total: clock.elapsed(),
    };
    Ok(Drawn {
        frame,
        device,
        written,
    })
}

/// Refuses an output that is the model, one of its files, or a file of the options.
pub(crate) fn check_output(
    output: &Destination,
    model: &Model,
    args: &PictureArgs,
) -> Result<(), Failure> {
    let options = [args.texture.as_deref(), args.shader.file()];
    let files = model.files.iter().map(std::path::PathBuf::as_path);
    output::check_inputs(output, files.chain(options.into_iter().flatten()))
}

/// The bytes of a picture that a device draws, with the camera of a file if there is one.
pub(crate) fn drawn_bytes(
    model: &Model,
    (args, camera): (&PictureArgs, Option<&NamedCamera>),
    (default_view, format): (ViewDirection, ImageFormat),
    device: &Device,
) -> Result<Vec<u8>, Failure> {
    check_drawable(model)?;
    // The level that a camera of a file needs is not that of the default view.
    let view = camera.is_none().then_some(default_view);
    let texture = texture_of(model, args, view)?;
    let mut options = options(model, args, (default_view, texture), device)?;
    if let Some(camera) = camera {
        options = camera.apply(options);
    }
    let frame = frame(model, args, &options, device)?;
    encoded(&frame.image, format)
}

/// The renderer's options of a picture, and the device that draws it.
pub(crate) fn prepare(
    model: &Model,
    args: &PictureArgs,
    default_view: ViewDirection,
) -> Result<(RenderOptions, Device), Failure> {
    args.check()?;
    let device = device(args)?;
    let options = frame_options(model, args, default_view, &device)?;
    Ok((options, device))
}

/// The renderer's options of a model, for a device that draws several frames.
pub(crate) fn frame_options(
    model: &Model,
    args: &PictureArgs,
    default_view: ViewDirection,
    device: &Device,
) -> Result<RenderOptions, Failure> {
    check_drawable(model)?;
    let texture = texture_of(model, args, None)?;
    options(model, args, (default_view, texture), device)
}

/// A frame with the renderer's options.
pub(crate) fn frame(
    model: &Model,
    args: &PictureArgs,
    options: &RenderOptions,
    device: &Device,
) -> Result<Frame, Failure> {
    render(&model.scene, options, device).map_err(|error| args.shader.failure(error))
}

/// A frame of light with the renderer's options.
pub(super) fn light_frame(
    model: &Model,
    args: &PictureArgs,
    options: &RenderOptions,
    device: &Device,
) -> Result<Frame<LightImage>, Failure> {
    render_light(&model.scene, options, device).map_err(|error| args.shader.failure(error))
}

/// The renderer's options, with the program of a shader, and a camera of the model.
fn options(
    model: &Model,
    args: &PictureArgs,
    (default_view, texture): (ViewDirection, Option<Image>),
    device: &Device,
) -> Result<RenderOptions, Failure> {
    camera_check::eye_in_middle(args.eye, args.target, (&model.scene, args.up))?;
    let mut options = RenderOptions {
        program: args.shader.program(device, args.texture.as_deref())?,
        ..args.options(default_view, texture)?
    };
    if let Some(bounding_box) = &mut options.bounding_box {
        bounding_box.unit = unit_of(model.format).map(str::to_owned);
    }
    with_model_camera(options, args, &model.scene)
}

/// The options with the camera of the model that the arguments choose, if they do.
pub(super) fn with_model_camera(
    options: RenderOptions,
    args: &PictureArgs,
    scene: &Scene,
) -> Result<RenderOptions, Failure> {
    let Some(chosen) = &args.camera else {
        return Ok(options);
    };
    let camera = choice::camera(scene, chosen)?.camera;
    Ok(RenderOptions {
        camera: CameraOptions {
            eye: Eye::At(camera.eye_world.as_dvec3()),
            target_world: Some(camera.target_world.as_dvec3()),
            projection: match camera.projection {
                Projection::Perspective { fov_y_rad, .. } => ProjectionKind::Perspective {
                    fov_y_deg: f64::from(fov_y_rad).to_degrees(),
                },
                Projection::Orthographic { half_height, .. } => ProjectionKind::Orthographic {
                    half_height: Some(f64::from(half_height)),
                },
            },
            ..options.camera
        },
        up: Up::Direction(camera.up_world.as_dvec3()),
        ..options
    })
}

/// The unit of lengths in files of a format, if the format has one.
fn unit_of(format: Option<ModelFormat>) -> Option<&'static str> {
    match format? {
        ModelFormat::Gltf => Some("m"),
        ModelFormat::ThreeMf => Some("mm"),
        _ => None,
    }
}

/// The texture of the options, if they name one; in the detail that a picture with this default
/// view needs, or whole.
fn texture_of(
    model: &Model,
    args: &PictureArgs,
    default_view: Option<ViewDirection>,
) -> Result<Option<Image>, Failure> {
    let path = args.texture.as_deref();
    let level =
        |size| default_view.map_or(0, |view| level_of_texture(size, args, view, &model.scene));
    path.map(|path| read_texture(path, model, level))
        .transpose()
}

/// The format of a picture: the named one, else that of the destination.
pub(crate) fn image_format(
    named: Option<ImageFormatName>,
    output: &Destination,
) -> Result<ImageFormat, Failure> {
    let named = named.map(ImageFormat::from);
    named.or_else(|| output.image_format()).ok_or_else(|| {
        let problem = match output.extension() {
            Some(extension) => format!(".{extension} is no format of pictures that is written"),
            None => "OUT's name does not show the image's format".to_owned(),
        };
        Failure::Usage(format!(
            "{problem}; name OUT .png, .jpg, .tga or .webp, or add --output-format"
        ))
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
    // The last warning says that there is nothing.
    let cause = match &*model.warnings {
        [first, _, ..] => {
            let place = first.location.map_or(String::new(), |at| format!("{at}: "));
            format!("; {place}{}", one_line(&first.message))
        }
        _ => String::new(),
    };
    let advice = "check that the export was complete";
    Err(Failure::Input(format!(
        "{name}: the model has no triangle, line or point to draw{cause}; {advice}"
    )))
}

fn read_texture(
    path: &std::path::Path,
    model: &Model,
    level: impl FnOnce((u32, u32)) -> u32,
) -> Result<Image, Failure> {
    let limits = Limits::default();
    let bytes = input::read_file(path, &limits)?;
    let reduction = Reduction {
        level: stated_size(&bytes).map_or(0, level),
        content: TexelContent::Color,
    };
    let image = decode_reduced(&bytes, reduction, &limits);
    let image = image.map_err(|error| error.in_file(&shown(path)))?;
    if model.scene.meshes.iter().all(|mesh| mesh.uvs.is_empty()) {
        let name = &model.name;
        return Err(Failure::Input(format!(
            "{name}: the model has no texture coordinates, so --texture has no effect; omit it"
        )));
    }
    Ok(image)
}

/// The device that draws a picture.
pub(crate) fn device(args: &PictureArgs) -> Result<Device, Failure> {
    let with_level = || DeviceDescriptor {
        level: args.simd,
        ..DeviceDescriptor::default()
    };
    let mut descriptor = DeviceDescriptor {
        threads: args.thread_count(),
        ..args.shader.via.map_or_else(with_level, Via::device)
    };
    descriptor.limits.max_shader_jumps = FRAGMENT_JUMPS;
    Device::new(&descriptor)
        .map_err(|error| Failure::Output(format!("{error}; try fewer --threads")))
}

/// The image's file; formats without alpha get the default background behind transparency.
pub(crate) fn encoded(image: &Image, format: ImageFormat) -> Result<Vec<u8>, Failure> {
    let opaque;
    let image = if format.has_alpha() {
        image
    } else {
        opaque = composite_over(image, RenderOptions::DEFAULT_BACKGROUND);
        &opaque
    };
    encode(image, format).map_err(|error| Failure::Output(error.to_string()))
}
