//! Depth bias: the offset that is added to a triangle's depth.
//!
//! In · Out: a triangle's depth plane and depths · an offset. Precision: f32 in the order of
//! NUMERICS.md. Spec: Vulkan, "Depth Bias Computation".

use crate::arithmetic::{max, min};
use crate::setup::SortedTriangle;
use estampe_types::state::DepthBiasState;

/// The offset of a triangle's depth; 0 if it is not finite. `unit` is the unit of the bias constant
/// for fixed-point depths; `None` computes it from the triangle's greatest depth, as for float
/// depths.
#[must_use]
pub fn offset(state: &DepthBiasState, unit: Option<f32>, triangle: &SortedTriangle) -> f32 {
    let [a, b, c] = triangle.vertices.each_ref().map(|vertex| vertex.z);
    let plane = triangle.plane([a, b, c]);
    let slope = max(plane.per_x.abs(), plane.per_y.abs());
    let unit = unit.unwrap_or_else(|| float_unit(max(max(a.abs(), b.abs()), c.abs())));
    let sum = slope * state.slope_scale + unit * state.constant;
    if !sum.is_finite() {
        0.0
    } else if state.clamp > 0.0 {
        min(sum, state.clamp)
    } else if state.clamp < 0.0 {
        max(sum, state.clamp)
    } else {
        sum
    }
}

/// 2^(e − 23), where e is the exponent of a depth; denormal depths have e = −126.
#[must_use]
pub fn float_unit(depth: f32) -> f32 {
    let exponent = (depth.to_bits() >> 23).max(1);
    // 2^(exponent − 127 − 23), by exact halvings of 2^(exponent − 127).
    let mut unit = f32::from_bits(exponent << 23);
    for _ in 0..23 {
        unit *= 0.5;
    }
    unit
}
