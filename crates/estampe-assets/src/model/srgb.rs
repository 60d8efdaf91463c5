//! Conversion of stored colours to linear light.

use std::sync::LazyLock;

/// Linear light of one sRGB-encoded component (IEC 61966-2-1). Values above 1 follow the same
/// curve, values below 0 and NaN are 0.
pub(super) fn linear_from_srgb(encoded: f32) -> f32 {
    if encoded <= 0.040_45 {
        encoded.max(0.0) / 12.92
    } else {
        libm::powf((encoded + 0.055) / 1.055, 2.4).max(0.0)
    }
}

/// Linear light of an 8-bit sRGB component.
pub(super) fn linear_from_srgb8(encoded: u8) -> f32 {
    static TABLE: LazyLock<[f32; 256]> =
        LazyLock::new(|| std::array::from_fn(|value| linear_from_srgb(value as f32 / 255.0)));
    TABLE[usize::from(encoded)]
}
