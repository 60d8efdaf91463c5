//! Lines: from assembled vertices to line primitives, clipped where they leave the view volume.

use super::binning::push_line;
use super::clip_detour::ClipDetour;
use super::run::RunWork;
use super::setup::Setup;
use crate::bounds::primitives::{LinePrimitive, VertexRef, WindowVertex};

/// The values of a line or point besides its vertices: its own, or those of the triangle that it
/// outlines.
#[derive(Debug, Clone, Copy)]
pub(super) struct Outline {
    /// The vertex that flat varyings come from.
    pub(super) provoking: VertexRef,
    pub(super) front: bool,
    /// The value added to its depth.
    pub(super) bias: Option<f32>,
}

impl Outline {
    /// The values of a line or point that is no part of a triangle.
    pub(super) fn own(provoking: u32) -> Self {
        Self {
            provoking: VertexRef(provoking),
            front: true,
            bias: None,
        }
    }

    /// A vertex with the depth that it has in this outline.
    pub(super) fn biased(&self, vertex: WindowVertex) -> WindowVertex {
        match self.bias {
            Some(bias) => WindowVertex {
                z: vertex.z + bias,
                ..vertex
            },
            None => vertex,
        }
    }
}

/// Draws the lines of a run in order: a stipple pattern goes on from line to line of a strip.
#[derive(Debug, Default)]
pub(super) struct LineWalk {
    /// Fragments of the pattern that the strip's lines so far have taken.
    stipple: u32,
}

impl LineWalk {
    /// Draws lines of an instance, the first of which has this number there.
    pub(super) fn draw(
        &mut self,
        work: &RunWork<'_>,
        first: u32,
        lines: &[[u32; 3]],
        setup: &mut Setup<'_>,
        clip: &mut ClipDetour,
    ) {
        for (number, &[a, b, provoking]) in (first..).zip(lines) {
            if begins_strip(work, number) {
                self.restart();
            }
            if !clip.is_culled_by_distance(work, &[a, b]) {
                self.draw_line(work, [a, b], Outline::own(provoking), setup, clip);
            }
        }
    }

    /// Begins the stipple pattern anew.
    pub(super) fn restart(&mut self) {
        self.stipple = 0;
    }

    /// Draws one line.
    pub(super) fn draw_line(
        &mut self,
        work: &RunWork<'_>,
        corners: [u32; 2],
        outline: Outline,
        setup: &mut Setup<'_>,
        clip: &mut ClipDetour,
    ) {
        let ends = corners.map(|corner| work.vertices.window_vertex(corner));
        let ends = if let [Some(a), Some(b)] = ends {
            [a, b]
        } else {
            setup.chunk.statistics.primitives_clipped += 1;
            if !clip.clip(work, &corners, setup) {
                return;
            }
            let Some(ends) = clip.line() else {
                return;
            };
            ends
        };
        let line = LinePrimitive {
            ends: ends.map(|end| outline.biased(end)),
            provoking: outline.provoking,
            front: outline.front,
            stipple: self.stipple,
        };
        let style = &work.plan.line_style;
        if style.stipple.is_some() {
            self.stipple = style.phase_after(&line);
        }
        push_line(work.plan, line, setup.chunk);
    }
}

/// Returns true if the line of this number in an instance begins a stipple pattern.
fn begins_strip(work: &RunWork<'_>, number: u32) -> bool {
    !work.is_line_strip || number == 0 || work.line_restarts.binary_search(&number).is_ok()
}
