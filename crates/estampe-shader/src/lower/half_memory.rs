//! 16-bit floats in buffers and immediates, where two share a word.
//!
//! | access | of a buffer |
//! |---|---|
//! | load | the word that holds it, shifted, and converted |
//! | store of two that are a word | the word |
//! | store of one | [`Atomic::StoreHalf`]: other invocations may store to the other half meanwhile |
//!
//! Loads are of words, so that one word gives both components of a pair. Everywhere else, in
//! variables and in the work-group's memory, a 16-bit float has a word for itself, as binary32.

use super::Lowering;
use super::half::is_half;
use super::pointer::{Base, InWord};
use super::types::Part;
use estampe_ir::op::{Atomic, Binary, Memory, Unary};
use estampe_ir::{Op, Value};
use naga::Scalar;

/// 16-bit floats in a buffer, one after the other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Halves {
    buffer: u32,
    byte: Value,
    place: InWord,
    count: u32,
}

impl Halves {
    /// Those at a place, if it is in a buffer and has such scalars. Several begin with a word.
    pub(super) fn of(base: &Base, scalar: Scalar, count: u32) -> Option<Self> {
        match *base {
            Base::Buffer {
                buffer,
                byte,
                place,
            } if is_half(scalar) && (count == 1 || place == InWord::After(0)) => Some(Self {
                buffer,
                byte,
                place,
                count,
            }),
            _ => None,
        }
    }
}

impl Lowering<'_> {
    /// A place in a buffer moved by an index.
    pub(super) fn moved_in_buffer(
        &mut self,
        (buffer, byte, place): (u32, Value, InWord),
        part: &Part,
        index: Result<u32, Value>,
    ) -> Base {
        let [start, step] = part.bytes;
        let (byte, place) = match (place, index) {
            (InWord::After(before), Ok(index)) => {
                let offset = if step == 0 {
                    start
                } else {
                    index.wrapping_mul(step).wrapping_add(start)
                };
                let offset = offset.wrapping_add(before);
                (self.behind(byte, offset & !3), InWord::After(offset & 2))
            }
            (InWord::After(_), Err(_)) if step.is_multiple_of(4) => {
                (self.moved(byte, part, part.bytes, index), place)
            }
            _ => {
                let byte = self.first_byte(byte, place);
                let moved = self.moved(byte, part, part.bytes, index);
                (moved, InWord::Computed)
            }
        };
        Base::Buffer {
            buffer,
            byte,
            place,
        }
    }

    /// The byte with which a place in a buffer begins.
    pub(super) fn first_byte(&mut self, byte: Value, place: InWord) -> Value {
        match place {
            InWord::After(bytes) => self.behind(byte, bytes),
            InWord::Computed => byte,
        }
    }

    fn behind(&mut self, byte: Value, offset: u32) -> Value {
        let offset = self.builder.word(offset);
        self.builder.binary(Binary::Add, byte, offset)
    }

    pub(super) fn load_halves(&mut self, halves: &Halves) -> Vec<Value> {
        let Halves {
            buffer,
            byte,
            place,
            count,
        } = *halves;
        let load =
            |lowering: &mut Self, offset| lowering.builder.op1(Op::LoadBuffer { buffer, offset });
        let InWord::After(first) = place else {
            let word = load(self, byte);
            // Eight times an even byte, modulo 32, is 0 or 16; shifts are modulo 32.
            let by = self.shifted(Binary::Shl, byte, 3);
            let code = self.builder.binary(Binary::UShr, word, by);
            return vec![self.builder.unary(Unary::F32FromF16, code)];
        };
        let mut word = None;
        let mut numbers = Vec::new();
        for at in 0..count {
            let offset = first + 2 * at;
            let is_high = offset & 2 != 0;
            let code = match word.filter(|_| is_high) {
                Some(word) => word,
                None => {
                    let byte = self.behind(byte, offset & !3);
                    *word.insert(load(self, byte))
                }
            };
            // The operation takes the low half of a word.
            let code = if is_high {
                self.shifted(Binary::UShr, code, 16)
            } else {
                code
            };
            numbers.push(self.builder.unary(Unary::F32FromF16, code));
        }
        numbers
    }

    /// A number of the immediates, from a byte on.
    pub(super) fn load_half_immediate(&mut self, byte: Value) -> Value {
        let start = match self.builder.constant_of(byte) {
            Some(byte) => self.builder.word(byte & !3),
            // Loads round the offset down.
            None => byte,
        };
        let word = self.immediate_word(start);
        let by = self.shifted(Binary::Shl, byte, 3);
        let code = self.builder.binary(Binary::UShr, word, by);
        self.builder.unary(Unary::F32FromF16, code)
    }

    pub(super) fn store_halves(&mut self, halves: &Halves, values: &[Value]) {
        let Halves {
            buffer,
            byte,
            place,
            ..
        } = *halves;
        let mask = self.slots[self.cover];
        let encode = |value: &Value| self.builder.unary(Unary::F16FromF32, *value);
        let codes: Vec<_> = values.iter().map(encode).collect();
        // A vector begins with a word.
        for (at, pair) in (0..).zip(codes.chunks(2)) {
            let start = self.first_byte(byte, place);
            let offset = self.behind(start, 4 * at);
            if let [low, high] = *pair {
                let high = self.shifted(Binary::Shl, high, 16);
                let value = self.builder.binary(Binary::Or, low, high);
                self.builder.op(Op::StoreBuffer {
                    buffer,
                    offset,
                    value,
                    mask,
                });
                continue;
            }
            // The highest bit of the operand says which half, as bit 1 of the offset does. Bit 0
            // of the offset is 0.
            let half = match place {
                InWord::After(bytes) => self.builder.word(bytes << 30),
                InWord::Computed => self.shifted(Binary::Shl, byte, 30),
            };
            let value = self.builder.binary(Binary::Or, pair[0], half);
            self.builder.op(Op::Atomic {
                kind: Atomic::StoreHalf,
                memory: Memory::Buffer(buffer),
                offset,
                value,
                mask,
            });
        }
    }

    fn shifted(&mut self, kind: Binary, word: Value, bits: u32) -> Value {
        let bits = self.builder.word(bits);
        self.builder.binary(kind, word, bits)
    }
}
