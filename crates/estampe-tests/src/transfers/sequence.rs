//! Sequences of operations on textures and buffers, as plain data.

use crate::CaseDraw;
use crate::geometry::Vertex;
use estampe::{FilterMode, ResolveMode, SamplerDescriptor};
use estampe_reference::transfer::blit::Rectangle;
use estampe_reference::transfer::{Layout, Place};
use estampe_types::{TextureAspect, TextureDimension, TextureFormat, ViewDimension};

/// Textures, buffers and operations on them.
#[derive(Debug, Clone)]
pub struct Sequence {
    /// The textures.
    pub textures: Vec<TextureShape>,
    /// The bytes of each buffer, which are zeros at first.
    pub buffers: Vec<u64>,
    /// The operations, in order.
    pub operations: Vec<Operation>,
}

/// A texture to create.
#[derive(Debug, Clone)]
pub struct TextureShape {
    /// Format of the texels.
    pub format: TextureFormat,
    /// Number of axes along which the texture is filtered.
    pub dimension: TextureDimension,
    /// Width, height, and depth or layers.
    pub size: [u32; 3],
    /// Number of mip levels.
    pub levels: u32,
    /// Samples per texel.
    pub samples: u32,
    /// The seed of the texels of the first levels, and the number of those; `None` for zeros.
    pub given: Option<(u64, u32)>,
}

/// A place in one of the textures.
#[derive(Debug, Clone, Copy)]
pub struct Side {
    /// The texture.
    pub texture: usize,
    /// Where the region begins.
    pub place: Place,
}

/// One image of one of the textures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct ImageAt {
    /// The texture.
    pub texture: usize,
    /// The mip level.
    pub level: u32,
    /// The layer, or the depth of a 3D texture.
    pub slice: u32,
}

/// The host's memory: random bytes.
#[derive(Debug, Clone, Copy)]
pub struct Memory {
    /// The layout of the region in it.
    pub layout: Layout,
    /// The number of bytes.
    pub len: usize,
    /// The seed of the bytes.
    pub seed: u64,
}

/// An operation.
#[derive(Debug, Clone)]
pub enum Operation {
    /// `Buffer::write` of random bytes.
    WriteBuffer {
        /// The buffer.
        buffer: usize,
        /// The first byte.
        offset: u64,
        /// The bytes; their layout has no meaning.
        memory: Memory,
    },
    /// `Device::copy_buffer_to_buffer`: buffers and offsets.
    CopyBuffer {
        /// The source.
        from: (usize, u64),
        /// The destination.
        into: (usize, u64),
        /// The number of bytes.
        size: u64,
    },
    /// `Device::clear_buffer`.
    ClearBuffer {
        /// The buffer.
        buffer: usize,
        /// The first byte.
        offset: u64,
        /// The number of bytes.
        size: u64,
    },
    /// `Device::write_texture`.
    WriteTexture {
        /// The destination.
        into: Side,
        /// The size of the region.
        size: [u32; 3],
        /// The bytes.
        memory: Memory,
    },
    /// `Device::read_texture_into`.
    ReadTexture {
        /// The source.
        from: Side,
        /// The size of the region.
        size: [u32; 3],
        /// The memory that is read into.
        memory: Memory,
    },
    /// `Device::copy_buffer_to_texture`.
    BufferToTexture {
        /// The buffer and the layout in it.
        from: (usize, Layout),
        /// The destination.
        into: Side,
        /// The size of the region.
        size: [u32; 3],
    },
    /// `Device::copy_texture_to_buffer`.
    TextureToBuffer {
        /// The source.
        from: Side,
        /// The buffer and the layout in it.
        into: (usize, Layout),
        /// The size of the region.
        size: [u32; 3],
    },
    /// `Device::copy_texture_to_texture`.
    TextureToTexture {
        /// The source.
        from: Side,
        /// The destination.
        into: Side,
        /// The size of the region.
        size: [u32; 3],
    },
    /// `Device::clear_texture`.
    ClearTexture {
        /// The texture.
        texture: usize,
        /// The dimension of the view.
        dimension: ViewDimension,
        /// The first level and the number of levels.
        levels: [u32; 2],
        /// The first layer and the number of layers; all depths of a 3D texture.
        layers: [u32; 2],
        /// The aspect.
        aspect: TextureAspect,
    },
    /// `Device::generate_mips`.
    GenerateMips {
        /// The texture.
        texture: usize,
    },
    /// `Device::blit`.
    Blit {
        /// The source.
        from: BlitSide,
        /// The destination.
        into: BlitSide,
        /// The filter.
        filter: FilterMode,
    },
    /// `Device::render`.
    Render(Pass),
    /// A pass without attachments that stores to each texel of an image.
    Store {
        /// The image.
        image: ImageAt,
    },
    /// `Device::sampled_texture`: the texels as they are now, read after the last operation.
    Hold {
        /// The texture, of one sample.
        texture: usize,
    },
}

/// One side of a blit.
#[derive(Debug, Clone, Copy)]
pub struct BlitSide {
    /// The image.
    pub image: ImageAt,
    /// The format of its view.
    pub format: TextureFormat,
    /// The rectangle.
    pub rectangle: Rectangle,
}

/// A render pass.
#[derive(Debug, Clone)]
pub struct Pass {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel.
    pub samples: u32,
    /// The colour attachments.
    pub colors: Vec<ColorUse>,
    /// The depth-stencil attachment.
    pub depth_stencil: Option<DepthUse>,
    /// The draws.
    pub draws: Draws,
}

/// The draws of a pass.
#[derive(Debug, Clone)]
pub enum Draws {
    /// Draws of test shaders.
    Cases(Vec<CaseDraw>),
    /// One draw that samples a texture.
    Textured(TexturedDraw),
    /// One draw that compares a shadow map.
    Compared(ComparedDraw),
}

/// A draw that compares a shadow map.
#[derive(Debug, Clone)]
pub struct ComparedDraw {
    /// A triangle list; the first two values of a vertex are (u, v).
    pub vertices: Vec<Vertex>,
    /// The image of depths.
    pub image: ImageAt,
    /// The depth that it is compared with.
    pub reference: f32,
}

/// A draw that samples a texture.
#[derive(Debug, Clone)]
pub struct TexturedDraw {
    /// A triangle list; the first two values of a vertex are (u, v).
    pub vertices: Vec<Vertex>,
    /// The texture.
    pub texture: usize,
    /// The format of its view.
    pub format: TextureFormat,
    /// The first level and the number of levels.
    pub levels: [u32; 2],
    /// The layer.
    pub layer: u32,
    /// The sampler.
    pub sampler: SamplerDescriptor,
}

/// A colour attachment.
#[derive(Debug, Clone, Copy)]
pub struct ColorUse {
    /// The image.
    pub image: ImageAt,
    /// The format of its view.
    pub format: TextureFormat,
    /// The colour that it is cleared to; `None` loads it.
    pub clear: Option<[f64; 4]>,
    /// If not set, it is discarded.
    pub is_stored: bool,
    /// The image that its samples are resolved into.
    pub resolve: Option<ImageAt>,
}

/// A depth-stencil attachment.
#[derive(Debug, Clone, Copy)]
pub struct DepthUse {
    /// The image.
    pub image: ImageAt,
    /// The operations on depth; `None` is read-only.
    pub depth: Option<AspectUse<f32>>,
    /// The operations on stencil; `None` is read-only.
    pub stencil: Option<AspectUse<u8>>,
    /// The image that its samples are resolved into, by these modes of depth and stencil.
    pub resolve: Option<(ImageAt, [Option<ResolveMode>; 2])>,
}

/// The operations of a pass on an aspect.
#[derive(Debug, Clone, Copy)]
pub struct AspectUse<T> {
    /// The value that it is cleared to; `None` loads it.
    pub clear: Option<T>,
    /// If not set, it is discarded.
    pub is_stored: bool,
}

impl TextureShape {
    /// Width, height, and depth or layers, of a mip level.
    #[must_use]
    pub fn level_size(&self, level: u32) -> [u32; 3] {
        let halved = |side: u32| (side >> level).max(1);
        let [width, height, slices] = self.size;
        let slices = match self.dimension {
            TextureDimension::D3 => halved(slices),
            _ => slices,
        };
        [halved(width), halved(height), slices]
    }

    /// The greatest number of mip levels.
    #[must_use]
    pub fn most_levels(&self) -> u32 {
        let [width, height, slices] = self.size;
        let depth = match self.dimension {
            TextureDimension::D3 => slices,
            _ => 1,
        };
        width.max(height).max(depth).ilog2() + 1
    }

    /// The random bytes of the first levels, without padding.
    #[must_use]
    pub fn given_bytes(&self) -> Vec<Vec<u8>> {
        let Some((seed, count)) = self.given else {
            return Vec::new();
        };
        let [block_width, block_height] = self.format.block_size();
        let of_level = |level: u32| {
            let [width, height, slices] = self.level_size(level);
            let blocks = width.div_ceil(block_width) * height.div_ceil(block_height) * slices;
            let each = self.format.block_bytes() * self.samples;
            noise(seed + u64::from(level), (blocks * each) as usize)
        };
        (0..count).map(of_level).collect()
    }
}

impl DepthUse {
    /// Returns true if a pass writes an aspect that the format has.
    #[must_use]
    pub fn is_written(&self, format: TextureFormat) -> bool {
        self.depth.is_some() && format.has_depth() || self.stencil.is_some() && format.has_stencil()
    }
}

impl Pass {
    /// The formats of the colour attachments' views.
    #[must_use]
    pub fn formats(&self) -> Vec<TextureFormat> {
        self.colors.iter().map(|color| color.format).collect()
    }

    /// All images that the pass uses as attachments and resolve targets.
    pub fn images(&self) -> impl Iterator<Item = ImageAt> {
        let colors = self.colors.iter();
        let colors = colors.flat_map(|color| [Some(color.image), color.resolve]);
        let depth = self.depth_stencil.iter().flat_map(|depth| {
            let resolve = depth.resolve.map(|(image, _)| image);
            [Some(depth.image), resolve]
        });
        colors.chain(depth).flatten()
    }
}

/// Random bytes.
#[must_use]
pub fn noise(seed: u64, len: usize) -> Vec<u8> {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut bytes = vec![0; len];
    random.fill(&mut bytes);
    bytes
}
