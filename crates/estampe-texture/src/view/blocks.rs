//! Fetches of texels that are a block of 4×4, as a pass over a whole picture loads them: rows of
//! neighbours in memory, of one texture or of several at the same place.

use super::coordinates::{Answers, packet};
use super::packet_fetch::times;
use super::packet_texel::{FLOAT, RGBA8, RGBA8_SRGB, RGBA16F};
use super::plane::{Plane, TexelView};
use estampe_simd::{
    Bytes, LANE_X, LANE_Y, LANES, Lanes as SimdLanes, Level, Packet, SimdBase, dispatch, f32x16,
    i32x16, mask32x16, u32x4, u32x16,
};
use estampe_types::morton::{compact, spread};
use estampe_types::{Real, ViewDimension};

impl TexelView {
    /// Fetches the texels of several textures at the same places (x, y) of a level; those without a
    /// view are left as they are. `false` unless all are two-dimensional ones of one size, of half
    /// floats, of four unorm bytes or of one float, and the texels a block inside the level; what
    /// is stored then means nothing.
    pub fn fetch_blocks(
        views: &[Option<&Self>],
        level: Level,
        [x, y, mips]: [&Packet<i32>; 3],
        texels: &mut [Answers],
    ) -> bool {
        let mip = usize::try_from(mips.0[0]).ok();
        let Some((mip, sides)) = mip.and_then(|mip| Some((mip, sides_of(views, mip)?))) else {
            return false;
        };
        if !mips.is_uniform() {
            return false;
        }
        dispatch!(@specialized_move level, s => {
            let first = [x.0[0], y.0[0]];
            let lanes = [i32x16::load_array_ref(s, &x.0), i32x16::load_array_ref(s, &y.0)];
            fetch_block(s, (views, mip, sides), (first, lanes), AHEAD, texels)
        }, others => false)
    }

    /// Fetches the texels of several textures at the pixels of packets of fragments, as
    /// [`fetch_blocks`](Self::fetch_blocks) does in the finest level: x, y, z and 1/w of each
    /// packet are its position in the window, and of each there are as many texels as textures, of
    /// which those without a view are left as they are. Returns the packets that were not fetched,
    /// of which nothing is stored that counts: bit `i` is packet `i`.
    ///
    /// # Panics
    /// If there are more packets than bits.
    pub fn fetch_at_pixels(
        views: &[Option<&Self>],
        level: Level,
        positions: &[[Packet<f32>; 4]],
        texels: &mut [Answers],
    ) -> u32 {
        assert!(
            positions.len() <= u32::BITS as usize,
            "more packets than bits"
        );
        let all = positions.iter().fold(0, |all, _| all << 1 | 1);
        let Some(sides) = sides_of(views, 0) else {
            return all;
        };
        dispatch!(@specialized_move level, s => {
            let mut others = 0;
            let packets = positions.iter().zip(texels.chunks_exact_mut(views.len()));
            for (at, ([x, y, ..], texels)) in packets.enumerate() {
                let first = [whole(x.0[0]), whole(y.0[0])];
                let lanes = [
                    f32x16::load_array_ref(s, &x.0).to_int_within_range(),
                    f32x16::load_array_ref(s, &y.0).to_int_within_range(),
                ];
                let is_fetched =
                    fetch_block(s, (views, 0, sides), (first, lanes), BATCH, texels);
                others |= u32::from(!is_fetched) << at;
            }
            others
        }, others => all)
    }

    /// True if blocks of the view's texels can be fetched.
    #[inline(always)]
    fn has_blocks(&self) -> bool {
        self.dimension == ViewDimension::D2
            && self.texture.shape.samples == 1
            && self.packets.is_some_and(|format| {
                format.is_one_float() || matches!(format.kind(), RGBA8 | RGBA8_SRGB | RGBA16F)
            })
    }

    /// Prefetches a block at a place and the one to the right of it, as far as they are in the
    /// texture.
    #[inline(always)]
    pub(super) fn prefetch_blocks<S: SimdLanes>(&self, s: S, plane: &Plane, [x, y]: [i32; 2]) {
        let words = self.packets.map_or(1, |format| format.words);
        let row = words.wrapping_mul(plane.sides[0]);
        let slice = self.base_layer.cast_signed().wrapping_mul(plane.sides[1]);
        let first = slice.wrapping_add(y).wrapping_mul(row);
        let first = first.wrapping_add(x.wrapping_mul(words) + plane.begin_words(words));
        let texels = &self.texture.texels[..];
        for line in 0..SIDE {
            let begin = first.wrapping_add(line.wrapping_mul(row));
            if let Some(word) = texels.get(begin.cast_unsigned() as usize) {
                s.prefetch(word);
            }
            // Most often both blocks lie in one cache line, as texels begin at one.
            let last = begin.wrapping_add(2 * SIDE * words - 1);
            if last & -LINE != begin & -LINE
                && let Some(word) = texels.get(last.cast_unsigned() as usize)
            {
                s.prefetch(word);
            }
        }
    }

    /// The channels of a block whose first texel has this number in the level's first image of the
    /// view, which [has blocks](Self::has_blocks); `None` if they are not in memory, or if the
    /// level has no instruction for half floats.
    #[inline(always)]
    fn block_at<S: SimdLanes>(&self, s: S, plane: &Plane, texel: i32) -> Option<[f32x16<S>; 4]> {
        let format = self.packets?;
        let [width, height, _] = plane.sides;
        let slice = self.base_layer.cast_signed().wrapping_mul(height);
        let texel = slice.wrapping_mul(width).wrapping_add(texel);
        let first = texel.wrapping_mul(format.words);
        let first = first.wrapping_add(plane.begin_words(format.words));
        let row = (format.words * width).cast_unsigned();
        let place = [first.cast_unsigned(), row];
        let texels = &self.texture.texels[..];
        if format.kind() == RGBA16F {
            return rows_of_halves(s, texels, place);
        }
        let zero = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
        let none = <u32x16<S> as SimdBase<S>>::splat(s, 0);
        let words = [rows_of_words(s, texels, place)?, none, none, none];
        let scale = self.codec.scale();
        if format.is_one_float() {
            let mut units = [zero; 1];
            format.units::<S, 1, FLOAT>(s, &words, &mut units);
            return Some([units[0] * scale[0], zero, zero, zero + 1.0]);
        }
        let mut units = [zero; 4];
        if format.kind() == RGBA8_SRGB {
            format.units::<S, 4, RGBA8_SRGB>(s, &words, &mut units);
        } else {
            format.units::<S, 4, RGBA8>(s, &words, &mut units);
        }
        let [r, g, b, a] = units;
        Some([r * scale[0], g * scale[1], b * scale[2], a * scale[3]])
    }
}

/// The sides of a level of views whose blocks can be fetched together: they are those of all.
#[inline(always)]
fn sides_of(views: &[Option<&TexelView>], mip: usize) -> Option<[i32; 3]> {
    let mut all = views.iter().flatten();
    let of = |view: &TexelView| {
        let plane = view.planes.get(mip)?;
        view.has_blocks().then_some(plane.sides)
    };
    let sides = of(all.next()?)?;
    all.all(|other| of(other) == Some(sides)).then_some(sides)
}

/// Fetches a block of several views, and prefetches that which comes so many blocks later. False if
/// the lanes' places are none, and nothing is stored that counts.
#[inline(always)]
fn fetch_block<S: SimdLanes>(
    s: S,
    (views, mip, sides): (&[Option<&TexelView>], usize, [i32; 3]),
    (first, lanes): ([i32; 2], [i32x16<S>; 2]),
    ahead: u32,
    texels: &mut [Answers],
) -> bool {
    let Some(at) = first_of_block(s, (first, lanes), sides) else {
        return false;
    };
    let ahead = blocks_ahead(first, ahead);
    for (view, texels) in views.iter().zip(texels) {
        let Some(view) = view else {
            continue;
        };
        let plane = &view.planes[mip];
        let Some([r, g, b, a]) = view.block_at(s, plane, at) else {
            return false;
        };
        if let Some(ahead) = ahead {
            view.prefetch_blocks(s, plane, ahead);
        }
        *texels = [packet(r, 0), packet(g, 0), packet(b, 0), packet(a, 0)];
    }
    true
}

/// The whole number towards zero.
#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "positions are in a picture"
)]
fn whole(position: f32) -> i32 {
    position as i32
}

/// The number of the first texel, if the texels at the places of lanes, of which those of the first
/// one are given apart, are a block inside an image.
#[inline(always)]
fn first_of_block<S: SimdLanes>(
    s: S,
    ([left, top], [x, y]): ([i32; 2], [i32x16<S>; 2]),
    [width, height, _]: [i32; 3],
) -> Option<i32> {
    let columns: i32x16<S> = u32x16::load_array(s, COLUMNS).bitcast();
    let rows: i32x16<S> = u32x16::load_array(s, ROWS).bitcast();
    let columns = columns + <i32x16<S> as SimdBase<S>>::splat(s, left);
    let rows = rows + <i32x16<S> as SimdBase<S>>::splat(s, top);
    let (is_column, is_row) = (x.simd_eq(columns), y.simd_eq(rows));
    let is_block: mask32x16<S> = is_column & is_row;
    let is_inside = left >= 0 && top >= 0 && left <= width - SIDE && top <= height - SIDE;
    (is_inside && s.bits_of_mask(is_block) == u16::MAX).then(|| top * width + left)
}

/// For a block in an even column, where the block begins that comes so many later in the order in
/// which passes shade: tiles of 64×64 pixels from left to right, and in a tile Morton order.
///
/// What pass after pass reads is in no cache near the processor, as images are large, and rows of a
/// tile are too short for the processor to foresee.
#[inline(always)]
pub(super) fn blocks_ahead([x, y]: [i32; 2], count: u32) -> Option<[i32; 2]> {
    let [column, row] = [x / SIDE, y / SIDE].map(i32::cast_unsigned);
    if column & 1 != 0 {
        return None;
    }
    let ahead = (spread(column % TILE) | spread(row % TILE) << 1) + count;
    // After a tile's last blocks come the first of the tile to the right.
    let (tile, in_tile) = (column / TILE + ahead / BLOCKS, ahead % BLOCKS);
    let blocks = [
        tile * TILE + compact(in_tile),
        row / TILE * TILE + compact(in_tile >> 1),
    ];
    Some(blocks.map(|block| block.cast_signed() * SIDE))
}

/// The words of a block of texels of one word, from its first word and the words of a row of the
/// image; `None` if they are not in memory.
#[inline(always)]
fn rows_of_words<S: SimdLanes>(s: S, texels: &[u32], [first, row]: [u32; 2]) -> Option<u32x16<S>> {
    let mut rows = [<u32x4<S> as SimdBase<S>>::splat(s, 0); 4];
    let mut texels = texels.get(first as usize..)?;
    for (at, to) in rows.iter_mut().enumerate() {
        if at > 0 {
            texels = texels.get(row as usize..)?;
        }
        *to = u32x4::load_array_ref(s, texels.first_chunk()?);
    }
    let [a, b, c, d] = rows;
    let rows = s.combine_u32x8(s.combine_u32x4(a, b), s.combine_u32x4(c, d));
    Some(s.permute(rows, u32x16::load_array(s, PLACES)))
}

/// The channels of a block of half floats, from its first word and the words of a row of the image;
/// `None` if they are not in memory, or if the level has no instruction for halves.
#[inline(always)]
pub(super) fn rows_of_halves<S: SimdLanes>(
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

/// How many blocks before it is fetched a block is prefetched.
const AHEAD: u32 = 4;
/// The same where the blocks of a batch of packets are fetched one after the other.
const BATCH: u32 = 16;

/// The words of a cache line.
const LINE: i32 = 64 / 4;

/// The blocks of a row of a tile.
const TILE: u32 = 16;
/// The blocks of a tile.
const BLOCKS: u32 = TILE * TILE;

/// The columns of a block's lanes.
const COLUMNS: [u32; LANES] = times(LANE_X, 1);
/// The rows of a block's lanes.
const ROWS: [u32; LANES] = times(LANE_Y, 1);
/// Where a block's lanes are among its rows.
const PLACES: [u32; LANES] = {
    let mut places = times(LANE_Y, 4);
    let mut lane = 0;
    while lane < LANES {
        places[lane] += COLUMNS[lane];
        lane += 1;
    }
    places
};

#[cfg(test)]
mod tests {
    use super::*;

    /// The blocks that come later in Morton order, tile after tile.
    #[test]
    fn the_next_blocks_are_those_that_passes_shade_next() {
        let order: Vec<[i32; 2]> = (0..2)
            .flat_map(|tile| {
                (0..BLOCKS).map(move |at| [tile * TILE + compact(at), compact(at >> 1)])
            })
            .map(|blocks| blocks.map(|block| block.cast_signed() * SIDE))
            .collect();
        for count in [4_u32, 16] {
            let later = order.iter().skip(count as usize);
            for (at, (&[x, y], &later)) in order.iter().zip(later).enumerate() {
                let expected = (at % 2 == 0).then_some(later);
                assert_eq!(blocks_ahead([x, y], count), expected, "{x} {y}");
                let below = expected.map(|[x, y]| [x, y + 64]);
                assert_eq!(blocks_ahead([x, y + 64], count), below, "{x} {y}");
            }
        }
    }
}
