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
    /// Operands and results of accesses to textures.
    texture: RefCell<(Vec<Packet<u32>>, Vec<u16>)>,
}

impl Code {
    /// Executes the kernel in all lanes of all packets.
    ///
    /// # Errors
    /// [`Stopped`] if a chunk uses its budget up, or if there is not enough memory for registers.
    pub fn run(&self, level: Level, run: &Run<'_>, scratch: &mut Scratch) -> Result<(), Stopped> {
        let chunk = match self.chunk {
            Chunk::Packets(packets) => packets.min(run.packets),
            Chunk::Workgroup => run.packets,
        };
        if chunk == 0 {
            return Ok(());
        }
        self.prepare(chunk, scratch)?;
        let mut state = State {
            code: self,
            run,
            level,
            words: cells(&mut scratch.words),
            masks: cells(&mut scratch.masks),
            scalars: cells(&mut scratch.scalars),
            locals: cells(&mut scratch.locals),
            workgroup: cells(&mut scratch.workgroup),
            texture: &scratch.texture,
            stride: chunk,
            first: 0,
            count: 0,
        };
        for (to, op) in &self.preamble {
            state.scalar(*to, op);
        }
        while state.first < run.packets {
            state.count = chunk.min(run.packets - state.first);
            state.reset_locals();
            dispatch!(@wide level, s => execute::chunk(wide::Wide(s), &state),
                scalar => execute::chunk(by_lane::ByLane, &state))?;
            state.first += chunk;
        }
        Ok(())
    }

    /// Makes room for the registers of chunks of so many packets.
    fn prepare(&self, chunk: usize, scratch: &mut Scratch) -> Result<(), Stopped> {
        let size = |words: usize| words.checked_mul(chunk).ok_or(Stopped::Memory);
        grow(&mut scratch.words, size(self.slots)?)?;
        grow(&mut scratch.masks, size(self.mask_slots)?)?;
        grow(&mut scratch.locals, size(self.locals.len())?)?;
        grow(&mut scratch.scalars, self.scalars.len())?;
        scratch.scalars[..self.scalars.len()].copy_from_slice(&self.scalars);
        grow(&mut scratch.workgroup, self.workgroup_words)?;
        scratch.workgroup.truncate(self.workgroup_words);
        scratch.workgroup.fill(0);
        Ok(())
    }
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
