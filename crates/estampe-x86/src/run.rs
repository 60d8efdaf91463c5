//! Runs code on packets.

use crate::Code;
use crate::enter::{Line, enter};
use crate::frame::{self, PACKET};
use crate::serve::Context;
use estampe_ir::Type;
use estampe_ir::interpreter::{Buffer, InputData, OutputData, Run, Stopped, Words};
use estampe_simd::Level;
use std::cell::RefCell;
use std::sync::atomic::Ordering::Relaxed;

/// The memory of a run, kept for the next one. One for each thread.
#[derive(Debug, Default)]
pub struct Scratch {
    lines: Vec<Line>,
    /// The code for which the lines were cleared.
    code: u64,
    /// What is added to each pointer after the first pass and after the last one.
    steps: [Vec<Line>; 2],
    /// Copies of buffers that are shorter than what instructions read at fixed places.
    padded: Vec<Vec<u32>>,
}

/// Bytes of a line.
const LINE: u32 = PACKET;
/// Pointers of a line.
const POINTERS: u32 = LINE / 8;

impl Code {
    /// Executes the kernel in all lanes of all packets.
    ///
    /// # Errors
    /// [`Stopped`] if a pass of a packet uses the budget up, which counts jumps backwards, or if
    /// there is not enough memory.
    ///
    /// # Panics
    /// Where an access to a texture panics.
    pub fn run(&self, level: Level, run: &Run<'_>, scratch: &mut Scratch) -> Result<(), Stopped> {
        if run.packets == 0 {
            return Ok(());
        }
        self.make_room(scratch)?;
        let context = Context {
            served: &self.served,
            frame: &self.frame,
            run,
            level,
            local_words: &self.local_words,
            panic: RefCell::new(None),
        };
        self.set_table(run, &mut scratch.lines);
        self.set_buffers(run, scratch);
        if let Some(prepare) = self.prepare {
            enter(&self.executable, prepare, &mut scratch.lines, &context);
        }
        self.set_still(run, &mut scratch.lines);
        let is_inside = self.set_pointers(run, scratch, 0);
        let mut result = Ok(());
        for packet in 0..run.packets {
            // Some slice is too short: each packet's places are looked for.
            if !is_inside && packet > 0 {
                self.set_pointers(run, scratch, packet);
            }
            result = self.packet(&context, scratch);
            if result.is_err() || context.has_panicked() {
                break;
            }
        }
        if let Some(panic) = context.panic.take() {
            std::panic::resume_unwind(panic);
        }
        result
    }

    /// Runs the passes of a packet, and moves the pointers to the next one.
    fn packet(&self, context: &Context<'_>, scratch: &mut Scratch) -> Result<(), Stopped> {
        let Scratch { lines, steps, .. } = scratch;
        for pass in 0..self.passes {
            lines[0].0[frame::BUDGET as usize / 8] = context.run.budget;
            for (start, words, init) in &self.reset_locals {
                let start = (start / LINE) as usize;
                let words = &mut lines[start..start + *words as usize];
                let init = init.iter().copied().chain(std::iter::repeat(0));
                for (line, word) in words.iter_mut().zip(init) {
                    *line = splat(word);
                }
            }
            if enter(&self.executable, self.packet, lines, context) != 0 {
                return Err(Stopped::Budget);
            }
            let steps = &steps[usize::from(pass + 1 == self.passes)];
            let pointers = &mut lines[(self.frame.pointers / LINE) as usize..];
            for (pointers, steps) in pointers.iter_mut().zip(steps) {
                for (pointer, step) in pointers.0.iter_mut().zip(steps.0) {
                    *pointer = pointer.wrapping_add(step);
                }
            }
        }
        Ok(())
    }

    fn make_room(&self, scratch: &mut Scratch) -> Result<(), Stopped> {
        let lines = (self.frame.bytes / LINE) as usize;
        if let Some(more) = lines.checked_sub(scratch.lines.len()) {
            let reserved = scratch.lines.try_reserve_exact(more);
            reserved.map_err(|_| Stopped::Memory)?;
            scratch.lines.resize(lines, Line::default());
        }
        if scratch.code != self.id {
            scratch.code = self.id;
            scratch.lines[..lines].fill(Line::default());
            let pointers = (self.frame.inputs + self.frame.outputs).div_ceil(POINTERS);
            for steps in &mut scratch.steps {
                steps.clear();
                steps.resize(pointers as usize, Line::default());
            }
            scratch.padded.clear();
            scratch.padded.resize(self.fixed_words.len(), Vec::new());
        }
        Ok(())
    }

    /// Inputs that are words of the table.
    fn set_table(&self, run: &Run<'_>, lines: &mut [Line]) {
        for &(at, slot) in &self.table_inputs {
            let word = run.inputs.get(at).map_or(0, InputData::first_word);
            let offset = self.frame.slot(slot);
            for copy in 0..self.frame.slot_bytes / 4 {
                set_word(lines, offset + copy * 4, word);
            }
        }
    }

    fn set_buffers(&self, run: &Run<'_>, scratch: &mut Scratch) {
        for (at, &fixed) in (0..).zip(&self.fixed_words) {
            let buffer = run.buffers.get(at as usize).copied().unwrap_or_default();
            let (mut address, words, stored) = match buffer.words() {
                Words::ReadOnly(words) => (words.as_ptr().expose_provenance(), words.len(), 0),
                Words::Shared(words) => {
                    let address = words.as_ptr().expose_provenance();
                    (address, words.len(), words.len())
                }
            };
            if words < fixed as usize {
                let padded = &mut scratch.padded[at as usize];
                copy_padded(buffer, fixed as usize, padded);
                address = padded.as_ptr().expose_provenance();
            }
            let offset = self.frame.buffer(at);
            set_pointer(&mut scratch.lines, offset, address);
            // Buffers have less than 2³² bytes, and so less than 2³⁰ words.
            let [words, stored] = [words, stored].map(|words| u32::try_from(words).unwrap_or(0));
            set_word(&mut scratch.lines, offset + frame::BUFFER_WORDS, words);
            let place = offset + frame::BUFFER_STORED_WORDS;
            set_word(&mut scratch.lines, place, stored);
            let bytes = buffer.bytes();
            set_word(&mut scratch.lines, offset + frame::BUFFER_BYTES, bytes);
        }
    }

    /// Packets that do not move: zeros for missing inputs, or a uniform word in all lanes.
    fn set_still(&self, run: &Run<'_>, lines: &mut [Line]) {
        for (at, kind) in self.input_types.iter().enumerate() {
            let word = match run.inputs.get(at) {
                Some(InputData::Uniform(word)) => *word,
                _ => 0,
            };
            let word = match kind {
                Type::Word => word,
                Type::Mask if word == 0 => 0,
                Type::Mask => u32::MAX,
            };
            lines[(self.frame.still / LINE) as usize + at] = splat(word);
        }
    }

    /// Sets the pointers of inputs and outputs to a packet, and their steps. Returns true if the
    /// steps lead to every later packet.
    fn set_pointers(&self, run: &Run<'_>, scratch: &mut Scratch, packet: usize) -> bool {
        let frame = scratch.lines.as_mut_ptr().expose_provenance();
        let mut is_inside = true;
        let left = run.packets - packet;
        for at in 0..self.frame.inputs {
            let kind = self.input_types[at as usize];
            let still = frame + (self.frame.still + at * PACKET) as usize;
            let place = run.inputs.get(at as usize);
            let place = place.map_or(Place::Still, |input| of_input(input, kind, packet, left));
            is_inside &= self.set(scratch, self.frame.input(at), (place, still), kind);
        }
        for at in 0..self.frame.outputs {
            let kind = self.output_types[at as usize];
            let sink = frame + self.frame.sink as usize;
            let place = run.outputs.get(at as usize);
            let place = place.map_or(Place::Still, |output| of_output(output, kind, packet, left));
            is_inside &= self.set(scratch, self.frame.output(at), (place, sink), kind);
        }
        is_inside
    }

    /// Sets a pointer and its steps; `still` is where it points that moves nowhere.
    fn set(
        &self,
        scratch: &mut Scratch,
        offset: u32,
        (place, still): (Place, usize),
        kind: Type,
    ) -> bool {
        let half = match kind {
            Type::Word => (PACKET / 2) as usize,
            Type::Mask => 1,
        };
        let (address, step, is_inside) = match place {
            Place::Still => (still, 0, true),
            // The next packet is looked for again.
            Place::Outside => (still, 0, false),
            Place::At {
                address,
                stride,
                is_inside,
            } => (address, if is_inside { stride } else { 0 }, is_inside),
        };
        set_pointer(&mut scratch.lines, offset, address);
        // With two passes the first one leads to the other half.
        let [first, last] = if self.passes == 2 {
            [half, step.wrapping_sub(half)]
        } else {
            [0, step]
        };
        let of_steps = offset - self.frame.pointers;
        set_pointer(&mut scratch.steps[0], of_steps, first);
        set_pointer(&mut scratch.steps[1], of_steps, last);
        is_inside
    }
}

/// Where an input or output of a packet is.
#[derive(Debug, Clone, Copy)]
enum Place {
    /// Nowhere in memory, for all packets.
    Still,
    /// Beyond the end of its slice.
    Outside,
    At {
        address: usize,
        /// Bytes to the next packet.
        stride: usize,
        /// True if the packets that are left are in the slice, too.
        is_inside: bool,
    },
}

/// Element `first + packet · stride` of a slice.
fn element<T>(slice: &[T], (first, stride): (usize, usize), packet: usize, left: usize) -> Place {
    let element = |packet: usize| {
        let at = packet.checked_mul(stride)?.checked_add(first)?;
        slice.get(at)
    };
    match element(packet) {
        None => Place::Outside,
        Some(found) => Place::At {
            address: std::ptr::from_ref(found).expose_provenance(),
            stride: stride.wrapping_mul(size_of::<T>()),
            is_inside: element(packet + (left - 1)).is_some(),
        },
    }
}

fn of_input(input: &InputData<'_>, kind: Type, packet: usize, left: usize) -> Place {
    match (*input, kind) {
        (
            InputData::Words {
                packets,
                first,
                stride,
            },
            Type::Word,
        ) => element(packets, (first, stride), packet, left),
        (
            InputData::Floats {
                packets,
                first,
                stride,
            },
            Type::Word,
        ) => element(packets, (first, stride), packet, left),
        (InputData::Mask(bits), Type::Mask) => element(bits, (0, 1), packet, left),
        (InputData::SharedMask(bits), Type::Mask) => element(bits, (0, 1), packet, left),
        _ => Place::Still,
    }
}

fn of_output(output: &OutputData<'_>, kind: Type, packet: usize, left: usize) -> Place {
    match (*output, kind) {
        (
            OutputData::Words {
                packets,
                first,
                stride,
            },
            Type::Word,
        ) => element(packets, (first, stride), packet, left),
        (
            OutputData::Floats {
                packets,
                first,
                stride,
            },
            Type::Word,
        ) => element(packets, (first, stride), packet, left),
        (OutputData::Mask(bits), Type::Mask) => element(bits, (0, 1), packet, left),
        _ => Place::Still,
    }
}

/// A copy of a buffer, with zeros up to a length.
fn copy_padded(buffer: Buffer<'_>, len: usize, to: &mut Vec<u32>) {
    to.clear();
    match buffer.words() {
        Words::ReadOnly(words) => to.extend(words),
        Words::Shared(words) => to.extend(words.iter().map(|word| word.load(Relaxed))),
    }
    to.resize(len, 0);
}

fn splat(word: u32) -> Line {
    Line([u64::from(word) << 32 | u64::from(word); 8])
}

/// Sets eight bytes of lines.
fn set_pointer(lines: &mut [Line], offset: u32, address: usize) {
    let at = (offset / 8) as usize;
    lines[at / 8].0[at % 8] = address as u64;
}

/// Sets four bytes of lines.
fn set_word(lines: &mut [Line], offset: u32, word: u32) {
    let at = (offset / 8) as usize;
    let shift = offset % 8 * 8;
    let pair = &mut lines[at / 8].0[at % 8];
    *pair = *pair & !(u64::from(u32::MAX) << shift) | u64::from(word) << shift;
}
