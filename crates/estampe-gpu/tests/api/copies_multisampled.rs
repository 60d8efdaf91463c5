//! Copies of multisampled textures: whole images with every sample, and errors otherwise.

use crate::support::{device, noise};
use estampe::{
    ColorAttachment, CopyError, DepthStencilAttachment, Device, Extent3d, RenderPass,
    TexelCopyLayout, Texture, TextureAspect, TextureCopy, TextureDescriptor, TextureError,
    TextureFormat, TextureViewDescriptor,
};

const SIZE: Extent3d = Extent3d {
    width: 70,
    height: 19,
    depth_or_array_layers: 2,
};

fn descriptor(format: TextureFormat, samples: u32) -> TextureDescriptor<'static> {
    TextureDescriptor {
        sample_count: samples,
        size: SIZE,
        ..TextureDescriptor::new_2d(1, 1, format)
    }
}

/// A texture whose samples all differ.
fn noisy(device: &Device, format: TextureFormat, samples: u32) -> Texture {
    let len = 70 * 19 * 2 * samples * format.block_bytes();
    let bytes = noise(len as usize, samples);
    device
        .create_texture_with_data(&descriptor(format, samples), &[&bytes])
        .unwrap()
}

/// Renders to a layer without draws, so that its newest texels are in tiles.
fn render(device: &Device, texture: &Texture, layer: u32) {
    let view = texture.image(0, layer).unwrap();
    let is_color = texture.format().is_color();
    let color = [is_color.then(|| ColorAttachment::load(&view))];
    let depth = (!is_color).then(|| DepthStencilAttachment::load(&view));
    device
        .render(&RenderPass {
            color_attachments: &color,
            depth_stencil_attachment: depth,
            ..RenderPass::default()
        })
        .unwrap();
}

/// Every sample of an aspect of a layer.
fn samples(device: &Device, texture: &Texture, layer: u32, aspect: TextureAspect) -> Vec<Vec<u8>> {
    let view = texture.create_view(&TextureViewDescriptor {
        aspect,
        ..TextureViewDescriptor::image(0, layer)
    });
    let view = view.unwrap();
    (0..texture.sample_count())
        .map(|sample| device.read_sample(&view, sample).unwrap())
        .collect()
}

fn layer(texture: &Texture, layer: u32) -> TextureCopy<'_> {
    TextureCopy {
        origin: [0, 0, layer],
        ..texture.into()
    }
}

const ONE: Extent3d = Extent3d {
    depth_or_array_layers: 1,
    ..SIZE
};

/// From rows and from tiles, to a new texture and to one that was rendered to, inside a texture,
/// for every format.
///
/// Rows: R6.
#[test]
fn whole_images_are_copied_with_every_sample() {
    let device = device();
    let mut formats = 0;
    for (number, &format) in TextureFormat::ALL.iter().enumerate() {
        if !format.is_renderable() && format.is_color() {
            continue;
        }
        formats += 1;
        let count = [2, 4, 8, 16][number % 4];
        for in_tiles in [false, true] {
            let from = noisy(&device, format, count);
            let into = device
                .create_texture(&descriptor(format.with_srgb(true), count))
                .unwrap();
            if in_tiles {
                render(&device, &from, 0);
                render(&device, &into, 1);
            }
            let all =
                |texture: &Texture, layer| samples(&device, texture, layer, TextureAspect::All);
            // Read after the copy: reading would make the rows.
            device
                .copy_texture_to_texture(layer(&from, 0), layer(&into, 1), ONE)
                .unwrap();
            let zeros = all(&into, 0);
            assert!(zeros.iter().flatten().all(|byte| *byte == 0));
            assert!(all(&into, 1) == all(&from, 0), "{}", format.name());
            // A pass clamps float depths, which are noise until a pass has rendered to them.
            if in_tiles {
                render(&device, &into, 1);
                assert!(all(&into, 1) == all(&from, 0), "{}", format.name());
            }
            // Both layers at once; then inside the texture.
            device.copy_texture_to_texture(&from, &into, SIZE).unwrap();
            assert!(all(&into, 1) == all(&from, 1), "{}", format.name());
            device
                .copy_texture_to_texture(layer(&into, 0), layer(&into, 1), ONE)
                .unwrap();
            assert!(all(&into, 1) == all(&from, 0), "{}", format.name());
        }
    }
    assert_eq!(formats, 48);
}

/// Rows: R6.
#[test]
fn one_aspect_is_copied_with_every_sample() {
    use TextureAspect::{Depth, Stencil};
    let device = device();
    for format in [
        TextureFormat::Depth24PlusStencil8,
        TextureFormat::Depth32FloatStencil8,
    ] {
        let from = noisy(&device, format, 4);
        for aspect in [Depth, Stencil] {
            let into = device.create_texture(&descriptor(format, 4)).unwrap();
            let [read, written] = [&from, &into].map(|texture| TextureCopy {
                aspect,
                ..texture.into()
            });
            device.copy_texture_to_texture(read, written, SIZE).unwrap();
            for copied in [Depth, Stencil] {
                let got = samples(&device, &into, 1, copied);
                if copied == aspect {
                    assert!(got == samples(&device, &from, 1, copied));
                } else {
                    assert!(got.iter().flatten().all(|byte| *byte == 0));
                }
            }
        }
    }
}

/// Depths that are not in 0..1 are copied as they are, also after a pass has tested them: it clamps
/// what it tests, not what is stored.
///
/// Rows: D1.
#[test]
fn depths_that_a_pass_tested_are_copied_as_stored() {
    let device = device();
    for count in [1, 4] {
        let from = noisy(&device, TextureFormat::Depth32Float, count);
        let into = device
            .create_texture(&descriptor(TextureFormat::Depth32Float, count))
            .unwrap();
        let stored = samples(&device, &from, 1, TextureAspect::All);
        let view = from.image(0, 1).unwrap();
        device
            .render(&RenderPass {
                depth_stencil_attachment: Some(DepthStencilAttachment::read_only(&view)),
                ..RenderPass::default()
            })
            .unwrap();
        device.copy_texture_to_texture(&from, &into, SIZE).unwrap();
        assert!(samples(&device, &into, 1, TextureAspect::All) == stored);
        assert!(samples(&device, &from, 1, TextureAspect::All) == stored);
    }
}

#[test]
fn parts_other_counts_and_buffers_are_refused() {
    let device = device();
    let format = TextureFormat::Rgba8Unorm;
    let four = noisy(&device, format, 4);
    let before = samples(&device, &four, 1, TextureAspect::All);
    let [two, one] = [2, 1].map(|count| device.create_texture(&descriptor(format, count)).unwrap());
    let refused = |from: &Texture, into: &Texture, size: Extent3d| {
        let result = device.copy_texture_to_texture(from, into, size);
        let error = result.unwrap_err();
        assert!(
            matches!(error, CopyError::Texture(TextureError::Unsupported { .. })),
            "{error:?}"
        );
        error.to_string()
    };
    let other = noisy(&device, format, 4);
    assert_eq!(
        refused(&other, &four, Extent3d { width: 69, ..SIZE }),
        "a texture of format rgba8unorm with 4 samples: a multisampled texture is copied to one of as \
         many samples, whole images at a time: resolve it to copy a part"
    );
    refused(&other, &four, Extent3d { height: 1, ..SIZE });
    refused(&two, &four, SIZE);
    refused(&one, &four, SIZE);
    refused(&other, &one, SIZE);
    let buffer = device.create_buffer_with_contents(&[0; 70 * 19 * 2 * 16]);
    let (buffer, tight) = (buffer.unwrap(), TexelCopyLayout::default());
    let from_buffer = device.copy_buffer_to_texture((&buffer, &tight), &four, SIZE);
    let to_buffer = device.copy_texture_to_buffer(&four, (&buffer, &tight), SIZE);
    for result in [from_buffer, to_buffer] {
        let error = result.unwrap_err().to_string();
        assert!(error.contains("resolve a multisampled texture"), "{error}");
    }
    // No layers are copied as nothing, as of all textures.
    let none = Extent3d {
        depth_or_array_layers: 0,
        ..SIZE
    };
    device.copy_texture_to_texture(&other, &four, none).unwrap();
    assert!(samples(&device, &four, 1, TextureAspect::All) == before);
}
