//! The interpreter's loop.

use super::super::Stopped;
use super::super::instruction::{Instruction, Mask};
use super::arithmetic::Arithmetic;
use super::state::{MaskOperand, Operand, State, quads_with_any};
use crate::op::MaskBinary;
use estampe_simd::{LANES, Packet};

/// Executes the instructions on a chunk.
#[inline(always)]
pub(super) fn chunk<A: Arithmetic>(level: A, state: &State<'_>) -> Result<(), Stopped> {
    let mut budget = state.run.budget;
    let mut next = 0;
    while let Some(instruction) = state.code.instructions.get(next) {
        next += 1;
        match instruction {
            Instruction::Jump(to) => {
                budget = budget.checked_sub(1).ok_or(Stopped::Budget)?;
                next = *to as usize;
            }
            Instruction::Branch(mask, [any, none]) => {
                budget = budget.checked_sub(1).ok_or(Stopped::Budget)?;
                next = *if state.any(*mask) { any } else { none } as usize;
            }
            Instruction::Return => return Ok(()),
            Instruction::Scalar(to, op) => state.scalar(*to, op),
            _ => on_lanes(level, state, instruction),
        }
    }
    Ok(())
}

/// Executes an instruction on registers.
#[inline(always)]
fn on_lanes<A: Arithmetic>(level: A, state: &State<'_>, instruction: &Instruction) {
    match *instruction {
        Instruction::Unary(kind, to, a) => level.unary(kind, state.slot(to), state.slot(a)),
        Instruction::Binary(kind, to, pair) => {
            level.binary(kind, state.slot(to), pair.map(|word| state.word(word)));
        }
        Instruction::Product(kind, to, three) => {
            level.product(kind, state.slot(to), three.map(|word| state.word(word)));
        }
        Instruction::Fma(to, three) => {
            level.fma(state.slot(to), three.map(|slot| state.slot(slot)));
        }
        Instruction::Compare(kind, to, pair) => {
            level.compare(kind, state.mask_slot(to), pair.map(|word| state.word(word)));
        }
        Instruction::Select(to, mask, pair) => {
            let pair = pair.map(|word| state.word(word));
            level.select(state.slot(to), state.mask(mask), pair);
        }
        Instruction::Math(function, to, x) => {
            level.math(function, state.slot(to), state.slot(x));
        }
        Instruction::Math2(function, to, pair) => {
            level.math2(function, state.slot(to), pair.map(|slot| state.slot(slot)));
        }
        Instruction::Derivative(axis, precision, to, value, mask) => {
            let (value, mask) = (state.slot(value), state.mask(mask));
            level.derivative((axis, precision), state.slot(to), value, mask);
        }
        Instruction::LoadTable(table, to, index) => {
            let table = &state.code.tables[table as usize];
            level.gather(state.slot(to), table, state.slot(index), 0, true);
        }
        Instruction::LoadBuffer(to, buffer, offset) => {
            state.load_buffer(level, state.slot(to), buffer, state.slot(offset));
        }
        _ => copies_and_memory(state, instruction),
    }
}

/// Executes an instruction that is the same at all SIMD levels.
#[inline(never)]
fn copies_and_memory(state: &State<'_>, instruction: &Instruction) {
    match instruction {
        Instruction::Copy(to, word) => match state.word(*word) {
            Operand::Many(from) => {
                for (to, from) in state.slot(*to).iter().zip(from) {
                    to.set(from.get());
                }
            }
            Operand::One(word) => {
                let packet = Packet([word; LANES]);
                state.slot(*to).iter().for_each(|to| to.set(packet));
            }
        },
        Instruction::CopyMask(to, mask) => {
            let mask = state.mask(*mask);
            for (packet, to) in state.mask_slot(*to).iter().enumerate() {
                to.set(mask.packet(packet));
            }
        }
        Instruction::MaskNot(to, a) => {
            for (to, a) in state.mask_slot(*to).iter().zip(state.mask_slot(*a)) {
                to.set(!a.get());
            }
        }
        Instruction::MaskBinary(kind, to, pair) => mask_binary(state, *kind, (*to, *pair)),
        Instruction::QuadAny(to, a) => {
            for (to, a) in state.mask_slot(*to).iter().zip(state.mask_slot(*a)) {
                to.set(quads_with_any(a.get()));
            }
        }
        Instruction::Input(to, at) => state.input(state.slot(*to), *at),
        Instruction::InputMask(to, at) => state.input_mask(state.mask_slot(*to), *at),
        Instruction::Output(at, word) => state.output(*at, state.word(*word)),
        Instruction::OutputMask(at, mask) => state.output_mask(*at, state.mask(*mask)),
        Instruction::LoadLocal(to, array, index) => {
            state.load_local(state.slot(*to), state.array(*array), state.word(*index));
        }
        Instruction::StoreLocal(array, words, mask) => {
            let words = words.map(|word| state.word(word));
            state.store_local(state.array(*array), words, state.mask(*mask));
        }
        Instruction::StoreBuffer(buffer, words, mask) => {
            let words = words.map(|word| state.word(word));
            state.store_buffer(*buffer, words, state.mask(*mask));
        }
        Instruction::LoadWorkgroup(to, index) => {
            state.load_workgroup(state.slot(*to), state.slot(*index));
        }
        Instruction::StoreWorkgroup(words, mask) => {
            let words = words.map(|word| state.word(word));
            state.store_workgroup(words, state.mask(*mask));
        }
        Instruction::Atomic(code) => state.atomic(code),
        Instruction::CompareExchange(code) => state.compare_exchange(code),
        Instruction::Texture(code) => state.texture(code),
        // The loop, and the SIMD level, execute the others.
        _ => {}
    }
}

fn mask_binary(
    state: &State<'_>,
    kind: MaskBinary,
    (to, pair): (super::super::instruction::MaskSlot, [Mask; 2]),
) {
    let [a, b] = pair.map(|mask| state.mask(mask));
    let combine = |combine: fn(u16, u16) -> u16| match (a, b) {
        (MaskOperand::Many(a), MaskOperand::Many(b)) => {
            for ((to, a), b) in state.mask_slot(to).iter().zip(a).zip(b) {
                to.set(combine(a.get(), b.get()));
            }
        }
        _ => {
            for (packet, to) in state.mask_slot(to).iter().enumerate() {
                to.set(combine(a.packet(packet), b.packet(packet)));
            }
        }
    };
    match kind {
        MaskBinary::And => combine(|a, b| a & b),
        MaskBinary::Or => combine(|a, b| a | b),
        MaskBinary::Xor => combine(|a, b| a ^ b),
        MaskBinary::AndNot => combine(|a, b| a & !b),
    }
}
