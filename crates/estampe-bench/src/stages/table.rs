//! The table of loads.

use crate::measure::Timing;

/// The header of the table. Times are wall time, in nanoseconds per vertex, primitive or fragment.
pub const HEADER: &str = "load                           primitives    binned   fragments     ms  \
                          geometry   raster  geo/vertex  geo/prim  ras/prim  ras/fragment";

/// A load's line in the table.
#[must_use]
pub fn line(purpose: &str, timing: &Timing) -> String {
    let counts = timing.statistics;
    let each_ns = |ms: f64, count: u64| ms * 1e6 / count.max(1) as f64;
    format!(
        "{purpose:<30}{:>11}{:>10}{:>12}{:>7.2}{:>10.3}{:>9.3}{:>12.2}{:>10.2}{:>10.2}{:>14.3}",
        counts.primitives_in,
        counts.primitives_binned,
        counts.fragments_shaded,
        timing.median_ms,
        timing.geometry_ms,
        timing.raster_ms,
        each_ns(timing.geometry_ms, counts.vertices_shaded),
        each_ns(timing.geometry_ms, counts.primitives_in),
        each_ns(timing.raster_ms, counts.primitives_in),
        each_ns(timing.raster_ms, counts.fragments_shaded),
    )
}
