//! Draw batches: sub-draws that are processed together.

use super::chunk_plan::ChunkPart;
use super::draw_state::DrawState;
use super::sub_draw::SubDraw;
use super::tile_plan::{TargetFacts, TileState};
use crate::attachment::RenderTarget;
use crate::commands::Draw;
use crate::geometry::plan::GeometryPlan;
use crate::geometry::shaded_vertices::VertexSpan;
use crate::pipeline::primitive_kind::PrimitiveKind;
use crate::tile_path::{PathFacts, TilePath};
use estampe_simd::{LANES, Level};
use std::ops::Range;

/// Sub-draws in submission order, and the states that they share.
#[derive(Debug, Default)]
pub(crate) struct DrawBatch<'a> {
    pub(crate) states: Vec<DrawState<'a>>,
    pub(crate) sub_draws: Vec<SubDraw<'a>>,
    /// Primitives of the draws that are in no sub-draw, because they have no extent.
    pub(crate) invisible_primitives: u64,
    /// Vertices and primitives of the sub-draws.
    pub(super) vertices: usize,
    pub(super) primitives: usize,
    /// The number of the group at hand, and its first sub-draw.
    group: usize,
    first_of_group: usize,
}

impl<'a> DrawBatch<'a> {
    /// An empty batch in the memory of others.
    pub(crate) fn new(states: Vec<DrawState<'a>>, sub_draws: Vec<SubDraw<'a>>) -> Self {
        Self {
            states,
            sub_draws,
            ..Self::default()
        }
    }

    /// Empties the batch.
    pub(crate) fn clear(&mut self) {
        self.states.clear();
        self.sub_draws.clear();
        self.invisible_primitives = 0;
        (self.vertices, self.primitives) = (0, 0);
        (self.group, self.first_of_group) = (0, 0);
    }

    /// Begins a group of sub-draws, whose vertices in the window take the place of those of the
    /// group before. Gives the number of its first sub-draw.
    pub(super) fn begin_group(&mut self) -> usize {
        // The group before may have got no sub-draws.
        if self.sub_draws.len() > self.first_of_group {
            self.group += 1;
            self.first_of_group = self.sub_draws.len();
        }
        self.first_of_group
    }

    /// The number of a draw's state, which is resolved unless the last one is the same; `None`
    /// where the draw would draw nothing.
    pub(super) fn state_of(&mut self, draw: &Draw<'a>, target: &RenderTarget) -> Option<u32> {
        if !self.states.last().is_some_and(|last| last.is_of(draw)) {
            self.states.push(DrawState::resolve(draw, target)?);
        }
        let last = self.states.len() - 1;
        debug_assert!(
            u32::try_from(last).is_ok(),
            "a state for each sub-draw at most"
        );
        Some(u32::try_from(last).unwrap_or(u32::MAX))
    }

    /// Adds a sub-draw, after whose vertices lie those of the one before.
    pub(super) fn push(&mut self, mut sub_draw: SubDraw<'a>) {
        let interface = sub_draw.draw.pipeline.interface();
        let of_group = &self.sub_draws[self.first_of_group..];
        let begin = VertexSpan {
            group: self.group,
            ..VertexSpan::default()
        };
        let after = of_group.last().map_or(begin, |last| last.span.following());
        sub_draw.span = VertexSpan {
            count: sub_draw.total_vertices(),
            varying_scalars: interface.varyings.len(),
            // Filled triangles compute them again for the few vertices that need clipping.
            keeps_clip_positions: !self.state(&sub_draw).geometry.fills_triangles(),
            has_point_sizes: interface.writes_point_size,
            ..after
        };
        self.sub_draws.push(sub_draw);
    }

    /// A sub-draw's state.
    pub(crate) fn state(&self, sub_draw: &SubDraw<'_>) -> &DrawState<'a> {
        &self.states[sub_draw.state as usize]
    }

    /// A sub-draw's geometry plan.
    pub(crate) fn plan(&self, sub_draw: &SubDraw<'_>) -> &GeometryPlan {
        &self.state(sub_draw).geometry
    }

    /// Returns true if tiles may rasterize the triangles of two sub-draws as those of one.
    pub(crate) fn joins(&self, sub_draws: [u32; 2], level: Level, samples: usize) -> bool {
        let [a, b] = sub_draws.map(|number| &self.sub_draws[number as usize]);
        let facts = PathFacts {
            samples,
            level,
            // Tells no visibility paths apart.
            tests_depth_alone: false,
            cuts_samples: self.plan(a).cut_samples.is_some(),
        };
        a.rasterizes_like(b) && TilePath::choose(a.draw.pipeline, &facts).joins_draws()
    }

    /// The packets of triangles and of lines of a chunk, if none is culled.
    pub(crate) fn packets(&self, parts: &[ChunkPart]) -> [usize; 2] {
        let (mut triangles, mut lines) = (0, 0);
        for part in parts {
            let [from, to] = part.primitives;
            let packets = ((to - from) as usize).div_ceil(LANES);
            let plan = self.plan(&self.sub_draws[part.sub_draw as usize]);
            match plan.kind {
                PrimitiveKind::Triangles if plan.fills_triangles() => triangles += packets,
                PrimitiveKind::Lines => lines += packets,
                PrimitiveKind::Triangles | PrimitiveKind::Points => {}
            }
        }
        [triangles, lines]
    }

    /// Resolves the state that tiles read; sub-draws in a row share it.
    pub(crate) fn tile_states<'b>(&'b self, target: &TargetFacts, states: &mut Vec<TileState<'b>>) {
        let mut last: Option<&SubDraw<'_>> = None;
        for (number, sub_draw) in self.sub_draws.iter().enumerate() {
            match states.last_mut() {
                Some(state) if last.is_some_and(|last| last.has_tile_state_of(sub_draw)) => {
                    state.sub_draws.end = number + 1;
                }
                _ => {
                    let plan = self.plan(sub_draw);
                    states.push(TileState::new(number, sub_draw.draw, plan, target));
                }
            }
            last = Some(sub_draw);
        }
    }

    /// The places of the vertices of a group's sub-draws.
    pub(crate) fn spans(&self, group: Range<usize>) -> impl Iterator<Item = &VertexSpan> + Clone {
        self.sub_draws[group].iter().map(|sub_draw| &sub_draw.span)
    }

    /// Vertices of all sub-draws that a shader of the caller's shades.
    pub(crate) fn total_vertices(&self) -> usize {
        let shaded = self.sub_draws.iter();
        shaded
            .filter(|sub_draw| !sub_draw.draw.pipeline.has_finished_vertices())
            .map(|sub_draw| sub_draw.span.count)
            .sum()
    }
}
