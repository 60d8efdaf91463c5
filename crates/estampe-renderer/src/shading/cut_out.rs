//! Surfaces that are cut out where their alpha is below a cutoff.
//!
//! With several samples the edge is smooth: alpha, sharpened by its change between neighbouring
//! pixels so that it rises from 0 to 1 within about one pixel around the cutoff, is the share of
//! samples that is covered, as in alpha to coverage. Samples that are covered are opaque; the
//! pipeline state of that name would leave the share in the alpha of the picture as well.

use estampe::{FragmentOut, Int, Real};

/// With fewer samples edges are hard.
pub const LEAST_SAMPLES: u32 = 4;

/// The fragment where alpha is not below the cutoff.
#[inline(always)]
pub fn hard<R: Real>(out: FragmentOut<R>, alpha: R, cutoff: f32) -> FragmentOut<R> {
    out.discard_unless(alpha.ge(cutoff))
}

/// The fragment in the share of its samples that is covered.
#[inline(always)]
pub fn smooth<R: Real>(out: FragmentOut<R>, alpha: R, cutoff: f32, samples: u16) -> FragmentOut<R> {
    let samples = f32::from(samples);
    let count = (coverage(alpha, cutoff) * samples + 0.5).floor();
    // The first samples, as of alpha to coverage: 2ⁿ − 1, which is exact.
    let bits = count.exp2().to_int();
    out.with_sample_mask(bits - bits.splat(1))
}

/// The covered share of a pixel.
#[inline(always)]
fn coverage<R: Real>(alpha: R, cutoff: f32) -> R {
    /// Where alpha changes less from pixel to pixel, there is no edge.
    const FLAT: f32 = 1e-4;
    let change = alpha.ddx().abs() + alpha.ddy().abs();
    let sharpened = ((alpha - cutoff) / change.max(FLAT) + 0.5).saturate();
    let whole = R::select(alpha.ge(cutoff), alpha.splat(1.0), alpha.splat(0.0));
    R::select(change.lt(FLAT), whole, sharpened)
}
