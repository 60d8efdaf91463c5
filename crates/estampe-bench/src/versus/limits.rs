//! Lower bounds of frame times on this machine, from rates that `limits` of `peerbench` measures.

use crate::BenchError;
use crate::frame::FrameSize;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Measured rates by name; empty if none were measured.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Limits {
    rates: BTreeMap<String, f64>,
}

/// A line of the file.
#[derive(Debug, Deserialize)]
struct Rate {
    name: String,
    value: f64,
}

/// The number of layers of fill and blend.
const LAYERS: f64 = 32.0;

impl Limits {
    /// Reads the file that `limits --out` writes.
    ///
    /// # Errors
    /// If it cannot be read or has another format.
    pub fn read(path: &Path) -> Result<Self, BenchError> {
        let text = std::fs::read_to_string(path).map_err(|source| BenchError::File {
            path: path.to_owned(),
            source,
        })?;
        Self::from_json(&text).map_err(|reason| BenchError::Picture {
            path: path.to_owned(),
            reason,
        })
    }

    fn from_json(text: &str) -> Result<Self, String> {
        let rates: Vec<Rate> = serde_json::from_str(text).map_err(|error| error.to_string())?;
        let rates = rates.into_iter().map(|rate| (rate.name, rate.value));
        Ok(Self {
            rates: rates.collect(),
        })
    }

    /// The least time in milliseconds of a frame of a scene, if it has a single bound.
    ///
    /// | scene | bound |
    /// |---|---|
    /// | clear | colour and depth, 8 bytes a pixel, at memset's rate for a frame |
    /// | fill | 32 times 8 bytes a pixel, at memset's rate for a tile in the first cache |
    /// | blend | 32 times 4 bytes a pixel, loaded, added to and stored in the first cache |
    /// | textured | 8 texels a fragment, gathered from the first cache |
    /// | mid_tris, msaa4 | 16 texels a fragment, gathered from the first cache |
    #[must_use]
    pub fn of_scene(
        &self,
        scene: &str,
        size: FrameSize,
        cores: usize,
        fragments: u64,
    ) -> Option<f64> {
        let pixels = f64::from(size.width) * f64::from(size.height);
        let threads = format!(", {cores} thread(s)");
        // 1 GB/s, or 10⁹ texels per second, is 10⁶ per millisecond.
        let fill = |what: &str| Some(self.rates.get(&format!("fill {what}{threads}"))? * 1e6);
        let gathered = |texels: f64| {
            let of_one = self.rates.get("gather AVX2, 16 KiB (L1), 1 thread")?;
            Some(fragments as f64 * texels / (of_one * cores as f64 * 1e6))
        };
        match scene {
            "clear" => Some(pixels * 8.0 / fill("1920x1080x4 frame, write_bytes (memset)")?),
            "fill" => {
                let rate = fill("32 KiB tile (L1), write_bytes (memset)")?;
                Some(LAYERS * pixels * 8.0 / rate)
            }
            "blend" => {
                let rate = fill("32 KiB tile (L1), AVX-512 load+add+store")
                    .or_else(|| fill("32 KiB tile (L1), AVX2 load+add+store"))?;
                Some(LAYERS * pixels * 4.0 / rate)
            }
            "textured" => gathered(8.0),
            "mid_tris" | "msaa4" => gathered(16.0),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: FrameSize = FrameSize {
        width: 1000,
        height: 1000,
    };

    #[test]
    fn limits_are_bytes_or_texels_over_rates() {
        let limits = Limits::from_json(
            r#"[{"name":"fill 1920x1080x4 frame, write_bytes (memset), 2 thread(s)","value":80,"unit":"GB/s"},
            {"name":"fill 32 KiB tile (L1), AVX2 load+add+store, 2 thread(s)","value":128,"unit":"GB/s"},
            {"name":"gather AVX2, 16 KiB (L1), 1 thread","value":4,"unit":"Gtexel/s"}]"#,
        )
        .unwrap();
        let of = |scene| limits.of_scene(scene, SIZE, 2, 500_000);
        assert_eq!(of("clear"), Some(0.1));
        assert_eq!(of("blend"), Some(1.0));
        assert_eq!(of("textured"), Some(0.5));
        assert_eq!(of("mid_tris"), Some(1.0));
        // One rate is not measured, and one scene has no single bound.
        assert_eq!(of("fill"), None);
        assert_eq!(of("heavy_fs"), None);
        assert!(Limits::from_json("{}").is_err());
    }
}
