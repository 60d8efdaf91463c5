//! The draw cursor: cuts a pass's draws into batches of sub-draws.

use super::draw_batch::DrawBatch;
use super::index_extremes::KnownExtremes;
use super::index_range::{
    MAX_WHOLE_ELEMENTS, element_count, is_splittable, is_stippled_strip, list_vertices, part_of,
    restart_source, vertex_range, visible_elements,
};
use super::sub_draw::{Cut, Instances, SubDraw};
use crate::attachment::RenderTarget;
use crate::commands::{Draw, DrawIter, DrawList};
use crate::geometry::assembly::primitive_count;
use crate::geometry::restart::{RestartCursor, RestartSource};
use crate::schedule::Executor;
use estampe_simd::Level;
use std::ops::Range;

/// Vertices or primitives that a batch holds before it is drawn.
const BATCH_BUDGET: usize = 2_000_000;

/// Vertices or primitives for each thread whose geometry is done together: their indices, and their
/// vertices in the window, stay in a core's second-level cache from the first use to the last. A
/// frame of a million triangles read 12 MB of indices twice, and wrote and read 8 MB of positions,
/// when it was one group.
const GROUP_BUDGET: usize = 1 << 16;

/// Primitives of a sub-draw at most: a larger draw becomes several. Even, so that a strip's parts
/// begin on triangles that are not turned.
const SUB_DRAW_PRIMITIVES: u32 = 1 << 16;

/// Primitives of a sub-draw at most, where fewer could have too many vertices in common with
/// others.
const INCOHERENT_PRIMITIVES: u32 = 1_000_000;

/// The position in a pass's draws up to which they are cut into batches.
#[derive(Debug)]
pub(crate) struct DrawCursor<'a> {
    draws: DrawIter<'a>,
    /// The draw that is being cut.
    current: Option<OpenDraw<'a>>,
    known: KnownExtremes,
}

/// A draw, and which of its primitives and instances are left.
#[derive(Debug)]
struct OpenDraw<'a> {
    draw: &'a Draw<'a>,
    /// The elements of an instance that can show anything.
    elements: u32,
    /// The primitives of the others.
    invisible_primitives: u32,
    /// The primitives that are left in the instance at hand.
    primitives: Range<u32>,
    instances: Range<u32>,
    /// The position in the current instance at which the search for the next primitive begins,
    /// where indices may restart primitives.
    restart: RestartCursor,
}

impl<'a> DrawCursor<'a> {
    pub(crate) fn new(draws: DrawList<'a>, level: Level) -> Self {
        Self {
            draws: draws.iter(),
            current: None,
            known: KnownExtremes::new(level),
        }
    }

    /// Returns the number of draws that no batch has begun.
    pub(crate) fn draws_left(&self) -> usize {
        self.draws.len()
    }

    /// Returns true if all draws are cut.
    pub(crate) fn is_at_end(&self) -> bool {
        self.current.is_none() && self.draws.len() == 0
    }

    /// Cuts the next group of a batch's sub-draws, whose vertices lie together; none when the batch
    /// is full or no draws are left.
    pub(crate) fn next_group(
        &mut self,
        executor: &Executor,
        target: &RenderTarget,
        batch: &mut DrawBatch<'a>,
    ) -> Option<Range<usize>> {
        let first = batch.begin_group();
        let (mut vertices, mut primitives) = (0, 0);
        // More threads have more work at once, and wait for each other as rarely as few.
        let budget = GROUP_BUDGET.saturating_mul(executor.threads());
        while vertices < budget
            && primitives < budget
            && batch.vertices < BATCH_BUDGET
            && batch.primitives < BATCH_BUDGET
        {
            let Some(mut open) = self.current.take().or_else(|| self.next_draw()) else {
                break;
            };
            let Some(state) = batch.state_of(open.draw, target) else {
                continue;
            };
            batch.invisible_primitives += open.take_invisible();
            let (mut sub_draw, listed) = open.take(executor, &mut self.known);
            sub_draw.state = state;
            if sub_draw.total_primitives() > 0 {
                vertices += sub_draw.total_vertices();
                primitives += sub_draw.total_primitives();
                batch.push(sub_draw, listed);
            }
            if !open.is_done() {
                self.current = Some(open);
            }
        }
        let end = batch.sub_draws.len();
        (end > first).then_some(first..end)
    }

    /// The next draw of at least one primitive.
    fn next_draw(&mut self) -> Option<OpenDraw<'a>> {
        loop {
            let draw = self.draws.next()?;
            let topology = draw.pipeline.descriptor().primitive.topology;
            let all = primitive_count(topology, element_count(draw));
            let elements = visible_elements(draw);
            let primitives = 0..primitive_count(topology, elements);
            if all == 0 || draw.instances.is_empty() {
                continue;
            }
            return Some(OpenDraw {
                draw,
                elements,
                invisible_primitives: all - primitives.end,
                primitives,
                instances: draw.instances.clone(),
                restart: RestartCursor::default(),
            });
        }
    }
}

impl<'a> OpenDraw<'a> {
    fn is_done(&self) -> bool {
        self.instances.is_empty()
    }

    /// The primitives of all instances that cannot show anything; 0 when asked again.
    fn take_invisible(&mut self) -> u64 {
        let instances = u64::from(self.instances.end - self.instances.start);
        u64::from(std::mem::take(&mut self.invisible_primitives)) * instances
    }

    /// Takes the next sub-draw off: many instances of a small draw, or part of one instance of a
    /// large one.
    fn take(&mut self, executor: &Executor, known: &mut KnownExtremes) -> Cut<'a> {
        let draw = self.draw;
        if let Some(source) = restart_source(draw) {
            return self.take_restarted(&source);
        }
        let topology = draw.pipeline.descriptor().primitive.topology;
        let whole = self.elements;
        let all = primitive_count(topology, whole);
        if all > SUB_DRAW_PRIMITIVES && is_splittable(draw) {
            let left = self.primitives.end - self.primitives.start;
            let first = self.primitives.start;
            let mut part = |count: u32| {
                let elements = part_of(topology, first, count, whole);
                self.sub_draw((executor, &mut *known), elements, 1)
            };
            let mut count = left.min(SUB_DRAW_PRIMITIVES);
            let mut taken = part(count);
            // Parts of a mesh have half a vertex for each triangle, and few in common with others.
            // Of triangles in random order each part has many of the vertices, which would be
            // shaded again for each part.
            let is_coherent = draw.indices.is_none() || taken.0.vertices / 3 <= count / 4;
            if !is_coherent && count < left {
                count = left.min(INCOHERENT_PRIMITIVES);
                taken = part(count);
            }
            self.primitives.start += count;
            if self.primitives.is_empty() {
                self.primitives.start = 0;
                self.instances.start += 1;
            }
            return taken;
        }
        let left = self.instances.end - self.instances.start;
        let instances = (SUB_DRAW_PRIMITIVES / all.max(1)).clamp(1, left);
        let mut cut = self.sub_draw((executor, known), [0, whole], instances);
        cut.0.keep_within(BATCH_BUDGET);
        self.instances.start += cut.0.instances;
        cut
    }

    /// Takes the next sub-draw off where indices may restart primitives.
    fn take_restarted(&mut self, source: &RestartSource<'_>) -> Cut<'a> {
        let is_first = self.restart.is_at_start();
        let is_whole = is_stippled_strip(self.draw);
        let mut begins = Vec::new();
        let limit = if is_whole {
            MAX_WHOLE_ELEMENTS
        } else {
            INCOHERENT_PRIMITIVES
        };
        let mut corners = self.restart.take(source, limit, &mut begins);
        if !is_whole {
            begins.clear();
        }
        let is_done = self.restart.is_done(source);
        debug_assert!(
            corners.len() <= limit as usize + 1,
            "the limit, and a loop's last line"
        );
        let primitives = u32::try_from(corners.len()).unwrap_or(u32::MAX);
        let left = self.instances.end - self.instances.start;
        let count = if is_first && is_done {
            (INCOHERENT_PRIMITIVES / primitives.max(1)).clamp(1, left)
        } else {
            1
        };
        let instances = Instances {
            first: self.instances.start,
            count,
        };
        let range = list_vertices(&mut corners);
        let (mut sub_draw, listed) = SubDraw::cut(self.draw, [0, 0], primitives, instances, range);
        let mut listed = listed.unwrap_or_default();
        listed.restarted = Some(corners);
        listed.line_restarts = begins;
        sub_draw.keep_within(BATCH_BUDGET);
        if is_done {
            self.restart = RestartCursor::default();
            self.instances.start += sub_draw.instances;
        }
        (sub_draw, Some(listed))
    }

    /// The sub-draw of some elements (first and count, from the draw's first on) of the next
    /// instances.
    fn sub_draw(
        &self,
        indices: (&Executor, &mut KnownExtremes),
        [first, count]: [u32; 2],
        instances: u32,
    ) -> Cut<'a> {
        let first = self.draw.elements.start.saturating_add(first);
        let range = vertex_range(indices, self.draw, first, count);
        let topology = self.draw.pipeline.descriptor().primitive.topology;
        let instances = Instances {
            first: self.instances.start,
            count: instances,
        };
        let primitives = primitive_count(topology, count);
        SubDraw::cut(self.draw, [first, count], primitives, instances, range)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attachment::{ColorTexels, DepthStencilTexels, ImageSize};
    use crate::pipeline::{RenderPipeline, RenderPipelineDescriptor};
    use estampe_types::shader::VertexOut;
    use estampe_types::state::{PrimitiveTopology, ScissorRect, Viewport};
    use estampe_types::{
        BufferData, FragmentIn, FragmentOut, IndexFormat, Limits, TextureFormat, Vec2, VertexIn,
    };

    /// A shader of two floats as varyings.
    struct Plain;

    estampe_types::shader! {
        impl Shader for Plain {
            type Attributes<R: Real> = ();
            type Varyings<R: Real> = Vec2<R>;

            fn vertex<R: Real>(&self, input: VertexIn<'_, R>, _: ()) -> VertexOut<R, Vec2<R>> {
                let zero = input.real(0.0);
                let nowhere = Vec2::new(zero, zero);
                VertexOut::new(estampe_types::Vec4::new(zero, zero, zero, zero), nowhere)
            }

            fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, _: Vec2<R>) -> FragmentOut<R> {
                let zero = input.real(0.0);
                FragmentOut::color(estampe_types::Vec4::new(zero, zero, zero, zero))
            }
        }
    }

    fn pipeline(topology: PrimitiveTopology, samples: u32) -> RenderPipeline {
        let mut descriptor = RenderPipelineDescriptor::new(Plain);
        descriptor.primitive.topology = topology;
        descriptor.multisample.count = samples;
        RenderPipeline::new(&descriptor, &Limits::default()).unwrap()
    }

    /// Cuts draws into batches and hands each to `check`, with its number; says how many there are.
    fn cut(draws: &[Draw<'_>], mut check: impl FnMut(usize, &DrawBatch<'_>)) -> usize {
        let size = ImageSize {
            width: 40,
            height: 30,
            samples: 1,
        };
        let color = ColorTexels::zeros(TextureFormat::Rgba8Unorm, size).unwrap();
        let depth = DepthStencilTexels::zeros(TextureFormat::Depth32Float, size).unwrap();
        let target = RenderTarget::of_images(size, vec![color], Some(depth));
        let executor = Executor::new(1).unwrap();
        let (mut cursor, mut batch) = (
            DrawCursor::new(draws.into(), Level::best()),
            DrawBatch::default(),
        );
        let mut batches = 0;
        loop {
            batch.clear();
            let (mut groups, mut sub_draws) = (0, 0);
            while let Some(group) = cursor.next_group(&executor, &target, &mut batch) {
                assert_eq!(group.start, sub_draws);
                sub_draws = group.end;
                let mut vertex = 0;
                for span in batch.spans(group) {
                    let places = (span.group, span.first, span.first_varying);
                    assert_eq!(places, (groups, vertex, 2 * vertex));
                    assert!(vertex < GROUP_BUDGET, "a group that was full");
                    vertex += span.count;
                }
                groups += 1;
            }
            assert_eq!(batch.sub_draws.len(), sub_draws);
            if sub_draws == 0 {
                return batches;
            }
            check(batches, &batch);
            batches += 1;
        }
    }

    #[test]
    fn draws_of_one_state_share_it() {
        let fits = pipeline(PrimitiveTopology::TriangleList, 1);
        let plain = Draw::new(&fits, 0..6);
        let blended = Draw {
            blend_constant: [-0.0; 4],
            ..plain.clone()
        };
        let viewport = |x| Draw {
            viewport: Some(Viewport {
                x,
                ..Viewport::of_target(40, 30)
            }),
            ..plain.clone()
        };
        let draws = [
            plain.clone(),
            blended,
            viewport(0.0),
            viewport(-0.0),
            Draw {
                scissor: Some(ScissorRect {
                    x: 40,
                    y: 0,
                    width: 5,
                    height: 5,
                }),
                ..plain.clone()
            },
            Draw::new(&fits, 0..2),
            plain,
        ];
        let batches = cut(&draws, |_, batch| {
            let states = batch.sub_draws.iter().map(|sub_draw| sub_draw.state);
            // A blend constant belongs to the draw. No pixel is left of the fifth draw, and the
            // sixth has no triangle.
            assert_eq!(states.collect::<Vec<_>>(), [0, 0, 1, 2, 3]);
            assert_eq!(batch.states.len(), 4);
        });
        assert_eq!(batches, 1);
    }

    #[test]
    fn a_large_draw_becomes_several_sub_draws_in_several_batches() {
        let strips = pipeline(PrimitiveTopology::TriangleStrip, 1);
        let draws = [Draw::new(&strips, 5..2_500_007)];
        let mut elements = Vec::new();
        let batches = cut(&draws, |number, batch| {
            for sub_draw in &batch.sub_draws {
                elements.push((number, sub_draw.elements, sub_draw.primitives));
            }
        });
        // A strip's part repeats the two vertices before it.
        let each = SUB_DRAW_PRIMITIVES;
        let expected = (0..39).map(|part| {
            let count = each.min(2_500_000 - part * each);
            // The first batch is full with the 31st part.
            (usize::from(part > 30), [5 + part * each, count + 2], count)
        });
        assert_eq!((batches, elements), (2, expected.collect()));
    }

    #[test]
    fn many_instances_are_cut_between_two_of_them() {
        let lists = pipeline(PrimitiveTopology::TriangleList, 1);
        let draws = [Draw {
            instances: 7..250_007,
            ..Draw::new(&lists, 0..30)
        }];
        let mut instances = Vec::new();
        let _ = cut(&draws, |_, batch| {
            for sub_draw in &batch.sub_draws {
                assert_eq!((sub_draw.primitives, sub_draw.vertices), (10, 30));
                instances
                    .push(sub_draw.first_instance..sub_draw.first_instance + sub_draw.instances);
            }
        });
        // A sub-draw has 6,553 instances of ten triangles.
        let expected = (0..39).map(|part| {
            let first = 7 + part * 6_553;
            first..(first + 6_553).min(250_007)
        });
        assert!(instances.into_iter().eq(expected));
    }

    #[test]
    fn parts_that_share_their_vertices_are_not_cut() {
        let lists = pipeline(PrimitiveTopology::TriangleList, 1);
        let triangles = 200_000;
        // Of a strip of triangles two parts have two vertices in common; of triangles that join
        // vertices from everywhere each part has all of them.
        for (stride, expected) in [(1, 4), (7_919, 1)] {
            let vertex = |element: u32| {
                let (triangle, corner) = (element / 3, element % 3);
                (triangle / 2 * stride + corner) % (triangles / 2 + 2)
            };
            let bytes: Vec<u8> = (0..triangles * 3)
                .flat_map(|element| vertex(element).to_le_bytes())
                .collect();
            let buffer = BufferData::from_bytes(&bytes);
            let draws = [Draw {
                indices: Some((&buffer, IndexFormat::Uint32)),
                ..Draw::new(&lists, 0..triangles * 3)
            }];
            let batches = cut(&draws, |_, batch| {
                let primitives = batch.sub_draws.iter().map(|sub_draw| sub_draw.primitives);
                assert_eq!(primitives.sum::<u32>(), triangles);
                assert_eq!(batch.sub_draws.len(), expected, "stride {stride}");
            });
            assert_eq!(batches, 1);
        }
    }

    #[test]
    fn elements_beyond_the_index_buffer_are_left_out_and_counted() {
        let lists = pipeline(PrimitiveTopology::TriangleList, 1);
        let points = pipeline(PrimitiveTopology::PointList, 1);
        let buffer = BufferData::from_bytes(&[0; 20]);
        let draw = |pipeline, elements| Draw {
            indices: Some((&buffer, IndexFormat::Uint16)),
            ..Draw::new(pipeline, elements)
        };
        let draws = [
            draw(&lists, 0..12),
            Draw {
                instances: 0..2,
                ..draw(&lists, 4..304)
            },
            draw(&points, 0..300),
        ];
        let batches = cut(&draws, |_, batch| {
            let primitives = batch.sub_draws.iter().map(|sub_draw| sub_draw.primitives);
            // Six of the ten indices are left from the fourth one on; six more elements complete a
            // primitive.
            assert!(primitives.eq([4, 4, 300]));
            assert_eq!(batch.invisible_primitives, 2 * 96);
        });
        assert_eq!(batches, 1);
    }
}
