//! Passes that do not fit their target: each is an error that names the draw, both sides and what
//! to do, and nothing is drawn or cleared.

use estampe::state::{CompareFunction, DepthState, StencilState, Viewport};
use estampe::{
    Device, DeviceDescriptor, Draw, FragmentIn, FragmentOut, LoadOp, OcclusionQueries, RenderPass,
    RenderPassError, RenderPipeline, RenderPipelineDescriptor, RenderTarget,
    RenderTargetDescriptor, TextureFormat, Vec4, VertexIn, VertexOut,
};

/// A white triangle over the whole target.
struct Cover;

estampe::shader! {
    impl Shader for Cover {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, ()> {
            let index = input.vertex_index.to_real();
            let x = R::select(index.eq(input.real(1.0)), input.real(3.0), input.real(-1.0));
            let y = R::select(index.eq(input.real(2.0)), input.real(3.0), input.real(-1.0));
            VertexOut::new(Vec4::new(x, y, input.zero, input.real(1.0)), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            FragmentOut::color(Vec4::repeat(input.real(1.0)))
        }
    }
}

fn device() -> Device {
    Device::new(&DeviceDescriptor::default()).unwrap()
}

fn pipeline(device: &Device, change: impl FnOnce(&mut RenderPipelineDescriptor)) -> RenderPipeline {
    let mut descriptor = RenderPipelineDescriptor::new(Cover);
    change(&mut descriptor);
    device.create_render_pipeline(&descriptor).unwrap()
}

fn target(device: &Device, change: impl FnOnce(&mut RenderTargetDescriptor)) -> RenderTarget {
    let mut descriptor = RenderTargetDescriptor::new(20, 10);
    change(&mut descriptor);
    device.create_render_target(&descriptor).unwrap()
}

/// The error of a pass of two draws, of which the first fits. The target must stay as it is.
fn error_of(device: &Device, target: &mut RenderTarget, pass: RenderPass<'_>) -> RenderPassError {
    let before = target.read_color(0);
    let error = device.render(target, &pass).unwrap_err();
    assert!(target.read_color(0) == before, "something was drawn");
    error
}

/// The error of a draw of a pipeline, in a pass without occlusion queries.
fn error_of_pipeline(target: &mut RenderTarget, pipeline: &RenderPipeline) -> String {
    let draws = [Draw::new(pipeline, 0..3)];
    let pass = RenderPass {
        draws: &draws,
        ..RenderPass::default()
    };
    error_of(&device(), target, pass).to_string()
}

#[test]
fn pipelines_of_other_samples() {
    let device = device();
    let (one, four) = (
        pipeline(&device, |_| ()),
        pipeline(&device, |descriptor| descriptor.samples = 4),
    );
    let mut target = target(&device, |_| ());
    let draws = [Draw::new(&one, 0..3), Draw::new(&four, 0..3)];
    let pass = RenderPass {
        load_colors: vec![LoadOp::Clear([1.0; 4])],
        draws: &draws,
        ..RenderPass::default()
    };
    assert_eq!(
        error_of(&device, &mut target, pass).to_string(),
        "draw 1: its pipeline has 4 samples per pixel and the render target 1; create the pipeline \
         with `samples: 1`"
    );
    // The first draw by itself fits.
    device.draw(&mut target, &draws[..1]).unwrap();
    assert!(target.read_color(0).iter().all(|&byte| byte == 255));
}

#[test]
fn pipelines_of_other_color_formats() {
    let device = device();
    let unorm = pipeline(&device, |_| ());
    let mut float = target(&device, |descriptor| {
        descriptor.color_formats = vec![TextureFormat::Rgba16Float, TextureFormat::R8Unorm];
    });
    assert_eq!(
        error_of_pipeline(&mut float, &unorm),
        "draw 0: its pipeline writes the colour formats [rgba8unorm] and the render target has \
         [rgba16float, r8unorm]; give the pipeline one target for each attachment, of the same format"
    );
}

#[test]
fn tests_of_what_the_target_lacks() {
    let device = device();
    let depth = pipeline(&device, |descriptor| {
        descriptor.depth = Some(DepthState {
            compare: CompareFunction::Less,
            write_enabled: true,
        });
    });
    let mut without = target(&device, |descriptor| descriptor.depth_stencil = None);
    assert_eq!(
        error_of_pipeline(&mut without, &depth),
        "draw 0: its pipeline has a depth test and the render target has no depth attachment; \
         create the target with a depth format or the pipeline without `depth`"
    );
    let stencil = pipeline(&device, |descriptor| {
        descriptor.stencil = Some(StencilState::default());
    });
    let mut depth_alone = target(&device, |_| ());
    assert_eq!(
        error_of_pipeline(&mut depth_alone, &stencil),
        "draw 0: its pipeline has a stencil test and the render target has no stencil attachment; \
         create the target with a stencil format or the pipeline without `stencil`"
    );
}

#[test]
fn viewports_beyond_the_guard_band() {
    let device = device();
    let (pipeline, mut target) = (pipeline(&device, |_| ()), target(&device, |_| ()));
    let whole = Viewport::of_target(20, 10);
    for wrong in [
        Viewport {
            x: f32::NAN,
            ..whole
        },
        Viewport {
            y: -32_769.0,
            ..whole
        },
        Viewport {
            width: 0.0,
            ..whole
        },
        Viewport {
            height: f32::INFINITY,
            ..whole
        },
        Viewport {
            min_depth: -0.1,
            ..whole
        },
        Viewport {
            max_depth: 1.5,
            ..whole
        },
    ] {
        let draws = [Draw {
            viewport: Some(wrong),
            ..Draw::new(&pipeline, 0..3)
        }];
        let pass = RenderPass {
            draws: &draws,
            ..RenderPass::default()
        };
        let error = error_of(&device, &mut target, pass);
        assert!(
            matches!(error, RenderPassError::Viewport { draw: 0, .. }),
            "{wrong:?}: {error}"
        );
    }
    let draws = [Draw {
        viewport: Some(Viewport {
            max_depth: 1.5,
            ..whole
        }),
        ..Draw::new(&pipeline, 0..3)
    }];
    let error = device.draw(&mut target, &draws).unwrap_err();
    assert_eq!(
        error.to_string(),
        "draw 0: the viewport is at (0, 0), 20x10 pixels large, with depths 0..1.5; its corner must \
         be in -32768..=32767, its sides above 0 and at most 32768, its depths in 0..=1"
    );
}

#[test]
fn occlusion_queries_that_the_pass_lacks() {
    let device = device();
    let (pipeline, mut target) = (pipeline(&device, |_| ()), target(&device, |_| ()));
    let draws = [Draw {
        occlusion_query: Some(2),
        ..Draw::new(&pipeline, 0..3)
    }];
    let queries = OcclusionQueries::new(2);
    let with = |occlusion_queries| RenderPass {
        occlusion_queries,
        draws: &draws,
        ..RenderPass::default()
    };
    for (queries, count) in [(None, 0), (Some(&queries), 2)] {
        assert_eq!(
            error_of(&device, &mut target, with(queries)).to_string(),
            format!(
                "draw 0: it counts samples for occlusion query 2 and the pass has {count} of them; \
                 set `RenderPass::occlusion_queries` to at least 3 queries"
            )
        );
    }
    let enough = OcclusionQueries::new(3);
    device.render(&mut target, &with(Some(&enough))).unwrap();
    assert_eq!(enough.samples_passed(2), 200);
}

#[test]
fn more_load_operations_than_attachments() {
    let device = device();
    let mut target = target(&device, |_| ());
    let pass = RenderPass {
        load_colors: vec![LoadOp::Clear([1.0; 4]); 2],
        ..RenderPass::default()
    };
    assert_eq!(
        error_of(&device, &mut target, pass).to_string(),
        "the pass has 2 colour load operations and the render target 1 colour attachments; drop \
         those beyond"
    );
}
