//! Fetches of sixteen texels at once, with the results of the scalar code in `fetch.rs`: of every
//! format that [`PacketFormat`] decodes and of integers, in every dimension, if all lanes read the
//! same mip level of a texture with one sample.

use super::blocks::rows_of_halves;
use super::coordinates::{Answers, packet};
use super::packet_texel::{OTHERS, PacketFormat, RGBA8, RGBA8_SRGB, RGBA16F};
use super::plane::{Plane, TexelView};
use estampe_format::attachment::Family;
use estampe_format::{AttachmentCodec, PacketCodec};
use estampe_simd::{
    Bytes, LANE_X, LANE_Y, LANES, Lanes as SimdLanes, Level, Packet, SimdBase, dispatch, f32x16,
    i32x16, mask32x16, u32x16,
};
use estampe_types::{Int, ViewDimension};

impl TexelView {
    /// Fetches sixteen texels at a SIMD level, as [`fetch`](Self::fetch) does: x, y, z, level and
    /// sample of each. `false`, with nothing stored, if packet code cannot do it: for stencil, and
    /// where lanes read several levels or a multisampled texture.
    pub fn fetch_packet(
        &self,
        level: Level,
        [x, y, z, mips, samples]: [&Packet<i32>; 5],
        texels: &mut [Packet<f32>; 4],
    ) -> bool {
        let plane = usize::try_from(mips.0[0]).ok();
        let Some(plane) = plane.and_then(|mip| self.planes.get(mip)) else {
            return false;
        };
        let is_uniform = mips.is_uniform() && samples.is_uniform() && samples.0[0] == 0;
        if !is_uniform || self.texture.shape.samples != 1 || self.texture.texels.is_empty() {
            return false;
        }
        let words = i32::try_from(self.codec.words()).unwrap_or(1);
        let fetch = PacketFetch {
            view: self,
            words,
            plane,
            places: [x, y, z],
        };
        let Some(format) = self.packets else {
            return self
                .integers
                .is_some_and(|codec| fetch.enter_integers(level, codec, texels));
        };
        let fetch = NumberFetch { of: fetch, format };
        match (format.components, format.kind()) {
            (1, _) => fetch.enter::<1>(level, texels),
            (_, RGBA8) => fetch.enter_special::<RGBA8>(level, texels),
            (_, RGBA8_SRGB) => fetch.enter_special::<RGBA8_SRGB>(level, texels),
            (_, RGBA16F) => fetch.enter_special::<RGBA16F>(level, texels),
            _ => fetch.enter::<4>(level, texels),
        }
    }
}

/// The rows of a block's lanes.
const ROWS: [u32; LANES] = times(LANE_Y, 1);
/// The words before a block's lanes in a row of texels of two words.
const COLUMN_WORDS: [u32; LANES] = times(LANE_X, 2);

pub(super) const fn times(of: [u8; LANES], factor: u32) -> [u32; LANES] {
    let mut products = [0; LANES];
    let mut lane = 0;
    while lane < LANES {
        products[lane] = of[lane] as u32 * factor;
        lane += 1;
    }
    products
}

/// A request for sixteen texels of a level.
struct PacketFetch<'a> {
    view: &'a TexelView,
    /// The words of a texel.
    words: i32,
    plane: &'a Plane,
    places: [&'a Packet<i32>; 3],
}

/// The same, of a format that is no integer.
struct NumberFetch<'a> {
    of: PacketFetch<'a>,
    format: PacketFormat,
}

impl NumberFetch<'_> {
    /// Fetches with the code for all formats of up to `C` channels; the scalar SIMD level has none.
    fn enter<const C: usize>(&self, level: Level, texels: &mut Answers) -> bool {
        dispatch!(@wide_move level, s => {
            self.fetch::<_, C, OTHERS>(s, texels);
            true
        }, scalar => false)
    }

    /// Fetches with code for one kind of format, where the SIMD level has some.
    fn enter_special<const KIND: u8>(&self, level: Level, texels: &mut Answers) -> bool {
        dispatch!(@specialized_move level, s => {
            self.fetch::<_, 4, KIND>(s, texels);
            true
        }, others => self.enter::<4>(level, texels))
    }

    #[inline(always)]
    fn fetch<S: SimdLanes, const C: usize, const KIND: u8>(&self, s: S, texels: &mut Answers) {
        let (index, is_outside) = self.of.index(s);
        if KIND == RGBA16F
            && s.bits_of_mask(is_outside) == 0
            && let Some(block) = self.of.block_of_halves(s, index)
        {
            for k in 0..4 {
                texels[k] = packet(block[k], 0);
            }
            return;
        }
        let alpha = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
        let words = self.of.words(s, index);
        let mut units = [<f32x16<S> as SimdBase<S>>::splat(s, 0.0); C];
        self.format.units::<S, C, KIND>(s, &words, &mut units);
        let scale = self.of.view.codec.scale();
        for (k, unit) in units.into_iter().enumerate() {
            // A channel that the format does not store is 0, or 1 if it is alpha.
            texels[k] = match k {
                k if k < self.format.components => zero_where(is_outside, unit * scale[k]),
                3 => zero_where(is_outside, alpha),
                _ => Packet::default(),
            };
        }
        if C == 1 {
            (texels[1], texels[2]) = (Packet::default(), Packet::default());
            texels[3] = zero_where(is_outside, alpha);
        }
    }
}

impl PacketFetch<'_> {
    /// Fetches integers; the scalar SIMD level has no code for it.
    fn enter_integers(&self, level: Level, codec: AttachmentCodec, texels: &mut Answers) -> bool {
        dispatch!(@wide_move level, s => match codec.family() {
            Family::Bits1(codec) => self.fetch_integers(s, codec, texels),
            Family::Bits2(codec) => self.fetch_integers(s, codec, texels),
            Family::Bits4(codec) => self.fetch_integers(s, codec, texels),
            _ => false,
        }, scalar => false)
    }

    #[inline(always)]
    fn fetch_integers<S: SimdLanes>(
        &self,
        s: S,
        codec: impl PacketCodec<S>,
        texels: &mut Answers,
    ) -> bool {
        let (index, is_outside) = self.index(s);
        let channels = codec.decode(s, self.words(s, index));
        for k in 0..4 {
            texels[k] = zero_where(is_outside, channels[k]);
        }
        true
    }

    /// The first word of each lane's texel, of lanes outside the level any number, as gathers clamp
    /// theirs; and the lanes outside.
    #[inline(always)]
    fn index<S: SimdLanes>(&self, s: S) -> (u32x16<S>, mask32x16<S>) {
        use ViewDimension as V;
        let (view, plane) = (self.view, self.plane);
        let zero: i32x16<S> = SimdBase::splat(s, 0);
        let [width, height, depth] = plane.sides;
        let slices = match view.dimension {
            V::D3 => depth,
            _ if view.is_cube() => view.layers * 6,
            _ => view.layers,
        };
        let x = self.place(s, 0);
        let mut index = x;
        let y = match view.dimension {
            V::D1 => zero,
            _ => self.place(s, 1),
        };
        let z = match view.dimension {
            V::D1 | V::D2 => zero,
            _ => self.place(s, 2),
        };
        let slice = z + Int::splat(zero, view.base_layer.cast_signed());
        let row = Int::wrapping_mul(slice, Int::splat(zero, height)) + y;
        index += Int::wrapping_mul(row, Int::splat(zero, width));
        let begin = Int::splat(zero, plane.begin_words(self.words));
        let first = Int::wrapping_mul(index, Int::splat(zero, self.words)) + begin;
        let is_outside = x.is_outside(width) | y.is_outside(height) | z.is_outside(slices);
        (first.bitcast(), is_outside)
    }

    /// The channels of a packet whose texels are a block of 4×4, as its lanes are: four rows of
    /// neighbours in memory. `None` if they are not, or if the level has no instruction for halves.
    #[inline(always)]
    fn block_of_halves<S: SimdLanes>(&self, s: S, index: u32x16<S>) -> Option<[f32x16<S>; 4]> {
        let texels = &self.view.texture.texels[..];
        let row = 2 * self.plane.sides[0].cast_unsigned();
        let column = u32x16::load_array(s, COLUMN_WORDS);
        let line = u32x16::load_array(s, ROWS) * <u32x16<S> as SimdBase<S>>::splat(s, row);
        let first = index[0];
        let block = column + line + <u32x16<S> as SimdBase<S>>::splat(s, first);
        let is_block: mask32x16<S> = index.simd_eq(block);
        if s.bits_of_mask(is_block) != u16::MAX {
            return None;
        }
        rows_of_halves(s, texels, [first, row])
    }

    /// A coordinate of each lane's texel.
    #[inline(always)]
    fn place<S: SimdLanes>(&self, s: S, axis: usize) -> i32x16<S> {
        SimdBase::from_slice(s, &self.places[axis].0)
    }

    /// The words of each lane's texel.
    #[inline(always)]
    fn words<S: SimdLanes>(&self, s: S, index: u32x16<S>) -> [u32x16<S>; 4] {
        let texels = &self.view.texture.texels[..];
        let mut words = [<u32x16<S> as SimdBase<S>>::splat(s, 0); 4];
        match self.words {
            1 => words[0] = s.gather(texels, index),
            2 => {
                let next = index + <u32x16<S> as SimdBase<S>>::splat(s, 1);
                words[0] = s.gather(texels, index);
                words[1] = s.gather(texels, next);
            }
            _ => words = s.gather_four(texels, index),
        }
        words
    }
}

/// A channel, with 0 in the lanes of a mask.
#[inline(always)]
pub(super) fn zero_where<S: SimdLanes>(mask: mask32x16<S>, channel: f32x16<S>) -> Packet<f32> {
    let zero = Int::splat(channel.bitcast::<i32x16<S>>(), 0);
    let bits: i32x16<S> = Int::select(mask, zero, channel.bitcast());
    let channel: f32x16<S> = bits.bitcast();
    packet(channel, 0)
}
