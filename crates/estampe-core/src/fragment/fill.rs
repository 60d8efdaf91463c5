//! Packets that are filled fragment by fragment: their lanes, and the samples of these.

use estampe_simd::{Bytes, LANES, Lanes, Select, SimdBase, u32x16};

/// The numbers of a packet's lanes.
pub(crate) const LANE_NUMBERS: [u32; LANES] =
    [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// The samples of sixteen fragments, one bit each, given the lanes of each sample. Nothing is asked
/// of a single one, which gives 0.
#[inline(always)]
pub(crate) fn samples_of<S: Lanes, const N: usize>(s: S, masks: &[u16; N]) -> u32x16<S> {
    let zero = <u32x16<S> as SimdBase<S>>::splat(s, 0);
    let mut samples = zero;
    if const { N > 1 } {
        for (mask, sample) in masks.iter().zip(0..) {
            let bit = <u32x16<S> as SimdBase<S>>::splat(s, 1 << sample);
            samples |= s.mask_from_bits(*mask).select(bit, zero);
        }
    }
    samples
}

/// The lanes of each sample, among some lanes, of fragments whose samples are listed. A single
/// sample is not listed.
#[inline(always)]
pub(crate) fn masks_of<S: Lanes, const N: usize>(
    s: S,
    samples: &[u32; LANES],
    lanes: u16,
) -> [u16; N] {
    let mut masks = [lanes; N];
    if const { N > 1 } {
        let samples = u32x16::load_array_ref(s, samples);
        for (mask, sample) in masks.iter_mut().zip(0u32..) {
            *mask &= s.sign_bits((samples << (31 - sample)).bitcast());
        }
    }
    masks
}

/// The lanes from one on, before another one.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "sixteen bits")]
pub(crate) fn lanes_between(first: usize, end: usize) -> u16 {
    ((1u32 << end) - (1 << first)) as u16
}
