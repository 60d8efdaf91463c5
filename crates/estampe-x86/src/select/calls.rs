//! Calls of what code does not do itself.
//!
//! Operands and results are packets in the frame; the mask has a place of its own. The code names
//! the call by its number among those of the kernel.

use super::Selector;
use super::operands::Source;
use crate::CompileError;
use crate::encoder::vector_op;
use crate::frame::{MASK_ARGUMENT, MASK_RESULT, PACKET, displacement};
use crate::machine::{Instruction, Memory, MemoryBase};
use estampe_ir::lanes::Kernel;
use estampe_ir::op::{Atomic, Binary, Memory as Shared, TextureOp, Unary};
use estampe_ir::{Op, Type, Value};

/// A call.
#[derive(Debug, Clone)]
pub(crate) struct Served {
    pub(crate) kind: Kind,
    /// The number of packets that are given; the results follow them.
    pub(crate) operands: usize,
    /// The number of packets that are returned.
    pub(crate) results: usize,
    /// Bit i is set if result i is uniform. Lanes outside of the mask are given it, too: code
    /// branches where any lane of a uniform mask is set.
    pub(crate) uniform: u8,
}

/// What a call asks for.
#[derive(Debug, Clone)]
pub(crate) enum Kind {
    Unary(Unary),
    Binary(Binary),
    /// Offset and word.
    Store {
        memory: Shared,
    },
    /// Index and word.
    StoreLocal {
        array: u32,
    },
    /// Offset and operand; a word.
    Atomic {
        kind: Atomic,
        memory: Shared,
    },
    /// Offset, expected word and new word; a word and a mask.
    CompareExchange {
        memory: Shared,
    },
    Texture(Box<TextureOp>),
}

impl Served {
    fn new(op: &Op) -> Option<Self> {
        let results = op.results().iter();
        Some(Self {
            kind: Kind::new(op)?,
            operands: words(op).len(),
            results: results.filter(|kind| **kind == Type::Word).count(),
            uniform: 0,
        })
    }
}

impl Kind {
    fn new(op: &Op) -> Option<Self> {
        Some(match op {
            Op::Unary(kind, _) => Self::Unary(*kind),
            Op::Binary(kind, _) => Self::Binary(*kind),
            Op::StoreBuffer { buffer, .. } => Self::Store {
                memory: Shared::Buffer(*buffer),
            },
            Op::StoreWorkgroup { .. } => Self::Store {
                memory: Shared::Workgroup,
            },
            Op::StoreLocal { array, .. } => Self::StoreLocal { array: *array },
            Op::Atomic { kind, memory, .. } => Self::Atomic {
                kind: *kind,
                memory: *memory,
            },
            Op::CompareExchange { memory, .. } => Self::CompareExchange { memory: *memory },
            Op::Texture(op) => Self::Texture(op.clone()),
            _ => return None,
        })
    }
}

/// The operands of an operation that are words.
fn words(op: &Op) -> Vec<Value> {
    let mut words = Vec::new();
    op.each_operand(|value, kind| words.extend((kind == Type::Word).then_some(value)));
    words
}

/// The most packets that a call of the kernel needs.
pub(super) fn most_packets(kernel: &Kernel) -> u32 {
    let ops = kernel.blocks.iter().flat_map(|block| &block.ops);
    let packets = ops.filter_map(|(op, _)| Served::new(op));
    let packets = packets.map(|served| served.operands + served.results);
    u32::try_from(packets.max().unwrap_or(0)).unwrap_or(u32::MAX)
}

impl Selector<'_> {
    /// An operation that a call does.
    pub(super) fn call(&mut self, op: &Op, first: Value) -> Result<(), CompileError> {
        let mut served = Served::new(op).ok_or(CompileError::Unknown)?;
        for (bit, value) in first.and_next(served.results).iter().enumerate() {
            let is_uniform = self.kernel.values[value.index()].is_uniform;
            served.uniform |= u8::from(is_uniform) << bit;
        }
        let place = |packet: usize| {
            let packet = u32::try_from(packet).unwrap_or(0);
            displacement(self.frame.arguments + packet * PACKET)
        };
        let places: Vec<i32> = (0..served.operands + served.results).map(place).collect();
        let (operands, results) = places.split_at(served.operands);
        let mask = op.clone().mask_mut().copied();
        let at = u32::try_from(self.served.len()).map_err(|_| CompileError::TooLarge)?;
        self.served.push(served);
        for halves in self.packets_of_pass() {
            for half in halves.clone() {
                let offset = self.half_words(half);
                for (value, to) in words(op).into_iter().zip(operands) {
                    let word = self.word_register(value, half);
                    self.store_words((MemoryBase::Frame, to + offset), None, word);
                }
                if let Some(mask) = mask {
                    let mask = self.mask(mask, half);
                    self.store_mask((MASK_ARGUMENT, half), None, mask);
                }
            }
            self.function.push(Instruction::Call(at), &[]);
            self.buffer_pointers.fill(None);
            for half in halves {
                self.results(op, (first, half), results);
            }
        }
        Ok(())
    }

    /// Loads the results of a call, of which words lie at these places.
    fn results(&mut self, op: &Op, (first, half): (Value, usize), places: &[i32]) {
        let offset = self.half_words(half);
        let types = op.results();
        for (kind, value) in types.iter().zip(first.and_next(types.len())) {
            let register = match kind {
                Type::Word => {
                    let packet = (value.0 - first.0) as usize;
                    let memory = Memory {
                        base: MemoryBase::Frame,
                        offset: places[packet] + offset,
                        is_broadcast: false,
                    };
                    self.one(&vector_op::LOAD, Source::Memory(memory, None))
                }
                Type::Mask => self.load_mask(MemoryBase::Frame, (MASK_RESULT, half), None),
            };
            self.define(value, half, register);
        }
    }
}
