//! Depth bias (A5): what is added to the depth of a triangle, or of its edges and corners.
//!
//! *In* a triangle in the window · *Out* an offset of its depth · *Precision* f32 in the order of
//! `docs/NUMERICS.md` · *Spec* Vulkan §Depth Bias Computation.

use crate::bounds::plane::PlanePacket;
use crate::bounds::primitives::WindowVertex;
use estampe_simd::LANES;
use estampe_types::state::DepthBiasState;
use estampe_types::{TexelEncoding, TextureFormat};

/// A bias that may be other than zero.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DepthBias {
    state: DepthBiasState,
    /// The unit of the constant; none where it follows a triangle's depths.
    unit: Option<f32>,
}

impl DepthBias {
    /// A pipeline's bias in a depth attachment of a format; none if nothing would be added.
    pub(crate) fn new(state: &DepthBiasState, format: Option<TextureFormat>) -> Option<Self> {
        let unit = match format.map(TextureFormat::encoding) {
            Some(TexelEncoding::Depth16) => Some(1.0 / 65_536.0),
            Some(TexelEncoding::Depth24) => Some(1.0 / 16_777_216.0),
            _ => None,
        };
        let state = *state;
        (!state.is_zero()).then_some(Self { state, unit })
    }

    /// Moves the depth planes of a packet; the depths are those of the triangles' second and third
    /// vertices.
    #[inline(never)]
    pub(crate) fn apply(&self, planes: &mut PlanePacket, depths: &[[f32; LANES]; 2]) {
        for lane in 0..LANES {
            let (plane, origin) = (planes.lane(lane), &mut planes.origin[lane]);
            let depths = [plane.origin, depths[0][lane], depths[1][lane]];
            *origin += self.offset([plane.dx, plane.dy], depths);
        }
    }

    /// The offset of a triangle that is drawn as its edges or corners; its vertices and area are
    /// those of the sorted order.
    pub(crate) fn of_triangle(&self, [a, b, c]: [WindowVertex; 3], area: i64) -> f32 {
        let difference = |to: i32, from: i32| (to - from) as f32 * (1.0 / 256.0);
        let (dx1, dy1) = (difference(b.x, a.x), difference(b.y, a.y));
        let (dx2, dy2) = (difference(c.x, a.x), difference(c.y, a.y));
        let r = 65_536.0 / area as f32;
        let (e1, e2) = (b.z - a.z, c.z - a.z);
        let slopes = [(e1 * dy2 - e2 * dy1) * r, (e2 * dx1 - e1 * dx2) * r];
        self.offset(slopes, [a.z, b.z, c.z])
    }

    fn offset(&self, [dx, dy]: [f32; 2], depths: [f32; 3]) -> f32 {
        let greater = |a: f32, b: f32| if a > b { a } else { b };
        let DepthBiasState {
            constant,
            slope_scale,
            clamp,
        } = self.state;
        let unit = self.unit.unwrap_or_else(|| {
            let [a, b, c] = depths.map(f32::abs);
            float_unit(greater(greater(a, b), c))
        });
        let slope = greater(dx.abs(), dy.abs());
        let offset = slope * slope_scale + unit * constant;
        let confined = if clamp > 0.0 {
            offset.min(clamp)
        } else if clamp < 0.0 {
            offset.max(clamp)
        } else {
            offset
        };
        // Planes stay finite.
        if offset.is_finite() { confined } else { 0.0 }
    }
}

/// 2^(e − 23) where e is the exponent of a depth: the distance of floats there.
fn float_unit(depth: f32) -> f32 {
    let exponent = (depth.to_bits() >> 23 & 0xFF).max(1);
    // Below the 24th exponent the unit is denormal: a single bit of the mantissa.
    f32::from_bits(match exponent.checked_sub(23) {
        Some(of_unit @ 1..) => of_unit << 23,
        _ => 1 << (exponent - 1),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unit_is_the_distance_to_the_next_float() {
        let mut depth = 1.0_f32;
        while depth > 0.0 {
            for depth in [depth, depth * 1.5] {
                let next = f32::from_bits(depth.to_bits() + 1);
                assert_eq!(float_unit(depth), next - depth, "{depth:e}");
            }
            depth *= 0.5;
        }
        assert_eq!(float_unit(0.0), f32::from_bits(1));
    }

    #[test]
    fn the_sum_is_confined_on_the_side_of_the_clamps_sign() {
        let bias = |constant, slope_scale, clamp| {
            let state = DepthBiasState {
                constant,
                slope_scale,
                clamp,
            };
            let format = Some(TextureFormat::Depth16Unorm);
            DepthBias::new(&state, format)
                .unwrap()
                .offset([0.25, -0.5], [0.0; 3])
        };
        assert_eq!(bias(65_536.0, 2.0, 0.0), 2.0);
        assert_eq!(bias(65_536.0, 2.0, 1.5), 1.5);
        assert_eq!(bias(65_536.0, 2.0, -1.5), 2.0);
        assert_eq!(bias(-65_536.0, -2.0, -1.5), -1.5);
        assert_eq!(bias(f32::INFINITY, 0.0, 1.0), 0.0);
        assert!(DepthBias::new(&DepthBiasState::default(), None).is_none());
    }
}
