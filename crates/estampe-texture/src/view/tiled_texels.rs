//! [`TiledTexels`]: an attachment's texels in storage order, for loads at the pixel itself.
//!
//! In storage order the sixteen texels of a packet's block are whole cache lines, word by word and
//! lane by lane: to load them takes no rows in memory, and no permutation. A pass that reads
//! another one's pixels so, as deferred lighting and tone mapping do, needs no rows of them at all.

use super::coordinates::{Answers, packet};
use super::packet_fetch::{times, zero_where};
use super::packet_texel::{FLOAT, PacketFormat, RGBA8, RGBA8_SRGB, RGBA16F};
use estampe_format::{TexelCodec, half};
use estampe_simd::{
    Bytes, LANE_X, LANE_Y, LANES, Lanes, Level, Packet, SimdBase, bits_of, dispatch, f32x16,
    i32x16, mask32x16, outline, u32x16,
};
use estampe_types::morton::{spread, spread_lanes};
use estampe_types::{Int, Lines, Real, TextureAspect, TextureFormat};
use std::sync::Arc;

/// The side of a storage block in texels, and of a packet's block.
const BLOCK: u32 = 64;
const SIDE: u32 = 4;
/// Packets of a storage block.
const BLOCK_PACKETS: u32 = (BLOCK / SIDE) * (BLOCK / SIDE);

const _: () = assert!((SIDE * SIDE) as usize == LANES);

/// The words of an attachment of one sample in storage order: 64×64 blocks in row order, in a block
/// packets in Morton order, in a packet the words of its texels one after the other, of each the
/// sixteen lanes.
#[derive(Debug, Clone)]
pub enum TiledWords {
    /// Of a colour format.
    Colors(Arc<Lines<u32>>),
    /// Depths in 0..=1.
    Depths(Arc<Lines<f32>>),
}

/// An attachment's texels where it stores them.
#[derive(Debug, Clone)]
pub struct TiledTexels {
    words: TiledWords,
    size: [u32; 2],
    format: PacketFormat,
    scale: [f32; 4],
}

impl TiledTexels {
    /// The texels of an attachment of a width and a height. `None` for other formats than four
    /// bytes with R first, four half floats, one float, or a float depth, and where words are
    /// missing.
    #[must_use]
    pub fn new(format: TextureFormat, size: [u32; 2], words: TiledWords) -> Option<Self> {
        let codec = TexelCodec::of_aspect(format, TextureAspect::All);
        let packets = PacketFormat::new(format, &codec)?;
        let is_depth = matches!(words, TiledWords::Depths(_));
        let has_b_first = format.with_srgb(false) == TextureFormat::Bgra8Unorm;
        let is_known = !has_b_first
            && (packets.is_one_float() || matches!(packets.kind(), RGBA8 | RGBA8_SRGB | RGBA16F))
            && is_depth == (format == TextureFormat::Depth32Float);
        let tiled = Self {
            words,
            size,
            format: packets,
            scale: codec.scale(),
        };
        let block = (BLOCK * BLOCK * tiled.format.words.cast_unsigned()) as usize;
        let blocks = size.map(|side| side.div_ceil(BLOCK) as usize);
        let needed = blocks[0].saturating_mul(blocks[1]).saturating_mul(block);
        (is_known && needed > 0 && tiled.words().len() >= needed).then_some(tiled)
    }

    fn words(&self) -> &[u32] {
        match &self.words {
            TiledWords::Colors(words) => words,
            TiledWords::Depths(depths) => bits_of(depths),
        }
    }

    /// Loads the texels of several attachments at the pixels of packets of fragments: x, y, z and
    /// 1/w of each packet are its position in the window, and of each there are as many texels as
    /// textures, of which those without an attachment are left as they are. Texels outside an
    /// attachment are zeros.
    ///
    /// # Panics
    /// At the scalar level.
    pub fn fetch_at_pixels(
        all: &[Option<&Self>],
        level: Level,
        positions: &[[Packet<f32>; 4]],
        texels: &mut [Answers],
    ) {
        dispatch!(@wide_move level, s => {
            let packets = positions.iter().zip(texels.chunks_exact_mut(all.len().max(1)));
            for ([x, y, ..], texels) in packets {
                let at = [
                    f32x16::load_array_ref(s, &x.0).to_int_within_range(),
                    f32x16::load_array_ref(s, &y.0).to_int_within_range(),
                ];
                let block = block_of(s, at);
                for (tiled, texels) in all.iter().zip(texels) {
                    let Some(tiled) = tiled else {
                        continue;
                    };
                    match block.and_then(|block| tiled.packet_at(block)) {
                        Some(packet) => tiled.load_packet(s, packet, texels),
                        None => tiled.load_apart(s, at, texels),
                    }
                }
            }
        }, scalar => unreachable!("rows are loaded from at the scalar level"));
    }

    /// The index of the first word of a packet whose texels begin at a place, if all of them are
    /// inside.
    #[inline(always)]
    fn packet_at(&self, [x, y]: [u32; 2]) -> Option<usize> {
        let [width, height] = self.size;
        if x + SIDE > width || y + SIDE > height {
            return None;
        }
        let block = y / BLOCK * width.div_ceil(BLOCK) + x / BLOCK;
        let in_block = spread(x % BLOCK / SIDE) | spread(y % BLOCK / SIDE) << 1;
        let packet = block * BLOCK_PACKETS + in_block;
        Some(packet as usize * LANES * self.format.words.cast_unsigned() as usize)
    }

    /// Loads the texels of a packet, given by its first word.
    #[inline(always)]
    fn load_packet<S: Lanes>(&self, s: S, packet: usize, texels: &mut Answers) {
        let words = &self.words()[packet..];
        // Passes shade packets in the order of storage, mostly.
        let each = self.format.words.cast_unsigned() as usize * LANES;
        for line in 0..each / LANES {
            if let Some(word) = words.get(AHEAD * each + line * LANES) {
                s.prefetch(word);
            }
        }
        let first = u32x16::from_slice(s, &words[..LANES]);
        let mut second = first;
        if self.format.words > 1 {
            second = u32x16::from_slice(s, &words[LANES..2 * LANES]);
        }
        self.decode(s, [first, second], texels);
    }

    /// Loads texels anywhere.
    #[inline(always)]
    fn load_apart<S: Lanes>(&self, s: S, [x, y]: [i32x16<S>; 2], texels: &mut Answers) {
        outline!(s, {
            let [width, height] = self.size.map(u32::cast_signed);
            let is_outside = x.is_outside(width) | y.is_outside(height);
            let blocks = self.size[0].div_ceil(BLOCK).cast_signed();
            let block = Int::wrapping_mul(y >> 6, Int::splat(x, blocks)) + (x >> 6);
            let texel = spread_lanes(x) | (spread_lanes(y) << 1);
            let packet = (block << 8) | (texel >> 4);
            let line = Int::wrapping_mul(packet, Int::splat(x, self.format.words));
            let lane = texel & Int::splat(x, (SIDE * SIDE - 1).cast_signed());
            let index: u32x16<S> = ((line << 4) | lane).bitcast();
            let words = self.words();
            let first = s.gather(words, index);
            let mut second = first;
            if self.format.words > 1 {
                let next = index + <u32x16<S> as SimdBase<S>>::splat(s, SIDE * SIDE);
                second = s.gather(words, next);
            }
            self.decode(s, [first, second], texels);
            for channel in texels {
                *channel = zero_where(is_outside, f32x16::load_array_ref(s, &channel.0));
            }
        });
    }

    /// Decodes sixteen texels.
    #[inline(always)]
    fn decode<S: Lanes>(&self, s: S, [first, second]: [u32x16<S>; 2], texels: &mut Answers) {
        let zero = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
        let (format, scale) = (self.format, self.scale);
        let words = [first, second, second, second];
        let mut units = [zero; 4];
        match format.kind() {
            RGBA16F => {
                let [[r, g], [b, a]] = [half::decode_pair(s, first), half::decode_pair(s, second)];
                *texels = [packet(r, 0), packet(g, 0), packet(b, 0), packet(a, 0)];
                return;
            }
            RGBA8 => format.units::<S, 4, RGBA8>(s, &words, &mut units),
            RGBA8_SRGB => format.units::<S, 4, RGBA8_SRGB>(s, &words, &mut units),
            _ => {
                let mut alone = [zero; 1];
                format.units::<S, 1, FLOAT>(s, &words, &mut alone);
                let [zeros, ones] = [zero, zero + 1.0];
                let red = alone[0] * scale[0];
                *texels = [
                    packet(red, 0),
                    packet(zeros, 0),
                    packet(zeros, 0),
                    packet(ones, 0),
                ];
                return;
            }
        }
        let [r, g, b, a] = units;
        *texels = [
            packet(r * scale[0], 0),
            packet(g * scale[1], 0),
            packet(b * scale[2], 0),
            packet(a * scale[3], 0),
        ];
    }
}

/// Where the block of a packet's pixels begins, if they are that of a packet in storage.
#[inline(always)]
fn block_of<S: Lanes>(s: S, [x, y]: [i32x16<S>; 2]) -> Option<[u32; 2]> {
    let first = [x[0], y[0]].map(i32::cast_unsigned);
    let columns: i32x16<S> = u32x16::load_array(s, COLUMNS).bitcast();
    let rows: i32x16<S> = u32x16::load_array(s, ROWS).bitcast();
    let is_column = x.simd_eq(columns + <i32x16<S> as SimdBase<S>>::splat(s, x[0]));
    let is_row = y.simd_eq(rows + <i32x16<S> as SimdBase<S>>::splat(s, y[0]));
    let is_block: mask32x16<S> = is_column & is_row;
    let is_aligned = (first[0] | first[1]) % SIDE == 0 && (first[0] | first[1]) <= MOST;
    (is_aligned && s.bits_of_mask(is_block) == u16::MAX).then_some(first)
}

/// How many packets before it is loaded a packet is prefetched: what pass after pass reads is in no
/// cache near the processor, as images are large.
const AHEAD: usize = 16;

/// More than any place in an attachment.
const MOST: u32 = 0xFFFF;

/// The columns of a block's lanes.
const COLUMNS: [u32; LANES] = times(LANE_X, 1);
/// The rows of a block's lanes.
const ROWS: [u32; LANES] = times(LANE_Y, 1);
