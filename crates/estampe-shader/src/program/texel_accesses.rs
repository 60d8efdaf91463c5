//! Accesses to texels without a sampler: loads and stores.

use super::samples::MOST;
use super::textures::BoundTextures;
use estampe_ir::interpreter::{TextureAccess, TextureAccesses};
use estampe_ir::op::TextureQuery;
use estampe_simd::{
    Bytes, LANES, Lanes, Packet, SimdBase, dispatch, f32x16, floats_of, floats_of_mut, i32x16,
    ints_of, mask32x16, u32x16,
};
use estampe_texture::{
    TexelView, TextureBindings, load_packet, storage_load, storage_store, store_packet,
    store_unorm8,
};
use estampe_types::Vec4;

impl BoundTextures<'_> {
    /// Loads or stores one packet of texels of the common kind; otherwise false is returned, and
    /// nothing done.
    #[inline]
    pub(super) fn common_access(&self, access: &mut TextureAccess<'_>) -> bool {
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
                    || load_viewed(view, access)
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
    pub(super) fn load_all(&self, accesses: &mut TextureAccesses<'_>) -> bool {
        let (operands, _) = accesses.all();
        let is_block = matches!(operands, [x, y, ..] if begins_block(x, y));
        let ops = accesses.ops;
        if !is_block {
            return false;
        }
        let mut views = [None; MOST];
        for (to, op) in views.iter_mut().zip(ops) {
            *to = self.loaded(op.texture);
            if to.is_none() {
                return false;
            }
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

    #[inline(always)]
    pub(super) fn load<S: Lanes>(&self, s: S, access: &mut TextureAccess<'_>) {
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
    pub(super) fn store<S: Lanes>(&self, s: S, access: &TextureAccess<'_>) {
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

    /// Loads from or stores to a storage texture packet by packet; false if that is not what is
    /// asked, or the SIMD level has no code for it, and nothing is done.
    pub(super) fn access_stored(&self, access: &mut TextureAccess<'_>) -> bool {
        let (group, binding) = self.slot(access);
        let Some(texture) = self.bindings.storage_texture(group, binding) else {
            return false;
        };
        let is_store = match access.op.query {
            TextureQuery::Store => true,
            TextureQuery::Load => false,
            _ => return false,
        };
        if access.op.offset != [0; 3] {
            return false;
        }
        let level = access.level;
        for packet in 0..access.packets {
            let at = places(access, packet);
            if is_store {
                let texels = [0, 1, 2, 3].map(|k| &floats_of(access.stored(k))[packet]);
                if !store_packet(texture, level, (at, access.mask[packet]), texels) {
                    return false;
                }
                continue;
            }
            let mut texels = [Packet::default(); 4];
            if !load_packet(texture, level, at, &mut texels) {
                return false;
            }
            for (k, texel) in texels.iter().enumerate().take(access.results()) {
                floats_of_mut(access.result_mut(k))[packet] = *texel;
            }
        }
        true
    }
}

/// The coordinates of a packet's texels, with the layer after them.
fn places<'a>(access: &TextureAccess<'a>, packet: usize) -> [&'a Packet<i32>; 3] {
    let mut at = [&ZEROS; 3];
    let count = access.op.coordinates.len();
    for (axis, place) in at.iter_mut().enumerate().take(count) {
        *place = &ints_of(access.coordinate(axis))[packet];
    }
    if let Some(layer) = access.layer() {
        at[2] = &ints_of(layer)[packet];
    }
    at
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

/// Loads a packet of texels of any format; false if they cannot be loaded together, and nothing is
/// done.
fn load_viewed(view: &TexelView, access: &mut TextureAccess<'_>) -> bool {
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
