//! Inputs to registers, and registers to outputs.

use super::super::{InputData, OutputData};
use super::state::{MaskOperand, Masks, Operand, State, Words};
use estampe_simd::{LANES, Packet};
use std::cell::Cell;

impl State<'_> {
    #[inline(always)]
    pub(super) fn copy(&self, to: Words<'_>, from: Operand<'_>) {
        match from {
            // A register that stays where it is.
            Operand::Many(from) if std::ptr::eq(to, from) => {}
            Operand::Many(from) => {
                for (to, from) in to.iter().zip(from) {
                    to.set(from.get());
                }
            }
            Operand::One(word) => {
                for to in to {
                    to.set(Packet([word; LANES]));
                }
            }
        }
    }

    #[inline(always)]
    pub(super) fn input(&self, to: Words<'_>, at: u32) {
        match self.run.input(at) {
            InputData::Words {
                packets,
                first,
                stride,
            } => {
                for (to, at) in to.iter().zip(self.elements(first, stride)) {
                    to.set(packets.get(at).map_or(ZERO, |packet| *packet));
                }
            }
            InputData::Floats {
                packets,
                first,
                stride,
            } => {
                for (to, at) in to.iter().zip(self.elements(first, stride)) {
                    to.set(packets.get(at).map_or(ZERO, bits));
                }
            }
            InputData::Uniform(word) => to.iter().for_each(|to| to.set(Packet([word; LANES]))),
            InputData::Mask(_) | InputData::SharedMask(_) | InputData::UniformWords(_) => {
                to.iter().for_each(|to| to.set(Packet::default()));
            }
        }
    }

    pub(super) fn input_mask(&self, to: Masks<'_>, at: u32) {
        let input = self.run.input(at);
        let bits = |packet: usize| match input {
            InputData::Mask(bits) => bits.get(packet).copied().unwrap_or(0),
            InputData::SharedMask(bits) => bits.get(packet).map_or(0, Cell::get),
            InputData::Uniform(1..) => u16::MAX,
            _ => 0,
        };
        for (to, packet) in to.iter().zip(self.first..) {
            to.set(bits(packet));
        }
    }

    #[inline(always)]
    pub(super) fn output(&self, at: u32, from: Operand<'_>) {
        match self.run.output(at) {
            OutputData::Words {
                packets,
                first,
                stride,
            } => {
                for (packet, at) in (0..self.count).zip(self.elements(first, stride)) {
                    if let Some(to) = packets.get(at) {
                        to.set(Packet(from.packet(packet)));
                    }
                }
            }
            OutputData::Floats {
                packets,
                first,
                stride,
            } => {
                for (packet, at) in (0..self.count).zip(self.elements(first, stride)) {
                    if let Some(to) = packets.get(at) {
                        to.set(floats(from.packet(packet)));
                    }
                }
            }
            OutputData::Mask(_) | OutputData::Dropped => {}
        }
    }

    pub(super) fn output_mask(&self, at: u32, from: MaskOperand<'_>) {
        if let OutputData::Mask(masks) = self.run.output(at) {
            let places = masks.get(self.first..).unwrap_or_default();
            for (packet, to) in (0..self.count).zip(places) {
                to.set(from.packet(packet));
            }
        }
    }

    /// The elements of the chunk's packets.
    #[inline(always)]
    fn elements(&self, first: usize, stride: usize) -> impl Iterator<Item = usize> {
        (self.first..).map(move |packet| packet.saturating_mul(stride).saturating_add(first))
    }
}

const ZERO: Packet<u32> = Packet([0; LANES]);

#[inline(always)]
fn bits(floats: &Packet<f32>) -> Packet<u32> {
    let mut bits = ZERO;
    for (to, from) in bits.0.iter_mut().zip(&floats.0) {
        *to = from.to_bits();
    }
    bits
}

#[inline(always)]
fn floats(bits: [u32; LANES]) -> Packet<f32> {
    let mut floats = Packet([0.0; LANES]);
    for (to, from) in floats.0.iter_mut().zip(bits) {
        *to = f32::from_bits(from);
    }
    floats
}
