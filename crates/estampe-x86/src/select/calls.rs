//! Calls of what code does not do itself.
//!
//! Operands and results are packets in the frame; the mask has a place of its own. The code names
//! the call by its number among those of the kernel.

use super::Selector;
use super::operands::Source;
use super::plan::Plan;
use crate::CompileError;
use crate::encoder::vector_op;
use crate::frame::{MASK_ARGUMENT, MASK_RESULT, PACKET, SECOND_MASK_ARGUMENT, displacement};
use crate::machine::{Instruction, Memory, MemoryBase};
use estampe_ir::interpreter::Common;
use estampe_ir::lanes::Kernel;
use estampe_ir::op::{Atomic, Memory as Shared, TextureOp};
use estampe_ir::{Op, Type, Value};
use std::ops::Range;

/// A call.
#[derive(Debug, Clone)]
pub(crate) struct Served {
    pub(crate) kind: Kind,
    /// The number of packets that are given; the results follow them.
    pub(crate) operands: usize,
    /// The number of packets that are returned.
    pub(crate) results: usize,
    /// The packets of lanes that are served, one after the other: 1, or 2.
    pub(crate) lanes: usize,
    /// Bit i is set if result i is uniform. Lanes outside of the mask are given it, too: code
    /// branches where any lane of a uniform mask is set.
    pub(crate) uniform: u64,
}

/// What a call asks for.
#[derive(Debug, Clone)]
pub(crate) enum Kind {
    /// Offset and word.
    Store { memory: Shared },
    /// Offset and operand; a word.
    Atomic { kind: Atomic, memory: Shared },
    /// Offset, expected word and new word; a word and a mask.
    CompareExchange { memory: Shared },
    /// Accesses to textures in the same lanes, none of which needs another's results.
    Textures(Vec<TextureOp>, Common),
}

impl Served {
    fn new(op: &Op) -> Option<Self> {
        let results = op.results().iter();
        Some(Self {
            kind: Kind::new(op)?,
            operands: words(op).len(),
            results: results.filter(|kind| **kind == Type::Word).count(),
            lanes: 1,
            uniform: 0,
        })
    }
}

impl Kind {
    fn new(op: &Op) -> Option<Self> {
        Some(match op {
            Op::StoreBuffer { buffer, .. } => Self::Store {
                memory: Shared::Buffer(*buffer),
            },
            Op::StoreWorkgroup { .. } => Self::Store {
                memory: Shared::Workgroup,
            },
            Op::Atomic { kind, memory, .. } => Self::Atomic {
                kind: *kind,
                memory: *memory,
            },
            Op::CompareExchange { memory, .. } => Self::CompareExchange { memory: *memory },
            Op::Texture(op) => {
                let ops = vec![TextureOp::clone(op)];
                let common = Common::of(&ops);
                Self::Textures(ops, common)
            }
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

/// The most accesses to textures that are one call.
const MOST_JOINED: usize = 16;

/// The most accesses among which those that can be one call are looked for.
const MOST_ADJACENT: usize = 64;

/// The most packets that a call of the kernel needs, for so many packets of lanes.
pub(super) fn most_packets(kernel: &Kernel, plan: &Plan, lanes: usize) -> u32 {
    let of_block = |ops: &[(Op, Value)]| {
        let (mut most, mut joined) = (0, 0);
        for (op, _) in ops {
            // No call, but lane by lane its numbers and words are where the packets of calls are.
            if matches!(op, Op::StoreLocal { .. }) {
                most = most.max(2);
            }
            let Some(served) = Served::new(op) else {
                continue;
            };
            most = most.max(served.operands + served.results);
            joined += usize::from(plan.can_join(op));
        }
        most * joined.clamp(1, MOST_JOINED) * lanes
    };
    let most = kernel.blocks.iter().map(|block| of_block(&block.ops));
    u32::try_from(most.max().unwrap_or(0)).unwrap_or(u32::MAX)
}

/// How many operations, from the first on, are accesses to textures in the same lanes of which none
/// needs another's result: at least one.
pub(super) fn joined(plan: &Plan, ops: &[&(Op, Value)]) -> usize {
    let Some((op, _)) = ops.first().filter(|(op, _)| plan.can_join(op)) else {
        return 1;
    };
    let mask = op.clone().mask_mut().copied();
    let mut results: Vec<Value> = Vec::new();
    let mut count = 0;
    for (op, first) in ops.iter().take(MOST_ADJACENT) {
        let mut needs_another = false;
        op.each_operand(|value, _| needs_another |= results.contains(&value));
        if !plan.can_join(op) || op.clone().mask_mut().copied() != mask || needs_another {
            break;
        }
        results.extend(first.and_next(op.results().len()));
        count += 1;
    }
    count.max(1)
}

/// The halves of packets, each with the number of its packet.
fn each_half(packets: &[Range<usize>]) -> impl Iterator<Item = (usize, usize)> {
    let packets = packets.iter().cloned().enumerate();
    packets.flat_map(|(packet, halves)| halves.map(move |half| (packet, half)))
}

fn texture_op(op: &Op) -> Option<TextureOp> {
    match op {
        Op::Texture(op) => Some(TextureOp::clone(op)),
        _ => None,
    }
}

/// Accesses that need no other's results, in groups: what those of a group have in common makes
/// them cheaper together.
pub(super) fn groups<'o>(ops: &[&'o (Op, Value)]) -> Vec<Vec<&'o (Op, Value)>> {
    let mut groups: Vec<Vec<&(Op, Value)>> = Vec::new();
    for &one in ops {
        let is_like = |group: &&mut Vec<&(Op, Value)>| {
            let with_one = group.iter().copied().chain([one]);
            let ops: Vec<TextureOp> = with_one.filter_map(|(op, _)| texture_op(op)).collect();
            ops.len() == group.len() + 1
                && ops.len() <= MOST_JOINED
                && Common::of(&ops) != Common::Nothing
        };
        match groups.iter_mut().find(is_like) {
            Some(group) => group.push(one),
            None => groups.push(vec![one]),
        }
    }
    groups
}

impl Selector<'_> {
    /// An operation that a call does.
    pub(super) fn call(&mut self, op: &Op, first: Value) -> Result<(), CompileError> {
        let served = Served::new(op).ok_or(CompileError::Unknown)?;
        self.serve(&[&(op.clone(), first)], served)
    }

    /// Accesses to textures that are one call.
    pub(super) fn call_joined(&mut self, ops: &[&(Op, Value)]) -> Result<(), CompileError> {
        let mut textures = Vec::new();
        let (mut operands, mut results) = (0, 0);
        for (op, _) in ops {
            if let Op::Texture(op) = op {
                operands += op.words();
                results += op.query.results() as usize;
                textures.push(TextureOp::clone(op));
            }
        }
        let common = Common::of(&textures);
        if common.shares_operands() {
            // All have the operands of the first.
            operands = textures.first().map_or(0, TextureOp::words);
        }
        let served = Served {
            kind: Kind::Textures(textures, common),
            operands,
            results,
            lanes: 1,
            uniform: 0,
        };
        self.serve(ops, served)
    }

    /// Stores the operands, calls, and loads the results of operations that are one call.
    fn serve(&mut self, ops: &[&(Op, Value)], mut served: Served) -> Result<(), CompileError> {
        let is_word = |value: &Value| self.kernel.values[value.index()].kind == Type::Word;
        let values = ops
            .iter()
            .flat_map(|(op, first)| first.and_next(op.results().len()));
        for (bit, value) in values.filter(is_word).enumerate() {
            let is_uniform = self.kernel.values[value.index()].is_uniform;
            served.uniform |= u64::from(is_uniform) << bit;
        }
        let place = |packet: usize| {
            let packet = u32::try_from(packet).unwrap_or(0);
            displacement(self.frame.arguments + packet * PACKET)
        };
        // Nothing sees in which order textures are read: a call serves all packets of the pass.
        let passes = self.packets_of_pass();
        if ops.iter().all(|(op, _)| self.plan.can_join(op)) {
            served.lanes = passes.len();
        }
        let (lanes, inputs) = (served.lanes, served.operands);
        let packets = inputs + served.results;
        let places: Vec<i32> = (0..packets * lanes).map(place).collect();
        let places: Vec<&[i32]> = places.chunks(packets.max(1)).collect();
        let places = |of_call: usize| places.get(of_call).copied().unwrap_or_default();
        let mask = ops
            .first()
            .and_then(|(op, _)| op.clone().mask_mut().copied());
        let at = u32::try_from(self.served.len()).map_err(|_| CompileError::TooLarge)?;
        self.served.push(served);
        for served in passes.chunks(lanes) {
            for (of_call, half) in each_half(served) {
                let offset = self.half_words(half);
                let words = ops.iter().flat_map(|(op, _)| words(op));
                for (value, to) in words.take(inputs).zip(places(of_call)) {
                    let word = self.word_register(value, half);
                    self.store_words((MemoryBase::Frame, to + offset), None, word);
                }
                if let Some(mask) = mask {
                    let mask = self.mask(mask, half);
                    let place = match of_call {
                        0 => MASK_ARGUMENT,
                        _ => SECOND_MASK_ARGUMENT,
                    };
                    self.store_mask((place, half), None, mask);
                }
            }
            self.function.push(Instruction::Call(at), &[]);
            self.buffer_pointers.fill(None);
            for (of_call, half) in each_half(served) {
                let mut places = places(of_call).iter().skip(inputs);
                for (op, first) in ops {
                    self.results((op, *first), half, &mut places);
                }
            }
        }
        Ok(())
    }

    /// Loads the results of an operation, of which words lie at the next of these places.
    fn results<'p>(
        &mut self,
        (op, first): (&Op, Value),
        half: usize,
        places: &mut impl Iterator<Item = &'p i32>,
    ) {
        let offset = self.half_words(half);
        let types = op.results();
        for (kind, value) in types.iter().zip(first.and_next(types.len())) {
            let register = match kind {
                Type::Word => {
                    let memory = Memory {
                        base: MemoryBase::Frame,
                        offset: places.next().copied().unwrap_or(0) + offset,
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
