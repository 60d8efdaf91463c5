//! Linear scan: registers whose lives do not overlap become one.
//!
//! The life of a register is the range of instructions from the first that names it to the last. If
//! a register that is written before a loop is read in it, its life goes on until the end of the
//! loop.

use super::super::instruction::{Instruction, Mask, MaskSlot, ScalarOp, Slot, Word};
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

/// Words, and masks.
pub(super) const KINDS: usize = 2;

/// How an instruction names a register.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Access {
    Read,
    Write,
}

/// Renames the registers. Returns the numbers of registers of words and of masks.
pub(super) fn allocate(instructions: &mut [Instruction]) -> [usize; KINDS] {
    let ends = Loops::of(instructions);
    let mut lives: [Vec<Life>; KINDS] = [Vec::new(), Vec::new()];
    for (at, instruction) in instructions.iter_mut().enumerate() {
        each_register(instruction, |kind, register, _| {
            let lives = &mut lives[kind];
            let index = *register as usize;
            if lives.len() <= index {
                lives.resize(index + 1, Life::default());
            }
            let life = &mut lives[index];
            life.first = life.first.min(at);
            life.last = at;
        });
    }
    for life in lives.iter_mut().flatten() {
        ends.extend(life);
    }
    let mut files = lives.map(File::new);
    for (at, instruction) in instructions.iter_mut().enumerate() {
        let copied = copied(instruction);
        let mut preferred = None;
        each_register(instruction, |kind, register, access| {
            if access == Access::Read {
                *register = files[kind].get(*register, None);
                if copied == Some(kind) {
                    preferred = Some(*register);
                }
            }
        });
        files.iter_mut().for_each(|file| file.free_until(at));
        each_register(instruction, |kind, register, access| {
            if access == Access::Write {
                *register = files[kind].get(*register, preferred);
            }
        });
    }
    files.map(|file| file.count as usize)
}

/// The kind of register that an instruction copies to another one.
fn copied(instruction: &Instruction) -> Option<usize> {
    match instruction {
        Instruction::Copy(_, Word::Slot(_)) => Some(0),
        Instruction::CopyMask(_, Mask::Slot(_)) => Some(1),
        _ => None,
    }
}

#[derive(Debug, Clone, Copy)]
struct Life {
    first: usize,
    last: usize,
}

impl Default for Life {
    fn default() -> Self {
        Self {
            first: usize::MAX,
            last: 0,
        }
    }
}

/// The registers of a kind.
struct File {
    lives: Vec<Life>,
    renamed: Vec<Option<u32>>,
    free: BTreeSet<u32>,
    /// The last instructions of registers in use.
    used: BinaryHeap<Reverse<(usize, u32)>>,
    count: u32,
}

impl File {
    fn new(lives: Vec<Life>) -> Self {
        Self {
            renamed: vec![None; lives.len()],
            lives,
            free: BTreeSet::new(),
            used: BinaryHeap::new(),
            count: 0,
        }
    }

    fn get(&mut self, register: u32, preferred: Option<u32>) -> u32 {
        if let Some(renamed) = self.renamed[register as usize] {
            return renamed;
        }
        let preferred = preferred.filter(|preferred| self.free.remove(preferred));
        let renamed = preferred.or_else(|| self.free.pop_first());
        let renamed = renamed.unwrap_or_else(|| {
            self.count += 1;
            self.count - 1
        });
        self.renamed[register as usize] = Some(renamed);
        let last = self.lives[register as usize].last;
        self.used.push(Reverse((last, renamed)));
        renamed
    }

    /// Frees the registers that no later instruction names.
    fn free_until(&mut self, at: usize) {
        while let Some(&Reverse((last, register))) = self.used.peek()
            && last <= at
        {
            self.used.pop();
            self.free.insert(register);
        }
    }
}

/// The loops, by their first instructions: a tree of maxima over their last ones.
struct Loops {
    firsts: Vec<usize>,
    maxima: Vec<usize>,
}

impl Loops {
    fn of(instructions: &[Instruction]) -> Self {
        let mut loops = Vec::new();
        for (at, instruction) in instructions.iter().enumerate() {
            let targets = match instruction {
                Instruction::Jump(target) => [*target; 2],
                Instruction::Branch(_, targets) => *targets,
                _ => continue,
            };
            let backward = targets.map(|target| target as usize);
            loops.extend(
                backward
                    .into_iter()
                    .filter(|&to| to <= at)
                    .map(|to| (to, at)),
            );
        }
        loops.sort_unstable();
        let count = loops.len();
        let mut maxima = vec![0; 2 * count];
        for (at, &(_, last)) in loops.iter().enumerate() {
            maxima[count + at] = last;
        }
        for at in (1..count).rev() {
            maxima[at] = maxima[2 * at].max(maxima[2 * at + 1]);
        }
        Self {
            firsts: loops.into_iter().map(|(first, _)| first).collect(),
            maxima,
        }
    }

    /// Extends a life to the ends of loops that it enters.
    fn extend(&self, life: &mut Life) {
        loop {
            let from = self.firsts.partition_point(|&first| first <= life.first);
            let to = self.firsts.partition_point(|&first| first <= life.last);
            let last = self.greatest(from, to);
            if last <= life.last {
                return;
            }
            life.last = last;
        }
    }

    /// The greatest last instruction of the loops `from..to`.
    fn greatest(&self, from: usize, to: usize) -> usize {
        let count = self.firsts.len();
        let (mut from, mut to, mut greatest) = (from + count, to + count, 0);
        while from < to {
            if from % 2 == 1 {
                greatest = greatest.max(self.maxima[from]);
                from += 1;
            }
            if to % 2 == 1 {
                to -= 1;
                greatest = greatest.max(self.maxima[to]);
            }
            from /= 2;
            to /= 2;
        }
        greatest
    }
}

/// Calls `visit` with the kind of each register that an instruction names, and its number.
pub(super) fn each_register(
    instruction: &mut Instruction,
    visit: impl FnMut(usize, &mut u32, Access),
) {
    let mut visit = Visitor(visit);
    match instruction {
        Instruction::Scalar(_, op) => match op {
            ScalarOp::Any(mask) => visit.read_mask(mask),
            ScalarOp::First(slot, mask) => {
                visit.read(slot);
                visit.mask(mask);
            }
            _ => {}
        },
        Instruction::Unary(_, to, a)
        | Instruction::Math(_, to, a)
        | Instruction::LoadTable(_, to, a)
        | Instruction::LoadBuffer(to, _, a)
        | Instruction::LoadWorkgroup(to, a) => {
            visit.read(a);
            visit.write(to);
        }
        Instruction::Binary(_, to, pair) => {
            visit.words(pair);
            visit.write(to);
        }
        Instruction::Product(_, to, three) => {
            visit.words(three);
            visit.write(to);
        }
        Instruction::Fma(to, three) => {
            three.iter_mut().for_each(|slot| visit.read(slot));
            visit.write(to);
        }
        Instruction::Compare(_, to, pair) => {
            visit.words(pair);
            visit.write_mask(to);
        }
        Instruction::MaskNot(to, a) | Instruction::QuadAny(to, a) => {
            visit.read_mask(a);
            visit.write_mask(to);
        }
        Instruction::MaskBinary(_, to, pair) => {
            pair.iter_mut().for_each(|mask| visit.mask(mask));
            visit.write_mask(to);
        }
        Instruction::Select(to, mask, pair) => {
            visit.mask(mask);
            visit.words(pair);
            visit.write(to);
        }
        Instruction::Math2(_, to, pair) => {
            pair.iter_mut().for_each(|slot| visit.read(slot));
            visit.write(to);
        }
        Instruction::Derivative(_, _, to, a, mask) | Instruction::QuadLane(_, to, a, mask) => {
            visit.read(a);
            visit.mask(mask);
            visit.write(to);
        }
        Instruction::Copy(to, word) | Instruction::LoadLocal(to, _, word) => {
            visit.word(word);
            visit.write(to);
        }
        Instruction::CopyMask(to, mask) => {
            visit.mask(mask);
            visit.write_mask(to);
        }
        Instruction::Input(to, _) => visit.write(to),
        Instruction::InputMask(to, _) => visit.write_mask(to),
        Instruction::Output(_, word) => visit.word(word),
        Instruction::OutputMask(_, mask) | Instruction::Branch(mask, _) => visit.mask(mask),
        Instruction::StoreLocal(_, words, mask)
        | Instruction::StoreBuffer(_, words, mask)
        | Instruction::StoreWorkgroup(words, mask) => {
            visit.words(words);
            visit.mask(mask);
        }
        Instruction::Atomic(code) => {
            visit.words(&mut [&mut code.offset, &mut code.value]);
            visit.mask(&mut code.mask);
            visit.write(&mut code.result);
        }
        Instruction::CompareExchange(code) => {
            visit.words(&mut [&mut code.offset, &mut code.expected, &mut code.value]);
            visit.mask(&mut code.mask);
            visit.write(&mut code.result);
            visit.write_mask(&mut code.is_stored);
        }
        Instruction::Texture(code) => {
            visit.words(&mut code.operands);
            visit.mask(&mut code.mask);
            code.results.iter_mut().for_each(|slot| visit.write(slot));
        }
        Instruction::Barrier | Instruction::Jump(_) | Instruction::Return => {}
    }
}

struct Visitor<F>(F);

impl<F: FnMut(usize, &mut u32, Access)> Visitor<F> {
    fn read(&mut self, Slot(slot): &mut Slot) {
        (self.0)(0, slot, Access::Read);
    }

    fn write(&mut self, Slot(slot): &mut Slot) {
        (self.0)(0, slot, Access::Write);
    }

    fn read_mask(&mut self, MaskSlot(slot): &mut MaskSlot) {
        (self.0)(1, slot, Access::Read);
    }

    fn write_mask(&mut self, MaskSlot(slot): &mut MaskSlot) {
        (self.0)(1, slot, Access::Write);
    }

    fn word(&mut self, word: &mut Word) {
        if let Word::Slot(slot) = word {
            self.read(slot);
        }
    }

    fn words(&mut self, words: &mut [impl std::borrow::BorrowMut<Word>]) {
        for word in words {
            self.word(word.borrow_mut());
        }
    }

    fn mask(&mut self, mask: &mut Mask) {
        if let Mask::Slot(slot) = mask {
            self.read_mask(slot);
        }
    }
}
