//! Runs `estampe turntable`.

use super::arguments::TurntableArgs;
use super::orbit::{Orbit, turned};
use super::output::{Output, numbered};
use super::poses::Poses;
use crate::failure::Failure;
use crate::input::{Model, Reading};
use crate::limits::Clock;
use crate::output::{self, Unwritten};
use crate::progress::Progress;
use crate::render::{self, PictureDetail};
use crate::values::Destination;
use estampe::Device;
use estampe_assets::image::animation::{ApngWriter, WebpAnimation, Y4mWriter};
use estampe_assets::image::gif::{MAX_GIF_RATE, write_gif};
use estampe_renderer::{Eye, RenderOptions, ViewDirection, composite_over};
use estampe_scene::{Image, Scene};
use serde_json::json;
use std::io::Write;

/// The greatest sum of a GIF's frames, all of which its palette needs.
const MOST_GIF_BYTES: u64 = 4 << 30;

/// Runs the command.
pub(crate) fn run(args: &TurntableArgs) -> Result<(), Failure> {
    let clock = args.limits.watch("turntable", &args.model.name());
    let format = Output::of(args)?;
    check(args, &format)?;
    // Reading and parsing come before, and writing after.
    let progress = Progress::new(3 + u64::from(args.frames), args.report.quiet);
    let limits = args.limits.of_reader(args.picture.thread_count());
    let time_s = args.picture.shader.time.or(args.animate.then_some(0.0));
    let chosen = args.choice.at(time_s);
    let folder = args.choice.folder_of(&args.model)?;
    let source = (&args.model, &folder);
    let reading = Reading {
        options: &chosen,
        limits: &limits,
        detail: &PictureDetail::of_cameras(&args.picture, |scene, options| {
            turn_of(args, scene, options)
        }),
    };
    let model = Model::read(source, args.format, reading, |stage| {
        progress.stage(stage);
    })?;
    args.limits.check_memory(&model, &args.picture, false)?;
    for frame in 0..args.frames {
        let destination = numbered(&args.output, frame, args.frames);
        render::check_output(&destination, &model, &args.picture)?;
    }
    let (mut options, device) = render::prepare(&model, &args.picture, ViewDirection::default())?;
    // All frames are alike.
    options.edges_of_flat_views = false;
    let Eye::Fitted(direction) = options.camera.eye else {
        return Err(fixed_camera());
    };
    let poses = if args.animate {
        Some(Poses::new(args, &limits, &model)?)
    } else {
        None
    };
    let mut orbit = Orbit::new(&model.scene, &options, direction);
    orbit.include(&model.scene, options.up);
    if let Some(poses) = &poses {
        for frame in 1..args.frames {
            orbit.include(&poses.shape_at(frame)?.scene, options.up);
        }
    }
    let turn = Turn {
        args,
        model: &model,
        poses,
        options,
        device,
        orbit,
        progress: &progress,
    };
    turn.write(&format)?;
    drop(progress);
    report(args, &format, &model, &clock)
}

/// The options of all frames, to find the detail of textures. The poses of `--animate` are read for
/// each frame, and the model itself is not drawn.
fn turn_of(args: &TurntableArgs, scene: &Scene, options: RenderOptions) -> Vec<RenderOptions> {
    match options.camera.eye {
        Eye::Fitted(start) if !args.animate => {
            let mut orbit = Orbit::new(scene, &options, start);
            orbit.include(scene, options.up);
            turned(&orbit, args.frames, &options)
        }
        _ => vec![options],
    }
}

/// Refuses what cannot be drawn, before anything is read.
fn check(args: &TurntableArgs, format: &Output) -> Result<(), Failure> {
    if args.picture.eye.is_some() || args.picture.camera.is_some() {
        return Err(fixed_camera());
    }
    if *format == Output::Gif {
        let (frames, seconds) = (args.fps.frames(), args.fps.seconds());
        if u32::from(frames) > u32::from(MAX_GIF_RATE) * u32::from(seconds) {
            return Err(Failure::Usage(format!(
                "GIF shows at most {MAX_GIF_RATE} frames in a second; choose a smaller --fps, or \
                 name OUT .png or .webp"
            )));
        }
        let (width, height) = args.picture.size;
        let bytes = u64::from(width) * u64::from(height) * 4 * u64::from(args.frames);
        if bytes > MOST_GIF_BYTES {
            return Err(Failure::Limit(format!(
                "the frames of the GIF have {bytes} bytes, more than the limit of {MOST_GIF_BYTES}; \
                 choose fewer --frames or a smaller --size"
            )));
        }
    }
    output::check(&numbered(&args.output, 0, args.frames))
}

fn fixed_camera() -> Failure {
    Failure::Usage(
        "--eye and --camera fix the camera, which goes around the model here; choose --azimuth, \
         --elevation and --target"
            .to_owned(),
    )
}

/// What all frames share.
struct Turn<'a> {
    args: &'a TurntableArgs,
    model: &'a Model,
    poses: Option<Poses<'a>>,
    options: RenderOptions,
    device: Device,
    orbit: Orbit,
    progress: &'a Progress,
}

impl Turn<'_> {
    /// Draws and writes all frames.
    fn write(&self, format: &Output) -> Result<(), Failure> {
        let args = self.args;
        let (size, rate) = (args.picture.size, args.fps);
        let has_alpha = self.options.background.is_none();
        match format {
            Output::Pictures(format) => {
                let drawn = self.each_frame(|frame, image| {
                    let bytes = render::encoded(&image, *format)?;
                    output::write(&numbered(&args.output, frame, args.frames), &bytes)?;
                    Ok(())
                });
                drawn.map_err(failure)
            }
            Output::Gif => {
                let mut frames = Vec::new();
                let drawn = self.each_frame(|_, image| {
                    frames.push(image);
                    Ok(())
                });
                drawn.map_err(failure)?;
                self.progress.stage("encoding");
                output::write_with(&args.output, |out| Ok(write_gif(out, &frames, rate)?))
            }
            Output::Apng => output::write_with(&args.output, |out| {
                let mut writer = ApngWriter::new(out, size, (args.frames, rate), has_alpha)?;
                self.each_frame(|_, image| Ok(writer.add(image)?))?;
                Ok(writer.finish()?)
            }),
            Output::Webp => {
                let mut animation = WebpAnimation::new(size, rate, has_alpha);
                let drawn = self.each_frame(|_, image| Ok(animation.add(image)?));
                drawn.map_err(failure)?;
                let file = animation.finish();
                let file = file.map_err(|error| failure(Unwritten::Io(error)))?;
                output::write(&args.output, &file)
            }
            Output::Y4m => output::write_with(&args.output, |out| {
                let samples = (args.chroma.into(), args.matrix.into());
                let mut writer = Y4mWriter::new(out, size, rate, samples)?;
                self.each_frame(|_, image| {
                    let opaque = composite_over(&image, RenderOptions::DEFAULT_BACKGROUND);
                    Ok(writer.add(&opaque)?)
                })
            }),
        }
    }

    /// Draws one frame after the other.
    fn each_frame(
        &self,
        mut use_frame: impl FnMut(u32, Image) -> Result<(), Unwritten>,
    ) -> Result<(), Unwritten> {
        let count = self.args.frames;
        for frame in 0..count {
            self.progress.stage("drawing");
            let picture = &self.args.picture;
            let camera = self.orbit.camera(frame, count, self.options.camera);
            let drawn = match &self.poses {
                None => {
                    let options = RenderOptions {
                        camera,
                        ..self.options.clone()
                    };
                    render::frame(self.model, picture, &options, &self.device)?
                }
                Some(poses) => {
                    let seen = |_: &Scene, options| vec![RenderOptions { camera, ..options }];
                    let detail = PictureDetail::of_cameras(picture, seen);
                    let model = poses.at(frame, &detail)?;
                    // Shaders see the time too.
                    let mut picture = picture.clone();
                    picture.shader.time = Some(poses.time_s(frame));
                    let view = ViewDirection::default();
                    let options = render::frame_options(&model, &picture, view, &self.device)?;
                    let options = RenderOptions {
                        camera,
                        edges_of_flat_views: false,
                        ..options
                    };
                    render::frame(&model, &picture, &options, &self.device)?
                }
            };
            use_frame(frame, drawn.image)?;
        }
        Ok(())
    }
}

/// The failure of frames that are not in a file yet.
fn failure(reason: Unwritten) -> Failure {
    match reason {
        Unwritten::Failed(failure) => failure,
        Unwritten::Io(error) => Failure::Output(format!("{error}; choose another output format")),
    }
}

/// The summary on standard error, or the object.
fn report(
    args: &TurntableArgs,
    format: &Output,
    model: &Model,
    clock: &Clock,
) -> Result<(), Failure> {
    let (width, height) = args.picture.size;
    let rate = f64::from(args.fps.frames()) / f64::from(args.fps.seconds());
    let bytes = match (&args.output, format) {
        (Destination::StandardOutput, _) => None,
        (_, Output::Pictures(_)) => { 0..args.frames }
            .map(|frame| bytes_of(&numbered(&args.output, frame, args.frames)))
            .sum(),
        _ => bytes_of(&args.output),
    };
    if !args.report.quiet {
        model.print_warnings();
    }
    if args.report.json {
        let warnings = model.warnings.iter().map(ToString::to_string);
        let object = json!({
            "model": model.name,
            "output": {
                "path": render::output_path(&args.output),
                "format": format.name(),
                "width": width,
                "height": height,
                "frames": args.frames,
                "frames_per_second": rate,
                "bytes": bytes,
            },
            "milliseconds": render::rounded_milliseconds(clock.elapsed()),
            "warnings": warnings.collect::<Vec<_>>(),
        });
        return render::write_json(&object, &args.output);
    }
    if !args.report.quiet {
        let bytes = bytes.map_or_else(String::new, |bytes| format!("{bytes} bytes, "));
        // If standard error is closed, the line is lost.
        let _ = writeln!(
            std::io::stderr(),
            "{}: {width}x{height}, {} frames at {rate} fps, {bytes}{:.1} s",
            render::output_name(&args.output),
            args.frames,
            clock.elapsed().as_secs_f64()
        );
    }
    Ok(())
}

/// The size of a file.
fn bytes_of(destination: &Destination) -> Option<u64> {
    match destination {
        Destination::File(path) => Some(std::fs::metadata(path).ok()?.len()),
        Destination::StandardOutput => None,
    }
}
