//! A colour target of any format: blending or a logic operation, write masks, encoding.

use super::blend::Inputs;
use super::logic::combine;
use crate::per_sample::texel::{Codes, Numbers, TexelCodec};
use estampe_simd::LANES;
use estampe_types::state::{BlendState, ColorTargetState, LogicOperation};

/// One colour target of a draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct GeneralTarget {
    codec: TexelCodec,
    blend: Option<BlendState>,
    logic: Option<LogicOperation>,
    /// By channel the bits that may change.
    writable: [u32; 4],
    /// The blend constant, confined to the format's range.
    constant: [f32; 4],
}

impl GeneralTarget {
    pub(crate) fn new(
        state: &ColorTargetState,
        logic: Option<LogicOperation>,
        constant: [f32; 4],
    ) -> Self {
        let codec = TexelCodec::new(state.format);
        let channel = |channel: usize| {
            if state.write_mask.0 >> channel & 1 == 1 {
                u32::MAX
            } else {
                0
            }
        };
        let constant = constant.map(|value| confined(value, codec.range()));
        Self {
            codec,
            // A logic operation replaces blending, also where the format leaves it without effect.
            blend: state.blend.filter(|_| logic.is_none()),
            logic: logic.filter(|_| codec.has_logic()),
            writable: [0, 1, 2, 3].map(channel),
            constant,
        }
    }

    /// Whether the format is one of integers.
    pub(crate) fn is_integer(&self) -> bool {
        self.codec.is_integer()
    }

    /// Words of a texel.
    pub(crate) fn words(&self) -> usize {
        self.codec.words
    }

    /// Writes a packet's colours to one sample's texels, in the lanes of the mask. `stored` has sixteen of each of
    /// the texel's words.
    #[inline(always)]
    pub(crate) fn write(&self, source: &Numbers, second: &Numbers, lanes: u16, stored: &mut [u32]) {
        let codec = &self.codec;
        let old = codec.unpack(&codec.words_of(stored));
        let mut new = match &self.blend {
            None => codec.encode(source),
            Some(blend) => {
                let range = codec.range();
                let inputs = Inputs {
                    source: &confined_all(source, range),
                    second: &confined_all(second, range),
                    stored: &codec.decode(&old),
                    constant: self.constant,
                };
                codec.encode(&inputs.blend(blend))
            }
        };
        if let Some(operation) = self.logic {
            for (new, old) in new.as_flattened_mut().iter_mut().zip(old.as_flattened()) {
                *new = combine(operation, *new, *old);
            }
        }
        self.keep_masked(&mut new, &old, lanes);
        let words = codec.pack(&new);
        for (to, from) in stored.as_chunks_mut::<LANES>().0.iter_mut().zip(&words) {
            *to = *from;
        }
    }

    /// Puts the old codes back where nothing may change.
    #[inline(always)]
    fn keep_masked(&self, new: &mut Codes, old: &Codes, lanes: u16) {
        for ((new, old), writable) in new.iter_mut().zip(old).zip(self.writable) {
            for (lane, (new, old)) in new.iter_mut().zip(old).enumerate() {
                let mask = if lanes >> lane & 1 == 1 { writable } else { 0 };
                *new = *new & mask | *old & !mask;
            }
        }
    }
}

#[inline(always)]
fn confined_all(colors: &Numbers, range: Option<[f32; 2]>) -> Numbers {
    let mut out = *colors;
    if range.is_some() {
        for value in out.as_flattened_mut() {
            *value = confined(*value, range);
        }
    }
    out
}

/// A number in a range; NaN is 0 or the range's lower end, whichever is greater.
#[inline(always)]
fn confined(value: f32, range: Option<[f32; 2]>) -> f32 {
    let Some([low, high]) = range else {
        return value;
    };
    let value = if value.is_nan() { 0.0 } else { value };
    let above = if value > low { value } else { low };
    if above < high { above } else { high }
}
