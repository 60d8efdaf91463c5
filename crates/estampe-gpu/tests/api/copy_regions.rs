//! Copies of regions, slices and layers from one texture to another.

use crate::support::{device, noise, texture};
use estampe::{
    Extent3d, TexelCopyLayout, TextureCopy, TextureDescriptor, TextureDimension, TextureFormat,
};

/// A region of 2×2 blocks, or of less at the edge, from one place to another.
#[test]
fn regions_change_nothing_around_them() {
    let device = device();
    for format in [
        TextureFormat::R8Unorm,
        TextureFormat::Bgra8Unorm,
        TextureFormat::Rgba32Float,
        TextureFormat::Bc1RgbaUnorm,
        TextureFormat::Astc12x10Unorm,
    ] {
        let [width, height] = format.block_size();
        // Four blocks and a texel of a fifth, three blocks.
        let size = [width * 4 + 1, height * 3];
        let size = if format.is_compressed() { size } else { [5, 3] };
        let [from, into] = [0, 1].map(|_| texture(&device, size, format));
        let columns = 5;
        let each = format.block_bytes() as usize;
        let texels = [1, 2].map(|seed| noise(columns * 3 * each, seed));
        for (texture, texels) in [(&from, &texels[0]), (&into, &texels[1])] {
            let layout = TexelCopyLayout::default();
            device
                .write_texture(texture, texels, &layout, texture.size())
                .unwrap();
        }
        let [first, second] =
            [(&from, [3, 1]), (&into, [3, 0])].map(|(texture, [x, y])| TextureCopy {
                origin: [x * width, y * height, 0],
                ..texture.into()
            });
        // Blocks 3 and 4; the fifth column is cut by the edge.
        let region = Extent3d::new_2d(size[0] - 3 * width, 2 * height);
        device
            .copy_texture_to_texture(first.clone(), second, region)
            .unwrap();
        let mut expected = texels[1].clone();
        for row in 0..2 {
            let (source, place) = ((row + 1) * columns + 3, row * columns + 3);
            expected[place * each..][..2 * each]
                .copy_from_slice(&texels[0][source * each..][..2 * each]);
        }
        assert!(
            device.read_texture(&into).unwrap() == expected,
            "{}",
            format.name()
        );

        // Inside one texture, where the regions overlap: as if the source were read first.
        let place = TextureCopy {
            origin: [2 * width, 0, 0],
            ..(&from).into()
        };
        let source = TextureCopy {
            origin: [width, height, 0],
            ..(&from).into()
        };
        let region = Extent3d::new_2d(2 * width, 2 * height);
        device
            .copy_texture_to_texture(source, place, region)
            .unwrap();
        let mut expected = texels[0].clone();
        for row in 0..2 {
            let (source, place) = ((row + 1) * columns + 1, row * columns + 2);
            expected[place * each..][..2 * each]
                .copy_from_slice(&texels[0][source * each..][..2 * each]);
        }
        assert!(
            device.read_texture(&from).unwrap() == expected,
            "{}",
            format.name()
        );
    }
}

#[test]
fn slices_of_a_volume_are_copied_like_layers() {
    let device = device();
    let size = Extent3d {
        width: 5,
        height: 4,
        depth_or_array_layers: 6,
    };
    let volume = device
        .create_texture(&TextureDescriptor {
            dimension: TextureDimension::D3,
            size,
            ..TextureDescriptor::new_2d(5, 4, TextureFormat::Rg16Uint)
        })
        .unwrap();
    let layers = device
        .create_texture(&TextureDescriptor {
            size,
            ..TextureDescriptor::new_2d(5, 4, TextureFormat::Rg16Uint)
        })
        .unwrap();
    let texels = noise(5 * 4 * 6 * 4, 9);
    let tight = TexelCopyLayout::default();
    device
        .write_texture(&volume, &texels, &tight, size)
        .unwrap();
    let three = Extent3d {
        depth_or_array_layers: 3,
        ..size
    };
    let [from, into] = [(&volume, 2), (&layers, 1)].map(|(texture, slice)| TextureCopy {
        origin: [0, 0, slice],
        ..texture.into()
    });
    device.copy_texture_to_texture(from, into, three).unwrap();
    let mut bytes = vec![0; texels.len()];
    device
        .read_texture_into(&layers, &mut bytes, &tight, size)
        .unwrap();
    let image = 5 * 4 * 4;
    let expected = [
        vec![0; image],
        texels[2 * image..5 * image].to_vec(),
        vec![0; 2 * image],
    ];
    assert!(bytes == expected.concat());
}
