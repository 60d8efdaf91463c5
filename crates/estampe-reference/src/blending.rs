//! Blending of one sample's colour with the attachment's.
//!
//! In · Out: source, second source, constant and destination colours · the blended colour.
//! Precision: f32 in the order of NUMERICS.md, *Per-sample operations*.

use crate::arithmetic::{max, min};
use estampe_types::state::{BlendComponent, BlendFactor, BlendOperation, BlendState};

/// The inputs of the blend equation: linear colours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlendInputs {
    /// The fragment's colour.
    pub source: [f32; 4],
    /// The fragment's second colour, for dual-source blending.
    pub second: [f32; 4],
    /// The draw's blend constant.
    pub constant: [f32; 4],
    /// The stored colour.
    pub destination: [f32; 4],
}

/// Blends linear colours.
#[must_use]
pub fn blend(state: &BlendState, inputs: &BlendInputs) -> [f32; 4] {
    std::array::from_fn(|channel| {
        let component: &BlendComponent = if channel < 3 {
            &state.color
        } else {
            &state.alpha
        };
        let (s, d) = (inputs.source[channel], inputs.destination[channel]);
        let s_scaled = s * factor(component.src_factor, channel, inputs);
        let d_scaled = d * factor(component.dst_factor, channel, inputs);
        match component.operation {
            BlendOperation::Add => s_scaled + d_scaled,
            BlendOperation::Subtract => s_scaled - d_scaled,
            BlendOperation::ReverseSubtract => d_scaled - s_scaled,
            BlendOperation::Min => min(s, d),
            BlendOperation::Max => max(s, d),
        }
    })
}

fn factor(which: BlendFactor, channel: usize, inputs: &BlendInputs) -> f32 {
    use BlendFactor as F;
    let BlendInputs {
        source,
        second,
        constant,
        destination,
    } = inputs;
    match which {
        F::Zero => 0.0,
        F::One => 1.0,
        F::Src => source[channel],
        F::OneMinusSrc => 1.0 - source[channel],
        F::SrcAlpha => source[3],
        F::OneMinusSrcAlpha => 1.0 - source[3],
        F::Dst => destination[channel],
        F::OneMinusDst => 1.0 - destination[channel],
        F::DstAlpha => destination[3],
        F::OneMinusDstAlpha => 1.0 - destination[3],
        F::SrcAlphaSaturated if channel == 3 => 1.0,
        F::SrcAlphaSaturated => min(source[3], 1.0 - destination[3]),
        F::Constant => constant[channel],
        F::OneMinusConstant => 1.0 - constant[channel],
        F::ConstantAlpha => constant[3],
        F::OneMinusConstantAlpha => 1.0 - constant[3],
        F::Src1 => second[channel],
        F::OneMinusSrc1 => 1.0 - second[channel],
        F::Src1Alpha => second[3],
        F::OneMinusSrc1Alpha => 1.0 - second[3],
        // The enum is non-exhaustive; all of its factors are matched above.
        _ => 1.0,
    }
}
