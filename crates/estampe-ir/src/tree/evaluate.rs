//! One invocation, executed node by node: what a tree means.
//!
//! This is what tests compare kernels with. It has no neighbours: derivatives are 0.

use super::{Label, Node, Tree};
use crate::op::{Axis, Memory};
use crate::{Op, Value};

/// What an invocation sees outside of itself. Masks are 0 and 1.
pub trait Surroundings {
    /// The input at a position of the interface.
    fn input(&mut self, at: usize) -> u32;
    /// The words of a buffer.
    fn buffer(&mut self, at: usize) -> &mut Vec<u32>;
    /// The words of the work-group's memory.
    fn workgroup(&mut self) -> &mut Vec<u32>;
    /// The results of an access to a texture.
    fn texture(&mut self, op: &crate::op::TextureOp, operands: &[u32]) -> Vec<u32>;
}

/// Executes a tree. Returns the outputs, masks as 0 and 1; `None` if more nodes are executed than
/// the budget allows.
pub fn evaluate(tree: &Tree, surroundings: &mut dyn Surroundings, budget: u64) -> Option<Vec<u32>> {
    let locals = tree.interface.locals.iter().map(|array| {
        let mut words = array.init.clone();
        words.resize(array.words as usize, 0);
        words
    });
    let mut invocation = Invocation {
        values: vec![0; tree.len()],
        locals: locals.collect(),
        surroundings,
        budget,
    };
    match invocation.body(&tree.body) {
        Ok(()) => {
            let outputs = tree.outputs.iter();
            Some(
                outputs
                    .map(|value| invocation.values[value.index()])
                    .collect(),
            )
        }
        Err(_) => None,
    }
}

/// Why a body was left before its end.
enum Left {
    To(Label, Vec<u32>),
    Budget,
}

struct Invocation<'a> {
    values: Vec<u32>,
    locals: Vec<Vec<u32>>,
    surroundings: &'a mut dyn Surroundings,
    budget: u64,
}

impl Invocation<'_> {
    fn body(&mut self, nodes: &[Node]) -> Result<(), Left> {
        for node in nodes {
            self.budget = self.budget.checked_sub(1).ok_or(Left::Budget)?;
            match node {
                Node::Op { op, first } => {
                    let results = self.op(op);
                    for (offset, result) in results.into_iter().enumerate() {
                        self.values[first.index() + offset] = result;
                    }
                }
                Node::If {
                    condition,
                    accept,
                    reject,
                } => {
                    let side = if self.values[condition.index()] != 0 {
                        accept
                    } else {
                        reject
                    };
                    self.body(side)?;
                }
                Node::Block {
                    label,
                    results,
                    body,
                } => match self.body(body) {
                    Err(Left::To(to, brought)) if to == *label => self.set(results, &brought),
                    other => other?,
                },
                Node::Loop {
                    label,
                    parameters,
                    initial,
                    body,
                } => {
                    let mut brought = self.all(initial);
                    loop {
                        self.set(parameters, &brought);
                        match self.body(body) {
                            Err(Left::To(to, next)) if to == *label => brought = next,
                            other => {
                                other?;
                                break;
                            }
                        }
                    }
                }
                Node::Branch { label, arguments } => {
                    return Err(Left::To(*label, self.all(arguments)));
                }
            }
        }
        Ok(())
    }

    fn all(&self, values: &[Value]) -> Vec<u32> {
        values.iter().map(|value| self.get(*value)).collect()
    }

    fn get(&self, value: Value) -> u32 {
        self.values[value.index()]
    }

    fn set(&mut self, values: &[Value], words: &[u32]) {
        for (value, word) in values.iter().zip(words) {
            self.values[value.index()] = *word;
        }
    }

    fn op(&mut self, op: &Op) -> Vec<u32> {
        let one = match op {
            Op::Constant(word) => *word,
            Op::MaskConstant(mask) => u32::from(*mask),
            Op::Input(at) | Op::InputMask(at) => self.surroundings.input(*at as usize),
            Op::Unary(kind, a) => kind.evaluate(self.get(*a)),
            Op::Binary(kind, pair) => kind.evaluate(pair.map(|value| self.get(value))),
            Op::Fma(three) => crate::op::fma(three.map(|value| self.get(value))),
            Op::Compare(kind, pair) => u32::from(kind.evaluate(pair.map(|value| self.get(value)))),
            Op::MaskNot(a) => 1 - self.get(*a),
            Op::MaskBinary(kind, pair) => {
                u32::from(kind.evaluate(pair.map(|value| self.get(value) != 0)))
            }
            Op::Select { mask, yes, no } => {
                let chosen = if self.get(*mask) != 0 { yes } else { no };
                self.get(*chosen)
            }
            Op::Math(function, x) => function.evaluate(f32::from_bits(self.get(*x))).to_bits(),
            Op::Math2(function, pair) => {
                let pair = pair.map(|value| f32::from_bits(self.get(value)));
                function.evaluate(pair).to_bits()
            }
            Op::Derivative {
                axis: Axis::X | Axis::Y,
                ..
            } => 0,
            // Of a quad whose other lanes do not run.
            Op::QuadLane { lane, value, mask } => match (lane & 3, self.get(*mask)) {
                (0, 1..) => self.get(*value),
                _ => 0,
            },
            Op::QuadAny(a) | Op::Any(a) => self.get(*a),
            Op::Barrier => return Vec::new(),
            Op::Texture(op) => return self.texture(op),
            _ => return self.memory(op),
        };
        vec![one]
    }

    fn texture(&mut self, op: &crate::op::TextureOp) -> Vec<u32> {
        let mut operands = Vec::new();
        Op::Texture(Box::new(op.clone())).each_operand(|value, _| operands.push(self.get(value)));
        self.surroundings.texture(op, &operands)
    }

    fn memory(&mut self, op: &Op) -> Vec<u32> {
        match op {
            Op::LoadLocal { array, index } => {
                let (index, words) = (self.get(*index), &self.locals[*array as usize]);
                let word = words.get(index as usize).or(words.last());
                vec![word.copied().unwrap_or(0)]
            }
            Op::StoreLocal {
                array,
                index,
                value,
                mask,
            } => {
                let [index, value, mask] = [*index, *value, *mask].map(|one| self.get(one));
                let place = self.locals[*array as usize].get_mut(index as usize);
                if let Some(place) = place.filter(|_| mask != 0) {
                    *place = value;
                }
                Vec::new()
            }
            Op::LoadBuffer { buffer, offset } => {
                let at = self.get(*offset) / 4;
                let buffer = self.surroundings.buffer(*buffer as usize);
                vec![buffer.get(at as usize).copied().unwrap_or(0)]
            }
            Op::StoreBuffer {
                buffer,
                offset,
                value,
                mask,
            } => {
                let [offset, value, mask] = [*offset, *value, *mask].map(|one| self.get(one));
                if let Some(place) = self.place(Memory::Buffer(*buffer), offset, mask) {
                    *place = value;
                }
                Vec::new()
            }
            Op::BufferBytes(buffer) => {
                let words = self.surroundings.buffer(*buffer as usize).len();
                vec![u32::try_from(words * 4).unwrap_or(u32::MAX)]
            }
            Op::LoadWorkgroup(index) => {
                let index = self.get(*index);
                let word = self.surroundings.workgroup().get(index as usize).copied();
                vec![word.unwrap_or(0)]
            }
            Op::StoreWorkgroup { index, value, mask } => {
                let [index, value, mask] = [*index, *value, *mask].map(|one| self.get(one));
                if let Some(place) = self.place(Memory::Workgroup, index, mask) {
                    *place = value;
                }
                Vec::new()
            }
            Op::Atomic {
                kind,
                memory,
                offset,
                value,
                mask,
            } => {
                let [offset, value, mask] = [*offset, *value, *mask].map(|one| self.get(one));
                let Some(place) = self.place(*memory, offset, mask) else {
                    return vec![0];
                };
                let before = *place;
                *place = kind.evaluate([before, value]);
                vec![before]
            }
            Op::CompareExchange {
                memory,
                offset,
                expected,
                value,
                mask,
            } => {
                let [offset, value, mask] = [*offset, *value, *mask].map(|one| self.get(one));
                let expected = self.get(*expected);
                let Some(place) = self.place(*memory, offset, mask) else {
                    return vec![0, 0];
                };
                let before = *place;
                if before == expected {
                    *place = value;
                }
                vec![before, u32::from(before == expected)]
            }
            _ => unreachable!("the other operations do not touch memory"),
        }
    }

    /// A word of memory; `None` outside, and if the invocation has no effects.
    fn place(&mut self, memory: Memory, offset: u32, mask: u32) -> Option<&mut u32> {
        let place = match memory {
            Memory::Buffer(buffer) => {
                let words = self.surroundings.buffer(buffer as usize);
                words.get_mut(offset as usize / 4)
            }
            Memory::Workgroup => self.surroundings.workgroup().get_mut(offset as usize),
        };
        place.filter(|_| mask != 0)
    }
}
