//! Filtering of the common kind of texture: the nearest texel or the weighted mean of four, in one
//! mip level or between two.

use crate::texel::{Corners, Number, OPAQUE, finish, linear, mix, unpack};
use crate::wrap::{Place, place, tile};
use estampe_types::{AddressMode, FilterMode, Int, MipLevel, Real, TexelData, Vec2, Vec3, Vec4};

/// The longest side that lane arithmetic supports: the maximum of
/// [`Limits`](estampe_types::Limits).
const MAX_SIDE: u32 = 16_384;
/// The greatest offset of a level: beyond it, the index of a texel would not fit i32.
const MAX_OFFSET: u32 = 1 << 30;

/// A mip level's numbers as lane code reads them. The fields of a [`TexelData`] are public and may
/// hold any value: clamping them here keeps the arithmetic in range, and gathers clamp their
/// indices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Level {
    pub(crate) width: i32,
    pub(crate) height: i32,
    /// Width and height as floats.
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

    /// The index of the level's first word in the texture.
    #[inline(always)]
    pub(crate) fn offset(&self) -> i32 {
        self.offset
    }

    /// Returns true if [`Level::new`] clamped no number of `level`.
    pub(crate) fn is_exact(self, level: &MipLevel) -> bool {
        [self.width, self.height, self.offset].map(i32::cast_unsigned)
            == [level.width, level.height, level.offset]
    }

    /// The index of texel (x, y) in the texture's words.
    #[inline(always)]
    pub(crate) fn index<I: Int>(self, x: I, y: I) -> I {
        y * y.splat(self.width) + x + x.splat(self.offset)
    }
}

/// The footprint of a sample in one level.
struct Footprint<R: Real> {
    level: Level,
    x: Place<R>,
    y: Place<R>,
}

impl<R: Number> Footprint<R> {
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
    fn outside(&self) -> R::SelectMask {
        let (x, y) = (self.x.texel, self.y.texel);
        x.is_outside(self.level.width - 1) | y.is_outside(self.level.height - 1)
    }

    /// Loads the four texels if all are inside the level: left and right are neighbours in memory,
    /// and upper and lower are one row apart.
    #[inline(always)]
    fn corners_inside(&self, texels: &[u32]) -> Corners<R::Int> {
        let at = self.level.index(self.x.texel, self.y.texel);
        let [a, b, c, d] = at.gather_square(texels, self.level.width);
        Corners {
            upper: [a, b],
            lower: [c, d],
        }
    }

    /// Loads the four texels; texels across a border are taken from the opposite side.
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
    fn mean_of_colors(&self, corners: Corners<R::Int>) -> Vec3<R> {
        corners.mean_of_colors(self.x.fraction, self.y.fraction)
    }

    #[inline(always)]
    fn mean(&self, corners: Corners<R::Int>, is_srgb: bool) -> Vec4<R> {
        corners.mean(self.x.fraction, self.y.fraction, is_srgb)
    }
}

/// Samples a level at a wrapped coordinate; the colour is in the units of [`texel`](crate::texel).
#[inline(always)]
pub(crate) fn sample_level<R: Number>(
    texture: &TexelData,
    level: Level,
    wrapped: Vec2<R>,
    modes: [AddressMode; 2],
    (filter, is_srgb): (FilterMode, bool),
) -> Vec4<R> {
    let at = Footprint::new(level, wrapped, modes, filter);
    if filter == FilterMode::Linear {
        return at.mean(at.corners(&texture.texels), is_srgb);
    }
    let x = tile(at.x.texel, level.width);
    let y = tile(at.y.texel, level.height);
    let word = level.index(x, y).gather(&texture.texels);
    let linear = if is_srgb { Some(linear(word)) } else { None };
    unpack(word, linear)
}

/// The footprint of the common case: linear filtering, all lanes in the same mip level or between
/// the same two, all texels inside.
pub(crate) struct Inside<R: Real> {
    fine: Footprint<R>,
    /// The next coarser level, unless its weight is 0 in every lane.
    coarse: Option<Footprint<R>>,
    fraction: R,
}

impl<R: Number> Inside<R> {
    /// The footprint in one level or, unless the weight of the next one is 0 in every lane, in two.
    /// `None` if a lane's texels lie across a border.
    #[inline(always)]
    pub(crate) fn new(
        [fine, coarse]: [Level; 2],
        wrapped: Vec2<R>,
        modes: [AddressMode; 2],
        fraction: R,
    ) -> Option<Self> {
        let fine = Footprint::new(fine, wrapped, modes, FilterMode::Linear);
        let outside = fine.outside();
        if R::any(fraction.gt(fraction.splat(0.0))) {
            let coarse = Footprint::new(coarse, wrapped, modes, FilterMode::Linear);
            if R::any(outside | coarse.outside()) {
                return None;
            }
            return Some(Self {
                fine,
                coarse: Some(coarse),
                fraction,
            });
        }
        if R::any(outside) {
            return None;
        }
        Some(Self {
            fine,
            coarse: None,
            fraction,
        })
    }

    /// The colour of a texture at this footprint, 0..1. If alpha is 255 everywhere, unorm8 skips a
    /// quarter of its arithmetic.
    ///
    /// The texels of both levels are loaded before the first is used: the chain of dependent
    /// operations of a packet is so long that sampling one level after the other took a fifth more
    /// time.
    #[inline(always)]
    pub(crate) fn color(&self, texture: &TexelData, is_srgb: bool) -> Vec4<R> {
        let texels = &texture.texels[..];
        let of_fine = self.fine.corners_inside(texels);
        let Some(coarse) = &self.coarse else {
            return finish(self.fine.mean(of_fine, is_srgb), is_srgb);
        };
        let of_coarse = coarse.corners_inside(texels);
        let color = if is_srgb {
            let fine = self.fine.mean(of_fine, true);
            mix_colors(fine, coarse.mean(of_coarse, true), self.fraction)
        } else if texture.is_opaque {
            let fine = self.fine.mean_of_colors(of_fine);
            let coarse = coarse.mean_of_colors(of_coarse);
            let alpha = self.fraction.splat(OPAQUE);
            fine.mix(coarse, self.fraction).extend(alpha)
        } else {
            let fine = self.fine.mean(of_fine, false);
            mix_colors(fine, coarse.mean(of_coarse, false), self.fraction)
        };
        finish(color, is_srgb)
    }
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
