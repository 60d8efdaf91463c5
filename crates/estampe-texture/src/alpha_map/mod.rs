//! [`AlphaMap`]s of textures: where alpha may pass a test.
//!
//! In: a view of four unorm bytes with a sampler, the greatest alpha that fails · Out: a bit for
//! each of 32×32 cells, layer by layer, for each step of the level of detail.\
//! Precision: conservative. The weights that rounding gives to texels and levels beside those of a
//! cell and a step add up to less than 1/256, which is allowed for.

mod bounds;

use crate::SampledTexture;
use crate::view::packet_texel::PacketFormat;
use bounds::{CELLS, Layer, spans_of};
use estampe_types::shader::{ALPHA_CELLS, ALPHA_STEPS, AlphaMap, AlphaMapKey};
use estampe_types::{AddressMode, FilterMode, ViewDimension};
use std::sync::Arc;

/// The longest side of a texture for which maps are made: the weight of a texel beyond the cell's,
/// by rounding, is below 1/2000.
const MOST_TEXELS: u32 = 8192;

/// The most rows of a map: 512 kB.
const MOST_ROWS: usize = 1 << 17;

/// Texels for each primitive that is drawn: looking at so many takes a tenth of its time at most.
const TEXELS_EACH: usize = 32;

/// One cell of so many fails at least in maps that are worth a lookup for each fragment.
const LEAST_FAILING: usize = 8;

/// The most mip levels of a map.
const MOST_LEVELS: usize = 16;

/// Where the steps of a level of detail begin, beyond its whole part: ½·log₂ of 1, 3/2, 2 and 3;
/// and where the last one ends.
const ENDS: [f32; ALPHA_STEPS + 1] = [0.0, 0.292_481_26, 0.5, 0.792_481_26, 1.0];

impl SampledTexture {
    /// Where a sampled alpha may be greater than that of a code by more than 1/256; `None` if there
    /// is no map for textures and samplers of this kind, if it would fail in few places, or if so
    /// few primitives were drawn with the texture since the last map that none is made yet.
    #[must_use]
    pub fn alpha_map(&self, failing: u8, primitives: usize) -> Option<Arc<AlphaMap>> {
        let key = self.key_of_alpha(failing)?;
        let texture = &self.view.texture;
        let worth = texture.texels.len() / TEXELS_EACH;
        let maps = &texture.alpha_maps;
        maps.get(key, (primitives, worth), || self.new_alpha_map(&key))
    }

    /// What a map depends on, if there are maps of this kind.
    fn key_of_alpha(&self, failing: u8) -> Option<AlphaMapKey> {
        let (view, sampler) = (&self.view, &self.sampler);
        let repeats = [sampler.address_mode_u, sampler.address_mode_v].map(|mode| match mode {
            AddressMode::Repeat => Some(true),
            AddressMode::ClampToEdge => Some(false),
            _ => None,
        });
        let is_flat = matches!(view.dimension, ViewDimension::D2 | ViewDimension::D2Array);
        let is_rgba8 = view.packets.is_some_and(PacketFormat::is_of_four_bytes);
        let [width, height, _] = view.size(0);
        let (levels, layers) = (view.level_count(), view.layer_count());
        let last = levels.checked_sub(1)?;
        let is_known = !view.texture.is_opaque
            && is_flat
            && is_rgba8
            && view.sample_count() == 1
            && sampler.max_anisotropy <= 1
            && sampler.lod_bias == 0.0
            && width.max(height) <= MOST_TEXELS
            && levels <= MOST_LEVELS
            && levels * ALPHA_STEPS * layers as usize * ALPHA_CELLS <= MOST_ROWS;
        let first = view.planes[0].begin_words(1);
        is_known.then_some(AlphaMapKey {
            failing,
            repeats: [repeats[0]?, repeats[1]?],
            mixes_levels: sampler.mipmap_filter == FilterMode::Linear,
            steps: [sampler.lod_min_clamp, sampler.lod_max_clamp].map(|lod| step_of(lod, last)),
            size: [width, height],
            layers: [view.base_layer, layers],
            planes: [usize::try_from(first).ok()?, levels],
        })
    }

    fn new_alpha_map(&self, key: &AlphaMapKey) -> Option<AlphaMap> {
        let view = &self.view;
        let layers = view.layer_count();
        let mut bounds = Vec::with_capacity(view.level_count() * layers as usize);
        for plane in view.planes.iter() {
            let [width, height, _] = plane.sides.map(|side| side as usize);
            let spans = [
                spans_of(width, key.repeats[0]),
                spans_of(height, key.repeats[1]),
            ];
            for layer in 0..layers {
                let layer = Layer {
                    texels: view.layer_words(plane, layer)?,
                    width,
                    spans: &spans,
                };
                bounds.push(layer.greatest(self.level));
            }
        }
        let levels: Vec<&[[u8; CELLS]]> = bounds.chunks_exact(layers as usize).collect();
        let last = levels.len() - 1;
        let steps = last * ALPHA_STEPS + 1;
        let mut rows = Vec::with_capacity(steps * layers as usize * ALPHA_CELLS);
        for step in 0..steps {
            let level = step / ALPHA_STEPS;
            let ends = [step % ALPHA_STEPS, step % ALPHA_STEPS + 1].map(|end| ENDS[end]);
            let (fine, coarse) = (levels[level], levels[last.min(level + 1)]);
            for (fine, coarse) in fine.iter().zip(coarse) {
                let cells = fine.iter().zip(coarse);
                let mixtures = cells.map(|(fine, coarse)| {
                    let [fine, coarse] = [*fine, *coarse].map(f32::from);
                    if !key.mixes_levels {
                        return fine.max(coarse);
                    }
                    let [first, second] = ends.map(|end| fine + (coarse - fine) * end);
                    first.max(second)
                });
                let passes: Vec<bool> =
                    mixtures.map(|most| most > f32::from(key.failing)).collect();
                let (of_rows, _) = passes.as_chunks::<ALPHA_CELLS>();
                rows.extend(of_rows.iter().map(|row| {
                    let bits = (0..)
                        .zip(row)
                        .map(|(cell, passes)| u32::from(*passes) << cell);
                    bits.fold(0, |all, bit| all | bit)
                }));
            }
        }
        let failing: u32 = rows.iter().map(|row| row.count_zeros()).sum();
        let is_worth = failing as usize * LEAST_FAILING >= rows.len() * ALPHA_CELLS;
        is_worth.then(|| AlphaMap {
            size: key.size.map(|side| side as f32),
            repeats: key.repeats,
            steps: key.steps,
            layers,
            rows,
        })
    }
}

/// The step in which a clamped level of detail lies.
fn step_of(lod: f32, last: usize) -> u32 {
    let lod = lod.clamp(0.0, last as f32);
    let part = lod - lod.floor();
    let before = ENDS[1..ALPHA_STEPS]
        .iter()
        .filter(|end| **end <= part)
        .count();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the levels that there are"
    )]
    let step = lod as u32 * ALPHA_STEPS as u32 + before as u32;
    step
}
