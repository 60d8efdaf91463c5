//! Random operations on the objects of a sequence: mostly valid, some just beyond a rule.

use super::random_passes::{random_image, random_pass};
use super::random_textures::toggled;
use super::sequence::{BlitSide, ImageAt, Memory, Operation, Sequence, Side, TextureShape};
use crate::Random;
use estampe::{FilterMode, SampleType};
use estampe_reference::transfer::blit::Rectangle;
use estampe_reference::transfer::texel::{aspect_bytes, has_aspect};
use estampe_reference::transfer::{Layout, Place};
use estampe_types::{TextureAspect, TextureDimension, TextureFormat, ViewDimension};

impl Sequence {
    /// A sequence of random operations on random objects.
    #[must_use]
    pub fn random(random: &mut Random, seed: u64) -> Self {
        let mut sequence = Self::random_objects(random, seed);
        let count = 10 + random.index(20);
        while sequence.operations.len() < count {
            let operation = sequence.operation(random);
            sequence.operations.extend(operation);
        }
        sequence
    }

    /// An operation; `None` if the chosen kind is not possible with these objects.
    fn operation(&self, random: &mut Random) -> Option<Operation> {
        match random.below(26) {
            0 => Some(self.buffer_operation(random)),
            1 | 2 => {
                let (into, size) = self.side(random);
                let memory = self.memory(random, &into, size);
                Some(Operation::WriteTexture { into, size, memory })
            }
            3 => {
                let (from, size) = self.side(random);
                let memory = self.memory(random, &from, size);
                Some(Operation::ReadTexture { from, size, memory })
            }
            4 => Some(self.whole_read(random)),
            5 | 6 => {
                let (into, size) = self.side(random);
                let layout = self.memory(random, &into, size).layout;
                let from = (random.index(self.buffers.len()), layout);
                Some(Operation::BufferToTexture { from, into, size })
            }
            7 | 8 => {
                let (from, size) = self.side(random);
                let layout = self.memory(random, &from, size).layout;
                let into = (random.index(self.buffers.len()), layout);
                Some(Operation::TextureToBuffer { from, into, size })
            }
            9..=11 => self.texture_copy(random),
            12 => Some(self.clear(random)),
            13 => Some(Operation::GenerateMips {
                texture: random.index(self.textures.len()),
            }),
            14..=16 => self.blit(random),
            17 => self.store(random),
            18 => self.hold(random),
            _ => random_pass(random, &self.textures).map(Operation::Render),
        }
    }

    fn buffer_operation(&self, random: &mut Random) -> Operation {
        let mut place = || {
            let buffer = random.index(self.buffers.len());
            let len = u32::try_from(self.buffers[buffer]).expect("small buffers");
            // Now and then beyond the end.
            (buffer, u64::from(random.below(len + len / 16)))
        };
        let (from, into) = (place(), place());
        let size = u64::from(random.below(3000));
        match random.below(3) {
            0 => Operation::CopyBuffer { from, into, size },
            1 => Operation::ClearBuffer {
                buffer: into.0,
                offset: into.1,
                size,
            },
            _ => Operation::WriteBuffer {
                buffer: into.0,
                offset: into.1,
                memory: Memory {
                    layout: Layout::default(),
                    len: usize::try_from(size).expect("below 3000"),
                    seed: u64::from(random.bits()),
                },
            },
        }
    }

    /// A region of a level of a texture.
    fn side(&self, random: &mut Random) -> (Side, [u32; 3]) {
        let texture = random.index(self.textures.len());
        let shape = &self.textures[texture];
        let level = random.below(shape.levels);
        let sides = shape.level_size(level);
        let [_, (origin, size)] = region(random, shape.format, [sides, sides]);
        let mut place = Place {
            level,
            origin,
            aspect: aspect(random, shape.format),
        };
        let mut size = size;
        spoil(random, &mut place, &mut size);
        (Side { texture, place }, size)
    }

    /// All of one image, in memory of exactly its size: what is read most often.
    fn whole_read(&self, random: &mut Random) -> Operation {
        let texture = random.index(self.textures.len());
        let shape = &self.textures[texture];
        let level = random.below(shape.levels);
        let [width, height, slices] = shape.level_size(level);
        let size = [width, height, 1];
        let from = Side {
            texture,
            place: Place {
                level,
                origin: [0, 0, random.below(slices)],
                aspect: TextureAspect::All,
            },
        };
        let memory = Memory {
            layout: Layout::default(),
            len: self.tight(&from, size).iter().product(),
            seed: 0,
        };
        Operation::ReadTexture { from, size, memory }
    }

    /// Bytes of a row, rows and layers of a region without padding.
    fn tight(&self, side: &Side, [width, height, layers]: [u32; 3]) -> [usize; 3] {
        let format = self.textures[side.texture].format;
        let [block_width, block_height] = format.block_size();
        let row = width.div_ceil(block_width) as usize * aspect_bytes(format, side.place.aspect);
        [row, height.div_ceil(block_height) as usize, layers as usize]
    }

    /// Memory for a region: tight, padded, or now and then too small.
    fn memory(&self, random: &mut Random, side: &Side, size: [u32; 3]) -> Memory {
        let [row, rows, layers] = self.tight(side, size);
        let mut layout = Layout::default();
        let (mut stride, mut image_rows) = (row, rows);
        if random.once_in(2) {
            stride = row + random.index(9);
            image_rows = rows + random.index(3);
            if random.once_in(30) {
                stride = row.saturating_sub(1);
            }
            layout = Layout {
                offset: u64::from(random.below(20)),
                bytes_per_row: u32::try_from(stride).ok(),
                rows_per_image: u32::try_from(image_rows).ok(),
            };
        }
        let len = usize::try_from(layout.offset).unwrap_or_default() + stride * image_rows * layers;
        let len = if random.once_in(20) {
            len.saturating_sub(1 + random.index(4))
        } else {
            len + random.pick(&[0, 0, 3])
        };
        Memory {
            layout,
            len,
            seed: u64::from(random.bits()),
        }
    }

    /// A copy between two textures of the same format, or inside one.
    fn texture_copy(&self, random: &mut Random) -> Option<Operation> {
        let from = random.index(self.textures.len());
        let shape = &self.textures[from];
        let plain = shape.format.with_srgb(false);
        let fits = |into: &usize| {
            let other = &self.textures[*into];
            other.format.with_srgb(false) == plain && other.samples == shape.samples
        };
        let partners: Vec<usize> = (0..self.textures.len()).filter(fits).collect();
        let into = if random.once_in(40) {
            random.index(self.textures.len())
        } else {
            random.pick(&partners)
        };
        let other = &self.textures[into];
        let [level, other_level] = [shape, other].map(|shape| random.below(shape.levels));
        let sides = [shape.level_size(level), other.level_size(other_level)];
        let [mut first, mut second] = region(random, shape.format, sides);
        if shape.samples > 1 && !random.once_in(8) {
            // Whole images.
            for (origin, size) in [&mut first, &mut second] {
                *origin = [0, 0, origin[2]];
                *size = [sides[0][0], sides[0][1], size[2]];
            }
        }
        let aspect = aspect(random, shape.format);
        let [from, mut into] = [(from, level, first.0), (into, other_level, second.0)].map(
            |(texture, level, origin)| Side {
                texture,
                place: Place {
                    level,
                    origin,
                    aspect,
                },
            },
        );
        let mut size = first.1;
        spoil(random, &mut into.place, &mut size);
        Some(Operation::TextureToTexture { from, into, size })
    }

    fn clear(&self, random: &mut Random) -> Operation {
        let texture = random.index(self.textures.len());
        let shape = &self.textures[texture];
        let [first, count] = part(random, shape.levels);
        let slices = shape.size[2];
        let (dimension, layers) = match shape.dimension {
            TextureDimension::D1 => (ViewDimension::D1, [0, 1]),
            TextureDimension::D3 => (ViewDimension::D3, [0, 1]),
            TextureDimension::D2 => {
                let layers = part(random, slices);
                let is_square = shape.size[0] == shape.size[1];
                if shape.samples > 1 || random.once_in(3) {
                    (ViewDimension::D2, [layers[0], 1])
                } else if is_square && slices == 6 {
                    (ViewDimension::Cube, [0, 6])
                } else {
                    (ViewDimension::D2Array, layers)
                }
            }
        };
        Operation::ClearTexture {
            texture,
            dimension,
            levels: [first, count],
            layers,
            aspect: random.pick(&aspects_of(shape.format)),
        }
    }

    fn store(&self, random: &mut Random) -> Option<Operation> {
        let texture = random.index(self.textures.len());
        let shape = &self.textures[texture];
        let is_storable = shape.format.is_renderable() && !shape.format.is_srgb();
        (is_storable && shape.samples == 1).then(|| Operation::Store {
            image: random_image(random, &self.textures, texture),
        })
    }

    fn hold(&self, random: &mut Random) -> Option<Operation> {
        let texture = random.index(self.textures.len());
        (self.textures[texture].samples == 1).then_some(Operation::Hold { texture })
    }

    fn blit(&self, random: &mut Random) -> Option<Operation> {
        let is_flat = |shape: &TextureShape| {
            shape.dimension == TextureDimension::D2
                && shape.samples == 1
                && shape.format.sample_type() == SampleType::Float
        };
        let (from, into) = (
            random.index(self.textures.len()),
            random.index(self.textures.len()),
        );
        let (source, destination) = (&self.textures[from], &self.textures[into]);
        let is_possible = from != into
            && is_flat(source)
            && is_flat(destination)
            && destination.format.is_renderable();
        if !is_possible {
            return None;
        }
        let side = |random: &mut Random, texture: usize| {
            let shape = &self.textures[texture];
            let level = random.below(shape.levels);
            let [width, height, layers] = shape.level_size(level);
            let [x, y] = [part(random, width), part(random, height)];
            BlitSide {
                image: ImageAt {
                    texture,
                    level,
                    slice: random.below(layers),
                },
                format: toggled(random, shape.format),
                rectangle: Rectangle {
                    origin: [x[0], y[0]],
                    size: [x[1], y[1]],
                },
            }
        };
        Some(Operation::Blit {
            from: side(random, from),
            into: side(random, into),
            filter: random.pick(&[FilterMode::Nearest, FilterMode::Linear]),
        })
    }
}

/// A part of 0..len: first and length, not empty, often everything.
fn part(random: &mut Random, len: u32) -> [u32; 2] {
    if random.once_in(3) {
        return [0, len];
    }
    let first = random.below(len);
    [first, 1 + random.below(len - first)]
}

/// The aspects of a format.
fn aspects_of(format: TextureFormat) -> Vec<TextureAspect> {
    let mut aspects = vec![
        TextureAspect::All,
        TextureAspect::Depth,
        TextureAspect::Stencil,
    ];
    aspects.retain(|aspect| has_aspect(format, *aspect));
    aspects
}

/// An aspect of the format, now and then one that it does not have.
fn aspect(random: &mut Random, format: TextureFormat) -> TextureAspect {
    if random.once_in(60) {
        return random.pick(&[TextureAspect::Depth, TextureAspect::Stencil]);
    }
    random.pick(&aspects_of(format))
}

/// Origins of a region in two levels of the same format, and its size.
fn region(
    random: &mut Random,
    format: TextureFormat,
    [first, second]: [[u32; 3]; 2],
) -> [([u32; 3], [u32; 3]); 2] {
    let [block_width, block_height] = format.block_size();
    let (mut origins, mut size) = ([[0; 3]; 2], [0; 3]);
    for (axis, block) in [block_width, block_height, 1].into_iter().enumerate() {
        let ([from, into], len) = along(random, [first[axis], second[axis]], block);
        origins[0][axis] = from;
        origins[1][axis] = into;
        size[axis] = len;
    }
    origins.map(|origin| (origin, size))
}

/// First texels in two sides, and a length: whole blocks, or up to the ends of both sides.
fn along(random: &mut Random, sides: [u32; 2], block: u32) -> ([u32; 2], u32) {
    let [first, second] = sides;
    let blocks = first.min(second) / block;
    let rest = first % block;
    if second % block == rest && (blocks == 0 || random.once_in(2)) {
        // To the end of both sides.
        let most = blocks + u32::from(rest > 0);
        let taken = most - random.below(most.max(1));
        let len = if rest > 0 {
            (taken - 1) * block + rest
        } else {
            taken * block
        };
        return ([first - len, second - len], len);
    }
    let taken = if blocks > 0 && !random.once_in(40) {
        1 + random.below(blocks)
    } else {
        0
    };
    let origin = |random: &mut Random, side: u32| random.below(side / block - taken + 1) * block;
    (
        [origin(random, first), origin(random, second)],
        taken * block,
    )
}

/// Now and then moves a region over a border.
fn spoil(random: &mut Random, place: &mut Place, size: &mut [u32; 3]) {
    if !random.once_in(16) {
        return;
    }
    let axis = random.index(3);
    match random.below(5) {
        0 => place.origin[axis] += 1,
        1 => size[axis] += 1,
        2 => place.level += 1,
        3 => place.origin[axis] = u32::MAX,
        _ => size[axis] = 0,
    }
}
