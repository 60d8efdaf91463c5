//! The interpreter's loop.

use super::super::Stopped;
use super::super::instruction::{Instruction, Mask, Slot};
use super::arithmetic::Arithmetic;
use super::state::{MaskOperand, State, quads_with_any};
use super::table::Table;
use crate::op::MaskBinary;
use estampe_simd::Packet;

/// How far a chunk is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Progress {
    /// The next instruction; `None` at the end.
    pub(super) next: Option<usize>,
    /// The jumps that it may still execute.
    pub(super) budget: u64,
}

/// Executes the instructions on a chunk, up to the next barrier or to the end.
#[inline(always)]
pub(super) fn chunk<A: Arithmetic>(
    level: A,
    state: &State<'_>,
    from: Progress,
) -> Result<Progress, Stopped> {
    let entries = const { &Table::<A>::ENTRIES };
    let Progress {
        next: Some(mut next),
        mut budget,
    } = from
    else {
        return Ok(from);
    };
    while let Some((entry, instruction)) = state.code.instructions.get(next) {
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
            Instruction::Barrier => {
                let next = Some(next);
                return Ok(Progress { next, budget });
            }
            Instruction::Return => break,
            _ => entries[usize::from(*entry)](level, state, instruction),
        }
    }
    Ok(Progress { next: None, budget })
}

/// Executes an instruction that is the same at all SIMD levels.
pub(super) fn copies_and_memory(state: &State<'_>, instruction: &Instruction) {
    match instruction {
        Instruction::Scalar(to, op) => state.scalar(*to, op),
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
        Instruction::QuadLane(lane, to, value, mask) => {
            quad_lane(state, *lane, (*to, *value), state.mask(*mask));
        }
        Instruction::QuadAny(to, a) => {
            for (to, a) in state.mask_slot(*to).iter().zip(state.mask_slot(*a)) {
                to.set(quads_with_any(a.get()));
            }
        }
        Instruction::InputMask(to, at) => state.input_mask(state.mask_slot(*to), *at),
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
        // The loop and the functions of the SIMD levels execute the others.
        _ => {}
    }
}

fn quad_lane(state: &State<'_>, lane: u8, (to, value): (Slot, Slot), mask: MaskOperand<'_>) {
    let words = state.slot(to).iter().zip(state.slot(value));
    for (packet, (to, value)) in words.enumerate() {
        let (value, mask) = (value.get().0, mask.packet(packet));
        let of_lane = |at: usize| {
            let from = at & !3 | usize::from(lane & 3);
            value[from] * u32::from(mask >> from & 1)
        };
        to.set(Packet(core::array::from_fn(of_lane)));
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
