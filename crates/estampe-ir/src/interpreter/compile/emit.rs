//! Writes instructions, with a register of its own for each value that differs between lanes.

use super::super::instruction::{
    Array, Instruction, Mask, MaskSlot, Scalar, ScalarOp, Slot, TRUE, Word,
};
use super::kind_of;
use super::moves::sequence;
use super::plan::Plan;
use crate::lanes::{Jump, Kernel, Terminator};
use crate::{Op, Type, Value};
use std::collections::HashMap;

pub(super) struct Emitter<'a> {
    pub(super) kernel: &'a Kernel,
    plan: Plan,
    pub(super) instructions: Vec<Instruction>,
    pub(super) preamble: Vec<(Scalar, ScalarOp)>,
    /// The scalars at the start.
    pub(super) scalars: Vec<u32>,
    /// For each scalar, whether it is known after the preamble.
    is_known: Vec<bool>,
    constants: HashMap<u32, Scalar>,
    places: Vec<Place>,
    next_slot: u32,
    next_mask: u32,
    /// The first instruction of each block.
    starts: Vec<u32>,
    pub(super) tables: Vec<Vec<u32>>,
    pub(super) locals: Vec<u32>,
    pub(super) arrays: Vec<LocalCode>,
}

/// How an array of the invocation is held.
#[derive(Debug, Clone, Copy)]
pub(super) enum LocalCode {
    Table(u32),
    Array(Array),
}

/// Where a value is.
#[derive(Debug, Clone, Copy)]
enum Place {
    Nowhere,
    Word(Word),
    Mask(Mask),
    /// An input that is read where it is used first.
    Input(u32),
    /// A product that the sum computes.
    Product([Word; 2]),
}

impl<'a> Emitter<'a> {
    pub(super) fn new(kernel: &'a Kernel) -> Self {
        let mut emitter = Self {
            kernel,
            plan: Plan::new(kernel),
            instructions: Vec::new(),
            preamble: Vec::new(),
            scalars: Vec::new(),
            is_known: Vec::new(),
            constants: HashMap::new(),
            places: vec![Place::Nowhere; kernel.values.len()],
            next_slot: 0,
            next_mask: 0,
            starts: Vec::new(),
            tables: Vec::new(),
            locals: Vec::new(),
            arrays: Vec::new(),
        };
        emitter.divide_arrays();
        emitter
    }

    fn divide_arrays(&mut self) {
        let arrays = &self.kernel.interface.locals;
        let mut is_stored = vec![false; arrays.len()];
        for op in super::ops(self.kernel) {
            if let Op::StoreLocal { array, .. } = op {
                is_stored[*array as usize] = true;
            }
        }
        for (array, is_stored) in arrays.iter().zip(is_stored) {
            let mut words = array.init.clone();
            words.resize(array.words as usize, 0);
            self.arrays.push(if is_stored {
                let first = self.locals.len();
                self.locals.extend(words);
                LocalCode::Array(Array {
                    first: u32::try_from(first).unwrap_or(u32::MAX),
                    words: array.words,
                })
            } else {
                self.tables.push(words);
                LocalCode::Table(u32::try_from(self.tables.len() - 1).unwrap_or(u32::MAX))
            });
        }
    }

    pub(super) fn kernel(&mut self) {
        for block in &self.kernel.blocks {
            for &parameter in &block.parameters {
                self.define_parameter(parameter);
            }
        }
        for (at, block) in self.kernel.blocks.iter().enumerate() {
            self.starts.push(self.position());
            for (op, first) in &block.ops {
                if self.plan.is_needed(op, *first) {
                    self.op(op, *first);
                }
            }
            if at == 0 {
                self.read_inputs();
            }
            self.terminator(&block.terminator, at);
        }
        self.resolve();
    }

    fn define_parameter(&mut self, parameter: Value) {
        let is_uniform = self.is_uniform(parameter);
        let place = match kind_of(self.kernel, parameter) {
            Type::Word if is_uniform => Place::Word(Word::Scalar(self.new_scalar(0))),
            Type::Mask if is_uniform => Place::Mask(Mask::Scalar(self.new_scalar(0))),
            Type::Word => Place::Word(Word::Slot(self.new_slot())),
            Type::Mask => Place::Mask(Mask::Slot(self.new_mask())),
        };
        self.places[parameter.index()] = place;
    }

    /// Reads the inputs that the first block did not use, for the blocks after it.
    fn read_inputs(&mut self) {
        for at in 0..self.places.len() {
            if matches!(self.places[at], Place::Input(_)) {
                let value = Value(u32::try_from(at).unwrap_or(u32::MAX));
                match kind_of(self.kernel, value) {
                    Type::Word => drop(self.word(value)),
                    Type::Mask => drop(self.mask(value)),
                }
            }
        }
    }

    fn terminator(&mut self, terminator: &Terminator, at: usize) {
        match terminator {
            Terminator::Jump(jump) => self.jump(jump, at),
            Terminator::Branch { mask, any, none } => {
                let mask = self.mask(*mask);
                let branch = self.instructions.len();
                self.push(Instruction::Branch(mask, [0; 2]));
                let targets = [any, none].map(|jump| {
                    if jump.arguments.is_empty() {
                        return block_label(jump);
                    }
                    let stub = self.position();
                    self.jump(jump, usize::MAX);
                    stub
                });
                if let Some(Instruction::Branch(_, to)) = self.instructions.get_mut(branch) {
                    *to = targets;
                }
            }
            Terminator::Return(values) => {
                let outputs = self.kernel.interface.outputs.iter();
                for (at, (output, &value)) in (0..).zip(outputs.zip(values)) {
                    let instruction = match output.kind() {
                        Type::Word => Instruction::Output(at, self.word(value)),
                        Type::Mask => Instruction::OutputMask(at, self.mask(value)),
                    };
                    self.push(instruction);
                }
                self.push(Instruction::Return);
            }
        }
    }

    /// Moves the arguments to the parameters, and jumps, unless the block is the next one.
    fn jump(&mut self, jump: &Jump, from: usize) {
        let Some(target) = self.kernel.blocks.get(jump.to.index()) else {
            return self.push(Instruction::Return);
        };
        let (mut slots, mut masks, mut scalars) = (Vec::new(), Vec::new(), Vec::new());
        for (&parameter, &argument) in target.parameters.iter().zip(&jump.arguments) {
            match self.places[parameter.index()] {
                Place::Word(Word::Slot(to)) => slots.push((to, self.word(argument))),
                Place::Mask(Mask::Slot(to)) => masks.push((to, self.mask(argument))),
                Place::Word(Word::Scalar(to)) => {
                    let word = self.word(argument);
                    scalars.push((to, self.first_lane(word, None)));
                }
                Place::Mask(Mask::Scalar(to)) => {
                    let mask = self.mask(argument);
                    scalars.push((to, self.any_lane(mask)));
                }
                _ => {}
            }
        }
        for (to, from) in sequence(slots, || Word::Slot(self.new_slot())) {
            let Word::Slot(to) = to else { continue };
            self.push(Instruction::Copy(to, from));
        }
        for (to, from) in sequence(masks, || Mask::Slot(self.new_mask())) {
            let Mask::Slot(to) = to else { continue };
            self.push(Instruction::CopyMask(to, from));
        }
        for (to, from) in sequence(scalars, || self.new_scalar(0)) {
            self.push(Instruction::Scalar(to, ScalarOp::Copy(from)));
        }
        if jump.to.index() != from.wrapping_add(1) || from == usize::MAX {
            self.push(Instruction::Jump(block_label(jump)));
        }
    }

    /// Replaces the labels of blocks by the positions of their instructions.
    fn resolve(&mut self) {
        let starts = &self.starts;
        let resolve = |target: &mut u32| {
            if *target & BLOCK_LABEL != 0 {
                let block = (*target & !BLOCK_LABEL) as usize;
                *target = starts.get(block).copied().unwrap_or(u32::MAX);
            }
        };
        for instruction in &mut self.instructions {
            match instruction {
                Instruction::Jump(target) => resolve(target),
                Instruction::Branch(_, targets) => targets.iter_mut().for_each(resolve),
                _ => {}
            }
        }
    }

    fn position(&self) -> u32 {
        u32::try_from(self.instructions.len()).unwrap_or(u32::MAX)
    }

    pub(super) fn push(&mut self, instruction: Instruction) {
        self.instructions.push(instruction);
    }

    pub(super) fn is_uniform(&self, value: Value) -> bool {
        let info = self.kernel.values.get(value.index());
        info.is_some_and(|info| info.is_uniform)
    }

    pub(super) fn is_fused(&self, value: Value) -> bool {
        self.plan.is_fused(value)
    }

    /// The position of a new register of words.
    pub(super) fn new_slot(&mut self) -> Slot {
        self.next_slot += 1;
        Slot(self.next_slot - 1)
    }

    pub(super) fn new_mask(&mut self) -> MaskSlot {
        self.next_mask += 1;
        MaskSlot(self.next_mask - 1)
    }

    fn new_scalar(&mut self, start: u32) -> Scalar {
        self.scalars.push(start);
        self.is_known.push(false);
        Scalar(u32::try_from(self.scalars.len() - 1).unwrap_or(u32::MAX))
    }

    pub(super) fn constant(&mut self, word: u32) -> Scalar {
        if let Some(&scalar) = self.constants.get(&word) {
            return scalar;
        }
        let scalar = self.new_scalar(word);
        self.is_known[scalar.0 as usize] = true;
        self.constants.insert(word, scalar);
        scalar
    }

    pub(super) fn mask_constant(&mut self, mask: bool) -> Scalar {
        self.constant(if mask { TRUE } else { 0 })
    }

    /// Adds an operation on scalars; to the preamble if its operands are known there and it reads
    /// nothing that changes.
    pub(super) fn scalar_op(&mut self, op: ScalarOp, operands: &[Scalar], is_pure: bool) -> Scalar {
        let to = self.new_scalar(0);
        let is_known = |scalar: &Scalar| self.is_known[scalar.0 as usize];
        if is_pure && operands.iter().all(is_known) {
            self.is_known[to.0 as usize] = true;
            self.preamble.push((to, op));
        } else {
            self.push(Instruction::Scalar(to, op));
        }
        to
    }

    /// Where a word is. An input that was not read yet is read.
    pub(super) fn word(&mut self, value: Value) -> Word {
        match self.places[value.index()] {
            Place::Word(word) => word,
            Place::Input(at) => {
                let slot = self.new_slot();
                self.push(Instruction::Input(slot, at));
                self.set_word(value, Word::Slot(slot));
                Word::Slot(slot)
            }
            Place::Product([a, b]) => {
                // Not fused after all: a product of scalars, or a sum of two products.
                let slot = self.new_slot();
                self.push(Instruction::Binary(crate::op::Binary::FMul, slot, [a, b]));
                self.set_word(value, Word::Slot(slot));
                Word::Slot(slot)
            }
            Place::Nowhere | Place::Mask(_) => Word::Scalar(self.constant(0)),
        }
    }

    /// Where a mask is.
    pub(super) fn mask(&mut self, value: Value) -> Mask {
        match self.places[value.index()] {
            Place::Mask(mask) => mask,
            Place::Input(at) => {
                let slot = self.new_mask();
                self.push(Instruction::InputMask(slot, at));
                self.set_mask(value, Mask::Slot(slot));
                Mask::Slot(slot)
            }
            _ => Mask::Scalar(self.constant(0)),
        }
    }

    /// The factors of a product that the sum computes.
    pub(super) fn product(&self, value: Value) -> Option<[Word; 2]> {
        match self.places[value.index()] {
            Place::Product(factors) => Some(factors),
            _ => None,
        }
    }

    pub(super) fn set_word(&mut self, value: Value, word: Word) {
        self.places[value.index()] = Place::Word(word);
    }

    pub(super) fn set_mask(&mut self, value: Value, mask: Mask) {
        self.places[value.index()] = Place::Mask(mask);
    }

    pub(super) fn set_input(&mut self, value: Value, at: u32) {
        self.places[value.index()] = Place::Input(at);
    }

    pub(super) fn set_product(&mut self, value: Value, factors: [Word; 2]) {
        self.places[value.index()] = Place::Product(factors);
    }

    /// The register of a word; a scalar is copied to one.
    pub(super) fn slot(&mut self, word: Word) -> Slot {
        match word {
            Word::Slot(slot) => slot,
            Word::Scalar(_) => {
                let slot = self.new_slot();
                self.push(Instruction::Copy(slot, word));
                slot
            }
        }
    }

    /// The word of the first lane in a mask, or of the first lane.
    pub(super) fn first_lane(&mut self, word: Word, mask: Option<Mask>) -> Scalar {
        match word {
            Word::Scalar(scalar) => scalar,
            Word::Slot(slot) => {
                let all = Mask::Scalar(self.mask_constant(true));
                self.scalar_op(ScalarOp::First(slot, mask.unwrap_or(all)), &[], false)
            }
        }
    }

    /// Whether a lane of a mask is set.
    pub(super) fn any_lane(&mut self, mask: Mask) -> Scalar {
        match mask {
            Mask::Scalar(scalar) => scalar,
            Mask::Slot(slot) => self.scalar_op(ScalarOp::Any(slot), &[], false),
        }
    }
}

/// Marks a target that is the number of a block.
const BLOCK_LABEL: u32 = 1 << 31;

fn block_label(jump: &Jump) -> u32 {
    jump.to.0 | BLOCK_LABEL
}
