//! The observer that counts what happens at the pixels of a band of rows.

use super::hidden_blocks::{HiddenBlocks, Rejection};
use super::pass_stages::PixelCounts;
use crate::inspect::TestOutcome;
use estampe_reference::cull::Face;
use estampe_reference::observer::{FragmentEvent, Observer, SampleEvent};
use estampe_reference::{PixelBounds, Target, WindowVertex};

/// The pixels of a band, and the pieces that were drawn to them.
pub(super) struct Band<'a> {
    bounds: PixelBounds,
    counts: &'a mut [PixelCounts],
    /// Of each pixel the last piece that covered it, as its number from 1.
    last_covered: Vec<u32>,
    pub(super) blocks: HiddenBlocks,
    /// The number of pieces until now.
    pieces: u32,
}

impl<'a> Band<'a> {
    /// The pixels that a target stores, which are whole rows, with their counts.
    pub(super) fn new(target: &Target, counts: &'a mut [PixelCounts]) -> Self {
        Self {
            bounds: target.stored().clone(),
            last_covered: vec![0; counts.len()],
            counts,
            blocks: HiddenBlocks::new(target),
            pieces: 0,
        }
    }
}

/// Counts what one draw does to a band.
pub(super) struct BandRecorder<'a, 'b> {
    band: &'a mut Band<'b>,
    /// How its triangles are rejected in blocks, if they are.
    rejection: Option<Rejection>,
    /// True if the draw has a depth test.
    tests_depth: bool,
    /// True if it writes a channel of a colour attachment.
    writes_color: bool,
    /// True if the piece at hand is a triangle.
    is_triangle: bool,
    pixel: [u32; 2],
}

impl<'a, 'b> BandRecorder<'a, 'b> {
    pub(super) fn new(
        band: &'a mut Band<'b>,
        rejection: Option<Rejection>,
        (tests_depth, writes_color): (bool, bool),
    ) -> Self {
        Self {
            band,
            rejection,
            tests_depth,
            writes_color,
            is_triangle: false,
            pixel: [0; 2],
        }
    }

    /// The position of the pixel at hand in the band.
    fn at(&self) -> usize {
        let bounds = &self.band.bounds;
        let [x, y] = self.pixel;
        (y - bounds.y.start) as usize * bounds.x.len() + x as usize
    }
}

impl Observer for BandRecorder<'_, '_> {
    fn piece(&mut self, vertices: &[WindowVertex], _face: Face) {
        // More pieces than 32 bits count do not fit the memory for them.
        self.band.pieces = self.band.pieces.wrapping_add(1);
        self.is_triangle = vertices.len() == 3;
    }

    fn culled(&mut self, vertices: &[WindowVertex], face: Face) {
        self.piece(vertices, face);
    }

    fn fragment(&mut self, event: &FragmentEvent<'_>) {
        self.pixel = event.pixel;
        let at = self.at();
        let band = &mut *self.band;
        let counts = &mut band.counts[at];
        counts.shaded += 1;
        counts.discarded += u32::from(event.fragment.is_discarded);
        if band.last_covered[at] == band.pieces {
            return;
        }
        band.last_covered[at] = band.pieces;
        counts.covered += 1;
        if self.is_triangle && self.tests_depth {
            band.blocks.test(
                (band.pieces, event.pixel),
                self.rejection,
                event.surface,
                event.clamp_depth,
            );
        }
    }

    fn wants(&self, _pixel: [u32; 2]) -> bool {
        true
    }

    fn sample(&mut self, event: SampleEvent) {
        let at = self.at();
        let band = &mut *self.band;
        let counts = &mut band.counts[at];
        match event.outcome {
            TestOutcome::DepthBounds => counts.failed_depth_bounds += 1,
            TestOutcome::Stencil => counts.failed_stencil += 1,
            TestOutcome::Depth => counts.failed_depth += 1,
            TestOutcome::Passed => {
                counts.passed += 1;
                let piece = Some(band.pieces.wrapping_sub(1));
                counts.stored += u32::from(self.writes_color && counts.visible != piece);
                counts.visible = piece;
            }
        }
        if let Some(depth) = event.after.depth {
            band.blocks.store(self.pixel, event.sample, depth);
        }
    }
}
