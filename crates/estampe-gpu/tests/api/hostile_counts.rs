//! Draws of 2³² indices over a small buffer end at once, and draw the contents of the buffer.

use crate::support::Images;
use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::{BlendState, PrimitiveTopology, VertexBufferLayout};
use estampe::{
    Device, DeviceDescriptor, Draw, IndexFormat, Limits, RenderPipelineDescriptor, Vec2, Vec4,
    VertexFormat, bytes_of,
};

/// A translucent colour at a position in clip space.
struct Translucent;

estampe::shader! {
    impl Shader for Translucent {
        type Attributes<R: Real> = Vec2<R>;
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, at: Vec2<R>) -> VertexOut<R, ()> {
            let (zero, one) = (input.real(0.0), input.real(1.0));
            VertexOut::new(Vec4::new(at.x, at.y, zero, one), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, _: ()) -> FragmentOut<R> {
            let half = input.real(0.5);
            FragmentOut::color(Vec4::new(half, half, half, half))
        }
    }
}

#[test]
fn elements_beyond_the_index_buffer_show_nothing_and_take_no_time() {
    // As many elements as there are: nothing keeps them from being drawn but their being skipped.
    let device = Device::new(&DeviceDescriptor {
        limits: Limits {
            max_pass_vertices: u64::MAX,
            ..Limits::default()
        },
        ..DeviceDescriptor::default()
    })
    .unwrap();
    let corners: [f32; 12] = [
        -0.9, -0.8, 0.7, -0.6, 0.1, 0.9, -0.4, 0.3, 0.5, 0.5, -0.7, 0.6,
    ];
    let vertices = device.create_buffer_with_contents(bytes_of(&corners));
    let vertices = [vertices.unwrap().slice(..)];
    let bytes = [3, 0, 1, 0, 2, 0, 4, 0, 5, 0, 0, 0, 1, 0];
    let buffer = device.create_buffer_with_contents(&bytes).unwrap();
    let indices = buffer.slice(..);
    use PrimitiveTopology as T;
    for topology in [
        T::TriangleList,
        T::TriangleStrip,
        T::LineList,
        T::LineStrip,
        T::TriangleListAdjacency,
        T::TriangleStripAdjacency,
        T::LineStripAdjacency,
    ] {
        let mut descriptor = RenderPipelineDescriptor::new(Translucent);
        descriptor.vertex_buffers = vec![VertexBufferLayout::packed(&[VertexFormat::Float32x2])];
        descriptor.primitive.topology = topology;
        descriptor.depth_stencil = None;
        descriptor.targets[0].as_mut().unwrap().blend = Some(BlendState::ALPHA_BLENDING);
        let pipeline = device.create_render_pipeline(&descriptor).unwrap();
        let picture = |elements: std::ops::Range<u32>, format| {
            let images = Images::new(&device, 48, 48);
            let draws = [Draw {
                vertex_buffers: &vertices,
                index_buffer: Some((&indices, format)),
                instances: 0..2,
                ..Draw::new(&pipeline, elements)
            }];
            let statistics = images.draw(&device, &draws);
            (images.pixels(&device), statistics.primitives_in)
        };
        for (first, format) in [
            (0, IndexFormat::Uint16),
            (1, IndexFormat::Uint16),
            (2, IndexFormat::Uint8),
            (100, IndexFormat::Uint32),
        ] {
            // Thirty elements are more than the buffer holds, and few enough to be drawn one by
            // one.
            let (few, _) = picture(first..first + 30, format);
            let (all, primitives) = picture(first..u32::MAX, format);
            assert!(few == all, "{topology:?} {first} {format:?}");
            assert!(primitives > 1 << 30, "{topology:?}: {primitives}");
        }
    }
}
