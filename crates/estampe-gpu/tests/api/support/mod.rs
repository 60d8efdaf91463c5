//! Devices, images to draw into and shaders that several tests use.

#![allow(dead_code, reason = "every test uses a part")]

pub(crate) mod binding;
pub(crate) mod sampling;

use estampe::{
    ColorAttachment, DepthStencilAttachment, Device, DeviceDescriptor, Draw, Extent3d, FragmentIn,
    FragmentOut, Int, Level, Limits, RenderPass, Statistics, TexelCopyLayout, Texture, TextureCopy,
    TextureDescriptor, TextureFormat, TextureUsages, TextureView, Vec2, Vec4, VertexIn, VertexOut,
};

/// A device with as many threads as processors.
pub(crate) fn device() -> Device {
    Device::new(&DeviceDescriptor::default()).unwrap()
}

/// A device with so many threads, at a SIMD level.
pub(crate) fn device_with(threads: usize, level: Level) -> Device {
    let descriptor = DeviceDescriptor {
        threads,
        level,
        ..DeviceDescriptor::default()
    };
    Device::new(&descriptor).unwrap()
}

/// Devices of every SIMD level, each with 1 and with 3 threads.
pub(crate) fn devices() -> impl Iterator<Item = (String, Device)> {
    Level::all_available().into_iter().flat_map(|level| {
        [1, 3].map(|threads| {
            let name = format!("{}, {threads} threads", level.name());
            (name, device_with(threads, level))
        })
    })
}

/// A 2D texture of one level and one sample.
pub(crate) fn texture(device: &Device, size: [u32; 2], format: TextureFormat) -> Texture {
    device
        .create_texture(&TextureDescriptor::new_2d(size[0], size[1], format))
        .unwrap()
}

/// A texture of two layers, three levels, sides that no block size divides.
pub(crate) fn layered(format: TextureFormat) -> TextureDescriptor<'static> {
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

/// A texture with a label and few uses.
pub(crate) fn labelled(device: &Device, label: &str, usage: TextureUsages) -> Texture {
    let descriptor = TextureDescriptor {
        label: Some(label),
        usage,
        ..TextureDescriptor::new_2d(8, 4, TextureFormat::Rgba8Unorm)
    };
    device.create_texture(&descriptor).unwrap()
}

/// A colour image and a depth image of the same size.
#[derive(Debug, Clone)]
pub(crate) struct Images {
    pub(crate) color: Texture,
    pub(crate) depth: Texture,
}

impl Images {
    /// Images of the formats that a pipeline has by default.
    pub(crate) fn new(device: &Device, width: u32, height: u32) -> Self {
        Self::with(device, [width, height], TextureFormat::Rgba8Unorm, 1)
    }

    pub(crate) fn with(
        device: &Device,
        size: [u32; 2],
        color: TextureFormat,
        samples: u32,
    ) -> Self {
        let create = |format| {
            let descriptor = TextureDescriptor {
                sample_count: samples,
                ..TextureDescriptor::new_2d(size[0], size[1], format)
            };
            device.create_texture(&descriptor).unwrap()
        };
        Self {
            color: create(color),
            depth: create(TextureFormat::Depth32Float),
        }
    }

    /// Clears the colour to zeros and the depth to 1, and draws.
    pub(crate) fn draw(&self, device: &Device, draws: &[Draw<'_>]) -> Statistics {
        device
            .render(&RenderPass {
                color_attachments: &[Some(ColorAttachment::clear(&self.color.view(), [0.0; 4]))],
                depth_stencil_attachment: Some(self.cleared_depth()),
                draws,
                ..RenderPass::default()
            })
            .unwrap()
    }

    pub(crate) fn cleared_depth(&self) -> DepthStencilAttachment {
        DepthStencilAttachment::clear(&self.depth.view(), 1.0)
    }

    /// The colours in the format's own bytes.
    pub(crate) fn pixels(&self, device: &Device) -> Vec<u8> {
        device.read_texture(&self.color).unwrap()
    }

    pub(crate) fn depths(&self, device: &Device) -> Vec<f32> {
        f32s(&device.read_texture(&self.depth).unwrap())
    }
}

/// The bytes of one level of all layers or slices, rows without padding.
pub(crate) fn read_level(device: &Device, texture: &Texture, level: u32) -> Vec<u8> {
    read_region(device, texture, [level, 0], texture.level_size(level))
}

/// The bytes of one level of one layer or slice, rows without padding.
pub(crate) fn read_layer(device: &Device, texture: &Texture, level: u32, layer: u32) -> Vec<u8> {
    let size = texture.level_size(level);
    let size = Extent3d::new_2d(size.width, size.height);
    read_region(device, texture, [level, layer], size)
}

fn read_region(
    device: &Device,
    texture: &Texture,
    [mip_level, layer]: [u32; 2],
    size: Extent3d,
) -> Vec<u8> {
    // Bytes that are not written would differ from the expected ones.
    let mut bytes = vec![0xEE; len_bytes(texture.format(), size)];
    let from = TextureCopy {
        mip_level,
        origin: [0, 0, layer],
        ..texture.into()
    };
    device
        .read_texture_into(from, &mut bytes, &TexelCopyLayout::default(), size)
        .unwrap();
    bytes
}

/// The bytes of rows without padding.
pub(crate) fn len_bytes(format: TextureFormat, size: Extent3d) -> usize {
    let [width, height] = format.block_size();
    let blocks = size.width.div_ceil(width) * size.height.div_ceil(height);
    (blocks * size.depth_or_array_layers * format.block_bytes()) as usize
}

/// Writes one level of all layers or slices, from rows without padding.
pub(crate) fn write_level(device: &Device, texture: &Texture, level: u32, bytes: &[u8]) {
    let to = TextureCopy {
        mip_level: level,
        ..texture.into()
    };
    let size = texture.level_size(level);
    device
        .write_texture(to, bytes, &TexelCopyLayout::default(), size)
        .unwrap();
}

/// The floats of little-endian bytes.
pub(crate) fn f32s(bytes: &[u8]) -> Vec<f32> {
    let numbers = bytes.as_chunks::<4>().0;
    numbers
        .iter()
        .map(|four| f32::from_le_bytes(*four))
        .collect()
}

/// Bytes that differ from place to place, the same on every machine.
pub(crate) fn noise(len: usize, seed: u32) -> Vec<u8> {
    let hash = |at: u32| {
        let hash = (at ^ seed.rotate_left(16)).wrapping_mul(0x9E37_79B9);
        let hash = (hash ^ (hash >> 15)).wrapping_mul(0x85EB_CA6B);
        hash.to_be_bytes()[0]
    };
    (0..).map(hash).take(len).collect()
}

/// Clears a view to a colour, in a pass without draws.
pub(crate) fn clear(device: &Device, view: &TextureView, color: [f64; 4]) {
    let attachment = ColorAttachment::clear(view, color);
    device
        .render(&RenderPass {
            color_attachments: &[Some(attachment)],
            ..RenderPass::default()
        })
        .unwrap();
}

/// A triangle over the whole attachment at a depth, in one colour.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fill {
    pub(crate) color: [f32; 4],
    pub(crate) depth: f32,
}

impl Fill {
    pub(crate) const WHITE: Self = Self {
        color: [1.0; 4],
        depth: 0.0,
    };
}

estampe::shader! {
    impl Shader for Fill {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, ()> {
            let at: Vec2<R> = covering(&input);
            VertexOut::new(Vec4::new(at.x, at.y, input.real(self.depth), input.real(1.0)), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            let [r, g, b, a] = self.color.map(|channel| input.real(channel));
            FragmentOut::color(Vec4::new(r, g, b, a))
        }
    }
}

/// The corners (−1, −1), (3, −1), (−1, 3) of a triangle that covers the viewport, by vertex index.
#[inline(always)]
pub(crate) fn covering<R: estampe::Real>(input: &VertexIn<'_, R>) -> Vec2<R> {
    let index = input.vertex_index.to_real();
    let [one, three, two] = [-1.0, 3.0, 2.0].map(|value| input.real(value));
    let x = R::select(index.eq(input.real(1.0)), three, one);
    let y = R::select(index.eq(two), three, one);
    Vec2::new(x, y)
}

/// A device with limits of its own.
pub(crate) fn limited(limits: Limits) -> Device {
    Device::new(&DeviceDescriptor {
        limits,
        ..DeviceDescriptor::default()
    })
    .unwrap()
}

/// A texture of 8×4 texels with four samples each.
pub(crate) fn samples(device: &Device, format: TextureFormat) -> Texture {
    let descriptor = TextureDescriptor {
        sample_count: 4,
        ..TextureDescriptor::new_2d(8, 4, format)
    };
    device.create_texture(&descriptor).unwrap()
}
