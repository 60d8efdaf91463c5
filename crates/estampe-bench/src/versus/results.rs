//! What a run wrote, ours or the peer's: the same JSON.

use crate::BenchError;
use crate::frame::FrameSize;
use serde::Deserialize;
use std::path::Path;

/// Rounds that other processes disturbed this little more than the least disturbed one, in cores' worth of
/// work, count as equals.
const SAME_DISTURBANCE: f64 = 0.05;

/// A run of some scenes.
#[derive(Debug, Clone, Deserialize)]
pub struct RunResults {
    /// Who drew.
    pub driver: String,
    /// Scene by scene.
    pub results: Vec<Measured>,
}

/// A scene at a size.
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
    /// Cores' worth of work that other processes did meanwhile.
    pub other_cores: f64,
    /// De-tiling to rows, in milliseconds; the peer stores rows anyway.
    #[serde(default)]
    pub readback_ms: f64,
    /// Copying as many bytes by one thread, in milliseconds.
    #[serde(default)]
    pub copy_ms: f64,
    /// Fragments shaded; 0 where the renderer does not count.
    #[serde(default)]
    pub fragments: u64,
    /// Runs of opaque triangles that were shaded after all of them had been seen, so that what later ones hide
    /// was not.
    #[serde(default)]
    pub visibility_runs: u64,
}

impl RunResults {
    /// Reads a file.
    ///
    /// # Errors
    /// When it cannot be read or is something else.
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

/// Of several rounds the one that counts: among the least disturbed the fastest.
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
