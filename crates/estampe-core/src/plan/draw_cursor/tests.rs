//! Sub-draws and batches into which draws are cut, and what belongs to each.

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
