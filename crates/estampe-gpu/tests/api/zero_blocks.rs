//! Compressed textures of zeros: new, cleared and written ones are the same blocks and the same
//! colours.

use crate::support::{device, noise};
use estampe::{
    Device, Extent3d, FilterMode, TexelCopyLayout, Texture, TextureDescriptor, TextureError,
    TextureFormat, TextureViewDescriptor,
};

fn compressed() -> impl Iterator<Item = TextureFormat> {
    let formats = TextureFormat::ALL.iter().copied();
    formats.filter(|format| format.is_compressed())
}

/// Two layers, two levels, sides that no block size divides.
fn texture(device: &Device, format: TextureFormat) -> Texture {
    let descriptor = TextureDescriptor {
        size: Extent3d {
            width: 26,
            height: 17,
            depth_or_array_layers: 2,
        },
        mip_level_count: 2,
        ..TextureDescriptor::new_2d(1, 1, format)
    };
    device.create_texture(&descriptor).unwrap()
}

/// The colours of an image, as they are sampled.
fn colors(device: &Device, texture: &Texture, level: u32, layer: u32) -> Vec<[f32; 4]> {
    let size = texture.level_size(level);
    let (width, height) = (size.width, size.height);
    let float = TextureDescriptor::new_2d(width, height, TextureFormat::Rgba32Float);
    let into = device.create_texture(&float).unwrap();
    let from = texture.image(level, layer).unwrap();
    device
        .blit(&from, &into.view(), FilterMode::Nearest)
        .unwrap();
    let bytes = device.read_texture(&into).unwrap();
    let floats = bytes
        .as_chunks::<4>()
        .0
        .iter()
        .map(|b| f32::from_le_bytes(*b));
    let floats: Vec<f32> = floats.collect();
    floats.as_chunks::<4>().0.to_vec()
}

fn write(device: &Device, texture: &Texture, bytes: &[u8]) {
    let layout = TexelCopyLayout::default();
    device
        .write_texture(texture, bytes, &layout, texture.size())
        .unwrap();
}

/// The bytes of both layers of the first level.
fn len(texture: &Texture) -> usize {
    let [width, height] = texture.format().block_size();
    let size = texture.size();
    let blocks = size.width.div_ceil(width) * size.height.div_ceil(height) * 2;
    (blocks * texture.format().block_bytes()) as usize
}

/// Rows: F2.
#[test]
fn new_written_and_cleared_zeros_are_the_same() {
    let device = device();
    let mut formats = 0;
    for format in compressed() {
        let textures = [0, 1, 2, 3].map(|_| texture(&device, format));
        let [new, written, cleared, begun] = &textures;
        write(&device, written, &vec![0; len(written)]);
        write(&device, cleared, &noise(len(cleared), 3));
        device.clear_texture(&cleared.view()).unwrap();
        // A block of the first layer alone is written, so the second layer is new.
        let [width, height] = format.block_size();
        let block = Extent3d::new_2d(width, height);
        let bytes = noise(format.block_bytes() as usize, 7);
        device
            .write_texture(begun, &bytes, &TexelCopyLayout::default(), block)
            .unwrap();
        let expected = colors(&device, new, 0, 0);
        // All blocks are the same.
        assert!(expected.iter().all(|color| *color == expected[0]));
        for texture in [written, cleared, begun] {
            assert!(
                colors(&device, texture, 0, 1) == expected,
                "{}",
                format.name()
            );
        }
        assert!(colors(&device, begun, 0, 0)[width as usize..][..5] == expected[..5]);
        let small = colors(&device, new, 1, 1);
        assert!(small.iter().all(|color| *color == expected[0]));
        // A layer that is cleared, beside one that is not.
        write(&device, cleared, &noise(len(cleared), 5));
        let second = cleared.create_view(&TextureViewDescriptor {
            base_array_layer: 1,
            ..TextureViewDescriptor::default()
        });
        device.clear_texture(&second.unwrap()).unwrap();
        assert!(colors(&device, cleared, 0, 1) == expected);
        assert!(
            colors(&device, cleared, 0, 0) == {
                write(&device, written, &noise(len(cleared), 5));
                colors(&device, written, 0, 0)
            }
        );
        formats += 1;
    }
    assert_eq!(formats, 52);
}

/// Rows: F2.
#[test]
fn blocks_of_zero_bytes_have_the_colours_of_their_formats() {
    use TextureFormat as F;
    let device = device();
    let black = [0.0, 0.0, 0.0, 1.0];
    let two = 2.0 / 255.0;
    for (format, expected) in [
        (F::Bc1RgbaUnorm, black),
        (F::Bc2RgbaUnorm, [0.0; 4]),
        (F::Bc3RgbaUnorm, [0.0; 4]),
        (F::Bc4RUnorm, black),
        (F::Bc5RgSnorm, black),
        (F::Bc6hRgbUfloat, black),
        (F::Bc7RgbaUnorm, [0.0; 4]),
        (F::Etc2Rgb8Unorm, [two, two, two, 1.0]),
        (F::Etc2Rgb8A1Unorm, black),
        (F::Etc2Rgba8Unorm, [two, two, two, 0.0]),
        (F::EacR11Unorm, [1.0 / 2047.0, 0.0, 0.0, 1.0]),
        (F::EacR11Snorm, [-3.0 / 1023.0, 0.0, 0.0, 1.0]),
        (F::Astc6x5Unorm, [1.0, 0.0, 1.0, 1.0]),
        (F::Astc6x5UnormSrgb, [1.0, 0.0, 1.0, 1.0]),
    ] {
        let color = colors(&device, &texture(&device, format), 0, 0)[0];
        let difference = color.iter().zip(expected).map(|(a, b)| (a - b).abs());
        let most = difference.fold(0.0, f32::max);
        assert!(most < 1e-6, "{}: {color:?}", format.name());
    }
}

/// Rows: F2.
#[test]
fn levels_of_blocks_are_not_generated() {
    let device = device();
    let descriptor = TextureDescriptor::new_2d(8, 8, TextureFormat::Bc1RgbaUnorm).with_all_levels();
    let (first, small) = (noise(32, 1), noise(8, 2));
    let made = device.create_texture_with_data(&descriptor, &[&first]);
    assert!(matches!(made, Err(TextureError::Unsupported { .. })));
    let all: [&[u8]; 4] = [&first, &small, &small, &small];
    let made = device.create_texture_with_data(&descriptor, &all).unwrap();
    let refused = device.generate_mips(&made);
    assert!(matches!(refused, Err(TextureError::Unsupported { .. })));
    assert!(device.read_texture(&made).unwrap() == first);
}
