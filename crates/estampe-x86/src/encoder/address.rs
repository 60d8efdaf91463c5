//! Memory operands, and the ModRM and SIB bytes with their displacement.

use super::{Assembler, Gpr};

/// A place in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Address {
    pub(crate) base: Base,
    /// A vector of indices of four-byte elements, in gathers and scatters.
    pub(crate) index: Option<u8>,
    /// Bytes that are added.
    pub(crate) displacement: i32,
    /// The element is read once, for all lanes. EVEX only.
    pub(crate) is_broadcast: bool,
}

/// What an address counts from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Base {
    /// A register.
    Gpr(Gpr),
    /// The start of the pool of constants.
    Pool,
}

impl Address {
    /// `displacement` bytes after where a register points.
    pub(crate) fn at(base: Gpr, displacement: i32) -> Self {
        Self {
            base: Base::Gpr(base),
            index: None,
            displacement,
            is_broadcast: false,
        }
    }
}

impl Address {
    /// `displacement` bytes after the start of the pool.
    pub(crate) fn in_pool(displacement: i32) -> Self {
        Self {
            base: Base::Pool,
            ..Self::at(Gpr::RAX, displacement)
        }
    }
}

impl Assembler {
    /// ModRM of two registers, of which the low three bits are used.
    pub(super) fn modrm_register(&mut self, reg: u8, rm: u8) {
        self.byte(0xC0 | (reg & 7) << 3 | rm & 7);
    }

    /// ModRM of a place that is named by its distance from the end of the instruction.
    pub(super) fn modrm_relative(&mut self, reg: u8) {
        self.byte((reg & 7) << 3 | 0b101);
    }

    /// ModRM, SIB and displacement of a memory operand. A displacement of eight bits counts in
    /// multiples of `scale`; `trailing` bytes of the instruction follow.
    pub(super) fn modrm_memory(&mut self, reg: u8, address: Address, scale: i32, trailing: usize) {
        let base = match address.base {
            Base::Gpr(base) => base.0 & 7,
            Base::Pool => {
                self.modrm_relative(reg);
                let offset = u32::try_from(address.displacement).unwrap_or(0);
                self.distance_to_pool(offset, trailing);
                return;
            }
        };
        let reg = (reg & 7) << 3;
        let displacement = address.displacement;
        let short = (displacement % scale == 0)
            .then(|| i8::try_from(displacement / scale).ok())
            .flatten();
        // The base rbp or r13 without displacement has another meaning.
        let mode = match short {
            Some(0) if base != 0b101 => 0b00,
            Some(_) => 0b01,
            None => 0b10,
        };
        let needs_sib = address.index.is_some() || base == 0b100;
        self.byte(mode << 6 | reg | if needs_sib { 0b100 } else { base });
        if needs_sib {
            let index = address.index.map_or(0b100, |index| index & 7);
            let scale = if address.index.is_some() { 0b10 } else { 0b00 };
            self.byte(scale << 6 | index << 3 | base);
        }
        match (mode, short) {
            (0b00, _) => {}
            (0b01, Some(short)) => self.byte(short.cast_unsigned()),
            _ => self.dword(displacement.cast_unsigned()),
        }
    }
}
