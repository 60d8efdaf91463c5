//! Accesses to textures: what a kernel asks, answered by `estampe_texture`.

use super::samples::{compare_all, sample, sample_all, sample_each};
use estampe_ir::interface::TextureSlot;
use estampe_ir::interpreter::{Common, TextureAccess, TextureAccesses, Textures};
use estampe_ir::op::{TextureOp, TextureQuery};
use estampe_simd::{LANES, Packet, dispatch};
use estampe_texture::{SampledTexture, TexelView, TextureBindings};
use estampe_types::{Bindings, StorageTexture};
use std::cell::OnceCell;

/// The textures that a draw binds, as a kernel numbers them.
#[derive(Debug)]
pub(super) struct BoundTextures<'a> {
    pub(super) bindings: &'a Bindings,
    textures: &'a [TextureSlot],
    samplers: &'a [TextureSlot],
    /// For each texture and sampler, both together; made when it is first sampled. `None` inside
    /// where the sampler cannot sample the texture.
    sampled: Cells<Option<&'a SampledTexture>>,
    /// For each texture its view, found when texels are first loaded; `None` inside for a texture
    /// that shaders store to.
    loaded: Cells<Option<&'a TexelView>>,
}

/// Values that are found when they are first asked for. The first few take no allocation, as a
/// shader is given new ones for each batch.
#[derive(Debug)]
struct Cells<T> {
    few: [OnceCell<T>; FEW],
    more: Vec<OnceCell<T>>,
}

/// The values that take no allocation.
const FEW: usize = 6;

impl<T: Clone> Cells<T> {
    #[inline(always)]
    fn new(count: usize) -> Self {
        let more = match count.checked_sub(FEW) {
            None | Some(0) => Vec::new(),
            Some(more) => vec![OnceCell::new(); more],
        };
        Self {
            few: [const { OnceCell::new() }; FEW],
            more,
        }
    }

    #[inline]
    fn get(&self, at: usize) -> Option<&OnceCell<T>> {
        let few = self.few.get(at);
        few.or_else(|| self.more.get(at - FEW))
    }
}

impl<'a> BoundTextures<'a> {
    #[inline(always)]
    pub(super) fn new(
        bindings: &'a Bindings,
        textures: &'a [TextureSlot],
        samplers: &'a [TextureSlot],
    ) -> Self {
        let pairs = textures.len() * samplers.len();
        Self {
            bindings,
            textures,
            samplers,
            sampled: Cells::new(pairs),
            loaded: Cells::new(textures.len()),
        }
    }

    /// The view of a texture; `None` for one that shaders store to.
    pub(super) fn loaded(&self, texture: u32) -> Option<&'a TexelView> {
        let found = self.loaded.get(texture as usize)?.get_or_init(|| {
            let &TextureSlot { group, binding } = self.textures.get(texture as usize)?;
            let stored = self.bindings.storage_texture(group, binding);
            stored
                .is_none()
                .then(|| self.bindings.texture(group, binding))
        });
        *found
    }

    pub(super) fn sampled(&self, texture: u32, sampler: u32) -> Option<&'a SampledTexture> {
        let at = texture as usize * self.samplers.len() + sampler as usize;
        let made = self.sampled.get(at)?.get_or_init(|| {
            let slot = |slots: &[TextureSlot], at: u32| {
                let TextureSlot { group, binding } = *slots.get(at as usize)?;
                Some([group, binding])
            };
            let texture = slot(self.textures, texture)?;
            self.bindings
                .texture_with_sampler(texture, slot(self.samplers, sampler)?)
        });
        *made
    }
}

impl Textures for BoundTextures<'_> {
    fn access(&self, mut access: TextureAccess<'_>) {
        if let Some(sampler) = access.op.sampler {
            if access.packets == 1 && self.alone(&mut access) {
                return;
            }
            match self.sampled(access.op.texture, sampler) {
                Some(texture) => sample(texture, &mut access),
                None => clear(&mut access),
            }
            return;
        }
        if self.common_access(&mut access) || self.access_stored(&mut access) {
            return;
        }
        clear(&mut access);
        let level = access.level;
        match access.op.query {
            TextureQuery::Load => dispatch!(level, s => self.load(s, &mut access)),
            TextureQuery::Store => dispatch!(level, s => self.store(s, &access)),
            TextureQuery::Size
            | TextureQuery::Levels
            | TextureQuery::Layers
            | TextureQuery::Samples => self.query(&mut access),
            TextureQuery::Sample
            | TextureQuery::SampleCompare
            | TextureQuery::Gather(_)
            | TextureQuery::GatherCompare => {}
        }
    }

    fn access_all(&self, mut accesses: TextureAccesses<'_>) {
        let is_done = self.together(&mut accesses);
        if !is_done {
            while let Some(access) = accesses.next() {
                self.access(access);
            }
        }
    }
}

/// Sets all results to 0.
fn clear(access: &mut TextureAccess<'_>) {
    for result in 0..access.results() {
        access.result_mut(result).fill(Packet::default());
    }
}

impl BoundTextures<'_> {
    /// Does accesses that have something in common; false if they are not done, and nothing is
    /// stored that counts.
    #[inline(always)]
    fn together(&self, accesses: &mut TextureAccesses<'_>) -> bool {
        let sampled = |op: &TextureOp| self.sampled(op.texture, op.sampler.unwrap_or(u32::MAX));
        let first = || accesses.ops.first().and_then(sampled);
        match accesses.common {
            Common::Coordinates => sample_all(accesses, sampled),
            Common::Reference => compare_all(first(), accesses),
            Common::Texture => sample_each(first(), accesses),
            Common::Texels => self.load_all(accesses),
            Common::Nothing => false,
        }
    }

    /// Does an access of a single packet as accesses that have something in common are done; false
    /// if it is not one of these.
    fn alone(&self, access: &mut TextureAccess<'_>) -> bool {
        access
            .as_several()
            .is_some_and(|mut accesses| self.together(&mut accesses))
    }

    pub(super) fn slot(&self, access: &TextureAccess<'_>) -> (u32, u32) {
        self.slot_of(access.op.texture)
    }

    pub(super) fn slot_of(&self, texture: u32) -> (u32, u32) {
        let slot = self.textures.get(texture as usize);
        slot.map_or((u32::MAX, u32::MAX), |slot| (slot.group, slot.binding))
    }

    /// The words that a query of a texture's shape gives for a level.
    pub(super) fn shape(&self, query: TextureQuery, texture: u32, level: u32) -> [u32; 3] {
        let (group, binding) = self.slot_of(texture);
        let storage = self.bindings.storage_texture(group, binding);
        let view = self.bindings.texture(group, binding);
        let count = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
        match (query, storage) {
            (TextureQuery::Levels, _) => [count(view.level_count()), 0, 0],
            (TextureQuery::Layers, Some(texture)) => [slices(texture), 0, 0],
            (TextureQuery::Layers, None) => [view.layer_count(), 0, 0],
            (TextureQuery::Samples, _) => [view.sample_count(), 0, 0],
            (_, Some(texture)) => [texture.width(), texture.height(), slices(texture)],
            (_, None) if (level as usize) < view.level_count() => view.size(level as usize),
            (_, None) => [0; 3],
        }
    }

    fn query(&self, access: &mut TextureAccess<'_>) {
        let op = access.op;
        let words_of = |level: u32| self.shape(op.query, op.texture, level);
        for packet in 0..access.packets {
            let levels = access.level_of_detail();
            let levels = levels.map_or_else(Packet::default, |levels| levels[packet]);
            let of_first = words_of(levels.0[0]);
            let is_same = levels.is_uniform();
            for (at, word) in of_first.into_iter().enumerate().take(access.results()) {
                access.result_mut(at)[packet].0 = [word; LANES];
            }
            for lane in 1..LANES {
                if is_same {
                    break;
                }
                let words = words_of(levels.0[lane]);
                for (at, word) in words.into_iter().enumerate().take(access.results()) {
                    access.result_mut(at)[packet].0[lane] = word;
                }
            }
        }
    }
}

/// Layers, or the depth.
fn slices(texture: &StorageTexture) -> u32 {
    texture.shape().depth_or_layers
}
