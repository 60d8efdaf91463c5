//! Results of a run of estampe or of `peerbench`, which have the same JSON form.

use crate::BenchError;
use crate::frame::FrameSize;
use serde::Deserialize;
use std::path::Path;

/// Rounds whose disturbance by other processes, in cores, exceeds the least one by at most this
/// count as equally disturbed.
const SAME_DISTURBANCE: f64 = 0.05;

/// A run of some scenes.
#[derive(Debug, Clone, Deserialize)]
pub struct RunResults {
    /// The renderer: driver, SIMD level, threads.
    pub driver: String,
    /// The results, scene by scene.
    pub results: Vec<Measured>,
}

/// The measurement of a scene at a size.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Measured {
    /// The scene's name.
    pub scene: String,
    /// Width in pixels.
    pub w: u32,
    /// Height in pixels.
    pub h: u32,
    /// FNV-1a of the data.
    pub fingerprint: String,
    /// Wall time of a frame, median, in milliseconds.
    pub median_ms: f64,
    /// CPU time of a frame, all threads, median, in milliseconds.
    pub cpu_ms: f64,
    /// Work of other processes, in cores.
    pub other_cores: f64,
    /// Conversion of tiles to rows, in milliseconds; `peerbench` stores rows anyway.
    #[serde(default)]
    pub readback_ms: f64,
    /// Copying as many bytes by one thread, in milliseconds.
    #[serde(default)]
    pub copy_ms: f64,
    /// Shaded fragments; 0 if the renderer does not count them.
    #[serde(default)]
    pub fragments: u64,
    /// Runs of opaque triangles in tiles that were drawn by the visibility path, which shades no
    /// hidden fragments.
    #[serde(default)]
    pub visibility_runs: u64,
}

impl RunResults {
    /// Reads a file.
    ///
    /// # Errors
    /// If it cannot be read or has another format.
    pub fn read(path: &Path) -> Result<Self, BenchError> {
        let text = std::fs::read_to_string(path).map_err(|source| BenchError::File {
            path: path.to_owned(),
            source,
        })?;
        serde_json::from_str(&text).map_err(|error| BenchError::Picture {
            path: path.to_owned(),
            reason: error.to_string(),
        })
    }
}

/// Selects one of several rounds: the fastest of the least disturbed ones.
#[must_use]
pub fn choose(runs: &[RunResults], scene: &str, size: FrameSize) -> Option<Measured> {
    let rounds: Vec<&Measured> = runs
        .iter()
        .flat_map(|run| &run.results)
        .filter(|row| row.scene == scene && (row.w, row.h) == (size.width, size.height))
        .collect();
    let disturbance = rounds.iter().map(|row| row.other_cores);
    let least = disturbance.fold(f64::INFINITY, f64::min);
    let quiet = rounds
        .into_iter()
        .filter(|row| row.other_cores <= least + SAME_DISTURBANCE);
    quiet
        .min_by(|a, b| a.median_ms.total_cmp(&b.median_ms))
        .cloned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(rows: &[(&str, f64, f64)]) -> RunResults {
        let rows = rows.iter().map(|(scene, median, other)| {
            format!(
                r#"{{"scene":"{scene}","w":64,"h":48,"triangles":2,"fingerprint":"0f","median_ms":{median},"min_ms":1,
                "cpu_ms":2.5,"other_cores":{other}}}"#
            )
        });
        let rows: Vec<String> = rows.collect();
        let text = format!(
            r#"{{"label":"l","adapter":"a","driver":"Mesa 1","results":[{}]}}"#,
            rows.join(",")
        );
        serde_json::from_str(&text).unwrap()
    }

    #[test]
    fn the_least_disturbed_round_counts_and_among_equals_the_fastest() {
        let size = FrameSize {
            width: 64,
            height: 48,
        };
        let runs = [
            run(&[("fill", 9.0, 0.01), ("blend", 5.0, 0.9)]),
            run(&[("fill", 8.0, 0.04), ("blend", 6.0, 0.2)]),
            run(&[("fill", 1.0, 0.5)]),
        ];
        assert_eq!(choose(&runs, "fill", size).unwrap().median_ms, 8.0);
        assert_eq!(choose(&runs, "blend", size).unwrap().median_ms, 6.0);
        assert_eq!(choose(&runs, "clear", size), None);
        let other = FrameSize { width: 65, ..size };
        assert_eq!(choose(&runs, "fill", other), None);
        assert_eq!(runs[0].driver, "Mesa 1");
    }
}
