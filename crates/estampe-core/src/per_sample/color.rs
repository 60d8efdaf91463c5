//! Blending (O5), sRGB targets (O8) and write masks (O7): colours into attachments.
//!
//! *Spec* WebGPU §Blend state; Vulkan §Blending. Colours are f32; the stored value is decoded, the
//! products are rounded one by one, the result is encoded.

use super::codes::{pack, pack_one, saturate, unpack};
use estampe_simd::{LANES, Lanes, Level, Packet, Select, SimdBase, dispatch, f32x16, u32x16};
use estampe_types::state::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, ColorWrites,
};

/// A colour target's state, reduced to what selects code.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ColorTarget {
    blend: Option<BlendState>,
    is_srgb: bool,
    /// The bits of a pixel that may change.
    writable: u32,
    constant: [f32; 4],
}

impl ColorTarget {
    pub(crate) fn new(state: &ColorTargetState, constant: [f32; 4]) -> Self {
        let ColorWrites(mask) = state.write_mask;
        let channel = |bit: u32| {
            if mask >> bit & 1 == 1 {
                0xFF << (bit * 8)
            } else {
                0
            }
        };
        Self {
            // Replacing is not blending.
            blend: state.blend.filter(|blend| *blend != BlendState::default()),
            is_srgb: state.format.is_srgb(),
            writable: channel(0) | channel(1) | channel(2) | channel(3),
            constant,
        }
    }

    /// Whether every channel is replaced.
    #[inline(always)]
    pub(crate) fn replaces(&self) -> bool {
        self.blend.is_none() && self.writable == u32::MAX
    }

    /// Whether colours are blended *over* unorm8, all channels written.
    #[inline(always)]
    pub(crate) fn is_source_over(&self) -> bool {
        self.blend == Some(BlendState::ALPHA_BLENDING) && !self.is_srgb && self.writable == u32::MAX
    }

    /// Whether R, G, B are stored by the sRGB curve.
    #[inline(always)]
    pub(crate) fn is_srgb(&self) -> bool {
        self.is_srgb
    }

    /// The code of one colour, where it replaces.
    pub(crate) fn code(&self, rgba: [f32; 4]) -> u32 {
        pack_one(rgba, self.is_srgb)
    }

    /// Writes a shaded packet to one sample's sixteen pixels, those of the mask.
    #[inline(always)]
    pub(crate) fn write<S: Lanes>(
        &self,
        s: S,
        level: Level,
        colors: &[Packet<f32>],
        mask: u16,
        stored: &mut [u32; LANES],
    ) {
        let [r, g, b, a] = colors else {
            return;
        };
        let load = |packet: &Packet<f32>| f32x16::load_array_ref(s, &packet.0);
        let source = [load(r), load(g), load(b), load(a)];
        let old = u32x16::load_array_ref(s, stored);
        let color = match &self.blend {
            None => source,
            Some(blend) if *blend == BlendState::ALPHA_BLENDING => {
                let source = saturated(s, source);
                let stored = unpack(s, old, self.is_srgb);
                Inputs {
                    source,
                    stored,
                    constant: self.constant,
                }
                .source_over(s)
            }
            Some(blend) => {
                let mut channels = [r.0, g.0, b.0, a.0];
                self.blend_any(level, blend, &mut channels, stored);
                let [r, g, b, a] = &channels;
                let load = |channel: &[f32; LANES]| f32x16::load_array_ref(s, channel);
                [load(r), load(g), load(b), load(a)]
            }
        };
        let mut new = pack(s, color, self.is_srgb);
        if self.writable != u32::MAX {
            let writable = <u32x16<S> as SimdBase<S>>::splat(s, self.writable);
            new = (new & writable) | (old & !writable);
        }
        s.mask_from_bits(mask).select(new, old).store_array(stored);
    }

    /// Blending by any factors and operations: its own entry into the level, because the many cases
    /// would burden every caller's code.
    fn blend_any(
        &self,
        level: Level,
        blend: &BlendState,
        channels: &mut [[f32; LANES]; 4],
        stored: &[u32; LANES],
    ) {
        dispatch!(level, s => self.blend_lanes(s, blend, channels, stored));
    }

    #[inline(always)]
    fn blend_lanes<S: Lanes>(
        &self,
        s: S,
        blend: &BlendState,
        channels: &mut [[f32; LANES]; 4],
        stored: &[u32; LANES],
    ) {
        let load = |channel: usize| f32x16::load_array(s, channels[channel]);
        let inputs = Inputs {
            source: saturated(s, [load(0), load(1), load(2), load(3)]),
            stored: unpack(s, u32x16::load_array_ref(s, stored), self.is_srgb),
            constant: self.constant,
        };
        for (channel, out) in channels.iter_mut().enumerate() {
            let component = if channel == 3 {
                &blend.alpha
            } else {
                &blend.color
            };
            inputs.component(s, component, channel).store_array(out);
        }
    }
}

/// Each channel confined to 0..=1.
#[inline(always)]
fn saturated<S: Lanes>(s: S, [r, g, b, a]: [f32x16<S>; 4]) -> [f32x16<S>; 4] {
    [
        saturate(s, r),
        saturate(s, g),
        saturate(s, b),
        saturate(s, a),
    ]
}

/// Writes one code to the pixels of the mask.
#[inline(always)]
pub(crate) fn write_code<S: Lanes>(s: S, code: u32, mask: u16, stored: &mut [u32; LANES]) {
    let new = <u32x16<S> as SimdBase<S>>::splat(s, code);
    if mask == u16::MAX {
        new.store_array(stored);
        return;
    }
    let old = u32x16::load_array_ref(s, stored);
    s.mask_from_bits(mask).select(new, old).store_array(stored);
}

/// What blending combines.
struct Inputs<S: Lanes> {
    source: [f32x16<S>; 4],
    stored: [f32x16<S>; 4],
    constant: [f32; 4],
}

impl<S: Lanes> Inputs<S> {
    /// The common case: s·sa + d·(1 − sa) for colour, s·1 + d·(1 − sa) for alpha.
    #[inline(always)]
    fn source_over(&self, s: S) -> [f32x16<S>; 4] {
        let (source, stored) = (&self.source, &self.stored);
        let alpha = source[3];
        let rest = <f32x16<S> as SimdBase<S>>::splat(s, 1.0) - alpha;
        [
            source[0] * alpha + stored[0] * rest,
            source[1] * alpha + stored[1] * rest,
            source[2] * alpha + stored[2] * rest,
            alpha + stored[3] * rest,
        ]
    }

    #[inline(always)]
    fn component(&self, s: S, component: &BlendComponent, channel: usize) -> f32x16<S> {
        let (source, stored) = (self.source[channel], self.stored[channel]);
        let by_source = source * self.factor(s, component.src_factor, channel);
        let by_stored = stored * self.factor(s, component.dst_factor, channel);
        match component.operation {
            BlendOperation::Add => by_source + by_stored,
            BlendOperation::Subtract => by_source - by_stored,
            BlendOperation::ReverseSubtract => by_stored - by_source,
            BlendOperation::Min => s.min_f32(source, stored),
            BlendOperation::Max => s.max_f32(source, stored),
        }
    }

    #[inline(always)]
    fn factor(&self, s: S, factor: BlendFactor, channel: usize) -> f32x16<S> {
        let one = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
        let (source, stored) = (&self.source, &self.stored);
        // Unorm targets clamp the constant as they clamp the source.
        let constant = <f32x16<S> as SimdBase<S>>::splat(s, self.constant[channel]);
        let constant = saturate(s, constant);
        match factor {
            BlendFactor::Zero => SimdBase::splat(s, 0.0),
            BlendFactor::One => one,
            BlendFactor::Src => source[channel],
            BlendFactor::OneMinusSrc => one - source[channel],
            BlendFactor::SrcAlpha => source[3],
            BlendFactor::OneMinusSrcAlpha => one - source[3],
            BlendFactor::Dst => stored[channel],
            BlendFactor::OneMinusDst => one - stored[channel],
            BlendFactor::DstAlpha => stored[3],
            BlendFactor::OneMinusDstAlpha => one - stored[3],
            BlendFactor::SrcAlphaSaturated if channel == 3 => one,
            BlendFactor::SrcAlphaSaturated => s.min_f32(source[3], one - stored[3]),
            BlendFactor::Constant => constant,
            BlendFactor::OneMinusConstant => one - constant,
            // `BlendFactor` grows; a factor without code cannot pass for another.
            other => unreachable!("blend factor {other:?} has no code"),
        }
    }
}
