//! One coordinate axis in the scalar code: the texels between which a coordinate lies, with offsets
//! and borders.

use estampe_types::{AddressMode, FilterMode, Real};

/// The two texels of a sample along one axis and the position between their centres, 0..1. The
/// second texel counts only with linear filtering. Texel −1 is the border.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    pub(crate) texels: [i32; 2],
    pub(crate) fraction: f32,
}

/// Texel coordinates are clamped to ±2²⁴: beyond it, f32 does not distinguish neighbouring texels.
pub(crate) const FAR: f32 = 16_777_216.0;

/// The texels of coordinate `u` in a level of `count` texels; `length` is the same number as a
/// float.
#[expect(
    clippy::cast_possible_truncation,
    reason = "confined to whole numbers within ±2²⁴"
)]
#[inline]
pub(crate) fn place(
    u: f32,
    (count, length): (i32, f32),
    mode: AddressMode,
    filter: FilterMode,
    offset: i32,
) -> Place {
    let half = match filter {
        FilterMode::Nearest => 0.0,
        FilterMode::Linear => 0.5,
    };
    // The same arithmetic as `wrap`, to the bit, so that all paths agree.
    if offset == 0 && mode.is_plain() {
        let wrapped = crate::wrap::wrap(u, mode);
        let mut at = wrapped * length - half;
        if mode != AddressMode::Repeat {
            at = Real::clamp(at, 0.0, length - 1.0);
        }
        let whole = at.floor();
        let first = whole as i32;
        let texels = match mode {
            AddressMode::Repeat => [first, first + 1].map(|texel| crate::wrap::tile(texel, count)),
            _ => [first, (first + 1).min(count - 1)],
        };
        return Place {
            texels,
            fraction: at - whole,
        };
    }
    place_in_integers(u * length - half, count, mode, offset)
}

/// The two texels that gathering reads along an axis. Each is wrapped by itself, also at a clamped
/// or mirrored edge: there both are the texel at the edge. Filtering clamps the coordinate instead.
#[inline]
pub(crate) fn gathered(
    u: f32,
    (count, length): (i32, f32),
    mode: AddressMode,
    offset: i32,
) -> [i32; 2] {
    let place = match mode {
        AddressMode::Repeat => place(u, (count, length), mode, FilterMode::Linear, offset),
        _ => place_in_integers(u * length - 0.5, count, mode, offset),
    };
    place.texels
}

/// The texels of a texel coordinate: its integer part and the next one are moved by the offset,
/// then wrapped.
#[expect(
    clippy::cast_possible_truncation,
    reason = "confined to whole numbers within ±2²⁴"
)]
#[inline]
fn place_in_integers(at: f32, count: i32, mode: AddressMode, offset: i32) -> Place {
    let at = Real::clamp(at, -FAR, FAR);
    let whole = at.floor();
    let first = (whole as i32).saturating_add(offset.clamp(-1024, 1024));
    Place {
        texels: [first, first + 1].map(|texel| wrapped(texel, count, mode)),
        fraction: at - whole,
    }
}

/// Wraps an integer texel coordinate; −1 is the border.
#[inline]
pub(crate) fn wrapped(texel: i32, count: i32, mode: AddressMode) -> i32 {
    let mirrored = |texel: i32| if texel >= 0 { texel } else { -1 - texel };
    match mode {
        AddressMode::Repeat => texel.rem_euclid(count),
        AddressMode::MirrorRepeat => (count - 1) - mirrored(texel.rem_euclid(2 * count) - count),
        AddressMode::ClampToEdge => texel.clamp(0, count - 1),
        AddressMode::MirrorOnce => mirrored(texel).min(count - 1),
        AddressMode::ClampToBorder if (0..count).contains(&texel) => texel,
        AddressMode::ClampToBorder => -1,
    }
}
