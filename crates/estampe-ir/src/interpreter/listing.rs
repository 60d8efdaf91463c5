//! Bytecode as text, for people who read it.
//!
//! `r` are registers of words, `m` of masks, and `s` are scalars: what is the same in all lanes.
//! An instruction names its operation, then its result, then its operands; numbers after `Jump` and
//! `Branch` are those of instructions. Inputs, outputs and buffers are numbers in the interface.

use super::compile::{Chunk, Code};
use super::instruction::{Mask, MaskSlot, Scalar, Slot, Word};
use std::fmt::{Debug, Display, Formatter, Result};

impl Display for Code {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self.chunk {
            Chunk::Packets(packets) => writeln!(f, "chunks of {packets} packets")?,
            Chunk::Workgroup => writeln!(f, "chunks of a packet, which wait at barriers")?,
        }
        let (words, masks) = (self.slots, self.mask_slots);
        writeln!(f, "registers: {words} of words, {masks} of masks")?;
        for (at, &word) in self.scalars.iter().enumerate() {
            if word != 0 {
                writeln!(f, "s{at} = {word:#010x} ({:?})", f32::from_bits(word))?;
            }
        }
        for (at, words) in self.tables.iter().enumerate() {
            writeln!(f, "table {at}: {} words", words.len())?;
        }
        if !self.preamble.is_empty() {
            writeln!(f, "once a run:")?;
            for (to, op) in &self.preamble {
                writeln!(f, "      {to:?} = {op:?}")?;
            }
        }
        writeln!(f, "for each chunk:")?;
        for (at, (_, instruction)) in self.instructions.iter().enumerate() {
            writeln!(f, "{at:>4}  {instruction:?}")?;
        }
        Ok(())
    }
}

impl Debug for Slot {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "r{}", self.0)
    }
}

impl Debug for MaskSlot {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "m{}", self.0)
    }
}

impl Debug for Scalar {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "s{}", self.0)
    }
}

impl Debug for Word {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Slot(slot) => Debug::fmt(slot, f),
            Self::Scalar(scalar) => Debug::fmt(scalar, f),
        }
    }
}

impl Debug for Mask {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Slot(slot) => Debug::fmt(slot, f),
            Self::Scalar(scalar) => Debug::fmt(scalar, f),
        }
    }
}
