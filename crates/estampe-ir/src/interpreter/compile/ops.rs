//! The instructions of each operation.

use super::super::instruction::{
    AtomicCode, CompareExchangeCode, Instruction, Mask, Product, Scalar, ScalarOp, TextureCode,
    Word,
};
use super::emit::{Emitter, LocalCode};
use crate::op::{Binary, TextureOp};
use crate::{Op, Type, Value};

impl Emitter<'_> {
    pub(super) fn op(&mut self, op: &Op, first: Value) {
        match op {
            Op::Constant(word) => {
                let scalar = self.constant(*word);
                self.set_word(first, Word::Scalar(scalar));
            }
            Op::MaskConstant(mask) => {
                let scalar = self.mask_constant(*mask);
                self.set_mask(first, Mask::Scalar(scalar));
            }
            Op::Input(at) | Op::InputMask(at) => self.input(*at, first),
            Op::Unary(..)
            | Op::Binary(..)
            | Op::Fma(_)
            | Op::Select { .. }
            | Op::Math(..)
            | Op::Math2(..)
            | Op::Derivative { .. }
            | Op::QuadLane { .. } => self.arithmetic(op, first),
            Op::Compare(..) | Op::MaskNot(_) | Op::MaskBinary(..) | Op::QuadAny(_) | Op::Any(_) => {
                self.on_masks(op, first)
            }
            Op::LoadLocal { array, index } => self.load_local(*array, *index, first),
            Op::StoreLocal {
                array,
                index,
                value,
                mask,
            } => {
                let words = [self.word(*index), self.word(*value)];
                let mask = self.mask(*mask);
                if let Some(LocalCode::Array(array)) = self.array(*array) {
                    self.push(Instruction::StoreLocal(array, words, mask));
                }
            }
            Op::Texture(op) => self.texture(op, first),
            Op::Barrier => self.push(Instruction::Barrier),
            _ => self.memory(op, first),
        }
    }

    fn input(&mut self, at: u32, first: Value) {
        let kind = super::kind_of(self.kernel, first);
        let is_uniform = self.is_uniform(first);
        match kind {
            Type::Word if is_uniform => {
                let scalar = self.scalar_op(ScalarOp::Input(at), &[], true);
                self.set_word(first, Word::Scalar(scalar));
            }
            Type::Mask if is_uniform => {
                let scalar = self.scalar_op(ScalarOp::InputMask(at), &[], true);
                self.set_mask(first, Mask::Scalar(scalar));
            }
            _ => self.set_input(first, at),
        }
    }

    fn arithmetic(&mut self, op: &Op, first: Value) {
        if let Op::Binary(Binary::FMul, [a, b]) = *op
            && self.is_fused(first)
        {
            let factors = [self.word(a), self.word(b)];
            if scalars(factors).is_none() {
                return self.set_product(first, factors);
            }
        }
        if let Op::Binary(kind @ (Binary::FAdd | Binary::FSub), pair) = *op
            && self.sum_of_product(kind, pair, first)
        {
            return;
        }
        if let Some(scalar) = self.scalar_arithmetic(op) {
            return self.set_word(first, Word::Scalar(scalar));
        }
        let mut result = None;
        let instruction = match *op {
            Op::Unary(kind, a) => {
                let a = self.word_slot(a);
                Instruction::Unary(kind, *result.insert(self.new_slot()), a)
            }
            Op::Binary(kind, pair) => {
                let pair = pair.map(|value| self.word(value));
                Instruction::Binary(kind, *result.insert(self.new_slot()), pair)
            }
            Op::Fma(three) => {
                let three = three.map(|value| self.word_slot(value));
                Instruction::Fma(*result.insert(self.new_slot()), three)
            }
            Op::Select { mask, yes, no } => {
                let (mask, pair) = (self.mask(mask), [self.word(yes), self.word(no)]);
                Instruction::Select(*result.insert(self.new_slot()), mask, pair)
            }
            Op::Math(function, x) => {
                let x = self.word_slot(x);
                Instruction::Math(function, *result.insert(self.new_slot()), x)
            }
            Op::Math2(function, pair) => {
                let pair = pair.map(|value| self.word_slot(value));
                Instruction::Math2(function, *result.insert(self.new_slot()), pair)
            }
            Op::Derivative {
                axis,
                precision,
                value,
                mask,
            } => {
                let (value, mask) = (self.word_slot(value), self.mask(mask));
                let to = *result.insert(self.new_slot());
                Instruction::Derivative(axis, precision, to, value, mask)
            }
            Op::QuadLane { lane, value, mask } => {
                let (value, mask) = (self.word_slot(value), self.mask(mask));
                Instruction::QuadLane(lane, *result.insert(self.new_slot()), value, mask)
            }
            _ => return,
        };
        self.push(instruction);
        if let Some(slot) = result {
            self.define(first, Word::Slot(slot), op);
        }
    }

    /// A sum or difference of which a product is a term, if that is to be computed with it.
    fn sum_of_product(&mut self, kind: Binary, [x, y]: [Value; 2], first: Value) -> bool {
        let (factors, kind, other) = match (self.product(x), self.product(y), kind) {
            (Some(factors), _, Binary::FAdd) => (factors, Product::Plus, y),
            (Some(factors), _, _) => (factors, Product::Minus, y),
            (None, Some(factors), Binary::FAdd) => (factors, Product::Plus, x),
            (None, Some(factors), _) => (factors, Product::From, x),
            (None, None, _) => return false,
        };
        let [a, b] = factors;
        let other = self.word(other);
        let to = self.new_slot();
        // The first factor differs between lanes.
        let factors = match a {
            Word::Slot(_) => [a, b],
            Word::Scalar(_) => [b, a],
        };
        self.push(Instruction::Product(
            kind,
            to,
            [factors[0], factors[1], other],
        ));
        self.set_word(first, Word::Slot(to));
        true
    }

    /// The operation on scalars, if all operands are.
    fn scalar_arithmetic(&mut self, op: &Op) -> Option<Scalar> {
        let (op, operands) = match *op {
            Op::Unary(kind, a) => {
                let [a] = scalars([self.word(a)])?;
                (ScalarOp::Unary(kind, a), vec![a])
            }
            Op::Binary(kind, pair) => {
                let pair = scalars(pair.map(|value| self.word(value)))?;
                (ScalarOp::Binary(kind, pair), pair.to_vec())
            }
            Op::Fma(three) => {
                let three = scalars(three.map(|value| self.word(value)))?;
                (ScalarOp::Fma(three), three.to_vec())
            }
            Op::Select { mask, yes, no } => {
                let Mask::Scalar(mask) = self.mask(mask) else {
                    return None;
                };
                let [yes, no] = scalars([self.word(yes), self.word(no)])?;
                let all = [mask, yes, no];
                (ScalarOp::Select(all), all.to_vec())
            }
            Op::Math(function, x) => {
                let [x] = scalars([self.word(x)])?;
                (ScalarOp::Math(function, x), vec![x])
            }
            Op::Math2(function, pair) => {
                let pair = scalars(pair.map(|value| self.word(value)))?;
                (ScalarOp::Math2(function, pair), pair.to_vec())
            }
            _ => return None,
        };
        Some(self.scalar_op(op, &operands, true))
    }

    fn on_masks(&mut self, op: &Op, first: Value) {
        let result = match *op {
            Op::Compare(kind, pair) => {
                let pair = pair.map(|value| self.word(value));
                if let Some(pair) = scalars(pair) {
                    Mask::Scalar(self.scalar_op(ScalarOp::Compare(kind, pair), &pair, true))
                } else {
                    let to = self.new_mask();
                    self.push(Instruction::Compare(kind, to, pair));
                    Mask::Slot(to)
                }
            }
            Op::MaskNot(a) => match self.mask(a) {
                Mask::Scalar(a) => Mask::Scalar(self.scalar_op(ScalarOp::MaskNot(a), &[a], true)),
                Mask::Slot(a) => {
                    let to = self.new_mask();
                    self.push(Instruction::MaskNot(to, a));
                    Mask::Slot(to)
                }
            },
            Op::MaskBinary(kind, pair) => match pair.map(|value| self.mask(value)) {
                [Mask::Scalar(a), Mask::Scalar(b)] => {
                    let op = ScalarOp::MaskBinary(kind, [a, b]);
                    Mask::Scalar(self.scalar_op(op, &[a, b], true))
                }
                pair => {
                    let to = self.new_mask();
                    self.push(Instruction::MaskBinary(kind, to, pair));
                    Mask::Slot(to)
                }
            },
            Op::QuadAny(a) => match self.mask(a) {
                mask @ Mask::Scalar(_) => mask,
                Mask::Slot(a) => {
                    let to = self.new_mask();
                    self.push(Instruction::QuadAny(to, a));
                    Mask::Slot(to)
                }
            },
            Op::Any(a) => {
                let mask = self.mask(a);
                Mask::Scalar(self.any_lane(mask))
            }
            _ => return,
        };
        self.set_mask(first, result);
    }

    fn load_local(&mut self, array: u32, index: Value, first: Value) {
        let index = self.word(index);
        let word = match (self.array(array), index) {
            (Some(LocalCode::Table(table)), Word::Scalar(index)) => {
                let op = ScalarOp::LoadTable(table, index);
                Word::Scalar(self.scalar_op(op, &[index], true))
            }
            (Some(LocalCode::Table(table)), Word::Slot(index)) => {
                let to = self.new_slot();
                self.push(Instruction::LoadTable(table, to, index));
                Word::Slot(to)
            }
            (Some(LocalCode::Array(array)), index) => {
                let to = self.new_slot();
                self.push(Instruction::LoadLocal(to, array, index));
                Word::Slot(to)
            }
            (None, _) => Word::Scalar(self.constant(0)),
        };
        self.set_word(first, word);
    }

    fn array(&self, at: u32) -> Option<LocalCode> {
        self.arrays.get(at as usize).copied()
    }

    fn memory(&mut self, op: &Op, first: Value) {
        match *op {
            Op::BufferBytes(buffer) => {
                let scalar = self.scalar_op(ScalarOp::BufferBytes(buffer), &[], true);
                self.set_word(first, Word::Scalar(scalar));
            }
            Op::LoadBuffer { buffer, offset } => {
                let buffers = &self.kernel.interface.buffers;
                let is_read_only = buffers.get(buffer as usize).is_some_and(|b| !b.is_written);
                let word = match self.word(offset) {
                    Word::Scalar(offset) => {
                        let op = ScalarOp::LoadBuffer(buffer, offset);
                        Word::Scalar(self.scalar_op(op, &[offset], is_read_only))
                    }
                    Word::Slot(offset) => {
                        let to = self.new_slot();
                        self.push(Instruction::LoadBuffer(to, buffer, offset));
                        Word::Slot(to)
                    }
                };
                self.set_word(first, word);
            }
            Op::LoadWorkgroup(index) => {
                let word = match self.word(index) {
                    Word::Scalar(index) => Word::Scalar(self.scalar_op(
                        ScalarOp::LoadWorkgroup(index),
                        &[index],
                        false,
                    )),
                    Word::Slot(index) => {
                        let to = self.new_slot();
                        self.push(Instruction::LoadWorkgroup(to, index));
                        Word::Slot(to)
                    }
                };
                self.set_word(first, word);
            }
            Op::StoreBuffer {
                buffer,
                offset,
                value,
                mask,
            } => {
                let words = [self.word(offset), self.word(value)];
                let mask = self.mask(mask);
                self.push(Instruction::StoreBuffer(buffer, words, mask));
            }
            Op::StoreWorkgroup { index, value, mask } => {
                let words = [self.word(index), self.word(value)];
                let mask = self.mask(mask);
                self.push(Instruction::StoreWorkgroup(words, mask));
            }
            Op::Atomic {
                kind,
                memory,
                offset,
                value,
                mask,
            } => {
                let code = AtomicCode {
                    kind,
                    memory,
                    result: self.new_slot(),
                    offset: self.word(offset),
                    value: self.word(value),
                    mask: self.mask(mask),
                };
                let result = code.result;
                self.push(Instruction::Atomic(Box::new(code)));
                self.define(first, Word::Slot(result), op);
            }
            Op::CompareExchange {
                memory,
                offset,
                expected,
                value,
                mask,
            } => {
                let code = CompareExchangeCode {
                    memory,
                    result: self.new_slot(),
                    is_stored: self.new_mask(),
                    offset: self.word(offset),
                    expected: self.word(expected),
                    value: self.word(value),
                    mask: self.mask(mask),
                };
                let (result, is_stored) = (code.result, code.is_stored);
                self.push(Instruction::CompareExchange(Box::new(code)));
                self.define(first, Word::Slot(result), op);
                let second = Value(first.0 + 1);
                self.set_mask(second, Mask::Slot(is_stored));
            }
            _ => {}
        }
    }

    fn texture(&mut self, op: &TextureOp, first: Value) {
        let whole = Op::Texture(Box::new(op.clone()));
        let mut operands = Vec::new();
        whole.each_operand(|value, kind| {
            if kind == Type::Word {
                operands.push(value);
            }
        });
        let operands = operands.into_iter().map(|value| self.word(value)).collect();
        let mask = self.mask(op.mask);
        let results: Vec<_> = (0..op.query.results()).map(|_| self.new_slot()).collect();
        let code = TextureCode {
            op: op.clone(),
            operands,
            mask,
            results: results.clone(),
        };
        self.push(Instruction::Texture(Box::new(code)));
        for (offset, slot) in (0..).zip(results) {
            self.define(Value(first.0 + offset), Word::Slot(slot), &whole);
        }
    }

    /// Defines a result. A uniform one is that of the first lane in which the operation acts.
    fn define(&mut self, value: Value, word: Word, op: &Op) {
        if self.is_uniform(value) {
            let mask = op.clone().mask_mut().map(|mask| self.mask(*mask));
            let scalar = self.first_lane(word, mask);
            return self.set_word(value, Word::Scalar(scalar));
        }
        self.set_word(value, word);
    }

    fn word_slot(&mut self, value: Value) -> super::super::instruction::Slot {
        let word = self.word(value);
        self.slot(word)
    }
}

/// The scalars, if all of the words are.
fn scalars<const N: usize>(words: [Word; N]) -> Option<[Scalar; N]> {
    let mut scalars = [Scalar(0); N];
    for (to, word) in scalars.iter_mut().zip(words) {
        let Word::Scalar(scalar) = word else {
            return None;
        };
        *to = scalar;
    }
    Some(scalars)
}
