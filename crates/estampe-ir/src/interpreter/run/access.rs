//! Accesses to memory, lane after lane where their order matters.

use super::super::instruction::{AtomicCode, CompareExchangeCode, TextureCode};
use super::super::memory::{Words as BufferWords, atomic};
use super::super::{Buffer, TextureAccess};
use super::arithmetic::Arithmetic;
use super::state::{MaskOperand, Operand, State, Words};
use crate::op::{Atomic, Memory};
use estampe_simd::{LANES, Lane, Packet};
use std::sync::atomic::Ordering::Relaxed;

impl<'a> State<'a> {
    pub(super) fn buffer(&self, at: u32) -> Buffer<'a> {
        let buffers = self.run.buffers;
        buffers.get(at as usize).copied().unwrap_or_default()
    }

    #[inline(always)]
    pub(super) fn load_buffer<A: Arithmetic>(
        &self,
        level: A,
        to: Words<'_>,
        buffer: u32,
        offset: Words<'_>,
    ) {
        match self.buffer(buffer).words() {
            BufferWords::ReadOnly(words) => level.gather(to, words, offset, 2, false),
            BufferWords::Shared(_) => self.load_shared(to, buffer, offset),
        }
    }

    #[inline(never)]
    fn load_shared(&self, to: Words<'_>, buffer: u32, offset: Words<'_>) {
        let buffer = self.buffer(buffer);
        for (to, offset) in to.iter().zip(offset) {
            to.set(Packet(offset.get().0.map(|offset| buffer.load(offset))));
        }
    }

    #[inline(never)]
    pub(super) fn store_buffer(&self, buffer: u32, words: [Operand<'_>; 2], mask: MaskOperand<'_>) {
        let buffer = self.buffer(buffer);
        self.each_lane(words, mask, |_, _, [offset, value]| {
            if let Some(word) = buffer.at(offset) {
                word.store(value, Relaxed);
            }
        });
    }

    #[inline(never)]
    pub(super) fn load_workgroup(&self, to: Words<'_>, index: Words<'_>) {
        for (to, index) in to.iter().zip(index) {
            let word = |index: u32| {
                self.workgroup
                    .get(index as usize)
                    .map_or(0, |word| word.get())
            };
            to.set(Packet(index.get().0.map(word)));
        }
    }

    #[inline(never)]
    pub(super) fn store_workgroup(&self, words: [Operand<'_>; 2], mask: MaskOperand<'_>) {
        self.each_lane(words, mask, |_, _, [index, value]| {
            if let Some(word) = self.workgroup.get(index as usize) {
                word.set(value);
            }
        });
    }

    #[inline(never)]
    pub(super) fn load_local(&self, to: Words<'_>, array: Words<'_>, index: Operand<'_>) {
        let last = (array.len() / self.stride).saturating_sub(1);
        match index {
            Operand::One(index) => {
                let at = (index as usize).min(last) * self.stride;
                let from = array.get(at..).unwrap_or_default();
                for (to, from) in to.iter().zip(from) {
                    to.set(from.get());
                }
            }
            Operand::Many(index) => {
                for (packet, (to, index)) in to.iter().zip(index).enumerate() {
                    let index = index.get().0;
                    let mut words = [0; LANES];
                    for (lane, word) in words.iter_mut().enumerate() {
                        let at = (index[lane] as usize).min(last) * self.stride + packet;
                        *word = array.get(at).map_or(0, |packet| packet.get().0[lane]);
                    }
                    to.set(Packet(words));
                }
            }
        }
    }

    #[inline(never)]
    pub(super) fn store_local(
        &self,
        array: Words<'_>,
        [index, value]: [Operand<'_>; 2],
        mask: MaskOperand<'_>,
    ) {
        let words = array.len() / self.stride;
        let place = |index: u32, packet: usize| {
            let is_inside = (index as usize) < words;
            let at = is_inside.then(|| index as usize * self.stride + packet)?;
            array.get(at)
        };
        for packet in 0..self.count {
            let (value, bits) = (value.packet(packet), mask.packet(packet));
            match index {
                Operand::One(index) => {
                    if let Some(to) = place(index, packet) {
                        let mut words = to.get().0;
                        for lane in 0..LANES {
                            let is_set = bits >> lane & 1 == 1;
                            words[lane] = if is_set { value[lane] } else { words[lane] };
                        }
                        to.set(Packet(words));
                    }
                }
                Operand::Many(index) => {
                    let index = index[packet].get();
                    for lane in Lane::all_of(bits) {
                        if let Some(to) = place(index[lane], packet) {
                            let mut words = to.get();
                            words[lane] = value[lane.get()];
                            to.set(words);
                        }
                    }
                }
            }
        }
    }

    #[inline(never)]
    pub(super) fn atomic(&self, code: &AtomicCode) {
        let result = self.slot(code.result);
        let words = [self.word(code.offset), self.word(code.value)];
        self.each_lane_into(
            result,
            words,
            self.mask(code.mask),
            |[offset, operand]| match code.memory {
                Memory::Buffer(buffer) => {
                    let word = self.buffer(buffer).at(offset);
                    word.map_or(0, |word| atomic(code.kind, word, operand))
                }
                Memory::Workgroup => self.workgroup.get(offset as usize).map_or(0, |word| {
                    let before = word.get();
                    word.set(code.kind.evaluate([before, operand]));
                    // As for buffers, where a store does not read.
                    if code.kind == Atomic::Store {
                        0
                    } else {
                        before
                    }
                }),
            },
        );
    }

    #[inline(never)]
    pub(super) fn compare_exchange(&self, code: &CompareExchangeCode) {
        let (result, is_stored) = (self.slot(code.result), self.mask_slot(code.is_stored));
        let mask = self.mask(code.mask);
        let words = [code.offset, code.expected, code.value].map(|word| self.word(word));
        for packet in 0..self.count {
            let bits = mask.packet(packet);
            let [offset, expected, value] = words.map(|word| word.packet(packet));
            let (mut read, mut stored) = ([0; LANES], 0);
            for lane in Lane::all_of(bits) {
                let at = lane.get();
                let (before, is_equal) =
                    self.exchange(code.memory, offset[at], [expected[at], value[at]]);
                read[at] = before;
                stored |= if is_equal { lane.bit() } else { 0 };
            }
            result[packet].set(Packet(read));
            is_stored[packet].set(stored);
        }
    }

    /// Stores the second word where the first is.
    fn exchange(&self, memory: Memory, offset: u32, [expected, value]: [u32; 2]) -> (u32, bool) {
        match memory {
            Memory::Buffer(buffer) => {
                let Some(word) = self.buffer(buffer).at(offset) else {
                    return (0, false);
                };
                match word.compare_exchange(expected, value, Relaxed, Relaxed) {
                    Ok(before) => (before, true),
                    Err(before) => (before, false),
                }
            }
            Memory::Workgroup => {
                let Some(word) = self.workgroup.get(offset as usize) else {
                    return (0, false);
                };
                let before = word.get();
                let is_equal = before == expected;
                if is_equal {
                    word.set(value);
                }
                (before, is_equal)
            }
        }
    }

    /// Calls `act` with the words of each lane of a mask, in order.
    fn each_lane(
        &self,
        words: [Operand<'_>; 2],
        mask: MaskOperand<'_>,
        mut act: impl FnMut(usize, Lane, [u32; 2]),
    ) {
        for packet in 0..self.count {
            let bits = mask.packet(packet);
            let [a, b] = words.map(|word| word.packet(packet));
            for lane in Lane::all_of(bits) {
                act(packet, lane, [a[lane.get()], b[lane.get()]]);
            }
        }
    }

    /// The same with a result, which is 0 in other lanes.
    fn each_lane_into(
        &self,
        result: Words<'_>,
        words: [Operand<'_>; 2],
        mask: MaskOperand<'_>,
        act: impl Fn([u32; 2]) -> u32,
    ) {
        for (packet, result) in result.iter().enumerate() {
            let bits = mask.packet(packet);
            let [a, b] = words.map(|word| word.packet(packet));
            let mut read = [0; LANES];
            for lane in Lane::all_of(bits) {
                read[lane.get()] = act([a[lane.get()], b[lane.get()]]);
            }
            result.set(Packet(read));
        }
    }

    #[inline(never)]
    pub(super) fn texture(&self, code: &TextureCode) {
        let scratch = &mut *self.texture.borrow_mut();
        let (packets, masks) = scratch;
        packets.clear();
        masks.clear();
        for word in &code.operands {
            let word = self.word(*word);
            packets.extend((0..self.count).map(|packet| Packet(word.packet(packet))));
        }
        let mask = self.mask(code.mask);
        masks.extend((0..self.count).map(|packet| mask.packet(packet)));
        let operands = packets.len();
        packets.resize(
            operands + code.results.len() * self.count,
            Packet::default(),
        );
        let (operands, results) = packets.split_at_mut(operands);
        self.run.textures.access(TextureAccess {
            op: &code.op,
            level: self.level,
            packets: self.count,
            mask: masks,
            operands,
            results,
        });
        for (slot, from) in code.results.iter().zip(results.chunks_exact(self.count)) {
            for (to, from) in self.slot(*slot).iter().zip(from) {
                to.set(*from);
            }
        }
    }
}
