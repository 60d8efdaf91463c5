//! Loads and stores of sixteen texels of a storage texture at once, with the results of the code
//! for each lane in `storage.rs`: of every format, in every dimension.

use crate::storage::stored;
use estampe_format::{AttachmentCodec, PacketCodec, with_codec};
use estampe_simd::{LANES, Lanes, Level, Packet, SimdBase, dispatch, f32x16, u32x16};
use estampe_types::StorageTexture;

/// Stores sixteen texels at a SIMD level, as [`storage_store`](crate::storage_store) does: x, y and
/// the slice of each, in the lanes of the mask. False, with nothing stored, if the level has no
/// code for packets.
#[inline(never)]
pub fn store_packet(
    texture: &StorageTexture,
    level: Level,
    (at, mask): ([&Packet<i32>; 3], u16),
    texels: [&Packet<f32>; 4],
) -> bool {
    let codec = AttachmentCodec::new(stored(texture));
    dispatch!(@specialized_move level, s => {
        let words = with_codec!(codec, c => encode(s, c, texels));
        let places = Places::of(texture, at);
        places.store(texture, mask, &words);
        true
    }, others => false)
}

/// Loads sixteen texels at a SIMD level, as [`storage_load`](crate::storage_load) does. False, with
/// nothing stored, if the level has no code for packets.
#[inline(never)]
pub fn load_packet(
    texture: &StorageTexture,
    level: Level,
    at: [&Packet<i32>; 3],
    texels: &mut [Packet<f32>; 4],
) -> bool {
    let codec = AttachmentCodec::new(stored(texture));
    dispatch!(@specialized_move level, s => {
        let places = Places::of(texture, at);
        let words = places.load(texture);
        with_codec!(codec, c => decode(s, c, &words, texels));
        for lane in 0..LANES {
            if places.inside >> lane & 1 == 0 {
                for channel in &mut *texels {
                    channel.0[lane] = 0.0;
                }
            }
        }
        true
    }, others => false)
}

#[inline(always)]
fn encode<S: Lanes, C: PacketCodec<S>>(
    s: S,
    codec: C,
    [r, g, b, a]: [&Packet<f32>; 4],
) -> [Packet<u32>; 4] {
    let color = [lanes(s, r), lanes(s, g), lanes(s, b), lanes(s, a)];
    let words = codec.encode(s, color);
    let mut packets = [Packet::default(); 4];
    for k in 0..C::WORDS {
        words[k].store_array(&mut packets[k].0);
    }
    packets
}

#[inline(always)]
fn lanes<S: Lanes>(s: S, packet: &Packet<f32>) -> f32x16<S> {
    f32x16::load_array_ref(s, &packet.0)
}

#[inline(always)]
fn decode<S: Lanes, C: PacketCodec<S>>(
    s: S,
    codec: C,
    packets: &[Packet<u32>; 4],
    texels: &mut [Packet<f32>; 4],
) {
    let mut words = [<u32x16<S> as SimdBase<S>>::splat(s, 0); 4];
    for k in 0..C::WORDS {
        words[k] = u32x16::load_array_ref(s, &packets[k].0);
    }
    let channels = codec.decode(s, words);
    for k in 0..4 {
        channels[k].store_array(&mut texels[k].0);
    }
}

/// The places of sixteen texels.
struct Places {
    /// The first word of each texel, of lanes outside any number.
    first: [usize; LANES],
    /// The lanes whose texels are inside.
    inside: u16,
}

impl Places {
    #[inline(always)]
    fn of(texture: &StorageTexture, [x, y, slice]: [&Packet<i32>; 3]) -> Self {
        let [width, height] = [texture.width(), texture.height()];
        let slices = texture.shape().depth_or_layers;
        let count = texture.words_per_texel();
        let mut places = Self {
            first: [0; LANES],
            inside: 0,
        };
        for lane in 0..LANES {
            // A negative coordinate is beyond every side.
            let x = x.0[lane].cast_unsigned();
            let y = y.0[lane].cast_unsigned();
            let slice = slice.0[lane].cast_unsigned();
            let is_inside = (x < width) & (y < height) & (slice < slices);
            // Of lanes outside any number, beyond the end or not.
            let row = (slice as usize).wrapping_mul(height as usize);
            let row = row.wrapping_add(y as usize);
            let texel = row.wrapping_mul(width as usize).wrapping_add(x as usize);
            places.first[lane] = texel.wrapping_mul(count);
            places.inside |= u16::from(is_inside) << lane;
        }
        places
    }

    #[inline(always)]
    fn store(&self, texture: &StorageTexture, mask: u16, words: &[Packet<u32>; 4]) {
        let stores = mask & self.inside;
        let count = texture.words_per_texel();
        for lane in 0..LANES {
            if stores >> lane & 1 == 1 {
                for (k, word) in words.iter().enumerate().take(count) {
                    texture.store(self.first[lane] + k, word.0[lane]);
                }
            }
        }
    }

    #[inline(always)]
    fn load(&self, texture: &StorageTexture) -> [Packet<u32>; 4] {
        let count = texture.words_per_texel();
        let mut words = [Packet::default(); 4];
        for (k, word) in words.iter_mut().enumerate().take(count) {
            for lane in 0..LANES {
                word.0[lane] = texture.load(self.first[lane].wrapping_add(k));
            }
        }
        words
    }
}
