//! Lines: from assembled vertices to line primitives, clipped where they leave the view volume.
//!
//! The tiles of lines are found sixteen at a time; what is stored of a line is one cache line.

use super::binning::{LineTiles, push_line, push_line_of};
use super::clip_detour::ClipDetour;
use super::cull::{TriangleGroup, WindowTriangles};
use super::run::RunWork;
use super::setup::Setup;
use super::shaded_vertices::NEEDS_CLIPPING;
use crate::bounds::primitives::{LinePrimitive, VertexRef, WindowVertex};
use estampe_simd::{LANES, Lane, Lanes, SimdBase, dispatch, i32x16};

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
    /// Draws so many lines of an instance, the first of which has this number there.
    pub(super) fn draw(
        &mut self,
        work: &RunWork<'_>,
        [first, count]: [u32; 2],
        group: &mut TriangleGroup,
        setup: &mut Setup<'_>,
        clip: &mut ClipDetour,
    ) {
        let culls = work.source.pipeline.interface().cull_distances != 0;
        if !culls && work.plan.line_style.stipple.is_none() {
            dispatch!(work.level, s => self.draw_lanes(s, work, (group, count), setup, clip));
            return;
        }
        let lines = group.vertices.iter().take(count as usize);
        for (number, &[a, b, provoking]) in (first..).zip(lines) {
            if begins_strip(work, number) {
                self.restart();
            }
            if !clip.is_culled_by_distance(work, &[a, b]) {
                self.draw_line(work, [a, b], Outline::own(provoking), setup, clip);
            }
        }
    }

    /// Draws lines without pattern and cull distances.
    #[inline(always)]
    fn draw_lanes<S: Lanes>(
        &mut self,
        s: S,
        work: &RunWork<'_>,
        (group, count): (&mut TriangleGroup, u32),
        setup: &mut Setup<'_>,
        clip: &mut ClipDetour,
    ) {
        // Lanes beyond repeat the first line: they hold vertices of other draws.
        let first = group.vertices[0];
        group.vertices[(count as usize).min(LANES)..].fill(first);
        group.read_positions(work.vertices.window);
        let WindowTriangles { x, y } = WindowTriangles::new(s, group);
        let ends = [[x[0], x[1]], [y[0], y[1]]];
        let tiles = LineTiles::new(s, work.plan, ends, work.plan.line_style.reach());
        let needs_clipping = <i32x16<S> as SimdBase<S>>::splat(s, NEEDS_CLIPPING);
        let is_clipped = x[0].simd_eq(needs_clipping) | x[1].simd_eq(needs_clipping);
        let clipped = s.bits_of_mask(is_clipped);
        let used = u16::MAX >> (LANES - (count as usize).min(LANES));
        for lane in Lane::all_of((tiles.any | clipped) & used) {
            let [a, b, provoking] = lane.of(&group.vertices);
            if !lane.is_in(tiles.one & !clipped) {
                self.draw_line(work, [a, b], Outline::own(provoking), setup, clip);
                continue;
            }
            let line = push_line_of(work.plan, &tiles, lane, setup.chunk);
            for (to, vertex) in line.ends.iter_mut().zip([a, b]) {
                to.set(vertex, &work.vertices.window[vertex as usize]);
            }
            line.provoking = VertexRef(provoking);
            line.front = true;
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
