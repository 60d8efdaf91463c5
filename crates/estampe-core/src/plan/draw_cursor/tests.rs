//! Sub-draws and batches into which draws are cut, and what belongs to each.

use super::open_draw::SUB_DRAW_PRIMITIVES;
use super::*;
use crate::attachment::{ColorTexels, DepthStencilTexels, ImageSize};
use crate::commands::Draw;
use crate::pipeline::{RenderPipeline, RenderPipelineDescriptor};
use crate::plan::sub_draw::SubDraw;
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
        DrawCursor::new(draws.into(), Level::best(), Vec::new()),
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
            for SubDraw { span, .. } in batch.sub_draws.range(group) {
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
        for sub_draw in batch.sub_draws.iter() {
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
        for sub_draw in batch.sub_draws.iter() {
            assert_eq!((sub_draw.primitives, sub_draw.vertices), (10, 30));
            instances.push(sub_draw.first_instance..sub_draw.first_instance + sub_draw.instances);
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

/// The facts of a sub-draw that do not depend on where parts of draws end: all but the places of
/// its vertices. The last is what is listed of them.
type Facts = (usize, [u32; 2], [u32; 7], Option<String>);

/// The sub-draws of draws on so many threads, the first of each state of tiles, and how many parts
/// of the draws threads cut.
fn facts_on(threads: usize, draws: DrawList<'_>) -> (Vec<Facts>, Vec<usize>, usize) {
    let size = ImageSize {
        width: 40,
        height: 30,
        samples: 1,
    };
    let target = RenderTarget::of_images(size, Vec::new(), None);
    let executor = Executor::new(threads).unwrap();
    let mut batch = DrawBatch::default();
    let mut cursor = DrawCursor::new(draws, Level::best(), Vec::new());
    assert_eq!(cursor.draws_left(), draws.len());
    while let Some(group) = cursor.next_group(&executor, &target, &mut batch) {
        let (mut vertices, mut scalars) = (0, 0);
        for SubDraw { span, .. } in batch.sub_draws.range(group) {
            assert_eq!((span.first, span.first_varying), (vertices, scalars));
            vertices += span.count;
            scalars += span.count * span.varying_scalars;
        }
        assert_eq!(vertices, batch.group.count);
    }
    assert!(cursor.is_at_end());
    let facts = batch.sub_draws.iter().map(|sub_draw| {
        let ranges = [
            sub_draw.first_instance,
            sub_draw.instances,
            sub_draw.first_vertex,
            sub_draw.vertices,
            sub_draw.primitives,
            sub_draw.state,
            sub_draw.tile_state,
        ];
        let draw = std::ptr::from_ref(sub_draw.draw).addr();
        let listed = batch.listed(sub_draw).map(|listed| format!("{listed:?}"));
        (draw, sub_draw.elements, ranges, listed)
    });
    let facts = facts.collect();
    let primitives = batch.sub_draws.iter().map(SubDraw::total_primitives);
    assert_eq!(batch.primitives, primitives.sum::<usize>());
    let parts = cursor.into_memory();
    let empty = |part: &DrawBatch<'_>| part.sub_draws.is_empty() && part.states.is_empty();
    assert!(parts.iter().all(empty), "parts that were joined");
    (facts, batch.tile_states, parts.len())
}

#[test]
fn many_draws_are_cut_by_threads_as_by_one() {
    let pipelines = [(), ()].map(|()| pipeline(PrimitiveTopology::TriangleList, 1));
    let mut restarting = RenderPipelineDescriptor::new(Plain);
    restarting.primitive.topology = PrimitiveTopology::TriangleStrip;
    restarting.primitive.primitive_restart = true;
    let restarting = RenderPipeline::new(&restarting, &Limits::default()).unwrap();
    let indices: Vec<u8> = (0..3_000_u32)
        .flat_map(|at| (at % 97 * 5).to_le_bytes())
        .collect();
    let indices = BufferData::from_bytes(&indices);
    let mut state = 7_u32;
    let mut below = |limit: u32| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) % limit
    };
    let mut draw = |large: u32| {
        let pipeline = &pipelines[below(2) as usize];
        let count = below(40);
        let mut draw = Draw::new(pipeline, 0..count);
        match below(large) {
            0 => draw.elements.end = 200_001,
            1 => draw.instances.end = 5_000,
            2 => {
                draw.pipeline = &restarting;
                draw.indices = Some((&indices, IndexFormat::Uint32));
            }
            // Sparse, unless they are few.
            3..30 => draw.indices = Some((&indices, IndexFormat::Uint32)),
            _ => {}
        }
        if below(20) == 0 {
            let x = below(3) * 20;
            draw.scissor = Some(ScissorRect {
                x,
                y: 0,
                width: 20,
                height: 30,
            });
        }
        draw.stencil_reference = [u8::from(below(9) == 0); 2];
        draw
    };
    // Small draws alone, of which whole parts are cut, and with others between them, where they
    // end.
    let cases = [
        (63, 3_000, 0),
        (150, 3_000, 8),
        (3_000, 3_000_000, 12),
        (3_000, 1_000, 12),
    ];
    for (count, large, least) in cases {
        let mut all: Vec<Draw<'_>> = (0..count).map(|_| draw(large)).collect();
        let (facts, states, parts) = facts_on(1, all[..].into());
        assert_eq!(parts, 0);
        assert!(
            facts.len() * 10 > all.len() * 8,
            "{} sub-draws",
            facts.len()
        );
        let becomes_several = |pair: &[Facts]| pair[0].0 == pair[1].0;
        assert_eq!(facts.windows(2).any(becomes_several), large == 1_000);
        for threads in [2, 5] {
            let of_threads = facts_on(threads, all[..].into());
            assert_eq!(of_threads.0, facts);
            assert_eq!(of_threads.1, states);
            // Two threads cut four parts at once.
            let least = least.min(threads * 2);
            assert!(of_threads.2 >= least, "{} parts", of_threads.2);
            assert!(least > 0 || of_threads.2 == 0);
        }
        let is_listed = facts.iter().any(|facts| facts.3.is_some());
        assert!(count < 3_000 || is_listed == (large == 1_000));
        // The same draws in several lists, whose ends are ends of parts.
        let whole = facts_on(3, all[..].into());
        let addresses: Vec<usize> = all
            .iter()
            .map(|draw| std::ptr::from_ref(draw).addr())
            .collect();
        let mut lists = vec![Vec::new()];
        for (number, draw) in all.drain(..).enumerate() {
            if number % 700 == 0 {
                lists.push(Vec::new());
            }
            lists.last_mut().unwrap().push(draw);
        }
        let of_lists = facts_on(3, DrawList::Parts(&lists));
        let now = lists
            .iter()
            .flatten()
            .map(|draw| std::ptr::from_ref(draw).addr());
        let before: std::collections::HashMap<usize, usize> = now.zip(addresses).collect();
        let found = of_lists
            .0
            .iter()
            .map(|facts| (before[&facts.0], facts.1, facts.2, facts.3.clone()));
        assert!(found.eq(whole.0));
    }
}
