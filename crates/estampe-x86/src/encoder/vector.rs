//! VEX and EVEX prefixes.

use super::vector_op::Tuple;
use super::{Address, Assembler, Base, VectorOp, text};

/// The length of vectors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Length {
    /// xmm
    L128,
    /// ymm
    L256,
    /// zmm
    L512,
}

impl Length {
    /// The bytes of a vector.
    pub(crate) fn bytes(self) -> i32 {
        match self {
            Self::L128 => 16,
            Self::L256 => 32,
            Self::L512 => 64,
        }
    }
}

/// The operand that may be in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Rm {
    /// A register of the kind that the instruction has here.
    Register(u8),
    /// A place in memory.
    Memory(Address),
}

/// A vector or mask-register instruction with its operands. Registers are numbers, of the kind that
/// the instruction has in that place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct VectorInstruction {
    pub(crate) op: &'static VectorOp,
    /// True for an EVEX prefix.
    pub(crate) is_evex: bool,
    pub(crate) length: Length,
    /// ModRM.reg.
    pub(crate) reg: u8,
    /// The operand in the prefix, 0 where there is none.
    pub(crate) vvvv: u8,
    pub(crate) rm: Rm,
    /// The mask register, or 0 for all lanes. EVEX only.
    pub(crate) mask: u8,
    pub(crate) immediate: Option<u8>,
}

impl Assembler {
    /// Encodes a vector or mask-register instruction.
    pub(crate) fn vector(&mut self, instruction: &VectorInstruction) {
        self.note(|| text::vector(instruction));
        let VectorInstruction { op, rm, .. } = *instruction;
        let reg = op.digit.unwrap_or(instruction.reg);
        let scale = if instruction.is_evex {
            self.evex(instruction, reg);
            scale_of(op.tuple, rm, instruction.length)
        } else {
            self.vex(instruction, reg);
            1
        };
        self.byte(op.opcode);
        match rm {
            Rm::Register(rm) => self.modrm_register(reg, rm),
            Rm::Memory(address) => {
                let trailing = usize::from(instruction.immediate.is_some());
                self.modrm_memory(reg, address, scale, trailing);
            }
        }
        if let Some(immediate) = instruction.immediate {
            self.byte(immediate);
        }
    }

    fn vex(&mut self, instruction: &VectorInstruction, reg: u8) {
        let VectorInstruction { op, .. } = *instruction;
        let (x, b) = extension(instruction.rm);
        debug_assert!(op.vex_w.is_some(), "{} has no VEX form", op.name);
        let w = op.vex_w == Some(true);
        let l = op
            .fixed_length
            .unwrap_or(instruction.length != Length::L128);
        let last = (!instruction.vvvv & 15) << 3 | u8::from(l) << 2 | op.prefix;
        let r = reg >> 3 & 1;
        if x == 0 && b == 0 && !w && op.map == 1 {
            self.bytes.extend([0xC5, (r ^ 1) << 7 | last]);
        } else {
            let second = (r ^ 1) << 7 | (x & 1 ^ 1) << 6 | (b & 1 ^ 1) << 5 | op.map;
            self.bytes.extend([0xC4, second, u8::from(w) << 7 | last]);
        }
    }

    fn evex(&mut self, instruction: &VectorInstruction, reg: u8) {
        let VectorInstruction { op, vvvv, .. } = *instruction;
        debug_assert!(op.evex_w.is_some(), "{} has no EVEX form", op.name);
        let (x, b) = extension(instruction.rm);
        // Between registers the broadcast bit sets the rounding, which stands in the place of the
        // length: 2 is up, as is that of 512 bits.
        let (bit_b, index) = match instruction.rm {
            Rm::Register(_) => (op.rounds_up, None),
            Rm::Memory(address) => (address.is_broadcast, address.index),
        };
        debug_assert!(
            !op.rounds_up || (instruction.length, index) == (Length::L512, None),
            "{} rounds 512 bits in registers",
            op.name
        );
        // The fifth bit of an index of a gather stands in the place of that of vvvv.
        let v_high = index.map_or(vvvv >> 4 & 1, |index| index >> 4 & 1);
        let first = (reg >> 3 & 1 ^ 1) << 7 | (x & 1 ^ 1) << 6 | (b & 1 ^ 1) << 5;
        let first = first | (reg >> 4 & 1 ^ 1) << 4 | op.map;
        let w = op.evex_w == Some(true);
        let second = u8::from(w) << 7 | (!vvvv & 15) << 3 | 1 << 2 | op.prefix;
        let length = match (op.fixed_length, instruction.length) {
            (Some(_), _) | (None, Length::L128) => 0,
            (None, Length::L256) => 1,
            (None, Length::L512) => 2,
        };
        let third = length << 5 | u8::from(bit_b) << 4 | (v_high ^ 1) << 3;
        self.bytes
            .extend([0x62, first, second, third | instruction.mask]);
    }
}

/// The bits X and B: the fourth and, of registers, the fifth bit of what ModRM.rm and SIB name.
fn extension(rm: Rm) -> (u8, u8) {
    match rm {
        Rm::Register(rm) => (rm >> 4 & 1, rm >> 3 & 1),
        Rm::Memory(address) => {
            let base = match address.base {
                Base::Gpr(base) => base.0 >> 3,
                Base::Pool => 0,
            };
            (address.index.map_or(0, |index| index >> 3 & 1), base)
        }
    }
}

fn scale_of(tuple: Tuple, rm: Rm, length: Length) -> i32 {
    let is_broadcast = matches!(rm, Rm::Memory(address) if address.is_broadcast);
    match tuple {
        Tuple::Full(element) if is_broadcast => element,
        Tuple::Full(_) => length.bytes(),
        Tuple::Bytes(bytes) => bytes,
    }
}
