//! Layers of a tile: triangles that follow each other.

use super::estimate::{self, BlockEstimate, Estimate};
use super::{ColorPlanes, TileBlock, exact};
use crate::raster::{TileShape, packet_origin};
use estampe_simd::{LANES, Lanes, Select, SimdBase, u32x16};

/// The most layers that are blended together. More save little: what is shared costs as much as one
/// layer.
const MOST: usize = 8;

/// Layers that wait to be blended, in the order of submission.
#[derive(Debug, Default)]
pub(crate) struct Layers {
    layers: Vec<Layer>,
    /// By layer: its estimate in the block at hand.
    estimates: [BlockEstimate; MOST],
    /// By layer, block and packet: the lanes to blend, in partial blocks. Those of other blocks are
    /// left from layers before, as to clear all takes a fortieth of the time.
    masks: [[[u16; LANES]; LANES]; MOST],
    counts: LayerCounts,
}

/// A triangle in a tile.
#[derive(Debug)]
struct Layer {
    colors: ColorPlanes,
    estimate: Option<Estimate>,
    /// The blocks that it touches, one bit each.
    blocks: u16,
    /// Those of which some pixel is not covered or failed the depth test.
    partial: u16,
}

/// How packets were blended.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct LayerCounts {
    /// Packets that were loaded and stored.
    pub(crate) packets: u64,
    /// Layers of these packets.
    pub(crate) layers: u64,
    /// Of these, those that the exact formula decided.
    pub(crate) exact: u64,
}

impl Layers {
    pub(crate) fn is_empty(&self) -> bool {
        self.layers.is_empty()
    }

    pub(crate) fn is_full(&self) -> bool {
        self.layers.len() >= MOST
    }

    /// Begins a layer, for which there must be room; blocks are added to it.
    pub(crate) fn begin(&mut self, colors: ColorPlanes, tile: TileShape) {
        debug_assert!(!self.is_full(), "blended when full");
        let of_blocks = &mut self.estimates[self.layers.len() % MOST];
        self.layers.push(Layer {
            estimate: Estimate::new(&colors, tile, of_blocks),
            colors,
            blocks: 0,
            partial: 0,
        });
    }

    /// Adds blocks all of whose pixels pass to the last layer.
    #[inline(always)]
    pub(crate) fn add_whole(&mut self, blocks: u16) {
        if let Some(layer) = self.layers.last_mut() {
            layer.blocks |= blocks;
        }
    }

    /// Adds a block to the last layer, with the lanes of each packet that pass.
    #[inline(always)]
    pub(crate) fn add_tested(&mut self, block: u32, masks: &[u16; LANES]) {
        let last = self.layers.len().wrapping_sub(1) % MOST;
        if let Some(layer) = self.layers.last_mut() {
            let bit = 1 << block;
            if *masks == [0; LANES] {
                return;
            }
            layer.blocks |= bit;
            if *masks != [u16::MAX; LANES] {
                layer.partial |= bit;
                self.masks[last][block as usize % LANES] = *masks;
            }
        }
    }

    /// Adds lanes of a packet of the tile to the last layer.
    #[inline(always)]
    pub(crate) fn add_packet(&mut self, packet: u16, mask: u16) {
        let last = self.layers.len().wrapping_sub(1) % MOST;
        if let Some(layer) = self.layers.last_mut() {
            let (block, packet) = (
                usize::from(packet) / LANES % LANES,
                usize::from(packet) % LANES,
            );
            let masks = &mut self.masks[last][block];
            if layer.partial >> block & 1 == 0 {
                *masks = [0; LANES];
            }
            layer.blocks |= 1 << block;
            layer.partial |= 1 << block;
            masks[packet] = mask;
        }
    }

    /// Blends all layers over a tile's texels, and forgets them; `before_block` is called before
    /// each block.
    #[inline(always)]
    pub(crate) fn blend<S: Lanes>(
        &mut self,
        s: S,
        tile: TileShape,
        stored: &mut [[u32; LANES]],
        mut before_block: impl FnMut(),
    ) -> LayerCounts {
        self.counts = LayerCounts::default();
        let mut blocks = self
            .layers
            .iter()
            .fold(0, |blocks, layer| blocks | layer.blocks);
        while blocks != 0 {
            let block = blocks.trailing_zeros();
            blocks &= blocks - 1;
            before_block();
            self.blend_block(s, (block, TileBlock::new(tile, block)), stored);
        }
        self.layers.clear();
        self.counts
    }

    #[inline(always)]
    fn blend_block<S: Lanes>(
        &mut self,
        s: S,
        (number, block): (u32, TileBlock),
        stored: &mut [[u32; LANES]],
    ) {
        let (mut of_block, mut count) = ([0; MOST], 0);
        for (at, layer) in self.layers.iter().enumerate().take(MOST) {
            if layer.blocks >> number & 1 == 0 {
                continue;
            }
            of_block[count % MOST] = at;
            count += 1;
            if let Some(estimate) = &layer.estimate {
                let of_block = &mut self.estimates[at % MOST];
                estimate.set_block(s, &layer.colors, block, of_block);
            }
        }
        let visit = Visit {
            layers: &self.layers,
            estimates: &self.estimates,
            masks: &self.masks,
            of_block: &of_block[..count],
            block: number,
        };
        let opaque = <u32x16<S> as SimdBase<S>>::splat(s, 0xFF00_0000);
        let lines = stored[block.first_packet..][..LANES].iter_mut();
        for (packet, line) in lines.enumerate() {
            let old = u32x16::load_array_ref(s, line);
            let place = (packet, block.packet_pixel(packet));
            let (texels, exact) = if s.bits_of_mask(old.simd_ge(opaque)) == u16::MAX {
                visit.blend::<S, 3>(s, place, old)
            } else {
                visit.blend::<S, 4>(s, place, old)
            };
            self.counts.exact += exact;
            texels.store_array(line);
        }
        self.counts.packets += LANES as u64;
        self.counts.layers += (LANES * count) as u64;
    }
}

impl TileBlock {
    /// The first pixel of a packet of the block, in the target.
    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a block has sixteen packets"
    )]
    fn packet_pixel(self, packet: usize) -> [i32; 2] {
        let (x, y) = packet_origin((packet % LANES) as u32);
        [self.pixel[0] + x, self.pixel[1] + y]
    }
}

/// The layers of a block.
struct Visit<'a> {
    layers: &'a [Layer],
    estimates: &'a [BlockEstimate; MOST],
    masks: &'a [[[u16; LANES]; LANES]; MOST],
    /// The layers that cover the block, in order.
    of_block: &'a [usize],
    block: u32,
}

impl Visit<'_> {
    /// A packet's texels blended with all layers, and how many of these the exact formula decided.
    #[inline(always)]
    fn blend<S: Lanes, const CHANNELS: usize>(
        &self,
        s: S,
        (packet, pixel): (usize, [i32; 2]),
        old: u32x16<S>,
    ) -> (u32x16<S>, u64) {
        let mut below = estimate::raised_codes(s, old);
        let mut decided = 0;
        for &at in self.of_block {
            let layer = &self.layers[at];
            let mut mask = u16::MAX;
            if layer.partial >> self.block & 1 == 1 {
                mask = self.masks[at % MOST][self.block as usize % LANES][packet % LANES];
                if mask == 0 {
                    continue;
                }
            }
            let mut raised = below;
            let mut is_certain = false;
            if layer.estimate.is_some() {
                let estimate = &self.estimates[at % MOST];
                let (estimates, uncertain) = estimate.blend::<S, CHANNELS>(s, packet, &below);
                raised = estimates;
                is_certain = s.bits_of_mask(uncertain) == 0;
            }
            if !is_certain {
                raised = blend_exactly::<S, CHANNELS>(s, &layer.colors, pixel, &below);
                decided += 1;
            }
            let mut channel = 0;
            while channel < CHANNELS {
                raised[channel] = estimate::without_fraction(s, raised[channel]);
                if mask != u16::MAX {
                    let passes = s.mask_from_bits(mask);
                    raised[channel] = passes.select(raised[channel], below[channel]);
                }
                channel += 1;
            }
            below = raised;
        }
        (estimate::texels(s, &below), decided)
    }
}

/// [`exact::blend`] of raised codes.
#[inline(always)]
fn blend_exactly<S: Lanes, const CHANNELS: usize>(
    s: S,
    colors: &ColorPlanes,
    pixel: [i32; 2],
    below: &[u32x16<S>; 4],
) -> [u32x16<S>; 4] {
    let mut codes = *below;
    let mut channel = 0;
    while channel < 4 {
        codes[channel] = estimate::lowered(s, below[channel]);
        channel += 1;
    }
    let mut codes = exact::blend::<S, CHANNELS>(s, colors, pixel, &codes);
    let mut channel = 0;
    while channel < 4 {
        codes[channel] = estimate::raised(s, codes[channel]);
        channel += 1;
    }
    codes
}

#[cfg(test)]
mod tests;
