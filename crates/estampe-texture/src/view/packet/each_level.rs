//! Packets whose lanes lie in different mip levels or layers, at a clamped edge, or across a cube's
//! edges: linear filtering with a level, a layer and four texels for each lane.
//!
//! Quads of several triangles share packets, so their levels of detail differ, and the general code
//! samples the whole packet once for every level among the lanes. Here each lane looks the size and
//! the place of its own levels up. That serves texels of one word with four unorm bytes or one.
//!
//! # Texels across a cube's edge
//!
//! The texels' centres are put on the surface of the cube from −n to n, as `cube.rs` explains: one
//! texel beyond an edge, a coordinate is ±(n + 1), and the direction to this point meets the
//! neighbour. All numbers are whole and below 2²⁴, so floats hold them exactly. Where three faces
//! meet, the scalar code samples the lane.

use super::Packet;
use super::bytes::mean_of_bytes;
use super::face::Face;
use super::places::Spots;
use crate::filter::mix_colors;
use crate::texel::Corners;
use crate::view::packet_texel::mean_of_square;
use crate::view::plane::Plane;
use crate::wrap::{Place, place_by_lane, tile_lanes};
use estampe_simd::{
    Bytes, Lanes as SimdLanes, Select, SimdBase, f32x16, i32x16, mask32x16, u32x16,
};
use estampe_types::{AddressMode, Int, Real, Vec4};

/// The most mip levels of a table: the longest chain of a texture has 15.
const MOST_LEVELS: usize = 16;

/// The sides of each mip level, and its first word. Entries beyond the last level repeat it.
#[derive(Debug, Clone)]
pub(crate) struct LevelTable {
    width: [u32; MOST_LEVELS],
    height: [u32; MOST_LEVELS],
    begin: [u32; MOST_LEVELS],
}

impl LevelTable {
    /// `None` if there are more levels than a valid texture has.
    pub(crate) fn new(planes: &[Plane]) -> Option<Self> {
        let last = planes.len().checked_sub(1)?;
        if last >= MOST_LEVELS {
            return None;
        }
        let of = |number: fn(&Plane) -> i32| {
            std::array::from_fn(|level| number(&planes[level.min(last)]).cast_unsigned())
        };
        Some(Self {
            width: of(|plane| plane.sides[0]),
            height: of(|plane| plane.sides[1]),
            begin: of(|plane| plane.begin_words(1)),
        })
    }
}

/// One mip level of each lane.
struct OwnLevel<S: SimdLanes> {
    width: i32x16<S>,
    height: i32x16<S>,
    begin: i32x16<S>,
}

/// The index of the square of each lane, and the position between its texels' centres.
struct OfSquare<S: SimdLanes> {
    texel: i32x16<S>,
    x: f32x16<S>,
    y: f32x16<S>,
}

/// The indices of the four texels of each lane, and the position between their centres.
struct Around<S: SimdLanes> {
    texels: Corners<i32x16<S>>,
    x: f32x16<S>,
    y: f32x16<S>,
}

impl Packet<'_> {
    /// Samples a packet of a format of bytes with linear filtering and without offsets, between the
    /// finer level of each lane and the next one. The lanes that the scalar code must sample are
    /// added to `again`.
    #[inline(always)]
    pub(super) fn each_level<S: SimdLanes, const KIND: u8>(
        &self,
        s: S,
        spots: &Spots<f32x16<S>>,
        (table, (level, fraction)): (&LevelTable, (f32x16<S>, f32x16<S>)),
        again: &mut u32,
    ) -> Vec4<f32x16<S>> {
        let level = level.to_int_within_range();
        let is_mixed = f32x16::any(fraction.gt(fraction.splat(0.0)));
        let mut color = Vec4::repeat(fraction);
        // A loop, so that the long code of a level is compiled once.
        for step in 0..2 {
            if step == 1 && !is_mixed {
                break;
            }
            let own = self.own_level(s, table, level + Int::splat(level, step));
            let around = if self.of.view.is_cube() {
                self.around_on_cube(s, spots, &own, again)
            } else {
                self.around(spots, &own)
            };
            let texels = &self.of.view.texture.texels[..];
            let corners = gathered(s, texels, around.texels);
            let next = mean_of_bytes::<S, KIND>(s, corners, around.x, around.y);
            color = match step {
                0 => next,
                _ => mix_colors(color, next, fraction),
            };
        }
        color
    }

    #[inline(always)]
    fn own_level<S: SimdLanes>(&self, s: S, table: &LevelTable, level: i32x16<S>) -> OwnLevel<S> {
        let level: u32x16<S> = level.bitcast();
        let of = |table: &[u32; MOST_LEVELS]| s.lookup_sixteen(table, level).bitcast();
        OwnLevel {
            width: of(&table.width),
            height: of(&table.height),
            begin: of(&table.begin),
        }
    }

    /// The four texels of each lane, with wrapped coordinates.
    #[inline(always)]
    fn around<S: SimdLanes>(&self, spots: &Spots<f32x16<S>>, own: &OwnLevel<S>) -> Around<S> {
        let (columns, x) = pair(spots.at[0], own.width, self.mode(0));
        let (rows, y) = pair(spots.at[1], own.height, self.mode(1));
        let first = spots.slice * own.height;
        let row = |at: usize| (first + rows[at]) * own.width + own.begin;
        let (upper, lower) = (row(0), row(1));
        Around {
            texels: Corners {
                upper: [upper + columns[0], upper + columns[1]],
                lower: [lower + columns[0], lower + columns[1]],
            },
            x,
            y,
        }
    }

    /// Samples a packet of texels of one byte, by their squares, as [`each_level`](Self::each_level)
    /// does.
    #[inline(always)]
    pub(super) fn mean_of_squares<S: SimdLanes>(
        &self,
        s: S,
        (spots, squares): (&Spots<f32x16<S>>, &[u32]),
        (table, (level, fraction)): (&LevelTable, (f32x16<S>, f32x16<S>)),
    ) -> f32x16<S> {
        let level = level.to_int_within_range();
        let mut place = self.place_of_square(spots, &self.own_level(s, table, level));
        let word: u32x16<S> = s.gather(squares, place.texel.bitcast());
        let mut mean = mean_of_square(s, word, place.x, place.y);
        if f32x16::any(fraction.gt(fraction.splat(0.0))) {
            let next = level + Int::splat(level, 1);
            place = self.place_of_square(spots, &self.own_level(s, table, next));
            let word: u32x16<S> = s.gather(squares, place.texel.bitcast());
            let coarse = mean_of_square(s, word, place.x, place.y);
            mean = mix_colors(Vec4::repeat(mean), Vec4::repeat(coarse), fraction).x;
        }
        mean
    }

    /// Where each lane is in its level.
    #[inline(always)]
    fn place_of_square<S: SimdLanes>(
        &self,
        spots: &Spots<f32x16<S>>,
        own: &OwnLevel<S>,
    ) -> OfSquare<S> {
        let (x, y) = (
            place_in(spots.at[0], own.width, self.mode(0)),
            place_in(spots.at[1], own.height, self.mode(1)),
        );
        let mut first = [x.texel, y.texel];
        if self.mode(0) == AddressMode::Repeat {
            first[0] = tile_lanes(first[0], own.width);
        }
        if self.mode(1) == AddressMode::Repeat {
            first[1] = tile_lanes(first[1], own.height);
        }
        let row = spots.slice * own.height + first[1];
        OfSquare {
            texel: row * own.width + own.begin + first[0],
            x: x.fraction,
            y: y.fraction,
        }
    }

    /// The four texels of each lane on a cube.
    #[inline(always)]
    fn around_on_cube<S: SimdLanes>(
        &self,
        s: S,
        spots: &Spots<f32x16<S>>,
        own: &OwnLevel<S>,
        again: &mut u32,
    ) -> Around<S> {
        let side = own.width.to_real();
        let (column, x) = place_on_face(s, spots.at[0], side);
        let (row, y) = place_on_face(s, spots.at[1], side);
        let (columns, rows) = (centers(column, side), centers(row, side));
        let across_x = Real::abs(columns[0]).gt(side) | Real::abs(columns[1]).gt(side);
        let across_y = Real::abs(rows[0]).gt(side) | Real::abs(rows[1]).gt(side);
        *again |= u32::from(s.bits_of_mask(across_x & across_y));
        let face = Face::of(spots.direction);
        // The image of the first face of each lane's cube.
        let cube = spots.slice - face.index;
        let is_across = f32x16::any(across_x | across_y);
        let image = own.width * own.width;
        let most = side - 1.0;
        let mut texels = [own.begin; 4];
        for (corner, texel) in texels.iter_mut().enumerate() {
            let (mut across, mut down) = (columns[corner % 2], rows[corner / 2]);
            let mut slice = spots.slice;
            if is_across {
                let is_beyond = Real::abs(across).gt(side) | Real::abs(down).gt(side);
                // The major coordinate of this face is a coordinate of the neighbour's first row of
                // centres.
                let major = Real::select(is_beyond, most, side);
                let point = face.point([across, down, major]);
                let neighbor = Face::of(point);
                [across, down, _] = neighbor.turned(point);
                slice = cube + neighbor.index;
            }
            let column = ((across + most) * 0.5).to_int_within_range();
            let row = ((down + most) * 0.5).to_int_within_range();
            *texel = slice * image + row * own.width + column + own.begin;
        }
        let [a, b, c, d] = texels;
        Around {
            texels: Corners {
                upper: [a, b],
                lower: [c, d],
            },
            x,
            y,
        }
    }
}

/// Four texels of each lane.
#[inline(always)]
fn gathered<S: SimdLanes>(
    s: S,
    texels: &[u32],
    Corners { upper, lower }: Corners<i32x16<S>>,
) -> Corners<i32x16<S>> {
    // Most right texels follow the left ones in memory; at a clamped border they are the same.
    if const { S::LOADS_PAIRS } {
        let steps: [u32x16<S>; 2] = [
            (upper[1] - upper[0]).bitcast(),
            (lower[1] - lower[0]).bitcast(),
        ];
        let [above, below]: [u32x16<S>; 2] = [upper[0].bitcast(), lower[0].bitcast()];
        let pairs = u32::try_from(texels.len()).unwrap_or(0).saturating_sub(1);
        let [one, pairs]: [u32x16<S>; 2] = [SimdBase::splat(s, 1), SimdBase::splat(s, pairs)];
        let are_pairs: mask32x16<S> =
            (steps[0] | steps[1]).simd_le(one) & above.max(below).simd_lt(pairs);
        if s.bits_of_mask(are_pairs) == u16::MAX {
            let [a, b] = s.gather_pair(texels, above);
            let [c, d] = s.gather_pair(texels, below);
            let follows: [mask32x16<S>; 2] = [steps[0].simd_eq(one), steps[1].simd_eq(one)];
            let (b, d) = (follows[0].select(b, a), follows[1].select(d, c));
            return Corners {
                upper: [a.bitcast(), b.bitcast()],
                lower: [c.bitcast(), d.bitcast()],
            };
        }
    }
    Corners {
        upper: [upper[0].gather(texels), upper[1].gather(texels)],
        lower: [lower[0].gather(texels), lower[1].gather(texels)],
    }
}

/// The texel at or before a place on a face, and the position between its centre and the next.
#[inline(always)]
fn place_on_face<S: SimdLanes>(s: S, at: f32x16<S>, side: f32x16<S>) -> (f32x16<S>, f32x16<S>) {
    let at = Real::clamp(at * side - 0.5, -0.5, side - 0.5);
    let first = s.floor_f32(at);
    (first, at - first)
}

/// The centres of a texel and of the next one on the cube: 2x + 1 − n, where −n and n are the edges
/// of the face.
#[inline(always)]
fn centers<S: SimdLanes>(first: f32x16<S>, side: f32x16<S>) -> [f32x16<S>; 2] {
    let first = first * 2.0 + 1.0 - side;
    [first, first + 2.0]
}

/// The texel at or before a wrapped coordinate, and the position between its centre and the next.
#[inline(always)]
fn place_in<S: SimdLanes>(
    wrapped: f32x16<S>,
    count: i32x16<S>,
    mode: AddressMode,
) -> Place<f32x16<S>> {
    let length = count.to_real();
    place_by_lane(wrapped, length, length - 1.0, mode)
}

/// The two texels between which a wrapped coordinate lies, and the position between their centres.
#[inline(always)]
fn pair<S: SimdLanes>(
    wrapped: f32x16<S>,
    count: i32x16<S>,
    mode: AddressMode,
) -> ([i32x16<S>; 2], f32x16<S>) {
    let Place { texel, fraction } = place_in(wrapped, count, mode);
    let next = texel + Int::splat(texel, 1);
    let texels = if mode == AddressMode::Repeat {
        [tile_lanes(texel, count), tile_lanes(next, count)]
    } else {
        [texel, Int::min(next, count - Int::splat(count, 1))]
    };
    (texels, fraction)
}
