//! Shader inputs that depend on which samples of a pixel are covered (R6).

use super::interpolate::PixelOffsets;
use crate::raster::SampleSet;
use estampe_simd::{LANES, Packet};

/// The positions at which centroid varyings are interpolated: the pixel's centre if all samples or
/// none are covered, else the covered sample of the lowest number.
pub(super) fn centroids<const N: usize>(masks: &[u16; N], samples: SampleSet<N>) -> PixelOffsets {
    let offsets = samples.offsets();
    let masks = &masks[..samples.count()];
    let mut places = PixelOffsets::all([0.5; 2]);
    let all = masks.iter().fold(u16::MAX, |all, mask| all & mask);
    for lane in 0..LANES {
        let first = masks.iter().position(|mask| mask >> lane & 1 == 1);
        if let (Some(first), 0) = (first, all >> lane & 1) {
            [places.x[lane], places.y[lane]] = offsets[first];
        }
    }
    places
}

/// By lane the covered samples, bit by bit; of a packet that is shaded by sample that sample alone.
pub(super) fn covered_bits<const N: usize>(masks: &[u16; N], shaded: Option<u8>) -> Packet<u32> {
    let mut bits = [0; LANES];
    for (sample, mask) in masks.iter().enumerate() {
        if shaded.is_some_and(|shaded| usize::from(shaded) != sample) {
            continue;
        }
        for (lane, bits) in bits.iter_mut().enumerate() {
            *bits |= u32::from(mask >> lane & 1) << sample;
        }
    }
    Packet(bits)
}
