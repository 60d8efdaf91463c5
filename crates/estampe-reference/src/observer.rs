//! What the oracle tells about a draw while it draws.
//!
//! The events of one primitive follow each other: [`Observer::primitive`], then for each piece that
//! clipping leaves of it (and for each edge or corner, if triangles are drawn as those)
//! [`Observer::piece`] or [`Observer::culled`], and for each pixel of the piece
//! [`Observer::fragment`] and [`Observer::sample`].

use crate::cull::Face;
use crate::fragment::{Fragment, Invocation, Surface};
use crate::per_sample::Outcome;
use crate::{ClipVertex, StoredSample, WindowVertex};
use estampe_types::Bindings;

/// Is told what happens. `()` ignores it.
pub trait Observer {
    /// A primitive was assembled.
    fn primitive(&mut self, _assembled: &Assembled<'_>) {}
    /// A point, line or triangle of it reaches the rasterizer.
    fn piece(&mut self, _vertices: &[WindowVertex], _face: Face) {}
    /// A piece of a triangle was culled by its facing.
    fn culled(&mut self, _vertices: &[WindowVertex], _face: Face) {}
    /// A fragment was shaded.
    fn fragment(&mut self, _event: &FragmentEvent<'_>) {}
    /// Returns true if [`Observer::sample`] is to be called for a pixel.
    fn wants(&self, _pixel: [u32; 2]) -> bool {
        false
    }
    /// A sample of the last fragment was tested.
    fn sample(&mut self, _event: SampleEvent) {}
}

impl Observer for () {}

/// A primitive in clip space.
#[derive(Debug, Clone, Copy)]
pub struct Assembled<'a> {
    /// Its number in the draw, over all instances.
    pub number: u64,
    /// The index of its instance.
    pub instance: u32,
    /// The positions of its vertices in the draw's range; of a triangle the provoking one first.
    pub positions: &'a [u32],
    /// Its vertices.
    pub vertices: &'a [ClipVertex],
}

/// One run of the fragment shader on one pixel.
#[derive(Clone, Copy)]
pub struct FragmentEvent<'a> {
    /// The pixel.
    pub pixel: [u32; 2],
    /// Its place in the quad.
    pub lane: usize,
    /// The run on the quad.
    pub invocation: &'a Invocation,
    /// The samples for which the shader ran: covered, and kept by the sample mask.
    pub covered: u16,
    /// Those of them that are left after discarding, the shader's mask and alpha to coverage.
    pub stored: u16,
    /// The primitive's interpolants.
    pub surface: &'a dyn Surface,
    /// The resources of the draw.
    pub bindings: &'a Bindings,
    /// Clamps a depth to the viewport's range.
    pub clamp_depth: &'a dyn Fn(f32) -> f32,
    /// The shader's result.
    pub fragment: &'a Fragment,
}

impl std::fmt::Debug for FragmentEvent<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FragmentEvent")
            .field("pixel", &self.pixel)
            .field("invocation", self.invocation)
            .field("fragment", self.fragment)
            .finish_non_exhaustive()
    }
}

/// The tests of one sample, and what they stored.
#[derive(Debug, Clone, PartialEq)]
pub struct SampleEvent {
    /// The sample's number in its pixel.
    pub sample: u32,
    /// The depth that was tested, as the attachment stores it.
    pub depth: f32,
    /// The result of the tests.
    pub outcome: Outcome,
    /// The stored values before.
    pub before: StoredSample,
    /// The stored values after.
    pub after: StoredSample,
}
