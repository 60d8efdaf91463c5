//! The choice of path: the one place that decides how a draw's primitives become samples of a tile.
//!
//! ```text
//!   visibility   which triangle each sample shows, for all opaque draws in a row; then each
//!                visible sample is shaded once. For pipelines whose colours replace, and whose
//!                shaders neither discard nor write depth.
//!   in order     primitive by primitive, in the order of submission. Everything else.
//! ```
//!
//! Opaque lines are drawn in order, but may join a run of visibility: where they pass, its
//! triangles are not shaded. Either path serves every format, test and target. The variants tell
//! how fragments fill packets.

use crate::pipeline::{RenderPipeline, StageKey};
use estampe_simd::Level;

/// The code path by which the primitives of a draw are drawn into tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum TilePath {
    /// Visibility without colours: depth and stencil alone.
    VisibilityDepthOnly,
    /// Visibility; a triangle has one colour, which is shaded once for each tile.
    VisibilityPerPrimitive,
    /// Visibility; a packet holds one fragment of each of sixteen small triangles, because the
    /// shader takes no derivatives.
    VisibilityCrossTriangle,
    /// Visibility; packets hold 4×4 pixels of one triangle, or four quads of several.
    VisibilityQuads,
    /// In order; blocks of 16×16 pixels that a triangle covers whole are blended from its planes.
    InOrderBlocks,
    /// In order; packets hold 4×4 pixels of one primitive, or four quads of several, or, if the
    /// shader takes no derivatives, sixteen pixels of several triangles.
    InOrderQuads,
    /// In order; packets hold 4×4 pixels of one primitive: smooth lines, shading by sample, inputs
    /// that depend on coverage.
    InOrderPackets,
}

impl TilePath {
    /// Every path.
    pub const ALL: [Self; 7] = [
        Self::VisibilityDepthOnly,
        Self::VisibilityPerPrimitive,
        Self::VisibilityCrossTriangle,
        Self::VisibilityQuads,
        Self::InOrderBlocks,
        Self::InOrderQuads,
        Self::InOrderPackets,
    ];

    /// The path of a draw.
    pub(crate) fn choose(pipeline: &RenderPipeline, draw: &PathFacts) -> Self {
        let key = pipeline.key();
        let samples = draw.samples;
        // Sixteen scalar lanes of the visibility kernels took the compiler many minutes; the scalar
        // level draws in order, which gives the same bits. Viewports that cut pixels are too rare
        // for code of their own.
        let is_common = !draw.level.is_scalar() && !draw.cuts_samples;
        if is_common && key.is_opaque {
            return Self::choose_visibility(key, samples);
        }
        if is_common && key.blends_blocks && samples == 1 && draw.tests_depth_alone {
            return Self::InOrderBlocks;
        }
        if key.shares_packets && !draw.level.is_scalar() {
            Self::InOrderQuads
        } else {
            Self::InOrderPackets
        }
    }

    fn choose_visibility(key: &StageKey, samples: usize) -> Self {
        if !key.has_colors {
            Self::VisibilityDepthOnly
        } else if key.uniform_over_primitive {
            Self::VisibilityPerPrimitive
        } else if key.fragments_are_independent && samples == 1 {
            Self::VisibilityCrossTriangle
        } else {
            Self::VisibilityQuads
        }
    }

    /// Returns true if the path is a visibility path.
    #[must_use]
    pub fn is_visibility(self) -> bool {
        matches!(
            self,
            Self::VisibilityDepthOnly
                | Self::VisibilityPerPrimitive
                | Self::VisibilityCrossTriangle
                | Self::VisibilityQuads
        )
    }

    /// Returns true if triangles of draws that differ in bindings and vertices alone may be
    /// rasterized together: they are shaded afterwards, draw by draw.
    pub(crate) fn joins_draws(self) -> bool {
        self.is_visibility() && self != Self::VisibilityCrossTriangle
    }

    /// The path's name, in words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::VisibilityDepthOnly => "visibility, depth only",
            Self::VisibilityPerPrimitive => "visibility, per primitive",
            Self::VisibilityCrossTriangle => "visibility, across triangles",
            Self::VisibilityQuads => "visibility, quads",
            Self::InOrderBlocks => "in order, blocks",
            Self::InOrderQuads => "in order, quads",
            Self::InOrderPackets => "in order, packets",
        }
    }
}

/// The facts besides a pipeline's that decide on a path.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PathFacts {
    /// Samples of a pixel.
    pub(crate) samples: usize,
    pub(crate) level: Level,
    /// True if there is no stencil test, no depth-bounds test and no occlusion query.
    pub(crate) tests_depth_alone: bool,
    /// True if the viewport contains some samples of a pixel and not others.
    pub(crate) cuts_samples: bool,
}

/// The number of primitives that took each path, counted once for each tile that they touch.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct PathCounts([u64; TilePath::ALL.len()]);

impl PathCounts {
    /// The count of a path.
    #[must_use]
    pub fn of(&self, path: TilePath) -> u64 {
        self.0[path as usize]
    }

    /// Adds primitives to a path.
    pub(crate) fn add(&mut self, path: TilePath, primitives: u64) {
        self.0[path as usize] += primitives;
    }
}

impl std::ops::AddAssign for PathCounts {
    fn add_assign(&mut self, other: Self) {
        for (count, other) in self.0.iter_mut().zip(other.0) {
            *count += other;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_path_has_a_count_of_its_own() {
        let mut counts = PathCounts::default();
        for (number, path) in (1..).zip(TilePath::ALL) {
            counts.add(path, number);
        }
        counts += counts;
        for (number, path) in (1..).zip(TilePath::ALL) {
            assert_eq!(counts.of(path), 2 * number, "{}", path.name());
        }
    }
}
