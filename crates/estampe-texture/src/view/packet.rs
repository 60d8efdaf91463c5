//! Filtering sixteen lanes at once.
//!
//! The same as `sample` does lane by lane, for the formats of [`PacketFormat`] in every dimension, with every
//! filter. It is entered with arrays and chooses its instructions itself, so it is compiled once, in this
//! crate, and not into every shader.
//!
//! A lane whose texels are not all within its level, where that needs more than a wrapped index (a border, an offset,
//! a cube's edge), is done again by `sample`: there are few of them.

mod face;
mod footprint;
mod places;

pub(crate) use super::packet_texel::PacketFormat;

use super::SampledView;
use super::coordinates::{Answers, Lanes, LodOfLanes, answer};
use super::packet_texel::{OTHERS, RGBA8, RGBA16F, passes};
use super::plane::Plane;
use estampe_simd::{LANES, Level, SimdBase, dispatch, f32x16};
use estampe_types::state::CompareFunction;
use estampe_types::{FilterMode, Int, Real, ViewDimension};
use places::{Places, Spots};

impl SampledView {
    /// Samples or compares sixteen lanes; `false` where it cannot, and nothing is done.
    #[inline(always)]
    pub(crate) fn sample_packet(
        &self,
        lanes: &Lanes,
        answers: &mut Answers,
        compares: bool,
    ) -> bool {
        let Some(format) = self.packets else {
            return false;
        };
        if lanes.count != LANES {
            return false;
        }
        let compares = compares.then(|| self.sampler.compare.unwrap_or(CompareFunction::Never));
        let packet = Packet {
            of: self,
            format,
            lanes,
            compares,
        };
        // One channel is all that is compared, and that many formats have.
        let again = if compares.is_some() || format.components == 1 {
            packet.enter::<1, OTHERS>(self.level, answers)
        } else {
            match format.kind() {
                RGBA8 => packet.enter::<4, RGBA8>(self.level, answers),
                RGBA16F => packet.enter::<4, RGBA16F>(self.level, answers),
                _ => packet.enter::<4, OTHERS>(self.level, answers),
            }
        };
        let Some(again) = again else {
            return false;
        };
        for lane in 0..LANES {
            if again >> lane & 1 == 1 {
                let channels = if compares.is_some() {
                    self.compare_lane(lanes, lane)
                } else {
                    self.sample_lane(lanes, lane)
                };
                answer(answers, lane, channels);
            }
        }
        true
    }
}

/// A packet and what is asked of it.
struct Packet<'a> {
    of: &'a SampledView,
    format: PacketFormat,
    lanes: &'a Lanes,
    compares: Option<CompareFunction>,
}

impl Packet<'_> {
    /// Samples the packet at a level; gives the lanes that are to be done again. The scalar level has no packets.
    fn enter<const C: usize, const KIND: u8>(
        &self,
        level: Level,
        answers: &mut Answers,
    ) -> Option<u32> {
        dispatch!(@wide level, s => {
            let zero: f32x16<_> = SimdBase::splat(s, 0.0);
            Some(self.sample::<_, C, KIND>(zero, answers))
        }, scalar => None)
    }

    #[inline(always)]
    fn load<R: Real>(like: R, from: &[f32; LANES]) -> R {
        like.with_lanes(
            #[inline(always)]
            |lane| from[lane],
        )
    }

    /// A given derivative.
    #[inline(always)]
    fn gradient<R: Real>(&self, like: R, first: usize) -> [R; 3] {
        [
            Self::load(like, &self.lanes.gradients[first]),
            Self::load(like, &self.lanes.gradients[first + 1]),
            Self::load(like, &self.lanes.gradients[first + 2]),
        ]
    }

    /// Samples the packet; gives the lanes that are to be done again.
    #[inline(always)]
    fn sample<R: Real, const C: usize, const KIND: u8>(
        &self,
        like: R,
        answers: &mut Answers,
    ) -> u32 {
        let sampler = &self.of.sampler;
        let at = [
            Self::load(like, &self.lanes.at[0]),
            Self::load(like, &self.lanes.at[1]),
            Self::load(like, &self.lanes.at[2]),
        ];
        let value = Self::load(like, &self.lanes.value);
        let (lod, bias, probes, step) = match self.lanes.lod {
            LodOfLanes::Level => (value, like, like.splat(1.0), [like; 3]),
            LodOfLanes::Bias => {
                let first = of_quad(at, 0);
                let d = [minus(of_quad(at, 1), first), minus(of_quad(at, 2), first)];
                let (lod, probes, step) = self.footprint(first, d);
                (lod, value, probes, step)
            }
            LodOfLanes::Gradients => {
                let d = [self.gradient(like, 0), self.gradient(like, 3)];
                let (lod, probes, step) = self.footprint(at, d);
                (lod, like, probes, step)
            }
        };
        let lod = lod + (bias + sampler.lod_bias).clamp(-16.0, 15.99);
        // Comparisons make one probe.
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
            let active = R::mask_bits(counts);
            if active == 0 {
                break;
            }
            let mut uvw = at;
            let several = probes.gt(like.splat(1.0));
            if is_anisotropic {
                let t = like.splat(probe) / (probes + 1.0) - 0.5;
                for k in 0..3 {
                    uvw[k] = R::select(several, at[k] + step[k] * t, at[k]);
                }
            }
            let spots = self.spots(uvw);
            let color = self.levels::<R, C, KIND>(&spots, lod, active, &mut again);
            for k in 0..C {
                let added = if probe == 1.0 {
                    color[k]
                } else {
                    sum[k] + color[k]
                };
                sum[k] = R::select(counts, added, sum[k]);
            }
            probe += 1.0;
            if !is_anisotropic {
                break;
            }
        }
        self.finish(sum, probes, answers);
        again
    }

    /// Weighs the probes' sum, brings it to numbers and stores it.
    #[inline(always)]
    fn finish<R: Real, const C: usize>(&self, sum: [R; C], probes: R, answers: &mut Answers) {
        let several = probes.gt(probes.splat(1.0));
        let weight = probes.splat(1.0) / probes;
        let scale = self.of.view.decoder.scale;
        let mut k = 0;
        while k < C {
            let mut color = sum[k];
            if self.compares.is_none() {
                if self.of.sampler.max_anisotropy > 1 {
                    color = R::select(several, color * weight, color);
                }
                color = color * scale[k];
            }
            for (lane, to) in answers[k].iter_mut().enumerate() {
                *to = color.lane(lane);
            }
            k += 1;
        }
        if C == 1 {
            answers[1] = [0.0; LANES];
            answers[2] = [0.0; LANES];
            let alpha = if self.compares.is_some() { 0.0 } else { 1.0 };
            answers[3] = [alpha; LANES];
        }
    }

    /// One level of each lane, or the mixture of two, for the active lanes: once for every level among them.
    #[inline(always)]
    fn levels<R: Real, const C: usize, const KIND: u8>(
        &self,
        spots: &Spots<R>,
        lod: R,
        active: u32,
        again: &mut u32,
    ) -> [R; C] {
        let (sampler, planes) = (&self.of.sampler, &self.of.view.planes);
        let zero = lod.splat(0.0);
        let lod = lod.clamp(sampler.lod_min_clamp, sampler.lod_max_clamp);
        let is_minified = lod.gt(zero);
        let last = planes.len() - 1;
        let within = lod.clamp(0.0, last as f32);
        let (level, fraction) = match sampler.mipmap_filter {
            FilterMode::Nearest => ((within + 0.5).floor(), zero),
            FilterMode::Linear => (within.floor(), within - within.floor()),
        };
        let is_mixed = R::mask_bits(fraction.gt(zero));
        let level = level.to_int_within_range();
        // What a lane reads: 2·level, and 1 more where it is minified.
        let key = (level + level) | R::Int::select(is_minified, level.splat(1), level.splat(0));
        let mut color = [zero; C];
        let mut left = active;
        while left != 0 {
            let first = key.lane(left.trailing_zeros() as usize);
            let mask = key.eq(key.splat(first));
            let lanes = R::mask_bits(mask) & left;
            let filter = if first & 1 == 0 {
                sampler.mag_filter
            } else {
                sampler.min_filter
            };
            let at = (first >> 1).cast_unsigned() as usize;
            let steps = if lanes & is_mixed == 0 { 1 } else { 2 };
            let mut of_key = [zero; C];
            for step in 0..steps {
                let plane = &planes[(at + step).min(last)];
                let mut outside = 0;
                let texels = self.texels::<R, C, KIND>(plane, spots, filter, &mut outside);
                *again |= outside & lanes & if step == 0 { u32::MAX } else { is_mixed };
                for k in 0..C {
                    let mixed = of_key[k] + (texels[k] - of_key[k]) * fraction;
                    of_key[k] = if step == 0 {
                        texels[k]
                    } else {
                        R::select(fraction.gt(zero), mixed, of_key[k])
                    };
                }
            }
            for k in 0..C {
                color[k] = R::select(mask, of_key[k], color[k]);
            }
            left &= !lanes;
        }
        color
    }

    /// One level, nearest or linear; sets the lanes that cannot be done here.
    #[inline(always)]
    fn texels<R: Real, const C: usize, const KIND: u8>(
        &self,
        plane: &Plane,
        spots: &Spots<R>,
        filter: FilterMode,
        outside: &mut u32,
    ) -> [R; C] {
        let like = spots.at[0];
        let view = &self.of.view;
        let axes = match view.dimension {
            ViewDimension::D1 => 1,
            ViewDimension::D3 => 3,
            _ => 2,
        };
        let x = self.places(plane, spots, 0, filter, outside);
        let y = if axes > 1 {
            self.places(plane, spots, 1, filter, outside)
        } else {
            Places::fixed(spots.slice.splat(0), like)
        };
        let z = if axes > 2 {
            self.places(plane, spots, 2, filter, outside)
        } else {
            Places::fixed(spots.slice, like)
        };
        let [width, height, _] = plane.sides.map(|side| spots.slice.splat(side));
        let words = spots.slice.splat(self.format.words);
        let begin = spots.slice.splat(plane.begin_words(self.format.words));
        let is_linear = filter == FilterMode::Linear;
        let count = |axis: usize| if is_linear && axes > axis { 2 } else { 1 };
        let reference = if self.compares.is_some() {
            self.reference(like)
        } else {
            like
        };
        // Loops, so that the long code of a texel exists once.
        let mut images = [[like; C]; 2];
        for (slice, image) in images.iter_mut().enumerate().take(count(2)) {
            let mut rows = [[like; C]; 2];
            for (row, mean) in rows.iter_mut().enumerate().take(count(1)) {
                let begin_row = (z.texels[slice] * height + y.texels[row]) * width;
                let mut pair = [[like; C]; 2];
                for (column, units) in pair.iter_mut().enumerate().take(count(0)) {
                    let index = (begin_row + x.texels[column]) * words + begin;
                    self.missing(units);
                    let texels = &view.texture.texels;
                    self.format.units::<R, C, KIND>(texels, index, units);
                    if let Some(function) = self.compares {
                        units[0] = passes(function, reference, units[0]);
                    }
                }
                *mean = mix(pair, x.fraction, is_linear);
            }
            *image = mix(rows, y.fraction, count(1) == 2);
        }
        mix(images, z.fraction, count(2) == 2)
    }

    /// What channels that the format lacks read as.
    #[inline(always)]
    fn missing<R: Real, const C: usize>(&self, units: &mut [R; C]) {
        let mut k = self.format.components;
        while k < C {
            units[k] = units[k].splat(if k == 3 { 1.0 } else { 0.0 });
            k += 1;
        }
    }

    /// What texels are compared with.
    #[inline(always)]
    fn reference<R: Real>(&self, like: R) -> R {
        let reference = Self::load(like, &self.lanes.reference);
        if self.format.is_fixed_depth() {
            reference.saturate()
        } else {
            reference
        }
    }
}

/// Coordinates of one fragment of each quad.
#[inline(always)]
fn of_quad<R: Real>([x, y, z]: [R; 3], index: u8) -> [R; 3] {
    [x.quad_lane(index), y.quad_lane(index), z.quad_lane(index)]
}

#[inline(always)]
fn minus<R: Real>([a, b, c]: [R; 3], [x, y, z]: [R; 3]) -> [R; 3] {
    [a - x, b - y, c - z]
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
