//! Several colour targets of one pass, each with its own format, blending and write mask.

use crate::support::{device_with, texture};
use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::{
    BlendState, ColorTargetState, ColorWrites, PrimitiveTopology, VertexBufferLayout,
};
use estampe::{
    ColorAttachment, Draw, Level, PipelineError, RenderPass, RenderPipelineDescriptor,
    TextureFormat, Vec2, Vec4, VertexFormat, bytes_of,
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
    descriptor.depth_stencil = None;
    descriptor.vertex_buffers = vec![VertexBufferLayout::packed(&[VertexFormat::Float32x2])];
    descriptor.targets = vec![
        TextureFormat::Rgba8Unorm.into(),
        Some(ColorTargetState {
            write_mask: ColorWrites::COLOR,
            ..TextureFormat::Rgba8UnormSrgb.into()
        }),
        Some(ColorTargetState {
            blend: Some(BlendState::ALPHA_BLENDING),
            ..TextureFormat::Rgba8Unorm.into()
        }),
    ];
    descriptor
}

/// Rows: F1, O5, O7, O8.
#[test]
fn each_target_has_its_own_format_blending_and_mask() {
    let (width, height) = (70, 9);
    for level in Level::all_available() {
        for threads in [1, 2] {
            let device = device_with(threads, level);
            let pipeline = device
                .create_render_pipeline(&descriptor())
                .expect("it is valid");
            let targets = descriptor().targets;
            let images = targets
                .iter()
                .flatten()
                .map(|target| texture(&device, [width, height], target.format));
            let images: Vec<_> = images.collect();
            let corners: [f32; 8] = [-1.0, -1.0, 1.0, -1.0, -1.0, 1.0, 1.0, 1.0];
            let vertices = device.create_buffer_with_contents(bytes_of(&corners));
            let vertices = [vertices.expect("it is small").slice(..)];
            let draws = [Draw {
                vertex_buffers: &vertices,
                ..Draw::new(&pipeline, 0..4)
            }];
            let clear = [[0.0; 4], [1.0, 1.0, 1.0, 0.0], [1.0, 0.0, 0.0, 1.0]];
            let attachments = images.iter().zip(clear);
            let attachments = attachments
                .map(|(image, color)| Some(ColorAttachment::clear(&image.view(), color)));
            let pass = RenderPass {
                color_attachments: &attachments.collect::<Vec<_>>(),
                draws: &draws,
                ..RenderPass::default()
            };
            let statistics = device.render(&pass).expect("it fits");
            assert_eq!(statistics.fragments_shaded, u64::from(width * height));

            // 0.5 is code 128 (floor(127.5 + ½)), in sRGB 188. Target 1's alpha is masked. Target 2
            // blends half over red: (1·½, 0, ½·½, ½·1 + 1·½), 0.25 being code 64.
            let expected = [[128, 0, 0, 255], [0, 188, 0, 0], [128, 0, 64, 255]];
            for (index, expected) in expected.into_iter().enumerate() {
                let pixels = device.read_texture(&images[index]).expect("it can be read");
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

/// The colour of a number without attachment is dropped; the others keep their numbers.
#[test]
fn an_attachment_may_be_missing() {
    let device = device_with(1, Level::best());
    let corners: [f32; 8] = [-1.0, -1.0, 1.0, -1.0, -1.0, 1.0, 1.0, 1.0];
    let vertices = device.create_buffer_with_contents(bytes_of(&corners));
    let vertices = [vertices.expect("it is small").slice(..)];
    let seen = |missing: &[usize]| {
        let mut with_holes = descriptor();
        for index in missing {
            with_holes.targets[*index] = None;
        }
        let pipeline = device.create_render_pipeline(&with_holes);
        let pipeline = pipeline.expect("it is valid");
        let images: Vec<_> = descriptor()
            .targets
            .iter()
            .flatten()
            .map(|target| texture(&device, [70, 9], target.format))
            .collect();
        let attachments = images.iter().enumerate().map(|(index, image)| {
            let is_there = !missing.contains(&index);
            is_there.then(|| ColorAttachment::clear(&image.view(), [0.0; 4]))
        });
        let pass = RenderPass {
            color_attachments: &attachments.collect::<Vec<_>>(),
            draws: &[Draw {
                vertex_buffers: &vertices,
                ..Draw::new(&pipeline, 0..4)
            }],
            ..RenderPass::default()
        };
        device.render(&pass).expect("it fits");
        let bytes = images.iter().map(|image| device.read_texture(image));
        bytes
            .collect::<Result<Vec<_>, _>>()
            .expect("it can be read")
    };
    let all = seen(&[]);
    for missing in [&[0][..], &[1], &[2], &[0, 1], &[1, 2]] {
        let mut expected = all.clone();
        for index in missing {
            expected[*index].fill(0);
        }
        assert!(seen(missing) == expected, "without {missing:?}");
    }
}

#[test]
fn a_pipeline_names_the_rule_that_it_breaks() {
    let device = device_with(1, Level::best());
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
    assert_eq!(
        refused(|d| d.multisample.count = 3),
        PipelineError::SampleCount(3)
    );
    assert_eq!(
        refused(|d| d.vertex_buffers.clear()),
        PipelineError::LocationMissing(0)
    );
    assert_eq!(
        refused(|d| d.targets[1] = TextureFormat::Depth32Float.into()),
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
