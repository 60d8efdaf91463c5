//! The standard sample positions, and the set of samples of a pixel.
//!
//! Code of the tile side is compiled for 1, for 4 and for up to 16 samples. In the first two the
//! number of samples is a constant and loops over samples unroll; the third serves 2, 8 and 16
//! samples.
//!
//! *Spec* Vulkan §Multisampling, standard sample locations.

/// The most samples of a pixel.
pub(crate) const MAX_SAMPLES: usize = 16;

/// Offsets of the samples inside their pixel, in 1/256 pixel: the standard positions of Vulkan.
const SAMPLES_1: [[i32; 2]; 1] = [[128, 128]];
const SAMPLES_2: [[i32; 2]; 2] = [[192, 192], [64, 64]];
const SAMPLES_4: [[i32; 2]; 4] = [[96, 32], [224, 96], [32, 160], [160, 224]];
const SAMPLES_8: [[i32; 2]; 8] = [
    [144, 80],
    [112, 176],
    [208, 144],
    [80, 48],
    [48, 208],
    [16, 112],
    [176, 240],
    [240, 16],
];
const SAMPLES_16: [[i32; 2]; 16] = [
    [144, 144],
    [112, 80],
    [80, 160],
    [192, 112],
    [48, 96],
    [160, 208],
    [208, 176],
    [176, 48],
    [96, 224],
    [128, 16],
    [64, 32],
    [32, 192],
    [0, 128],
    [240, 64],
    [224, 240],
    [16, 0],
];

/// The samples of a pixel: exactly `N` if `N` is 1 or 4, any standard number if `N` is
/// [`MAX_SAMPLES`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct SampleSet<const N: usize> {
    count: usize,
}

impl<const N: usize> SampleSet<N> {
    /// A set of `count` samples.
    pub(crate) fn new(count: usize) -> Self {
        debug_assert!(
            count == N || N == MAX_SAMPLES && count <= N,
            "code for {N} samples cannot draw {count}"
        );
        Self { count }
    }

    /// Returns the number of samples: a constant, except in the code that serves any number.
    #[inline(always)]
    pub(crate) fn count(self) -> usize {
        if N == MAX_SAMPLES {
            self.count.min(N)
        } else {
            N
        }
    }

    /// The masks of a packet whose samples are all covered.
    #[inline(always)]
    pub(crate) fn whole(self) -> [u16; N] {
        let mut masks = [u16::MAX; N];
        if N == MAX_SAMPLES {
            masks[self.count()..].fill(0);
        }
        masks
    }

    /// Offsets of the samples in their pixel, in 1/256 pixel. Places beyond the set's repeat the
    /// first sample, so that extremes over the array are extremes over the set.
    #[inline(always)]
    pub(crate) fn subpixels(self) -> [[i32; 2]; N] {
        let standard = standard_positions(self.count());
        let mut positions = [standard[0]; N];
        for (position, standard) in positions.iter_mut().zip(standard) {
            *position = *standard;
        }
        positions
    }

    /// [`SampleSet::subpixels`] in pixels.
    #[inline(always)]
    pub(crate) fn offsets(self) -> [[f32; 2]; N] {
        let mut offsets = [[0.5; 2]; N];
        for (offset, [x, y]) in offsets.iter_mut().zip(self.subpixels()) {
            *offset = [x as f32 * (1.0 / 256.0), y as f32 * (1.0 / 256.0)];
        }
        offsets
    }
}

/// The standard positions of 1, 2, 4, 8 or 16 samples, in 1/256 pixel.
#[inline(always)]
pub(crate) fn standard_positions(count: usize) -> &'static [[i32; 2]] {
    match count {
        2 => &SAMPLES_2,
        4 => &SAMPLES_4,
        8 => &SAMPLES_8,
        16 => &SAMPLES_16,
        _ => &SAMPLES_1,
    }
}
