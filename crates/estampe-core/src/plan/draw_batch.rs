//! Draw batches: sub-draws that are processed together.

use super::chunk_plan::ChunkPart;
use super::draw_state::DrawState;
use super::sub_draw::{ListedVertices, SubDraw};
use super::tile_plan::{TargetFacts, TilePlan, TileState};
use crate::attachment::RenderTarget;
use crate::bounds::chunk::PacketCounts;
use crate::bounds::chunk::number;
use crate::commands::Draw;
use crate::geometry::plan::GeometryPlan;
use crate::geometry::shaded_vertices::{GroupVertices, ShadedVertices, VertexSpan};
use crate::pipeline::primitive_kind::PrimitiveKind;
use crate::recycle::recycled;
use crate::schedule::Executor;
use crate::segments::{Missing, Segments};
use crate::tile_path::{PathFacts, TilePath};
use estampe_simd::{LANES, Level};

/// Sub-draws whose plans one thread makes while others wait.
const FEW_SUB_DRAWS: usize = 128;

/// Sub-draws in submission order, and the states that they share.
#[derive(Debug, Default)]
pub(crate) struct DrawBatch<'a> {
    pub(crate) states: Vec<DrawState<'a>>,
    pub(crate) sub_draws: Segments<SubDraw<'a>>,
    /// The first sub-draw of each state that tiles read, which sub-draws in a row share.
    pub(crate) tile_states: Vec<usize>,
    listed: Vec<ListedVertices>,
    /// Vertices that shaders of the caller's shade.
    pub(crate) shaded: usize,
    /// Primitives of the draws that are in no sub-draw, because they have no extent.
    pub(crate) invisible_primitives: u64,
    /// Vertices and primitives of the sub-draws.
    pub(super) vertices: usize,
    pub(super) primitives: usize,
    /// The vertices of the group at hand, and its first sub-draw.
    pub(crate) group: GroupVertices,
    first_of_group: usize,
}

impl<'a> DrawBatch<'a> {
    /// An empty batch of other draws, in the same memory.
    pub(crate) fn recycled<'b>(mut self) -> DrawBatch<'b> {
        self.clear();
        DrawBatch {
            states: recycled(self.states),
            sub_draws: self.sub_draws.recycled(),
            tile_states: self.tile_states,
            listed: self.listed,
            ..DrawBatch::default()
        }
    }

    /// Empties the batch.
    pub(crate) fn clear(&mut self) {
        self.states.clear();
        self.sub_draws.clear();
        self.tile_states.clear();
        self.listed.clear();
        (self.shaded, self.invisible_primitives) = (0, 0);
        (self.vertices, self.primitives) = (0, 0);
        (self.group, self.first_of_group) = (GroupVertices::default(), 0);
    }

    /// Begins a group of sub-draws, whose vertices in the window take the place of those of the
    /// group before. Gives the number of its first sub-draw.
    pub(super) fn begin_group(&mut self) -> usize {
        // The group before may have got no sub-draws.
        if self.sub_draws.len() > self.first_of_group {
            self.group = self.group.following();
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
    pub(super) fn push(&mut self, mut sub_draw: SubDraw<'a>, listed: Option<Box<ListedVertices>>) {
        let interface = sub_draw.draw.pipeline.interface();
        let vertices = sub_draw.total_vertices();
        sub_draw.span = self.group.place(VertexSpan {
            count: vertices,
            varying_scalars: interface.varyings.len(),
            // Filled triangles compute them again for the few vertices that need clipping.
            keeps_clip_positions: !self.state(&sub_draw).geometry.fills_triangles(),
            has_point_sizes: interface.writes_point_size,
            ..VertexSpan::default()
        });
        self.vertices += vertices;
        self.primitives += sub_draw.total_primitives();
        if !sub_draw.draw.pipeline.has_finished_vertices() {
            self.shaded += vertices;
        }
        sub_draw.listed = listed.map(|listed| {
            self.listed.push(*listed);
            number(self.listed.len() - 1)
        });
        let last = self.sub_draws.last();
        if !last.is_some_and(|last| last.has_tile_state_of(&sub_draw)) {
            self.tile_states.push(self.sub_draws.len());
        }
        sub_draw.tile_state = number(self.tile_states.len() - 1);
        self.sub_draws.push(sub_draw);
    }

    /// Adds the sub-draws of batches of one group each behind those of the group at hand, on all
    /// threads, and empties these batches.
    pub(super) fn append(&mut self, executor: &Executor, parts: &mut [Self]) {
        if parts.is_empty() {
            return;
        }
        let first = self.sub_draws.len();
        let mut last = self.sub_draws.last().copied();
        let mut end = first;
        let mut moves: Vec<Move> = Vec::with_capacity(parts.len());
        for part in &mut *parts {
            let moved = self.move_of(part, (end, last));
            end += part.sub_draws.len();
            last = part.sub_draws.last().map(|last| moved.of(last)).or(last);
            moves.push(moved);
        }
        let shared = &*parts;
        let mut jobs: Vec<_> = self.sub_draws.grow_by(end - first).collect();
        executor.for_each_alone(&mut jobs, |(segment, missing)| {
            // From the last part that begins by there.
            let part = moves.partition_point(|moved| moved.begin <= missing.start) - 1;
            for (moved, part) in moves.iter().zip(shared).skip(part) {
                if moved.begin >= missing.end {
                    break;
                }
                let of_part = |number: usize| {
                    let number = number.saturating_sub(moved.begin);
                    number.min(part.sub_draws.len())
                };
                let sub_draws = part
                    .sub_draws
                    .range(of_part(missing.start)..of_part(missing.end));
                segment.extend(sub_draws.map(|sub_draw| moved.of(sub_draw)));
            }
        });
        parts.iter_mut().for_each(Self::clear);
    }

    /// Adds what a part counted, and all of it but its sub-draws, which will begin at a number,
    /// behind another one. Says where they are moved.
    fn move_of(&mut self, part: &mut Self, (begin, last): (usize, Option<SubDraw<'a>>)) -> Move {
        self.invisible_primitives += part.invisible_primitives;
        self.shaded += part.shaded;
        self.vertices += part.vertices;
        self.primitives += part.primitives;
        let mut moved = Move {
            begin,
            states: number(self.states.len()),
            tile_states: number(self.tile_states.len()),
            listed: number(self.listed.len()),
            group: self.group,
        };
        let Some(first) = part.sub_draws.first() else {
            return moved;
        };
        // The state of the last sub-draw goes on.
        let last_state = self.states.last();
        let goes_on = first.state == 0 && last_state.is_some_and(|last| last.is_of(first.draw));
        moved.states -= u32::from(goes_on);
        let states = part.states.drain(..);
        self.states.extend(states.skip(usize::from(goes_on)));
        let first = moved.of(first);
        let goes_on = last.is_some_and(|last| last.has_tile_state_of(&first));
        moved.tile_states -= u32::from(goes_on);
        let new = part.tile_states.iter().skip(usize::from(goes_on));
        self.tile_states.extend(new.map(|first| begin + first));
        self.listed.append(&mut part.listed);
        self.group.append(&part.group);
        moved
    }

    /// A sub-draw's lists of vertices, if it has some.
    pub(crate) fn listed(&self, sub_draw: &SubDraw<'_>) -> Option<&ListedVertices> {
        sub_draw.listed.map(|listed| &self.listed[listed as usize])
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
        (a.tile_state == b.tile_state || a.rasterizes_like(b))
            && TilePath::choose(a.draw.pipeline, &facts).joins_draws()
    }

    /// The packets of a chunk, if none is culled.
    pub(crate) fn packets(&self, parts: &[ChunkPart]) -> PacketCounts<usize> {
        let mut counts = PacketCounts::default();
        for part in parts {
            let [from, to] = part.primitives;
            let packets = ((to - from) as usize).div_ceil(LANES);
            let plan = self.plan(&self.sub_draws[part.sub_draw as usize]);
            match plan.kind {
                PrimitiveKind::Triangles if plan.fills_triangles() => {
                    counts.triangles += packets;
                    if plan.draws_one_by_one {
                        counts.one_by_one = counts.triangles;
                    }
                }
                PrimitiveKind::Lines => counts.lines += packets,
                PrimitiveKind::Triangles | PrimitiveKind::Points => {}
            }
        }
        counts
    }

    /// Resolves the states that tiles read.
    pub(crate) fn tile_states<'b>(&'b self, target: &TargetFacts, states: &mut Vec<TileState<'b>>) {
        states.extend(self.tile_states.iter().map(|&first| {
            let sub_draw = &self.sub_draws[first];
            TileState::new(
                (sub_draw.draw, sub_draw.bindings()),
                self.plan(sub_draw),
                target,
            )
        }));
    }

    /// The plans of sub-draws on the tile side, whose states were resolved, made on all threads.
    pub(crate) fn tile_plans<'b>(
        &'b self,
        executor: &Executor,
        (states, vertices): (&'b [TileState<'b>], &'b ShadedVertices),
        plans: &mut Segments<TilePlan<'b>>,
    ) {
        let segments = plans.grow_by(self.sub_draws.len());
        let fill = |(plans, missing): &mut Missing<'_, TilePlan<'b>>| {
            let sub_draws = self.sub_draws.range(missing.clone());
            plans.extend(sub_draws.map(|sub_draw| TilePlan {
                state: &states[sub_draw.tile_state as usize],
                bindings: sub_draw.bindings(),
                varyings: vertices.of_span(&sub_draw.span).varyings,
            }));
        };
        if executor.threads() == 1 || self.sub_draws.len() <= FEW_SUB_DRAWS {
            segments.for_each(|mut segment| fill(&mut segment));
            return;
        }
        let mut segments: Vec<_> = segments.collect();
        executor.for_each_alone(&mut segments, fill);
    }
}

/// What is added to the numbers of a part's sub-draws where they join a batch.
#[derive(Debug)]
struct Move {
    /// The number of the first of them.
    begin: usize,
    states: u32,
    tile_states: u32,
    listed: u32,
    /// The vertices before theirs.
    group: GroupVertices,
}

impl Move {
    fn of<'a>(&self, sub_draw: &SubDraw<'a>) -> SubDraw<'a> {
        SubDraw {
            state: sub_draw.state + self.states,
            tile_state: sub_draw.tile_state + self.tile_states,
            span: self.group.moved(sub_draw.span),
            listed: sub_draw.listed.map(|number| number + self.listed),
            ..*sub_draw
        }
    }
}
