//! Texels between the host and textures: whole levels or regions of them.

use super::contents::words_of;
use super::{Extent3d, Image, ImageKey, Texture, TextureError, TextureUsages, TextureView};
use crate::{Context, Limits};
use estampe_texture::region::{RowSpan, aspect_bytes, read_row, write_blocks, write_row};
use estampe_texture::{LevelData, MipGeneration, TexelDescriptor, create_texture};
use estampe_types::{TextureAspect, TextureFormat};

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

/// A region that is known to lie in its level, and the layout of its bytes.
#[derive(Debug, Clone, Copy)]
struct Region {
    key: ImageKey,
    origin: [usize; 2],
    columns: usize,
    /// Rows of texels, or of blocks.
    rows: usize,
    layers: usize,
    block_height: usize,
    row_bytes: usize,
    row_stride: usize,
    layer_stride: usize,
    offset: usize,
}

impl Region {
    fn new(
        copy: &TextureCopy<'_>,
        size: Extent3d,
        layout: &TexelCopyLayout,
        bytes: u64,
    ) -> Result<Self, TextureError> {
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
        if texture.sample_count() != 1 {
            return Err(unsupported(
                texture,
                "resolve a multisampled texture before it is copied to or from the host",
            ));
        }
        let each = aspect_bytes(format, copy.aspect) as u64;
        let rows = u64::from(height.div_ceil(block_height));
        let row_bytes = u64::from(width.div_ceil(block_width)) * each;
        let row_stride = layout.bytes_per_row.map_or(row_bytes, u64::from);
        let image_rows = layout.rows_per_image.map_or(rows, u64::from);
        let is_empty = width == 0 || height == 0 || layers == 0;
        let last = u64::from(layers.saturating_sub(1));
        let expected = if is_empty {
            0
        } else {
            let last_layer = row_stride.saturating_mul(image_rows).saturating_mul(last);
            let last_row = row_stride.saturating_mul(rows - 1);
            let end = last_layer
                .saturating_add(last_row)
                .saturating_add(row_bytes);
            end.saturating_add(layout.offset)
        };
        if row_stride < row_bytes || image_rows < rows || expected > bytes {
            return Err(TextureError::Bytes {
                texture: texture.name(),
                expected,
                bytes_per_row: row_bytes,
                actual: bytes,
            });
        }
        // What is used is at most `expected`, the length of bytes in memory.
        let within = |value: u64| usize::try_from(value).unwrap_or(usize::MAX);
        Ok(Self {
            key: ImageKey {
                level: copy.mip_level,
                layer,
            },
            origin: [x as usize, y as usize],
            columns: width as usize,
            rows: if is_empty { 0 } else { within(rows) },
            layers: layers as usize,
            block_height: block_height as usize,
            row_bytes: within(row_bytes),
            row_stride: within(row_stride),
            layer_stride: within(row_stride.saturating_mul(image_rows)),
            offset: within(layout.offset),
        })
    }

    /// The images that the region touches.
    fn images(self) -> impl Iterator<Item = ImageKey> {
        let last = self.key.layer + u32::try_from(self.layers).unwrap_or_default();
        (self.key.layer..last).map(move |layer| ImageKey { layer, ..self.key })
    }

    /// Each row of the region: the span of texels, and where its bytes begin.
    fn spans(self) -> impl Iterator<Item = (RowSpan, usize)> {
        (0..self.layers).flat_map(move |layer| {
            (0..self.rows).map(move |row| {
                let span = RowSpan {
                    level: self.key.level as usize,
                    slice: self.key.layer as usize + layer,
                    x: self.origin[0],
                    y: self.origin[1] + row * self.block_height,
                    width: self.columns,
                };
                let first = self.offset + layer * self.layer_stride + row * self.row_stride;
                (span, first)
            })
        })
    }
}

fn unsupported(texture: &Texture, rule: &'static str) -> TextureError {
    TextureError::Unsupported {
        texture: texture.name(),
        format: texture.format(),
        samples: texture.sample_count(),
        rule,
    }
}

/// Bytes of a region without padding.
pub(crate) fn tight_len(copy: &TextureCopy<'_>, size: Extent3d) -> u64 {
    let format = copy.texture.format();
    let [width, height] = format.block_size();
    u64::from(size.width.div_ceil(width))
        * u64::from(size.height.div_ceil(height))
        * u64::from(size.depth_or_array_layers)
        * aspect_bytes(format, copy.aspect) as u64
}

/// Writes a region from bytes.
pub(crate) fn write(
    context: &Context,
    copy: &TextureCopy<'_>,
    bytes: &[u8],
    layout: &TexelCopyLayout,
    size: Extent3d,
) -> Result<(), TextureError> {
    let texture = copy.texture;
    texture.require(TextureUsages::COPY_DST)?;
    let region = Region::new(copy, size, layout, bytes.len() as u64)?;
    let mut contents = texture.lock();
    let is_compressed = texture.format().is_compressed();
    if is_compressed {
        for (span, first) in region.spans() {
            let stored = blocks_of(&mut contents.blocks, texture, span);
            stored[..region.row_bytes].copy_from_slice(&bytes[first..][..region.row_bytes]);
        }
    }
    contents.write_rows(texture, context, region.images(), |data, words| {
        for (span, first) in region.spans() {
            let bytes = &bytes[first..][..region.row_bytes];
            if is_compressed {
                write_blocks(data, span, bytes, words);
            } else {
                write_row(data, span, copy.aspect, bytes, words);
            }
        }
    })
}

/// Reads a region into bytes.
pub(crate) fn read(
    context: &Context,
    copy: &TextureCopy<'_>,
    bytes: &mut [u8],
    layout: &TexelCopyLayout,
    size: Extent3d,
) -> Result<(), TextureError> {
    let texture = copy.texture;
    texture.require(TextureUsages::COPY_SRC)?;
    let region = Region::new(copy, size, layout, bytes.len() as u64)?;
    let mut contents = texture.lock();
    if texture.format().is_compressed() {
        for (span, first) in region.spans() {
            let stored = blocks_of(&mut contents.blocks, texture, span);
            bytes[first..][..region.row_bytes].copy_from_slice(&stored[..region.row_bytes]);
        }
        return Ok(());
    }
    let level = texture.level_size(copy.mip_level);
    let is_whole = size == Extent3d::new_2d(level.width, level.height);
    let is_tight =
        *layout == TexelCopyLayout::default() && bytes.len() == region.row_bytes * region.rows;
    if is_whole
        && is_tight
        && copy.aspect == TextureAspect::All
        && let Some(Image::Color(image)) = contents.tiles(region.key)
    {
        context.read_color_texels(image, bytes);
        return Ok(());
    }
    let data = contents.rows(texture, context)?;
    for (span, first) in region.spans() {
        read_row(
            &data,
            span,
            (copy.aspect, 0),
            &mut bytes[first..][..region.row_bytes],
        );
    }
    Ok(())
}

/// Reads one sample of each texel of an image.
pub(crate) fn read_sample(
    context: &Context,
    view: &TextureView,
    sample: u32,
) -> Result<Vec<u8>, TextureError> {
    let (texture, format) = (view.texture(), view.texture().format());
    texture.require(TextureUsages::COPY_SRC)?;
    let key = view.image_key(None);
    let Some(key) = key.filter(|_| !format.is_compressed() && sample < texture.sample_count())
    else {
        let rule = "a sample is read of one level of one layer, not compressed, that has it";
        return Err(unsupported(texture, rule));
    };
    let data = texture.lock().rows(texture, context)?;
    let level = data.levels[key.level as usize];
    let (width, height) = (level.width as usize, level.height as usize);
    let each = aspect_bytes(format, view.aspect());
    let mut bytes = vec![0; width * height * each];
    for (y, row) in bytes.chunks_mut(width * each).enumerate() {
        let span = RowSpan {
            level: key.level as usize,
            slice: key.layer as usize,
            x: 0,
            y,
            width,
        };
        read_row(&data, span, (view.aspect(), sample as usize), row);
    }
    Ok(bytes)
}

/// The bytes of a row of blocks from the span's first block on.
fn blocks_of<'a>(
    blocks: &'a mut std::collections::BTreeMap<ImageKey, Vec<u8>>,
    texture: &Texture,
    span: RowSpan,
) -> &'a mut [u8] {
    let format = texture.format();
    let [width, height] = format.block_size().map(|side| side as usize);
    let each = format.block_bytes() as usize;
    let level = u32::try_from(span.level).unwrap_or_default();
    let size = texture.level_size(level);
    let columns = (size.width as usize).div_ceil(width);
    let rows = (size.height as usize).div_ceil(height);
    let key = ImageKey {
        level,
        layer: u32::try_from(span.slice).unwrap_or_default(),
    };
    let image = blocks
        .entry(key)
        .or_insert_with(|| vec![0; columns * rows * each]);
    &mut image[(span.y / height * columns + span.x / width) * each..]
}

impl Texture {
    /// Sets the texels to the tight bytes of the first mip levels; the others are generated.
    pub(super) fn fill(&self, levels: &[&[u8]], limits: &Limits) -> Result<(), TextureError> {
        let descriptor = self.descriptor();
        let mips = if levels.len() < descriptor.mip_level_count as usize {
            MipGeneration::Full
        } else {
            MipGeneration::None
        };
        let mut contents = self.lock();
        let size = (descriptor.width, descriptor.height);
        let one = TexelDescriptor::new_2d(size.0, size.1, descriptor.format);
        let data = match levels {
            // The common case has code of its own.
            [rgba] if is_rgba8(descriptor.format) && *descriptor == one.with_all_levels() => {
                create_texture(size.0, size.1, descriptor.format, rgba, mips, limits)?
            }
            _ => {
                let data: Vec<_> = levels.iter().map(|bytes| LevelData::tight(bytes)).collect();
                descriptor.create(&data, mips, limits)?
            }
        };
        if descriptor.format.is_compressed() {
            for (level, bytes) in (0..).zip(levels) {
                let layers = self.level_size(level).depth_or_array_layers;
                let image = (bytes.len() / layers.max(1) as usize).max(1);
                for (layer, bytes) in (0..).zip(bytes.chunks(image)) {
                    let key = ImageKey { level, layer };
                    contents.blocks.insert(key, bytes.to_vec());
                }
            }
        }
        contents.set_rows(data);
        Ok(())
    }
}

fn is_rgba8(format: TextureFormat) -> bool {
    matches!(
        format,
        TextureFormat::Rgba8Unorm | TextureFormat::Rgba8UnormSrgb
    )
}

/// Sets one aspect or all of every texel of some images to zero.
pub(crate) fn zero(
    context: &Context,
    texture: &Texture,
    keys: &[ImageKey],
    aspect: TextureAspect,
) -> Result<(), TextureError> {
    let mut contents = texture.lock();
    contents.blocks.retain(|key, _| !keys.contains(key));
    contents.write_rows(texture, context, keys.iter().copied(), |data, words| {
        for key in keys {
            if aspect == TextureAspect::All {
                words[words_of(data, *key)].fill(0);
                continue;
            }
            let level = data.levels[key.level as usize];
            let width = level.width as usize;
            let samples = data.shape.samples as usize;
            let zeros = vec![0; width * samples * aspect_bytes(data.format, aspect)];
            for y in 0..level.height as usize {
                let span = RowSpan {
                    level: key.level as usize,
                    slice: key.layer as usize,
                    x: 0,
                    y,
                    width,
                };
                write_row(data, span, aspect, &zeros, words);
            }
        }
    })
}
