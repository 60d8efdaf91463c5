//! The operations outside of passes.

use crate::transfers::on_model::Outcome;
use crate::transfers::sequence::{BlitSide, ImageAt, Operation, Sequence, Side, noise};
use estampe::{
    BlitRegion, Buffer, BufferDescriptor, Device, Extent3d, SampledTexture, SamplerDescriptor,
    TexelCopyLayout, Texture, TextureCopy, TextureDescriptor, TextureView, TextureViewDescriptor,
};
use estampe_reference::transfer::Layout;
use estampe_types::{TextureAspect, TextureDimension, TextureFormat, ViewDimension};

/// Textures and buffers of a device.
#[derive(Debug)]
pub struct Objects<'d> {
    pub(super) device: &'d Device,
    pub(super) textures: Vec<Texture>,
    pub(super) buffers: Vec<Buffer>,
    pub(super) held: Vec<SampledTexture>,
}

impl<'d> Objects<'d> {
    /// Creates the textures and buffers of a sequence.
    ///
    /// # Panics
    /// If the device refuses one.
    #[must_use]
    pub fn new(device: &'d Device, sequence: &Sequence) -> Self {
        let textures = sequence.textures.iter().map(|shape| {
            let descriptor = TextureDescriptor {
                size: extent(shape.size),
                mip_level_count: shape.levels,
                sample_count: shape.samples,
                dimension: shape.dimension,
                ..TextureDescriptor::new_2d(1, 1, shape.format)
            };
            let given = shape.given_bytes();
            let levels: Vec<&[u8]> = given.iter().map(Vec::as_slice).collect();
            let texture = if levels.is_empty() {
                device.create_texture(&descriptor)
            } else {
                device.create_texture_with_data(&descriptor, &levels)
            };
            texture.expect("a valid texture")
        });
        let buffers = sequence.buffers.iter().map(|size| {
            let buffer = device.create_buffer(&BufferDescriptor::new(*size));
            buffer.expect("a small buffer")
        });
        Self {
            device,
            textures: textures.collect(),
            buffers: buffers.collect(),
            held: Vec::new(),
        }
    }

    /// Executes an operation.
    ///
    /// # Panics
    /// If the device refuses a blit or a pass, which are always valid.
    pub fn apply(&mut self, operation: &Operation) -> Outcome {
        let device = self.device;
        let is_done = match operation {
            Operation::WriteBuffer {
                buffer,
                offset,
                memory,
            } => {
                let bytes = noise(memory.seed, memory.len);
                self.buffers[*buffer].write(*offset, &bytes).is_ok()
            }
            Operation::CopyBuffer { from, into, size } => {
                let [from, into] = [from, into].map(|(buffer, at)| (&self.buffers[*buffer], *at));
                device.copy_buffer_to_buffer(from, into, *size).is_ok()
            }
            Operation::ClearBuffer {
                buffer,
                offset,
                size,
            } => device
                .clear_buffer(&self.buffers[*buffer], *offset, *size)
                .is_ok(),
            Operation::WriteTexture { into, size, memory } => {
                let bytes = noise(memory.seed, memory.len);
                let layout = layout(&memory.layout);
                device
                    .write_texture(self.side(into), &bytes, &layout, extent(*size))
                    .is_ok()
            }
            Operation::ReadTexture { from, size, memory } => {
                let mut bytes = noise(memory.seed, memory.len);
                let layout = layout(&memory.layout);
                let size = extent(*size);
                let read = device.read_texture_into(self.side(from), &mut bytes, &layout, size);
                return match read {
                    Ok(()) => Outcome::Read(bytes),
                    Err(_) => Outcome::Refused,
                };
            }
            Operation::BufferToTexture { from, into, size } => {
                let from = (&self.buffers[from.0], &layout(&from.1));
                device
                    .copy_buffer_to_texture(from, self.side(into), extent(*size))
                    .is_ok()
            }
            Operation::TextureToBuffer { from, into, size } => {
                let into = (&self.buffers[into.0], &layout(&into.1));
                device
                    .copy_texture_to_buffer(self.side(from), into, extent(*size))
                    .is_ok()
            }
            Operation::TextureToTexture { from, into, size } => device
                .copy_texture_to_texture(self.side(from), self.side(into), extent(*size))
                .is_ok(),
            Operation::ClearTexture {
                texture,
                dimension,
                levels,
                layers,
                aspect,
            } => {
                let view = self.textures[*texture].create_view(&TextureViewDescriptor {
                    format: None,
                    dimension: Some(*dimension),
                    base_mip_level: levels[0],
                    mip_level_count: Some(levels[1]),
                    base_array_layer: layers[0],
                    array_layer_count: Some(layers[1]),
                    aspect: *aspect,
                });
                device.clear_texture(&view.expect("a valid view")).is_ok()
            }
            Operation::GenerateMips { texture } => {
                device.generate_mips(&self.textures[*texture]).is_ok()
            }
            Operation::Blit { from, into, filter } => {
                let [from, into] = [from, into].map(|side| (self.blit_view(side), side.rectangle));
                let [from, into] = [&from, &into].map(|(view, rectangle)| BlitRegion {
                    view,
                    origin: rectangle.origin,
                    size: rectangle.size,
                });
                device.blit(from, into, *filter).expect("a valid blit");
                true
            }
            Operation::Render(pass) => {
                self.render(pass);
                true
            }
            Operation::Store { image } => {
                self.store(*image);
                true
            }
            Operation::Hold { texture } => {
                let sampler = device.create_sampler(&SamplerDescriptor::default());
                let view = self.textures[*texture].view();
                let held = device.sampled_texture(&view, &sampler.expect("the default"));
                self.held.push(held.expect("a texture of one sample"));
                true
            }
        };
        if is_done {
            Outcome::Done
        } else {
            Outcome::Refused
        }
    }

    fn side(&self, side: &Side) -> TextureCopy<'_> {
        TextureCopy {
            texture: &self.textures[side.texture],
            mip_level: side.place.level,
            origin: side.place.origin,
            aspect: side.place.aspect,
        }
    }

    fn blit_view(&self, side: &BlitSide) -> TextureView {
        self.view(side.image, side.format, TextureAspect::All)
    }

    /// The view of an image; of a 3D texture that of all depths of its level.
    pub(super) fn view(
        &self,
        at: ImageAt,
        format: TextureFormat,
        aspect: TextureAspect,
    ) -> TextureView {
        let texture = &self.textures[at.texture];
        let dimension = match texture.dimension() {
            TextureDimension::D1 => ViewDimension::D1,
            TextureDimension::D2 => ViewDimension::D2,
            TextureDimension::D3 => ViewDimension::D3,
        };
        let is_3d = dimension == ViewDimension::D3;
        let view = texture.create_view(&TextureViewDescriptor {
            format: Some(format),
            dimension: Some(dimension),
            aspect,
            ..TextureViewDescriptor::image(at.level, if is_3d { 0 } else { at.slice })
        });
        view.expect("an image that there is")
    }
}

fn extent([width, height, depth_or_array_layers]: [u32; 3]) -> Extent3d {
    Extent3d {
        width,
        height,
        depth_or_array_layers,
    }
}

fn layout(layout: &Layout) -> TexelCopyLayout {
    TexelCopyLayout {
        offset: layout.offset,
        bytes_per_row: layout.bytes_per_row,
        rows_per_image: layout.rows_per_image,
    }
}
