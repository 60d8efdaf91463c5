//! Accesses to textures: what a kernel asks, answered by `estampe_texture`.

use super::samples::{MOST, compare_all, sample, sample_all, sample_each};
use estampe_ir::interface::TextureSlot;
use estampe_ir::interpreter::{Common, TextureAccess, TextureAccesses, Textures};
use estampe_ir::op::{TextureOp, TextureQuery};
use estampe_simd::{
    Bytes, LANES, Lanes, Packet, SimdBase, dispatch, f32x16, floats_of_mut, i32x16, ints_of,
    mask32x16, u32x16,
};
use estampe_texture::{
    SampledTexture, TexelView, TextureBindings, storage_load, storage_store, store_unorm8,
};
use estampe_types::{Bindings, StorageTexture, Vec4};
use std::cell::OnceCell;

/// The textures that a draw binds, as a kernel numbers them.
#[derive(Debug)]
pub(super) struct BoundTextures<'a> {
    bindings: &'a Bindings,
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
        if self.common_access(&mut access) {
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

    /// Loads or stores one packet of texels of the common kind; otherwise false is returned, and
    /// nothing done.
    #[inline]
    fn common_access(&self, access: &mut TextureAccess<'_>) -> bool {
        let op = access.op;
        let ([_, _], [0, 0, 0], None, &[mask]) =
            (&op.coordinates[..], op.offset, op.layer, access.mask)
        else {
            return false;
        };
        let level = access.level;
        match op.query {
            TextureQuery::Load => {
                let Some(view) = self.loaded(op.texture) else {
                    return false;
                };
                view.is_unorm8() && dispatch!(level, s => load_common(s, view, access))
                    || load_packet(view, access)
            }
            TextureQuery::Store => dispatch!(level, s => self.store_common(s, access, mask)),
            _ => false,
        }
    }

    /// Stores a packet of texels; false if the texture is not a common one.
    #[inline(always)]
    fn store_common<S: Lanes>(&self, s: S, access: &TextureAccess<'_>, mask: u16) -> bool {
        let (group, binding) = self.slot(access);
        let Some(texture) = self.bindings.storage_texture(group, binding) else {
            return false;
        };
        let [x, y, _] = texel(s, access, 0);
        let channels = [
            floats(s, access.stored(0), 0),
            floats(s, access.stored(1), 0),
            floats(s, access.stored(2), 0),
            floats(s, access.stored(3), 0),
        ];
        store_unorm8(s, texture, ([x, y], mask), channels)
    }

    /// Loads a packet of texels of several textures at the same coordinates; false if they cannot
    /// be loaded together.
    fn load_all(&self, accesses: &mut TextureAccesses<'_>) -> bool {
        let (operands, _) = accesses.all();
        let is_block = matches!(operands, [x, y, ..] if begins_block(x, y));
        let ops = accesses.ops;
        let Some(first) = ops
            .first()
            .filter(|_| is_block)
            .and_then(|op| self.loaded(op.texture))
        else {
            return false;
        };
        let mut views = [first; MOST];
        for (to, op) in views.iter_mut().zip(ops) {
            let Some(view) = self.loaded(op.texture) else {
                return false;
            };
            *to = view;
        }
        let level = accesses.level();
        let (operands, results) = accesses.all();
        let places = match ints_of(operands) {
            [x, y] => [x, y, &ZEROS],
            [x, y, mip] => [x, y, mip],
            _ => return false,
        };
        let (texels, _) = floats_of_mut(results).as_chunks_mut();
        views
            .get(..ops.len())
            .is_some_and(|views| TexelView::fetch_blocks(views, level, places, texels))
    }

    fn slot(&self, access: &TextureAccess<'_>) -> (u32, u32) {
        self.slot_of(access.op.texture)
    }

    fn slot_of(&self, texture: u32) -> (u32, u32) {
        let slot = self.textures.get(texture as usize);
        slot.map_or((u32::MAX, u32::MAX), |slot| (slot.group, slot.binding))
    }

    #[inline(always)]
    fn load<S: Lanes>(&self, s: S, access: &mut TextureAccess<'_>) {
        for packet in 0..access.packets {
            let at = texel(s, access, packet);
            let zero = <i32x16<S> as SimdBase<S>>::splat(s, 0);
            let ints =
                |words: Option<&[Packet<u32>]>| words.map_or(zero, |words| ints(s, words, packet));
            let level = ints(access.level_of_detail());
            let sample = ints(access.sample());
            let texel = self.fetch(access.op.texture, at, level, sample);
            set(access, packet, [texel.x, texel.y, texel.z, texel.w]);
        }
    }

    /// The texels of a texture at any places, of a level and a sample.
    #[inline(always)]
    pub(super) fn fetch<S: Lanes>(
        &self,
        texture: u32,
        at: [i32x16<S>; 3],
        level: i32x16<S>,
        sample: i32x16<S>,
    ) -> Vec4<f32x16<S>> {
        let (group, binding) = self.slot_of(texture);
        match self.bindings.storage_texture(group, binding) {
            Some(texture) => storage_load(texture, at),
            None => {
                let texture = self.bindings.texture(group, binding);
                texture.fetch(at, level, sample)
            }
        }
    }

    #[inline(always)]
    fn store<S: Lanes>(&self, s: S, access: &TextureAccess<'_>) {
        let (group, binding) = self.slot(access);
        let Some(texture) = self.bindings.storage_texture(group, binding) else {
            return;
        };
        for packet in 0..access.packets {
            let at = texel(s, access, packet);
            let x = floats(s, access.stored(0), packet);
            let y = floats(s, access.stored(1), packet);
            let z = floats(s, access.stored(2), packet);
            let w = floats(s, access.stored(3), packet);
            let mask: mask32x16<S> = s.mask_from_bits(access.mask[packet]);
            storage_store(texture, mask, at, Vec4::new(x, y, z, w));
        }
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

/// Loads a packet of texels of the finest level; false if that is not what is asked.
#[inline(always)]
fn load_common<S: Lanes>(s: S, view: &TexelView, access: &mut TextureAccess<'_>) -> bool {
    let level = access.level_of_detail();
    let is_finest = level.is_none_or(|level| level[0].is_uniform() && level[0].0[0] == 0);
    if !is_finest || access.sample().is_some() {
        return false;
    }
    let [x, y, _] = texel(s, access, 0);
    let Some(texels) = view.load_unorm8(s, [x, y]) else {
        return false;
    };
    set(access, 0, texels);
    true
}

/// Loads a packet of texels of any format but integers; false if they cannot be loaded together,
/// and nothing is done.
fn load_packet(view: &TexelView, access: &mut TextureAccess<'_>) -> bool {
    let [x, y] = [0, 1].map(|at| ints_of(access.coordinate(at)).first());
    let [mip, sample] = [access.level_of_detail(), access.sample()].map(first_or_zeros);
    let (Some(x), Some(y), Some(mip), Some(sample)) = (x, y, mip, sample) else {
        return false;
    };
    let level = access.level;
    let texels = floats_of_mut(access.results_mut()).first_chunk_mut();
    texels.is_some_and(|texels| view.fetch_packet(level, [x, y, &ZEROS, mip, sample], texels))
}

/// The first packet of integers; zeros for none.
fn first_or_zeros(words: Option<&[Packet<u32>]>) -> Option<&Packet<i32>> {
    match words {
        Some(words) => ints_of(words).first(),
        None => Some(&ZEROS),
    }
}

static ZEROS: Packet<i32> = Packet([0; LANES]);

/// True if the first quad of a packet is one of neighbouring texels, as of a block: the packets of
/// a compute shader seldom are, and are told apart before anything else is looked at.
#[inline(always)]
fn begins_block(x: &Packet<u32>, y: &Packet<u32>) -> bool {
    x.0[1].wrapping_sub(x.0[0]) == 1 && x.0[2] == x.0[0] && y.0[2].wrapping_sub(y.0[0]) == 1
}

/// The integer coordinates of a packet's texels, with the layer after them.
#[inline(always)]
fn texel<S: Lanes>(s: S, access: &TextureAccess<'_>, packet: usize) -> [i32x16<S>; 3] {
    let zero = <i32x16<S> as SimdBase<S>>::splat(s, 0);
    let count = access.op.coordinates.len();
    let mut at = [zero; 3];
    for (axis, place) in at.iter_mut().enumerate().take(count) {
        let offset = <i32x16<S> as SimdBase<S>>::splat(s, access.op.offset[axis]);
        *place = ints(s, access.coordinate(axis), packet) + offset;
    }
    if let Some(layer) = access.layer() {
        at[2] = ints(s, layer, packet);
    }
    at
}

/// Layers, or the depth.
fn slices(texture: &StorageTexture) -> u32 {
    texture.shape().depth_or_layers
}

#[inline(always)]
fn floats<S: Lanes>(s: S, words: &[Packet<u32>], packet: usize) -> f32x16<S> {
    u32x16::load_array_ref(s, &words[packet].0).bitcast()
}

#[inline(always)]
fn ints<S: Lanes>(s: S, words: &[Packet<u32>], packet: usize) -> i32x16<S> {
    u32x16::load_array_ref(s, &words[packet].0).bitcast()
}

/// Stores as many of the results as the access has, each by a whole register.
#[inline(always)]
fn set<S: Lanes>(access: &mut TextureAccess<'_>, packet: usize, results: [f32x16<S>; 4]) {
    let count = access.results();
    let [a, b, c, d] = results;
    put(access, (0, packet), a, count);
    put(access, (1, packet), b, count);
    put(access, (2, packet), c, count);
    put(access, (3, packet), d, count);
}

#[inline(always)]
fn put<S: Lanes>(
    access: &mut TextureAccess<'_>,
    (at, packet): (usize, usize),
    result: f32x16<S>,
    count: usize,
) {
    if at < count {
        let words: u32x16<S> = result.bitcast();
        words.store_array(&mut access.result_mut(at)[packet].0);
    }
}
