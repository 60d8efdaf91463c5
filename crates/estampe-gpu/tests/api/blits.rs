//! Blits: exact copies where nothing is scaled, means where an image is halved, and nothing outside
//! of the rectangle.

use crate::support::{device, devices, noise, texture};
use estampe::{
    BlitRegion, Device, FilterMode, SampleType, TexelCopyLayout, Texture, TextureDescriptor,
    TextureFormat, srgb,
};

fn write(device: &Device, texture: &Texture, bytes: &[u8]) {
    let layout = TexelCopyLayout::default();
    device
        .write_texture(texture, bytes, &layout, texture.size())
        .unwrap();
}

/// Renderable formats of numbers.
fn float_formats() -> impl Iterator<Item = TextureFormat> {
    let formats = TextureFormat::ALL.iter().copied();
    formats.filter(|format| format.is_renderable() && format.sample_type() == SampleType::Float)
}

/// Texels that a format gives back when they are decoded and encoded: floats are finite, and the
/// signed channels of snorm formats are not the second code of −1.
fn texels(format: TextureFormat, count: usize) -> Vec<u8> {
    let name = format.name();
    let mut bytes = noise(count * format.block_bytes() as usize, 5);
    for (at, byte) in bytes.iter_mut().enumerate() {
        match name {
            // Not −128 or −32768.
            _ if name.contains("8snorm") => *byte = if *byte == 0x80 { 0x81 } else { *byte },
            _ if name.contains("16snorm") => *byte |= u8::from(at % 2 == 0),
            // No exponent is all ones: bits are cleared of which every exponent has one.
            _ if name == "rg11b10ufloat" => *byte &= 0b1011_1101,
            _ if name.contains("float") => *byte &= 0xBB,
            _ => {}
        }
    }
    bytes
}

#[test]
fn a_blit_of_the_same_size_is_exact_for_every_format() {
    for (name, device) in devices() {
        let mut count = 0;
        for format in float_formats() {
            for size in [[64, 32], [37, 19]] {
                let [from, into] = [0, 1].map(|_| texture(&device, size, format));
                let bytes = texels(format, (size[0] * size[1]) as usize);
                write(&device, &from, &bytes);
                let (from, view) = (from.view(), into.view());
                device.blit(&from, &view, FilterMode::Nearest).unwrap();
                assert!(
                    device.read_texture(&into).unwrap() == bytes,
                    "{} {size:?}, {name}",
                    format.name()
                );
            }
            count += 1;
        }
        assert_eq!(count, 23);
    }
}

#[test]
fn a_blit_to_half_the_size_is_the_mean() {
    for (name, device) in devices() {
        for (format, size) in [
            (TextureFormat::Rgba8Unorm, [64, 32]),
            (TextureFormat::Bgra8Unorm, [64, 32]),
            (TextureFormat::Rgba8UnormSrgb, [64, 32]),
            (TextureFormat::Rgba8Unorm, [74, 38]),
        ] {
            let [width, height] = size.map(|side: u32| side as usize);
            let from = texture(&device, size, format);
            let into = texture(&device, size.map(|side| side / 2), format);
            // Sums of four are multiples of four, so the means are codes.
            let even = |bytes: Vec<u8>| bytes.into_iter().map(|byte| byte & 0xFC);
            let bytes: Vec<u8> = even(noise(width * height * 4, 11)).collect();
            write(&device, &from, &bytes);
            let (from, view) = (from.view(), into.view());
            device.blit(&from, &view, FilterMode::Linear).unwrap();
            let seen = device.read_texture(&into).unwrap();
            for (at, code) in seen.iter().enumerate() {
                let (channel, texel) = (at % 4, at / 4);
                let (x, y) = (texel % (width / 2) * 2, texel / (width / 2) * 2);
                let four = [[0, 0], [1, 0], [0, 1], [1, 1]]
                    .map(|[right, down]| bytes[((y + down) * width + x + right) * 4 + channel]);
                let expected = if format.is_srgb() && channel < 3 {
                    let sum: f32 = four.map(srgb::decode).iter().sum();
                    srgb::encode(sum * 0.25)
                } else {
                    let sum: u32 = four.iter().copied().map(u32::from).sum();
                    u8::try_from(sum / 4).unwrap()
                };
                assert_eq!(
                    *code,
                    expected,
                    "byte {at}, {} {size:?}, {name}",
                    format.name()
                );
            }
        }
    }
}

/// The nearest filter takes texel ⌊(pixel + ½) · texels ÷ pixels⌋, also where that lies between two
/// texels, as for all pixels of an image of half the size.
#[test]
fn nearest_texels_are_those_of_integers() {
    let device = device();
    let mut between = 0;
    for texels in (1..=90).chain([1023, 1280]) {
        let from = texture(&device, [texels, 1], TextureFormat::R32Float);
        let bytes: Vec<u8> = (0..texels)
            .flat_map(|at| (at as f32).to_le_bytes())
            .collect();
        write(&device, &from, &bytes);
        for pixels in [1, 2, 3, 7, 36, 37, 45, 64, 500] {
            let into = texture(&device, [pixels, 1], TextureFormat::R32Float);
            let (from, view) = (from.view(), into.view());
            device.blit(&from, &view, FilterMode::Nearest).unwrap();
            let seen = device.read_texture(&into).unwrap();
            for (pixel, texel) in (0..pixels).zip(seen.as_chunks::<4>().0) {
                let place = (2 * pixel + 1) * texels;
                between += u32::from(place.is_multiple_of(2 * pixels));
                assert_eq!(
                    f32::from_le_bytes(*texel),
                    (place / (2 * pixels)) as f32,
                    "pixel {pixel} of {pixels}, from {texels} texels"
                );
            }
        }
    }
    assert!(between > 500, "{between}");
}

/// A rectangle of one image is scaled up into a rectangle of another, which is converted.
#[test]
fn a_region_is_scaled_and_converted_and_the_rest_stays() {
    for (name, device) in devices() {
        let from = texture(&device, [10, 8], TextureFormat::Rgba8Unorm);
        let bytes = noise(10 * 8 * 4, 2);
        write(&device, &from, &bytes);
        let descriptor = TextureDescriptor {
            mip_level_count: 2,
            ..TextureDescriptor::new_2d(60, 40, TextureFormat::Bgra8UnormSrgb)
        };
        let into = device.create_texture(&descriptor).unwrap();
        let around = noise(30 * 20 * 4, 3);
        let level = estampe::TextureCopy {
            mip_level: 1,
            ..(&into).into()
        };
        let size = into.level_size(1);
        let tight = TexelCopyLayout::default();
        device
            .write_texture(level.clone(), &around, &tight, size)
            .unwrap();
        let (view, into_view) = (from.view(), into.image(1, 0).unwrap());
        let source = BlitRegion {
            view: &view,
            origin: [3, 2],
            size: [4, 5],
        };
        let destination = BlitRegion {
            view: &into_view,
            origin: [7, 1],
            size: [16, 15],
        };
        device
            .blit(source, destination, FilterMode::Nearest)
            .unwrap();
        let mut expected = around;
        for y in 0..15 {
            for x in 0..16 {
                let texel = &bytes[((2 + y / 3) * 10 + 3 + x / 4) * 4..][..4];
                let [r, g, b, a]: [u8; 4] = texel.try_into().unwrap();
                let encode = |code: u8| srgb::encode(f32::from(code) / 255.0);
                let place = ((1 + y) * 30 + 7 + x) * 4;
                expected[place..place + 4].copy_from_slice(&[encode(b), encode(g), encode(r), a]);
            }
        }
        let mut seen = vec![0; expected.len()];
        device
            .read_texture_into(level, &mut seen, &tight, size)
            .unwrap();
        assert!(seen == expected, "{name}");
    }
}

/// Images so large that a texel's coordinate in 0..1 has few bits left.
#[test]
fn long_images_are_copied_exactly() {
    let device = device();
    for size in [[16_383, 3], [3, 16_383]] {
        let [from, into] = [0, 1].map(|_| texture(&device, size, TextureFormat::R8Unorm));
        let bytes = noise(16_383 * 3, 8);
        write(&device, &from, &bytes);
        for filter in [FilterMode::Nearest, FilterMode::Linear] {
            device.clear_texture(&into.view()).unwrap();
            let (from, view) = (from.view(), into.view());
            device.blit(&from, &view, filter).unwrap();
            assert!(
                device.read_texture(&into).unwrap() == bytes,
                "{size:?} {filter:?}"
            );
        }
    }
}
