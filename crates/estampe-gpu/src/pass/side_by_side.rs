//! Passes of a submission that are drawn side by side.
//!
//! A small pass has fewer tiles than there are threads to draw them, so that most wait for its end.
//! Of passes that follow one another, and of which none changes what another uses, each thread
//! draws one by itself, if that ends no later: a shadow map for each of several lights, pictures of
//! several models. Each draws what it draws alone.

use super::run::{render_beside, tiles};
use super::{RenderPass, RenderPassError};
use crate::texture::{Reservations, TextureUse};
use crate::{Device, Statistics};
use estampe_core::PassControl;
use std::collections::BTreeMap;

/// Passes that are looked at together, at most.
const MOST_PASSES: usize = 64;
/// Tiles of a pass, at most: one of 256×256 pixels has sixteen.
const MOST_TILES: u64 = 16;
/// Draws of a pass, at most.
const MOST_DRAWS: usize = 256;
/// Vertices, or indices, of all instances of a pass, at most: one pass with many more than the
/// others would end last, drawn by one thread.
const MOST_ELEMENTS: u64 = 1 << 16;

/// Passes that are drawn side by side.
#[derive(Default)]
pub(crate) struct SideBySide<'a> {
    passes: Vec<&'a RenderPass<'a>>,
    /// Tiles of all passes; of the largest; and of each the share of a thread.
    tiles: [u64; 3],
    /// Their textures by id: of each, whether a pass changes it.
    uses: BTreeMap<usize, TextureUse<'a>>,
}

impl<'a> SideBySide<'a> {
    /// Adds the pass that comes next, unless it must be drawn by itself, or after one of these.
    pub(crate) fn add(&mut self, device: &Device, pass: &'a RenderPass<'a>) -> bool {
        let threads = device.context().concurrent_threads() as u64;
        let Some(tiles) = tiles(pass).filter(|_| threads > 1) else {
            return false;
        };
        if self.passes.len() == MOST_PASSES || !is_small(pass, tiles) || !is_alone(pass) {
            return false;
        }
        let mut uses: BTreeMap<usize, TextureUse<'a>> = BTreeMap::new();
        for one in texture_uses(pass) {
            uses.entry(one.texture.id()).or_insert(one).writes |= one.writes;
        }
        let depends = uses.iter().any(|(id, one)| {
            let earlier = self.uses.get(id);
            earlier.is_some_and(|earlier| earlier.writes || one.writes)
        });
        if depends {
            return false;
        }
        let [all, largest, shares] = self.tiles;
        self.tiles = [
            all + tiles,
            largest.max(tiles),
            shares + tiles.div_ceil(threads),
        ];
        self.uses.append(&mut uses);
        self.passes.push(pass);
        true
    }

    /// Returns true if passes by one thread each end no later than by all threads, one pass after
    /// the other: by the number of tiles that a thread draws.
    pub(crate) fn is_worthwhile(&self, device: &Device) -> bool {
        let threads = device.context().concurrent_threads() as u64;
        let [all, largest, shares] = self.tiles;
        self.passes.len() > 1 && all.div_ceil(threads).max(largest) <= shares
    }

    /// The number of passes.
    pub(crate) fn len(&self) -> usize {
        self.passes.len()
    }

    /// Draws them all, and gives what each drew, in their order.
    pub(crate) fn render(
        self,
        device: &Device,
    ) -> impl Iterator<Item = Result<Statistics, RenderPassError>> {
        // All at once: a thread that waits for one pass may draw another one meanwhile.
        let reserved = Reservations::new(self.uses.into_values());
        let drawn = self.passes.into_iter().map(|pass| (pass, None));
        let mut drawn: Vec<_> = drawn.collect();
        device.context().for_each(&mut drawn, |(pass, result)| {
            *result = Some(render_beside(device, pass));
        });
        drop(reserved);
        drawn.into_iter().filter_map(|(_, result)| result)
    }
}

/// Returns true if one thread draws a pass soon.
fn is_small(pass: &RenderPass<'_>, tiles: u64) -> bool {
    let elements = pass.draws.iter().map(|draw| {
        let [elements, instances] = [&draw.elements, &draw.instances];
        elements.len() as u64 * instances.len() as u64
    });
    tiles <= MOST_TILES
        && pass.draws.len() <= MOST_DRAWS
        && elements.fold(0, u64::saturating_add) <= MOST_ELEMENTS
        && !pass.draws.iter().any(|draw| draw.pipeline.amplifies())
}

/// Returns true if nobody watches how a pass is drawn, and only its attachments change.
fn is_alone(pass: &RenderPass<'_>) -> bool {
    let PassControl { cancel, progress } = pass.control;
    let is_watched = cancel.is_some()
        || progress.is_some()
        || pass.occlusion_queries.is_some()
        || pass.range_queries.is_some();
    let mut groups = pass.draws.iter().flat_map(|draw| draw.bind_groups);
    !is_watched && !groups.any(|group| group.is_written())
}

/// The textures of a pass, of which some may come several times.
fn texture_uses<'a>(pass: &'a RenderPass<'_>) -> impl Iterator<Item = TextureUse<'a>> {
    let colors = pass.color_attachments.iter().flatten();
    let depth = pass.depth_stencil_attachment.as_ref();
    let of_depth = depth.map(|depth| &depth.resolve).into_iter().flatten();
    let attached = colors
        .clone()
        .map(|color| &color.view)
        .chain(colors.filter_map(|color| color.resolve_target.as_ref()))
        .chain(depth.map(|depth| &depth.view))
        .chain(of_depth.map(|resolve| &resolve.target));
    let attached = attached.map(|view| TextureUse {
        texture: view.texture(),
        writes: true,
    });
    let groups = pass.draws.iter().flat_map(|draw| draw.bind_groups);
    attached.chain(groups.flat_map(|group| group.texture_uses()))
}
