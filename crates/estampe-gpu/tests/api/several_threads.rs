//! A device that several threads of a program share: passes wait for each other's textures, none
//! for ever, and draw what they draw alone.

use crate::support::sampling::{FLAT, Turned, sampled_group, sampling_pipeline, turned};
use crate::support::{Fill, device_with, noise, texture};
use estampe::{
    BindGroup, BlitRegion, ColorAttachment, Device, Draw, FilterMode, PassControl, RenderPass,
    RenderPipeline, RenderPipelineDescriptor, Texture, TextureFormat,
};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex};
use std::time::Duration;

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

/// Draws over an image with a shader that samples another one; `inside` is called in the pass.
fn draw_sampling(
    device: &Device,
    (pipeline, group): (&RenderPipeline, &BindGroup),
    into: &Texture,
    inside: &(dyn Fn(usize, usize) + Sync),
) {
    device
        .render(&RenderPass {
            color_attachments: &[Some(ColorAttachment::clear(&into.view(), [0.0; 4]))],
            draws: &[Draw {
                bind_groups: std::slice::from_ref(group),
                ..Draw::new(pipeline, 0..3)
            }],
            control: PassControl {
                progress: Some(inside),
                ..PassControl::default()
            },
            ..RenderPass::default()
        })
        .unwrap();
}

/// A texture of noise, and its bytes.
fn noisy(device: &Device, size: [u32; 2]) -> (Texture, Vec<u8>) {
    let image = texture(device, size, TextureFormat::Rgba8Unorm);
    let bytes = noise((size[0] * size[1] * 4) as usize, 9);
    let layout = estampe::TexelCopyLayout::default();
    device
        .write_texture(&image, &bytes, &layout, image.size())
        .unwrap();
    (image, bytes)
}

/// Three passes that sample one texture are in their middles at the same time: each waits there for
/// the others.
#[test]
fn passes_that_read_one_texture_share_it() {
    const PASSES: usize = 3;
    let device = device_with(1, estampe::Level::best());
    let size = [70, 40];
    let (from, bytes) = noisy(&device, size);
    let (layout, pipeline) = sampling_pipeline(&device, Turned, FLAT, TextureFormat::Rgba8Unorm);
    let group = sampled_group(&device, &layout, &from.view());
    let (arrived, all_are_here) = (Mutex::new(0), Condvar::new());
    let meet = |_: usize, _: usize| {
        let mut arrived = arrived.lock().unwrap();
        *arrived += 1;
        all_are_here.notify_all();
        let missing = |arrived: &mut usize| *arrived < PASSES;
        let waited = all_are_here.wait_timeout_while(arrived, Duration::from_secs(60), missing);
        let (arrived, _) = waited.unwrap();
        assert!(*arrived >= PASSES, "the others wait for the texture");
    };
    std::thread::scope(|scope| {
        for _ in 0..PASSES {
            scope.spawn(|| {
                let into = texture(&device, size, TextureFormat::Rgba8Unorm);
                draw_sampling(&device, (&pipeline, &group), &into, &meet);
                let drawn = device.read_texture(&into).unwrap();
                assert!(drawn == turned(&bytes, size, size, false));
            });
        }
    });
    assert!(*arrived.lock().unwrap() >= PASSES);
}

/// While a pass renders to a texture no other one samples it, and the other way round.
#[test]
fn a_texture_that_is_rendered_to_is_not_read() {
    let device = device_with(1, estampe::Level::best());
    let size = [70, 40];
    let images = [(); 2].map(|()| noisy(&device, size).0);
    let (layout, pipeline) = sampling_pipeline(&device, Turned, FLAT, TextureFormat::Rgba8Unorm);
    let groups = images
        .each_ref()
        .map(|image| sampled_group(&device, &layout, &image.view()));
    // Of each image: readers, and writers.
    let users = [(); 2].map(|()| [(); 2].map(|()| AtomicUsize::new(0)));
    let draw = |from: usize, into: usize| {
        draw_sampling(
            &device,
            (&pipeline, &groups[from]),
            &images[into],
            &|_, _| {
                let (reads, writes) = (&users[from][0], &users[into][1]);
                reads.fetch_add(1, Ordering::SeqCst);
                assert_eq!(writes.fetch_add(1, Ordering::SeqCst), 0, "another writes");
                std::thread::sleep(Duration::from_millis(1));
                assert_eq!(users[into][0].load(Ordering::SeqCst), 0, "another reads");
                assert_eq!(users[from][1].load(Ordering::SeqCst), 0, "another writes");
                writes.fetch_sub(1, Ordering::SeqCst);
                reads.fetch_sub(1, Ordering::SeqCst);
            },
        );
    };
    std::thread::scope(|scope| {
        for (from, into) in [(0, 1), (1, 0), (0, 1)] {
            let draw = &draw;
            scope.spawn(move || (0..20).for_each(|_| draw(from, into)));
        }
    });
}
