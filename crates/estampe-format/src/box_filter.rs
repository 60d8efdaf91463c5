//! The 2×2 box filter of texels of four 8-bit channels, which halves images.
//!
//! Encoded unorm values a, b, c, d give `(a + b + c + d + 2) / 4`, rounded down. R, G and B of sRGB
//! are averaged as linear values, in f32, `((a + b) + (c + d)) · 0.25`, and encoded again. Alpha is
//! straight: colours are weighted with it only if [`Averaged::Weighted`] says so.
//!
//! A texel is a word with R in its lowest byte.

use crate::srgb::{Encoder, LINEAR_FROM_SRGB};

/// The values that are averaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Averaged {
    /// The stored values.
    Stored,
    /// The linear values of sRGB codes, and stored alpha.
    Linear,
    /// As [`Self::Linear`], each texel with the weight of its alpha; of four texels whose alpha is
    /// 0, all have the same weight.
    Weighted,
}

impl Averaged {
    /// The values that are averaged in a format with or without sRGB encoding.
    #[must_use]
    pub fn of(is_srgb: bool) -> Self {
        if is_srgb { Self::Linear } else { Self::Stored }
    }
}

/// Writes each texel of `half` as the mean of two texels of `upper` and of the two below them. The
/// last texel of an odd width is left out; a width of 1 is its own half.
pub fn halve_rows(upper: &[u32], lower: &[u32], half: &mut [u32], averaged: Averaged) {
    // Each form is compiled with its mean, so that the one of stored values is done in lanes.
    match averaged {
        Averaged::Stored => halve(upper, lower, half, mean_stored),
        Averaged::Linear => {
            let mean = LinearMean::new();
            halve(upper, lower, half, |four| mean.of(four));
        }
        Averaged::Weighted => {
            let mean = LinearMean::new();
            halve(upper, lower, half, |four| mean.weighted(four));
        }
    }
}

/// The mean of four texels.
#[must_use]
pub fn mean(four: [u32; 4], averaged: Averaged) -> u32 {
    match averaged {
        Averaged::Stored => mean_stored(four),
        Averaged::Linear => LinearMean::new().of(four),
        Averaged::Weighted => LinearMean::new().weighted(four),
    }
}

#[inline(always)]
fn halve(upper: &[u32], lower: &[u32], half: &mut [u32], mean: impl Fn([u32; 4]) -> u32) {
    if let (&[above], &[below], Some(first)) = (upper, lower, half.first_mut()) {
        *first = mean([above, above, below, below]);
        return;
    }
    let (pairs_above, _) = upper.as_chunks::<2>();
    let (pairs_below, _) = lower.as_chunks::<2>();
    for ((half, above), below) in half.iter_mut().zip(pairs_above).zip(pairs_below) {
        *half = mean([above[0], above[1], below[0], below[1]]);
    }
}

/// Two channels are summed in one word, 16 bits each.
#[inline(always)]
fn mean_stored(four: [u32; 4]) -> u32 {
    const EVEN: u32 = 0x00FF_00FF;
    let (mut even, mut odd) = (0x0002_0002, 0x0002_0002);
    for texel in four {
        even += texel & EVEN;
        odd += (texel >> 8) & EVEN;
    }
    (even >> 2) & EVEN | ((odd >> 2) & EVEN) << 8
}

/// The mean of linear values, with its tables.
struct LinearMean {
    linear: &'static [f32; 256],
    encoder: Encoder,
}

impl LinearMean {
    fn new() -> Self {
        Self {
            linear: &LINEAR_FROM_SRGB,
            encoder: Encoder::new(),
        }
    }

    #[inline(always)]
    fn of(&self, four: [u32; 4]) -> u32 {
        // Sums of equal numbers and their quarter are exact, and codes are encoded as themselves.
        if four == [four[0]; 4] {
            return four[0];
        }
        let mut texel = mean_stored(four) & 0xFF00_0000;
        for shift in [0, 8, 16] {
            let [a, b, c, d] = four.map(|t| self.linear[(t >> shift & 0xFF) as usize]);
            let linear = ((a + b) + (c + d)) * 0.25;
            texel |= self.encoder.code(linear) << shift;
        }
        texel
    }

    /// Channels whose four codes are equal keep them: a quotient of rounded sums might not.
    #[inline(always)]
    fn weighted(&self, four: [u32; 4]) -> u32 {
        let alphas = four.map(|texel| (texel >> 24) as f32);
        let is_invisible = four.iter().all(|texel| texel >> 24 == 0);
        let weights = if is_invisible { [1.0; 4] } else { alphas };
        let total = (weights[0] + weights[1]) + (weights[2] + weights[3]);
        let mut texel = mean_stored(four) & 0xFF00_0000;
        for shift in [0, 8, 16] {
            let codes = four.map(|t| t >> shift & 0xFF);
            texel |= if codes == [codes[0]; 4] {
                codes[0] << shift
            } else {
                let linear = |k: usize| self.linear[codes[k] as usize] * weights[k];
                let sum = (linear(0) + linear(1)) + (linear(2) + linear(3));
                // Rounded, the mean of numbers up to 1 may be a little more.
                self.encoder.code((sum / total).min(1.0)) << shift
            };
        }
        texel
    }
}
