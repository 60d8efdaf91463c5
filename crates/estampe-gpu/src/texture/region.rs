//! Regions of textures: which texels a copy reads or writes, and where their bytes are in memory.

use super::{Extent3d, ImageKey, Texture, TextureError};
use estampe_texture::region::{RowSpan, aspect_bytes};
use estampe_types::TextureAspect;

/// One side of a copy: a mip level, and where in it the region begins. WebGPU's
/// `GPUTexelCopyTextureInfo`.
#[derive(Debug, Clone)]
pub struct TextureCopy<'a> {
    /// The texture.
    pub texture: &'a Texture,
    /// The mip level. Default 0.
    pub mip_level: u32,
    /// The first texel: column, row, and layer or depth. Default zeros.
    pub origin: [u32; 3],
    /// The aspect of a depth-stencil format. Default all of it.
    pub aspect: TextureAspect,
}

impl<'a> From<&'a Texture> for TextureCopy<'a> {
    /// The full size, from the first texel on.
    fn from(texture: &'a Texture) -> Self {
        Self {
            texture,
            mip_level: 0,
            origin: [0; 3],
            aspect: TextureAspect::All,
        }
    }
}

impl TextureCopy<'_> {
    /// The same level, with the region's first texel in another column, row, and layer or depth.
    #[must_use]
    pub fn at(self, origin: [u32; 3]) -> Self {
        Self { origin, ..self }
    }

    /// The same region's first texel in another mip level.
    #[must_use]
    pub fn level(self, mip_level: u32) -> Self {
        Self { mip_level, ..self }
    }
}

/// The layout of a region's bytes in memory: WebGPU's `GPUTexelCopyBufferLayout`. The default is
/// without padding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TexelCopyLayout {
    /// The first byte. Default 0.
    pub offset: u64,
    /// Bytes from the start of a row (of blocks if the format is compressed) to the start of the
    /// next. Default those of the region's rows.
    pub bytes_per_row: Option<u32>,
    /// Rows (of blocks) from the start of a layer to the start of the next. Default those of the
    /// region.
    pub rows_per_image: Option<u32>,
}

/// A region that is known to lie in its level, of a texture that has its aspect.
#[derive(Debug, Clone, Copy)]
pub(super) struct Region {
    /// The mip level, and the first layer or slice.
    pub(super) key: ImageKey,
    origin: [usize; 2],
    columns: usize,
    /// Rows of texels, or of blocks; none without columns.
    rows: usize,
    layers: usize,
    block_height: usize,
    /// Bytes of a row without padding.
    pub(super) row_bytes: usize,
}

/// A region of a texture of one sample, and the layout of its bytes in memory that holds them.
#[derive(Debug, Clone, Copy)]
pub(super) struct RegionInMemory {
    region: Region,
    row_stride: usize,
    layer_stride: usize,
    offset: usize,
}

impl Region {
    /// Checks the rules of regions: WebGPU's *validating texture copy range*.
    pub(super) fn new(copy: &TextureCopy<'_>, size: Extent3d) -> Result<Self, TextureError> {
        let texture = copy.texture;
        let format = texture.format();
        let [block_width, block_height] = format.block_size();
        let has_level = copy.mip_level < texture.mip_level_count();
        let level = if has_level {
            texture.level_size(copy.mip_level)
        } else {
            Extent3d {
                width: 0,
                height: 0,
                depth_or_array_layers: 0,
            }
        };
        let fits = |first: u32, len: u32, side: u32, block: u32| {
            let end = first.checked_add(len);
            first.is_multiple_of(block)
                && end.is_some_and(|end| end <= side && (len.is_multiple_of(block) || end == side))
        };
        let [x, y, layer] = copy.origin;
        let Extent3d {
            width,
            height,
            depth_or_array_layers: layers,
        } = size;
        if !has_level
            || !fits(x, width, level.width, block_width)
            || !fits(y, height, level.height, block_height)
            || !fits(layer, layers, level.depth_or_array_layers, 1)
        {
            return Err(TextureError::Region {
                texture: texture.name(),
                level: copy.mip_level,
                origin: copy.origin,
                size,
                level_size: level,
                block: [block_width, block_height],
            });
        }
        let has_aspect = match copy.aspect {
            TextureAspect::All => true,
            TextureAspect::Depth => format.has_depth(),
            TextureAspect::Stencil => format.has_stencil(),
        };
        if !has_aspect {
            return Err(unsupported(texture, "it does not have this aspect"));
        }
        let each = aspect_bytes(format, copy.aspect);
        Ok(Self {
            key: ImageKey {
                level: copy.mip_level,
                layer,
            },
            origin: [x as usize, y as usize],
            columns: width as usize,
            rows: if width == 0 {
                0
            } else {
                height.div_ceil(block_height) as usize
            },
            layers: layers as usize,
            block_height: block_height as usize,
            row_bytes: width.div_ceil(block_width) as usize * each,
        })
    }

    /// Checks that `bytes` bytes of memory hold the region in a layout.
    pub(super) fn in_memory(
        self,
        texture: &Texture,
        layout: &TexelCopyLayout,
        bytes: usize,
    ) -> Result<RegionInMemory, TextureError> {
        if texture.sample_count() != 1 {
            let rule = "resolve a multisampled texture before it is copied to or from the host";
            return Err(unsupported(texture, rule));
        }
        let (rows, row_bytes) = (self.rows as u64, self.row_bytes as u64);
        let row_stride = layout.bytes_per_row.map_or(row_bytes, u64::from);
        let image_rows = layout.rows_per_image.map_or(rows, u64::from);
        let expected = if rows == 0 || self.layers == 0 {
            0
        } else {
            let last_layer = row_stride
                .saturating_mul(image_rows)
                .saturating_mul(self.layers as u64 - 1);
            let last_row = row_stride.saturating_mul(rows - 1);
            let end = last_layer
                .saturating_add(last_row)
                .saturating_add(row_bytes);
            end.saturating_add(layout.offset)
        };
        if row_stride < row_bytes || image_rows < rows || expected > bytes as u64 {
            return Err(TextureError::Bytes {
                texture: texture.name(),
                expected,
                bytes_per_row: row_bytes,
                actual: bytes as u64,
            });
        }
        // What is used is at most `expected`, the length of bytes in memory.
        let within = |value: u64| usize::try_from(value).unwrap_or(usize::MAX);
        Ok(RegionInMemory {
            region: self,
            row_stride: within(row_stride),
            layer_stride: within(row_stride.saturating_mul(image_rows)),
            offset: within(layout.offset),
        })
    }

    /// The number of bytes without padding.
    pub(super) fn tight_len(self) -> usize {
        self.row_bytes * self.rows * self.layers
    }

    /// Returns true if the region has all rows and columns of its images.
    pub(super) fn is_whole(self, texture: &Texture) -> bool {
        let level = texture.level_size(self.key.level);
        let [_, block_height] = texture.format().block_size();
        self.origin == [0, 0]
            && self.columns == level.width as usize
            && self.rows == level.height.div_ceil(block_height) as usize
    }

    /// The images that the region touches.
    pub(super) fn images(self) -> impl Iterator<Item = ImageKey> {
        let last = self.key.layer + u32::try_from(self.layers).unwrap_or_default();
        (self.key.layer..last).map(move |layer| ImageKey { layer, ..self.key })
    }

    /// The rows of one of the region's images, of blocks if the format is compressed.
    pub(super) fn spans_of(self, key: ImageKey) -> impl Iterator<Item = RowSpan> {
        (0..self.rows).map(move |row| RowSpan {
            level: key.level as usize,
            slice: key.layer as usize,
            x: self.origin[0],
            y: self.origin[1] + row * self.block_height,
            width: self.columns,
        })
    }
}

impl RegionInMemory {
    /// Each row of the region: the span of texels, and where its bytes begin.
    pub(super) fn spans(self) -> impl Iterator<Item = (RowSpan, usize)> {
        let images = self.region.images().enumerate();
        images.flat_map(move |(layer, key)| {
            let rows = self.region.spans_of(key).enumerate();
            rows.map(move |(row, span)| {
                let first = self.offset + layer * self.layer_stride + row * self.row_stride;
                (span, first)
            })
        })
    }
}

/// An error that names the rule which a texture breaks.
pub(super) fn unsupported(texture: &Texture, rule: &'static str) -> TextureError {
    TextureError::Unsupported {
        texture: texture.name(),
        format: texture.format(),
        samples: texture.sample_count(),
        rule,
    }
}
