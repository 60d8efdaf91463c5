//! The operations outside of passes, and the textures and buffers that they change.

use crate::transfers::sequence::{
    BlitSide, ImageAt, Memory, Operation, Sequence, Side, TextureShape, noise,
};
use estampe_reference::transfer::texel::set_aspect;
use estampe_reference::transfer::{PlainImage, PlainTexture, Rule, blit, copy, mips, sampled};
use estampe_texture::{LevelData, MipGeneration, TexelDescriptor};
use estampe_types::{Limits, SamplerDescriptor, TextureAspect, TextureDimension, TextureFormat};
use std::sync::Arc;

/// What the caller sees of an operation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    /// It was done.
    Done,
    /// It was refused, and changed nothing.
    Refused,
    /// Bytes that were read.
    Read(Vec<u8>),
}

/// Textures and buffers of the oracle.
#[derive(Debug, Clone)]
pub struct Model {
    /// The textures.
    pub textures: Vec<PlainTexture>,
    /// The buffers.
    pub buffers: Vec<Vec<u8>>,
    /// The textures that were held, as they were then.
    pub held: Vec<Arc<estampe_types::TexelData>>,
}

impl Model {
    /// The textures and buffers of a sequence before its first operation.
    #[must_use]
    pub fn new(sequence: &Sequence) -> Self {
        let len = |size: &u64| usize::try_from(*size).expect("small buffers");
        Self {
            textures: sequence.textures.iter().map(created).collect(),
            buffers: sequence
                .buffers
                .iter()
                .map(|size| vec![0; len(size)])
                .collect(),
            held: Vec::new(),
        }
    }

    /// Executes an operation.
    pub fn apply(&mut self, operation: &Operation) -> Outcome {
        let result = match operation {
            Operation::WriteBuffer {
                buffer,
                offset,
                memory,
            } => {
                let bytes = noise(memory.seed, memory.len);
                let size = bytes.len() as u64;
                copy::copy_bytes((&bytes, 0), (&mut self.buffers[*buffer], *offset), size)
            }
            Operation::CopyBuffer { from, into, size } => {
                let source = self.buffers[from.0].clone();
                let destination = &mut self.buffers[into.0];
                copy::copy_bytes((&source, from.1), (destination, into.1), *size)
            }
            Operation::ClearBuffer {
                buffer,
                offset,
                size,
            } => copy::clear_bytes(&mut self.buffers[*buffer], *offset, *size),
            Operation::WriteTexture { into, size, memory } => {
                let bytes = noise(memory.seed, memory.len);
                let texture = &mut self.textures[into.texture];
                copy::write(texture, &into.place, *size, (&bytes, &memory.layout))
            }
            Operation::ReadTexture { from, size, memory } => {
                return self.read(from, *size, memory);
            }
            Operation::BufferToTexture { from, into, size } => {
                let texture = &mut self.textures[into.texture];
                let bytes = (&self.buffers[from.0][..], &from.1);
                copy::write(texture, &into.place, *size, bytes)
            }
            Operation::TextureToBuffer { from, into, size } => {
                let texture = &self.textures[from.texture];
                let bytes = (&mut self.buffers[into.0][..], &into.1);
                copy::read(texture, &from.place, *size, bytes)
            }
            Operation::TextureToTexture { from, into, size } => {
                let source = self.textures[from.texture].clone();
                let destination = &mut self.textures[into.texture];
                let from = (&source, &from.place);
                copy::copy(from, (destination, &into.place), *size)
            }
            Operation::ClearTexture {
                texture,
                levels: [first, count],
                layers,
                aspect,
                ..
            } => {
                let texture = &mut self.textures[*texture];
                let is_3d = texture.dimension == TextureDimension::D3;
                let sizes = texture.clone();
                let slices = |level: u32| match is_3d {
                    true => 0..sizes.level_size(level)[2],
                    false => layers[0]..layers[0] + layers[1],
                };
                copy::clear(texture, *first..first + count, slices, *aspect);
                Ok(())
            }
            Operation::GenerateMips { texture } => {
                let texture = &mut self.textures[*texture];
                if mips::is_possible(texture.format) {
                    mips::generate(texture, 1);
                    Ok(())
                } else {
                    Err(Rule::Formats)
                }
            }
            Operation::Blit { from, into, filter } => {
                let sampler = SamplerDescriptor {
                    mag_filter: *filter,
                    min_filter: *filter,
                    ..SamplerDescriptor::default()
                };
                self.blit((from, sampler), into);
                Ok(())
            }
            Operation::Render(pass) => {
                self.render(pass);
                Ok(())
            }
            Operation::Store { image } => {
                self.store(*image);
                Ok(())
            }
            Operation::Hold { texture } => {
                let format = self.textures[*texture].format;
                self.held.push(self.sampled(*texture, format));
                Ok(())
            }
        };
        match result {
            Ok(()) => Outcome::Done,
            Err(_) => Outcome::Refused,
        }
    }

    fn read(&self, from: &Side, size: [u32; 3], memory: &Memory) -> Outcome {
        let mut bytes = noise(memory.seed, memory.len);
        let texture = &self.textures[from.texture];
        let into = (&mut bytes[..], &memory.layout);
        match copy::read(texture, &from.place, size, into) {
            Ok(()) => Outcome::Read(bytes),
            Err(_) => Outcome::Refused,
        }
    }

    fn blit(&mut self, (from, sampler): (&BlitSide, SamplerDescriptor), into: &BlitSide) {
        let source = self.sampled(from.image.texture, from.format);
        let ImageAt { level, slice, .. } = from.image;
        let view = sampled::image_view(source, [level, slice], sampler);
        let image = self.image_mut(into.image);
        blit::blit(
            (&view, from.rectangle),
            (image, into.format, into.rectangle),
        );
    }

    pub(super) fn sampled(
        &self,
        texture: usize,
        format: TextureFormat,
    ) -> Arc<estampe_types::TexelData> {
        Arc::new(sampled::texture(&self.textures[texture], format, decoded))
    }

    pub(super) fn image(&self, at: ImageAt) -> &PlainImage {
        &self.textures[at.texture].levels[at.level as usize][at.slice as usize]
    }

    pub(super) fn image_mut(&mut self, at: ImageAt) -> &mut PlainImage {
        &mut self.textures[at.texture].levels[at.level as usize][at.slice as usize]
    }
}

/// The texture as it is created.
fn created(shape: &TextureShape) -> PlainTexture {
    let mut texture = PlainTexture::zeros(
        shape.format,
        shape.dimension,
        shape.size,
        shape.levels,
        shape.samples,
    );
    let given = shape.given_bytes();
    let each = shape.format.block_bytes() as usize;
    for (level, bytes) in texture.levels.iter_mut().zip(&given) {
        let rows = level.iter_mut().flat_map(|image| &mut image.rows);
        let texels = rows.flat_map(|row| row.chunks_mut(each));
        for (texel, bytes) in texels.zip(bytes.chunks(each)) {
            set_aspect(shape.format, TextureAspect::All, texel, bytes);
        }
    }
    let first = u32::try_from(given.len()).expect("few levels");
    if first > 0 && first < shape.levels {
        mips::generate(&mut texture, first);
    }
    texture
}

/// The texels of a compressed block, as textures are made of it.
fn decoded(format: TextureFormat, block: &[u8]) -> Vec<u32> {
    let [width, height] = format.block_size();
    let descriptor = TexelDescriptor::new_2d(width, height, format);
    let texture = descriptor.create(
        &[LevelData::tight(block)],
        MipGeneration::None,
        &Limits::default(),
    );
    texture.expect("one block").texels.to_vec()
}
