//! The largest targets.

use estampe::{
    Device, DeviceDescriptor, Draw, RenderPass, RenderPipelineDescriptor, RenderTargetDescriptor,
};
use estampe_tests::geometry::{Style, Vertex, clip_at, triangles};
use estampe_tests::shaders::{Colored, Crowded};
use estampe_tests::{Case, CaseDraw, Random, check, check_some};
use estampe_types::Buffer;
use estampe_types::state::DepthState;

/// Rows: L, R1.
#[test]
fn the_longest_sides() {
    for size in [[16_384, 4], [4, 16_384], [16_383, 3]] {
        let mut random = Random::new("limits/sides", u64::from(size[0]));
        let mut case = Case::new(size, 1);
        let mut vertices = triangles(&mut random, Style::Large, size, 3);
        // At both ends.
        let ends = [[0.0, 0.0], size.map(|side| side as f32)];
        for [x, y] in ends {
            for [dx, dy] in [[-3.0, -3.0], [-3.0, 3.5], [3.5, -3.0]] {
                vertices.push(Vertex {
                    position: clip_at(size, [x + dx, y + dy], 0.25, 1.0),
                    values: [1.0, 0.5, 0.25, 1.0],
                });
            }
        }
        case.draws.push(CaseDraw::new(Colored, &vertices));
        check_some("limits/sides", &case);
    }
}

/// Rows: L, V1, V2.
#[test]
fn all_attributes_of_all_buffers_and_all_varyings() {
    check("limits/inputs", 20, |random| {
        let mut case = Case::random_target(random);
        let style = random.pick(&[Style::Large, Style::Small, Style::AroundEye]);
        let vertices = triangles(random, style, case.size, 4);
        let mut draw = CaseDraw::new(Crowded, &vertices);
        // Two attributes in each of eight buffers; the first buffer's are position and values.
        for buffer in 1..8 {
            let mut layout = draw.buffers[0].0.clone();
            for attribute in &mut layout.attributes {
                attribute.shader_location += 2 * buffer;
            }
            let values = vertices.iter().flat_map(|_| [0; 8].map(|_| random.unit()));
            let values: Vec<f32> = values.collect();
            draw.buffers.push((layout, Buffer::from_f32s(&values)));
        }
        case.draws.push(draw);
        case
    });
}

/// Rows: L.
#[test]
fn the_corners_of_a_target_of_8192_by_8192() {
    const SIDE: u32 = 8192;
    let device = Device::new(&DeviceDescriptor::default()).expect("a device");
    let mut target = device
        .create_render_target(&RenderTargetDescriptor {
            depth_stencil: None,
            ..RenderTargetDescriptor::new(SIDE, SIDE)
        })
        .expect("8192 is guaranteed");
    // A square of two pixels, of two triangles, in each corner and in the middle.
    let places = [
        [0, 0],
        [SIDE - 2, 0],
        [0, SIDE - 2],
        [SIDE - 2, SIDE - 2],
        [4095, 4095],
    ];
    let square = |[x, y]: [u32; 2]| {
        [[0, 0], [0, 2], [2, 0], [2, 0], [0, 2], [2, 2]].map(|[dx, dy]: [u32; 2]| Vertex {
            position: clip_at([SIDE; 2], [(x + dx) as f32, (y + dy) as f32], 0.5, 1.0),
            values: [1.0; 4],
        })
    };
    let vertices: Vec<_> = places.into_iter().flat_map(square).collect();
    let draw = CaseDraw::new(Colored, &vertices);
    let pipeline = device
        .create_render_pipeline(&RenderPipelineDescriptor {
            vertex_buffers: draw
                .buffers
                .iter()
                .map(|(layout, _)| layout.clone())
                .collect(),
            depth: None::<DepthState>,
            ..RenderPipelineDescriptor::with_program(draw.shader.program())
        })
        .expect("a valid pipeline");
    let buffers = [draw.buffers[0].1.clone()];
    let draws = [Draw {
        vertex_buffers: &buffers,
        ..Draw::new(&pipeline, draw.elements)
    }];
    device.render(
        &mut target,
        &RenderPass {
            draws: &draws,
            ..RenderPass::default()
        },
    );
    let color = target.read_color(0);
    let (pixels, _) = color.as_chunks::<4>();
    let drawn: Vec<_> = (0u32..)
        .zip(pixels)
        .filter(|(_, pixel)| **pixel != [0; 4])
        .collect();
    let wanted = |[x, y]: [u32; 2]| [0, 1].map(|dy| [0, 1].map(|dx| (y + dy) * SIDE + x + dx));
    let mut wanted: Vec<_> = places
        .into_iter()
        .flat_map(|place| wanted(place).concat())
        .collect();
    wanted.sort_unstable();
    assert!(drawn.iter().all(|(_, pixel)| **pixel == [255; 4]));
    let drawn: Vec<_> = drawn.into_iter().map(|(at, _)| at).collect();
    assert_eq!(drawn, wanted);
}
