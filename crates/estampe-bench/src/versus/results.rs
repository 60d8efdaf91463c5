//! Results of a run of estampe or of `peerbench`, which have the same JSON form.

use crate::BenchError;
use crate::frame::FrameSize;
use serde::Deserialize;
use std::path::Path;

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
    /// Wall time of the fastest frame, in milliseconds.
    pub min_ms: f64,
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

/// The fastest of several rounds. Rounds of both renderers are in turn, and other work only ever
/// makes a frame slower, so the fastest frames are those that compare.
#[must_use]
pub fn fastest(runs: &[RunResults], scene: &str, size: FrameSize) -> Option<Measured> {
    runs.iter()
        .flat_map(|run| &run.results)
        .filter(|row| row.scene == scene && (row.w, row.h) == (size.width, size.height))
        .min_by(|a, b| a.min_ms.total_cmp(&b.min_ms))
        .cloned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(rows: &[(&str, f64)]) -> RunResults {
        let rows = rows.iter().map(|(scene, least)| {
            format!(
                r#"{{"scene":"{scene}","w":64,"h":48,"triangles":2,"fingerprint":"0f","median_ms":20,
                "min_ms":{least},"cpu_ms":2.5,"other_cores":0.1}}"#
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
    fn the_fastest_round_counts() {
        let size = FrameSize {
            width: 64,
            height: 48,
        };
        let runs = [
            run(&[("fill", 9.0), ("blend", 5.0)]),
            run(&[("fill", 8.0), ("blend", 6.0)]),
            run(&[("fill", 10.0)]),
        ];
        assert_eq!(fastest(&runs, "fill", size).unwrap().min_ms, 8.0);
        assert_eq!(fastest(&runs, "blend", size).unwrap().min_ms, 5.0);
        assert_eq!(fastest(&runs, "clear", size), None);
        let other = FrameSize { width: 65, ..size };
        assert_eq!(fastest(&runs, "fill", other), None);
        assert_eq!(runs[0].driver, "Mesa 1");
    }
}
