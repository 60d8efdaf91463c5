//! Wrapping of one texture coordinate, and the texels between which it lies.

use estampe_types::{AddressMode, FilterMode, Int, Real};

/// Wraps u into the first tile, which is the same for all mip levels. [`AddressMode::ClampToEdge`]
/// leaves u unchanged.
#[inline(always)]
pub(crate) fn wrap<R: Real>(u: R, mode: AddressMode) -> R {
    match mode {
        // max() turns NaN into 0; infinities give NaN, too.
        AddressMode::Repeat => u.fract().max(u.splat(0.0)),
        AddressMode::MirrorRepeat => {
            let tile = (u * 0.5).floor() * 2.0;
            u.splat(1.0) - (u - tile - 1.0).abs()
        }
        // This code does not serve the other two modes: `SampledTexture` samples with them.
        AddressMode::ClampToEdge | AddressMode::MirrorOnce | AddressMode::ClampToBorder => u,
    }
}

/// The texel coordinate of a sample along one axis of one mip level.
pub(crate) struct Place<R: Real> {
    /// The texel at or before the sample: −1..size with repeat, where −1 is the last texel; else
    /// 0..size.
    pub(crate) texel: R::Int,
    /// The position between the centres of that texel and the next, 0..1: the weight of the next
    /// texel. With mirror and clamp it is 0 at the last texel, so a next texel, which does not
    /// exist, never counts.
    pub(crate) fraction: R,
}

/// The texel coordinate of a wrapped coordinate in a level of `length` texels.
#[inline(always)]
pub(crate) fn place<R: Real>(
    wrapped: R,
    length: f32,
    mode: AddressMode,
    filter: FilterMode,
) -> Place<R> {
    let mut at = wrapped * length;
    if filter == FilterMode::Linear {
        at -= 0.5;
    }
    if mode != AddressMode::Repeat {
        at = at.clamp(0.0, length - 1.0);
    }
    let whole = at.floor();
    Place {
        texel: whole.to_int_within_range(),
        fraction: at - whole,
    }
}

/// [`place`] with linear filtering and a separate number of texels in each lane; `last` is one less
/// than it.
#[inline(always)]
pub(crate) fn place_by_lane<R: Real>(
    wrapped: R,
    length: R,
    last: R,
    mode: AddressMode,
) -> Place<R> {
    let mut at = wrapped * length - 0.5;
    if mode != AddressMode::Repeat {
        at = at.clamp(0.0, last);
    }
    let whole = at.floor();
    Place {
        texel: whole.to_int_within_range(),
        fraction: at - whole,
    }
}

/// Wraps a texel coordinate by one tile: −1 is the last texel and `size` is the first.
#[inline(always)]
pub(crate) fn tile<I: Int>(texel: I, size: i32) -> I {
    tile_lanes(texel, texel.splat(size))
}

/// [`tile`] with a separate size in each lane.
#[inline(always)]
pub(crate) fn tile_lanes<I: Int>(texel: I, size: I) -> I {
    let below = I::select(texel.lt(texel.splat(0)), size - texel.splat(1), texel);
    I::select(below.eq(size), below.splat(0), below)
}
