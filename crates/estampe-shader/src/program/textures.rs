//! Accesses to textures: what a kernel asks, answered by `estampe_texture`.

use estampe_ir::interface::TextureSlot;
use estampe_ir::interpreter::{TextureAccess, Textures};
use estampe_ir::op::{LevelOfDetail, TextureQuery};
use estampe_simd::{
    Bytes, LANES, Lanes, Packet, SimdBase, dispatch, f32x16, i32x16, mask32x16, u32x16,
};
use estampe_texture::{
    Coordinates, Lod, Rgba8Texture, SampledTexture, TextureBindings, sample_compare_level,
    storage_load, storage_store, store_unorm8,
};
use estampe_types::{Bindings, Real, ShadowMap, StorageTexture, Vec2, Vec3, Vec4, ViewDimension};
use std::cell::OnceCell;
use std::sync::Arc;

/// The textures that a draw binds, as a kernel numbers them.
#[derive(Debug)]
pub(super) struct BoundTextures<'a> {
    bindings: &'a Bindings,
    textures: &'a [TextureSlot],
    samplers: &'a [TextureSlot],
    /// For each texture and sampler, both together; made when it is first sampled. `None` inside
    /// where the sampler cannot sample the texture.
    sampled: Vec<OnceCell<Option<Arc<SampledTexture>>>>,
}

impl<'a> BoundTextures<'a> {
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
            sampled: vec![OnceCell::new(); pairs],
        }
    }

    fn sampled(&self, texture: u32, sampler: u32) -> Option<&SampledTexture> {
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
        made.as_deref()
    }
}

impl Textures for BoundTextures<'_> {
    fn access(&self, mut access: TextureAccess<'_>) {
        if self.common_access(&mut access) {
            return;
        }
        for result in 0..access.results() {
            access.result_mut(result).fill(Packet::default());
        }
        let level = access.level;
        match access.op.query {
            TextureQuery::Sample
            | TextureQuery::SampleCompare
            | TextureQuery::Gather(_)
            | TextureQuery::GatherCompare => {
                let sampler = access.op.sampler.unwrap_or(u32::MAX);
                if let Some(texture) = self.sampled(access.op.texture, sampler) {
                    dispatch!(level, s => sample(s, texture, &mut access));
                }
            }
            TextureQuery::Load => dispatch!(level, s => self.load(s, &mut access)),
            TextureQuery::Store => dispatch!(level, s => self.store(s, &access)),
            TextureQuery::Size
            | TextureQuery::Levels
            | TextureQuery::Layers
            | TextureQuery::Samples => self.query(&mut access),
        }
    }
}

impl BoundTextures<'_> {
    /// Does an access of one packet whose form and whose texture are the common ones; otherwise
    /// false is returned, and nothing done.
    #[inline]
    fn common_access(&self, access: &mut TextureAccess<'_>) -> bool {
        let op = access.op;
        let ([_, _], [0, 0, 0], None, &[mask]) =
            (&op.coordinates[..], op.offset, op.layer, access.mask)
        else {
            return false;
        };
        let level = access.level;
        let Some(sampler) = op.sampler else {
            return match op.query {
                TextureQuery::Load => dispatch!(level, s => self.load_common(s, access)),
                TextureQuery::Store => dispatch!(level, s => self.store_common(s, access, mask)),
                _ => false,
            };
        };
        match (op.query, &op.level) {
            (TextureQuery::Sample, LevelOfDetail::Implicit) if mask == whole_quads(mask) => {
                let texture = self.sampled(op.texture, sampler);
                let Some(texture) = texture.and_then(SampledTexture::common) else {
                    return false;
                };
                dispatch!(level, s => plain(s, texture, access));
                true
            }
            (TextureQuery::SampleCompare, _) => {
                let texture = self.sampled(op.texture, sampler);
                let Some(depths) = texture.and_then(SampledTexture::depths) else {
                    return false;
                };
                dispatch!(level, s => compare(s, depths, access));
                true
            }
            _ => false,
        }
    }

    /// Loads a packet of texels of the finest level; false if the texture is not a common one.
    #[inline(always)]
    fn load_common<S: Lanes>(&self, s: S, access: &mut TextureAccess<'_>) -> bool {
        let (group, binding) = self.slot(access);
        let level = access.level_of_detail();
        let is_finest = level.is_none_or(|level| level[0].0 == [0; LANES]);
        let is_stored = self.bindings.storage_texture(group, binding).is_some();
        if !is_finest || is_stored || access.sample().is_some() {
            return false;
        }
        let [x, y, _] = texel(s, access, 0);
        let Some(texels) = self.bindings.texture(group, binding).load_unorm8(s, [x, y]) else {
            return false;
        };
        set(access, 0, texels);
        true
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

    fn slot(&self, access: &TextureAccess<'_>) -> (u32, u32) {
        let slot = self.textures.get(access.op.texture as usize);
        slot.map_or((u32::MAX, u32::MAX), |slot| (slot.group, slot.binding))
    }

    #[inline(always)]
    fn load<S: Lanes>(&self, s: S, access: &mut TextureAccess<'_>) {
        let (group, binding) = self.slot(access);
        for packet in 0..access.packets {
            let at = texel(s, access, packet);
            let texel = match self.bindings.storage_texture(group, binding) {
                Some(texture) => storage_load(texture, at),
                None => {
                    let zero = <i32x16<S> as SimdBase<S>>::splat(s, 0);
                    let ints = |words: Option<&[Packet<u32>]>| {
                        words.map_or(zero, |words| ints(s, words, packet))
                    };
                    let level = ints(access.level_of_detail());
                    let sample = ints(access.sample());
                    self.bindings
                        .texture(group, binding)
                        .fetch(at, level, sample)
                }
            };
            set(access, packet, [texel.x, texel.y, texel.z, texel.w]);
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

    fn query(&self, access: &mut TextureAccess<'_>) {
        let (group, binding) = self.slot(access);
        let storage = self.bindings.storage_texture(group, binding);
        let view = self.bindings.texture(group, binding);
        let count = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
        for packet in 0..access.packets {
            for lane in 0..16 {
                let level = access.level_of_detail();
                let level = level.map_or(0, |level| level[packet].0[lane]);
                let size = || match storage {
                    Some(texture) => [texture.width(), texture.height(), slices(texture)],
                    None if (level as usize) < view.level_count() => view.size(level as usize),
                    None => [0; 3],
                };
                let words = match access.op.query {
                    TextureQuery::Levels => [count(view.level_count()), 0, 0],
                    TextureQuery::Layers => match storage {
                        Some(texture) => [slices(texture), 0, 0],
                        None => [view.layer_count(), 0, 0],
                    },
                    TextureQuery::Samples => [view.sample_count(), 0, 0],
                    _ => size(),
                };
                for (at, word) in words.into_iter().enumerate().take(access.results()) {
                    access.result_mut(at)[packet].0[lane] = word;
                }
            }
        }
    }
}

/// Samples a texture of the common kind in one packet. Operands and results are loaded and stored
/// by whole registers: a load waits long for several stores to the same line.
#[inline(always)]
fn plain<S: Lanes>(s: S, texture: &Rgba8Texture, access: &mut TextureAccess<'_>) {
    let u = floats(s, access.coordinate(0), 0);
    let v = floats(s, access.coordinate(1), 0);
    let color = texture.sample(Vec2::new(u, v));
    set(access, 0, [color.x, color.y, color.z, color.w]);
}

/// Compares the depths of a shadow map.
#[inline(always)]
fn compare<S: Lanes>(s: S, depths: &ShadowMap, access: &mut TextureAccess<'_>) {
    let uv = Vec2::new(
        floats(s, access.coordinate(0), 0),
        floats(s, access.coordinate(1), 0),
    );
    let reference = access.reference().unwrap_or_default();
    let share = sample_compare_level(depths, uv, floats(s, reference, 0));
    let words: u32x16<S> = share.bitcast();
    words.store_array(&mut access.result_mut(0)[0].0);
}

/// Samples, compares and gathers.
#[inline(always)]
fn sample<S: Lanes>(s: S, texture: &SampledTexture, access: &mut TextureAccess<'_>) {
    let zero = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
    for packet in 0..access.packets {
        let u = coordinate(s, access, (0, packet));
        let v = coordinate(s, access, (1, packet));
        let w = coordinate(s, access, (2, packet));
        let uvw = Vec3::new(u, v, w);
        let layer = access.layer().map(|layer| ints(s, layer, packet));
        let layer = layer.unwrap_or(<i32x16<S> as SimdBase<S>>::splat(s, 0));
        // An array view takes the layer; of others it is 0.
        let at = match texture.view().dimension() {
            ViewDimension::CubeArray => Coordinates::cube_array(uvw, layer),
            ViewDimension::D2Array => Coordinates::d2_array(Vec2::new(uvw.x, uvw.y), layer),
            _ => Coordinates::d3(uvw),
        };
        let result = answer(s, texture, access, (packet, at), lod(s, access, packet));
        let whole = whole_quads(access.mask[packet]);
        let takes_derivatives = matches!(
            access.op.level,
            LevelOfDetail::Implicit | LevelOfDetail::Bias(_)
        );
        let result = if !takes_derivatives || whole == access.mask[packet] {
            result
        } else {
            let none = Vec3::new(zero, zero, zero);
            let alone = answer(s, texture, access, (packet, at), Lod::Gradients(none, none));
            let mask: mask32x16<S> = s.mask_from_bits(whole);
            let [a, b, c, d] = result;
            let [of_a, of_b, of_c, of_d] = alone;
            [
                f32x16::<S>::select(mask, a, of_a),
                f32x16::<S>::select(mask, b, of_b),
                f32x16::<S>::select(mask, c, of_c),
                f32x16::<S>::select(mask, d, of_d),
            ]
        };
        set(access, packet, result);
    }
}

/// A coordinate, 0 if the operation has fewer.
#[inline(always)]
fn coordinate<S: Lanes>(
    s: S,
    access: &TextureAccess<'_>,
    (at, packet): (usize, usize),
) -> f32x16<S> {
    if at < access.op.coordinates.len() {
        floats(s, access.coordinate(at), packet)
    } else {
        <f32x16<S> as SimdBase<S>>::splat(s, 0.0)
    }
}

#[inline(always)]
fn answer<S: Lanes>(
    s: S,
    texture: &SampledTexture,
    access: &TextureAccess<'_>,
    (packet, at): (usize, Coordinates<f32x16<S>>),
    lod: Lod<f32x16<S>>,
) -> [f32x16<S>; 4] {
    let [x, y, _] = access.op.offset;
    let reference = access.reference().map(|words| floats(s, words, packet));
    let zero = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
    let reference = reference.unwrap_or(zero);
    let four = match access.op.query {
        TextureQuery::SampleCompare => {
            let share = texture.sample_compare(at, reference, lod, [x, y]);
            return [share, zero, zero, zero];
        }
        TextureQuery::Gather(channel) => texture.gather(at, usize::from(channel), [x, y]),
        TextureQuery::GatherCompare => texture.gather_compare(at, reference, [x, y]),
        _ if matches!(lod, Lod::Implicit) && access.op.offset == [0; 3] => texture.sample(at),
        _ => texture.sample_with(at, lod, access.op.offset),
    };
    [four.x, four.y, four.z, four.w]
}

#[inline(always)]
fn lod<S: Lanes>(s: S, access: &TextureAccess<'_>, packet: usize) -> Lod<f32x16<S>> {
    let zero = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
    let value = access
        .level_of_detail()
        .map(|words| floats(s, words, packet));
    let value = value.unwrap_or(zero);
    match &access.op.level {
        LevelOfDetail::Zero => Lod::Level(zero),
        LevelOfDetail::Implicit => Lod::Implicit,
        LevelOfDetail::Bias(_) => Lod::Bias(value),
        LevelOfDetail::Explicit(_) => Lod::Level(value),
        LevelOfDetail::Gradient { x, .. } => {
            let count = x.len();
            let along_x = gradient(s, access, (0, count), packet);
            let along_y = gradient(s, access, (1, count), packet);
            Lod::Gradients(along_x, along_y)
        }
    }
}

/// The derivative of the coordinates, so many, along an axis of the picture.
#[inline(always)]
fn gradient<S: Lanes>(
    s: S,
    access: &TextureAccess<'_>,
    (axis, count): (usize, usize),
    packet: usize,
) -> Vec3<f32x16<S>> {
    let zero = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
    let mut parts = [zero; 3];
    for (at, part) in parts.iter_mut().enumerate().take(count) {
        if let Some(words) = access.gradient(axis, at) {
            *part = floats(s, words, packet);
        }
    }
    let [x, y, z] = parts;
    Vec3::new(x, y, z)
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

/// The lanes of quads that are wholly in a mask.
fn whole_quads(mask: u16) -> u16 {
    let pairs = mask & mask >> 1;
    let firsts = pairs & pairs >> 2 & 0x1111;
    firsts * 0xF
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

#[cfg(test)]
mod tests {
    use super::whole_quads;

    #[test]
    fn quads_count_only_if_all_of_their_lanes_run() {
        assert_eq!(whole_quads(0xFFFF), 0xFFFF);
        assert_eq!(whole_quads(0xF7F0), 0xF0F0);
        assert_eq!(whole_quads(0x8EEF), 0x000F);
    }
}
