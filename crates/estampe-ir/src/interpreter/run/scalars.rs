//! Operations on words that are the same in all lanes.

use super::super::instruction::{Mask, Scalar, ScalarOp, TRUE};
use super::state::{Operand, State};
use crate::op::fma;

impl State<'_> {
    /// Executes an operation on scalars.
    #[inline(never)]
    pub(super) fn scalar(&self, to: Scalar, op: &ScalarOp) {
        let of = |scalar: Scalar| self.scalar_of(scalar);
        let mask = |mask: bool| if mask { TRUE } else { 0 };
        let result = match *op {
            ScalarOp::Unary(kind, a) => kind.evaluate(of(a)),
            ScalarOp::Binary(kind, pair) => kind.evaluate(pair.map(of)),
            ScalarOp::Fma(three) => fma(three.map(of)),
            ScalarOp::Compare(kind, pair) => mask(kind.evaluate(pair.map(of))),
            ScalarOp::MaskNot(a) => !of(a),
            ScalarOp::MaskBinary(kind, pair) => {
                mask(kind.evaluate(pair.map(|scalar| of(scalar) != 0)))
            }
            ScalarOp::Select([mask, yes, no]) => of(if of(mask) == 0 { no } else { yes }),
            ScalarOp::Math(function, x) => function.evaluate(f32::from_bits(of(x))).to_bits(),
            ScalarOp::Math2(function, pair) => {
                let pair = pair.map(|scalar| f32::from_bits(of(scalar)));
                function.evaluate(pair).to_bits()
            }
            ScalarOp::Input(at) => self.first_input(at),
            ScalarOp::InputMask(at) => mask(self.first_input(at) != 0),
            ScalarOp::BufferBytes(buffer) => self.buffer(buffer).bytes(),
            ScalarOp::LoadBuffer(buffer, offset) => self.buffer(buffer).load(of(offset)),
            ScalarOp::LoadWorkgroup(index) => {
                let word = self.workgroup.get(of(index) as usize);
                word.map_or(0, std::cell::Cell::get)
            }
            ScalarOp::LoadTable(table, index) => {
                let table = &self.code.tables[table as usize];
                let at = (of(index) as usize).min(table.len().saturating_sub(1));
                table.get(at).copied().unwrap_or(0)
            }
            ScalarOp::Any(slot) => mask(self.any(Mask::Slot(slot))),
            ScalarOp::First(slot, mask) => {
                let (words, mask) = (Operand::Many(self.slot(slot)), self.mask(mask));
                let first = (0..self.count).find(|&packet| mask.packet(packet) != 0);
                first.map_or(0, |packet| {
                    words.packet(packet)[mask.packet(packet).trailing_zeros() as usize & 15]
                })
            }
            ScalarOp::Copy(from) => of(from),
        };
        self.scalars[to.0 as usize].set(result);
    }

    fn first_input(&self, at: u32) -> u32 {
        self.run.input(at).first_word()
    }
}
