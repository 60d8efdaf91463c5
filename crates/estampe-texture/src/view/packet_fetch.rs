//! Fetches of sixteen texels at once, with the results of the scalar code in `fetch.rs`: of every
//! format that [`PacketFormat`] decodes, in every dimension, if all lanes read the same mip level
//! of a texture with one sample.

use super::coordinates::{Answers, packet};
use super::packet_texel::{OTHERS, PacketFormat, RGBA8, RGBA8_SRGB, RGBA16F};
use super::plane::{Plane, TexelView};
use estampe_simd::{
    Bytes, LANE_X, LANE_Y, LANES, Lanes as SimdLanes, Level, Packet, SimdBase, dispatch, f32x16,
    i32x16, mask32x16, u32x16,
};
use estampe_types::{Int, ViewDimension};

impl TexelView {
    /// Fetches sixteen texels at a SIMD level, as [`fetch`](Self::fetch) does: x, y, z, level and
    /// sample of each. `false`, with nothing stored, if packet code cannot do it: for integers, and
    /// where lanes read several levels or a multisampled texture.
    pub fn fetch_packet(
        &self,
        level: Level,
        [x, y, z, mips, samples]: [&Packet<i32>; 5],
        texels: &mut [Packet<f32>; 4],
    ) -> bool {
        let Some(format) = self.packets else {
            return false;
        };
        let plane = usize::try_from(mips.0[0]).ok();
        let Some(plane) = plane.and_then(|mip| self.planes.get(mip)) else {
            return false;
        };
        let is_uniform = mips.is_uniform() && samples.is_uniform() && samples.0[0] == 0;
        if !is_uniform || self.texture.shape.samples != 1 || self.texture.texels.is_empty() {
            return false;
        }
        let fetch = PacketFetch {
            view: self,
            format,
            plane,
            places: [x, y, z],
        };
        match (format.components, format.kind()) {
            (1, _) => fetch.enter::<1>(level, texels),
            (_, RGBA8) => fetch.enter_special::<RGBA8>(level, texels),
            (_, RGBA8_SRGB) => fetch.enter_special::<RGBA8_SRGB>(level, texels),
            (_, RGBA16F) => fetch.enter_special::<RGBA16F>(level, texels),
            _ => fetch.enter::<4>(level, texels),
        }
    }
}

impl TexelView {
    /// Fetches the texels of several textures at the same places (x, y) of a level. `false` unless
    /// all are two-dimensional ones of half floats, of one size, and the texels a block inside the
    /// level; what is stored then means nothing.
    pub fn fetch_blocks(
        views: &[&Self],
        level: Level,
        [x, y, mips]: [&Packet<i32>; 3],
        texels: &mut [Answers],
    ) -> bool {
        let Some((first, others)) = views.split_first() else {
            return false;
        };
        let plane = |view: &Self| {
            let plane = view.planes.get(usize::try_from(mips.0[0]).ok()?)?;
            let is_common = view.packets.is_some_and(|format| format.kind() == RGBA16F)
                && view.dimension == ViewDimension::D2
                && view.texture.shape.samples == 1;
            is_common.then_some(*plane)
        };
        let Some(Plane { sides, .. }) = plane(first).filter(|_| mips.is_uniform()) else {
            return false;
        };
        let is_like = |other: &&Self| plane(other).is_some_and(|plane| plane.sides == sides);
        if !others.iter().all(is_like) {
            return false;
        }
        dispatch!(@specialized_move level, s => {
            let Some(texel) = first_of_block(s, [x, y], sides) else {
                return false;
            };
            for (view, texels) in views.iter().zip(texels) {
                let Some([r, g, b, a]) = view.block_at(s, mips.0[0], texel) else {
                    return false;
                };
                *texels = [packet(r, 0), packet(g, 0), packet(b, 0), packet(a, 0)];
            }
            true
        }, others => false)
    }

    /// The channels of a block of half floats whose first texel has this number in the level's
    /// first image of the view.
    #[inline(always)]
    fn block_at<S: SimdLanes>(&self, s: S, mip: i32, texel: i32) -> Option<[f32x16<S>; 4]> {
        let plane = self.planes.get(usize::try_from(mip).ok()?)?;
        let [width, height, _] = plane.sides;
        let slice = self.base_layer.cast_signed().wrapping_mul(height);
        let texel = slice.wrapping_mul(width).wrapping_add(texel);
        let first = texel.wrapping_mul(2).wrapping_add(plane.begin_words(2));
        let row = 2 * width.cast_unsigned();
        rows_of_halves(s, &self.texture.texels[..], [first.cast_unsigned(), row])
    }
}

/// The number of the first texel, if the texels at these places are a block inside an image.
#[inline(always)]
fn first_of_block<S: SimdLanes>(
    s: S,
    [x, y]: [&Packet<i32>; 2],
    [width, height, _]: [i32; 3],
) -> Option<i32> {
    let (left, top) = (x.0[0], y.0[0]);
    let columns: i32x16<S> = u32x16::load_array(s, COLUMNS).bitcast();
    let rows: i32x16<S> = u32x16::load_array(s, ROWS).bitcast();
    let columns = columns + <i32x16<S> as SimdBase<S>>::splat(s, left);
    let rows = rows + <i32x16<S> as SimdBase<S>>::splat(s, top);
    let is_column = i32x16::load_array_ref(s, &x.0).simd_eq(columns);
    let is_row = i32x16::load_array_ref(s, &y.0).simd_eq(rows);
    let is_block: mask32x16<S> = is_column & is_row;
    let is_inside = left >= 0 && top >= 0 && left <= width - SIDE && top <= height - SIDE;
    (is_inside && s.bits_of_mask(is_block) == u16::MAX).then(|| top * width + left)
}

/// The channels of a block of half floats, from its first word and the words of a row of the image;
/// `None` if they are not in memory, or if the level has no instruction for halves.
#[inline(always)]
fn rows_of_halves<S: SimdLanes>(
    s: S,
    texels: &[u32],
    [first, row]: [u32; 2],
) -> Option<[f32x16<S>; 4]> {
    let mut rows = [<f32x16<S> as SimdBase<S>>::splat(s, 0.0); 4];
    let mut texels = texels.get(first as usize..)?;
    for (at, to) in rows.iter_mut().enumerate() {
        if at > 0 {
            texels = texels.get(row as usize..)?;
        }
        *to = s.row_of_halves(texels.first_chunk()?)?;
    }
    Some(s.channels_of_rows(rows))
}

/// The columns and rows of a block.
const SIDE: i32 = 4;

/// The columns of a block's lanes.
const COLUMNS: [u32; LANES] = times(LANE_X, 1);
/// The rows of a block's lanes.
const ROWS: [u32; LANES] = times(LANE_Y, 1);
/// The words before a block's lanes in a row of texels of two words.
const COLUMN_WORDS: [u32; LANES] = times(LANE_X, 2);

const fn times(of: [u8; LANES], factor: u32) -> [u32; LANES] {
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
    format: PacketFormat,
    plane: &'a Plane,
    places: [&'a Packet<i32>; 3],
}

impl PacketFetch<'_> {
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
        use ViewDimension as V;
        let (view, plane) = (self.view, self.plane);
        let zero: i32x16<S> = SimdBase::splat(s, 0);
        let [width, height, depth] = plane.sides;
        let slices = match view.dimension {
            V::D3 => depth,
            _ if view.is_cube() => view.layers * 6,
            _ => view.layers,
        };
        // The index of the texel; of lanes outside the level any number, as gathers clamp theirs.
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
        let size = self.format.words;
        let begin = Int::splat(zero, plane.begin_words(size));
        let index: u32x16<S> = (Int::wrapping_mul(index, Int::splat(zero, size)) + begin).bitcast();

        let alpha = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
        let is_outside = x.is_outside(width) | y.is_outside(height) | z.is_outside(slices);
        if KIND == RGBA16F
            && s.bits_of_mask(is_outside) == 0
            && let Some(block) = self.block_of_halves(s, index)
        {
            for k in 0..4 {
                texels[k] = packet(block[k], 0);
            }
            return;
        }
        let words = self.words(s, index);
        let mut units = [<f32x16<S> as SimdBase<S>>::splat(s, 0.0); C];
        self.format.units::<S, C, KIND>(s, &words, &mut units);
        let scale = view.codec.scale();
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
        match self.format.words {
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
fn zero_where<S: SimdLanes>(mask: mask32x16<S>, channel: f32x16<S>) -> Packet<f32> {
    let zero = Int::splat(channel.bitcast::<i32x16<S>>(), 0);
    let bits: i32x16<S> = Int::select(mask, zero, channel.bitcast());
    let channel: f32x16<S> = bits.bitcast();
    packet(channel, 0)
}
