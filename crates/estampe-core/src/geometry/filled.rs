//! Filled triangles, sixteen at a time: the loop of the geometry side.
//!
//! *In* the primitives of a run · *Out* triangles in a chunk's packets, binned · *Space* window.
//!
//! ```text
//!     assemble ──▶ classify ──┬──▶ (culled: most of a closed mesh)
//!                             ├──▶ set up, in order ◀──┐
//!                             └──▶ clip detour ────────┘ pieces, in the triangle's place
//! ```
//!
//! One group is assembled before the last one is classified: vectors cannot be loaded from what was
//! just stored lane by lane, and meanwhile there is something to do. Where positions are gathered,
//! nothing is stored but vertices.

use super::clip_detour::ClipDetour;
use super::cull::{Classified, TriangleGroup, WindowTriangles, classify};
use super::groups::PrimitiveGroups;
use super::run::RunWork;
use super::setup::{Setup, SetupLanes};
use super::shaded_vertices::PackedVertex;
use crate::bounds::transpose::components_of_three;
use estampe_simd::{LANES, Lane, Lanes, SimdBase, u32x16};

/// Positions are gathered of fewer vertices than this: hardware indices of words have 31 bits.
const MOST_GATHERED: usize = 1 << 29;

/// Draws the triangles of a run.
#[inline(always)]
pub(super) fn draw<S: Lanes>(
    s: S,
    work: &RunWork<'_>,
    setup: &mut Setup<'_>,
    groups: &mut [TriangleGroup; 2],
    clip: &mut ClipDetour,
) {
    let window = work.vertices.window;
    let gathers = s.gathers_pairs() && window.len() < MOST_GATHERED;
    let read = if gathers { None } else { Some(window) };
    let mut primitives = PrimitiveGroups::new(&work.elements, work.instance, work.primitives);
    let [mut group, mut ahead] = groups.each_mut();
    let mut coming = assemble(&mut primitives, read, ahead);
    let mut culled = 0;
    while let Some(count) = coming {
        std::mem::swap(&mut group, &mut ahead);
        coming = assemble(&mut primitives, read, ahead);

        let active = u16::MAX >> (LANES - count);
        let mut vertices = [<u32x16<S> as SimdBase<S>>::splat(s, 0); 3];
        let triangles = if gathers {
            vertices = components_of_three(s, &group.vertices);
            WindowTriangles::gather(s, window, &vertices)
        } else {
            WindowTriangles::new(s, group)
        };
        let classified = classify(s, work.plan, &triangles, active);
        let kept = classified.visible | classified.clipped;
        culled += (active & !kept).count_ones();
        if kept == 0 {
            continue;
        }
        if !gathers {
            // Of culled triangles they are not needed.
            vertices = components_of_three(s, &group.vertices);
        }
        let lanes = SetupLanes {
            vertices,
            first_vertex: <u32x16<S> as SimdBase<S>>::splat(s, work.vertices.first_in_group),
            doubled_area: classified.doubled_area,
        };
        let mut submit = Submission {
            work,
            setup,
            group,
            triangles: &triangles,
            lanes: &lanes,
        };
        let visible = submit.clip_in_order(s, &classified, clip);
        submit.set_up(s, visible);
    }
    let statistics = &mut setup.chunk.statistics;
    statistics.primitives_culled += u64::from(culled);
    if gathers {
        let [from, to] = work.primitives;
        statistics.triangles_gathered_in_pairs += u64::from(to - from);
    }
}

/// Assembles the next group, and reads where its vertices are in a window if one is given; none at
/// the end.
#[inline(always)]
fn assemble(
    primitives: &mut PrimitiveGroups<'_>,
    window: Option<&[PackedVertex]>,
    group: &mut TriangleGroup,
) -> Option<usize> {
    let count = primitives.next_group(&mut group.vertices)?;
    if let Some(window) = window {
        group.read_positions(window);
    }
    Some(count)
}

/// A group on its way to set-up.
struct Submission<'a, 'b, 'c, S: Lanes> {
    work: &'a RunWork<'b>,
    setup: &'a mut Setup<'c>,
    group: &'a TriangleGroup,
    triangles: &'a WindowTriangles<S>,
    lanes: &'a SetupLanes<S>,
}

impl<S: Lanes> Submission<'_, '_, '_, S> {
    /// Clips the triangles that need it, and sets up those before the last of them, so that all
    /// keep their order. The visible ones that are left are the caller's.
    #[inline(always)]
    fn clip_in_order(&mut self, s: S, classified: &Classified<S>, clip: &mut ClipDetour) -> u16 {
        let mut visible = classified.visible;
        for lane in Lane::all_of(classified.clipped) {
            let before = visible & (lane.bit() - 1);
            visible &= !before;
            self.set_up(s, before);
            clip.draw_triangle(self.work, lane.of(&self.group.vertices), self.setup);
        }
        visible
    }

    /// Sets up the triangles of some lanes.
    #[inline(always)]
    fn set_up(&mut self, s: S, lanes: u16) {
        if lanes != 0 {
            self.setup.push_lanes(s, self.triangles, self.lanes, lanes);
        }
    }
}
