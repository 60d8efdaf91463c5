//! Comparisons and operations on masks.
//!
//! A mask is a mask register (AVX-512), or a vector with all or no bits of a lane (AVX2).

use super::operands::{Operands, Source};
use super::{Place, Selector};
use crate::Isa;
use crate::encoder::{VectorOp, vector_op};
use crate::frame::displacement;
use crate::machine::{GPR, Instruction, MASK, Memory, MemoryBase, Role, VECTOR};
use estampe_ir::Value;
use estampe_ir::op::{Compare, MaskBinary};
use regalloc2::{Operand, VReg};

/// Predicates of `vcmpps` that do not signal: equal, less, less or equal, not equal or unordered,
/// greater or equal, ordered, unordered.
pub(super) const EQUAL: u8 = 0x00;
pub(super) const LESS: u8 = 0x11;
pub(super) const LESS_OR_EQUAL: u8 = 0x12;
pub(super) const NOT_EQUAL: u8 = 0x04;
pub(super) const GREATER_OR_EQUAL: u8 = 0x1D;
pub(super) const ORDERED: u8 = 0x07;
pub(super) const UNORDERED: u8 = 0x03;

/// The sign bit.
const SIGN: u32 = 1 << 31;

impl Selector<'_> {
    /// The mask of a value in a register.
    pub(super) fn mask(&mut self, value: Value, half: usize) -> VReg {
        match self.places[value.index()] {
            Place::Registers(registers) => registers[half],
            Place::MaskConstant(is_set) => self.mask_constant(is_set),
            Place::Table(slot) => {
                let memory = Memory {
                    base: MemoryBase::Frame,
                    offset: displacement(self.frame.slot(slot)),
                    is_broadcast: false,
                };
                let op = match self.isa {
                    Isa::Avx2 => &vector_op::LOAD,
                    Isa::Avx512 => &vector_op::MASK_LOAD,
                };
                let class = self.mask_class();
                self.emit((op, class), None, Source::Memory(memory, None), None)
            }
            _ => {
                debug_assert!(false, "a mask is used before it is computed");
                self.mask_constant(false)
            }
        }
    }

    /// All lanes, or none.
    pub(super) fn mask_constant(&mut self, is_set: bool) -> VReg {
        match self.isa {
            Isa::Avx2 if is_set => {
                let ones = self.constant(u32::MAX);
                self.in_register(ones)
            }
            Isa::Avx2 => self.zero(),
            Isa::Avx512 => {
                let mask = self.function.register(MASK);
                self.function
                    .push(Instruction::MaskConstant(is_set), &[Operand::reg_def(mask)]);
                mask
            }
        }
    }

    /// A row of the table on mask registers.
    pub(super) fn on_masks(
        &mut self,
        op: &'static VectorOp,
        first: Option<VReg>,
        second: VReg,
    ) -> VReg {
        let result = self.function.register(MASK);
        let mut operands = Operands::new().with(Role::Reg, Operand::reg_def(result));
        if let Some(first) = first {
            operands = operands.with(Role::Vvvv, Operand::reg_use(first));
        }
        operands = operands.with(Role::Rm, Operand::reg_use(second));
        self.push(op, (None, None), &operands);
        result
    }

    pub(super) fn mask_not(&mut self, a: Value, half: usize) -> VReg {
        let a = self.mask(a, half);
        self.not(a)
    }

    fn not(&mut self, mask: VReg) -> VReg {
        match self.isa {
            Isa::Avx2 => {
                let ones = self.constant(u32::MAX);
                self.two(&vector_op::XOR, mask, ones)
            }
            Isa::Avx512 => self.on_masks(&vector_op::MASK_NOT, None, mask),
        }
    }

    pub(super) fn mask_binary(&mut self, kind: MaskBinary, pair: [Value; 2], half: usize) -> VReg {
        let [a, b] = pair.map(|value| self.mask(value, half));
        // Most masks come from floats and choose among floats.
        let (on_vectors, on_masks) = match kind {
            MaskBinary::And => (&vector_op::AND_F, &vector_op::MASK_AND),
            MaskBinary::Or => (&vector_op::OR_F, &vector_op::MASK_OR),
            MaskBinary::Xor => (&vector_op::XOR_F, &vector_op::MASK_XOR),
            MaskBinary::AndNot => (&vector_op::AND_NOT_F, &vector_op::MASK_NOT_AND),
        };
        // The instructions negate their first operand.
        let [a, b] = if kind == MaskBinary::AndNot {
            [b, a]
        } else {
            [a, b]
        };
        match self.isa {
            Isa::Avx2 => self.two(on_vectors, a, Source::Register(b)),
            Isa::Avx512 => self.on_masks(on_masks, Some(a), b),
        }
    }

    pub(super) fn mask_or(&mut self, a: VReg, b: VReg) -> VReg {
        match self.isa {
            Isa::Avx2 => self.two(&vector_op::OR_F, a, Source::Register(b)),
            Isa::Avx512 => self.on_masks(&vector_op::MASK_OR, Some(a), b),
        }
    }

    pub(super) fn mask_and(&mut self, a: VReg, b: VReg) -> VReg {
        match self.isa {
            Isa::Avx2 => self.two(&vector_op::AND_F, a, Source::Register(b)),
            Isa::Avx512 => self.on_masks(&vector_op::MASK_AND, Some(a), b),
        }
    }

    /// Quads of which a lane, or every lane, is set.
    pub(super) fn quads(&mut self, mask: VReg, needs_all: bool) -> VReg {
        match self.isa {
            Isa::Avx2 => {
                let op = if needs_all {
                    &vector_op::AND
                } else {
                    &vector_op::OR
                };
                let mut mask = mask;
                // Each lane's neighbour in the row, then in the column.
                for order in [0b10_11_00_01, 0b01_00_11_10] {
                    let neighbours = Source::Register(mask);
                    let neighbours =
                        self.emit((&vector_op::PERMUTE, VECTOR), None, neighbours, Some(order));
                    mask = self.two(op, mask, Source::Register(neighbours));
                }
                mask
            }
            Isa::Avx512 => {
                let result = self.function.register(MASK);
                let operands = [
                    Operand::reg_def(result),
                    Operand::reg_use(mask),
                    self.temporary(GPR),
                    self.temporary(GPR),
                ];
                self.function
                    .push(Instruction::Quads { needs_all }, &operands);
                result
            }
        }
    }

    /// All lanes if a lane is set.
    pub(super) fn any(&mut self, value: Value) -> VReg {
        let mut mask = self.mask(value, 0);
        for half in 1..self.halves {
            let other = self.mask(value, half);
            mask = self.mask_or(mask, other);
        }
        let class = self.mask_class();
        let result = self.function.register(class);
        let operands = [
            Operand::reg_def(result),
            Operand::reg_use(mask),
            self.temporary(GPR),
        ];
        let instruction = match self.isa {
            Isa::Avx2 => Instruction::AnyVector,
            Isa::Avx512 => Instruction::AnyMask,
        };
        self.function.push(instruction, &operands);
        result
    }

    /// A comparison of floats by a predicate of `vcmpps`.
    pub(super) fn compare_floats(&mut self, predicate: u8, a: VReg, b: Source) -> VReg {
        let class = self.mask_class();
        self.emit((&vector_op::COMPARE_F, class), Some(a), b, Some(predicate))
    }

    pub(super) fn compare(&mut self, kind: Compare, pair: [Value; 2], half: usize) -> VReg {
        let predicate = match kind {
            Compare::FEq => Some(EQUAL),
            Compare::FNe => Some(NOT_EQUAL),
            Compare::FLt => Some(LESS),
            Compare::FLe => Some(LESS_OR_EQUAL),
            _ => None,
        };
        let [a, b] = pair;
        if let Some(predicate) = predicate {
            let first = self.word_register(a, half);
            let second = self.word(b, half);
            return self.compare_floats(predicate, first, second);
        }
        match self.isa {
            Isa::Avx2 => self.compare_by_vectors(kind, pair, half),
            Isa::Avx512 => {
                let (op, predicate) = match kind {
                    Compare::Ne => (&vector_op::COMPARE_S, 4),
                    Compare::SLt => (&vector_op::COMPARE_S, 1),
                    Compare::SLe => (&vector_op::COMPARE_S, 2),
                    Compare::ULt => (&vector_op::COMPARE_U, 1),
                    Compare::ULe => (&vector_op::COMPARE_U, 2),
                    _ => (&vector_op::COMPARE_S, 0),
                };
                let first = self.word_register(a, half);
                let second = self.word(b, half);
                self.emit((op, MASK), Some(first), second, Some(predicate))
            }
        }
    }

    /// Comparisons of integers where there are only "equal" and "greater".
    fn compare_by_vectors(&mut self, kind: Compare, [a, b]: [Value; 2], half: usize) -> VReg {
        match kind {
            Compare::SLt | Compare::SLe => {
                // a < b is b > a; a ≤ b is not a > b.
                let (first, second) = if kind == Compare::SLt { (b, a) } else { (a, b) };
                let first = self.word_register(first, half);
                let second = self.word(second, half);
                let greater = self.two(&vector_op::GREATER_S, first, second);
                if kind == Compare::SLt {
                    greater
                } else {
                    self.not(greater)
                }
            }
            Compare::ULt => {
                // With the sign bits turned, unsigned order is signed order.
                let turned = [b, a].map(|value| {
                    let word = self.word_register(value, half);
                    let sign = self.constant(SIGN);
                    self.two(&vector_op::XOR, word, sign)
                });
                let [b, a] = turned;
                self.two(&vector_op::GREATER_S, b, Source::Register(a))
            }
            Compare::ULe => {
                let a = self.word_register(a, half);
                let b = self.word(b, half);
                let lesser = self.two(&vector_op::MIN_U, a, b);
                self.two(&vector_op::EQUAL, lesser, Source::Register(a))
            }
            _ => {
                let a = self.word_register(a, half);
                let b = self.word(b, half);
                let equal = self.two(&vector_op::EQUAL, a, b);
                if kind == Compare::Ne {
                    self.not(equal)
                } else {
                    equal
                }
            }
        }
    }

    /// `yes` where a mask is set, else `no`.
    pub(super) fn blend(&mut self, mask: VReg, yes: Source, no: VReg) -> VReg {
        let result = self.function.register(VECTOR);
        let mut operands = Operands::new()
            .with(Role::Reg, Operand::reg_def(result))
            .with(Role::Vvvv, Operand::reg_use(no));
        let memory = match yes {
            Source::Register(yes) => {
                operands = operands.with(Role::Rm, Operand::any_use(yes));
                None
            }
            Source::Memory(memory, base) => {
                if let Some(base) = base {
                    operands = operands.with(Role::Base, Operand::reg_use(base));
                }
                Some(memory)
            }
        };
        let (op, role) = match self.isa {
            Isa::Avx2 => (&vector_op::BLEND_BY_SIGN, Role::Fourth),
            Isa::Avx512 => (&vector_op::BLEND, Role::Mask),
        };
        let immediate = (role == Role::Fourth).then_some(0);
        let operands = operands.with(role, Operand::reg_use(mask));
        self.push(op, (immediate, memory), &operands);
        result
    }

    pub(super) fn select(&mut self, mask: Value, [yes, no]: [Value; 2], half: usize) -> VReg {
        let mask = self.mask(mask, half);
        let no = self.word_register(no, half);
        let yes = self.word(yes, half);
        self.blend(mask, yes, no)
    }
}
