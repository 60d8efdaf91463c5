//! Which blocks a copy touches, where their bytes are in memory, and the rules.

use super::PlainTexture;
use super::texel::{aspect_bytes, has_aspect};
use estampe_types::TextureAspect;
use std::ops::Range;

/// Where in a texture a copy begins: WebGPU's `GPUTexelCopyTextureInfo` without the texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// The mip level.
    pub level: u32,
    /// The first texel: column, row, and layer or depth.
    pub origin: [u32; 3],
    /// The aspect of a depth-stencil format.
    pub aspect: TextureAspect,
}

/// The layout of bytes in memory: WebGPU's `GPUTexelCopyBufferLayout`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Layout {
    /// The first byte.
    pub offset: u64,
    /// Bytes from row to row; `None` without padding.
    pub bytes_per_row: Option<u32>,
    /// Rows from slice to slice; `None` without padding.
    pub rows_per_image: Option<u32>,
}

/// The rule that an operation breaks; nothing is changed then.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// A region lies in an existing level, and begins and ends at blocks or at the level's end.
    Region,
    /// The format has the aspect.
    Aspect,
    /// A texture of several samples is copied to one of as many, whole images at a time.
    Samples,
    /// The memory holds the region in its layout.
    Bytes,
    /// Formats differ at most in sRGB, and the aspects are the same.
    Formats,
}

/// The blocks of a region, in a level of a texture; without compression a block is a texel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Blocks {
    /// Columns of blocks.
    pub columns: Range<u32>,
    /// Rows of blocks.
    pub rows: Range<u32>,
    /// Layers, or depths.
    pub slices: Range<u32>,
}

impl Blocks {
    /// The blocks of a region; `size` is in texels.
    ///
    /// # Errors
    /// [`Rule::Region`] or [`Rule::Aspect`].
    pub fn of(texture: &PlainTexture, place: &Place, size: [u32; 3]) -> Result<Self, Rule> {
        if place.level as usize >= texture.levels.len() {
            return Err(Rule::Region);
        }
        let level = texture.level_size(place.level);
        let [block_width, block_height] = texture.format.block_size();
        let along = |axis: usize, block: u32| {
            let (first, side) = (u64::from(place.origin[axis]), u64::from(level[axis]));
            let end = first + u64::from(size[axis]);
            let block = u64::from(block);
            if end > side || first % block != 0 || (end % block != 0 && end != side) {
                return Err(Rule::Region);
            }
            // Not above the level's size.
            let narrow = |blocks: u64| u32::try_from(blocks).expect("within the level");
            Ok(narrow(first / block)..narrow(end.div_ceil(block)))
        };
        let blocks = Self {
            columns: along(0, block_width)?,
            rows: along(1, block_height)?,
            slices: along(2, 1)?,
        };
        if !has_aspect(texture.format, place.aspect) {
            return Err(Rule::Aspect);
        }
        Ok(blocks)
    }

    /// All blocks in order: column, row and slice.
    pub fn all(&self) -> impl Iterator<Item = [u32; 3]> {
        let Self {
            columns,
            rows,
            slices,
        } = self.clone();
        slices.flat_map(move |slice| {
            let columns = columns.clone();
            rows.clone().flat_map(move |row| {
                let columns = columns.clone();
                columns.map(move |column| [column, row, slice])
            })
        })
    }

    /// The number of blocks along each axis.
    #[must_use]
    pub fn counts(&self) -> [u64; 3] {
        let count = |range: &Range<u32>| u64::from(range.end - range.start);
        [count(&self.columns), count(&self.rows), count(&self.slices)]
    }
}

/// Where the blocks of a region are in memory.
#[derive(Debug, Clone)]
pub struct Placed {
    blocks: Blocks,
    /// Bytes of an aspect of a texel, or of a block.
    pub each: usize,
    offset: u64,
    row_stride: u64,
    slice_stride: u64,
}

impl Placed {
    /// Checks that a region of a texture of one sample fits `len` bytes of memory.
    ///
    /// # Errors
    /// The rule that is broken.
    pub fn of(
        texture: &PlainTexture,
        place: &Place,
        size: [u32; 3],
        (len, layout): (usize, &Layout),
    ) -> Result<Self, Rule> {
        let blocks = Blocks::of(texture, place, size)?;
        if texture.samples != 1 {
            return Err(Rule::Samples);
        }
        let each = aspect_bytes(texture.format, place.aspect);
        let [columns, rows, _] = blocks.counts();
        let row_bytes = columns * each as u64;
        let row_stride = layout.bytes_per_row.map_or(row_bytes, u64::from);
        let image_rows = layout.rows_per_image.map_or(rows, u64::from);
        let placed = Self {
            each,
            offset: layout.offset,
            row_stride,
            slice_stride: row_stride * image_rows,
            blocks,
        };
        let last = placed.blocks.all().last();
        let end = last.map_or(0, |last| placed.first_byte(last) + each as u128);
        if row_stride < row_bytes || image_rows < rows || end > len as u128 {
            return Err(Rule::Bytes);
        }
        Ok(placed)
    }

    /// Each block, and the range of its bytes.
    pub fn all(&self) -> impl Iterator<Item = ([u32; 3], Range<usize>)> {
        self.blocks.all().map(|block| {
            let first = usize::try_from(self.first_byte(block)).expect("in memory");
            (block, first..first + self.each)
        })
    }

    fn first_byte(&self, [column, row, slice]: [u32; 3]) -> u128 {
        let Blocks {
            columns,
            rows,
            slices,
        } = &self.blocks;
        let column = u128::from(column - columns.start) * self.each as u128;
        let row = u128::from(row - rows.start) * u128::from(self.row_stride);
        let slice = u128::from(slice - slices.start) * u128::from(self.slice_stride);
        u128::from(self.offset) + slice + row + column
    }
}
