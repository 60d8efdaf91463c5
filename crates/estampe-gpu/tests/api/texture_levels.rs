//! Levels and layers of a texture: zeros at first, cleared one by one, made of each other.

use crate::support::{clear, device, layered, len_bytes, noise, read_level, write_level};
use estampe::{TextureDescriptor, TextureFormat, TextureViewDescriptor};

/// Levels and layers that were not written are zeros.
#[test]
fn what_was_not_written_is_zeros() {
    let device = device();
    for &format in TextureFormat::ALL {
        let texture = device.create_texture(&layered(format)).unwrap();
        let bytes = read_level(&device, &texture, 1);
        assert!(bytes.iter().all(|byte| *byte == 0), "{}", format.name());
    }
}

#[test]
fn views_are_cleared_and_nothing_else() {
    let device = device();
    for format in [TextureFormat::Rgba8Unorm, TextureFormat::Bc4RUnorm] {
        let texture = device.create_texture(&layered(format)).unwrap();
        let mut written = Vec::new();
        for level in 0..3 {
            let len = len_bytes(format, texture.level_size(level));
            let bytes = noise(len, level);
            write_level(&device, &texture, level, &bytes);
            written.push(bytes);
        }
        let view = texture.create_view(&TextureViewDescriptor {
            base_mip_level: 1,
            base_array_layer: 1,
            ..TextureViewDescriptor::default()
        });
        device.clear_texture(&view.unwrap()).unwrap();
        for (level, mut expected) in (0..).zip(written) {
            if level > 0 {
                let half = expected.len() / 2;
                expected[half..].fill(0);
            }
            let bytes = read_level(&device, &texture, level);
            assert!(bytes == expected, "{} level {level}", format.name());
        }
    }
}

/// A level's texel is the mean of four, of the level that was rendered or written above it.
#[test]
fn mip_levels_are_means() {
    let device = device();
    let descriptor = TextureDescriptor::new_2d(8, 4, TextureFormat::R8Unorm).with_all_levels();
    let image = device.create_texture(&descriptor).unwrap();
    let read = |level: u32| read_level(&device, &image, level);
    let texels: Vec<u8> = (0..32).map(|at| at % 8 * 4 + at / 8 * 8).collect();
    write_level(&device, &image, 0, &texels);
    device.generate_mips(&image).unwrap();
    assert_eq!(read(1), [6, 14, 22, 30, 22, 30, 38, 46]);
    assert_eq!(read(2), [18, 34]);
    assert_eq!(read(3), [26]);
    clear(&device, &image.image(0, 0).unwrap(), [1.0; 4]);
    device.generate_mips(&image).unwrap();
    assert_eq!([read(1), read(2), read(3)].concat(), [255; 11]);
}
