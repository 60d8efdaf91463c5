//! Blending (O5): every factor and operation, dual source included.
//!
//! *In* a packet's source colours and the stored colours, as numbers, clamped to the format's range
//! · *Out* the blended colours · *Precision* f32: s·fs, d·fd, then the operation, each rounded ·
//! *Spec* WebGPU §Blend State; Vulkan §Blending.

use crate::pipeline::color_target::{Over, Weight};
use estampe_simd::{LANES, Lanes, Level, SimdBase, dispatch, f32x16};
use estampe_types::state::{BlendComponent, BlendFactor, BlendOperation, BlendState};

/// Four channels of sixteen colours.
pub(crate) type ColorLanes<S> = [f32x16<S>; 4];

/// A blend equation, compiled into the loop that stores colours.
pub(crate) trait BlendKernel: Copy {
    /// True if it is known that the source replaces the stored colours.
    const REPLACES: bool = false;

    /// Returns true if the stored colours are read.
    fn reads_stored(&self) -> bool;

    /// The colours to store.
    fn blend<S: Lanes>(self, s: S, inputs: &BlendInputs<S>) -> ColorLanes<S>;
}

/// The colours that blending combines.
pub(crate) struct BlendInputs<S: Lanes> {
    pub(crate) source: ColorLanes<S>,
    /// The fragments' second colour; zeros if there is none.
    pub(crate) second: ColorLanes<S>,
    pub(crate) stored: ColorLanes<S>,
}

/// The source replaces the stored colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Replace;

impl BlendKernel for Replace {
    const REPLACES: bool = true;

    #[inline(always)]
    fn reads_stored(&self) -> bool {
        false
    }

    #[inline(always)]
    fn blend<S: Lanes>(self, _s: S, inputs: &BlendInputs<S>) -> ColorLanes<S> {
        inputs.source
    }
}

/// A factor's value for each channel. A product with 1 changes nothing, so 1 needs no code of its
/// own.
#[inline(always)]
fn weights<S: Lanes>(s: S, weight: Weight, inputs: &BlendInputs<S>) -> ColorLanes<S> {
    let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
    let (alpha, stored_alpha) = (inputs.source[3], inputs.stored[3]);
    match weight {
        Weight::Zero => [splat(0.0); 4],
        Weight::One => [splat(1.0); 4],
        Weight::SourceAlpha => [alpha; 4],
        Weight::OneMinusSourceAlpha => [splat(1.0) - alpha; 4],
        Weight::StoredAlpha => [stored_alpha; 4],
        Weight::OneMinusStoredAlpha => [splat(1.0) - stored_alpha; 4],
        Weight::Stored => inputs.stored,
    }
}

impl BlendKernel for Over {
    #[inline(always)]
    fn reads_stored(&self) -> bool {
        true
    }

    #[inline(always)]
    fn blend<S: Lanes>(self, s: S, inputs: &BlendInputs<S>) -> ColorLanes<S> {
        let ([r, g, b, a], stored) = (inputs.source, &inputs.stored);
        let by = weights(s, self.source_color, inputs);
        let stored_by = weights(s, self.stored_color, inputs);
        let alpha_by = weights(s, self.source_alpha, inputs)[3];
        let stored_alpha_by = weights(s, self.stored_alpha, inputs)[3];
        [
            r * by[0] + stored[0] * stored_by[0],
            g * by[1] + stored[1] * stored_by[1],
            b * by[2] + stored[2] * stored_by[2],
            a * alpha_by + stored[3] * stored_alpha_by,
        ]
    }
}

/// An equation of [`CommonOver::EQUATIONS`], by its number: the compiler knows its weights.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CommonOver<const NUMBER: usize>;

impl<const NUMBER: usize> CommonOver<NUMBER> {
    /// Premultiplied alpha, alone and with egui's alpha; straight alpha.
    pub(crate) const EQUATIONS: [Over; 3] = [
        Over {
            source_color: Weight::One,
            stored_color: Weight::OneMinusSourceAlpha,
            source_alpha: Weight::One,
            stored_alpha: Weight::OneMinusSourceAlpha,
        },
        Over {
            source_color: Weight::One,
            stored_color: Weight::OneMinusSourceAlpha,
            source_alpha: Weight::OneMinusStoredAlpha,
            stored_alpha: Weight::One,
        },
        Over {
            source_color: Weight::SourceAlpha,
            stored_color: Weight::OneMinusSourceAlpha,
            source_alpha: Weight::One,
            stored_alpha: Weight::OneMinusSourceAlpha,
        },
    ];
}

impl<const NUMBER: usize> BlendKernel for CommonOver<NUMBER> {
    #[inline(always)]
    fn reads_stored(&self) -> bool {
        true
    }

    #[inline(always)]
    fn blend<S: Lanes>(self, s: S, inputs: &BlendInputs<S>) -> ColorLanes<S> {
        const { Self::EQUATIONS[NUMBER] }.blend(s, inputs)
    }
}

/// Any equation. Its many cases would burden each loop that stores colours, so a packet is blended
/// by an entry into the SIMD level of its own; that costs 4 % of a blended frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AnyBlend<'a> {
    pub(crate) level: Level,
    pub(crate) state: &'a BlendState,
    /// The blend constant, clamped to the format's range.
    pub(crate) constant: [f32; 4],
}

/// An equation that is matched for each packet.
#[derive(Debug, Clone, Copy)]
pub(crate) enum AnyEquation<'a> {
    Replace,
    Over(Over),
    Any(AnyBlend<'a>),
}

impl BlendKernel for AnyEquation<'_> {
    #[inline(always)]
    fn reads_stored(&self) -> bool {
        !matches!(self, Self::Replace)
    }

    #[inline(always)]
    fn blend<S: Lanes>(self, s: S, inputs: &BlendInputs<S>) -> ColorLanes<S> {
        match self {
            Self::Replace => inputs.source,
            Self::Over(over) => over.blend(s, inputs),
            Self::Any(any) => any.blend(s, inputs),
        }
    }
}

/// [`BlendInputs`] in memory.
struct StoredInputs {
    source: [[f32; LANES]; 4],
    second: [[f32; LANES]; 4],
    stored: [[f32; LANES]; 4],
}

impl BlendKernel for AnyBlend<'_> {
    #[inline(always)]
    fn reads_stored(&self) -> bool {
        true
    }

    #[inline(always)]
    fn blend<S: Lanes>(self, s: S, inputs: &BlendInputs<S>) -> ColorLanes<S> {
        let store =
            |[r, g, b, a]: ColorLanes<S>| [r.to_array(), g.to_array(), b.to_array(), a.to_array()];
        let inputs = StoredInputs {
            source: store(inputs.source),
            second: store(inputs.second),
            stored: store(inputs.stored),
        };
        let mut out = [[0.0; LANES]; 4];
        self.blend_stored(&inputs, &mut out);
        let [r, g, b, a] = &out;
        let load = |channel: &[f32; LANES]| f32x16::load_array_ref(s, channel);
        [load(r), load(g), load(b), load(a)]
    }
}

impl AnyBlend<'_> {
    fn blend_stored(&self, inputs: &StoredInputs, out: &mut [[f32; LANES]; 4]) {
        dispatch!(self.level, s => self.blend_lanes(s, inputs, out));
    }

    #[inline(always)]
    fn blend_lanes<S: Lanes>(&self, s: S, inputs: &StoredInputs, out: &mut [[f32; LANES]; 4]) {
        let load = |[r, g, b, a]: &[[f32; LANES]; 4]| {
            let load = |channel: &[f32; LANES]| f32x16::load_array_ref(s, channel);
            [load(r), load(g), load(b), load(a)]
        };
        let inputs = BlendInputs {
            source: load(&inputs.source),
            second: load(&inputs.second),
            stored: load(&inputs.stored),
        };
        for (channel, out) in out.iter_mut().enumerate() {
            let component = if channel == 3 {
                &self.state.alpha
            } else {
                &self.state.color
            };
            self.component(s, &inputs, component, channel)
                .store_array(out);
        }
    }

    #[inline(always)]
    fn component<S: Lanes>(
        &self,
        s: S,
        inputs: &BlendInputs<S>,
        component: &BlendComponent,
        channel: usize,
    ) -> f32x16<S> {
        let (source, stored) = (inputs.source[channel], inputs.stored[channel]);
        let by_source = source * self.factor(s, inputs, component.src_factor, channel);
        let by_stored = stored * self.factor(s, inputs, component.dst_factor, channel);
        match component.operation {
            BlendOperation::Add => by_source + by_stored,
            BlendOperation::Subtract => by_source - by_stored,
            BlendOperation::ReverseSubtract => by_stored - by_source,
            BlendOperation::Min => s.min_f32(source, stored),
            BlendOperation::Max => s.max_f32(source, stored),
        }
    }

    #[inline(always)]
    fn factor<S: Lanes>(
        &self,
        s: S,
        inputs: &BlendInputs<S>,
        factor: BlendFactor,
        channel: usize,
    ) -> f32x16<S> {
        use BlendFactor as F;
        let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
        let one = splat(1.0);
        let BlendInputs {
            source,
            second,
            stored,
        } = inputs;
        match factor {
            F::Zero => splat(0.0),
            F::One => one,
            F::Src => source[channel],
            F::OneMinusSrc => one - source[channel],
            F::SrcAlpha => source[3],
            F::OneMinusSrcAlpha => one - source[3],
            F::Dst => stored[channel],
            F::OneMinusDst => one - stored[channel],
            F::DstAlpha => stored[3],
            F::OneMinusDstAlpha => one - stored[3],
            F::SrcAlphaSaturated if channel == 3 => one,
            F::SrcAlphaSaturated => s.min_f32(source[3], one - stored[3]),
            F::Constant => splat(self.constant[channel]),
            F::OneMinusConstant => splat(1.0 - self.constant[channel]),
            F::ConstantAlpha => splat(self.constant[3]),
            F::OneMinusConstantAlpha => splat(1.0 - self.constant[3]),
            F::Src1 => second[channel],
            F::OneMinusSrc1 => one - second[channel],
            F::Src1Alpha => second[3],
            F::OneMinusSrc1Alpha => one - second[3],
            // `BlendFactor` grows; a factor without code cannot pass for another.
            other => unreachable!("blend factor {other:?} has no code"),
        }
    }
}
