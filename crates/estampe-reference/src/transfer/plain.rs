//! A texture as plain rows of bytes.

use estampe_types::{TextureDimension, TextureFormat};

/// A texture as plain rows of bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlainTexture {
    /// Format of the texels.
    pub format: TextureFormat,
    /// Number of axes along which the texture is filtered.
    pub dimension: TextureDimension,
    /// Width, height, and depth or layers, in texels.
    pub size: [u32; 3],
    /// Samples per texel.
    pub samples: u32,
    /// By mip level, then by layer or depth.
    pub levels: Vec<Vec<PlainImage>>,
}

/// One mip level of one layer, or of one depth of a 3D texture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlainImage {
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Rows from the top, of texels or of compressed blocks. A row is the bytes of its texels one
    /// after the other, a texel those of its samples.
    pub rows: Vec<Vec<u8>>,
}

impl PlainTexture {
    /// A texture of zero bytes.
    #[must_use]
    pub fn zeros(
        format: TextureFormat,
        dimension: TextureDimension,
        size: [u32; 3],
        level_count: u32,
        samples: u32,
    ) -> Self {
        let mut texture = Self {
            format,
            dimension,
            size,
            samples,
            levels: Vec::new(),
        };
        for level in 0..level_count {
            let [width, height, slices] = texture.level_size(level);
            let [columns, rows] = texture.blocks_of([width, height]);
            let image = PlainImage {
                size: [width, height],
                rows: vec![vec![0; columns as usize * texture.block_bytes()]; rows as usize],
            };
            texture.levels.push(vec![image; slices as usize]);
        }
        texture
    }

    /// Width, height, and depth or layers, of a mip level: sides are halved and rounded down, at
    /// least 1; layers stay.
    #[must_use]
    pub fn level_size(&self, level: u32) -> [u32; 3] {
        let halved = |side: u32| (0..level).fold(side, |side, _| (side / 2).max(1));
        let [width, height, slices] = self.size;
        let slices = match self.dimension {
            TextureDimension::D3 => halved(slices),
            TextureDimension::D1 | TextureDimension::D2 => slices,
        };
        [halved(width), halved(height), slices]
    }

    /// Bytes of a texel with all its samples, or of a compressed block.
    #[must_use]
    pub fn block_bytes(&self) -> usize {
        self.format.block_bytes() as usize * self.samples as usize
    }

    /// The columns and rows of blocks that hold so many texels.
    #[must_use]
    pub fn blocks_of(&self, [width, height]: [u32; 2]) -> [u32; 2] {
        let [block_width, block_height] = self.format.block_size();
        [width.div_ceil(block_width), height.div_ceil(block_height)]
    }

    /// The bytes of a texel with all its samples, or of a block. `at` is column, row and slice.
    #[must_use]
    pub fn block(&self, level: u32, [column, row, slice]: [u32; 3]) -> &[u8] {
        let each = self.block_bytes();
        let image = &self.levels[level as usize][slice as usize];
        &image.rows[row as usize][column as usize * each..][..each]
    }

    /// As [`block`](Self::block), to be changed.
    #[must_use]
    pub fn block_mut(&mut self, level: u32, [column, row, slice]: [u32; 3]) -> &mut [u8] {
        let each = self.block_bytes();
        let image = &mut self.levels[level as usize][slice as usize];
        &mut image.rows[row as usize][column as usize * each..][..each]
    }
}
