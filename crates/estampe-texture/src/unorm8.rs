//! The common kind of `textureLoad` and `textureStore`: a packet of texels of four unorm8 channels
//! in two dimensions. The results are those of the code for all formats.

use crate::TexelView;
use estampe_format::normalized::encode_unorm_lanes;
use estampe_simd::{
    Bytes, LANES, Lanes, Select, SimdBase, SimdCvtFloat, f32x16, i32x16, mask32x16, u32x16,
};
use estampe_types::{StorageTexture, TextureDimension, TextureFormat};
use std::sync::atomic::AtomicU32;

/// The numbers of the lanes.
const NUMBERS: [u32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// 1/255 rounded.
const UNIT: f32 = 1.0 / 255.0;

impl TexelView {
    /// True if [`load_unorm8`](Self::load_unorm8) loads texels of the view.
    #[inline]
    #[must_use]
    pub fn is_unorm8(&self) -> bool {
        self.is_unorm8
    }

    /// The texels of the finest level row by row, one word each, and its sides; `None` if
    /// [`load_unorm8`](Self::load_unorm8) loads none.
    #[must_use]
    pub fn unorm8_words(&self) -> Option<(&[u32], [u32; 2])> {
        let plane = self.planes.first().filter(|_| self.is_unorm8)?;
        let [width, height, _] = plane.sides.map(i32::cast_unsigned);
        Some((self.slice_words(plane)?, [width, height]))
    }

    /// The texels (x, y) of the finest level, zeros outside; `None` if the view is of another kind.
    #[inline(always)]
    pub fn load_unorm8<S: Lanes>(&self, s: S, at: [i32x16<S>; 2]) -> Option<[f32x16<S>; 4]> {
        let plane = self.planes.first()?;
        if !self.is_unorm8 {
            return None;
        }
        let [width, height, _] = plane.sides;
        let texels = self.slice_words(plane)?;
        let places = Places::new(s, at, [width, height]);
        let words = match places.row(texels) {
            Some(row) => u32x16::load_array_ref(s, row),
            None => {
                let inside: mask32x16<S> = s.mask_from_bits(places.inside);
                let none = <u32x16<S> as SimdBase<S>>::splat(s, 0);
                inside.select(s.gather(texels, places.index), none)
            }
        };
        Some([
            number(s, words, 0),
            number(s, words, 8),
            number(s, words, 16),
            number(s, words, 24),
        ])
    }
}

/// The number that a channel's code stands for, which begins at a bit of the texel.
#[inline(always)]
fn number<S: Lanes>(s: S, texel: u32x16<S>, bit: u32) -> f32x16<S> {
    let code = (texel >> bit) & <u32x16<S> as SimdBase<S>>::splat(s, 255);
    f32x16::float_from(code) * UNIT
}

/// The code of a number, from a bit of the texel on.
#[inline(always)]
fn code<S: Lanes>(s: S, number: f32x16<S>, bit: u32) -> u32x16<S> {
    let code: u32x16<S> = encode_unorm_lanes(s, number, 255.0).bitcast();
    code << bit
}

/// True if texels are four unorm bytes, in two dimensions.
fn is_unorm8(texture: &StorageTexture) -> bool {
    let is_rgba8 = matches!(
        texture.format(),
        TextureFormat::Rgba8Unorm | TextureFormat::Bgra8Unorm
    );
    is_rgba8 && texture.shape().dimension == TextureDimension::D2
}

/// The texels row by row, one word each, and the sides; `None` if [`store_unorm8`] stores none, or
/// there are several layers.
#[must_use]
pub fn stored_unorm8_words(texture: &StorageTexture) -> Option<(&[AtomicU32], [u32; 2])> {
    let is_packed = is_unorm8(texture) && texture.shape().depth_or_layers == 1;
    is_packed.then(|| (texture.words(), [texture.width(), texture.height()]))
}

/// Stores the texels (x, y) for the lanes of the mask, those inside; false if the texture is of
/// another kind, and nothing is stored.
#[inline(always)]
pub fn store_unorm8<S: Lanes>(
    s: S,
    texture: &StorageTexture,
    (at, mask): ([i32x16<S>; 2], u16),
    [r, g, b, a]: [f32x16<S>; 4],
) -> bool {
    if !is_unorm8(texture) {
        return false;
    }
    let sides = [texture.width(), texture.height()].map(u32::cast_signed);
    let places = Places::new(s, at, sides);
    let words = code(s, r, 0) | code(s, g, 8) | code(s, b, 16) | code(s, a, 24);
    let [mut stored, mut index] = [[0; LANES]; 2];
    words.store_array(&mut stored);
    places.index.store_array(&mut index);
    let stores = mask & places.inside;
    for (lane, (word, index)) in stored.into_iter().zip(index).enumerate() {
        if stores >> lane & 1 == 1 {
            texture.store(index as usize, word);
        }
    }
    true
}

/// Where the texels of a packet are.
struct Places<S: Lanes> {
    /// The number of each texel in its slice.
    index: u32x16<S>,
    /// The lanes whose texels are inside.
    inside: u16,
    /// The first lane's number if the others have the numbers that follow it, and all are inside.
    first: Option<u32>,
}

impl<S: Lanes> Places<S> {
    #[inline(always)]
    fn new(s: S, [x, y]: [i32x16<S>; 2], sides: [i32; 2]) -> Self {
        let width = <i32x16<S> as SimdBase<S>>::splat(s, sides[0]);
        let height = <i32x16<S> as SimdBase<S>>::splat(s, sides[1]);
        let zero = <i32x16<S> as SimdBase<S>>::splat(s, 0);
        let is_inside = x.simd_ge(zero) & x.simd_lt(width) & y.simd_ge(zero) & y.simd_lt(height);
        let inside = s.bits_of_mask(is_inside);
        let index: u32x16<S> = (y * width + x).bitcast();
        let first = index[0];
        let row = u32x16::load_array_ref(s, &NUMBERS) + first;
        let is_row: mask32x16<S> = index.simd_eq(row);
        let is_row = inside == u16::MAX && s.bits_of_mask(is_row) == u16::MAX;
        Self {
            index,
            inside,
            first: is_row.then_some(first),
        }
    }

    /// The texels, if they stand side by side.
    #[inline(always)]
    fn row<'a>(&self, texels: &'a [u32]) -> Option<&'a [u32; LANES]> {
        texels.get(self.first? as usize..)?.first_chunk()
    }
}
