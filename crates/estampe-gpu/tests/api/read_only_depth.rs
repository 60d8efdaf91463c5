//! Depth that a pass tests and leaves as it is: it may be sampled meanwhile.

use crate::support::sampling::{sampled_group, sampling_pipeline};
use crate::support::{Fill, Images, covering, device, devices};
use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::{CompareFunction, DepthState, ScissorRect};
use estampe::{
    ColorAttachment, DepthStencilAttachment, Device, Draw, RenderPass, RenderPipeline,
    RenderPipelineDescriptor, SampleType, TextureBindings, TextureFormat, Vec2, Vec4,
    ViewDimension,
};

/// The depths that binding 0 holds, as grey.
struct Grey {
    depth: f32,
}

estampe::shader! {
    impl Shader for Grey {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = ();
        const READS_POSITION: bool = true;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, ()> {
            let at: Vec2<R> = covering(&input);
            VertexOut::new(Vec4::new(at.x, at.y, input.real(self.depth), input.real(1.0)), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            let [x, y] = [input.position.x, input.position.y].map(|at| at.floor().to_int());
            let zero = x.splat(0);
            let depth = input.bindings.sampled_texture(0, 0).view().fetch([x, y, zero], zero, zero).x;
            FragmentOut::color(Vec4::new(depth, depth, depth, input.real(1.0)))
        }
    }
}

const LEFT: ScissorRect = ScissorRect {
    x: 0,
    y: 0,
    width: 20,
    height: 30,
};

/// A pipeline that writes one depth, and no colours.
fn depth_writer(device: &Device, depth: f32, format: TextureFormat) -> RenderPipeline {
    let fill = Fill {
        depth,
        ..Fill::WHITE
    };
    device
        .create_render_pipeline(&RenderPipelineDescriptor {
            targets: vec![format.into()],
            ..RenderPipelineDescriptor::new(fill)
        })
        .unwrap()
}

#[test]
fn depth_is_sampled_while_it_is_tested_read_only() {
    for (name, device) in devices() {
        let images = Images::new(&device, 50, 30);
        let half = depth_writer(&device, 0.5, TextureFormat::Rgba8Unorm);
        let draw = Draw {
            scissor: Some(LEFT),
            ..Draw::new(&half, 0..3)
        };
        images.draw(&device, &[draw]);

        let kind = (SampleType::Depth, ViewDimension::D2);
        let draw_grey = |depth: f32| {
            let (layout, pipeline) =
                sampling_pipeline(&device, Grey { depth }, kind, TextureFormat::Rgba8Unorm);
            let mut descriptor = pipeline.descriptor().clone();
            descriptor.depth_stencil = Some(
                DepthState {
                    compare: CompareFunction::Less,
                    write_enabled: false,
                }
                .into(),
            );
            let pipeline = device.create_render_pipeline(&descriptor).unwrap();
            let group = sampled_group(&device, &layout, &images.depth.view());
            let view = images.color.view();
            device
                .render(&RenderPass {
                    color_attachments: &[Some(ColorAttachment::clear(&view, [0.0; 4]))],
                    depth_stencil_attachment: Some(DepthStencilAttachment::read_only(
                        &images.depth.view(),
                    )),
                    draws: &[Draw {
                        bind_groups: std::slice::from_ref(&group),
                        ..Draw::new(&pipeline, 0..3)
                    }],
                    ..RenderPass::default()
                })
                .unwrap();
            images.pixels(&device)
        };
        let expected =
            |left: [u8; 4], right: [u8; 4]| [left.repeat(20), right.repeat(30)].concat().repeat(30);
        // Behind the left half, in front of all.
        assert!(draw_grey(0.75) == expected([0; 4], [255; 4]), "{name}");
        let grey = [128, 128, 128, 255];
        assert!(draw_grey(0.25) == expected(grey, [255; 4]), "{name}");
        let depths = images.depths(&device);
        assert!(
            depths
                .chunks(50)
                .all(|row| row[..20] == [0.5; 20] && row[20..] == [1.0; 30])
        );
    }
}

/// A pass that only tests depth leaves it as new as it was.
#[test]
fn a_read_only_pass_keeps_the_newest_depths() {
    let device = device();
    let images = Images::new(&device, 50, 30);
    let [half, quarter] =
        [0.5, 0.25].map(|depth| depth_writer(&device, depth, TextureFormat::Rgba8Unorm));
    images.draw(&device, &[Draw::new(&half, 0..3)]);
    assert!(images.depths(&device) == [0.5; 1500]);
    images.draw(&device, &[Draw::new(&quarter, 0..3)]);
    device
        .render(&RenderPass {
            depth_stencil_attachment: Some(DepthStencilAttachment::read_only(&images.depth.view())),
            ..RenderPass::default()
        })
        .unwrap();
    assert!(images.depths(&device) == [0.25; 1500]);
}
