//! Test of a shader's claim that it passes its colour through unchanged.

use super::scalar;
use crate::{Bindings, FragmentBatch, Interface, Shader};
use estampe_simd::{LANES, Packet};

/// True if the shader sets `COLOR_PASSTHROUGH` and returns sixteen test colours unchanged. A shader
/// that sets it and fails the test is run as any other.
pub(super) fn color_passthrough<T: Shader>(shader: &T, interface: &Interface) -> bool {
    let scalars = interface.varyings.len();
    if !T::COLOR_PASSTHROUGH
        || T::DISCARDS
        || T::READS_POSITION
        || interface.depth_output != super::DepthOutput::None
        || interface.color_targets != 1
        || interface.dual_source
        || T::STORES
        || interface.writes_sample_mask
        || scalars < 4
    {
        return false;
    }
    // Every lane and scalar has a different value; some are outside 0..=1.
    let mut varyings = vec![Packet([0.0; LANES]); scalars];
    let all = varyings.iter_mut().flat_map(|packet| &mut packet.0);
    all.zip(1u16..)
        .for_each(|(value, number)| *value = f32::from(number) * 0.037 - 0.5);
    let mut colors = [Packet([f32::NAN; LANES]); 4];
    let batch = FragmentBatch {
        varyings: &varyings,
        front_facing: &[u16::MAX],
        coverage: &mut [u16::MAX],
        colors: &mut colors,
        ..FragmentBatch::default()
    };
    scalar::fragments(shader, interface, &Bindings::default(), batch);
    colors == varyings[..4]
}

#[cfg(test)]
mod tests {
    use crate::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
    use crate::{Program, ShaderProgram, Vec4};

    struct Colored {
        is_honest: bool,
    }

    crate::shader! {
        impl Shader for Colored {
            type Attributes<R: Real> = Vec4<R>;
            type Varyings<R: Real> = Vec4<R>;
            const COLOR_PASSTHROUGH: bool = true;

            fn vertex<R: Real>(&self, _input: VertexIn<'_, R>, color: Vec4<R>) -> VertexOut<R, Vec4<R>> {
                VertexOut::new(color, color)
            }

            fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, color: Vec4<R>) -> FragmentOut<R> {
                let x = if self.is_honest { color.x } else { color.x * 0.5 };
                FragmentOut::color(Vec4::new(x, color.y, color.z, color.w))
            }
        }
    }

    #[test]
    fn a_false_passthrough_claim_is_detected() {
        for is_honest in [true, false] {
            let program = ShaderProgram::new(Colored { is_honest });
            assert_eq!(program.interface().color_passthrough, is_honest);
        }
    }
}
