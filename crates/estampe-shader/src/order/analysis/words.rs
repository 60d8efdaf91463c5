//! The words that are known: the form of an operation's result.

use super::Analysis;
use crate::order::form::{Coefficient, Form, Symbol, Variable};
use estampe_ir::Op;
use estampe_ir::interface::{BufferSlot, Input};
use estampe_ir::op::{Binary, Unary};

/// A float that is known.
#[derive(Debug, Clone, Copy)]
pub(super) enum Float {
    /// The centre of the fragment's pixel along an axis, or a place in that pixel.
    Position(usize),
    /// At least as much as positions can be.
    Large,
}

impl Analysis<'_> {
    pub(super) fn float_of(&self, op: &Op) -> Option<Float> {
        match *op {
            Op::Input(at) => match self.tree.interface.inputs.get(at as usize)? {
                Input::Position(axis @ 0..2) => Some(Float::Position(*axis as usize)),
                _ => None,
            },
            Op::Constant(word) if f32::from_bits(word) >= 65_536.0 => Some(Float::Large),
            Op::Unary(Unary::FFloor | Unary::FTrunc, a) => self.floats.get(&a).copied(),
            // What holds floats to those that an integer can be.
            Op::Binary(Binary::FMin, [a, b]) => {
                match (self.floats.get(&a)?, self.floats.get(&b)?) {
                    (Float::Large, other) | (other, Float::Large) => Some(*other),
                    (Float::Position(_), Float::Position(_)) => None,
                }
            }
            _ => None,
        }
    }

    /// The word that an operation gives, if it is known.
    pub(super) fn form_of(&self, op: &Op) -> Option<Form> {
        let size = self.accesses.size;
        let number = |value: u32| Form::interval(i64::from(value), i64::from(value));
        match op {
            Op::Constant(word) => Some(number(*word)),
            Op::Input(at) => match *self.tree.interface.inputs.get(*at as usize)? {
                Input::WorkgroupId(axis) if axis < 3 => {
                    Some(Form::variable(Variable::Group(axis as usize)))
                }
                Input::LocalInvocationId(axis) if axis < 3 => {
                    Some(Form::variable(Variable::Local(axis as usize)))
                }
                Input::LocalInvocationIndex => {
                    let [x, y, z] = [0, 1, 2].map(|axis| Form::variable(Variable::Local(axis)));
                    let of = |factor: u32| Coefficient::number(i64::from(factor));
                    let rows = y.product(of(size[0]))?;
                    let slices = z.product(of(size[0].checked_mul(size[1])?))?;
                    x.sum(&rows, size)?.sum(&slices, size)
                }
                Input::NumWorkgroups(axis) if axis < 3 => {
                    Some(Form::symbol(Symbol::Workgroups(axis as usize)))
                }
                Input::PushConstant(at) => Some(Form::symbol(Symbol::Immediate(at))),
                _ => None,
            },
            Op::LoadBuffer { buffer, offset } if !self.tree.is_written(*buffer) => {
                let offset = self.form(*offset).only_interval()?;
                let offset = u32::try_from(offset[0])
                    .ok()
                    .filter(|_| offset[0] == offset[1])?;
                let (buffer, offset) = (*buffer, offset & !3);
                Some(Form::symbol(
                    match self.tree.interface.buffers.get(buffer as usize) {
                        Some(&BufferSlot::IMMEDIATES) => Symbol::Immediate(offset / 4),
                        _ => Symbol::Word { buffer, offset },
                    },
                ))
            }
            Op::BufferBytes(buffer) => Some(Form::symbol(Symbol::Elements {
                buffer: *buffer,
                bytes: 1,
            })),
            Op::Select { yes, no, .. } => {
                let (yes, no) = (self.form(*yes), self.form(*no));
                let [low, high] = [yes.low.min(no.low), yes.high.max(no.high)];
                let is_same = yes.terms == no.terms && yes.constants == no.constants;
                let conditions = [&yes.conditions[..], &no.conditions[..]].concat();
                is_same.then_some(Form {
                    low,
                    high,
                    conditions,
                    ..yes
                })
            }
            Op::Binary(kind, [a, b]) => self.binary(*kind, &self.form(*a), &self.form(*b)),
            Op::Unary(Unary::S32FromF32 | Unary::U32FromF32, a) => match self.floats.get(a)? {
                Float::Position(axis) => Some(Form::variable(Variable::Pixel(*axis))),
                Float::Large => None,
            },
            _ => None,
        }
    }

    fn binary(&self, kind: Binary, a: &Form, b: &Form) -> Option<Form> {
        let size = self.accesses.size;
        let constant = |form: &Form| {
            let coefficient = form.coefficient()?;
            let is_word = coefficient.symbol.is_none() && u32::try_from(coefficient.factor).is_ok();
            is_word.then_some(coefficient)
        };
        match kind {
            Binary::Add => a.sum(b, size),
            Binary::Sub => a.sum(&b.product(Coefficient::number(-1))?, size),
            Binary::Mul => match (a.coefficient(), b.coefficient()) {
                (_, Some(factor)) => a.product(factor),
                (Some(factor), None) => b.product(factor),
                (None, None) => None,
            },
            Binary::Shl => {
                let bits = constant(b)?.factor;
                a.product(Coefficient::number(1 << u32::try_from(bits).ok()?.min(31)))
            }
            Binary::And => {
                let [a, b] = [constant(a), constant(b)];
                let most = a.or(b)?.factor;
                Some(Form::interval(0, most))
            }
            Binary::URem => {
                let divisor = constant(b)?.factor;
                Some(Form::interval(0, (divisor - 1).max(0)))
            }
            Binary::UDiv => {
                let divisor = constant(b)?.factor.max(1);
                if let Some(length) = a.divided_length(divisor) {
                    return Some(length);
                }
                let [low, high] = a.words()?;
                Some(Form::interval(low / divisor, high / divisor))
            }
            Binary::UShr => {
                let bits = constant(b)?.factor & 31;
                if let Some(length) = a.divided_length(1 << bits) {
                    return Some(length);
                }
                let [low, high] = a.words()?;
                Some(Form::interval(low >> bits, high >> bits))
            }
            Binary::UMin => {
                let (form, most) = match (constant(a), constant(b)) {
                    (_, Some(most)) => (a, most),
                    (Some(most), None) => (b, most),
                    (None, None) => return None,
                };
                Some(form.at_most(u32::try_from(most.factor).ok()?))
            }
            _ => None,
        }
    }
}
