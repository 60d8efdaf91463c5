//! Textures that are rendered to, sampled in the next pass, and rendered to again: the same bytes
//! at every SIMD level and with any number of threads.

use crate::support::sampling::{FLAT, Turned, draw_over, sampled_group, sampling_pipeline, turned};
use crate::support::{Fill, clear, devices, noise, read_layer, texture, write_level};
use estampe::state::ScissorRect;
use estampe::{
    BindGroup, ColorAttachment, Draw, Extent3d, RenderPass, RenderPipelineDescriptor,
    TexelCopyLayout, Texture, TextureDescriptor, TextureFormat, TextureViewDescriptor, srgb,
};

/// The host writes A; passes draw A into B, B into A and A into B; between them the host reads, and
/// changes a part.
#[test]
fn pictures_are_sampled_and_rendered_to_in_turn() {
    let size = [70, 45];
    for format in [TextureFormat::Rgba8Unorm, TextureFormat::Bgra8Unorm] {
        for (name, device) in devices() {
            let (layout, pipeline) = sampling_pipeline(&device, Turned, FLAT, format);
            let [a, b] = [0, 1].map(|_| texture(&device, size, format));
            let [from_a, from_b] =
                [&a, &b].map(|from| sampled_group(&device, &layout, &from.view()));
            let once_more = |bytes: &[u8]| turned(bytes, size, size, format.is_bgra());

            let first = noise(70 * 45 * 4, 7);
            write_level(&device, &a, 0, &first);
            draw_over(&device, &pipeline, &from_a, &b.view());
            draw_over(&device, &pipeline, &from_b, &a.view());
            let twice = once_more(&once_more(&first));
            assert!(
                device.read_texture(&a).unwrap() == twice,
                "{format:?}, {name}"
            );
            assert!(
                device.read_texture(&b).unwrap() == once_more(&first),
                "{format:?}, {name}"
            );

            // The host's texel is in what the next pass samples.
            let one = Extent3d::new_2d(1, 1);
            device
                .write_texture(&a, &[1, 2, 3, 4], &TexelCopyLayout::default(), one)
                .unwrap();
            let mut changed = twice.clone();
            changed[..4].copy_from_slice(&[1, 2, 3, 4]);
            draw_over(&device, &pipeline, &from_a, &b.view());
            assert!(
                device.read_texture(&b).unwrap() == once_more(&changed),
                "{format:?}, {name}"
            );
            // And in what the next pass draws over.
            device
                .render(&RenderPass {
                    color_attachments: &[Some(ColorAttachment::load(&a.view()))],
                    draws: &[Draw {
                        bind_groups: std::slice::from_ref(&from_b),
                        scissor: Some(ScissorRect {
                            x: 30,
                            y: 0,
                            width: 40,
                            height: 45,
                        }),
                        ..Draw::new(&pipeline, 0..3)
                    }],
                    ..RenderPass::default()
                })
                .unwrap();
            let over = once_more(&once_more(&changed));
            for (at, code) in device.read_texture(&a).unwrap().iter().enumerate() {
                let is_drawn = at / 4 % 70 >= 30;
                let expected = if is_drawn { &over } else { &changed };
                assert_eq!(*code, expected[at], "byte {at}, {format:?}, {name}");
            }
        }
    }
}

/// An image that shaders sampled before is stored in rows while it is drawn, and in tiles only if a
/// pass has loaded it.
#[test]
fn images_that_are_sampled_after_each_pass_are_stored_in_rows() {
    for (size, format) in [
        ([70, 45], TextureFormat::Rgba8Unorm),
        ([130, 129], TextureFormat::Bgra8Unorm),
        ([64, 128], TextureFormat::Rgba8Unorm),
    ] {
        for (name, device) in devices() {
            let (layout, pipeline) = sampling_pipeline(&device, Turned, FLAT, format);
            let [a, b, c] = [0, 1, 2].map(|_| texture(&device, size, format));
            let [from_a, from_b] =
                [&a, &b].map(|from| sampled_group(&device, &layout, &from.view()));
            let draw = |group: &BindGroup, into: &Texture, loads: bool| {
                let into = into.view();
                let attachment = match loads {
                    true => ColorAttachment::load(&into),
                    false => ColorAttachment::clear(&into, [0.0; 4]),
                };
                let pass = RenderPass {
                    color_attachments: &[Some(attachment)],
                    draws: &[Draw {
                        bind_groups: std::slice::from_ref(group),
                        ..Draw::new(&pipeline, 0..3)
                    }],
                    ..RenderPass::default()
                };
                device.render(&pass).unwrap()
            };
            let once_more = |bytes: &[u8]| turned(bytes, size, size, format.is_bgra());
            for frame in 0..5 {
                let what = format!("frame {frame}, {size:?}, {format:?}, {name}");
                let first = noise((size[0] * size[1] * 4) as usize, 7 + frame);
                write_level(&device, &a, 0, &first);
                let statistics = draw(&from_a, &b, frame == 2);
                let has_rows = frame > 0;
                assert_eq!(statistics.tiles_to_rows > 0, has_rows, "{what}");
                let has_tiles = frame == 0 || frame >= 2;
                assert_eq!(statistics.tiles_in_workers == 0, has_tiles, "{what}");
                let statistics = draw(&from_b, &c, false);
                assert_eq!(statistics.tiles_to_rows, 0, "{what}");
                let once = once_more(&first);
                assert!(device.read_texture(&b).unwrap() == once, "{what}");
                assert!(
                    device.read_texture(&c).unwrap() == once_more(&once),
                    "{what}"
                );
            }
        }
    }
}

/// Linear texels that are written and read as sRGB.
#[test]
fn an_srgb_view_of_a_linear_texture_encodes_and_decodes() {
    for format in [TextureFormat::Rgba8Unorm, TextureFormat::Bgra8Unorm] {
        let encoded = format.with_srgb(true);
        for (name, device) in devices() {
            let image = texture(&device, [9, 5], format);
            let srgb_view = image
                .create_view(&TextureViewDescriptor {
                    format: Some(encoded),
                    ..TextureViewDescriptor::default()
                })
                .unwrap();
            assert_eq!((srgb_view.format(), image.format()), (encoded, format));
            clear(&device, &srgb_view, [0.5; 4]);
            let texel = [188, 188, 188, 128];
            assert_eq!(
                read_layer(&device, &image, 0, 0),
                texel.repeat(45),
                "{name}"
            );
            let draws = device
                .create_render_pipeline(&RenderPipelineDescriptor {
                    depth_stencil: None,
                    targets: vec![encoded.into()],
                    ..RenderPipelineDescriptor::new(Fill {
                        color: [0.0, 0.5, 1.0, 0.5],
                        depth: 0.0,
                    })
                })
                .unwrap();
            device
                .render(&RenderPass {
                    color_attachments: &[Some(ColorAttachment::load(&srgb_view))],
                    draws: &[Draw::new(&draws, 0..3)],
                    ..RenderPass::default()
                })
                .unwrap();
            let mut texel = [0, 188, 255, 128];
            if format.is_bgra() {
                texel.swap(0, 2);
            }
            assert_eq!(
                read_layer(&device, &image, 0, 0),
                texel.repeat(45),
                "{name}"
            );

            // Sampled as they are, and decoded. `Turned` makes green the red.
            let target = texture(&device, [9, 5], TextureFormat::Rgba8Unorm);
            let (layout, pipeline) =
                sampling_pipeline(&device, Turned, FLAT, TextureFormat::Rgba8Unorm);
            draw_over(
                &device,
                &pipeline,
                &sampled_group(&device, &layout, &image.view()),
                &target.view(),
            );
            let plain = device.read_texture(&target).unwrap();
            assert_eq!(plain, [188, 255, 0, 128].repeat(45), "{name}");
            draw_over(
                &device,
                &pipeline,
                &sampled_group(&device, &layout, &srgb_view),
                &target.view(),
            );
            assert_eq!((srgb::decode(188) * 255.0 + 0.5).floor(), 128.0);
            let seen = device.read_texture(&target).unwrap();
            assert_eq!(seen, [128, 255, 0, 128].repeat(45), "{name}");
        }
    }
}

/// Each level is drawn from the one above, of the same texture.
#[test]
fn a_mip_level_is_rendered_from_another_one() {
    for (name, device) in devices() {
        let descriptor =
            TextureDescriptor::new_2d(64, 32, TextureFormat::Rgba8Unorm).with_all_levels();
        let image = device.create_texture(&descriptor).unwrap();
        assert_eq!(image.mip_level_count(), 7);
        let (layout, pipeline) = sampling_pipeline(&device, Turned, FLAT, image.format());
        let mut above = noise(64 * 32 * 4, 3);
        write_level(&device, &image, 0, &above);
        let mut all = vec![above.clone()];
        for level in 1..7 {
            let [from, into] = [level - 1, level].map(|level| image.image(level, 0).unwrap());
            draw_over(
                &device,
                &pipeline,
                &sampled_group(&device, &layout, &from),
                &into,
            );
            above = turned(&above, from.size(), into.size(), false);
            all.push(above.clone());
        }
        for (level, expected) in (0..).zip(&all) {
            assert!(
                read_layer(&device, &image, level, 0) == *expected,
                "level {level}, {name}"
            );
        }
    }
}
