//! Places, and what is loaded from and stored to them.

use super::types::{Part, kind_of, part, scalars};
use super::{LowerError, Lowered, Lowering};
use estampe_ir::op::{Binary, Compare, Unary};
use estampe_ir::{Op, Type, Value};
use naga::{Scalar, ScalarKind, TypeInner};

/// A place in memory, and the type of what is there.
#[derive(Debug, Clone)]
pub(super) struct Pointer {
    pub(super) base: Base,
    pub(super) inner: TypeInner,
}

/// Where a place is.
#[derive(Debug, Clone, Copy)]
pub(super) enum Base {
    /// Slots from this one on.
    Slots(usize),
    /// An array of the invocation, from this word on.
    Local { array: u32, word: Value },
    /// The work-group's memory, from this word on.
    Workgroup(Value),
    /// A buffer, from this byte on.
    Buffer { buffer: u32, byte: Value },
}

impl Lowering<'_> {
    /// The place that an index selects.
    pub(super) fn access(
        &mut self,
        pointer: &Pointer,
        index: Result<u32, Value>,
    ) -> Lowered<Pointer> {
        let part = part(self.module, &pointer.inner, index.ok())?;
        let base = match pointer.base {
            Base::Slots(first) => {
                let Ok(index) = index else {
                    return Err(LowerError::Unsupported("computed indices of this variable"));
                };
                let [start, step] = part.scalars;
                let last = part.count.unwrap_or(1).saturating_sub(1);
                let index = if step == 0 { 0 } else { index.min(last) };
                Base::Slots(first + (start + index * step) as usize)
            }
            Base::Local { array, word } => Base::Local {
                array,
                word: self.moved(word, &part, part.scalars, index),
            },
            Base::Workgroup(word) => Base::Workgroup(self.moved(word, &part, part.scalars, index)),
            Base::Buffer { buffer, byte } => Base::Buffer {
                buffer,
                byte: self.moved(byte, &part, part.bytes, index),
            },
        };
        Ok(Pointer {
            base,
            inner: part.inner,
        })
    }

    /// A place moved by an index, which is held to those that exist.
    fn moved(
        &mut self,
        at: Value,
        part: &Part,
        [start, step]: [u32; 2],
        index: Result<u32, Value>,
    ) -> Value {
        let offset = match index {
            Ok(_) if step == 0 => self.builder.word(start),
            Ok(index) => self
                .builder
                .word(index.wrapping_mul(step).wrapping_add(start)),
            Err(index) => {
                let index = match part.count {
                    Some(count) => {
                        let last = self.builder.word(count.saturating_sub(1));
                        self.builder.binary(Binary::UMin, index, last)
                    }
                    // A product that overflows must not come back into the buffer.
                    None => {
                        let last = self.builder.word((u32::MAX >> 1) / step.max(1));
                        self.builder.binary(Binary::UMin, index, last)
                    }
                };
                let step = self.builder.word(step);
                self.builder.binary(Binary::Mul, index, step)
            }
        };
        self.builder.binary(Binary::Add, at, offset)
    }

    /// The scalars at a place.
    pub(super) fn load(&mut self, pointer: &Pointer) -> Lowered<Vec<Value>> {
        if let Base::Slots(first) = pointer.base {
            let count = scalars(self.module, &pointer.inner)?.len();
            return Ok(self.slots[first..first + count].to_vec());
        }
        let mut loaded = Vec::new();
        self.each_scalar(pointer, &mut |lowering, base, scalar| {
            let word = lowering.load_word(base);
            loaded.push(lowering.loaded_from_word(word, scalar)?);
            Ok(())
        })?;
        Ok(loaded)
    }

    /// Stores scalars at a place.
    pub(super) fn store(&mut self, pointer: &Pointer, values: &[Value]) -> Lowered<()> {
        if let Base::Slots(first) = pointer.base {
            self.slots[first..first + values.len()].copy_from_slice(values);
            return Ok(());
        }
        let mut values = values.iter();
        self.each_scalar(pointer, &mut |lowering, base, scalar| {
            if let Some(&value) = values.next() {
                let word = lowering.word_to_store(value, scalar, &base)?;
                lowering.store_word(base, word);
            }
            Ok(())
        })
    }

    /// Calls `visit` with the place of each scalar.
    fn each_scalar(
        &mut self,
        pointer: &Pointer,
        visit: &mut dyn FnMut(&mut Self, Base, Scalar) -> Lowered<()>,
    ) -> Lowered<()> {
        if self.builder.len() > super::MAX_VALUES {
            return Err(LowerError::TooLarge);
        }
        match pointer.inner {
            TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => {
                visit(self, pointer.base, scalar)
            }
            TypeInner::Struct { ref members, .. } => {
                for index in 0..u32::try_from(members.len()).unwrap_or(u32::MAX) {
                    let member = self.access(pointer, Ok(index))?;
                    self.each_scalar(&member, visit)?;
                }
                Ok(())
            }
            _ => {
                let count = part(self.module, &pointer.inner, None)?.count;
                let count = count.ok_or(LowerError::Unsupported("values of unknown size"))?;
                for index in 0..count {
                    let element = self.access(pointer, Ok(index))?;
                    self.each_scalar(&element, visit)?;
                }
                Ok(())
            }
        }
    }

    fn load_word(&mut self, base: Base) -> Value {
        self.builder.op1(match base {
            Base::Slots(slot) => return self.slots[slot],
            Base::Local { array, word } => Op::LoadLocal { array, index: word },
            Base::Workgroup(word) => Op::LoadWorkgroup(word),
            Base::Buffer { buffer, byte } => Op::LoadBuffer {
                buffer,
                offset: byte,
            },
        })
    }

    fn store_word(&mut self, base: Base, value: Value) {
        let mask = self.slots[self.cover];
        let always = self.builder.mask(true);
        self.builder.op(match base {
            Base::Slots(slot) => {
                self.slots[slot] = value;
                return;
            }
            Base::Local { array, word } => Op::StoreLocal {
                array,
                index: word,
                value,
                mask: always,
            },
            Base::Workgroup(index) => Op::StoreWorkgroup { index, value, mask },
            Base::Buffer { buffer, byte } => Op::StoreBuffer {
                buffer,
                offset: byte,
                value,
                mask,
            },
        });
    }

    /// A word of memory as a scalar: masks are words that are not 0.
    fn loaded_from_word(&mut self, word: Value, scalar: Scalar) -> Lowered<Value> {
        Ok(match kind_of(scalar)? {
            Type::Word => word,
            Type::Mask => {
                let zero = self.builder.word(0);
                self.builder.compare(Compare::Ne, word, zero)
            }
        })
    }

    /// A scalar as a word of memory. The host sees one NaN alone.
    fn word_to_store(&mut self, value: Value, scalar: Scalar, base: &Base) -> Lowered<Value> {
        Ok(match kind_of(scalar)? {
            Type::Mask => {
                let (one, zero) = (self.builder.word(1), self.builder.word(0));
                self.builder.select(value, one, zero)
            }
            Type::Word
                if scalar.kind == ScalarKind::Float && matches!(base, Base::Buffer { .. }) =>
            {
                self.builder.unary(Unary::Canonical, value)
            }
            Type::Word => value,
        })
    }
}
