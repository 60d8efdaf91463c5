//! The blocks of compressed textures as they were written. Shaders sample the decoded rows; copies
//! and the host read the blocks.

use super::{ImageKey, Texture};
use estampe_texture::region::RowSpan;
use std::collections::BTreeMap;

/// The bytes of a row of blocks from the span's first block on.
pub(super) fn blocks_of<'a>(
    blocks: &'a mut BTreeMap<ImageKey, Vec<u8>>,
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
