//! The report of `estampe render`: a line of text, or a JSON object.

use super::arguments::RenderArgs;
use super::command::milliseconds;
use crate::failure::Failure;
use crate::input::Model;
use crate::values::{Destination, shown};
use clap::ValueEnum;
use estampe::Device;
use estampe_assets::image::ImageFormat;
use estampe_renderer::Frame;
use estampe_scene::Projection;
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
pub(super) struct Report<'a> {
    pub(super) args: &'a RenderArgs,
    pub(super) model: &'a Model,
    pub(super) frame: &'a Frame,
    pub(super) device: &'a Device,
    pub(super) written: Encoded,
}

impl Report<'_> {
    /// Writes one line to standard error.
    pub(super) fn write_summary(&self) {
        let (width, height) = self.args.size;
        let triangles: usize = self
            .model
            .scene
            .meshes
            .iter()
            .map(|m| m.triangles.len())
            .sum();
        let total = milliseconds(self.written.total);
        let output = self.output_name();
        // If standard error is closed, the line is lost.
        let _ = writeln!(
            io::stderr(),
            "{output}: {width}x{height}, {triangles} triangles, {total:.0} ms"
        );
    }

    /// Writes one object to standard output, or to standard error if the image goes to standard
    /// output.
    pub(super) fn write_json(&self) -> Result<(), Failure> {
        let object = self.json();
        let written = if self.args.output.is_standard_output() {
            writeln!(io::stderr(), "{object:#}")
        } else {
            let mut out = io::stdout().lock();
            writeln!(out, "{object:#}").and_then(|()| out.flush())
        };
        written.map_err(|error| {
            Failure::Output(format!(
                "the report: {error}; check the program that reads standard output"
            ))
        })
    }

    fn output_name(&self) -> String {
        match &self.args.output {
            Destination::File(path) => shown(path),
            Destination::StandardOutput => "standard output".to_owned(),
        }
    }

    fn json(&self) -> Value {
        let shading = self.args.shading.to_possible_value();
        json!({
            "model": self.model.name,
            "format": self.model.format.map(|format| format.name()),
            "output": {
                "path": self.output_name(),
                "format": format!("{:?}", self.written.format).to_lowercase(),
                "width": self.args.size.0,
                "height": self.args.size.1,
                "samples": if self.args.samples == "1" { 1 } else { 4 },
                "bytes": self.written.bytes,
            },
            "shading": shading.as_ref().map(clap::builder::PossibleValue::get_name),
            "threads": self.device.threads(),
            "simd": self.device.level().name(),
            "camera": self.camera(),
            "counts": counts(self.model),
            "pipeline": self.pipeline(),
            "timings_ms": self.timings(),
            "warnings": self.model.warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
            "warning_count": self.model.warning_count,
        })
    }

    fn camera(&self) -> Value {
        let camera = &self.frame.camera;
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

    fn pipeline(&self) -> Value {
        let statistics = &self.frame.statistics;
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
        let (timings, written) = (&self.frame.timings, &self.written);
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
        let rounded = |time: Duration| (milliseconds(time) * 1e3).round() / 1e3;
        stages
            .into_iter()
            .map(|(stage, time)| (stage.to_owned(), json!(rounded(time))))
            .collect()
    }
}

/// The counts of a model's contents.
pub(crate) fn counts(model: &Model) -> Value {
    let scene = &model.scene;
    let sum = |count: fn(&estampe_scene::Mesh) -> usize| -> usize {
        scene.meshes.iter().map(count).sum()
    };
    json!({
        "meshes": scene.meshes.len(),
        "vertices": sum(|mesh| mesh.positions.len()),
        "triangles": sum(|mesh| mesh.triangles.len()),
        "lines": sum(|mesh| mesh.lines.len()),
        "points": sum(|mesh| mesh.points.len()),
        "materials": scene.materials.len(),
        "textures": scene.images.len(),
    })
}
