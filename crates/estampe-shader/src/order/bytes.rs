//! Which bytes an access to a buffer uses.
//!
//! Words are four bytes. Of 16-bit floats, stores change two, and loads read a word of which only
//! two are used ([`half_memory`](crate::lower) makes them), so neighbours that share a word do not
//! meet.

use super::form::Form;
use estampe_ir::op::{Atomic, Binary, Unary};
use estampe_ir::tree::{Node, Tree};
use estampe_ir::{Op, Value};
use std::collections::HashMap;

/// Remainders modulo 4 that a value may have: bit k for k.
type Remainders = u8;

const ANY: Remainders = 0b1111;
/// Multiples of 4: words.
const OF_WORDS: Remainders = 0b0001;
/// Multiples of 2: halves of words.
const OF_HALVES: Remainders = 0b0101;

/// What is known of the operations of a shader for this.
pub(super) struct Bytes<'a> {
    ops: HashMap<Value, &'a Op>,
    /// The operations that use a value; `None` for all other uses.
    users: HashMap<Value, Vec<Option<Value>>>,
    remainders: HashMap<Value, Remainders>,
}

impl<'a> Bytes<'a> {
    pub(super) fn of(tree: &'a Tree) -> Self {
        let mut bytes = Self {
            ops: HashMap::new(),
            users: HashMap::new(),
            remainders: HashMap::new(),
        };
        bytes.survey(&tree.body);
        bytes.other_uses(&tree.outputs);
        bytes
    }

    fn other_uses(&mut self, values: &[Value]) {
        for value in values {
            self.users.entry(*value).or_default().push(None);
        }
    }

    fn survey(&mut self, nodes: &'a [Node]) {
        for node in nodes {
            match node {
                Node::Op { op, first } => {
                    op.each_operand(|value, _| {
                        self.users.entry(value).or_default().push(Some(*first));
                    });
                    self.ops.insert(*first, op);
                    let remainders = self.remainders_of(op);
                    self.remainders.insert(*first, remainders);
                }
                Node::If {
                    condition,
                    accept,
                    reject,
                } => {
                    self.other_uses(&[*condition]);
                    self.survey(accept);
                    self.survey(reject);
                }
                Node::Block { body, .. } => self.survey(body),
                Node::Loop { initial, body, .. } => {
                    self.other_uses(initial);
                    self.survey(body);
                }
                Node::Branch { arguments, .. } => self.other_uses(arguments),
            }
        }
    }

    fn remainders(&self, value: Value) -> Remainders {
        self.remainders.get(&value).copied().unwrap_or(ANY)
    }

    fn remainders_of(&self, op: &Op) -> Remainders {
        match op {
            Op::Constant(word) => 1 << (word & 3),
            Op::Select { yes, no, .. } => self.remainders(*yes) | self.remainders(*no),
            Op::Binary(Binary::UMin | Binary::UMax, [a, b]) => {
                self.remainders(*a) | self.remainders(*b)
            }
            // The lowest two bits of the result are those of the operands' lowest two.
            Op::Binary(
                kind @ (Binary::Add | Binary::Sub | Binary::Mul | Binary::And | Binary::Or),
                [a, b],
            ) => {
                let all = |of: Remainders| (0..4_u32).filter(move |one| of >> one & 1 == 1);
                let [a, b] = [a, b].map(|value| self.remainders(*value));
                let pairs = all(a).flat_map(|a| all(b).map(move |b| [a, b]));
                pairs.fold(0, |of, pair| of | 1 << (kind.evaluate(pair) & 3))
            }
            Op::Binary(Binary::Shl, [a, by]) => match self.ops.get(by) {
                Some(Op::Constant(0)) => self.remainders(*a),
                Some(Op::Constant(1)) => OF_HALVES,
                Some(Op::Constant(2..32)) => OF_WORDS,
                _ => ANY,
            },
            _ => ANY,
        }
    }

    /// The bytes that an operation whose first result is `first` uses, from an offset with this
    /// form. `size` is that of a work-group.
    pub(super) fn used(
        &self,
        (op, first): (&Op, Value),
        (offset, form): (Value, &Form),
        size: [u32; 3],
    ) -> Form {
        let [from, end] = match op {
            Op::Atomic {
                kind: Atomic::StoreHalf,
                ..
            } if self.is(offset, OF_HALVES) => [0, 2],
            Op::LoadBuffer { .. } => self.loaded(first, offset),
            _ => self.whole(offset),
        };
        let bytes = Form::interval(from, end - 1);
        form.sum(&bytes, size).unwrap_or_else(Form::unknown)
    }

    fn is(&self, offset: Value, allowed: Remainders) -> bool {
        self.remainders(offset) & !allowed == 0
    }

    /// Those of the word to which an offset is rounded down.
    fn whole(&self, offset: Value) -> [i64; 2] {
        if self.is(offset, OF_WORDS) {
            [0, 4]
        } else {
            [-3, 4]
        }
    }

    /// Those of the halves of a word that are used.
    fn loaded(&self, word: Value, offset: Value) -> [i64; 2] {
        let is_word = self.is(offset, OF_WORDS);
        let mut used: Option<[i64; 2]> = None;
        for user in self.users.get(&word).into_iter().flatten() {
            let half = user.and_then(|user| match self.ops.get(&user)? {
                Op::Unary(Unary::F32FromF16, _) if is_word => Some([0, 2]),
                Op::Binary(Binary::UShr, [one, by]) if *one == word => {
                    let half = match self.ops.get(by)? {
                        Op::Constant(16) if is_word => [2, 4],
                        Op::Binary(Binary::Shl, [one, by])
                            if *one == offset
                                && matches!(self.ops.get(by), Some(Op::Constant(3)))
                                && self.is(offset, OF_HALVES) =>
                        {
                            [0, 2]
                        }
                        _ => return None,
                    };
                    self.is_converted(user).then_some(half)
                }
                _ => None,
            });
            let Some([from, end]) = half else {
                return self.whole(offset);
            };
            used = Some(used.map_or([from, end], |[first, last]| {
                [first.min(from), last.max(end)]
            }));
        }
        used.unwrap_or_else(|| self.whole(offset))
    }

    /// True if of a word only the low half is used, as a 16-bit float.
    fn is_converted(&self, word: Value) -> bool {
        let mut users = self.users.get(&word).into_iter().flatten();
        users.all(|user| {
            user.is_some_and(|user| {
                matches!(self.ops.get(&user), Some(Op::Unary(Unary::F32FromF16, _)))
            })
        })
    }
}
