//! Places, and what is loaded from and stored to them.

use super::half::is_half;
use super::half_memory::Halves;
use super::types::{Part, is_wide, kind_of, part, scalars};
use super::{LowerError, Lowered, Lowering};
use estampe_ir::interface::{BufferSlot, Input};
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
    Buffer {
        buffer: u32,
        byte: Value,
        place: InWord,
    },
    /// The immediates, from this byte on.
    Immediates(Value),
}

/// Where in a word of a buffer a place begins: 16-bit floats need not begin where a word does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum InWord {
    /// So many bytes, 0 or 2, after the byte that the place names, with which a word begins.
    After(u32),
    /// At the byte that the place names, with which a word or its second half begins.
    Computed,
}

/// A scalar at a place; in buffers also the components of a vector of 16-bit floats, which share
/// words.
#[derive(Debug, Clone, Copy)]
struct Scalars {
    base: Base,
    scalar: Scalar,
    count: u32,
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
            Base::Buffer {
                buffer,
                byte,
                place,
            } => self.moved_in_buffer((buffer, byte, place), &part, index),
            Base::Immediates(byte) => {
                let moved = self.moved(byte, &part, part.bytes, index);
                if let (Some(first), None) = (
                    self.builder.constant_of(byte),
                    self.builder.constant_of(moved),
                ) {
                    // Any of the elements is read.
                    let size = pointer.inner.size(self.module.to_ctx());
                    self.read_immediates(first, size);
                }
                Base::Immediates(moved)
            }
        };
        Ok(Pointer {
            base,
            inner: part.inner,
        })
    }

    /// A place moved by an index, which is held to those that exist.
    pub(super) fn moved(
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
        self.each_scalar(pointer, &mut |lowering, scalars| {
            let Scalars { base, scalar, .. } = scalars;
            if let Some(halves) = scalars.halves() {
                loaded.extend(lowering.load_halves(&halves));
                return Ok(());
            }
            if let (Base::Immediates(byte), true) = (base, is_half(scalar)) {
                loaded.push(lowering.load_half_immediate(byte));
                return Ok(());
            }
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
        let mut values = values.iter().copied();
        self.each_scalar(pointer, &mut |lowering, scalars| {
            let Scalars { base, scalar, .. } = scalars;
            if let Some(halves) = scalars.halves() {
                let values: Vec<_> = values.by_ref().take(scalars.count as usize).collect();
                lowering.store_halves(&halves, &values);
            } else if let Some(value) = values.next() {
                let word = lowering.word_to_store(value, scalar, &base)?;
                lowering.store_word(base, word);
            }
            Ok(())
        })
    }

    /// Calls `visit` with each scalar, or with several that share words; of a 64-bit integer with
    /// both words.
    fn each_scalar(
        &mut self,
        pointer: &Pointer,
        visit: &mut dyn FnMut(&mut Self, Scalars) -> Lowered<()>,
    ) -> Lowered<()> {
        if self.builder.len() > super::MAX_VALUES {
            return Err(LowerError::TooLarge);
        }
        let some = |scalar, count| Scalars {
            base: pointer.base,
            scalar,
            count,
        };
        match pointer.inner {
            TypeInner::Scalar(scalar) if is_wide(scalar) => {
                visit(self, some(Scalar::U32, 1))?;
                let base = self.next_word(pointer.base);
                let high = Scalars {
                    base,
                    ..some(Scalar::U32, 1)
                };
                visit(self, high)
            }
            TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => visit(self, some(scalar, 1)),
            TypeInner::Vector { size, scalar } if some(scalar, size as u32).halves().is_some() => {
                visit(self, some(scalar, size as u32))
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

    /// The place of the word behind another.
    fn next_word(&mut self, base: Base) -> Base {
        let mut after = |at: Value, step: u32| {
            let step = self.builder.word(step);
            self.builder.binary(Binary::Add, at, step)
        };
        match base {
            Base::Slots(slot) => Base::Slots(slot + 1),
            Base::Local { array, word } => Base::Local {
                array,
                word: after(word, 1),
            },
            Base::Workgroup(word) => Base::Workgroup(after(word, 1)),
            Base::Buffer {
                buffer,
                byte,
                place,
            } => Base::Buffer {
                buffer,
                byte: after(byte, 4),
                place,
            },
            Base::Immediates(byte) => Base::Immediates(after(byte, 4)),
        }
    }

    /// Notes that the bytes from `first` on are read.
    fn read_immediates(&mut self, first: u32, size: u32) {
        let end = first.saturating_add(size);
        self.immediate_size = self.immediate_size.max(end);
    }

    /// A word of the immediates: an input, or at a computed place one of a buffer that holds them.
    pub(super) fn immediate_word(&mut self, byte: Value) -> Value {
        if let Some(byte) = self.builder.constant_of(byte) {
            self.read_immediates(byte, 4);
            return self.builder.input(Input::PushConstant(byte / 4));
        }
        let buffers = &mut self.builder.interface_mut().buffers;
        let found = buffers
            .iter()
            .position(|slot| *slot == BufferSlot::IMMEDIATES);
        let buffer = found.unwrap_or_else(|| {
            buffers.push(BufferSlot::IMMEDIATES);
            buffers.len() - 1
        });
        let buffer = u32::try_from(buffer).expect("few buffers");
        self.builder.op1(Op::LoadBuffer {
            buffer,
            offset: byte,
        })
    }

    fn load_word(&mut self, base: Base) -> Value {
        self.builder.op1(match base {
            Base::Slots(slot) => return self.slots[slot],
            Base::Immediates(byte) => return self.immediate_word(byte),
            Base::Local { array, word } => Op::LoadLocal { array, index: word },
            Base::Workgroup(word) => Op::LoadWorkgroup(word),
            Base::Buffer { buffer, byte, .. } => Op::LoadBuffer {
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
            Base::Immediates(_) => unreachable!("a module that stores to immediates is refused"),
            Base::Local { array, word } => Op::StoreLocal {
                array,
                index: word,
                value,
                mask: always,
            },
            Base::Workgroup(index) => Op::StoreWorkgroup { index, value, mask },
            Base::Buffer { buffer, byte, .. } => Op::StoreBuffer {
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

impl Scalars {
    /// The 16-bit floats in a buffer, if these are such.
    fn halves(&self) -> Option<Halves> {
        Halves::of(&self.base, self.scalar, self.count)
    }
}
