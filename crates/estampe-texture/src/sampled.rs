//! A texture with a sampler, as a shader holds it.

use crate::filter::{Level, mix_colors, sample_level, sample_one_inside, sample_two_inside};
use crate::lod::level_of_detail;
use crate::texel::{finish, unpack};
use crate::wrap::{small_int, wrap};
use estampe_simd::LANES;
use estampe_types::shader::Sample2d;
use estampe_types::{
    AddressMode, FilterMode, Int, Real, SamplerDescriptor, Texture, TextureFormat, Vec2, Vec4,
};
use std::sync::Arc;

/// A texture and how it is sampled. Cheap to clone: the texels are shared.
///
/// Coordinates may be anything; NaN and infinities read some texel of the texture, as
/// `docs/NUMERICS.md` says. Colours are linear, alpha is straight, all in 0..=1.
#[derive(Clone, Debug)]
pub struct Sampled {
    /// The texels.
    pub texture: Arc<Texture>,
    /// How they are sampled.
    pub sampler: SamplerDescriptor,
}

impl Sample2d for Sampled {
    #[inline(always)]
    fn sample<R: Real>(&self, uv: Vec2<R>) -> Vec4<R> {
        Self::sample(self, uv)
    }
}

/// One lane of those that are sampled one by one.
#[derive(Clone, Copy, Default)]
struct Lane {
    uv: [f32; 2],
    lod: f32,
}

/// What a sample reads, once its level of detail is known.
struct Request<R: Real> {
    /// (u, v) in the first tile.
    wrapped: Vec2<R>,
    /// Whether the level of detail is above 0: the minification filter serves.
    is_minified: R::Mask,
    /// The finer level.
    level: R::Int,
    /// The weight of the next coarser level.
    fraction: R,
}

impl Sampled {
    /// A texture with a sampler.
    #[must_use]
    pub fn new(texture: impl Into<Arc<Texture>>, sampler: SamplerDescriptor) -> Self {
        Self {
            texture: texture.into(),
            sampler,
        }
    }

    /// The colour at (u, v), level of detail from the differences of (u, v) within each 2×2 quad. A lone
    /// fragment (`f32`) has none: it reads the finest level.
    #[inline(always)]
    pub fn sample<R: Real>(&self, uv: Vec2<R>) -> Vec4<R> {
        if R::NARROW {
            return self.sample_narrow(uv, None);
        }
        uv.x.outlined(
            #[inline(always)]
            || {
                let dx = Vec2::new(uv.x.ddx_coarse(), uv.y.ddx_coarse());
                let dy = Vec2::new(uv.x.ddy_coarse(), uv.y.ddy_coarse());
                self.sample_at(uv, self.level_of_detail(dx, dy))
            },
        )
    }

    /// The colour at (u, v), level of detail from the given derivatives of (u, v) along x and y.
    #[inline(always)]
    pub fn sample_grad<R: Real>(&self, uv: Vec2<R>, dx: Vec2<R>, dy: Vec2<R>) -> Vec4<R> {
        self.sample_level(uv, self.level_of_detail(dx, dy))
    }

    /// The colour at (u, v) at a level of detail: 0 is the base level, each further one half as large.
    #[inline(always)]
    pub fn sample_level<R: Real>(&self, uv: Vec2<R>, lod: R) -> Vec4<R> {
        if R::NARROW {
            return self.sample_narrow(uv, Some(lod));
        }
        uv.x.outlined(
            #[inline(always)]
            || self.sample_at(uv, lod),
        )
    }

    /// The texel (x, y) of a level, without filtering; what lies outside reads the nearest texel inside.
    #[inline(always)]
    pub fn texel_fetch<R: Real>(&self, x: R::Int, y: R::Int, level: usize) -> Vec4<R> {
        let level = Level::of(&self.texture, level);
        let x = x.max(x.splat(0)).min(x.splat(level.width - 1));
        let y = y.max(y.splat(0)).min(y.splat(level.height - 1));
        let is_srgb = self.texture.format.is_srgb();
        let word = level.index(x, y).gather(&self.texture.texels);
        finish(unpack(word, is_srgb), is_srgb)
    }

    #[inline(always)]
    fn level_of_detail<R: Real>(&self, dx: Vec2<R>, dy: Vec2<R>) -> R {
        let base = Level::of(&self.texture, 0);
        level_of_detail(dx, dy, [base.width as f32, base.height as f32])
    }

    /// [`Self::sample`], or [`Self::sample_level`] where a level of detail is given, lane by lane.
    #[inline(always)]
    fn sample_narrow<R: Real>(&self, uv: Vec2<R>, lod: Option<R>) -> Vec4<R> {
        let mut lanes = [Lane::default(); LANES];
        for (index, lane) in lanes.iter_mut().enumerate().take(R::LANES) {
            lane.uv = [uv.x.lane(index), uv.y.lane(index)];
            lane.lod = lod.map_or(0.0, |lod| lod.lane(index));
        }
        let mut colors = [[0.0; 4]; LANES];
        self.sample_lanes(&lanes[..R::LANES], lod.is_none(), &mut colors);
        let like = uv.x;
        Vec4::new(
            like.with_lanes(|lane| colors[lane][0]),
            like.with_lanes(|lane| colors[lane][1]),
            like.with_lanes(|lane| colors[lane][2]),
            like.with_lanes(|lane| colors[lane][3]),
        )
    }

    /// Samples lanes one after the other; they are whole quads where their levels of detail are to be
    /// found.
    #[inline(never)]
    fn sample_lanes(&self, lanes: &[Lane], is_implicit: bool, colors: &mut [[f32; 4]]) {
        let mut lod = 0.0;
        for (index, (lane, color)) in lanes.iter().zip(colors).enumerate() {
            if !is_implicit {
                lod = lane.lod;
            } else if let (0, [a, b, c, ..]) = (index % 4, &lanes[index..]) {
                let [dx, dy] =
                    [b, c].map(|other| Vec2::new(other.uv[0] - a.uv[0], other.uv[1] - a.uv[1]));
                lod = self.level_of_detail(dx, dy);
            }
            let Vec4 { x, y, z, w } = self.sample_at(Vec2::from(lane.uv), lod);
            *color = [x, y, z, w];
        }
    }

    #[inline(always)]
    fn address_modes(&self) -> [AddressMode; 2] {
        [self.sampler.address_mode_u, self.sampler.address_mode_v]
    }

    #[inline(always)]
    fn sample_at<R: Real>(&self, uv: Vec2<R>, lod: R) -> Vec4<R> {
        let sampler = &self.sampler;
        let lod = lod.clamp(sampler.lod_min_clamp, sampler.lod_max_clamp);
        let last = self.texture.levels.len().saturating_sub(1) as f32;
        let within = lod.clamp(0.0, last);
        let (level, fraction) = match sampler.mipmap_filter {
            FilterMode::Nearest => ((within + 0.5).floor(), within.splat(0.0)),
            FilterMode::Linear => (within.floor(), within.fract()),
        };
        let request = Request {
            wrapped: Vec2::new(
                wrap(uv.x, sampler.address_mode_u),
                wrap(uv.y, sampler.address_mode_v),
            ),
            is_minified: lod.gt(lod.splat(0.0)),
            level: small_int(level),
            fraction,
        };
        if let Some(color) = self.sample_inside(&request) {
            return color;
        }
        fraction.outlined(
            #[inline(always)]
            || self.sample_anywhere(&request),
        )
    }

    /// The common case, and the fast one: linear filtering of unorm8, all lanes of one level and none at a
    /// border. `None` where it is another.
    #[inline(always)]
    fn sample_inside<R: Real>(&self, request: &Request<R>) -> Option<Vec4<R>> {
        let linear = [FilterMode::Linear; 2];
        if [self.sampler.mag_filter, self.sampler.min_filter] != linear
            || self.texture.format != TextureFormat::Rgba8Unorm
        {
            return None;
        }
        let level = request.level.lane(0);
        if R::any(!request.level.eq(request.level.splat(level))) {
            return None;
        }
        let Request {
            wrapped, fraction, ..
        } = *request;
        let (level, modes) = (level as usize, self.address_modes());
        let fine = Level::of(&self.texture, level);
        let color = if R::any(fraction.gt(fraction.splat(0.0))) {
            let levels = [fine, Level::of(&self.texture, level + 1)];
            sample_two_inside(&self.texture, levels, wrapped, modes, fraction)?
        } else {
            sample_one_inside(&self.texture, fine, wrapped, modes)?
        };
        Some(finish(color, false))
    }

    /// Any case: samples the whole packet once for every level among its lanes, and picks the lanes
    /// together.
    #[inline(always)]
    fn sample_anywhere<R: Real>(&self, request: &Request<R>) -> Vec4<R> {
        let sampler = &self.sampler;
        // What a lane reads: 2·level + 1, or 0 where it is magnified.
        let level = request.level;
        let minified = (level + level) | level.splat(1);
        let key = R::Int::select(request.is_minified, minified, level.splat(0));
        let fraction = request.fraction;
        let mut color = Vec4::repeat(fraction);
        let mut left = u16::MAX >> (16 - R::LANES);
        while left != 0 {
            let first = key.lane(left.trailing_zeros() as usize);
            let mask = key.eq(key.splat(first));
            let filter = if first == 0 {
                sampler.mag_filter
            } else {
                sampler.min_filter
            };
            // A loop over the two levels, so that their long code exists once.
            let mut of_key = Vec4::repeat(fraction);
            for step in 0..2 {
                let level = Level::of(&self.texture, (first >> 1) as usize + step);
                let modes = self.address_modes();
                let next = sample_level(&self.texture, level, request.wrapped, modes, filter);
                if step == 0 {
                    of_key = next;
                    if sampler.mipmap_filter == FilterMode::Nearest {
                        break;
                    }
                } else {
                    of_key = mix_colors(of_key, next, fraction);
                }
            }
            color = Vec4::select(mask, of_key, color);
            // The first lane left is always in the mask, so this ends.
            left &= !R::mask_bits(mask);
        }
        finish(color, self.texture.format.is_srgb())
    }
}
