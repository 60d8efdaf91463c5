//! Passes whose draws do not fit their attachments: each is an error that names the draw, both
//! sides and what to do, and nothing is drawn, cleared, discarded or resolved.

use crate::support::{Fill, Images, clear, device, texture};
use estampe::state::{CompareFunction, DepthState, StencilState, Viewport};
use estampe::{
    ColorAttachment, DepthStencilAttachment, Device, Draw, DrawError, OcclusionQueries,
    PassErrorKind, RenderPass, RenderPassError, RenderPipeline, RenderPipelineDescriptor, StoreOp,
    TextureFormat,
};

fn pipeline(device: &Device, change: impl FnOnce(&mut RenderPipelineDescriptor)) -> RenderPipeline {
    let mut descriptor = RenderPipelineDescriptor::new(Fill::WHITE);
    change(&mut descriptor);
    device.create_render_pipeline(&descriptor).unwrap()
}

fn images(device: &Device) -> Images {
    let images = Images::new(device, 20, 10);
    images.draw(device, &[]);
    images
}

/// The error of draws into images, which must stay as they are.
fn error_of(device: &Device, images: &Images, pass: RenderPass<'_>) -> RenderPassError {
    let read = || (images.pixels(device), images.depths(device));
    let before = read();
    let mut discarded = ColorAttachment::clear(&images.color.view(), [1.0; 4]);
    discarded.store = StoreOp::Discard;
    let error = device
        .render(&RenderPass {
            color_attachments: &[Some(discarded)],
            depth_stencil_attachment: Some(DepthStencilAttachment::clear(
                &images.depth.view(),
                0.25,
            )),
            ..pass
        })
        .unwrap_err();
    assert!(read() == before, "something was drawn: {error}");
    error
}

/// The message of one draw of a pipeline into a pass of these attachments.
fn message(
    device: &Device,
    pipeline: &RenderPipeline,
    colors: &[Option<ColorAttachment>],
    depth_stencil_attachment: Option<DepthStencilAttachment>,
) -> String {
    let pass = RenderPass {
        color_attachments: colors,
        depth_stencil_attachment,
        draws: &[Draw::new(pipeline, 0..3)],
        ..RenderPass::default()
    };
    device.render(&pass).unwrap_err().to_string()
}

#[test]
fn pipelines_of_other_samples() {
    let device = device();
    let (one, four) = (
        pipeline(&device, |_| ()),
        pipeline(&device, |descriptor| descriptor.multisample.count = 4),
    );
    let images = images(&device);
    let draws = [Draw::new(&one, 0..3), Draw::new(&four, 0..3)];
    let pass = RenderPass {
        label: Some("main"),
        draws: &draws,
        ..RenderPass::default()
    };
    assert_eq!(
        error_of(&device, &images, pass).to_string(),
        "the pass `main`: draw 1: its pipeline has 4 samples per pixel and the pass 1; \
         create the pipeline with `multisample.count` 1"
    );
    // The first draw by itself fits.
    images.draw(&device, &draws[..1]);
    assert!(images.pixels(&device).iter().all(|&byte| byte == 255));
}

/// The texels that the host wrote stay, also where a pass that clears has an image of its own.
#[test]
fn a_refused_pass_keeps_what_the_host_wrote() {
    let device = device();
    let images = images(&device);
    let bytes = crate::support::noise(20 * 10 * 4, 1);
    let layout = estampe::TexelCopyLayout::default();
    let size = images.color.size();
    device
        .write_texture(&images.color, &bytes, &layout, size)
        .unwrap();
    let four = pipeline(&device, |descriptor| descriptor.multisample.count = 4);
    let pass = RenderPass {
        draws: &[Draw::new(&four, 0..3)],
        ..RenderPass::default()
    };
    error_of(&device, &images, pass);
    assert!(images.pixels(&device) == bytes);
}

#[test]
fn a_refused_pass_resolves_nothing() {
    let device = device();
    let samples = Images::with(&device, [20, 10], TextureFormat::Rgba8Unorm, 4);
    let image = texture(&device, [20, 10], TextureFormat::Rgba8Unorm);
    clear(&device, &image.view(), [0.2, 0.4, 0.6, 0.8]);
    let one = pipeline(&device, |_| ());
    let color = ColorAttachment {
        resolve_target: Some(image.view()),
        ..ColorAttachment::clear(&samples.color.view(), [1.0; 4])
    };
    let depth = samples.cleared_depth();
    assert_eq!(
        message(&device, &one, &[Some(color)], Some(depth)),
        "the pass: draw 0: its pipeline has 1 samples per pixel and the pass 4; create \
         the pipeline with `multisample.count` 4"
    );
    let bytes = device.read_texture(&image).unwrap();
    assert!(
        bytes
            .as_chunks::<4>()
            .0
            .iter()
            .all(|texel| *texel == [51, 102, 153, 204])
    );
}

#[test]
fn pipelines_of_other_color_formats() {
    let device = device();
    let unorm = pipeline(&device, |descriptor| descriptor.depth_stencil = None);
    let colors = [TextureFormat::Rgba16Float, TextureFormat::R8Unorm].map(|format| {
        let image = texture(&device, [20, 10], format);
        Some(ColorAttachment::load(&image.view()))
    });
    assert_eq!(
        message(&device, &unorm, &colors, None),
        "the pass: draw 0: its pipeline writes the colour formats [rgba8unorm] and the pass \
         has [rgba16float, r8unorm]; give the pipeline one target for each attachment, of the \
         same format"
    );
}

#[test]
fn tests_of_what_the_pass_lacks() {
    let device = device();
    let images = images(&device);
    let color = [Some(ColorAttachment::load(&images.color.view()))];
    let depth = pipeline(&device, |descriptor| {
        descriptor.depth_stencil = Some(
            DepthState {
                compare: CompareFunction::Less,
                write_enabled: true,
            }
            .into(),
        );
    });
    assert_eq!(
        message(&device, &depth, &color, None),
        "the pass: draw 0: its pipeline has a depth test and the pass has no depth \
         attachment; attach one with a depth format or create the pipeline without `depth_stencil`"
    );
    let stencil = pipeline(&device, |descriptor| {
        descriptor.depth_stencil.get_or_insert_default().stencil = Some(StencilState::default());
    });
    assert_eq!(
        message(&device, &stencil, &color, Some(images.cleared_depth())),
        "the pass: draw 0: its pipeline has a stencil test and the pass has no stencil \
         attachment; attach one with a stencil format or create the pipeline without `depth_stencil.stencil`"
    );
}

#[test]
fn viewports_beyond_the_guard_band() {
    let device = device();
    let (pipeline, images) = (pipeline(&device, |_| ()), images(&device));
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
        let error = error_of(&device, &images, pass);
        assert!(
            matches!(
                error.kind,
                PassErrorKind::Draw(DrawError::Viewport { draw: 0, .. })
            ),
            "{wrong:?}: {error}"
        );
        assert!(
            wrong.max_depth < 1.5
                || error.to_string()
                    == "the pass: draw 0: the viewport is at (0, 0), 20x10 pixels large, with \
                        depths 0..1.5; its corner must be in -32768..=32767, its sides above 0 and \
                        at most 32768, its depths in 0..=1"
        );
    }
}

#[test]
fn occlusion_queries_that_the_pass_lacks() {
    let device = device();
    let (pipeline, images) = (pipeline(&device, |_| ()), images(&device));
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
            error_of(&device, &images, with(queries)).to_string(),
            format!(
                "the pass: draw 0: it counts samples for occlusion query 2 and the pass has \
                 {count} of them; set `RenderPass::occlusion_queries` to at least 3 queries"
            )
        );
    }
    let enough = OcclusionQueries::new(3);
    device
        .render(&RenderPass {
            color_attachments: &[Some(ColorAttachment::load(&images.color.view()))],
            depth_stencil_attachment: Some(images.cleared_depth()),
            ..with(Some(&enough))
        })
        .unwrap();
    assert_eq!(enough.samples_passed(2), 200);
}
