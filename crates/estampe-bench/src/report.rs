//! Reports in `peerbench`'s form: JSON with one scene per line, and a table.

use crate::frame::FrameSize;
use crate::measure::Timing;
use crate::picture::Difference;
use crate::scene::Scene;
use estampe::Device;
use serde::Serialize;
use std::fmt::Write as _;

/// The results of one run.
#[derive(Debug, Clone)]
pub struct Report {
    /// The name of the run.
    pub label: String,
    /// SIMD level and threads.
    pub driver: String,
    /// One row per scene and size, in the order of drawing.
    pub rows: Vec<Row>,
}

/// One scene at one size. The names up to `other_cores` are `peerbench`'s; times are in
/// milliseconds.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    /// The scene's name.
    pub scene: &'static str,
    /// Width in pixels.
    pub w: u32,
    /// Height in pixels.
    pub h: u32,
    /// Triangles submitted.
    pub triangles: u64,
    /// FNV-1a of the data, 16 hexadecimal digits.
    pub fingerprint: String,
    /// Wall time of a frame, median.
    pub median_ms: f64,
    /// Wall time of a frame, least.
    pub min_ms: f64,
    /// Recording the draws, median.
    pub encode_ms: f64,
    /// CPU time of the process, median.
    pub cpu_ms: f64,
    /// CPU time of the process, least.
    pub cpu_min_ms: f64,
    /// CPU time of the busiest thread.
    pub busiest_thread_ms: f64,
    /// Frames measured.
    pub frames: usize,
    /// Creation of pipelines, buffers and targets.
    pub setup_ms: f64,
    /// The first frame.
    pub first_ms: f64,
    /// Work of other processes, in cores.
    pub other_cores: f64,
    /// Conversion of the colour tiles to rows; not part of the frame.
    pub readback_ms: f64,
    /// A copy of as many bytes on one thread.
    pub copy_ms: f64,
    /// The geometry stages, median.
    pub geometry_ms: f64,
    /// The tiles, median.
    pub raster_ms: f64,
    /// Fragments shaded.
    pub fragments: u64,
    /// Runs of opaque triangles in tiles that were drawn by the visibility path.
    pub visibility_runs: u64,
    /// The share of pixels, 0..=1, that differ from the other renderer's by more than the
    /// tolerance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub beyond: Option<f64>,
}

impl Row {
    /// A scene's row.
    #[must_use]
    pub fn new(scene: &Scene, size: FrameSize, setup_ms: f64, timing: Timing) -> Self {
        Self {
            scene: scene.name,
            w: size.width,
            h: size.height,
            triangles: scene.triangles(),
            fingerprint: format!("{:016x}", scene.fingerprint()),
            median_ms: rounded(timing.median_ms),
            min_ms: rounded(timing.min_ms),
            encode_ms: rounded(timing.encode_ms),
            cpu_ms: rounded(timing.cpu_ms),
            cpu_min_ms: rounded(timing.cpu_min_ms),
            busiest_thread_ms: rounded(timing.busiest_thread_ms),
            frames: timing.frames,
            setup_ms: rounded(setup_ms),
            first_ms: rounded(timing.first_ms),
            other_cores: rounded(timing.other_cores),
            readback_ms: rounded(timing.readback_ms),
            copy_ms: rounded(timing.copy_ms),
            geometry_ms: rounded(timing.geometry_ms),
            raster_ms: rounded(timing.raster_ms),
            fragments: timing.statistics.fragments_shaded,
            visibility_runs: timing.statistics.visibility_runs,
            beyond: None,
        }
    }

    /// The row as a line of the table.
    #[must_use]
    pub fn line(&self) -> String {
        let size = format!("{}x{}", self.w, self.h);
        let mut line = format!("{:<15}{size:>10}", self.scene);
        for value in [
            self.median_ms,
            self.min_ms,
            self.encode_ms,
            self.cpu_ms,
            self.cpu_min_ms,
            self.busiest_thread_ms,
            self.geometry_ms,
            self.raster_ms,
            self.readback_ms,
            self.copy_ms,
            self.first_ms,
        ] {
            let _ = write!(line, "{value:>9.3}");
        }
        let _ = write!(line, "{:>7}{:>7.2}", self.frames, self.other_cores);
        let _ = write!(line, "  {}", self.fingerprint);
        line
    }
}

/// The header of the table.
#[must_use]
pub fn header() -> String {
    let mut line = format!("{:<15}{:>10}", "scene", "size");
    for name in [
        "median", "min", "encode", "cpu", "cpu min", "thread", "geometry", "raster", "readback",
        "copy", "first",
    ] {
        let _ = write!(line, "{name:>9}");
    }
    let _ = write!(line, "{:>7}{:>7}  {:<16}", "frames", "other", "fingerprint");
    line
}

/// One line about the difference of a picture from another renderer's.
#[must_use]
pub fn comparison(name: &str, difference: &Difference) -> String {
    let verdict = if difference.passes() {
        "same"
    } else {
        "DIFFERENT"
    };
    let share = |count: u64| count as f64 * 100.0 / difference.pixels.max(1) as f64;
    format!(
        "{name:<24} differ {:8.4} %  beyond {}: {:6} = {:7.4} %  max {:3}  mean {:7.4}  {verdict}",
        share(difference.differing),
        Difference::TOLERANCE,
        difference.beyond,
        share(difference.beyond),
        difference.max,
        difference.mean,
    )
}

impl Report {
    /// A report without rows.
    #[must_use]
    pub fn new(label: String, device: &Device) -> Self {
        let driver = format!(
            "estampe {} ({}, {} threads)",
            env!("CARGO_PKG_VERSION"),
            device.level().name(),
            device.threads()
        );
        Self {
            label,
            driver,
            rows: Vec::new(),
        }
    }

    /// The report as JSON, one row a line.
    #[must_use]
    pub fn to_json(&self) -> String {
        let rows: Vec<String> = self.rows.iter().map(json).collect();
        format!(
            "{{\"label\":{},\"adapter\":\"estampe\",\"driver\":{},\"results\":[\n{}\n]}}\n",
            json(&self.label),
            json(&self.driver),
            rows.join(",\n")
        )
    }
}

fn json<T: Serialize>(value: &T) -> String {
    serde_json::to_string(value).expect("strings and numbers always serialize")
}

/// A number rounded to four decimals: a tenth of a microsecond, in milliseconds.
fn rounded(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_json_is_valid_and_has_one_row_a_line() {
        let scene = crate::scene::SceneEntry::named("fill").unwrap();
        let size = FrameSize {
            width: 64,
            height: 48,
        };
        let scene = scene.make(crate::scene::Detail::Full, size);
        let timing = Timing {
            median_ms: 1.234_56,
            min_ms: 1.0,
            encode_ms: 0.5,
            cpu_ms: 2.0,
            cpu_min_ms: 1.9,
            busiest_thread_ms: 1.1,
            geometry_ms: 0.2,
            raster_ms: 0.8,
            frames: 15,
            first_ms: 4.0,
            other_cores: 0.01,
            readback_ms: 0.3,
            copy_ms: 0.2,
            statistics: estampe::Statistics::default(),
        };
        let report = Report {
            label: "a \"label\"".to_owned(),
            driver: "d".to_owned(),
            rows: vec![Row::new(&scene, size, 0.1, timing); 2],
        };
        let text = report.to_json();
        let value: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(value["label"], report.label);
        let row = &value["results"][1];
        assert_eq!(row["scene"], "fill");
        assert_eq!(row["fingerprint"], "0252fe2463db7e25");
        assert_eq!(row["median_ms"], 1.2346);
        assert_eq!(row["triangles"], 64);
        assert!(row.get("beyond").is_none());
        let lines = text.lines().filter(|line| line.starts_with("{\"scene\""));
        assert_eq!(lines.count(), 2);
        assert_eq!(report.rows[0].line().len(), header().len());
    }
}
