//! Per-sample operations: depth test, blending, encoding and write mask, on one sample at a time.
//!
//! In · Out: a fragment · the target's stored values. Precision: f32 in the order of NUMERICS.md,
//! *Per-sample operations*.

use crate::arithmetic::{clamp, max, min};
use crate::{State, Target, color};
use estampe_types::TextureFormat;
use estampe_types::state::{BlendComponent, BlendFactor, BlendOperation, BlendState, ColorWrites};

/// Tests and stores one sample of a fragment: whether it passed.
pub fn store_sample(
    target: &mut Target,
    index: usize,
    state: &State,
    depth: f32,
    color: Option<[f32; 4]>,
) -> bool {
    if let Some(test) = state.depth {
        if !test.compare.passes(depth, target.depth[index]) {
            return false;
        }
        if test.write_enabled {
            target.depth[index] = depth;
        }
    }
    if let Some(source) = color {
        let stored = target.color[index];
        let format = target.color_format;
        let codes = match &state.blend {
            None => color::encode(format, source),
            Some(blend) => blend_codes(format, blend, state.blend_constant, source, stored),
        };
        target.color[index] = masked(state.write_mask, codes, stored);
    }
    true
}

/// Decodes the destination, blends and encodes.
fn blend_codes(
    format: TextureFormat,
    state: &BlendState,
    constant: [f32; 4],
    source: [f32; 4],
    stored: [u8; 4],
) -> [u8; 4] {
    // Unorm attachments confine what comes in.
    let confine = |channel| clamp(channel, 0.0, 1.0);
    let blended = blend(
        state,
        constant.map(confine),
        source.map(confine),
        color::decode(format, stored),
    );
    color::encode(format, blended)
}

/// Blends linear colours.
#[must_use]
pub fn blend(
    state: &BlendState,
    constant: [f32; 4],
    source: [f32; 4],
    destination: [f32; 4],
) -> [f32; 4] {
    std::array::from_fn(|channel| {
        let component: &BlendComponent = if channel < 3 {
            &state.color
        } else {
            &state.alpha
        };
        let (s, d) = (source[channel], destination[channel]);
        let of = |which| factor(which, channel, constant, source, destination);
        let s_scaled = s * of(component.src_factor);
        let d_scaled = d * of(component.dst_factor);
        match component.operation {
            BlendOperation::Add => s_scaled + d_scaled,
            BlendOperation::Subtract => s_scaled - d_scaled,
            BlendOperation::ReverseSubtract => d_scaled - s_scaled,
            BlendOperation::Min => min(s, d),
            BlendOperation::Max => max(s, d),
        }
    })
}

fn factor(
    which: BlendFactor,
    channel: usize,
    constant: [f32; 4],
    source: [f32; 4],
    destination: [f32; 4],
) -> f32 {
    use BlendFactor as F;
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
        // A factor that this version does not know changes nothing.
        _ => 1.0,
    }
}

/// The new codes in the channels that may change, the stored ones in the others.
#[must_use]
pub fn masked(mask: ColorWrites, new: [u8; 4], stored: [u8; 4]) -> [u8; 4] {
    std::array::from_fn(|channel| {
        if mask.0 >> channel & 1 == 1 {
            new[channel]
        } else {
            stored[channel]
        }
    })
}
