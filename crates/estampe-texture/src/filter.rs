//! Mip levels, sampled: the nearest texel, or the weighted mean of four, of one level or two.

use crate::texel::{Corners, mix, unpack};
use crate::wrap::{Place, place, tile};
use estampe_types::{AddressMode, FilterMode, Int, MipLevel, Real, Texture, Vec2, Vec4};

/// The longest side that lane arithmetic is made for, [`Limits`](estampe_types::Limits)' maximum.
const MAX_SIDE: u32 = 16_384;
/// Beyond this the index of a texel would not fit i32.
const MAX_OFFSET: u32 = 1 << 30;

/// A mip level as lane code needs it. A texture put together by hand may claim anything; confining its
/// numbers here keeps the arithmetic in range, and gathers clamp their indices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Level {
    pub(crate) width: i32,
    pub(crate) height: i32,
    /// Width and height once more.
    pub(crate) size: [f32; 2],
    offset: i32,
}

impl Level {
    pub(crate) fn new(level: MipLevel) -> Self {
        let [width, height] =
            [level.width, level.height].map(|side| side.clamp(1, MAX_SIDE).cast_signed());
        Self {
            width,
            height,
            size: [width as f32, height as f32],
            offset: level.offset.min(MAX_OFFSET).cast_signed(),
        }
    }

    /// Where the texel (x, y) lies in the texture's words.
    #[inline(always)]
    pub(crate) fn index<I: Int>(self, x: I, y: I) -> I {
        y * y.splat(self.width) + x + x.splat(self.offset)
    }
}

/// The place of a sample in one level.
struct Footprint<R: Real> {
    level: Level,
    x: Place<R>,
    y: Place<R>,
}

impl<R: Real> Footprint<R> {
    #[inline(always)]
    fn new(level: Level, wrapped: Vec2<R>, modes: [AddressMode; 2], filter: FilterMode) -> Self {
        Self {
            level,
            x: place(wrapped.x, level.size[0], modes[0], filter),
            y: place(wrapped.y, level.size[1], modes[1], filter),
        }
    }

    /// The lanes whose four texels are not all inside the level.
    #[inline(always)]
    fn outside(&self) -> R::Mask {
        let (x, y) = (self.x.texel, self.y.texel);
        x.is_outside(self.level.width - 1) | y.is_outside(self.level.height - 1)
    }

    /// The four texels where none is outside: left and right are neighbours in memory, and upper and
    /// lower one row apart.
    #[inline(always)]
    fn corners_inside(&self, texels: &[u32]) -> Corners<R::Int> {
        let at = self.level.index(self.x.texel, self.y.texel);
        let [a, b, c, d] = at.gather_square(texels, self.level.width);
        Corners {
            upper: [a, b],
            lower: [c, d],
        }
    }

    /// The four texels, those across a border from the other side.
    #[inline(always)]
    fn corners(&self, texels: &[u32]) -> Corners<R::Int> {
        let Self { level, x, y } = self;
        let (x, y) = (x.texel, y.texel);
        let (left, right) = (tile(x, level.width), tile(x + x.splat(1), level.width));
        let (upper, lower) = (tile(y, level.height), tile(y + y.splat(1), level.height));
        Corners {
            upper: [
                level.index(left, upper).gather(texels),
                level.index(right, upper).gather(texels),
            ],
            lower: [
                level.index(left, lower).gather(texels),
                level.index(right, lower).gather(texels),
            ],
        }
    }

    #[inline(always)]
    fn mean(&self, corners: Corners<R::Int>, is_srgb: bool) -> Vec4<R> {
        corners.mean(self.x.fraction, self.y.fraction, is_srgb)
    }
}

/// The level's colour at a wrapped coordinate, in the units of [`texel`](crate::texel).
#[inline(always)]
pub(crate) fn sample_level<R: Real>(
    texture: &Texture,
    level: Level,
    wrapped: Vec2<R>,
    modes: [AddressMode; 2],
    filter: FilterMode,
) -> Vec4<R> {
    let is_srgb = texture.format.is_srgb();
    let at = Footprint::new(level, wrapped, modes, filter);
    if filter == FilterMode::Linear {
        return at.mean(at.corners(&texture.texels), is_srgb);
    }
    let x = tile(at.x.texel, level.width);
    let y = tile(at.y.texel, level.height);
    unpack(level.index(x, y).gather(&texture.texels), is_srgb)
}

/// The mean of two linearly filtered unorm8 levels, or `None` where a lane's texels lie across a border.
///
/// Both levels' texels are under way before the first is used: a packet's chain of dependent
/// operations is so long that one level after the other took a fifth more time.
#[inline(always)]
pub(crate) fn sample_two_inside<R: Real>(
    texels: &[u32],
    levels: [Level; 2],
    wrapped: Vec2<R>,
    modes: [AddressMode; 2],
    fraction: R,
) -> Option<Vec4<R>> {
    let [fine, coarse] = levels;
    let fine = Footprint::new(fine, wrapped, modes, FilterMode::Linear);
    let coarse = Footprint::new(coarse, wrapped, modes, FilterMode::Linear);
    if R::any(fine.outside() | coarse.outside()) {
        return None;
    }
    let of_fine = fine.corners_inside(texels);
    let of_coarse = coarse.corners_inside(texels);
    Some(mix_colors(
        fine.mean(of_fine, false),
        coarse.mean(of_coarse, false),
        fraction,
    ))
}

/// One linearly filtered unorm8 level, or `None` where a lane's texels lie across a border.
#[inline(always)]
pub(crate) fn sample_one_inside<R: Real>(
    texels: &[u32],
    level: Level,
    wrapped: Vec2<R>,
    modes: [AddressMode; 2],
) -> Option<Vec4<R>> {
    let at = Footprint::new(level, wrapped, modes, FilterMode::Linear);
    if R::any(at.outside()) {
        return None;
    }
    Some(at.mean(at.corners_inside(texels), false))
}

/// `a + (b − a)·t` of each channel.
#[inline(always)]
pub(crate) fn mix_colors<R: Real>(a: Vec4<R>, b: Vec4<R>, t: R) -> Vec4<R> {
    Vec4::new(
        mix(a.x, b.x, t),
        mix(a.y, b.y, t),
        mix(a.z, b.z, t),
        mix(a.w, b.w, t),
    )
}
