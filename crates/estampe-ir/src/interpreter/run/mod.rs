//! Runs bytecode.

mod access;
mod arithmetic;
mod by_lane;
mod execute;
mod packets;
mod scalars;
mod shift;
mod state;
mod table;
mod transfer;
mod wide;

use super::batch::{Run, Stopped};
use super::cells;
use super::compile::{Chunk, Code};
use estampe_simd::{Level, Packet, dispatch};
use execute::Progress;
use state::State;
use std::cell::RefCell;
pub(super) use table::entry_of;

/// The registers of a run, kept for the next one. One for each thread.
#[derive(Debug, Default)]
pub struct Scratch {
    words: Vec<Packet<u32>>,
    masks: Vec<u16>,
    scalars: Vec<u32>,
    locals: Vec<Packet<u32>>,
    workgroup: Vec<u32>,
    /// The next instruction of each packet of a work-group.
    reached: Vec<Option<usize>>,
    /// Operands and results of accesses to textures.
    texture: RefCell<(Vec<Packet<u32>>, Vec<u16>)>,
}

impl Code {
    /// Executes the kernel in all lanes of all packets.
    ///
    /// # Errors
    /// [`Stopped`] if a chunk uses its budget up, or if there is not enough memory for registers.
    pub fn run(&self, level: Level, run: &Run<'_>, scratch: &mut Scratch) -> Result<(), Stopped> {
        if run.packets == 0 {
            return Ok(());
        }
        // The packets of a chunk, and the chunks whose registers are kept beside each other.
        let (chunk, banks) = match self.chunk {
            Chunk::Packets(packets) => (packets.min(run.packets), 1),
            Chunk::Workgroup => (1, run.packets),
        };
        self.prepare(chunk, banks, scratch)?;
        let start = Progress {
            next: Some(0),
            budget: run.budget,
        };
        if self.chunk == Chunk::Workgroup {
            return self.workgroup((level, run), start, scratch);
        }
        let mut state = self.state((level, run), (chunk, 0), scratch);
        self.preamble(&state);
        while state.first < run.packets {
            state.count = chunk.min(run.packets - state.first);
            state.reset_locals();
            advance(&state, start)?;
            state.first += chunk;
        }
        Ok(())
    }

    /// Executes the kernel in a work-group: packet after packet up to the next barrier, until all
    /// have ended.
    fn workgroup(
        &self,
        run: (Level, &Run<'_>),
        start: Progress,
        scratch: &mut Scratch,
    ) -> Result<(), Stopped> {
        let packets = run.1.packets;
        let mut reached = std::mem::take(&mut scratch.reached);
        reached.clear();
        reached.resize(packets, start.next);
        let mut budget = start.budget;
        for packet in 0..packets {
            let state = self.state(run, (1, packet), scratch);
            self.preamble(&state);
            state.reset_locals();
        }
        while reached.iter().any(Option::is_some) {
            for (packet, next) in reached.iter_mut().enumerate() {
                let state = self.state(run, (1, packet), scratch);
                let from = Progress {
                    next: *next,
                    budget,
                };
                let to = advance(&state, from)?;
                (*next, budget) = (to.next, to.budget);
            }
        }
        scratch.reached = reached;
        Ok(())
    }

    /// What instructions act on: the registers of a bank, whose chunks have so many packets.
    fn state<'a>(
        &'a self,
        (level, run): (Level, &'a Run<'a>),
        (chunk, bank): (usize, usize),
        scratch: &'a mut Scratch,
    ) -> State<'a> {
        let bank_of = |words: usize| bank * words * chunk..(bank + 1) * words * chunk;
        let scalars = self.scalars.len();
        State {
            code: self,
            run,
            level,
            words: cells(&mut scratch.words[bank_of(self.slots)]),
            masks: cells(&mut scratch.masks[bank_of(self.mask_slots)]),
            scalars: cells(&mut scratch.scalars[bank * scalars..(bank + 1) * scalars]),
            locals: cells(&mut scratch.locals[bank_of(self.locals.len())]),
            workgroup: cells(&mut scratch.workgroup),
            texture: &scratch.texture,
            stride: chunk,
            first: bank,
            count: 1,
        }
    }

    /// Computes what is the same in all packets of the run.
    fn preamble(&self, state: &State<'_>) {
        for (to, op) in &self.preamble {
            state.scalar(*to, op);
        }
    }

    /// Makes room for the registers of so many chunks of so many packets.
    fn prepare(&self, chunk: usize, banks: usize, scratch: &mut Scratch) -> Result<(), Stopped> {
        let size = |words: usize, of: usize| words.checked_mul(of).ok_or(Stopped::Memory);
        let packets = size(chunk, banks)?;
        grow(&mut scratch.words, size(self.slots, packets)?)?;
        grow(&mut scratch.masks, size(self.mask_slots, packets)?)?;
        grow(&mut scratch.locals, size(self.locals.len(), packets)?)?;
        let scalars = self.scalars.len();
        grow(&mut scratch.scalars, size(scalars, banks)?)?;
        for bank in 0..banks {
            scratch.scalars[bank * scalars..][..scalars].copy_from_slice(&self.scalars);
        }
        grow(&mut scratch.workgroup, self.workgroup_words)?;
        scratch.workgroup.truncate(self.workgroup_words);
        scratch.workgroup.fill(0);
        Ok(())
    }
}

/// Executes a chunk up to the next barrier, or to the end.
fn advance(state: &State<'_>, from: Progress) -> Result<Progress, Stopped> {
    dispatch!(@wide state.level, s => execute::chunk(wide::Wide(s), state, from),
        scalar => execute::chunk(by_lane::ByLane, state, from))
}

/// Makes a vector at least so long.
fn grow<T: Default + Clone>(vector: &mut Vec<T>, len: usize) -> Result<(), Stopped> {
    let Some(more) = len.checked_sub(vector.len()) else {
        return Ok(());
    };
    vector
        .try_reserve_exact(more)
        .map_err(|_| Stopped::Memory)?;
    vector.resize(len, T::default());
    Ok(())
}
