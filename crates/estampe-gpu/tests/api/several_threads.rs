//! A device that several threads of a program share: passes wait for each other's textures, none
//! for ever, and draw what they draw alone.

use crate::support::{Fill, device_with, noise, texture};
use estampe::{
    BlitRegion, ColorAttachment, Device, Draw, FilterMode, RenderPass, RenderPipelineDescriptor,
    Texture, TextureFormat,
};

fn copy(device: &Device, from: &Texture, into: &Texture) {
    let (from, into) = (from.view(), into.view());
    let all: BlitRegion<'_> = (&into).into();
    device.blit(&from, all, FilterMode::Nearest).unwrap();
}

#[test]
fn threads_copy_textures_to_and_fro() {
    let device = device_with(2, estampe::Level::best());
    let size = [70, 40];
    let [a, b] = [0, 1].map(|_| texture(&device, size, TextureFormat::Rgba8Unorm));
    let bytes = noise(70 * 40 * 4, 4);
    for image in [&a, &b] {
        let layout = estampe::TexelCopyLayout::default();
        device
            .write_texture(image, &bytes, &layout, image.size())
            .unwrap();
    }
    std::thread::scope(|scope| {
        for (from, into) in [(&a, &b), (&b, &a), (&a, &b), (&b, &a)] {
            let device = &device;
            scope.spawn(move || {
                for round in 0..40 {
                    copy(device, from, into);
                    if round % 8 == 0 {
                        let all = into.size();
                        device.copy_texture_to_texture(into, from, all).unwrap();
                        device.read_texture(from).unwrap();
                    }
                }
            });
        }
    });
    assert!(device.read_texture(&a).unwrap() == bytes);
    assert!(device.read_texture(&b).unwrap() == bytes);
}

/// Passes into one image are drawn one after the other: each picture is of one colour.
#[test]
fn passes_into_one_image_do_not_mix() {
    let device = device_with(2, estampe::Level::best());
    let image = texture(&device, [130, 70], TextureFormat::Rgba8Unorm);
    let colors = [0.2, 0.4, 0.6, 0.8];
    std::thread::scope(|scope| {
        for color in colors {
            let (device, image) = (&device, &image);
            scope.spawn(move || {
                let fill = Fill {
                    color: [color; 4],
                    depth: 0.0,
                };
                let descriptor = RenderPipelineDescriptor {
                    depth_stencil: None,
                    ..RenderPipelineDescriptor::new(fill)
                };
                let pipeline = device.create_render_pipeline(&descriptor).unwrap();
                for _ in 0..20 {
                    device
                        .render(&RenderPass {
                            color_attachments: &[Some(ColorAttachment::load(&image.view()))],
                            draws: &[Draw::new(&pipeline, 0..3)],
                            ..RenderPass::default()
                        })
                        .unwrap();
                    let bytes = device.read_texture(image).unwrap();
                    assert!(bytes.iter().all(|byte| *byte == bytes[0]));
                    assert!([51, 102, 153, 204].contains(&bytes[0]));
                }
            });
        }
    });
}
