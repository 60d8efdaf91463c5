//! Packets of formats of bytes, with linear filtering: four unorm bytes, with sRGB colours or
//! without, and one.
//!
//! If all lanes are in the same mip level or between the same two, and all texels are inside, they
//! are loaded as squares (`inside.rs`); in other packets each lane has its own level and texels
//! (`each_level.rs`). Where the [squares](estampe_types::ByteSquares) of texels of one byte are
//! made, they serve all packets. Colours are in the units of [`texel`](crate::texel) until the end.
//! These are the units of the scalar code, times a power of two, so the bits are the same.

use super::places::Spots;
use super::{LevelTable, Packet, only_red};
use crate::filter::mix_colors;
use crate::texel::{Corners, finish};
use crate::view::coordinates::{Answers, load, packet, packet_of_ints};
use crate::view::packet_texel::{R8, RGBA8_SRGB, red_mean};
use crate::view::{PacketRequest, SampledTexture};
use estampe_simd::{
    LANES, Lanes as SimdLanes, Level, Packet as Values, SimdBase, dispatch, f32x16, i32x16,
};
use estampe_types::{FilterMode, Int, Real, Vec4};

/// Where each lane is in the texture, as packets in memory: what the common case found out before
/// it had to give up.
struct Found {
    at: [Values<f32>; 2],
    slice: Values<i32>,
    level: Values<f32>,
    fraction: Values<f32>,
}

impl Packet<'_> {
    /// Samples a packet with linear filtering and without offsets; returns the lanes that the
    /// scalar code must sample again.
    pub(super) fn enter_bytes<const KIND: u8>(
        &self,
        table: &LevelTable,
        answers: &mut Answers,
    ) -> Option<u32> {
        if self.of.sampler.max_anisotropy > 1 {
            return self.enter_probes::<KIND>(table, answers);
        }
        dispatch!(@specialized_move self.of.level, s => {
            self.sample_bytes::<_, KIND>(s, table, answers)
        }, others => self.enter_any(answers))
    }

    /// The common case. Other packets are behind a second call, so that this one keeps nothing in
    /// memory for them.
    #[inline(always)]
    pub(super) fn sample_bytes<S: SimdLanes, const KIND: u8>(
        &self,
        s: S,
        table: &LevelTable,
        answers: &mut Answers,
    ) -> Option<u32> {
        let zero: f32x16<S> = SimdBase::splat(s, 0.0);
        let at = self.coordinates(zero);
        let (level, fraction) = if self.of.ignores_lod {
            (zero, zero)
        } else {
            self.mixture(s, self.footprints(at).lod)
        };
        let spots = self.spots(at);
        if KIND == R8
            && self.of.reads_squares
            && let Some(squares) = self.of.view.texture.squares.get()
        {
            let mean = self.mean_of_squares(s, (&spots, squares), (table, (level, fraction)));
            store::<_, KIND>(self, Vec4::repeat(mean), answers);
            return Some(0);
        }
        if let Some(color) = self.color_inside::<S, KIND>(s, &spots, level, fraction) {
            store::<_, KIND>(self, color, answers);
            return Some(0);
        }
        let found = Found {
            at: [packet(spots.at[0], 0), packet(spots.at[1], 0)],
            slice: packet_of_ints(spots.slice, 0),
            level: packet(level, 0),
            fraction: packet(fraction, 0),
        };
        self.enter_each_level::<KIND>(s.as_level(), table, &found, answers)
    }

    #[inline(never)]
    fn enter_each_level<const KIND: u8>(
        &self,
        level: Level,
        table: &LevelTable,
        found: &Found,
        answers: &mut Answers,
    ) -> Option<u32> {
        dispatch!(@specialized_move level, s => {
            let zero: f32x16<_> = SimdBase::splat(s, 0.0);
            let spots = Spots {
                at: [load(zero, &found.at[0], 0), load(zero, &found.at[1], 0), zero],
                direction: self.coordinates(zero),
                slice: SimdBase::from_slice(s, &found.slice.0),
            };
            let mixture = (load(zero, &found.level, 0), load(zero, &found.fraction, 0));
            let mut again = 0;
            let color = self.each_level::<_, KIND>(s, &spots, (table, mixture), &mut again);
            store::<_, KIND>(self, color, answers);
            Some(again)
        }, others => self.enter_any(answers))
    }

    #[inline(never)]
    fn enter_probes<const KIND: u8>(
        &self,
        table: &LevelTable,
        answers: &mut Answers,
    ) -> Option<u32> {
        dispatch!(@specialized_move self.of.level, s => {
            let mut again = 0;
            let color = self.mean_of_probes::<_, KIND>(s, table, &mut again);
            store::<_, KIND>(self, color, answers);
            Some(again)
        }, others => self.enter_any(answers))
    }

    /// The mean of the probes along each lane's footprint.
    #[inline(always)]
    fn mean_of_probes<S: SimdLanes, const KIND: u8>(
        &self,
        s: S,
        table: &LevelTable,
        again: &mut u32,
    ) -> Vec4<f32x16<S>> {
        let at = self.coordinates(SimdBase::splat(s, 0.0));
        let footprint = self.footprints(at);
        let probes = footprint.probes;
        let (level, fraction) = self.mixture(s, footprint.lod);
        let several = probes.gt(probes.splat(1.0));
        let mut sum = Vec4::repeat(probes);
        let mut probe = 1.0;
        loop {
            let counts = probes.ge(probes.splat(probe));
            let active = u32::from(s.bits_of_mask(counts));
            if active == 0 {
                break;
            }
            let mut uvw = at;
            let t = probes.splat(probe) / (probes + 1.0) - 0.5;
            for k in 0..3 {
                uvw[k] = Real::select(several, at[k] + footprint.step[k] * t, at[k]);
            }
            let mut left_out = 0;
            let spots = self.spots(uvw);
            let color = match self.color_inside::<S, KIND>(s, &spots, level, fraction) {
                Some(color) => color,
                None => {
                    let of_levels = (table, (level, fraction));
                    self.each_level::<S, KIND>(s, &spots, of_levels, &mut left_out)
                }
            };
            *again |= left_out & active;
            // Every lane has the first probe.
            sum = match probe {
                1.0 => color,
                _ => Vec4::select(counts, sum + color, sum),
            };
            probe += 1.0;
        }
        let weight = probes.splat(1.0) / probes;
        Vec4::select(several, sum * weight, sum)
    }

    /// The colour of each lane, if all are in the same level or between it and the next one, and
    /// all texels are inside.
    #[inline(always)]
    fn color_inside<S: SimdLanes, const KIND: u8>(
        &self,
        s: S,
        spots: &Spots<f32x16<S>>,
        level: f32x16<S>,
        fraction: f32x16<S>,
    ) -> Option<Vec4<f32x16<S>>> {
        let first = Int::lane(level.to_int_within_range(), 0);
        if f32x16::any(!level.eq(level.splat(first as f32))) {
            return None;
        }
        let planes = &self.of.view.planes;
        let at = first.cast_unsigned() as usize;
        let plane = |step: usize| &planes[(at + step).min(planes.len() - 1)];
        let fine = self.square(spots, plane(0))?;
        if !f32x16::any(fraction.gt(fraction.splat(0.0))) {
            let of_fine = self.corners(s, spots, &fine);
            let (x, y) = (fine.x.fraction, fine.y.fraction);
            return Some(mean_of_bytes::<S, KIND>(s, of_fine, x, y));
        }
        let coarse = self.square(spots, plane(1))?;
        // The texels of both levels are loaded before the first is used.
        let of_fine = self.corners(s, spots, &fine);
        let of_coarse = self.corners(s, spots, &coarse);
        let (x, y) = (fine.x.fraction, fine.y.fraction);
        let fine = mean_of_bytes::<S, KIND>(s, of_fine, x, y);
        let (x, y) = (coarse.x.fraction, coarse.y.fraction);
        let coarse = mean_of_bytes::<S, KIND>(s, of_coarse, x, y);
        Some(mix_colors(fine, coarse, fraction))
    }

    /// The finer level of each lane and the weight of the next one.
    #[inline(always)]
    pub(super) fn mixture<S: SimdLanes>(&self, s: S, lod: f32x16<S>) -> (f32x16<S>, f32x16<S>) {
        let (sampler, planes) = (&self.of.sampler, &self.of.view.planes);
        let last = planes.len() - 1;
        let lod = Real::clamp(lod, sampler.lod_min_clamp, sampler.lod_max_clamp);
        let within = Real::clamp(lod, 0.0, last as f32);
        match sampler.mipmap_filter {
            FilterMode::Nearest => (s.floor_f32(within + 0.5), SimdBase::splat(s, 0.0)),
            FilterMode::Linear => (s.floor_f32(within), within - s.floor_f32(within)),
        }
    }
}

/// The weighted mean of four texels. Of one byte, every channel is the mean.
#[inline(always)]
pub(super) fn mean_of_bytes<S: SimdLanes, const KIND: u8>(
    s: S,
    corners: Corners<i32x16<S>>,
    x: f32x16<S>,
    y: f32x16<S>,
) -> Vec4<f32x16<S>> {
    match KIND {
        R8 => Vec4::repeat(red_mean(s, corners, x, y)),
        _ => corners.mean(x, y, KIND == RGBA8_SRGB),
    }
}

/// Stores colours as numbers.
#[inline(always)]
fn store<R: Real, const KIND: u8>(of: &Packet<'_>, color: Vec4<R>, answers: &mut Answers) {
    if KIND == R8 {
        answers[0] = packet(color.x * of.of.view.codec.scale()[0], 0);
        only_red(answers);
        return;
    }
    let Vec4 { x, y, z, w } = finish(color, KIND == RGBA8_SRGB);
    *answers = [packet(x, 0), packet(y, 0), packet(z, 0), packet(w, 0)];
}

impl SampledTexture {
    /// The lanes of a request that are sampled one by one although packet code for bytes samples
    /// the others; `None` if it does not sample the request. Tests see by it which way is taken.
    #[doc(hidden)]
    #[must_use]
    pub fn lanes_beside_bytes(&self, request: &PacketRequest<'_>) -> Option<u32> {
        let format = self.packets.filter(|format| format.is_of_bytes())?;
        self.level_table.as_ref()?;
        let packet = Packet {
            of: self,
            format,
            lanes: request,
            compares: None,
            is_simple: self.is_simple,
        };
        let answers = &mut Answers::default();
        let is_special = self.level.is_specialized();
        let is_bytes = is_special && request.count == LANES && request.offset == [0; 3];
        is_bytes.then(|| packet.enter_kind(answers)).flatten()
    }
}
