//! Operations on words.

use super::masks::{GREATER_OR_EQUAL, ORDERED, UNORDERED};
use super::operands::{Operands, Source};
use super::{Place, Selector};
use crate::Isa;
use crate::encoder::{VectorOp, vector_op};
use crate::machine::{Role, VECTOR};
use estampe_ir::Value;
use estampe_ir::op::{Axis, Binary, NAN, Precision, Unary};
use regalloc2::{Operand, VReg};

/// The bits of 2³¹ and 2³² as floats.
const TWO_31: u32 = 0x4F00_0000;
const TWO_32: u32 = 0x4F80_0000;
/// The bits of 2¹⁶ as a float.
const TWO_16: u32 = 0x4780_0000;
/// The sign bit.
const SIGN: u32 = 1 << 31;

impl Selector<'_> {
    /// An operation of one word.
    pub(super) fn unary(&mut self, kind: Unary, a: Value, half: usize) -> VReg {
        match kind {
            Unary::FNeg => self.with_constant(self.logic_of_floats(Binary::Xor), (a, half), SIGN),
            Unary::FAbs => self.with_constant(self.logic_of_floats(Binary::And), (a, half), !SIGN),
            Unary::Not => self.with_constant(&vector_op::XOR, (a, half), u32::MAX),
            Unary::FSqrt => {
                let a = self.word(a, half);
                self.one(&vector_op::SQRT_F, a)
            }
            // Bit 3 keeps "inexact" quiet; bits 0 to 1 are the direction.
            Unary::FRound => self.round(a, half, 0b1000),
            Unary::FFloor => self.round(a, half, 0b1001),
            Unary::FCeil => self.round(a, half, 0b1010),
            Unary::FTrunc => self.round(a, half, 0b1011),
            Unary::Canonical => {
                let a = self.word_register(a, half);
                let is_nan = self.compare_floats(UNORDERED, a, Source::Register(a));
                let nan = self.constant(NAN);
                self.blend(is_nan, nan, a)
            }
            Unary::RoundF16 => self.round_f16(a, half),
            Unary::F16FromF32 => self.f16_from_f32(a, half),
            Unary::F32FromF16 => self.f32_from_f16(a, half),
            Unary::S32FromF32 => self.s32_from_f32(a, half),
            Unary::U32FromF32 => self.u32_from_f32(a, half),
            Unary::F32FromS32 => {
                let a = self.word(a, half);
                self.one(&vector_op::F32_FROM_S32, a)
            }
            Unary::F32FromU32 => self.f32_from_u32(a, half),
            Unary::CountOnes if self.isa == Isa::Avx512 => {
                let a = self.word(a, half);
                self.one(&vector_op::COUNT_ONES, a)
            }
            Unary::LeadingZeros if self.isa == Isa::Avx512 => {
                let a = self.word(a, half);
                self.one(&vector_op::LEADING_ZEROS, a)
            }
            Unary::TrailingZeros if self.isa == Isa::Avx512 => {
                // The zeros below the lowest one are the ones of (a − 1) & !a.
                let a = self.word_register(a, half);
                let minus_one = self.constant(u32::MAX);
                let before = self.two(&vector_op::ADD, a, minus_one);
                let below = self.two(&vector_op::AND_NOT, a, Source::Register(before));
                self.one(&vector_op::COUNT_ONES, Source::Register(below))
            }
            Unary::CountOnes => self.count_ones(a, half),
            Unary::LeadingZeros => self.leading_zeros(a, half),
            Unary::TrailingZeros => self.trailing_zeros(a, half),
            Unary::ReverseBits => self.reverse_bits(a, half),
        }
    }

    /// An operation on the bits of floats. Zen 3 takes a cycle to hand a result from the units for
    /// floats to those for integers, and another one back.
    fn logic_of_floats(&self, kind: Binary) -> &'static VectorOp {
        match (self.isa, kind) {
            (Isa::Avx2, Binary::And) => &vector_op::AND_F,
            (Isa::Avx2, Binary::Or) => &vector_op::OR_F,
            (Isa::Avx2, _) => &vector_op::XOR_F,
            (Isa::Avx512, Binary::And) => &vector_op::AND,
            (Isa::Avx512, Binary::Or) => &vector_op::OR,
            (Isa::Avx512, _) => &vector_op::XOR,
        }
    }

    fn with_constant(
        &mut self,
        op: &'static VectorOp,
        (a, half): (Value, usize),
        word: u32,
    ) -> VReg {
        let a = self.word_register(a, half);
        let constant = self.constant(word);
        self.two(op, a, constant)
    }

    fn round(&mut self, a: Value, half: usize, how: u8) -> VReg {
        let a = self.word(a, half);
        self.emit((&vector_op::ROUND_F, VECTOR), None, a, Some(how))
    }

    /// The instruction gives −2³¹ for all that does not fit.
    fn s32_from_f32(&mut self, a: Value, half: usize) -> VReg {
        let a = self.word_register(a, half);
        let converted = self.one(&vector_op::S32_FROM_F32, Source::Register(a));
        let limit = self.constant(TWO_31);
        let is_above = self.compare_floats(GREATER_OR_EQUAL, a, limit);
        let greatest = self.constant(i32::MAX.cast_unsigned());
        let saturated = self.blend(is_above, greatest, converted);
        let is_number = self.compare_floats(ORDERED, a, Source::Register(a));
        self.where_set(is_number, saturated)
    }

    /// A word where a mask is set, else 0.
    fn where_set(&mut self, mask: VReg, word: VReg) -> VReg {
        match self.isa {
            Isa::Avx2 => self.two(&vector_op::AND, word, Source::Register(mask)),
            Isa::Avx512 => {
                let zero = self.zero();
                self.blend(mask, Source::Register(word), zero)
            }
        }
    }

    fn u32_from_f32(&mut self, a: Value, half: usize) -> VReg {
        let a = self.word_register(a, half);
        // NaN and negative numbers become 0: the second operand.
        let zero = self.zero();
        let a = self.two(&vector_op::MAX_F, a, Source::Register(zero));
        if self.isa == Isa::Avx512 {
            // Numbers from 2³² on give the greatest integer.
            return self.one(&vector_op::U32_FROM_F32, Source::Register(a));
        }
        // Numbers from 2³¹ on are converted without their highest bit.
        let limit = self.constant(TWO_31);
        let is_large = self.compare_floats(GREATER_OR_EQUAL, a, limit);
        let excess = self.two(&vector_op::AND, is_large, limit);
        let small = self.two(&vector_op::SUB_F, a, Source::Register(excess));
        let converted = self.one(&vector_op::S32_FROM_F32, Source::Register(small));
        let sign = self.constant(SIGN);
        let highest = self.two(&vector_op::AND, is_large, sign);
        let converted = self.two(&vector_op::XOR, converted, Source::Register(highest));
        let limit = self.constant(TWO_32);
        let is_above = self.compare_floats(GREATER_OR_EQUAL, a, limit);
        self.two(&vector_op::OR, converted, Source::Register(is_above))
    }

    fn f32_from_u32(&mut self, a: Value, half: usize) -> VReg {
        if self.isa == Isa::Avx512 {
            let a = self.word(a, half);
            return self.one(&vector_op::F32_FROM_U32, a);
        }
        // Both halves and the product are exact; only the sum is rounded.
        let a = self.word_register(a, half);
        let high = self.shift_by(&vector_op::SHR_U_BY, a, 16);
        let low = self.constant(0xFFFF);
        let low = self.two(&vector_op::AND, a, low);
        let [high, low] =
            [high, low].map(|part| self.one(&vector_op::F32_FROM_S32, Source::Register(part)));
        let factor = self.constant(TWO_16);
        let high = self.two(&vector_op::MUL_F, high, factor);
        self.two(&vector_op::ADD_F, high, Source::Register(low))
    }

    /// An operation of two words.
    pub(super) fn binary(&mut self, kind: Binary, pair: [Value; 2], half: usize) -> VReg {
        if self.is_inverse_root(kind, pair) {
            return self.inverse_of_root(pair[1], half);
        }
        let [a, b] = pair;
        if kind == Binary::Mul {
            for [a, factor] in [[a, b], [b, a]] {
                if let Some(bits) = self.shift_of_factor(factor) {
                    let a = self.word_register(a, half);
                    return self.shift_by(&vector_op::SHL_BY, a, bits);
                }
            }
        }
        let (op, commutes) = match kind {
            Binary::FAdd => (&vector_op::ADD_F, true),
            Binary::FSub => (&vector_op::SUB_F, false),
            Binary::FMul => (&vector_op::MUL_F, true),
            Binary::FDiv => (&vector_op::DIV_F, false),
            // The instructions give the second operand for NaN and equal numbers.
            Binary::FMin => (&vector_op::MIN_F, false),
            Binary::FMax => (&vector_op::MAX_F, false),
            Binary::Add => (&vector_op::ADD, true),
            Binary::Sub => (&vector_op::SUB, false),
            Binary::Mul => (&vector_op::MUL, true),
            Binary::And | Binary::Or | Binary::Xor
                if [a, b].iter().any(|value| self.plan.is_float(*value)) =>
            {
                (self.logic_of_floats(kind), true)
            }
            Binary::And => (&vector_op::AND, true),
            Binary::Or => (&vector_op::OR, true),
            Binary::Xor => (&vector_op::XOR, true),
            Binary::SMin => (&vector_op::MIN_S, true),
            Binary::SMax => (&vector_op::MAX_S, true),
            Binary::UMin => (&vector_op::MIN_U, true),
            Binary::UMax => (&vector_op::MAX_U, true),
            Binary::Shl => return self.shift([&vector_op::SHL, &vector_op::SHL_BY], pair, half),
            Binary::UShr => {
                return self.shift([&vector_op::SHR_U, &vector_op::SHR_U_BY], pair, half);
            }
            Binary::SShr => {
                return self.shift([&vector_op::SHR_S, &vector_op::SHR_S_BY], pair, half);
            }
            Binary::UMulHigh => return self.high(&vector_op::MUL_U64, pair, half),
            Binary::SMulHigh => return self.high(&vector_op::MUL_S64, pair, half),
            Binary::SDiv | Binary::SRem | Binary::UDiv | Binary::URem => {
                return self.divide(kind, pair, half);
            }
        };
        // The operand in memory comes second.
        let is_in_memory =
            |value: Value| !matches!(self.places[value.index()], Place::Registers(_));
        let (a, b) = if commutes && is_in_memory(a) && !is_in_memory(b) {
            (b, a)
        } else {
            (a, b)
        };
        let first = self.word_register(a, half);
        let second = if a == b {
            Source::Register(first)
        } else {
            self.word(b, half)
        };
        self.two(op, first, second)
    }

    /// The shift that is a product with a constant power of two: a cycle in place of ten.
    fn shift_of_factor(&self, factor: Value) -> Option<u8> {
        let factor = self.plan.constant(factor)?;
        let bits = u8::try_from(factor.trailing_zeros()).ok()?;
        factor.is_power_of_two().then_some(bits)
    }

    /// A shift: by vectors, and by the same number in all lanes.
    fn shift(
        &mut self,
        [by_lane, by_immediate]: [&'static VectorOp; 2],
        [a, b]: [Value; 2],
        half: usize,
    ) -> VReg {
        let a = self.word_register(a, half);
        if let Some(bits) = self.plan.constant(b) {
            let bits = u8::try_from(bits & 31).unwrap_or(0);
            return self.shift_by(by_immediate, a, bits);
        }
        let b = self.word_register(b, half);
        let modulo = self.constant(31);
        let b = self.two(&vector_op::AND, b, modulo);
        self.two(by_lane, a, Source::Register(b))
    }

    /// The high words of products, of which the instruction makes those of even lanes.
    fn high(&mut self, op: &'static VectorOp, pair: [Value; 2], half: usize) -> VReg {
        let [a, b] = pair.map(|value| self.word_register(value, half));
        let even = self.two(op, a, Source::Register(b));
        let even = self.shift_by(&vector_op::SHR_64_BY, even, 32);
        let [a, b] = [(a, pair[0]), (b, pair[1])].map(|(word, value)| {
            if self.plan.is_splat(value) {
                return word;
            }
            self.shift_by(&vector_op::SHR_64_BY, word, 32)
        });
        let odd = self.two(op, a, Source::Register(b));
        if self.isa == Isa::Avx2 {
            return self.odd_lanes(Source::Register(odd), even);
        }
        let is_odd: Vec<u32> = (0..self.isa.lanes())
            .map(|lane| if lane % 2 == 1 { u32::MAX } else { 0 })
            .collect();
        let is_odd = self.constant_lanes(&is_odd);
        let odd = self.two(&vector_op::AND, odd, is_odd);
        self.two(&vector_op::OR, even, Source::Register(odd))
    }

    /// a · b + c, rounded once.
    pub(super) fn fma(&mut self, three: [Value; 3], half: usize) -> VReg {
        let [a, b, c] = three;
        let a = self.word_register(a, half);
        let b = self.word_register(b, half);
        let c = self.word(c, half);
        self.fma_of(&vector_op::FMA_F, [a, b], c)
    }

    /// An instruction of a fused product and sum, a · b + c.
    pub(super) fn fma_of(&mut self, op: &'static VectorOp, [a, b]: [VReg; 2], c: Source) -> VReg {
        let result = self.function.register(VECTOR);
        // The first factor's register becomes the result.
        let mut operands = Operands::new()
            .with(Role::Reg, Operand::reg_reuse_def(result, 1))
            .with(Role::Silent, Operand::reg_use(a))
            .with(Role::Vvvv, Operand::reg_use(b));
        let memory = match c {
            Source::Register(c) if op.rounds_up => {
                operands = operands.with(Role::Rm, Operand::reg_use(c));
                None
            }
            Source::Register(c) => {
                operands = operands.with(Role::Rm, Operand::any_use(c));
                None
            }
            Source::Memory(memory, base) => {
                if let Some(base) = base {
                    operands = operands.with(Role::Base, Operand::reg_use(base));
                }
                Some(memory)
            }
        };
        self.push(op, (None, memory), &operands);
        result
    }

    /// The difference to the neighbour in the quad; 0 in quads of which a lane is not in the mask.
    pub(super) fn derivative(
        &mut self,
        (axis, precision): (Axis, Precision),
        (value, mask): (Value, Value),
        half: usize,
    ) -> VReg {
        // Which lane of the quad each lane takes, the lowest lane in the lowest two bits.
        let [from, to] = match (axis, precision) {
            (Axis::X, Precision::Fine) => [0b10_10_00_00, 0b11_11_01_01],
            (Axis::X, Precision::Coarse) => [0b00_00_00_00, 0b01_01_01_01],
            (Axis::Y, Precision::Fine) => [0b01_00_01_00, 0b11_10_11_10],
            (Axis::Y, Precision::Coarse) => [0b00_00_00_00, 0b10_10_10_10],
        };
        let value = self.word_register(value, half);
        let [from, to] = [from, to].map(|order| {
            let source = Source::Register(value);
            self.emit((&vector_op::PERMUTE, VECTOR), None, source, Some(order))
        });
        let difference = self.two(&vector_op::SUB_F, to, Source::Register(from));
        if self.plan.has_whole_quads(mask) {
            return difference;
        }
        let mask = self.mask(mask, half);
        let whole = self.quads(mask, true);
        self.where_set(whole, difference)
    }

    /// The word of one lane of the quad, 0 if the lane is not set.
    pub(super) fn quad_lane(
        &mut self,
        lane: u8,
        (value, mask): (Value, Value),
        half: usize,
    ) -> VReg {
        let mut value_of = self.word_register(value, half);
        if !self.plan.has_whole_quads(mask) {
            let mask = self.mask(mask, half);
            value_of = self.where_set(mask, value_of);
        }
        let order = (lane & 3) * 0b01_01_01_01;
        let source = Source::Register(value_of);
        self.emit((&vector_op::PERMUTE, VECTOR), None, source, Some(order))
    }
}
