//! [`Rgba8Texture`]: the common kind of texture with a sampler, as a shader holds it.

use crate::filter::{Inside, Level, mix_colors, sample_level};
use crate::lod::rho2;
use crate::mixed::Mixed;
use crate::request::Detail;
use crate::texel::{Number, finish, linear_of_any, unpack};
use crate::view::{Answers, by_sixteen, packed};
use crate::wrap::wrap;
use estampe_simd::LANES;
use estampe_types::shader::Sample2d;
use estampe_types::{
    AddressMode, FilterMode, Int, MipLevel, Real, SamplerDescriptor, TexelData, TextureFormat,
    Vec2, Vec4,
};
use std::sync::Arc;

/// The levels of the longest chain, from the maximum of [`Limits`](estampe_types::Limits), 16,384,
/// down to 1, and one more to make a power of two.
const MAX_LEVELS: usize = 16;

/// A 2D texture of four 8-bit channels with a sampler. Cheap to clone: the texels are shared.
///
/// Coordinates may be any number; NaN and infinities read some texel of the texture, as
/// `docs/NUMERICS.md` says. Colours are linear, alpha is straight, all in 0..=1.
#[derive(Clone, Debug)]
pub struct Rgba8Texture {
    pub(crate) texture: Arc<TexelData>,
    pub(crate) sampler: SamplerDescriptor,
    /// The texture's mip levels; entries beyond the last level repeat it.
    pub(crate) levels: Arc<[Level; MAX_LEVELS]>,
    /// The least and greatest level of detail that the sampler and the levels allow.
    pub(crate) lod_range: [f32; 2],
    /// The finer level at both ends of `lod_range`.
    level_range: [i32; 2],
    /// True if the common case is possible: unorm8 or sRGB, linear filters for magnification and
    /// minification.
    is_linear: bool,
    /// True if the computed level of detail is of no effect: sampler and levels allow one alone,
    /// and the filter is the same for magnification and minification.
    ignores_lod: bool,
    /// True if the texture's format is sRGB.
    pub(crate) is_srgb: bool,
    /// True if the levels are laid out as by `create_texture`, so that the size and the number of
    /// levels determine the layout.
    is_regular: bool,
    /// The index of the smallest level.
    last_level: usize,
}

impl Sample2d for Rgba8Texture {
    #[inline(always)]
    fn sample<R: Real>(&self, uv: Vec2<R>) -> Vec4<R> {
        Self::sample(self, uv)
    }
}

impl Rgba8Texture {
    /// Combines a texture with a sampler.
    #[must_use]
    pub fn new(texture: impl Into<Arc<TexelData>>, sampler: SamplerDescriptor) -> Self {
        let texture: Arc<TexelData> = texture.into();
        let last = texture.levels.len().saturating_sub(1).min(MAX_LEVELS - 1);
        let smallest = MipLevel {
            width: 1,
            height: 1,
            offset: 0,
        };
        let levels = std::array::from_fn(|level| {
            Level::new(*texture.levels.get(level.min(last)).unwrap_or(&smallest))
        });
        let lod_range = [f32::NEG_INFINITY, f32::INFINITY].map(|lod| {
            Real::clamp(lod, sampler.lod_min_clamp, sampler.lod_max_clamp).clamp(0.0, last as f32)
        });
        let linear = [FilterMode::Linear; 2];
        let is_linear = [sampler.mag_filter, sampler.min_filter] == linear;
        Self {
            levels: Arc::new(levels),
            lod_range,
            level_range: lod_range.map(|lod| mixture(lod, sampler.mipmap_filter).0.to_int()),
            is_regular: is_regular(&texture.levels),
            last_level: last,
            ignores_lod: lod_range[0].to_bits() == lod_range[1].to_bits()
                && sampler.mag_filter == sampler.min_filter,
            is_srgb: texture.format.is_srgb(),
            is_linear: is_linear && is_rgba8(texture.format),
            texture,
            sampler,
        }
    }

    /// The texture.
    #[must_use]
    pub fn texture(&self) -> &Arc<TexelData> {
        &self.texture
    }

    /// The sampler.
    #[must_use]
    pub fn sampler(&self) -> &SamplerDescriptor {
        &self.sampler
    }

    /// Samples at (u, v), with the level of detail from the differences of (u, v) within each 2×2
    /// quad. A single fragment (`f32`) has no differences: it reads the finest level.
    #[inline(always)]
    pub fn sample<R: Real>(&self, uv: Vec2<R>) -> Vec4<R> {
        uv.x.takes_derivatives();
        self.request(uv, Detail::Quads)
    }

    /// Samples several textures at the same coordinates, such as a surface's colour and its normal
    /// map. The results are those of [`Self::sample`].
    ///
    /// If the textures have the same size, number of levels and sampler state, the level of detail
    /// and the footprint are computed once for all of them.
    #[inline(always)]
    pub fn sample_all<R: Real, const N: usize>(textures: [&Self; N], uv: Vec2<R>) -> [Vec4<R>; N] {
        uv.x.takes_derivatives();
        Self::sample_all_with(textures, uv, Detail::Quads)
    }

    /// The level of detail of derivatives of (u, v) along x and y, reduced to one number for each
    /// lane, so that the sampler gets one packet in place of four.
    #[inline(always)]
    fn detail_of<R: Real>(&self, [dx, dy]: [Vec2<R>; 2]) -> Detail<R> {
        Detail::Rho2(rho2(dx, dy, self.levels[0].size))
    }

    /// Samples several textures at the same coordinates, with the level of detail from the given
    /// derivatives of (u, v) along x and y.
    #[inline(always)]
    pub(crate) fn sample_all_grad<R: Real, const N: usize>(
        textures: [&Self; N],
        uv: Vec2<R>,
        derivatives: [Vec2<R>; 2],
    ) -> [Vec4<R>; N] {
        let size = textures.first().map(|first| first.levels[0].size);
        let is_one_size = textures
            .iter()
            .all(|texture| Some(texture.levels[0].size) == size);
        let detail = match textures.first().filter(|_| is_one_size) {
            Some(first) => first.detail_of(derivatives),
            None => Detail::Gradients(derivatives),
        };
        Self::sample_all_with(textures, uv, detail)
    }

    /// Samples several textures at the same coordinates and levels of detail.
    #[inline(always)]
    fn sample_all_with<R: Real, const N: usize>(
        textures: [&Self; N],
        uv: Vec2<R>,
        detail: Detail<R>,
    ) -> [Vec4<R>; N] {
        let mut first = [Answers::default(); N];
        Self::sample_all_lanes(&textures, (uv, detail), 0, &mut first);
        let mut second = first;
        if R::LANES > LANES {
            Self::sample_all_lanes(&textures, (uv, detail), LANES, &mut second);
        }
        if R::LANES <= 2 * LANES {
            return all_packed(uv.x, [&first, &second, &first, &second]);
        }
        let (mut third, mut fourth) = (first, first);
        Self::sample_all_lanes(&textures, (uv, detail), 2 * LANES, &mut third);
        Self::sample_all_lanes(&textures, (uv, detail), 3 * LANES, &mut fourth);
        all_packed(uv.x, [&first, &second, &third, &fourth])
    }

    /// Samples sixteen lanes at a time through `request.rs`, whose code is not compiled into the
    /// shader.
    #[inline(always)]
    fn request<R: Real>(&self, uv: Vec2<R>, detail: Detail<R>) -> Vec4<R> {
        if R::LANES == 2 * LANES
            && let Some(level) = uv.x.level()
        {
            let [first, second] = &self.sample_two_packets(level, uv, detail);
            return packed(uv.x, [first, second, first, second]);
        }
        by_sixteen(
            uv.x,
            #[inline(always)]
            |first| self.sample_lanes(uv, detail, first),
        )
    }

    /// Samples at (u, v), with the level of detail from the given derivatives of (u, v) along x and
    /// y.
    #[inline(always)]
    pub fn sample_grad<R: Real>(&self, uv: Vec2<R>, dx: Vec2<R>, dy: Vec2<R>) -> Vec4<R> {
        self.request(uv, self.detail_of([dx, dy]))
    }

    /// Samples at (u, v) at a level of detail: 0 is the base level, each further level is half as
    /// large.
    #[inline(always)]
    pub fn sample_level<R: Real>(&self, uv: Vec2<R>, lod: R) -> Vec4<R> {
        self.request(uv, Detail::Level(lod))
    }

    /// The texel (x, y) of a level, without filtering; coordinates outside are clamped to the edge.
    #[inline(always)]
    pub fn texel_fetch<R: Real>(&self, x: R::Int, y: R::Int, level: usize) -> Vec4<R> {
        let level = self.levels[level.min(MAX_LEVELS - 1)];
        let x = x.max(x.splat(0)).min(x.splat(level.width - 1));
        let y = y.max(y.splat(0)).min(y.splat(level.height - 1));
        let is_srgb = self.is_srgb;
        let word = level.index(x, y).gather(&self.texture.texels);
        let linear = if is_srgb {
            Some(linear_of_any(word))
        } else {
            None
        };
        finish(unpack(word, linear), is_srgb)
    }

    /// Returns true if samples of both textures have the same footprint, and the common case is
    /// possible for both.
    #[inline(always)]
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        self.is_linear
            && other.is_linear
            && self.is_regular
            && other.is_regular
            && self.levels[0].size == other.levels[0].size
            && self.lod_range == other.lod_range
            && self.last_level == other.last_level
            && self.sampler.mipmap_filter == other.sampler.mipmap_filter
            && self.address_modes() == other.address_modes()
    }

    /// A guess of the finer level of the first lane: λ without the clamps is e/2 and a little more,
    /// where e is the exponent of ρ². The guess is known long before λ, so addresses need not wait
    /// for λ.
    #[inline(always)]
    pub(crate) fn guess_of_level<R: Real>(&self, rho2: R) -> i32 {
        let exponent = (rho2.to_bits().lane(0) >> 23) - 127;
        let twice = match self.sampler.mipmap_filter {
            FilterMode::Nearest => exponent + 1,
            FilterMode::Linear => exponent,
        };
        let [first, last] = self.level_range;
        Ord::min(Ord::max(twice >> 1, first), last)
    }

    /// The level of detail and the finer level, if the coordinates do not change them.
    #[inline(always)]
    pub(crate) fn fixed_lod(&self) -> Option<(f32, i32)> {
        self.ignores_lod
            .then_some((self.lod_range[0], self.level_range[0]))
    }

    #[inline(always)]
    fn address_modes(&self) -> [AddressMode; 2] {
        [self.sampler.address_mode_u, self.sampler.address_mode_v]
    }

    /// Samples at a level of detail; `guess` is the probable finer level.
    #[inline(always)]
    pub(crate) fn sample_at<R: Number>(&self, uv: Vec2<R>, lod: R, guess: i32) -> Vec4<R> {
        if let Some(inside) = self.inside(uv, lod, guess) {
            return inside.color(&self.texture, self.is_srgb);
        }
        self.sample_outside(uv, lod)
    }

    /// Samples where [`Self::inside`] gives `None`.
    #[inline(always)]
    pub(crate) fn sample_outside<R: Number>(&self, uv: Vec2<R>, lod: R) -> Vec4<R> {
        match self.mixed(uv, lod) {
            Some(mixed) => mixed.color(&self.texture, self.is_srgb),
            None => self.sample_anywhere(uv, lod),
        }
    }

    /// (u, v) wrapped into the first tile.
    #[inline(always)]
    fn wrapped<R: Real>(&self, uv: Vec2<R>) -> Vec2<R> {
        let [mode_u, mode_v] = self.address_modes();
        // One branch for the most common modes.
        if [mode_u, mode_v] == [AddressMode::Repeat; 2] {
            let mode = AddressMode::Repeat;
            return Vec2::new(wrap(uv.x, mode), wrap(uv.y, mode));
        }
        Vec2::new(wrap(uv.x, mode_u), wrap(uv.y, mode_v))
    }

    /// The footprint in the common case, which is also the fast one: linear filtering, all lanes in
    /// the same mip level or between the same two, no texel across a border. `None` in other cases.
    #[inline(always)]
    pub(crate) fn inside<R: Number>(&self, uv: Vec2<R>, lod: R, guess: i32) -> Option<Inside<R>> {
        if !self.is_linear {
            return None;
        }
        let within = lod.clamp(self.lod_range[0], self.lod_range[1]);
        let (level, fraction) = mixture(within, self.sampler.mipmap_filter);
        if R::any(!level.eq(level.splat(guess as f32))) {
            return None;
        }
        let at = guess.cast_unsigned() as usize;
        let levels = [
            self.levels[at % MAX_LEVELS],
            self.levels[(at + 1) % MAX_LEVELS],
        ];
        Inside::new(levels, self.wrapped(uv), self.address_modes(), fraction)
    }

    /// The footprint in the next common case: linear filtering, lanes in one level or in two
    /// neighbouring ones, repeated coordinates. `None` in other cases.
    #[inline(always)]
    pub(crate) fn mixed<R: Number>(&self, uv: Vec2<R>, lod: R) -> Option<Mixed<R>> {
        if R::LANES == 1 || !self.is_linear || self.address_modes() != [AddressMode::Repeat; 2] {
            return None;
        }
        let within = lod.clamp(self.lod_range[0], self.lod_range[1]);
        let (level, fraction) = mixture(within, self.sampler.mipmap_filter);
        let one = level.to_int_within_range().lane(0);
        let is_below = R::any(level.lt(level.splat(one as f32)));
        let first = one - i32::from(is_below);
        let second = level.eq(level.splat((first + 1) as f32));
        if R::any(!(second | level.eq(level.splat(first as f32)))) {
            return None;
        }
        let at = |step: usize| &self.levels[(first.cast_unsigned() as usize + step) % MAX_LEVELS];
        let levels = [at(0), at(1), at(2)];
        Some(Mixed::new(levels, second, self.wrapped(uv), fraction))
    }

    /// Samples in any case: the whole packet once for every level among its lanes, with a selection
    /// of the lanes of each.
    #[inline(always)]
    pub(crate) fn sample_anywhere<R: Number>(&self, uv: Vec2<R>, lod: R) -> Vec4<R> {
        let sampler = &self.sampler;
        let lod = lod.clamp(sampler.lod_min_clamp, sampler.lod_max_clamp);
        let is_minified = lod.gt(lod.splat(0.0));
        let within = lod.clamp(self.lod_range[0], self.lod_range[1]);
        let (level, fraction) = mixture(within, sampler.mipmap_filter);
        let (level, wrapped) = (level.to_int_within_range(), self.wrapped(uv));
        // The key of what a lane reads: 2·level + 1, or 0 where it is magnified.
        let minified = (level + level) | level.splat(1);
        let key = R::Int::select(is_minified, minified, level.splat(0));
        let mut color = Vec4::repeat(fraction);
        let mut left = u64::MAX >> (64 - R::LANES);
        while left != 0 {
            let first = key.lane(left.trailing_zeros() as usize);
            let mask = key.eq(key.splat(first));
            let filter = if first == 0 {
                sampler.mag_filter
            } else {
                sampler.min_filter
            };
            // A loop over the two levels, so that their long code is compiled once.
            let mut of_key = Vec4::repeat(fraction);
            for step in 0..2 {
                let level = self.levels[((first >> 1) as usize + step) % MAX_LEVELS];
                let modes = self.address_modes();
                let next =
                    sample_level(&self.texture, level, wrapped, modes, (filter, self.is_srgb));
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
        finish(color, self.is_srgb)
    }
}

/// [`packed`] of several textures.
#[inline(always)]
fn all_packed<R: Real, const N: usize>(like: R, answers: [&[Answers; N]; 4]) -> [Vec4<R>; N] {
    let mut colors = [Vec4::repeat(like); N];
    let [first, second, third, fourth] = answers;
    for (at, color) in colors.iter_mut().enumerate() {
        *color = packed(like, [&first[at], &second[at], &third[at], &fourth[at]]);
    }
    colors
}

/// Returns true if texels are words of four unorm bytes, with or without sRGB.
pub(crate) fn is_rgba8(format: TextureFormat) -> bool {
    matches!(
        format,
        TextureFormat::Rgba8Unorm | TextureFormat::Rgba8UnormSrgb
    )
}

/// Returns true if each level is half as large as the one before and begins where that one ends.
fn is_regular(levels: &[MipLevel]) -> bool {
    levels
        .first()
        .is_some_and(|first| first.offset == 0 && Level::new(*first).is_exact(first))
        && levels.len() <= MAX_LEVELS
        && levels.windows(2).all(|pair| {
            let half = |side: u32| (side / 2).max(1);
            let end =
                u64::from(pair[0].offset) + u64::from(pair[0].width) * u64::from(pair[0].height);
            [pair[1].width, pair[1].height] == [half(pair[0].width), half(pair[0].height)]
                && u64::from(pair[1].offset) == end
        })
}

/// The finer level and the weight of the next one, from a level of detail within the existing
/// levels.
#[inline(always)]
pub(crate) fn mixture<R: Real>(lod: R, filter: FilterMode) -> (R, R) {
    match filter {
        FilterMode::Nearest => ((lod + 0.5).floor(), lod.splat(0.0)),
        FilterMode::Linear => {
            let level = lod.floor();
            (level, lod - level)
        }
    }
}
