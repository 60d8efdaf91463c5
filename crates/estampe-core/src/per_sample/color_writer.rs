//! The way of colours into attachments: blending (O5) or a logic operation (O6), write masks (O7),
//! encoding (O8).
//!
//! *In* a batch of shaded packets · *Out* one colour attachment · *Precision* f32, the format's
//! rounding · *Spec* WebGPU §Blend State; Vulkan §Blending, §Logical Operations.
//!
//! A batch is written packet by packet, in order, because later packets may lie on earlier ones.
//! The loop is compiled for RGBA8 and BGRA8 that replace or blend by a sum of common weights, three
//! times for the commonest of these, for four half floats that do either, and once for everything
//! else: there the format and the equation are matched for each packet, which costs a predicted
//! branch. A copy of the loop for each of ten families of formats and three kinds of equations was
//! five times as much code and took the compiler a minute.

use super::blend::{
    AnyBlend, AnyEquation, BlendInputs, BlendKernel, ColorLanes, CommonOver, Replace,
};
use super::logic::combine;
use crate::fragment::place::{PacketLayout, Place};
use crate::fragment::queue::ShadedBatch;
use crate::pipeline::color_target::{ColorTarget, Equation, MAX_WORDS};
use estampe_format::attachment::Family;
use estampe_format::{AttachmentCodec, PacketCodec, with_codec};
use estampe_simd::{
    LANES, Lanes, Level, Packet, Select, SimdBase, dispatch, f32x16, outline, u32x16,
};

/// The way of colours into one attachment.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ColorWriter<'a> {
    pub(crate) target: &'a ColorTarget,
    /// The target's number.
    pub(crate) index: usize,
    /// The draw's blend constant.
    pub(crate) constant: [f32; 4],
}

impl ColorWriter<'_> {
    /// Writes a batch of shaded packets.
    pub(crate) fn write_batch(
        &self,
        level: Level,
        batch: &ShadedBatch<'_>,
        stored: &mut [[u32; LANES]],
    ) {
        dispatch!(level, s => self.write_lanes(s, level, batch, stored));
    }

    #[inline(always)]
    fn write_lanes<S: Lanes>(
        &self,
        s: S,
        level: Level,
        batch: &ShadedBatch<'_>,
        stored: &mut [[u32; LANES]],
    ) {
        match (self.target.codec.family(), &self.target.equation) {
            (Family::Rgba8(codec), Equation::Replace) if const { !S::IS_SCALAR } => {
                self.by(Common(codec)).write(s, Replace, batch, stored);
            }
            (Family::Rgba8(codec), Equation::Over(over)) if const { !S::IS_SCALAR } => {
                let target = self.by(Common(codec));
                let mut common = CommonOver::<0>::EQUATIONS.iter();
                match common.position(|equation| equation == over) {
                    Some(0) => target.write(s, CommonOver::<0>, batch, stored),
                    Some(1) => target.write(s, CommonOver::<1>, batch, stored),
                    Some(2) => target.write(s, CommonOver::<2>, batch, stored),
                    _ => target.write(s, *over, batch, stored),
                }
            }
            (Family::Half2(codec), Equation::Replace) if const { !S::IS_SCALAR } => {
                self.by(Common(codec)).write(s, Replace, batch, stored);
            }
            (Family::Half2(codec), Equation::Over(over)) if const { !S::IS_SCALAR } => {
                self.by(Common(codec)).write(s, *over, batch, stored);
            }
            (_, equation) => {
                let codec = self.target.codec;
                let constant = [
                    clamp_one(self.constant[0], codec.range()),
                    clamp_one(self.constant[1], codec.range()),
                    clamp_one(self.constant[2], codec.range()),
                    clamp_one(self.constant[3], codec.range()),
                ];
                let kernel = match equation {
                    Equation::Replace => AnyEquation::Replace,
                    Equation::Over(over) => AnyEquation::Over(*over),
                    Equation::Any(state) => AnyEquation::Any(AnyBlend {
                        level,
                        state,
                        constant,
                    }),
                };
                self.by(codec).write(s, kernel, batch, stored);
            }
        }
    }

    /// The target, whose texels are accessed by a codec.
    #[inline(always)]
    fn by<A>(&self, codec: A) -> Target<'_, A> {
        Target {
            writer: self.target,
            codec,
            index: self.index,
        }
    }

    /// Appends the words of each packet's texels.
    pub(crate) fn encode_batch(
        &self,
        level: Level,
        batch: &ShadedBatch<'_>,
        texels: &mut Vec<[u32; LANES]>,
    ) {
        dispatch!(level, s => self.encode_lanes(s, batch, texels));
    }

    #[inline(always)]
    fn encode_lanes<S: Lanes>(
        &self,
        s: S,
        batch: &ShadedBatch<'_>,
        texels: &mut Vec<[u32; LANES]>,
    ) {
        let words = AttachmentCodec::words(&self.target.codec);
        for packet in batch.packets() {
            let texel =
                TexelAccess::encode(self.target.codec, s, load(s, packet.color(self.index)));
            for word in texel.iter().take(words) {
                texels.push(word.to_array());
            }
        }
    }
}

/// Sixteen texels of a format, between words and numbers.
trait TexelAccess<S: Lanes>: Copy {
    /// Words of a texel.
    fn words(self) -> usize;
    fn decode(self, s: S, words: [u32x16<S>; MAX_WORDS]) -> ColorLanes<S>;
    fn encode(self, s: S, color: ColorLanes<S>) -> [u32x16<S>; MAX_WORDS];
}

/// A codec that the compiler knows.
#[derive(Clone, Copy)]
struct Common<C>(C);

impl<S: Lanes, C: PacketCodec<S>> TexelAccess<S> for Common<C> {
    #[inline(always)]
    fn words(self) -> usize {
        C::WORDS
    }
    #[inline(always)]
    fn decode(self, s: S, words: [u32x16<S>; MAX_WORDS]) -> ColorLanes<S> {
        self.0.decode(s, words)
    }
    #[inline(always)]
    fn encode(self, s: S, color: ColorLanes<S>) -> [u32x16<S>; MAX_WORDS] {
        self.0.encode(s, color)
    }
}

impl<S: Lanes> TexelAccess<S> for AttachmentCodec {
    #[inline(always)]
    fn words(self) -> usize {
        Self::words(&self)
    }
    #[inline(always)]
    fn decode(self, s: S, words: [u32x16<S>; MAX_WORDS]) -> ColorLanes<S> {
        outline!(s, with_codec!(self, codec => codec.decode(s, words)))
    }
    #[inline(always)]
    fn encode(self, s: S, color: ColorLanes<S>) -> [u32x16<S>; MAX_WORDS] {
        outline!(s, with_codec!(self, codec => codec.encode(s, color)))
    }
}

/// A target of a batch.
struct Target<'a, C> {
    writer: &'a ColorTarget,
    codec: C,
    index: usize,
}

impl<C: Copy> Target<'_, C> {
    #[inline(always)]
    fn write<S: Lanes, K: BlendKernel>(
        &self,
        s: S,
        kernel: K,
        batch: &ShadedBatch<'_>,
        stored: &mut [[u32; LANES]],
    ) where
        C: TexelAccess<S>,
    {
        let layout = PacketLayout {
            samples: batch.samples,
            words: self.codec.words(),
        };
        let range = self.writer.codec.range();
        let zero = <u32x16<S> as SimdBase<S>>::splat(s, 0);
        let reads_stored = kernel.reads_stored() || self.combines_words();
        let nothing: ColorLanes<S> = [SimdBase::splat(s, 0.0); 4];
        let mut inputs = BlendInputs {
            source: nothing,
            second: nothing,
            stored: nothing,
        };
        let mut shaded = None;
        let replaces = const { K::REPLACES } && batch.samples == 1 && !reads_stored;
        let replaces_words = const { K::REPLACES } && layout.words == 1 && !reads_stored;
        for packet in batch.packets() {
            if replaces && let (&Place::Packet(at), &[mask]) = (packet.place, packet.masks) {
                let texel = self.codec.encode(s, load(s, packet.color(self.index)));
                let line = layout.line(usize::from(at), 0, 0);
                replace_texels(s, &mut stored[line..][..layout.words], texel, mask);
                continue;
            }
            // Packets of one colour follow each other.
            if shaded != Some(packet.shaded) {
                shaded = Some(packet.shaded);
                inputs.source = load(s, packet.color(self.index));
                if kernel.reads_stored() {
                    inputs.source = clamp(s, inputs.source, range);
                    if let Some(second) = packet.second() {
                        inputs.second = clamp(s, load(s, second), range);
                    }
                }
            }
            let indices = packet.place.indices(s, layout);
            if let (true, Place::Pixels(_), &[a, b, c, d]) =
                (replaces_words, packet.place, packet.masks)
            {
                let [texel, ..] = self.codec.encode(s, inputs.source);
                outline!(s, {
                    let stored = stored.as_flattened_mut();
                    s.scatter_to_four_lines(stored, indices, texel, [a, b, c, d]);
                });
                continue;
            }
            let mut encoded = None;
            for (sample, &mask) in packet.masks.iter().enumerate() {
                if mask == 0 {
                    continue;
                }
                let mut old = [zero; MAX_WORDS];
                if reads_stored {
                    old = packet.place.load(s, stored, (layout, sample), indices);
                }
                // All samples are replaced by the same texel.
                let mut new = match encoded {
                    Some(words) if !kernel.reads_stored() => words,
                    _ => {
                        if kernel.reads_stored() {
                            inputs.stored = self.codec.decode(s, old);
                        }
                        self.codec.encode(s, kernel.blend(s, &inputs))
                    }
                };
                encoded = Some(new);
                self.mask_words(s, &mut new, &old);
                let texels = (&new, mask);
                packet
                    .place
                    .store(s, texels, stored, (layout, sample), indices);
            }
        }
    }

    /// Returns true if stored words are combined with new ones after blending.
    #[inline(always)]
    fn combines_words(&self) -> bool {
        self.writer.logic.is_some() || !self.writer.writes_all
    }

    /// Applies the logic operation and the write mask. Both work bit by bit, so they need no
    /// channels.
    #[inline(always)]
    fn mask_words<S: Lanes>(
        &self,
        s: S,
        new: &mut [u32x16<S>; MAX_WORDS],
        old: &[u32x16<S>; MAX_WORDS],
    ) {
        if !self.combines_words() {
            return;
        }
        for (word, (new, old)) in new.iter_mut().zip(old).enumerate() {
            if let Some(operation) = self.writer.logic {
                *new = combine(operation, *new, *old);
            }
            let writable = <u32x16<S> as SimdBase<S>>::splat(s, self.writer.writable[word]);
            *new = (*new & writable) | (*old & !writable);
        }
    }
}

/// Stores the words of texels in the lanes of a mask of a packet.
#[inline(always)]
fn replace_texels<S: Lanes>(
    s: S,
    lines: &mut [[u32; LANES]],
    texels: [u32x16<S>; MAX_WORDS],
    mask: u16,
) {
    // Where a packet is two registers, a mask takes longer than the branch without one.
    if const { S::REGISTERS > 1 } && mask == u16::MAX {
        for (line, texel) in lines.iter_mut().zip(texels) {
            texel.store_array(line);
        }
        return;
    }
    let mask = s.mask_from_bits(mask);
    for (line, texel) in lines.iter_mut().zip(texels) {
        let old = u32x16::load_array_ref(s, line);
        mask.select(texel, old).store_array(line);
    }
}

#[inline(always)]
pub(super) fn load<S: Lanes>(s: S, color: &[Packet<f32>; 4]) -> ColorLanes<S> {
    let load = |packet: &Packet<f32>| f32x16::load_array_ref(s, &packet.0);
    let [r, g, b, a] = color;
    [load(r), load(g), load(b), load(a)]
}

/// Colours in a format's range; NaN is 0.
#[inline(always)]
pub(super) fn clamp<S: Lanes>(
    s: S,
    color: ColorLanes<S>,
    range: Option<[f32; 2]>,
) -> ColorLanes<S> {
    let Some([low, high]) = range else {
        return color;
    };
    let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
    let mut clamped = color;
    for value in &mut clamped {
        // The maximum with 0 is 0 where the other operand is NaN; with a negative number it is that
        // number.
        let number = if low < 0.0 {
            value.simd_eq(*value).select(*value, splat(0.0))
        } else {
            *value
        };
        *value = s.min_f32(s.max_f32(number, splat(low)), splat(high));
    }
    clamped
}

/// A number in a format's range; NaN is 0.
fn clamp_one(value: f32, range: Option<[f32; 2]>) -> f32 {
    let Some([low, high]) = range else {
        return value;
    };
    let value = if value.is_nan() { 0.0 } else { value };
    let above = if value > low { value } else { low };
    if above < high { above } else { high }
}
