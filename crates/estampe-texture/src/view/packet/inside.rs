//! The common case of a packet: linear filtering, all lanes in the same mip level or between the
//! same two, all texels inside.
//!
//! This file has the squares of such a packet, and samples formats that `bytes.rs` does not serve.
//! The code then needs no distinction of borders, faces or levels per lane, and the texels of a
//! lane are neighbours in memory. The arithmetic is that of the other cases, in the same order, so
//! the bits are the same.

use super::Packet;
use super::places::Spots;
use crate::texel::Corners;
use crate::view::coordinates::{Answers, packet};
use crate::view::packet_texel::RGBA16F;
use crate::view::plane::Plane;
use crate::wrap::{Place, place};
use estampe_simd::{Bytes, Lanes as SimdLanes, SimdBase, f32x16, i32x16, u32x16};
use estampe_types::{FilterMode, Int, Real, ViewDimension};

/// The footprint of each lane in a level: the first of its 2×2 texels and the position between
/// their centres.
pub(super) struct Square<'a, R: Real> {
    pub(super) plane: &'a Plane,
    pub(super) x: Place<R>,
    pub(super) y: Place<R>,
}

impl Packet<'_> {
    /// Samples a packet of the common case; `false` for other packets.
    #[inline(always)]
    pub(super) fn inside<S: SimdLanes, const C: usize, const KIND: u8>(
        &self,
        s: S,
        spots: &Spots<f32x16<S>>,
        lod: f32x16<S>,
        answers: &mut Answers,
    ) -> bool {
        let (level, fraction) = self.mixture(s, lod);
        let zero: f32x16<S> = SimdBase::splat(s, 0.0);
        let first = Int::lane(level.to_int_within_range(), 0);
        if f32x16::any(!level.eq(zero.splat(first as f32))) {
            return false;
        }
        let at = first.cast_unsigned() as usize;
        let is_mixed = f32x16::any(fraction.gt(zero));
        self.inside_levels::<S, C, KIND>(s, spots, (at, is_mixed.then_some(fraction)), answers)
    }

    /// Samples a packet in one level, or between it and the next one, if all texels are inside;
    /// `false` for other packets.
    #[inline(always)]
    pub(super) fn inside_levels<S: SimdLanes, const C: usize, const KIND: u8>(
        &self,
        s: S,
        spots: &Spots<f32x16<S>>,
        (at, fraction): (usize, Option<f32x16<S>>),
        answers: &mut Answers,
    ) -> bool {
        if KIND == RGBA16F
            && let Some([r, g, b, a]) = self.block(s, (at, fraction))
        {
            // The units of half floats are the numbers themselves.
            *answers = [packet(r, 0), packet(g, 0), packet(b, 0), packet(a, 0)];
            return true;
        }
        let planes = &self.of.view.planes;
        let last = planes.len() - 1;
        let zero: f32x16<S> = SimdBase::splat(s, 0.0);
        let Some(fine) = self.square(spots, &planes[at.min(last)]) else {
            return false;
        };
        let coarse = if fraction.is_some() {
            let coarse = self.square(spots, &planes[(at + 1).min(last)]);
            if coarse.is_none() {
                return false;
            }
            coarse
        } else {
            None
        };
        let fraction = match fraction {
            Some(fraction) => fraction,
            None => zero,
        };
        let mut color = [zero; C];
        // A loop, so that the long code of texels is compiled once.
        for step in 0..2 {
            let square = match (step, &coarse) {
                (0, _) => &fine,
                (_, Some(coarse)) => coarse,
                (_, None) => break,
            };
            let next = self.mean::<S, C, KIND>(s, spots, square);
            for k in 0..C {
                color[k] = if step == 0 {
                    next[k]
                } else {
                    let mixed = color[k] + (next[k] - color[k]) * fraction;
                    Real::select(fraction.gt(zero), mixed, color[k])
                };
            }
        }
        self.finish::<_, C, KIND>(color, zero.splat(1.0), answers);
        true
    }

    /// The footprint in a level, if all texels are inside.
    #[inline(always)]
    pub(super) fn square<'a, R: Real>(
        &self,
        spots: &Spots<R>,
        plane: &'a Plane,
    ) -> Option<Square<'a, R>> {
        let x = self.place_inside(spots, plane, 0);
        let y = self.place_inside(spots, plane, 1);
        let outside =
            x.texel.is_outside(plane.sides[0] - 1) | y.texel.is_outside(plane.sides[1] - 1);
        if R::any(outside) {
            return None;
        }
        Some(Square { plane, x, y })
    }

    /// The texel along one axis, valid where no texel is outside; elsewhere this texel is outside,
    /// too.
    #[inline(always)]
    fn place_inside<R: Real>(&self, spots: &Spots<R>, plane: &Plane, axis: usize) -> Place<R> {
        let (at, length) = (spots.at[axis], plane.size[axis]);
        if !self.of.view.is_cube() {
            return place(at, length, self.mode(axis), FilterMode::Linear);
        }
        let at = (at * length - 0.5).clamp(-0.5, length - 0.5);
        let whole = at.floor();
        Place {
            texel: whole.to_int_within_range(),
            fraction: at - whole,
        }
    }

    /// The index of the first word of each lane's first texel.
    #[inline(always)]
    fn first_words<R: Real>(&self, spots: &Spots<R>, square: &Square<'_, R>) -> R::Int {
        let [width, height, _] = square.plane.sides;
        let words = self.format.words;
        let x = square.x.texel;
        let row = square.y.texel * x.splat(width) + x;
        let begin = x.splat(square.plane.begin_words(words));
        let image = width.wrapping_mul(height);
        let texel = if self.of.view.dimension == ViewDimension::D2 {
            let base = self.of.view.base_layer.cast_signed();
            row + x.splat(base.wrapping_mul(image))
        } else {
            row + spots.slice * x.splat(image)
        };
        texel * x.splat(words) + begin
    }

    /// Loads the four texels of a format of one word.
    #[inline(always)]
    pub(super) fn corners<S: SimdLanes>(
        &self,
        s: S,
        spots: &Spots<f32x16<S>>,
        square: &Square<'_, f32x16<S>>,
    ) -> Corners<i32x16<S>> {
        let index: u32x16<S> = self.first_words(spots, square).bitcast();
        let texels = &self.of.view.texture.texels[..];
        let width = square.plane.sides[0].cast_unsigned();
        let [a, b, c, d] = s.gather_square(texels, index, width);
        Corners {
            upper: [a.bitcast(), b.bitcast()],
            lower: [c.bitcast(), d.bitcast()],
        }
    }

    /// The weighted mean of four texels of any format, in units.
    #[inline(always)]
    fn mean<S: SimdLanes, const C: usize, const KIND: u8>(
        &self,
        s: S,
        spots: &Spots<f32x16<S>>,
        square: &Square<'_, f32x16<S>>,
    ) -> [f32x16<S>; C] {
        let texels = &self.of.view.texture.texels[..];
        let width = square.plane.sides[0].cast_unsigned();
        let index: u32x16<S> = self.first_words(spots, square).bitcast();
        let mut words = [[<u32x16<S> as SimdBase<S>>::splat(s, 0); 4]; 4];
        let size = match KIND {
            RGBA16F => 2,
            _ => self.format.words,
        };
        match size {
            1 => {
                let square = s.gather_square(texels, index, width);
                for k in 0..4 {
                    words[k][0] = square[k];
                }
            }
            2 => {
                let [a, b, c, d] = s.gather_four(texels, index);
                let [e, f, g, h] = s.gather_four(texels, after(s, index, 2 * width));
                for (texel, two) in words.iter_mut().zip([[a, b], [c, d], [e, f], [g, h]]) {
                    [texel[0], texel[1]] = two;
                }
            }
            _ => {
                words[0] = s.gather_four(texels, index);
                words[1] = s.gather_four(texels, after(s, index, 4));
                words[2] = s.gather_four(texels, after(s, index, 4 * width));
                words[3] = s.gather_four(texels, after(s, index, 4 * width + 4));
            }
        }
        let mut four = [[spots.at[0]; C]; 4];
        for corner in 0..4 {
            if size == 4 {
                // A texel of four words is four 32-bit floats.
                for k in 0..C {
                    four[corner][k] = words[corner][k].bitcast();
                }
                continue;
            }
            self.format
                .units::<S, C, KIND>(s, &words[corner], &mut four[corner]);
            self.missing(&mut four[corner]);
        }
        let (fx, fy) = (square.x.fraction, square.y.fraction);
        let mut mean = four[0];
        for k in 0..C {
            let upper = four[0][k] + (four[1][k] - four[0][k]) * fx;
            let lower = four[2][k] + (four[3][k] - four[2][k]) * fx;
            mean[k] = upper + (lower - upper) * fy;
        }
        mean
    }
}

/// Indices moved on by a number of words.
#[inline(always)]
fn after<S: SimdLanes>(s: S, index: u32x16<S>, words: u32) -> u32x16<S> {
    index + <u32x16<S> as SimdBase<S>>::splat(s, words)
}
