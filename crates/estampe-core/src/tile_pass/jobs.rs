//! The jobs of a pass: a target cut into the slices of its tiles.

use super::{TileJob, TileStores};
use crate::attachment::{RenderTarget, StoredRows};
use crate::layout::texel_words;

/// The tiles of a target, and what all of them store to. `keeps_depths` says that they are drawn
/// last, and that their depths are kept.
pub(crate) fn jobs_of<'a>(
    target: &'a mut RenderTarget,
    keeps_depths: bool,
    jobs: &mut Vec<TileJob<'a>>,
) -> TileStores<'a> {
    let mut stores = TileStores::default();
    let grid = target.grid();
    let elements = grid.tile_pixels() * target.samples() as usize;
    jobs.extend((0u32..).take(grid.tiles()).map(|tile| TileJob {
        tile,
        ..TileJob::default()
    }));
    for (index, color) in target.colors.iter_mut().enumerate() {
        let elements = elements * texel_words(color.format());
        for (job, slice) in jobs.iter_mut().zip(color.words.chunks_exact_mut(elements)) {
            job.colors[index] = slice.as_chunks_mut().0;
        }
    }
    for resolve in &mut target.resolves {
        let elements = grid.tile_pixels() * texel_words(resolve.into.format());
        let slices = resolve.into.words.chunks_exact_mut(elements);
        for (job, slice) in jobs.iter_mut().zip(slices) {
            job.resolved[resolve.color] = slice;
        }
    }
    for rows in target.rows.iter_mut().filter(|rows| rows.is_done) {
        let color = (rows.color, target.color_formats[rows.color]);
        let words = rows.words_mut();
        let image = words.map(|words| StoredRows::of_image(color, target.size, words));
        stores.rows.extend(image);
    }
    let Some(texels) = &mut target.depth_stencil else {
        return stores;
    };
    let (depth, stencil, bounds) = texels.tiles_mut(keeps_depths);
    for (job, slice) in jobs.iter_mut().zip(stencil.chunks_exact_mut(elements)) {
        job.stencil = slice.as_chunks_mut().0;
    }
    for (job, slice) in jobs.iter_mut().zip(depth.chunks_exact_mut(elements)) {
        job.depth = slice.as_chunks_mut().0;
    }
    stores.bounds = bounds;
    stores
}
