//! The registers of a chunk.

use super::super::batch::Run;
use super::super::compile::Code;
use super::super::instruction::{Array, Mask, MaskSlot, Scalar, Slot, Word};
use estampe_simd::{LANES, Level, Packet};
use std::cell::{Cell, RefCell};

pub(super) type Words<'a> = &'a [Cell<Packet<u32>>];
pub(super) type Masks<'a> = &'a [Cell<u16>];

/// What instructions act on.
pub(super) struct State<'a> {
    pub(super) code: &'a Code,
    pub(super) run: &'a Run<'a>,
    pub(super) level: Level,
    pub(super) words: Words<'a>,
    pub(super) masks: Masks<'a>,
    pub(super) scalars: &'a [Cell<u32>],
    pub(super) locals: Words<'a>,
    pub(super) workgroup: &'a [Cell<u32>],
    pub(super) texture: &'a RefCell<(Vec<Packet<u32>>, Vec<u16>)>,
    /// The packets of a register.
    pub(super) stride: usize,
    /// The first packet of the chunk in the run.
    pub(super) first: usize,
    /// The packets of the chunk: at most `stride`.
    pub(super) count: usize,
}

/// A word in each lane.
#[derive(Clone, Copy)]
pub(super) enum Operand<'a> {
    Many(Words<'a>),
    One(u32),
}

/// A mask.
#[derive(Clone, Copy)]
pub(super) enum MaskOperand<'a> {
    Many(Masks<'a>),
    One(u16),
}

impl<'a> State<'a> {
    #[inline(always)]
    pub(super) fn slot(&self, slot: Slot) -> Words<'a> {
        &self.words[slot.0 as usize * self.stride..][..self.count]
    }

    #[inline(always)]
    pub(super) fn mask_slot(&self, slot: MaskSlot) -> Masks<'a> {
        &self.masks[slot.0 as usize * self.stride..][..self.count]
    }

    #[inline(always)]
    pub(super) fn scalar_of(&self, scalar: Scalar) -> u32 {
        self.scalars[scalar.0 as usize].get()
    }

    #[inline(always)]
    pub(super) fn word(&self, word: Word) -> Operand<'a> {
        match word {
            Word::Slot(slot) => Operand::Many(self.slot(slot)),
            Word::Scalar(scalar) => Operand::One(self.scalar_of(scalar)),
        }
    }

    #[inline(always)]
    pub(super) fn words_of(&self, [a, b]: [Word; 2]) -> [Operand<'a>; 2] {
        [self.word(a), self.word(b)]
    }

    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "all bits of a mask are equal"
    )]
    pub(super) fn mask(&self, mask: Mask) -> MaskOperand<'a> {
        match mask {
            Mask::Slot(slot) => MaskOperand::Many(self.mask_slot(slot)),
            Mask::Scalar(scalar) => MaskOperand::One(self.scalar_of(scalar) as u16),
        }
    }

    /// True if a lane of the mask is set.
    #[inline(always)]
    pub(super) fn any(&self, mask: Mask) -> bool {
        match self.mask(mask) {
            MaskOperand::Many(bits) => bits.iter().fold(0, |all, bits| all | bits.get()) != 0,
            MaskOperand::One(bits) => bits != 0,
        }
    }

    /// The words of an array, one after the other, each of all packets.
    pub(super) fn array(&self, array: Array) -> Words<'a> {
        &self.locals[array.first as usize * self.stride..][..array.words as usize * self.stride]
    }

    /// Gives all arrays their words at the start.
    pub(super) fn reset_locals(&self) {
        let places = self.locals.chunks_exact(self.stride);
        for (place, &word) in places.zip(&self.code.locals) {
            place.iter().for_each(|to| to.set(Packet([word; LANES])));
        }
    }
}

impl Operand<'_> {
    /// The words of a packet.
    #[inline(always)]
    pub(super) fn packet(&self, packet: usize) -> [u32; LANES] {
        match self {
            Self::Many(words) => words[packet].get().0,
            Self::One(word) => [*word; LANES],
        }
    }
}

impl MaskOperand<'_> {
    /// The bits of a packet.
    #[inline(always)]
    pub(super) fn packet(&self, packet: usize) -> u16 {
        match self {
            Self::Many(bits) => bits[packet].get(),
            Self::One(bits) => *bits,
        }
    }
}

/// All lanes of the quads in which a lane is set.
#[inline(always)]
pub(super) fn quads_with_any(bits: u16) -> u16 {
    let pairs = bits | bits >> 1;
    ((pairs | pairs >> 2) & 0x1111) * 0xF
}

/// All lanes of the quads in which all lanes are set.
#[inline(always)]
pub(super) fn quads_with_all(bits: u16) -> u16 {
    let pairs = bits & bits >> 1;
    (pairs & pairs >> 2 & 0x1111) * 0xF
}
