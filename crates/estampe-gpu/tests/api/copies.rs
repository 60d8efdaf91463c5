//! Copies between buffers and textures: every format and block size, padding, aspects.

use crate::support::{device, layered, noise, texture};
use estampe::{
    Buffer, CopyError, Device, Extent3d, TexelCopyLayout, Texture, TextureAspect, TextureCopy,
    TextureDescriptor, TextureError, TextureFormat, TextureViewDescriptor,
};

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

#[test]
fn every_format_goes_from_buffer_to_texture_to_texture_to_buffer() {
    let device = device();
    let mut blocks = std::collections::BTreeSet::new();
    for (seed, &format) in (0..).zip(TextureFormat::ALL) {
        blocks.insert(format.block_size());
        let [first, second] = [0, 1].map(|_| device.create_texture(&layered(format)).unwrap());
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

/// Bytes that neither depth nor stencil has are zeros, also of texels that a texture is created
/// with.
#[test]
fn first_texels_keep_what_written_ones_keep() {
    let device = device();
    for &format in TextureFormat::ALL {
        let bytes = noise((7 * 5 * format.block_bytes()) as usize, 4);
        let descriptor = TextureDescriptor::new_2d(7, 5, format);
        if !format.is_compressed() {
            let made = device.create_texture_with_data(&descriptor, &[&bytes]);
            let read = device.read_texture(&made.unwrap()).unwrap();
            assert!(read == kept(format, bytes), "{}", format.name());
        }
    }
}

/// The region is checked before memory is taken for it.
#[test]
fn huge_regions_are_refused() {
    let device = device();
    let [from, into] = [0, 1].map(|_| texture(&device, [5, 4], TextureFormat::Rgba32Float));
    for side in [6, 1 << 20, u32::MAX] {
        let size = Extent3d {
            width: side,
            height: side,
            depth_or_array_layers: side,
        };
        let copied = device.copy_texture_to_texture(&from, &into, size);
        assert!(matches!(
            copied,
            Err(CopyError::Texture(TextureError::Region { .. }))
        ));
    }
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
