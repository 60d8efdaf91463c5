//! Sampling of a depth image with comparison, as for shadow maps.
//!
//! In · Out: (u, v) and a reference depth · the filtered result of four comparisons, 0..=1.
//! Precision: f32 in the order of NUMERICS.md, *Textures*.

use crate::arithmetic::{clamp, max, min};

/// A depth image, row by row from the top.
#[derive(Debug, Clone)]
pub struct DepthMap {
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// Width × height depths, from the top row on. Missing elements read as 0.
    pub rows: Vec<f32>,
}

impl DepthMap {
    /// The bilinear mixture of `reference <= depth` over the four texels around (u, v); coordinates
    /// are clamped to the edge.
    #[must_use]
    pub fn sample_compare_level(&self, [u, v]: [f32; 2], reference: f32) -> f32 {
        let (columns, fx) = axis(u, self.width);
        let (rows, fy) = axis(v, self.height);
        let passes = |x: usize, y: usize| {
            let depth = self.rows.get(y * self.width as usize + x);
            let depth = depth.copied().unwrap_or(0.0);
            f32::from(u8::from(reference <= depth))
        };
        let [top, bottom] = rows.map(|y| {
            let (left, right) = (passes(columns[0], y), passes(columns[1], y));
            left + (right - left) * fx
        });
        top + (bottom - top) * fy
    }
}

/// The two texels of one axis, and the weight of the second.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the image's texel coordinates"
)]
fn axis(coordinate: f32, size: u32) -> ([usize; 2], f32) {
    let last = max(size as f32 - 1.0, 0.0);
    let q = clamp(coordinate * size as f32 - 0.5, 0.0, last);
    let first = q.floor();
    ([first as usize, min(first + 1.0, last) as usize], q - first)
}
