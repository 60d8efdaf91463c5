//! The level of detail λ: how many times a texture is halved until a texel is as wide as a pixel.

use estampe_types::{Int, Real, Vec2};

/// log₂(1 + t) ≈ (((a₃·t + a₂)·t + a₁)·t + a₀)·t for t in 0..1, within 1.2·10⁻⁴: a minimax fit
/// among the polynomials that are exact at both ends (iterated weighted least squares).
const A: [f32; 4] = [1.438_725_7, -0.677_783_9, 0.321_188_8, -0.082_130_6];

/// ρ² of each quad in texels of a base level of this size, from the differences between the quad's
/// fragments.
///
/// The two derivatives stay in the quad's second and third lane until the last step, so that most
/// of the work is done once instead of twice.
#[inline(always)]
pub(crate) fn implicit_rho2<R: Real>(uv: Vec2<R>, size: [f32; 2]) -> R {
    let from_first = Vec2::new(uv.x - uv.x.quad_lane(0), uv.y - uv.y.quad_lane(0));
    let squared = squared(from_first, size);
    greater(squared.quad_lane(1), squared.quad_lane(2))
}

/// ρ² from the derivatives of (u, v) along x and along y.
#[inline(always)]
pub(crate) fn rho2<R: Real>(dx: Vec2<R>, dy: Vec2<R>, size: [f32; 2]) -> R {
    greater(squared(dx, size), squared(dy, size))
}

/// The greater of two squared lengths; NaN counts as 0.
#[inline(always)]
fn greater<R: Real>(x: R, y: R) -> R {
    x.max(y).max(x.splat(0.0))
}

/// λ from ρ².
///
/// GPUs resolve λ to 1/256. This is within 6·10⁻⁵ of ½·log₂ ρ², costs half as much as the exact
/// function, and needs no division. ρ² = 0 gives −63.5.
#[inline(always)]
pub(crate) fn level_of_detail<R: Real>(rho2: R) -> R {
    let bits = rho2.to_bits();
    let exponent = ((bits >> 23) - bits.splat(127)).to_real();
    let mantissa = (bits & bits.splat(0x007F_FFFF)) | bits.splat(0x3F80_0000);
    let t = mantissa.to_real_bits() - 1.0;
    let log2 = (((t * A[3] + A[2]) * t + A[1]) * t + A[0]) * t + exponent;
    log2 * 0.5
}

/// The squared length of a derivative, in texels.
#[inline(always)]
fn squared<R: Real>(d: Vec2<R>, size: [f32; 2]) -> R {
    let (x, y) = (d.x * size[0], d.y * size[1]);
    x * x + y * y
}
