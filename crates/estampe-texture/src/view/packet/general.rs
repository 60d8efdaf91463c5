//! The general packet code: probes, mip levels and texels of any format with packet code, in every
//! dimension, with every filter and comparison.
//!
//! It samples once for every mip level among the lanes.

use super::footprint::Footprints;
use super::places::{Places, Spots};
use super::{Packet, only_red};
use crate::view::coordinates::{Answers, load, packet};
use crate::view::packet_texel::{RGBA16F, passes};
use crate::view::plane::Plane;
use estampe_simd::{Bytes, Lanes as SimdLanes, SimdBase, f32x16, i32x16, u32x16};
use estampe_types::{FilterMode, Int, Real, ViewDimension};

/// A mip level, and how lanes read it.
struct OfLevel<'a> {
    plane: &'a Plane,
    filter: FilterMode,
    /// The lanes that read this level.
    lanes: u32,
}

impl Packet<'_> {
    /// Samples the packet; returns the lanes that the scalar code must sample again.
    #[inline(always)]
    pub(super) fn sample<S: SimdLanes, const C: usize, const KIND: u8>(
        &self,
        s: S,
        answers: &mut Answers,
    ) -> u32 {
        let like: f32x16<S> = SimdBase::splat(s, 0.0);
        let sampler = &self.of.sampler;
        let at = self.coordinates(like);
        if self.is_simple
            && self.of.ignores_lod
            && self.inside_levels::<S, C, KIND>(s, &self.spots(at), (0, None), answers)
        {
            return 0;
        }
        let Footprints { lod, probes, step } = self.footprints(at);
        if self.is_simple
            && !self.of.ignores_lod
            && self.inside::<S, C, KIND>(s, &self.spots(at), lod, answers)
        {
            return 0;
        }
        // Comparisons use one probe.
        let is_anisotropic = sampler.max_anisotropy > 1 && self.compares.is_none();
        let probes = if is_anisotropic {
            probes
        } else {
            like.splat(1.0)
        };
        let mut again = 0;
        let mut sum = [like; C];
        let mut probe = 1.0;
        loop {
            let counts = probes.ge(like.splat(probe));
            let active = u32::from(s.bits_of_mask(counts));
            if active == 0 {
                break;
            }
            let mut uvw = at;
            let several = probes.gt(like.splat(1.0));
            if is_anisotropic {
                let t = like.splat(probe) / (probes + 1.0) - 0.5;
                for k in 0..3 {
                    uvw[k] = Real::select(several, at[k] + step[k] * t, at[k]);
                }
            }
            let spots = self.spots(uvw);
            let color = self.levels::<S, C, KIND>(s, &spots, (lod, active), &mut again);
            for k in 0..C {
                let added = if probe == 1.0 {
                    color[k]
                } else {
                    sum[k] + color[k]
                };
                sum[k] = Real::select(counts, added, sum[k]);
            }
            probe += 1.0;
            if !is_anisotropic {
                break;
            }
        }
        self.finish::<_, C, KIND>(sum, probes, answers);
        again
    }

    /// Divides the sum of the probes by their number, scales it from units to numbers and stores
    /// it.
    #[inline(always)]
    pub(super) fn finish<R: Real, const C: usize, const KIND: u8>(
        &self,
        sum: [R; C],
        probes: R,
        answers: &mut Answers,
    ) {
        let several = probes.gt(probes.splat(1.0));
        let weight = probes.splat(1.0) / probes;
        let scale = self.of.view.codec.scale();
        let mut k = 0;
        while k < C {
            let mut color = sum[k];
            if self.compares.is_none() {
                if self.of.sampler.max_anisotropy > 1 {
                    color = R::select(several, color * weight, color);
                }
                // The units of half floats are the numbers themselves.
                if KIND != RGBA16F {
                    color *= scale[k];
                }
            }
            answers[k] = packet(color, 0);
            k += 1;
        }
        if C == 1 && self.compares.is_none() {
            only_red(answers);
        }
    }

    /// Samples one mip level of each active lane, or mixes two: once for every level among the
    /// lanes.
    #[inline(always)]
    fn levels<S: SimdLanes, const C: usize, const KIND: u8>(
        &self,
        s: S,
        spots: &Spots<f32x16<S>>,
        (lod, active): (f32x16<S>, u32),
        again: &mut u32,
    ) -> [f32x16<S>; C] {
        let (sampler, planes) = (&self.of.sampler, &self.of.view.planes);
        let zero: f32x16<S> = SimdBase::splat(s, 0.0);
        let lod = Real::clamp(lod, sampler.lod_min_clamp, sampler.lod_max_clamp);
        let is_minified = lod.gt(zero);
        let last = planes.len() - 1;
        let (level, fraction) = self.mixture(s, lod);
        let is_mixed = u32::from(s.bits_of_mask(fraction.gt(zero)));
        let level = level.to_int_within_range();
        // The key of what a lane reads: 2·level, and 1 more where it is minified.
        let one = Int::splat(level, 1);
        let key = (level + level) | Int::select(is_minified, one, Int::splat(level, 0));
        let mut color = [zero; C];
        let mut left = active;
        while left != 0 {
            let first = Int::lane(key, left.trailing_zeros() as usize);
            let mask = key.eq(Int::splat(key, first));
            let lanes = u32::from(s.bits_of_mask(mask)) & left;
            let filter = if first & 1 == 0 {
                sampler.mag_filter
            } else {
                sampler.min_filter
            };
            let at = (first >> 1).cast_unsigned() as usize;
            let steps = if lanes & is_mixed == 0 { 1 } else { 2 };
            let mut of_key = [zero; C];
            for step in 0..steps {
                let level = OfLevel {
                    plane: &planes[(at + step).min(last)],
                    filter,
                    lanes: lanes & if step == 0 { u32::MAX } else { is_mixed },
                };
                let texels = self.texels::<S, C, KIND>(s, &level, spots, again);
                for k in 0..C {
                    let mixed = of_key[k] + (texels[k] - of_key[k]) * fraction;
                    of_key[k] = if step == 0 {
                        texels[k]
                    } else {
                        Real::select(fraction.gt(zero), mixed, of_key[k])
                    };
                }
            }
            for k in 0..C {
                color[k] = Real::select(mask, of_key[k], color[k]);
            }
            left &= !lanes;
        }
        color
    }

    /// Samples one mip level, nearest or linear; adds the lanes that need the scalar code to
    /// `again`.
    #[inline(always)]
    fn texels<S: SimdLanes, const C: usize, const KIND: u8>(
        &self,
        s: S,
        level: &OfLevel<'_>,
        spots: &Spots<f32x16<S>>,
        again: &mut u32,
    ) -> [f32x16<S>; C] {
        let like = spots.at[0];
        let axes = match self.of.view.dimension {
            ViewDimension::D1 => 1,
            ViewDimension::D3 => 3,
            _ => 2,
        };
        let OfLevel { plane, filter, .. } = *level;
        let mut outside = 0;
        let x = self.places(plane, spots, 0, filter, &mut outside);
        let y = if axes > 1 {
            self.places(plane, spots, 1, filter, &mut outside)
        } else {
            Places::fixed(Int::splat(spots.slice, 0), like)
        };
        let z = if axes > 2 {
            self.places(plane, spots, 2, filter, &mut outside)
        } else {
            Places::fixed(spots.slice, like)
        };
        // No bit is lost: the lanes of a packet are sixteen.
        *again |= u32::try_from(outside & u64::from(level.lanes)).unwrap_or(u32::MAX);
        let is_linear = filter == FilterMode::Linear;
        let count = |axis: usize| if is_linear && axes > axis { 2 } else { 1 };
        let counts = [count(0), count(1)];
        let is_square = counts == [2, 2] && {
            let one = Int::splat(x.texels[0], 1);
            let next = (x.texels[0] + one).eq(x.texels[1]) & (y.texels[0] + one).eq(y.texels[1]);
            !u32::from(s.bits_of_mask(next)) & level.lanes == 0
        };
        let [width, height, _] = plane.sides;
        let (width, height) = (
            Int::splat(spots.slice, width),
            Int::splat(spots.slice, height),
        );
        let reference = if self.compares.is_some() {
            self.reference(like)
        } else {
            like
        };
        // Loops, so that the long code of a texel is compiled once.
        let mut images = [[like; C]; 2];
        for (slice, image) in images.iter_mut().enumerate().take(count(2)) {
            let first = z.texels[slice] * height;
            let rows = [(first + y.texels[0]) * width, (first + y.texels[1]) * width];
            let image_places = [
                rows[0] + x.texels[0],
                rows[0] + x.texels[1],
                rows[1] + x.texels[0],
                rows[1] + x.texels[1],
            ];
            let words = self.words(s, plane, image_places, is_square, counts);
            let mut four = [[like; C]; 4];
            for (corner, units) in four.iter_mut().enumerate() {
                if corner % 2 < counts[0] && corner / 2 < counts[1] {
                    self.format.units::<S, C, KIND>(s, &words[corner], units);
                    self.missing(units);
                    if let Some(function) = self.compares {
                        units[0] = passes(function, reference, units[0]);
                    }
                }
            }
            let [a, b, c, d] = four;
            let rows = [
                mix([a, b], x.fraction, is_linear),
                mix([c, d], x.fraction, is_linear),
            ];
            *image = mix(rows, y.fraction, counts[1] == 2);
        }
        mix(images, z.fraction, count(2) == 2)
    }

    /// Loads the words of up to four texels of a level: left and right of the upper row, then of
    /// the lower.
    ///
    /// If the texels are neighbours in memory, their words are loaded as squares, which takes half
    /// as long as a gather of each.
    #[inline(always)]
    pub(super) fn words<S: SimdLanes>(
        &self,
        s: S,
        plane: &Plane,
        places: [i32x16<S>; 4],
        is_square: bool,
        [columns, rows]: [usize; 2],
    ) -> [[u32x16<S>; 4]; 4] {
        let texels = &self.of.view.texture.texels[..];
        let size = self.format.words;
        let begin = Int::splat(places[0], plane.begin_words(size));
        let mut words = [[SimdBase::splat(s, 0); 4]; 4];
        if size == 1 && is_square {
            let width = plane.sides[0].cast_unsigned();
            let square = s.gather_square(texels, (places[0] + begin).bitcast(), width);
            for (words, word) in words.iter_mut().zip(square) {
                words[0] = word;
            }
            return words;
        }
        for corner in 0..4 {
            if corner % 2 >= columns || corner / 2 >= rows {
                continue;
            }
            let index: u32x16<S> = (places[corner] * Int::splat(places[0], size) + begin).bitcast();
            match size {
                1 => words[corner][0] = s.gather(texels, index),
                // Four consecutive words: of one texel, or of two neighbours.
                2 if is_square && corner % 2 == 0 => {
                    let [a, b, c, d] = s.gather_four(texels, index);
                    [words[corner][0], words[corner][1]] = [a, b];
                    [words[corner + 1][0], words[corner + 1][1]] = [c, d];
                }
                2 if is_square => {}
                2 => {
                    let next = index + <u32x16<S> as SimdBase<S>>::splat(s, 1);
                    words[corner][0] = s.gather(texels, index);
                    words[corner][1] = s.gather(texels, next);
                }
                _ => words[corner] = s.gather_four(texels, index),
            }
        }
        words
    }

    /// Sets the channels that the format does not store: colours to 0, alpha to 1.
    #[inline(always)]
    pub(super) fn missing<R: Real, const C: usize>(&self, units: &mut [R; C]) {
        for (k, unit) in units.iter_mut().enumerate() {
            if k >= self.format.components {
                *unit = unit.splat(if k == 3 { 1.0 } else { 0.0 });
            }
        }
    }

    /// The reference of comparisons; for fixed-point depths it is clamped to 0..=1.
    #[inline(always)]
    pub(super) fn reference<R: Real>(&self, like: R) -> R {
        let reference = load(like, self.lanes.reference, 0);
        if self.format.is_fixed_depth() {
            reference.saturate()
        } else {
            reference
        }
    }
}

/// `a + (b − a)·t` of each channel, or a alone.
#[inline(always)]
fn mix<R: Real, const C: usize>([a, b]: [[R; C]; 2], t: R, is_linear: bool) -> [R; C] {
    if !is_linear {
        return a;
    }
    let mut mixed = a;
    for k in 0..C {
        mixed[k] = a[k] + (b[k] - a[k]) * t;
    }
    mixed
}
