//! Blending (O5) complete: every factor, dual source included.

use crate::per_sample::texel::Numbers;
use estampe_simd::LANES;
use estampe_types::state::{BlendComponent, BlendFactor, BlendOperation, BlendState};

/// What blending combines; all are confined to the target's range already.
#[derive(Debug)]
pub(super) struct Inputs<'a> {
    pub(super) source: &'a Numbers,
    /// The fragments' second colour; zeros if there is none.
    pub(super) second: &'a Numbers,
    pub(super) stored: &'a Numbers,
    pub(super) constant: [f32; 4],
}

impl Inputs<'_> {
    /// s·fs, d·fd, then the operation, channel by channel.
    #[inline(always)]
    pub(super) fn blend(&self, state: &BlendState) -> Numbers {
        let mut blended = [[0.0; LANES]; 4];
        for (channel, out) in blended.iter_mut().enumerate() {
            let component = if channel == 3 {
                &state.alpha
            } else {
                &state.color
            };
            *out = self.component(component, channel);
        }
        blended
    }

    #[inline(always)]
    fn component(&self, component: &BlendComponent, channel: usize) -> [f32; LANES] {
        let (source, stored) = (&self.source[channel], &self.stored[channel]);
        let (by_source, by_stored) = (
            self.factor(component.src_factor, channel),
            self.factor(component.dst_factor, channel),
        );
        let mut out = [0.0; LANES];
        for (lane, out) in out.iter_mut().enumerate() {
            let (s, d) = (source[lane], stored[lane]);
            let (scaled_s, scaled_d) = (s * by_source[lane], d * by_stored[lane]);
            *out = match component.operation {
                BlendOperation::Add => scaled_s + scaled_d,
                BlendOperation::Subtract => scaled_s - scaled_d,
                BlendOperation::ReverseSubtract => scaled_d - scaled_s,
                BlendOperation::Min => least(s, d),
                BlendOperation::Max => greatest(s, d),
            };
        }
        out
    }

    #[inline(always)]
    fn factor(&self, factor: BlendFactor, channel: usize) -> [f32; LANES] {
        use BlendFactor as F;
        let (source, second, stored) = (self.source, self.second, self.stored);
        match factor {
            F::Zero => [0.0; LANES],
            F::One => [1.0; LANES],
            F::Src => source[channel],
            F::OneMinusSrc => rest(&source[channel]),
            F::SrcAlpha => source[3],
            F::OneMinusSrcAlpha => rest(&source[3]),
            F::Dst => stored[channel],
            F::OneMinusDst => rest(&stored[channel]),
            F::DstAlpha => stored[3],
            F::OneMinusDstAlpha => rest(&stored[3]),
            F::SrcAlphaSaturated if channel == 3 => [1.0; LANES],
            F::SrcAlphaSaturated => {
                let mut out = rest(&stored[3]);
                for (out, alpha) in out.iter_mut().zip(&source[3]) {
                    *out = least(*alpha, *out);
                }
                out
            }
            F::Constant => [self.constant[channel]; LANES],
            F::OneMinusConstant => [1.0 - self.constant[channel]; LANES],
            F::ConstantAlpha => [self.constant[3]; LANES],
            F::OneMinusConstantAlpha => [1.0 - self.constant[3]; LANES],
            F::Src1 => second[channel],
            F::OneMinusSrc1 => rest(&second[channel]),
            F::Src1Alpha => second[3],
            F::OneMinusSrc1Alpha => rest(&second[3]),
            // `BlendFactor` grows; a factor without code cannot pass for another.
            other => unreachable!("blend factor {other:?} has no code"),
        }
    }
}

#[inline(always)]
fn rest(values: &[f32; LANES]) -> [f32; LANES] {
    let mut out = *values;
    for value in &mut out {
        *value = 1.0 - *value;
    }
    out
}

/// `b` where either is NaN.
#[inline(always)]
fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// `b` where either is NaN.
#[inline(always)]
fn greatest(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
