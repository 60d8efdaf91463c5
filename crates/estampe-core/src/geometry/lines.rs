//! Lines: from assembled vertices to line primitives, clipped where they leave the view volume.
//!
//! Sixteen lines that are assembled together are read, binned and stored together; those of a
//! pattern, and outlines of triangles, one by one.

use super::binning::{LineTiles, bin_lines, push_line};
use super::clip_detour::ClipDetour;
use super::cull::TriangleGroup;
use super::groups::PrimitiveGroups;
use super::run::RunWork;
use super::setup::Setup;
use super::shaded_vertices::NEEDS_CLIPPING;
use crate::bounds::lines::LinePrimitive;
use crate::bounds::primitives::{VertexRef, WindowVertex};
use crate::bounds::transpose::components_of_three;
use estampe_simd::{Bytes, LANES, Lane, Lanes, SimdBase, dispatch, f32x16, i32x16};

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

/// Draws the lines of a run.
pub(super) fn draw(
    work: &RunWork<'_>,
    group: &mut TriangleGroup,
    setup: &mut Setup<'_>,
    clip: &mut ClipDetour,
) {
    let mut primitives = PrimitiveGroups::new(&work.elements, work.instance, work.primitives);
    let culls = work.source.pipeline.interface().cull_distances != 0;
    if !culls && work.plan.line_style.stipple.is_none() {
        dispatch!(work.level, s => draw_lanes(s, work, (&mut primitives, group), setup, clip));
        return;
    }
    let mut walk = LineWalk::default();
    while let Some(some) = primitives.next_of_instance(&mut group.vertices) {
        let lines = &group.vertices[..some.count];
        for (number, &[a, b, provoking]) in (some.first..).zip(lines) {
            if begins_strip(work, number) {
                walk.restart();
            }
            if !clip.is_culled_by_distance(work, &[a, b]) {
                walk.draw_line(work, [a, b], Outline::own(provoking), setup, clip);
            }
        }
    }
}

/// Draws lines without pattern and cull distances, sixteen at a time: each group is a packet, and
/// a line that is clipped keeps its lane.
#[inline(always)]
fn draw_lanes<S: Lanes>(
    s: S,
    work: &RunWork<'_>,
    (primitives, group): (&mut PrimitiveGroups<'_>, &mut TriangleGroup),
    setup: &mut Setup<'_>,
    clip: &mut ClipDetour,
) {
    let words = work.vertices.window.as_flattened();
    let needs_clipping = <i32x16<S> as SimdBase<S>>::splat(s, NEEDS_CLIPPING);
    while let Some(count) = primitives.next_group(&mut group.vertices) {
        let [a, b, provoking] = components_of_three(s, &group.vertices);
        // Products with four stay below 2³².
        let from = s.gather_four(words, a << 2);
        let to = s.gather_four(words, b << 2);
        let x: [i32x16<S>; 2] = [from[0].bitcast(), to[0].bitcast()];
        let y: [i32x16<S>; 2] = [from[1].bitcast(), to[1].bitcast()];
        let active = u16::MAX >> (LANES - count.min(LANES));
        let is_clipped = x[0].simd_eq(needs_clipping) | x[1].simd_eq(needs_clipping);
        let clipped = s.bits_of_mask(is_clipped) & active;
        let mut tiles = LineTiles::new(s, work.plan, [x, y]);
        let mut lanes = tiles.any & active & !clipped;
        if lanes | clipped == 0 {
            continue;
        }
        let packet = setup.chunk.lines.push();
        for end in 0..2 {
            x[end].store_array(&mut packet.x[end]);
            y[end].store_array(&mut packet.y[end]);
        }
        for (end, [_, _, z, iw]) in [from, to].into_iter().enumerate() {
            let (z, iw): (f32x16<S>, f32x16<S>) = (z.bitcast(), iw.bitcast());
            z.store_array(&mut packet.z[end]);
            iw.store_array(&mut packet.iw[end]);
        }
        packet.vertex = [a.to_array().map(VertexRef), b.to_array().map(VertexRef)];
        if work.plan.has_flat_varyings {
            packet.provoking.0 = provoking.to_array().map(VertexRef);
        }
        packet.front = u16::MAX;
        if clipped != 0 {
            lanes |= clip_lanes(work, (group, clipped), setup, clip);
            let Some(packet) = setup.chunk.lines.last_mut() else {
                continue;
            };
            let load = |values: &[i32; LANES]| i32x16::load_array_ref(s, values);
            let x = [load(&packet.x[0]), load(&packet.x[1])];
            let y = [load(&packet.y[0]), load(&packet.y[1])];
            tiles = LineTiles::new(s, work.plan, [x, y]);
            lanes &= tiles.any;
        }
        if lanes == 0 {
            setup.chunk.lines.pop();
        } else {
            bin_lines(s, work.plan, (&tiles, lanes), setup.chunk);
        }
    }
}

/// Clips lines of a group, and sets their lanes of the last packet. Returns those of which
/// something is left.
#[inline(never)]
fn clip_lanes(
    work: &RunWork<'_>,
    (group, clipped): (&TriangleGroup, u16),
    setup: &mut Setup<'_>,
    clip: &mut ClipDetour,
) -> u16 {
    let mut left = 0;
    for lane in Lane::all_of(clipped) {
        let [a, b, provoking] = lane.of(&group.vertices);
        let Some(ends) = clipped_line(work, [a, b], setup, clip) else {
            continue;
        };
        let line = LinePrimitive {
            ends,
            provoking: VertexRef(provoking),
            front: true,
            stipple: 0,
        };
        if let Some(packet) = setup.chunk.lines.last_mut() {
            packet.set(lane, &line);
            left |= lane.bit();
        }
    }
    left
}

/// The ends of a line after clipping.
fn clipped_line(
    work: &RunWork<'_>,
    corners: [u32; 2],
    setup: &mut Setup<'_>,
    clip: &mut ClipDetour,
) -> Option<[WindowVertex; 2]> {
    setup.chunk.statistics.primitives_clipped += 1;
    if !clip.clip(work, &corners, setup) {
        return None;
    }
    clip.line()
}

/// Draws the lines of a run one by one: a stipple pattern goes on from line to line of a strip.
#[derive(Debug, Default)]
pub(super) struct LineWalk {
    /// Fragments of the pattern that the strip's lines so far have taken.
    stipple: u32,
}

impl LineWalk {
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
        let ends = match ends {
            [Some(a), Some(b)] => Some([a, b]),
            _ => clipped_line(work, corners, setup, clip),
        };
        let Some(ends) = ends else {
            return;
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
        push_line(work.plan, &line, setup.chunk);
    }
}

/// Returns true if the line of this number in an instance begins a stipple pattern.
fn begins_strip(work: &RunWork<'_>, number: u32) -> bool {
    !work.is_line_strip || number == 0 || work.line_restarts.binary_search(&number).is_ok()
}
