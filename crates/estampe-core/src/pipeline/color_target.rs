//! Colour targets: state, reduced to the facts that select code.

use estampe_format::attachment::Family;
use estampe_format::{AttachmentCodec, TexelCodec};
use estampe_types::state::{
    BlendFactor, BlendOperation, BlendState, ColorTargetState, LogicOperation,
};

/// The most words of a texel.
pub(crate) const MAX_WORDS: usize = 4;

/// A colour target's state, reduced to the facts that select code.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ColorTarget {
    /// The number of the shader's colour.
    pub(crate) output: usize,
    pub(crate) codec: AttachmentCodec,
    texel: TexelCodec,
    pub(crate) equation: Equation,
    pub(crate) logic: Option<LogicOperation>,
    /// The bits of a texel that may change.
    pub(crate) writable: [u32; MAX_WORDS],
    /// True if these are all the bits of the texel.
    pub(crate) writes_all: bool,
}

/// The kind of blending.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Equation {
    Replace,
    Over(Over),
    Any(BlendState),
}

impl Equation {
    fn new(state: &ColorTargetState, codec: AttachmentCodec) -> Self {
        let Some(blend) = state.blend else {
            return Self::Replace;
        };
        // The sum of the source and 0 times a stored colour is the source, unless that colour is
        // infinite.
        if blend == BlendState::default() && codec.range().is_some() {
            return Self::Replace;
        }
        Over::new(&blend).map_or(Self::Any(blend), Self::Over)
    }
}

impl ColorTarget {
    pub(crate) fn new(
        state: &ColorTargetState,
        output: usize,
        logic: Option<LogicOperation>,
    ) -> Self {
        let codec = AttachmentCodec::new(state.format);
        let all = writable_bits(codec, 0xF);
        let writable = writable_bits(codec, u32::from(state.write_mask.0));
        Self {
            output,
            codec,
            texel: TexelCodec::new(state.format),
            // A logic operation replaces blending, also where the format leaves it without effect.
            equation: match logic {
                Some(_) => Equation::Replace,
                None => Equation::new(state, codec),
            },
            logic: logic.filter(|_| codec.has_logic_operations()),
            writable,
            writes_all: writable == all,
        }
    }

    /// The words of one colour's texel.
    pub(crate) fn texel(&self, color: [f32; 4]) -> [u32; MAX_WORDS] {
        self.texel.encode(color)
    }

    /// Returns true if the write mask lets some bit of a texel change.
    pub(crate) fn is_written(&self) -> bool {
        self.writable != [0; MAX_WORDS]
    }

    /// Returns true if every channel of the source replaces the stored one.
    pub(crate) fn replaces(&self) -> bool {
        self.equation == Equation::Replace && self.logic.is_none() && self.writes_all
    }

    /// Returns true if colours are blended *over* 8-bit unorm texels by straight alpha and all
    /// channels are written: the state of `per_sample::source_over`.
    pub(crate) fn is_source_over(&self) -> bool {
        let over = Over::new(&BlendState::ALPHA_BLENDING).map(Equation::Over);
        Some(self.equation) == over
            && self.writes_all
            && matches!(self.codec.family(), Family::Rgba8(_))
    }
}

/// The equations of most programs: a sum whose factors are 0, 1, an alpha, one less that, or the
/// stored colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Over {
    pub(crate) source_color: Weight,
    pub(crate) stored_color: Weight,
    pub(crate) source_alpha: Weight,
    pub(crate) stored_alpha: Weight,
}

/// A factor of [`Over`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Weight {
    Zero,
    One,
    SourceAlpha,
    OneMinusSourceAlpha,
    StoredAlpha,
    OneMinusStoredAlpha,
    /// Each channel of the stored colour.
    Stored,
}

impl Weight {
    fn new(factor: BlendFactor) -> Option<Self> {
        match factor {
            BlendFactor::Zero => Some(Self::Zero),
            BlendFactor::One => Some(Self::One),
            BlendFactor::SrcAlpha => Some(Self::SourceAlpha),
            BlendFactor::OneMinusSrcAlpha => Some(Self::OneMinusSourceAlpha),
            BlendFactor::DstAlpha => Some(Self::StoredAlpha),
            BlendFactor::OneMinusDstAlpha => Some(Self::OneMinusStoredAlpha),
            BlendFactor::Dst => Some(Self::Stored),
            _ => None,
        }
    }
}

impl Over {
    /// The kernel of a state, if it is such an equation.
    pub(crate) fn new(state: &BlendState) -> Option<Self> {
        let BlendState { color, alpha } = state;
        if [color.operation, alpha.operation] != [BlendOperation::Add; 2] {
            return None;
        }
        Some(Self {
            source_color: Weight::new(color.src_factor)?,
            stored_color: Weight::new(color.dst_factor)?,
            source_alpha: Weight::new(alpha.src_factor)?,
            stored_alpha: Weight::new(alpha.dst_factor)?,
        })
    }
}

/// The bits of a texel that belong to some channels: bit `i` of `channels` is channel i.
fn writable_bits(codec: AttachmentCodec, channels: u32) -> [u32; MAX_WORDS] {
    let mut bits = [0; MAX_WORDS];
    for channel in (0..4).filter(|channel| channels >> channel & 1 == 1) {
        for (bits, of_channel) in bits.iter_mut().zip(codec.channel_bits(channel)) {
            *bits |= of_channel;
        }
    }
    bits
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_types::state::BlendComponent;

    /// The equations of user interfaces and of products of colours have the compiled kernel.
    #[test]
    fn equations_of_programs_are_sums_of_usual_weights() {
        use BlendFactor as F;
        let state = |[from, to]: [F; 2], [alpha_from, alpha_to]: [F; 2]| BlendState {
            color: BlendComponent {
                src_factor: from,
                dst_factor: to,
                ..BlendComponent::default()
            },
            alpha: BlendComponent {
                src_factor: alpha_from,
                dst_factor: alpha_to,
                ..BlendComponent::default()
            },
        };
        let egui = state([F::One, F::OneMinusSrcAlpha], [F::OneMinusDstAlpha, F::One]);
        let product = state([F::Dst, F::Zero], [F::DstAlpha, F::Zero]);
        for state in [egui, product, BlendState::ALPHA_BLENDING] {
            assert!(Over::new(&state).is_some(), "{state:?}");
        }
        assert_eq!(Over::new(&state([F::Constant, F::One], [F::One; 2])), None);
    }
}
