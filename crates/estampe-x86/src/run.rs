//! Runs code on packets.

use crate::Code;
use crate::enter::{Line, enter};
use crate::frame::{self, PACKET};
use crate::places::Track;
use crate::scratch::{Begin, Scratch};
use crate::serve::Context;
use crate::workgroups::Again;
use estampe_ir::Type;
use estampe_ir::interpreter::{Buffer, InputData, Part, Run, Stopped, Words};
use estampe_simd::Level;
use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

/// Bytes of a line.
pub(crate) const LINE: u32 = PACKET;

/// Words of eight bytes of a line.
const WORDS: usize = LINE as usize / 8;

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
        self.run_workgroups(level, run, &[], scratch)
    }

    /// Runs all packets of a work-group, each of which has a state.
    pub(crate) fn run_workgroup(
        &self,
        run: &Run<'_>,
        (tracks, lines): (&[Track], &mut [Line]),
        context: &Context<'_>,
    ) -> Result<Option<Again>, Stopped> {
        let state_lines = (self.frame.state_bytes() / LINE) as usize;
        self.set_packets((run, tracks), lines, (0, run.packets), state_lines);
        set_head(lines, frame::PACKETS, run.packets as u64);
        self.enter(self.packet, lines, context)?;
        // Nothing moves the pointers of states.
        Ok(Some(Again {
            function: self.packet,
            passes: 1,
        }))
    }

    pub(crate) fn enter(
        &self,
        function: usize,
        lines: &mut [Line],
        context: &Context<'_>,
    ) -> Result<(), Stopped> {
        match enter(&self.executable, function, lines, context) {
            0 => Ok(()),
            _ => Err(Stopped::Budget),
        }
    }

    /// Runs packets one by one or two by two. Gives how to do it again, if one call ran all of
    /// them; `again_pointers` then are what it found.
    pub(crate) fn run_packets(
        &self,
        run: &Run<'_>,
        (tracks, lines): (&[Track], &mut [Line]),
        (begin, again_pointers): (&mut Begin, &mut Vec<Line>),
        context: &Context<'_>,
    ) -> Result<Option<Again>, Stopped> {
        let mut packet = 0;
        let mut again = None;
        while packet < run.packets && !context.has_panicked() {
            let left = run.packets - packet;
            // The last packet of an odd number runs alone.
            let (function, of_pass) = match self.pair {
                Some(pair) if left > 1 => (pair, 2),
                _ => (self.packet, 1),
            };
            let mut passes = left / of_pass;
            let pointers = (self.frame.pointers / LINE) as usize;
            let all = pointers..pointers + of_pass * self.frame.packet_lines();
            if packet == 0
                && let Some(known) = begin.pointers(self, run, tracks)
            {
                // Those of one packet are the first ones of a pass of several.
                let len = all.len();
                lines[all].copy_from_slice(&known[..len]);
            } else if (of_pass, left) == (1, 1) {
                // A packet alone, which takes no step, so that those of a pass stay in the frame.
                self.set_packet((run, tracks), lines, packet, (pointers, None));
            } else {
                // Where some slice is too short, the places of each pass are looked for.
                let (data, packets) = ((run, tracks), (packet, of_pass));
                let is_led = self.set_packets(data, lines, packets, self.frame.packet_lines());
                begin.forget();
                if is_led {
                    if of_pass > 1 {
                        self.set_steps(lines, of_pass);
                    }
                    if packet == 0 {
                        begin.note(self, run, tracks, &lines[all]);
                    }
                } else {
                    passes = 1;
                }
            }
            if self.has_workgroup_ids() && passes * of_pass == run.packets {
                again_pointers.clear();
                again_pointers.extend(&lines[self.frame.pointer_lines()]);
                again = Some(Again { function, passes });
            }
            set_head(lines, frame::LEFT, passes as u64);
            self.enter(function, lines, context)?;
            packet += passes * of_pass;
        }
        Ok(again)
    }

    /// Makes room for a frame with so many states, and for the memory of a work-group, which is
    /// cleared.
    pub(crate) fn make_room(&self, states: usize, scratch: &mut Scratch) -> Result<(), Stopped> {
        let lines = self.frame.lines(states).ok_or(Stopped::Memory)?;
        if let Some(more) = lines.checked_sub(scratch.lines.len()) {
            let reserved = scratch.lines.try_reserve_exact(more);
            reserved.map_err(|_| Stopped::Memory)?;
            scratch.lines.resize(lines, Line::default());
        }
        if scratch.code != self.id {
            scratch.code = self.id;
            scratch.begin.forget();
            scratch.lines[..lines].fill(Line::default());
            scratch.padded.clear();
            scratch.padded.resize(self.fixed_words.len(), Vec::new());
        }
        if let Some(words) = self.workgroup_words {
            let memory = &mut scratch.workgroup;
            memory.truncate(words);
            clear(memory);
            let reserved = memory.try_reserve_exact(words - memory.len());
            reserved.map_err(|_| Stopped::Memory)?;
            memory.resize_with(words, AtomicU32::default);
        }
        Ok(())
    }

    /// Inputs that are words of the table.
    pub(crate) fn set_table(&self, run: &Run<'_>, lines: &mut [Line]) {
        for &(at, slot) in &self.table_inputs {
            self.set_slot(slot, run.input(at).first_word(), lines);
        }
    }

    /// Sets a value of the table.
    pub(crate) fn set_slot(&self, slot: u32, word: u32, lines: &mut [Line]) {
        let offset = self.frame.slot(slot);
        for copy in 0..self.frame.slot_bytes / 4 {
            set_word(lines, offset + copy * 4, word);
        }
    }

    pub(crate) fn set_buffers(&self, run: &Run<'_>, scratch: &mut Scratch) {
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
            set_pointer(&mut scratch.lines, offset as usize, address);
            // Buffers have less than 2³² bytes, and so less than 2³⁰ words.
            let [words, stored] = [words, stored].map(|words| u32::try_from(words).unwrap_or(0));
            set_word(&mut scratch.lines, offset + frame::BUFFER_WORDS, words);
            let place = offset + frame::BUFFER_STORED_WORDS;
            set_word(&mut scratch.lines, place, stored);
            let bytes = buffer.bytes();
            set_word(&mut scratch.lines, offset + frame::BUFFER_BYTES, bytes);
        }
        if self.workgroup_words.is_some() {
            let memory = &scratch.workgroup;
            let offset = self.frame.buffer(self.frame.workgroup);
            let address = memory.as_ptr().expose_provenance();
            set_pointer(&mut scratch.lines, offset as usize, address);
            let words = u32::try_from(memory.len()).unwrap_or(0);
            for place in [frame::BUFFER_WORDS, frame::BUFFER_STORED_WORDS] {
                set_word(&mut scratch.lines, offset + place, words);
            }
        }
    }

    /// Sets the pointers of inputs and outputs to so many packets from the first on, each so many
    /// lines after those of the one before; and the steps of the first one. True if they lead to
    /// all packets of the run.
    fn set_packets(
        &self,
        data: (&Run<'_>, &[Track]),
        lines: &mut [Line],
        (first, count): (usize, usize),
        apart: usize,
    ) -> bool {
        let parts = [self.frame.pointers, self.frame.steps];
        let [pointers, steps] = parts.map(|offset| (offset / LINE) as usize);
        let is_led = self.set_packet(data, lines, first, (pointers, Some(steps)));
        for packet in 1..count {
            let to = pointers + packet * apart;
            if !is_led {
                let places = (to, Some(steps + packet * apart));
                self.set_packet(data, lines, first + packet, places);
                continue;
            }
            for line in 0..self.frame.packet_lines() {
                let (step, before) = (lines[steps + line], lines[to - apart + line]);
                let pointers = before.0.iter().zip(step.0);
                for (to, (pointer, step)) in lines[to + line].0.iter_mut().zip(pointers) {
                    *to = pointer.wrapping_add(step);
                }
            }
        }
        is_led
    }

    /// Makes the steps of the first packet of a pass those of all, of which there are so many.
    fn set_steps(&self, lines: &mut [Line], count: usize) {
        let of_packet = self.frame.packet_lines();
        let steps = &mut lines[(self.frame.steps / LINE) as usize..][..count * of_packet];
        for step in &mut steps[..of_packet] {
            step.0 = step.0.map(|step| step.wrapping_mul(count as u64));
        }
        for packet in 1..count {
            steps.copy_within(..of_packet, packet * of_packet);
        }
    }

    /// Sets the pointers of inputs and outputs to a packet, and their steps to the next one if they
    /// are wanted, in lines from these on. True if the steps lead to all packets of the run.
    #[inline(always)]
    fn set_packet(
        &self,
        (run, tracks): (&Run<'_>, &[Track]),
        lines: &mut [Line],
        packet: usize,
        (pointers, steps): (usize, Option<usize>),
    ) -> bool {
        let (inputs, outputs) = tracks.split_at(run.inputs.len());
        let first = self.input_types.len();
        let of_inputs = (&self.input_types[..], run.input_parts, inputs);
        let of_outputs = (&self.output_types[..], run.output_parts, outputs);
        let mut is_led = true;
        for ((kinds, parts, tracks), first) in [(of_inputs, 0), (of_outputs, first)] {
            for (number, &kind) in (0..).zip(kinds) {
                let part = Part::of(parts, number);
                let track = tracks.get(part.data as usize).unwrap_or(&Track::NOWHERE);
                let at = first + number as usize;
                let (address, step) = match track.whole_part(kind, part.first, packet) {
                    Some(found) => found,
                    None => {
                        let of_packet = |packet| track.packet_of_part(kind, part.first, packet);
                        is_led &= of_packet(0).is_none();
                        let still = self.still(run, lines, at);
                        (of_packet(packet).unwrap_or(still), 0)
                    }
                };
                lines[pointers + at / WORDS].0[at % WORDS] = address as u64;
                if let Some(steps) = steps {
                    lines[steps + at / WORDS].0[at % WORDS] = step as u64;
                }
            }
        }
        is_led
    }

    /// Where an input is read, or an output goes, that is not in memory: an input is the same in
    /// all packets, and an output that goes nowhere goes into the sink. Inputs come first.
    #[cold]
    fn still(&self, run: &Run<'_>, lines: &mut [Line], at: usize) -> usize {
        let frame = lines.as_mut_ptr().expose_provenance();
        let Some(kind) = self.input_types.get(at) else {
            return frame + self.frame.sink as usize;
        };
        let offset = self.frame.still as usize + at * PACKET as usize;
        let input = u32::try_from(at).map_or(InputData::Uniform(0), |at| run.input(at));
        lines[offset / LINE as usize] = splat(match (input, kind) {
            (InputData::Uniform(word), Type::Word) => word,
            (InputData::Uniform(1..), Type::Mask) => u32::MAX,
            _ => 0,
        });
        frame + offset
    }
}

/// Sets the memory of a work-group to zeros.
pub(crate) fn clear(memory: &mut [AtomicU32]) {
    for word in memory {
        *word.get_mut() = 0;
    }
}

/// Where the data of a run are: those of inputs, then those of outputs.
pub(crate) fn find_data(run: &Run<'_>, tracks: &mut Vec<Track>) {
    let last = run.packets - 1;
    tracks.clear();
    tracks.extend((run.inputs.iter()).map(|input| Track::of_input(input, last)));
    tracks.extend((run.outputs.iter()).map(|output| Track::of_output(output, last)));
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

pub(crate) fn splat(word: u32) -> Line {
    Line([u64::from(word) << 32 | u64::from(word); 8])
}

/// Sets eight bytes of lines.
fn set_pointer(lines: &mut [Line], offset: usize, address: usize) {
    let at = offset / 8;
    lines[at / 8].0[at % 8] = address as u64;
}

/// Sets eight bytes of the head.
pub(crate) fn set_head(lines: &mut [Line], offset: i32, value: u64) {
    let at = offset.unsigned_abs() as usize / 8;
    lines[at / 8].0[at % 8] = value;
}

/// Sets four bytes of lines.
fn set_word(lines: &mut [Line], offset: u32, word: u32) {
    let at = (offset / 8) as usize;
    let shift = offset % 8 * 8;
    let pair = &mut lines[at / 8].0[at % 8];
    *pair = *pair & !(u64::from(u32::MAX) << shift) | u64::from(word) << shift;
}
