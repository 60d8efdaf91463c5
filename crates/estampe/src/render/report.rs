//! The report of `estampe render`: a line of text, or a JSON object.

use super::draw::Drawn;
use super::picture::{PictureArgs, ReportArgs};
use crate::failure::Failure;
use crate::input::Model;
use crate::values::{Destination, shown};
use clap::ValueEnum;
use estampe_assets::image::ImageFormat;
use estampe_scene::{Camera, Projection};
use serde_json::{Value, json};
use std::io::{self, Write};
use std::time::Duration;

/// The written file, and the duration of its stages.
#[derive(Debug, Clone, Copy)]
pub(super) struct Encoded {
    pub(super) format: ImageFormat,
    pub(super) bytes: usize,
    pub(super) texture: Duration,
    pub(super) device: Duration,
    pub(super) encode: Duration,
    pub(super) write: Duration,
    pub(super) total: Duration,
}

/// The contents of a report.
pub(crate) struct Report<'a> {
    pub(crate) args: &'a PictureArgs,
    pub(crate) output: &'a Destination,
    pub(crate) model: &'a Model,
    pub(crate) drawn: &'a Drawn,
    /// The function that was meshed, if there is one.
    pub(crate) shape: Option<Value>,
}

impl Report<'_> {
    /// Writes the warnings, and the object or the line of text, as the options say.
    pub(crate) fn write(&self, args: &ReportArgs) -> Result<(), Failure> {
        let (width, height) = self.args.size;
        if let Some(warning) = self.unpeeled().filter(|_| !args.quiet) {
            // If standard error is closed, the warning is lost.
            let _ = writeln!(io::stderr(), "warning: {warning}");
        }
        let output = output_name(self.output);
        let subject = format!("{output}: {width}x{height}");
        write(
            args,
            self.model,
            self.output,
            &subject,
            self.drawn.written.total,
            || self.json(),
        )
    }

    /// The warning of a picture with more layers than are peeled.
    fn unpeeled(&self) -> Option<String> {
        let layers = self.drawn.frame.layers?;
        (!layers.is_complete).then(|| {
            format!(
                "more than {} layers of transparent surfaces: those in front of them are sorted by \
                 triangles",
                layers.count
            )
        })
    }

    fn json(&self) -> Value {
        let shading = self.args.shading.to_possible_value();
        let transparency = self.args.transparency.to_possible_value();
        let warnings = self.model.warnings.iter().map(ToString::to_string);
        let warnings: Vec<String> = warnings.chain(self.unpeeled()).collect();
        let Drawn {
            device, written, ..
        } = self.drawn;
        let mut object = json!({
            "model": self.model.name,
            "format": self.model.format.map(|format| format.name()),
            "output": {
                "path": output_path(self.output),
                "format": format!("{:?}", written.format).to_lowercase(),
                "width": self.args.size.0,
                "height": self.args.size.1,
                "samples": self.args.sample_count(),
                "bytes": written.bytes,
            },
            "shading": shading.as_ref().map(clap::builder::PossibleValue::get_name),
            "transparency": {
                "method": transparency.as_ref().map(clap::builder::PossibleValue::get_name),
                "layers": self.drawn.frame.layers.map(|layers| layers.count),
            },
            "threads": device.threads(),
            "simd": device.level().name(),
            "camera": camera_json(&self.drawn.frame.camera),
            "counts": counts(self.model),
            "pipeline": self.pipeline(),
            "timings_ms": self.timings(),
            "warnings": warnings,
            "warning_count": self.model.warning_count + u64::from(self.unpeeled().is_some()),
        });
        if let Some(shape) = &self.shape {
            object["shape"] = shape.clone();
        }
        object
    }

    fn pipeline(&self) -> Value {
        let statistics = &self.drawn.frame.statistics;
        json!({
            "vertices_shaded": statistics.vertices_shaded,
            "primitives_in": statistics.primitives_in,
            "primitives_clipped": statistics.primitives_clipped,
            "primitives_culled": statistics.primitives_culled,
            "primitives_binned": statistics.primitives_binned,
            "fragments_shaded": statistics.fragments_shaded,
        })
    }

    fn timings(&self) -> Value {
        let (timings, written) = (&self.drawn.frame.timings, &self.drawn.written);
        let stages = [
            ("read", self.model.read),
            ("parse", self.model.parse),
            ("texture", written.texture),
            ("device", written.device),
            ("prepare", timings.prepare),
            ("geometry", timings.geometry),
            ("raster", timings.raster),
            ("read_back", timings.read_back),
            ("encode", written.encode),
            ("write", written.write),
            ("total", written.total),
        ];
        stages
            .into_iter()
            .map(|(stage, time)| (stage.to_owned(), json!(rounded_milliseconds(time))))
            .collect()
    }
}

/// Writes the warnings of a model, then one JSON object, or one line to standard error that begins
/// with `subject`.
pub(crate) fn write(
    args: &ReportArgs,
    model: &Model,
    output: &Destination,
    subject: &str,
    total: Duration,
    object: impl FnOnce() -> Value,
) -> Result<(), Failure> {
    if !args.quiet {
        model.print_warnings();
    }
    if args.json {
        return write_json(&object(), output);
    }
    if !args.quiet {
        let counts = model.counts();
        let primitives = match (counts.triangles, counts.lines) {
            (0, lines @ 1..) => format!("{lines} lines"),
            (triangles, _) => format!("{triangles} triangles"),
        };
        let total = milliseconds(total);
        // If standard error is closed, the line is lost.
        let _ = writeln!(io::stderr(), "{subject}, {primitives}, {total:.0} ms");
    }
    Ok(())
}

/// Writes one object to standard output, or to standard error if the output goes to standard
/// output.
pub(crate) fn write_json(object: &Value, output: &Destination) -> Result<(), Failure> {
    if !output.is_standard_output() {
        return crate::output::print(&format!("{object:#}\n"));
    }
    writeln!(io::stderr(), "{object:#}").map_err(|error| {
        Failure::Output(format!(
            "the report: {error}; check the program that reads standard output"
        ))
    })
}

/// A camera, for programs.
pub(super) fn camera_json(camera: &Camera) -> Value {
    let (kind, key, value, near, far) = match camera.projection {
        Projection::Perspective {
            fov_y_rad,
            near,
            far,
        } => (
            "perspective",
            "fov_y_deg",
            fov_y_rad.to_degrees(),
            near,
            far,
        ),
        Projection::Orthographic {
            half_height,
            near,
            far,
        } => ("orthographic", "half_height", half_height, near, far),
    };
    json!({
        "eye": camera.eye_world.to_array(),
        "target": camera.target_world.to_array(),
        "up": camera.up_world.to_array(),
        "projection": kind,
        key: value,
        "near": near,
        "far": far,
    })
}

/// The output's path as it is, for programs.
pub(crate) fn output_path(output: &Destination) -> String {
    match output {
        Destination::File(path) => path.to_string_lossy().into_owned(),
        Destination::StandardOutput => output_name(output),
    }
}

/// The output for messages.
pub(crate) fn output_name(output: &Destination) -> String {
    match output {
        Destination::File(path) => shown(path),
        Destination::StandardOutput => "standard output".to_owned(),
    }
}

/// Milliseconds, for text and JSON.
pub(crate) fn milliseconds(duration: Duration) -> f64 {
    duration.as_secs_f64() * 1e3
}

/// Milliseconds, rounded to microseconds.
pub(crate) fn rounded_milliseconds(duration: Duration) -> f64 {
    (milliseconds(duration) * 1e3).round() / 1e3
}

/// The counts of a model's contents.
pub(crate) fn counts(model: &Model) -> Value {
    let counts = model.counts();
    json!({
        "meshes": counts.meshes,
        "vertices": counts.vertices,
        "triangles": counts.triangles,
        "lines": counts.lines,
        "points": counts.points,
        "materials": counts.materials,
        "textures": counts.textures,
    })
}
