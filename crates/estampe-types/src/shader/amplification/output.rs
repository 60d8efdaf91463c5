//! The outputs of the last stage before primitives, and their order in a record.

use super::super::vertex::VertexOut;
use super::super::{Interpolation, Sampling};
use super::record_sink::RecordSink;
use crate::shader::Sink;
use crate::{Real, Varyings};

/// The outputs of the vertices that a tessellation or geometry shader makes.
///
/// The record of a vertex holds x, y, z, w in clip space, the scalars of the varyings, the clip
/// distances, the cull distances, and the point size if it is written.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct OutputInterface {
    /// Interpolation of each scalar of the varyings.
    pub varyings: Vec<Interpolation>,
    /// Sampling position of each scalar of the varyings.
    pub sampling: Vec<Sampling>,
    /// True if vertices write a point size.
    pub writes_point_size: bool,
    /// Number of clip distances, at most 8.
    pub clip_distances: usize,
    /// Number of cull distances, at most 8.
    pub cull_distances: usize,
}

impl OutputInterface {
    /// Words of a vertex's record.
    #[must_use]
    pub fn record_words(&self) -> usize {
        4 + self.varyings.len()
            + self.clip_distances
            + self.cull_distances
            + usize::from(self.writes_point_size)
    }

    /// Writes a vertex's record.
    #[inline(always)]
    pub(super) fn store<R: Real, V: Varyings<R>>(
        &self,
        out: VertexOut<R, V>,
        zero: R,
        to: &mut RecordSink<'_>,
    ) {
        out.position.store(to);
        out.varyings.store(to);
        let clip = out.clip_distances.iter().take(self.clip_distances);
        let cull = out.cull_distances.iter().take(self.cull_distances);
        for distance in clip.chain(cull) {
            to.put(distance.unwrap_or(zero));
        }
        if self.writes_point_size {
            to.put(out.point_size.unwrap_or(zero.splat(1.0)));
        }
    }
}

impl OutputInterface {
    /// Asserts, if it is asked to, that the interface has the outputs of a vertex.
    #[inline(always)]
    pub(super) fn assert_has<R, V>(&self, asserts: bool, out: &VertexOut<R, V>) {
        if !asserts {
            return;
        }
        let found = OutputsFound::of(out);
        assert!(
            (self.writes_point_size || !found.point_size)
                && found.clip_distances <= self.clip_distances
                && found.cull_distances <= self.cull_distances,
            "the shader sets a point size, a clip distance or a cull distance, which it did not do \
             with nothing bound; set its WRITES_POINT_SIZE, CLIP_DISTANCES or CULL_DISTANCES"
        );
    }
}

/// The outputs of a vertex that are set.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct OutputsFound {
    pub(crate) point_size: bool,
    pub(crate) clip_distances: usize,
    pub(crate) cull_distances: usize,
}

impl OutputsFound {
    #[inline(always)]
    pub(crate) fn of<R, V>(out: &VertexOut<R, V>) -> Self {
        Self {
            point_size: out.point_size.is_some(),
            clip_distances: set(&out.clip_distances),
            cull_distances: set(&out.cull_distances),
        }
    }

    /// Adds these to an interface.
    pub(crate) fn widen(self, interface: &mut OutputInterface) {
        interface.writes_point_size |= self.point_size;
        interface.clip_distances = interface.clip_distances.max(self.clip_distances);
        interface.cull_distances = interface.cull_distances.max(self.cull_distances);
    }
}

/// The number of elements up to the last one that is set.
#[inline(always)]
fn set<R>(distances: &[Option<R>]) -> usize {
    let last = distances.iter().rposition(Option::is_some);
    last.map_or(0, |last| last + 1)
}
