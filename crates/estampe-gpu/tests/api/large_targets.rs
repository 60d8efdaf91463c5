//! Targets of the greatest sizes: pixels at their corners are drawn, and no other pixels.

use crate::support::{Images, device};
use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::{PrimitiveTopology, ScissorRect, VertexBufferLayout};
use estampe::{
    Draw, RenderPipelineDescriptor, TextureDescriptor, TextureFormat, Vec2, Vec4, VertexFormat,
    bytes_of,
};

/// White, at depth ½.
struct White;

estampe::shader! {
    impl Shader for White {
        type Attributes<R: Real> = Vec2<R>;
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, at: Vec2<R>) -> VertexOut<R, ()> {
            let (depth, w) = (input.real(0.5), input.real(1.0));
            VertexOut::new(Vec4::new(at.x, at.y, depth, w), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, _nothing: ()) -> FragmentOut<R> {
            let one = input.real(1.0);
            FragmentOut::color(Vec4::new(one, one, one, one))
        }
    }
}

/// Draws points at pixels' centres and, with a scissor, a rectangle over the whole target into the
/// pixel beside the last corner. Returns the white pixels and their depths.
fn drawn(width: u32, height: u32) -> Vec<([u32; 2], f32)> {
    let device = device();
    let (right, bottom) = (width - 1, height - 1);
    let corners = [[0, 0], [right, 0], [0, bottom], [right, bottom]];
    // Exact: sides are powers of two.
    let ndc = |pixel: u32, side: u32| (pixel as f32 + 0.5) / side as f32 * 2.0 - 1.0;
    let points: Vec<f32> = corners
        .iter()
        .flat_map(|&[x, y]| [ndc(x, width), -ndc(y, height)])
        .collect();
    let mut descriptor = RenderPipelineDescriptor::new(White);
    descriptor.vertex_buffers = vec![VertexBufferLayout::packed(&[VertexFormat::Float32x2])];
    descriptor.targets = vec![TextureFormat::R8Unorm.into()];
    descriptor.primitive.topology = PrimitiveTopology::PointList;
    let dots = device
        .create_render_pipeline(&descriptor)
        .expect("a valid pipeline");
    descriptor.primitive.topology = PrimitiveTopology::TriangleStrip;
    let filled = device
        .create_render_pipeline(&descriptor)
        .expect("a valid pipeline");
    let square: [f32; 8] = [-1.0, -1.0, 1.0, -1.0, -1.0, 1.0, 1.0, 1.0];
    let buffers = [&points[..], &square].map(|numbers| {
        let buffer = device.create_buffer_with_contents(bytes_of(numbers));
        buffer.expect("it is small").slice(..)
    });
    let draws = [
        Draw {
            vertex_buffers: &buffers[..1],
            ..Draw::new(&dots, 0..4)
        },
        Draw {
            vertex_buffers: &buffers[1..],
            scissor: Some(ScissorRect {
                x: right - 1,
                y: bottom,
                width: 1,
                height: 1,
            }),
            ..Draw::new(&filled, 0..4)
        },
    ];
    let images = Images::with(&device, [width, height], TextureFormat::R8Unorm, 1);
    images.draw(&device, &draws);
    let texels = images.pixels(&device);
    let depths = images.depths(&device);
    let (rows, depths) = (texels.chunks(width as usize), depths.chunks(width as usize));
    let mut white = Vec::new();
    for (y, (row, depths)) in (0..).zip(rows.zip(depths)) {
        for (x, (texel, depth)) in (0..).zip(row.iter().zip(depths)) {
            assert_eq!(*texel == 0, *depth == 1.0, "({x}, {y})");
            if *texel != 0 {
                white.push(([x, y], *depth));
            }
        }
    }
    white
}

fn check(width: u32, height: u32) {
    let (right, bottom) = (width - 1, height - 1);
    let expected = [
        [0, 0],
        [right, 0],
        [0, bottom],
        [right - 1, bottom],
        [right, bottom],
    ];
    assert_eq!(drawn(width, height), expected.map(|pixel| (pixel, 0.5)));
}

/// Rows: N1, R1, O2.
#[test]
fn corners_of_8192_by_8192_pixels() {
    check(8192, 8192);
}

/// Rows: N1, R1, O2.
#[test]
fn corners_of_the_longest_sides() {
    check(16_384, 16);
    check(16, 16_384);
}

/// Rows: N1.
#[test]
fn a_side_too_long_is_an_error_that_names_the_limit() {
    let size = TextureDescriptor::new_2d(16_385, 16, TextureFormat::R8Unorm);
    let refused = device().create_texture(&size);
    let message = refused.expect_err("too wide").to_string();
    assert!(
        message.contains("16385×16") && message.contains("16384"),
        "{message}"
    );
}
