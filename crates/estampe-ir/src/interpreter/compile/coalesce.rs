//! Coalescing: where one register is copied to another one, and their lives do not overlap, they
//! become one (Chaitin 1982). So what a loop carries to the next iteration is computed in its
//! place.
//!
//! Two registers may be one if none is written while the other one is still read. That is found by
//! following the flow from each write, as long as the effort is within [`EFFORT`].

use super::super::instruction::{Instruction, Mask, Word};
use super::registers::{Access, KINDS, each_register};

/// The most instructions that are visited for a kernel, times their number.
const EFFORT: usize = 64;

/// A register of a kind.
type Register = (usize, u32);

/// Coalesces registers.
pub(super) fn coalesce(instructions: &mut [Instruction]) {
    let mut search = Search::new(instructions);
    for (at, instruction) in instructions.iter().enumerate() {
        let (kind, to, from) = match *instruction {
            Instruction::Copy(to, Word::Slot(from)) => (0, to.0, from.0),
            Instruction::CopyMask(to, Mask::Slot(from)) => (1, to.0, from.0),
            _ => continue,
        };
        search.join((kind, to), (kind, from), at);
    }
    for instruction in instructions {
        each_register(instruction, |kind, register, _| {
            *register = search.name((kind, *register)).1;
        });
    }
}

/// Removes copies of registers to themselves.
pub(super) fn remove_idle_copies(instructions: &mut Vec<Instruction>) {
    let is_idle = |instruction: &Instruction| match *instruction {
        Instruction::Copy(to, Word::Slot(from)) => to == from,
        Instruction::CopyMask(to, Mask::Slot(from)) => to == from,
        _ => false,
    };
    let mut kept = 0;
    let mut places = Vec::with_capacity(instructions.len());
    for instruction in &*instructions {
        places.push(kept);
        kept += u32::from(!is_idle(instruction));
    }
    instructions.retain(|instruction| !is_idle(instruction));
    for instruction in instructions {
        let move_target = |target: &mut u32| {
            *target = places.get(*target as usize).copied().unwrap_or(kept);
        };
        match instruction {
            Instruction::Jump(target) => move_target(target),
            Instruction::Branch(_, targets) => targets.iter_mut().for_each(move_target),
            _ => {}
        }
    }
}

struct Search {
    /// The registers that each instruction names, and the instructions after it.
    accesses: Vec<Vec<(Register, Access)>>,
    next: Vec<[usize; 2]>,
    /// The instructions that write each register.
    writes: [Vec<Vec<usize>>; KINDS],
    /// The register that each became a part of.
    names: [Vec<u32>; KINDS],
    /// The search that visited each instruction last.
    visited: Vec<u32>,
    searches: u32,
    effort: usize,
}

impl Search {
    fn new(instructions: &mut [Instruction]) -> Self {
        let count = instructions.len();
        let mut search = Self {
            accesses: Vec::with_capacity(count),
            next: Vec::with_capacity(count),
            writes: [Vec::new(), Vec::new()],
            names: [Vec::new(), Vec::new()],
            visited: vec![0; count],
            searches: 0,
            effort: count.saturating_mul(EFFORT),
        };
        for (at, instruction) in instructions.iter_mut().enumerate() {
            let mut accesses = Vec::new();
            each_register(instruction, |kind, register, access| {
                accesses.push(((kind, *register), access));
            });
            for &((kind, register), access) in &accesses {
                let (writes, names) = (&mut search.writes[kind], &mut search.names[kind]);
                while names.len() <= register as usize {
                    names.push(u32::try_from(names.len()).unwrap_or(u32::MAX));
                    writes.push(Vec::new());
                }
                if access == Access::Write {
                    writes[register as usize].push(at);
                }
            }
            search.accesses.push(accesses);
            search.next.push(match instruction {
                Instruction::Jump(to) => [*to as usize; 2],
                Instruction::Branch(_, targets) => targets.map(|to| to as usize),
                Instruction::Return => [usize::MAX; 2],
                _ => [at + 1; 2],
            });
        }
        search
    }

    /// The register that a register became a part of.
    fn name(&self, (kind, register): Register) -> Register {
        let mut name = register;
        while self.names[kind][name as usize] != name {
            name = self.names[kind][name as usize];
        }
        (kind, name)
    }

    /// Makes two registers one if the copy from one to the other allows it.
    fn join(&mut self, to: Register, from: Register, copy: usize) {
        let (to, from) = (self.name(to), self.name(from));
        if to == from || self.overlap(to, from, copy) || self.overlap(from, to, copy) {
            return;
        }
        let (kind, to) = to;
        let (_, from) = from;
        self.names[kind][from as usize] = to;
        let moved = std::mem::take(&mut self.writes[kind][from as usize]);
        self.writes[kind][to as usize].extend(moved);
    }

    /// True if the second register is read after a write of the first, and was written before.
    /// The copy itself gives both the same.
    fn overlap(&mut self, first: Register, second: Register, copy: usize) -> bool {
        let writes = self.writes[first.0][first.1 as usize].clone();
        let mut writes = writes.into_iter().filter(|&at| at != copy);
        writes.any(|at| self.is_read_after(second, at))
    }

    /// True if a register is read after an instruction, and before it is written again.
    fn is_read_after(&mut self, register: Register, at: usize) -> bool {
        self.searches += 1;
        let mut open = self.next[at].to_vec();
        while let Some(at) = open.pop() {
            let Some(visited) = self.visited.get_mut(at) else {
                continue;
            };
            if std::mem::replace(visited, self.searches) == self.searches {
                continue;
            }
            if self.effort == 0 {
                return true;
            }
            self.effort -= 1;
            let named = self.accesses[at].iter();
            let mut named = named.filter(|(name, _)| self.name(*name) == register);
            // Reads come before writes.
            match named.next() {
                Some((_, Access::Read)) => return true,
                Some((_, Access::Write)) => {}
                None => open.extend(self.next[at]),
            }
        }
        false
    }
}
