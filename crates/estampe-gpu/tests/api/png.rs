//! PNG files of textures hold their texels.

use estampe::{
    Device, DeviceDescriptor, PngError, Texture, TextureDescriptor, TextureFormat, TextureUsages,
};
use png::{ColorType, Decoder};
use std::io::Cursor;

const OPAQUE: [u8; 16] = [10, 20, 30, 255, 40, 50, 60, 255, 1, 2, 3, 255, 4, 5, 6, 255];
const TRANSLUCENT: [u8; 16] = [10, 20, 30, 40, 50, 60, 70, 80, 1, 2, 3, 4, 5, 6, 7, 255];

fn device() -> Device {
    Device::new(&DeviceDescriptor::default()).unwrap()
}

fn texture(device: &Device, format: TextureFormat, texels: &[u8]) -> Texture {
    let descriptor = TextureDescriptor::new_2d(2, 2, format);
    device
        .create_texture_with_data(&descriptor, &[texels])
        .unwrap()
}

fn decoded(bytes: &[u8]) -> (ColorType, Vec<u8>) {
    let mut reader = Decoder::new(Cursor::new(bytes)).read_info().unwrap();
    let mut samples = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut samples).unwrap();
    assert_eq!((frame.width, frame.height), (2, 2));
    (frame.color_type, samples)
}

#[test]
fn files_hold_the_codes_of_the_texels() {
    use TextureFormat as F;
    let device = device();
    for (format, is_bgra) in [
        (F::Rgba8Unorm, false),
        (F::Rgba8UnormSrgb, false),
        (F::Bgra8Unorm, true),
        (F::Bgra8UnormSrgb, true),
    ] {
        let swapped = |texels: &[u8]| -> Vec<u8> {
            let texels = texels.as_chunks::<4>().0.iter();
            let order = |[r, g, b, a]: [u8; 4]| if is_bgra { [b, g, r, a] } else { [r, g, b, a] };
            texels.flat_map(|texel| order(*texel)).collect()
        };
        let bytes = device
            .encode_png(&texture(&device, format, &TRANSLUCENT))
            .unwrap();
        assert_eq!(decoded(&bytes), (ColorType::Rgba, swapped(&TRANSLUCENT)));
        let bytes = device
            .encode_png(&texture(&device, format, &OPAQUE))
            .unwrap();
        let mut rgb = swapped(&OPAQUE);
        rgb.retain(|code| *code != 255);
        assert_eq!(decoded(&bytes), (ColorType::Rgb, rgb));
    }
}

#[test]
fn what_cannot_be_written_is_an_error() {
    let device = device();
    let float = TextureDescriptor::new_2d(2, 2, TextureFormat::Rgba16Float);
    let error = device.encode_png(&device.create_texture(&float).unwrap());
    let error = error.unwrap_err();
    assert!(matches!(error, PngError::Texture(_)), "{error}");
    assert!(error.to_string().contains("blit it"), "{error}");

    let secret = TextureDescriptor {
        usage: TextureUsages::RENDER_ATTACHMENT,
        ..TextureDescriptor::new_2d(2, 2, TextureFormat::Rgba8Unorm)
    };
    let error = device.encode_png(&device.create_texture(&secret).unwrap());
    assert!(matches!(error, Err(PngError::Texture(_))), "{error:?}");

    let path = std::env::temp_dir()
        .join("no folder of this name")
        .join("picture.png");
    let error = device.write_png(&texture(&device, TextureFormat::Rgba8Unorm, &OPAQUE), &path);
    let error = error.unwrap_err().to_string();
    assert!(error.contains("picture.png cannot be written"), "{error}");
}
