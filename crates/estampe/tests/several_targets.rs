//! Several colour targets of one pass, each with its own format, blending and write mask.

use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::{
    BlendState, ColorTargetState, ColorWrites, PrimitiveTopology, VertexBufferLayout,
};
use estampe::{
    Buffer, Device, DeviceDescriptor, Draw, Level, LoadOp, PipelineError, RenderPass,
    RenderPipelineDescriptor, RenderTargetDescriptor, TextureFormat, Vec2, Vec4, VertexFormat,
};

/// Writes half red to target 0, half green to target 1, half blue to target 2.
struct Primaries;

estampe::shader! {
    impl Shader for Primaries {
        type Attributes<R: Real> = Vec2<R>;
        type Varyings<R: Real> = Vec2<R>;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, at: Vec2<R>) -> VertexOut<R, Vec2<R>> {
            let (depth, w) = (input.real(0.5), input.real(1.0));
            VertexOut::new(Vec4::new(at.x, at.y, depth, w), at)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, _at: Vec2<R>) -> FragmentOut<R> {
            let (zero, half, one) = (input.real(0.0), input.real(0.5), input.real(1.0));
            FragmentOut::color(Vec4::new(half, zero, zero, one))
                .with_color(1, Vec4::new(zero, half, zero, one))
                .with_color(2, Vec4::new(zero, zero, half, half))
        }
    }
}

fn descriptor() -> RenderPipelineDescriptor {
    let mut descriptor = RenderPipelineDescriptor::new(Primaries);
    descriptor.primitive.topology = PrimitiveTopology::TriangleStrip;
    descriptor.vertex_buffers = vec![VertexBufferLayout::packed(&[VertexFormat::Float32x2])];
    descriptor.targets = vec![
        TextureFormat::Rgba8Unorm.into(),
        ColorTargetState {
            write_mask: ColorWrites::COLOR,
            ..TextureFormat::Rgba8UnormSrgb.into()
        },
        ColorTargetState {
            blend: Some(BlendState::ALPHA_BLENDING),
            ..TextureFormat::Rgba8Unorm.into()
        },
    ];
    descriptor
}

fn device(threads: usize, level: Level) -> Device {
    let descriptor = DeviceDescriptor {
        threads,
        level,
        ..DeviceDescriptor::default()
    };
    Device::new(&descriptor).expect("the system starts one or two threads")
}

/// Rows: F1, O5, O7, O8.
#[test]
fn each_target_has_its_own_format_blending_and_mask() {
    let (width, height) = (70, 9);
    for level in Level::all_available() {
        for threads in [1, 2] {
            let device = device(threads, level);
            let pipeline = device
                .create_render_pipeline(&descriptor())
                .expect("it is valid");
            let formats = descriptor()
                .targets
                .iter()
                .map(|target| target.format)
                .collect();
            let mut target = device
                .create_render_target(&RenderTargetDescriptor {
                    color_formats: formats,
                    ..RenderTargetDescriptor::new(width, height)
                })
                .expect("it is small");
            let corners = [-1.0, -1.0, 1.0, -1.0, -1.0, 1.0, 1.0, 1.0];
            let vertices = [Buffer::from_f32s(&corners)];
            let draws = [Draw {
                vertex_buffers: &vertices,
                ..Draw::new(&pipeline, 0..4)
            }];
            let clear = vec![[0.0; 4], [1.0, 1.0, 1.0, 0.0], [1.0, 0.0, 0.0, 1.0]];
            let pass = RenderPass {
                load_colors: clear.into_iter().map(LoadOp::Clear).collect(),
                draws: &draws,
                ..RenderPass::default()
            };
            let statistics = device.render(&mut target, &pass).expect("it fits");
            assert_eq!(statistics.fragments_shaded, u64::from(width * height));

            // 0.5 is code 128 (floor(127.5 + ½)), in sRGB 188. Target 1's alpha is masked. Target 2
            // blends half over red: (1·½, 0, ½·½, ½·1 + 1·½), 0.25 being code 64.
            let expected = [[128, 0, 0, 255], [0, 188, 0, 0], [128, 0, 64, 255]];
            for (index, expected) in expected.into_iter().enumerate() {
                let pixels = target.read_color(index);
                assert_eq!(pixels.len(), (width * height * 4) as usize);
                for pixel in pixels.chunks_exact(4) {
                    assert_eq!(
                        pixel, expected,
                        "target {index}, {level:?}, {threads} threads"
                    );
                }
            }
        }
    }
}

#[test]
fn a_pipeline_names_the_rule_that_it_breaks() {
    let device = device(1, Level::best());
    let refused = |change: fn(&mut RenderPipelineDescriptor)| {
        let mut descriptor = descriptor();
        change(&mut descriptor);
        device
            .create_render_pipeline(&descriptor)
            .expect_err("the rule is broken")
    };
    assert_eq!(
        refused(|d| d.targets.truncate(2)),
        PipelineError::TargetCount {
            shader: 3,
            pipeline: 2
        }
    );
    assert_eq!(refused(|d| d.samples = 3), PipelineError::SampleCount(3));
    assert_eq!(
        refused(|d| d.vertex_buffers.clear()),
        PipelineError::LocationMissing(0)
    );
    assert_eq!(
        refused(|d| d.targets[1].format = TextureFormat::Depth32Float),
        PipelineError::NotRenderable {
            index: 1,
            format: TextureFormat::Depth32Float
        }
    );
    let stride = refused(|d| d.vertex_buffers[0].array_stride = 4);
    assert!(matches!(
        stride,
        PipelineError::AttributeBeyondStride {
            end: 8,
            stride: 4,
            ..
        }
    ));
    let twice = refused(|d| {
        let again = d.vertex_buffers[0].clone();
        d.vertex_buffers.push(again);
    });
    assert_eq!(twice, PipelineError::LocationTwice(0));
}
