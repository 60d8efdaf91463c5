//! The common kind of `textureLoad` and `textureStore`: a packet of texels of four unorm8 channels
//! in two dimensions. The results are those of the code for all formats.

use crate::TexelView;
use estampe_format::normalized::encode_unorm_lanes;
use estampe_simd::{
    Bytes, LANES, Lanes, Select, SimdBase, SimdCvtFloat, f32x16, i32x16, mask32x16, u32x16,
};
use estampe_types::{StorageTexture, TextureDimension, TextureFormat, ViewDimension};

/// The numbers of the lanes.
const NUMBERS: [u32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// 1/255 rounded.
const UNIT: f32 = 1.0 / 255.0;

impl TexelView {
    /// The texels (x, y) of the finest level, zeros outside; `None` if the view is of another kind.
    #[inline(always)]
    pub fn load_unorm8<S: Lanes>(&self, s: S, at: [i32x16<S>; 2]) -> Option<[f32x16<S>; 4]> {
        let plane = self.planes.first()?;
        let format = self.texture.stored_format();
        let is_common = format == TextureFormat::Rgba8Unorm
            && self.dimension == ViewDimension::D2
            && self.texture.shape.samples == 1;
        if !is_common {
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

/// Stores the texels (x, y) for the lanes of the mask, those inside; false if the texture is of
/// another kind, and nothing is stored.
#[inline(always)]
pub fn store_unorm8<S: Lanes>(
    s: S,
    texture: &StorageTexture,
    (at, mask): ([i32x16<S>; 2], u16),
    [r, g, b, a]: [f32x16<S>; 4],
) -> bool {
    let is_rgba8 = matches!(
        texture.format(),
        TextureFormat::Rgba8Unorm | TextureFormat::Bgra8Unorm
    );
    if !is_rgba8 || texture.shape().dimension != TextureDimension::D2 {
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

#[cfg(test)]
mod tests {
    use super::store_unorm8;
    use crate::{
        MipGeneration, TexelDescriptor, TexelView, create_storage_texture, create_texture,
        storage_bytes, storage_store,
    };
    use estampe_simd::{
        Bytes, LANES, Lanes, Level, SimdBase, dispatch, f32x16, i32x16, mask32x16, u32x16,
    };
    use estampe_types::{Limits, TextureFormat, Vec4};

    const SIDES: [u32; 2] = [13, 9];

    fn bits<S: Lanes>(texels: [f32x16<S>; 4]) -> [[u32; LANES]; 4] {
        let mut all = [[0; LANES]; 4];
        for (channel, to) in texels.into_iter().zip(&mut all) {
            let words: u32x16<S> = channel.bitcast();
            words.store_array(to);
        }
        all
    }

    fn check<S: Lanes>(s: S, random: &mut fastrand::Rng, inside: &mut u32) {
        let [width, height] = SIDES;
        let bytes: Vec<u8> = (0..width * height * 4).map(|_| random.u8(..)).collect();
        for format in [TextureFormat::Rgba8Unorm, TextureFormat::Bgra8Unorm] {
            let descriptor = TexelDescriptor::new_2d(width, height, format);
            let limits = Limits::default();
            let none = MipGeneration::None;
            let texture = create_texture(width, height, format, &bytes, none, &limits).unwrap();
            let view = TexelView::of(texture).unwrap();
            let stored =
                [(); 2].map(|()| create_storage_texture(&descriptor, None, &limits).unwrap());
            let zero = <i32x16<S> as SimdBase<S>>::splat(s, 0);
            for _ in 0..20 {
                let [x, y] = [(); 2].map(|()| {
                    let lanes: [i32; LANES] = std::array::from_fn(|_| match random.u32(0..12) {
                        0 => random.i32(..),
                        _ => random.i32(-2..15),
                    });
                    i32x16::load_array(s, lanes)
                });
                let found = view.load_unorm8(s, [x, y]).unwrap();
                let wanted = view.fetch([x, y, zero], zero, zero);
                let wanted = bits([wanted.x, wanted.y, wanted.z, wanted.w]);
                assert_eq!(bits(found), wanted);
                *inside += u32::from(wanted.concat().iter().any(|word| *word != 0));
                let channels = [(); 4].map(|()| {
                    let lanes: [f32; LANES] = std::array::from_fn(|_| match random.u32(0..12) {
                        0 => f32::from_bits(random.u32(..)),
                        _ => random.f32() * 1.2 - 0.1,
                    });
                    f32x16::load_array(s, lanes)
                });
                let mask = random.u16(..);
                assert!(store_unorm8(s, &stored[0], ([x, y], mask), channels));
                let lanes: mask32x16<S> = s.mask_from_bits(mask);
                let [r, g, b, a] = channels;
                storage_store(&stored[1], lanes, [x, y, zero], Vec4::new(r, g, b, a));
            }
            assert_eq!(storage_bytes(&stored[0]), storage_bytes(&stored[1]));
        }
    }

    #[test]
    fn packets_are_those_of_the_code_for_all_formats() {
        let mut random = fastrand::Rng::with_seed(8);
        let mut inside = 0;
        for level in Level::all_available() {
            dispatch!(level, s => check(s, &mut random, &mut inside));
        }
        assert!(inside > 10);
    }
}
