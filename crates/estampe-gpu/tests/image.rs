//! Images of the `image` crate become textures, and textures become images:
//! `cargo test -p estampe-gpu --features image --test image`. Other tests do not build the crate.

use estampe::{Device, DeviceDescriptor, TextureDescriptor, TextureError, TextureFormat};
use image::{Rgba, RgbaImage};

#[test]
fn images_are_the_same_after_a_round_trip() {
    use TextureFormat as F;
    let device = Device::new(&DeviceDescriptor::default()).unwrap();
    let image = RgbaImage::from_fn(5, 3, |x, y| {
        let byte = |number: u32| u8::try_from(number).unwrap();
        Rgba([byte(x * 50), byte(y * 80), 7, byte(255 - x)])
    });
    for format in [
        F::Rgba8Unorm,
        F::Rgba8UnormSrgb,
        F::Bgra8Unorm,
        F::Bgra8UnormSrgb,
    ] {
        let texture = device.create_texture_from_image(&image, format).unwrap();
        assert_eq!((texture.format(), texture.mip_level_count()), (format, 3));
        assert_eq!(device.read_image(&texture).unwrap(), image);
    }
}

#[test]
fn other_formats_and_empty_images_are_errors() {
    let device = Device::new(&DeviceDescriptor::default()).unwrap();
    let (format, one) = (TextureFormat::R8Unorm, RgbaImage::new(1, 1));
    let error = device.create_texture_from_image(&one, format).unwrap_err();
    assert!(matches!(error, TextureError::Unsupported { .. }), "{error}");
    let texture = TextureDescriptor::new_2d(1, 1, format);
    let error = device.read_image(&device.create_texture(&texture).unwrap());
    assert!(
        matches!(error, Err(TextureError::Unsupported { .. })),
        "{error:?}"
    );
    let empty = RgbaImage::new(0, 4);
    let error = device.create_texture_from_image(&empty, TextureFormat::Rgba8Unorm);
    assert!(matches!(error, Err(TextureError::Rule(_))), "{error:?}");
}
