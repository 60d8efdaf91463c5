//! Conservative rasterization: the pixels that a triangle touches (overestimate) or fills
//! (underestimate).
//!
//! In · Out: three snapped positions · quads whose covered pixels have all their samples set.
//! Precision: exact. Spec: NUMERICS.md, *Conservative rasterization*; after Hasselgren,
//! Akenine-Möller and Ohlsson (GPU Gems 2, chapter 42).
//!
//! ```text
//!   A pixel's closed square and a closed triangle are disjoint exactly if a line separates them,
//!   and then one that is parallel to a side of either: a side of the square (the bounding boxes
//!   are disjoint), or an edge of the triangle, outside of which even the innermost corner of the
//!   square lies.
//! ```

use crate::raster::{Edge, QuadCoverage, all_samples, cover_pixels, edges, extent};
use crate::viewport::PixelBounds;
use estampe_types::state::ConservativeMode;

/// The width of a pixel in 1/256 pixel.
const PIXEL: i64 = 256;

/// The quads with pixels that the triangle touches or fills, as the mode says. `Disabled` covers
/// nothing here.
#[must_use]
pub fn triangle(
    corners: [[i32; 2]; 3],
    mode: ConservativeMode,
    bounds: &PixelBounds,
    samples: u32,
) -> Vec<QuadCoverage> {
    let Some(edges) = edges(corners) else {
        return Vec::new();
    };
    let extent = extent(corners);
    // Widen the box by a pixel: a square that begins a pixel before the box may still touch it.
    let widened = extent.map(|[low, high]| [low - PIXEL, high]);
    cover_pixels(widened, bounds, |pixel| {
        let is_covered = match mode {
            ConservativeMode::Disabled => false,
            ConservativeMode::Overestimate => touches(extent, &edges, pixel),
            ConservativeMode::Underestimate => fills(&edges, pixel),
        };
        if is_covered { all_samples(samples) } else { 0 }
    })
}

/// The corners of a pixel's square, in 1/256 pixel.
fn square([i, j]: [i64; 2]) -> [[i64; 2]; 4] {
    let (x, y) = (i * PIXEL, j * PIXEL);
    [
        [x, y],
        [x + PIXEL, y],
        [x, y + PIXEL],
        [x + PIXEL, y + PIXEL],
    ]
}

/// Returns true if a triangle and a pixel's square have a point in common.
fn touches(extent: [[i64; 2]; 2], edges: &[Edge; 3], pixel: [i64; 2]) -> bool {
    let boxes_meet = (0..2).all(|axis| {
        let low = pixel[axis] * PIXEL;
        extent[axis][0] <= low + PIXEL && low <= extent[axis][1]
    });
    let corners = square(pixel);
    let reaches_inside = |edge: &Edge| corners.iter().any(|&corner| edge.function(corner) >= 0);
    boxes_meet && edges.iter().all(reaches_inside)
}

/// Returns true if a pixel's square lies inside a triangle.
fn fills(edges: &[Edge; 3], pixel: [i64; 2]) -> bool {
    let corners = square(pixel);
    let has_inside = |edge: &Edge| corners.iter().all(|&corner| edge.function(corner) >= 0);
    edges.iter().all(has_inside)
}
