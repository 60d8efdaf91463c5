//! Attachments whose texels are not stored: they are zeros wherever they are read.

use crate::support::sampling::{FLAT, Turned, draw_over, sampled_group, sampling_pipeline};
use crate::support::{Fill, Images, clear, device, devices, f32s, read_layer, texture};
use estampe::state::{MultisampleState, ScissorRect};
use estampe::{
    AspectOperations, ColorAttachment, DepthStencilAttachment, Draw, LoadOp, RangeQueries,
    RenderPass, RenderPipelineDescriptor, StoreOp, TextureFormat,
};

#[test]
fn discarded_colors_are_zeros_wherever_they_are_read() {
    let white = [1.0; 4];
    for (name, device) in devices() {
        let format = TextureFormat::Rgba8Unorm;
        let image = texture(&device, [40, 21], format);
        let discard = || {
            let attachment = ColorAttachment {
                store: StoreOp::Discard,
                ..ColorAttachment::clear(&image.view(), white)
            };
            device
                .render(&RenderPass {
                    color_attachments: &[Some(attachment)],
                    ..RenderPass::default()
                })
                .unwrap();
        };
        let is_zero = |bytes: &[u8]| bytes.iter().all(|byte| *byte == 0);
        // By the host, at first and after it was white.
        discard();
        assert!(is_zero(&read_layer(&device, &image, 0, 0)), "{name}");
        clear(&device, &image.view(), white);
        assert!(!is_zero(&read_layer(&device, &image, 0, 0)), "{name}");
        discard();
        assert!(is_zero(&read_layer(&device, &image, 0, 0)), "{name}");
        // By a shader.
        clear(&device, &image.view(), white);
        discard();
        let target = texture(&device, [40, 21], format);
        clear(&device, &target.view(), white);
        let (layout, pipeline) = sampling_pipeline(&device, Turned, FLAT, format);
        draw_over(
            &device,
            &pipeline,
            &sampled_group(&device, &layout, &image.view()),
            &target.view(),
        );
        assert!(is_zero(&read_layer(&device, &target, 0, 0)), "{name}");
        // By a pass that loads.
        clear(&device, &image.view(), white);
        discard();
        device
            .render(&RenderPass {
                color_attachments: &[Some(ColorAttachment::load(&image.view()))],
                ..RenderPass::default()
            })
            .unwrap();
        assert!(is_zero(&read_layer(&device, &image, 0, 0)), "{name}");
    }
}

#[test]
fn depth_and_stencil_are_discarded_one_by_one() {
    let device = device();
    let format = TextureFormat::Depth32FloatStencil8;
    let image = texture(&device, [40, 21], format);
    let render = |depth: [StoreOp; 2]| {
        let [depth, stencil] = depth;
        device
            .render(&RenderPass {
                depth_stencil_attachment: Some(DepthStencilAttachment {
                    depth: AspectOperations::Write {
                        load: LoadOp::Clear(0.5),
                        store: depth,
                    },
                    stencil: AspectOperations::Write {
                        load: LoadOp::Clear(77),
                        store: stencil,
                    },
                    ..DepthStencilAttachment::load(&image.view())
                }),
                ..RenderPass::default()
            })
            .unwrap();
        let texels = read_layer(&device, &image, 0, 0);
        let texels = texels.as_chunks::<8>().0;
        assert!(texels.iter().all(|texel| *texel == texels[0]));
        (f32s(&texels[0][..4])[0], texels[0][4])
    };
    use StoreOp::{Discard, Store};
    assert_eq!(render([Store, Store]), (0.5, 77));
    assert_eq!(render([Discard, Store]), (0.0, 77));
    assert_eq!(render([Store, Discard]), (0.5, 0));
    assert_eq!(render([Discard, Discard]), (0.0, 0));
}

/// A near rectangle, and behind it one colour everywhere: what is kept is the same bytes whether
/// the depths, and the samples that are resolved, are kept or not, and whether they were cleared or
/// loaded. Only what is cleared and discarded lies in the memory of workers.
#[test]
fn what_is_kept_does_not_depend_on_what_is_discarded() {
    let (size, format) = ([200, 130], TextureFormat::Rgba8Unorm);
    for (name, device) in devices() {
        for samples in [1, 4, 8] {
            let images = Images::with(&device, size, format, samples);
            let image = texture(&device, size, format);
            let pipeline = |depth, color| {
                let descriptor = RenderPipelineDescriptor {
                    multisample: MultisampleState::new(samples),
                    ..RenderPipelineDescriptor::new(Fill { color, depth })
                };
                device.create_render_pipeline(&descriptor).unwrap()
            };
            let [near, far] = [
                pipeline(0.25, [1.0, 0.5, 0.0, 1.0]),
                pipeline(0.5, [0.0, 0.25, 1.0, 1.0]),
            ];
            let rectangle = ScissorRect {
                x: 30,
                y: 20,
                width: 90,
                height: 100,
            };
            let near = Draw {
                scissor: Some(rectangle),
                ..Draw::new(&near, 0..3)
            };
            let draws = [near, Draw::new(&far, 0..3)];
            let render =
                |loads: (LoadOp<[f64; 4]>, LoadOp<f32>), store, queries: Option<&RangeQueries>| {
                    let color = if samples == 1 {
                        ColorAttachment::clear(&image.view(), [0.0; 4])
                    } else {
                        ColorAttachment {
                            resolve_target: Some(image.view()),
                            store,
                            ..ColorAttachment::clear(&images.color.view(), [0.0; 4])
                        }
                    };
                    let depth = DepthStencilAttachment {
                        depth: AspectOperations::Write {
                            load: loads.1,
                            store,
                        },
                        ..images.cleared_depth()
                    };
                    let pass = RenderPass {
                        color_attachments: &[Some(ColorAttachment {
                            load: loads.0,
                            ..color
                        })],
                        depth_stencil_attachment: Some(depth),
                        range_queries: queries,
                        draws: &draws,
                        ..RenderPass::default()
                    };
                    let statistics = device.render(&pass).unwrap();
                    (device.read_texture(&image).unwrap(), statistics)
                };
            let cleared = (LoadOp::Clear([0.0, 1.0, 0.0, 1.0]), LoadOp::Clear(0.4));
            for clears_color in [true, false] {
                for clears_depth in [true, false] {
                    let loads = (
                        if clears_color {
                            cleared.0
                        } else {
                            LoadOp::Load
                        },
                        if clears_depth {
                            cleared.1
                        } else {
                            LoadOp::Load
                        },
                    );
                    let mut seen = Vec::new();
                    for store in [StoreOp::Store, StoreOp::Discard] {
                        render((cleared.0, LoadOp::Clear(1.0)), StoreOp::Store, None);
                        let (bytes, statistics) = render(loads, store, None);
                        let is_local = clears_depth || clears_color && samples > 1;
                        assert_eq!(
                            statistics.tiles_in_workers > 0,
                            is_local && store == StoreOp::Discard,
                            "{name}, {samples} samples, {loads:?}, {store:?}"
                        );
                        seen.push(bytes);
                        // The second part goes on where the first one ended.
                        render((cleared.0, LoadOp::Clear(1.0)), StoreOp::Store, None);
                        let parts = RangeQueries::new([0..1, 1..2]);
                        let (bytes, statistics) = render(loads, store, Some(&parts));
                        assert_eq!(statistics.tiles_in_workers, 0, "{name}");
                        seen.push(bytes);
                    }
                    let what = format!("{name}, {samples} samples, {loads:?}");
                    assert!(seen.iter().all(|bytes| *bytes == seen[0]), "{what}");
                    let colors = seen[0].as_chunks::<4>().0;
                    let near = colors.iter().filter(|color| **color == [255, 128, 0, 255]);
                    // Loaded depths are those of the same rectangle, which is as near then.
                    let is_shown = clears_depth || !clears_color;
                    assert_eq!(near.count(), if is_shown { 90 * 100 } else { 0 }, "{what}");
                }
            }
        }
    }
}

/// Images that a pass clears first and discards last have no memory, until a pass cannot keep a
/// tile of them in each worker: because it draws tiles twice, or because it ends with part of the
/// draws.
#[test]
fn images_take_memory_when_a_pass_needs_it() {
    let (size, format) = ([40, 21], TextureFormat::Rgba8Unorm);
    for (name, device) in devices() {
        let descriptor = RenderPipelineDescriptor {
            multisample: MultisampleState::new(4),
            ..RenderPipelineDescriptor::new(Fill {
                color: [1.0, 0.5, 0.0, 1.0],
                depth: 0.25,
            })
        };
        let pipeline = device.create_render_pipeline(&descriptor).unwrap();
        let resolved = texture(&device, size, format);
        let render = |images: &Images, draws: &[Draw<'_>], queries: Option<&RangeQueries>| {
            clear(&device, &resolved.view(), [0.0; 4]);
            let color = ColorAttachment {
                resolve_target: Some(resolved.view()),
                store: StoreOp::Discard,
                ..ColorAttachment::clear(&images.color.view(), [0.0; 4])
            };
            let depth = DepthStencilAttachment {
                depth: AspectOperations::Write {
                    load: LoadOp::Clear(1.0),
                    store: StoreOp::Discard,
                },
                ..images.cleared_depth()
            };
            let pass = RenderPass {
                color_attachments: &[Some(color)],
                depth_stencil_attachment: Some(depth),
                range_queries: queries,
                draws,
                ..RenderPass::default()
            };
            let statistics = device.render(&pass).unwrap();
            let colors = device.read_texture(&resolved).unwrap();
            let is_drawn = |color: &[u8; 4]| *color == [255, 128, 0, 255];
            assert!(colors.as_chunks().0.iter().all(is_drawn), "{name}");
            statistics.images_given_memory
        };
        let fresh = || Images::with(&device, size, format, 4);
        let (draw, images) = (Draw::new(&pipeline, 0..3), fresh());
        let draws = [draw.clone(), draw.clone()];
        for _ in 0..2 {
            assert_eq!(render(&images, &draws, None), 0, "{name}");
        }
        // A pass that loads sees zeros, although the other one has drawn.
        let pass = RenderPass {
            color_attachments: &[Some(ColorAttachment {
                resolve_target: Some(resolved.view()),
                ..ColorAttachment::load(&images.color.view())
            })],
            ..RenderPass::default()
        };
        device.render(&pass).unwrap();
        let colors = device.read_texture(&resolved).unwrap();
        assert!(colors.iter().all(|byte| *byte == 0), "{name}");
        // Only depth has no memory yet.
        let parts = RangeQueries::new([0..1, 1..2]);
        assert_eq!(render(&images, &draws, Some(&parts)), 1, "{name}");
        let images = fresh();
        assert_eq!(render(&images, &draws, Some(&parts)), 2, "{name}");
        assert_eq!(render(&images, &draws, Some(&parts)), 0, "{name}");
        // More vertices than a batch has.
        let draws = [Draw::new(&pipeline, 0..2_100_000), draw];
        assert_eq!(render(&fresh(), &draws, None), 2, "{name}");
    }
}
