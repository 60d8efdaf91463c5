//! Copies between buffers and textures: every format and block size, padding, regions, aspects.

mod support;

use estampe::{
    Buffer, Device, Extent3d, TexelCopyLayout, Texture, TextureAspect, TextureCopy,
    TextureDescriptor, TextureDimension, TextureFormat, TextureViewDescriptor,
};
use support::{device, noise, texture};

/// The bytes of texels that a texture of this format keeps.
fn kept(format: TextureFormat, mut bytes: Vec<u8>) -> Vec<u8> {
    let each = format.block_bytes() as usize;
    for texel in bytes.chunks_exact_mut(each) {
        match format {
            // The fourth byte is not used.
            TextureFormat::Depth24Plus => texel[3] = 0,
            // Depths are not checked; after the stencil come three bytes that are not used.
            TextureFormat::Depth32FloatStencil8 => texel[5..].fill(0),
            _ => {}
        }
    }
    bytes
}

fn buffer_of(device: &Device, bytes: &[u8]) -> Buffer {
    device.create_buffer_with_contents(bytes).unwrap()
}

fn bytes_in(buffer: &Buffer) -> Vec<u8> {
    buffer.map_read(0..buffer.size(), <[u8]>::to_vec).unwrap()
}

/// A region's rows in memory.
struct Rows {
    layout: TexelCopyLayout,
    row_bytes: usize,
    rows: usize,
    layers: usize,
}

impl Rows {
    /// The rows of a level, each with `padding` bytes behind it, each layer with `more` rows.
    fn of(texture: &Texture, level: u32, padding: u32, more: u32) -> Self {
        let size = texture.level_size(level);
        let [width, height] = texture.format().block_size();
        let row_bytes = size.width.div_ceil(width) * texture.format().block_bytes();
        let rows = size.height.div_ceil(height);
        Self {
            layout: TexelCopyLayout {
                offset: u64::from(padding),
                bytes_per_row: Some(row_bytes + padding),
                rows_per_image: Some(rows + more),
            },
            row_bytes: row_bytes as usize,
            rows: rows as usize,
            layers: size.depth_or_array_layers as usize,
        }
    }

    /// The first byte of each row.
    fn firsts(&self) -> impl Iterator<Item = usize> {
        let stride = self.layout.bytes_per_row.unwrap() as usize;
        let rows_per_image = self.layout.rows_per_image.unwrap() as usize;
        let offset = usize::try_from(self.layout.offset).unwrap();
        (0..self.layers).flat_map(move |layer| {
            (0..self.rows).map(move |row| offset + (layer * rows_per_image + row) * stride)
        })
    }

    fn len(&self) -> usize {
        self.firsts().last().unwrap() + self.row_bytes
    }

    /// Tight rows in this layout, with `filler` between them.
    fn spread(&self, tight: &[u8], filler: u8) -> Vec<u8> {
        let mut bytes = vec![filler; self.len()];
        for (first, row) in self.firsts().zip(tight.chunks_exact(self.row_bytes)) {
            bytes[first..first + self.row_bytes].copy_from_slice(row);
        }
        bytes
    }
}

/// Two layers, three levels, sides that no block size divides.
fn descriptor(format: TextureFormat) -> TextureDescriptor<'static> {
    TextureDescriptor {
        size: Extent3d {
            width: 29,
            height: 23,
            depth_or_array_layers: 2,
        },
        mip_level_count: 3,
        ..TextureDescriptor::new_2d(1, 1, format)
    }
}

#[test]
fn every_format_goes_from_buffer_to_texture_to_texture_to_buffer() {
    let device = device();
    let mut blocks = std::collections::BTreeSet::new();
    for (seed, &format) in (0..).zip(TextureFormat::ALL) {
        blocks.insert(format.block_size());
        let [first, second] = [0, 1].map(|_| device.create_texture(&descriptor(format)).unwrap());
        for level in 0..3 {
            let (tight, padded) = (Rows::of(&first, level, 0, 0), Rows::of(&first, level, 8, 2));
            let texels = noise(tight.row_bytes * tight.rows * tight.layers, seed);
            let from = buffer_of(&device, &padded.spread(&texels, 0xAB));
            let size = first.level_size(level);
            let [one, other] = [&first, &second].map(|texture| TextureCopy {
                mip_level: level,
                ..texture.into()
            });
            device
                .copy_buffer_to_texture((&from, &padded.layout), one.clone(), size)
                .unwrap();
            device
                .copy_texture_to_texture(one, other.clone(), size)
                .unwrap();
            // The bytes between rows stay as they are.
            let other_rows = Rows::of(&first, level, 12, 1);
            let into = buffer_of(&device, &vec![0xCD; other_rows.len() + 5]);
            device
                .copy_texture_to_buffer(other, (&into, &other_rows.layout), size)
                .unwrap();
            let mut expected = other_rows.spread(&kept(format, texels), 0xCD);
            expected.extend([0xCD; 5]);
            assert!(
                bytes_in(&into) == expected,
                "{} level {level}",
                format.name()
            );
        }
    }
    assert!(blocks.len() == 15, "{blocks:?}");
}

/// Levels and layers that were not written are zeros.
#[test]
fn what_was_not_written_is_zeros() {
    let device = device();
    for &format in TextureFormat::ALL {
        let texture = device.create_texture(&descriptor(format)).unwrap();
        let rows = Rows::of(&texture, 1, 0, 0);
        let mut bytes = vec![0xEE; rows.len()];
        let from = TextureCopy {
            mip_level: 1,
            ..(&texture).into()
        };
        let size = texture.level_size(1);
        device
            .read_texture_into(from, &mut bytes, &TexelCopyLayout::default(), size)
            .unwrap();
        assert!(bytes.iter().all(|byte| *byte == 0), "{}", format.name());
    }
}

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

#[test]
fn depth_and_stencil_are_copied_one_by_one() {
    let device = device();
    let size = Extent3d::new_2d(6, 3);
    let tight = TexelCopyLayout::default();
    for format in [
        TextureFormat::Depth24PlusStencil8,
        TextureFormat::Depth32FloatStencil8,
    ] {
        let [image, other] = [0, 1].map(|_| texture(&device, [6, 3], format));
        let depth = if format == TextureFormat::Depth24PlusStencil8 {
            kept(TextureFormat::Depth24Plus, noise(6 * 3 * 4, 1))
        } else {
            noise(6 * 3 * 4, 1)
        };
        let stencil = noise(6 * 3, 2);
        let of = |texture, aspect| TextureCopy {
            aspect,
            ..TextureCopy::from(texture)
        };
        let read = |texture, aspect| {
            let each = if aspect == TextureAspect::Stencil {
                1
            } else {
                4
            };
            let mut bytes = vec![0; 6 * 3 * each];
            device
                .read_texture_into(of(texture, aspect), &mut bytes, &tight, size)
                .unwrap();
            bytes
        };
        use TextureAspect::{Depth, Stencil};
        for (aspect, bytes) in [(Stencil, &stencil), (Depth, &depth)] {
            device
                .write_texture(of(&image, aspect), bytes, &tight, size)
                .unwrap();
        }
        assert!(read(&image, Depth) == depth && read(&image, Stencil) == stencil);
        let all: Vec<u8> = depth
            .chunks(4)
            .zip(&stencil)
            .flat_map(|(depth, stencil)| match format {
                TextureFormat::Depth24PlusStencil8 => [&depth[..3], &[*stencil]].concat(),
                _ => [depth, &[*stencil, 0, 0, 0]].concat(),
            })
            .collect();
        assert!(
            device.read_texture(&image).unwrap() == all,
            "{}",
            format.name()
        );
        // One aspect of another texture.
        let [from, into] = [&image, &other].map(|texture| of(texture, Stencil));
        device.copy_texture_to_texture(from, into, size).unwrap();
        assert!(read(&other, Depth) == [0; 72] && read(&other, Stencil) == stencil);
        // One aspect becomes zeros.
        let view = image.create_view(&TextureViewDescriptor {
            aspect: Depth,
            ..TextureViewDescriptor::default()
        });
        device.clear_texture(&view.unwrap()).unwrap();
        assert!(read(&image, Depth) == [0; 72] && read(&image, Stencil) == stencil);
        device.clear_texture(&image.view()).unwrap();
        assert!(read(&image, Stencil) == [0; 18]);
    }
}

#[test]
fn views_are_cleared_and_nothing_else() {
    let device = device();
    for format in [TextureFormat::Rgba8Unorm, TextureFormat::Bc4RUnorm] {
        let texture = device.create_texture(&descriptor(format)).unwrap();
        let mut written = Vec::new();
        for level in 0..3 {
            let rows = Rows::of(&texture, level, 0, 0);
            let bytes = noise(rows.len(), level);
            let to = TextureCopy {
                mip_level: level,
                ..(&texture).into()
            };
            let size = texture.level_size(level);
            device
                .write_texture(to, &bytes, &TexelCopyLayout::default(), size)
                .unwrap();
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
            let mut bytes = vec![0; expected.len()];
            let from = TextureCopy {
                mip_level: level,
                ..(&texture).into()
            };
            let size = texture.level_size(level);
            device
                .read_texture_into(from, &mut bytes, &TexelCopyLayout::default(), size)
                .unwrap();
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
    let read = |level: u32| {
        let size = image.level_size(level);
        let mut bytes = vec![0; (size.width * size.height) as usize];
        let from = TextureCopy {
            mip_level: level,
            ..(&image).into()
        };
        device
            .read_texture_into(from, &mut bytes, &TexelCopyLayout::default(), size)
            .unwrap();
        bytes
    };
    let texels: Vec<u8> = (0..32).map(|at| at % 8 * 4 + at / 8 * 8).collect();
    let size = Extent3d::new_2d(8, 4);
    device
        .write_texture(&image, &texels, &TexelCopyLayout::default(), size)
        .unwrap();
    device.generate_mips(&image).unwrap();
    assert_eq!(read(1), [6, 14, 22, 30, 22, 30, 38, 46]);
    assert_eq!(read(2), [18, 34]);
    assert_eq!(read(3), [26]);
    support::clear(&device, &image.image(0, 0).unwrap(), [1.0; 4]);
    device.generate_mips(&image).unwrap();
    assert_eq!([read(1), read(2), read(3)].concat(), [255; 11]);
}
