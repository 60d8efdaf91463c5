//! The tile paths that the cases of a topic must have drawn on.
//!
//! The core chooses among several paths for the triangles of a tile. Equal images do not show which
//! path drew: a topic about one path would still pass if the core never chose that path. So a topic
//! names its paths, and fails if none of its cases reached one of them.

use crate::fast_path;
use estampe::{Level, Statistics, TilePath};

/// Returns true if a path exists at a SIMD level: the scalar level has only the in-order path.
fn exists_at(path: TilePath, level: Level) -> bool {
    !level.is_scalar() || path == TilePath::InOrderPackets
}

/// The paths of a topic: at least one case must take each of them on at least one device.
#[derive(Debug, Clone, Copy, Default)]
pub struct ExpectedPaths(pub &'static [TilePath]);

impl ExpectedPaths {
    /// Every path.
    pub const ALL: Self = Self(&TilePath::ALL);

    /// Checks the sum of the statistics of all cases of a topic.
    ///
    /// # Panics
    /// If a path was never taken, though one of the devices has it.
    pub fn assert_reached(self, topic: &str, statistics: &Statistics) {
        for path in self.0 {
            let devices = fast_path::all_devices();
            let exists = devices
                .iter()
                .any(|device| exists_at(*path, device.level()));
            assert!(
                !exists || statistics.paths.of(*path) > 0,
                "{topic}: no case was drawn on the path '{}'",
                path.name()
            );
        }
    }
}
