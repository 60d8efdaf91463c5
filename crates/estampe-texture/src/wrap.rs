//! One axis of a coordinate: from u to the texels that it lies between.

use estampe_types::{AddressMode, FilterMode, Int, Real};

/// Brings u into the first tile, the same for all levels. [`AddressMode::ClampToEdge`] leaves it as it is.
#[inline(always)]
pub(crate) fn wrap<R: Real>(u: R, mode: AddressMode) -> R {
    match mode {
        // max() turns NaN, which infinities give too, into 0.
        AddressMode::Repeat => u.fract().max(u.splat(0.0)),
        AddressMode::MirrorRepeat => {
            let tile = (u * 0.5).floor() * 2.0;
            u.splat(1.0) - (u - tile - 1.0).abs()
        }
        // The other two are not of this path: `SampledView` samples with them.
        AddressMode::ClampToEdge | AddressMode::MirrorOnce | AddressMode::ClampToBorder => u,
    }
}

/// Where a sample lies along one axis of one level.
pub(crate) struct Place<R: Real> {
    /// The texel at or before it: −1..size with repeat, where −1 is the last one; else 0..size.
    pub(crate) texel: R::Int,
    /// How far it is from that texel's centre to the next one's, 0..1. With mirror and clamp it is 0 at
    /// the last texel, so the next one, which does not exist, never counts.
    pub(crate) fraction: R,
}

/// The place of a wrapped coordinate in a level of `length` texels.
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

/// The texel −1 is the last one and texel `size` is the first.
#[inline(always)]
pub(crate) fn tile<I: Int>(texel: I, size: i32) -> I {
    tile_lanes(texel, texel.splat(size))
}

/// [`tile`] where each lane has a size of its own.
#[inline(always)]
pub(crate) fn tile_lanes<I: Int>(texel: I, size: I) -> I {
    let below = I::select(texel.lt(texel.splat(0)), size - texel.splat(1), texel);
    I::select(below.eq(size), below.splat(0), below)
}
