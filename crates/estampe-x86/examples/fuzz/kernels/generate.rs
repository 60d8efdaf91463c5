//! Random trees: every construct, nested, under uniform and other conditions. They all end: every
//! branch to a loop counts its first parameter up to at most 3.

use estampe_ir::interface::{BufferSlot, Input, LocalArray, Output, Stage, TextureSlot};
use estampe_ir::op::{Binary, Compare};
use estampe_ir::tree::{Builder, Label, Tree};
use estampe_ir::{Type, Value};
use fastrand::Rng;

/// The outputs that are words.
pub(super) const OUTPUTS: u32 = 3;
/// The inputs that differ between lanes.
pub(super) const VARYINGS: u32 = 4;
/// The inputs that are the same in all lanes.
pub(super) const UNIFORMS: u32 = 3;
/// The buffer that is read, the one that is written, and the arrays.
pub(super) const READ: u32 = 0;
pub(super) const WRITTEN: u32 = 1;
/// The array that is stored to. The one after it is a table; the last one has no words.
pub(super) const ARRAY: u32 = 0;
pub(super) const ARRAYS: u32 = 3;

/// The words of the memory of work-groups, where there is some.
const WORKGROUP_WORDS: u32 = 24;

/// The operations of loops that are long, of which a pass may run two packets with AVX2, too.
const LONG_LOOP: usize = 60;

pub(super) struct Generator<'a> {
    pub(super) random: &'a mut Rng,
    pub(super) builder: Builder,
    pub(super) words: Vec<Value>,
    pub(super) masks: Vec<Value>,
    labels: Vec<(Label, Target)>,
    /// Statements that may still be made.
    left: u32,
    pub(super) cover: Value,
    /// Operations that need no calls and have no effects: a pass may run two packets.
    pub(super) is_free: bool,
    /// A run is a work-group.
    pub(super) has_workgroup: bool,
    /// The index of the invocation, of compute shaders.
    pub(super) index: Option<Value>,
    has_flow: bool,
}

#[derive(Clone)]
enum Target {
    Block(Vec<Type>),
    /// The counter is the first parameter.
    Loop(Value, Vec<Type>),
}

/// A random shader of up to so many statements.
pub(super) fn tree(random: &mut Rng, statements: u32) -> Tree {
    let stages = [Stage::Vertex, Stage::Fragment, Stage::Compute];
    let stage = stages[random.usize(..3)];
    let mut builder = Builder::new(stage);
    let interface = builder.interface_mut();
    for is_written in [false, true] {
        interface.buffers.push(BufferSlot {
            group: 0,
            binding: u32::from(is_written),
            is_written,
        });
    }
    let slot = TextureSlot {
        group: 1,
        binding: 0,
    };
    interface.textures.push(slot);
    interface.samplers.push(slot);
    let local = |words: u32, init: &[u32]| LocalArray {
        words,
        init: init.to_vec(),
    };
    interface.locals = vec![local(5, &[7, 8]), local(4, &[3, 1, 4, 1]), local(0, &[])];
    let mut words: Vec<Value> = (0..UNIFORMS)
        .map(|at| builder.input(Input::PushConstant(at)))
        .collect();
    words.extend((0..VARYINGS).map(|at| builder.input(Input::Varying(at))));
    let cover = builder.input(Input::Cover);
    let facing = builder.input(Input::FrontFacing);
    let is_free = random.u32(0..3) == 0;
    let index = (stage == Stage::Compute).then(|| {
        builder.interface_mut().workgroup_size = [64, 1, 1];
        builder.input(Input::LocalInvocationIndex)
    });
    let has_workgroup = stage == Stage::Compute && !is_free && random.bool();
    if has_workgroup {
        builder.interface_mut().workgroup_words = WORKGROUP_WORDS;
    }
    let mut generator = Generator {
        words,
        masks: vec![cover, facing],
        labels: Vec::new(),
        left: statements,
        cover,
        builder,
        is_free,
        has_workgroup,
        index,
        has_flow: !is_free || random.bool(),
        random,
    };
    let mut types = vec![Type::Word; OUTPUTS as usize];
    types.push(Type::Mask);
    let results = generator.block(&types);
    let outputs = (0..OUTPUTS).map(Output::Varying).chain([Output::Cover]);
    generator.builder.finish(outputs.zip(results).collect())
}

impl Generator<'_> {
    /// A block of random statements with results of these types.
    fn block(&mut self, types: &[Type]) -> Vec<Value> {
        let label = self.builder.block_of(types);
        self.labels.push((label, Target::Block(types.to_vec())));
        self.statements();
        if !self.builder.has_ended() {
            let arguments = self.values_of(types);
            self.builder.branch(label, &arguments);
        }
        self.labels.pop();
        self.builder.end_block()
    }

    /// Random statements, whose values are forgotten at the end.
    fn statements(&mut self) {
        let seen = (self.words.len(), self.masks.len());
        let at_most = if self.labels.len() < 2 { 60 } else { 10 };
        for _ in 0..self.random.u32(1..at_most) {
            if self.left == 0 || self.builder.has_ended() {
                break;
            }
            self.left -= 1;
            if !self.has_flow {
                self.operation();
                continue;
            }
            let may_nest = self.labels.len() < 6;
            match self.random.u32(0..40) {
                0..=2 if may_nest => self.if_else(),
                3 if may_nest => {
                    let types = self.types();
                    let results = self.block(&types);
                    self.add(&results);
                }
                4 | 5 if may_nest => self.bounded_loop(),
                6 if may_nest => self.switch(),
                7 if self.random.u32(0..3) == 0 => self.early_branch(),
                _ => self.operation(),
            }
        }
        self.words.truncate(seen.0);
        self.masks.truncate(seen.1);
    }

    fn types(&mut self) -> Vec<Type> {
        let count = self.random.usize(0..4);
        let kind = |random: &mut Rng| match random.u32(0..4) {
            0 => Type::Mask,
            _ => Type::Word,
        };
        (0..count).map(|_| kind(self.random)).collect()
    }

    pub(super) fn word(&mut self) -> Value {
        if self.random.u32(0..6) == 0 {
            let special = [0, 1, 2, 31, u32::MAX, 1 << 31, 0x3F80_0000, 0x7FC0_0000];
            let word = special[self.random.usize(..special.len())];
            return self.builder.word(word);
        }
        // Values of late are likely.
        let from = self.words.len().saturating_sub(6);
        let from = if self.random.bool() { from } else { 0 };
        self.words[self.random.usize(from..self.words.len())]
    }

    pub(super) fn mask(&mut self) -> Value {
        if self.random.u32(0..3) == 0 {
            return self.masks[self.random.usize(..self.masks.len())];
        }
        let (a, b) = (self.word(), self.word());
        let kind = Compare::ALL[self.random.usize(..Compare::ALL.len())];
        self.builder.compare(kind, a, b)
    }

    fn values_of(&mut self, types: &[Type]) -> Vec<Value> {
        let value = |kind: &Type| match kind {
            Type::Word => self.word(),
            Type::Mask => self.mask(),
        };
        types.iter().map(value).collect()
    }

    pub(super) fn add(&mut self, values: &[Value]) {
        for &value in values {
            match self.builder.kind(value) {
                Type::Word => self.words.push(value),
                Type::Mask => self.masks.push(value),
            }
        }
    }

    fn if_else(&mut self) {
        let condition = self.mask();
        self.builder.start_if(condition);
        self.statements();
        if self.random.bool() {
            self.builder.start_else();
            self.statements();
        }
        self.builder.end_if();
    }

    /// A switch: a block that cases leave, some of which fall through.
    fn switch(&mut self) {
        let types = self.types();
        let done = self.builder.block_of(&types);
        self.labels.push((done, Target::Block(types.clone())));
        let three = self.builder.word(3);
        let selector = self.word();
        let selector = self.builder.binary(Binary::And, selector, three);
        for case in 0..self.random.u32(1..4) {
            let case = self.builder.word(case);
            let is_case = self.builder.compare(Compare::Eq, selector, case);
            self.builder.start_if(is_case);
            self.statements();
            if !self.builder.has_ended() && self.random.u32(0..4) != 0 {
                let arguments = self.values_of(&types);
                self.builder.branch(done, &arguments);
            }
            self.builder.end_if();
        }
        if !self.builder.has_ended() {
            self.statements();
        }
        if !self.builder.has_ended() {
            let arguments = self.values_of(&types);
            self.builder.branch(done, &arguments);
        }
        self.labels.pop();
        let results = self.builder.end_block();
        self.add(&results);
    }

    /// A block around a loop that a counter ends.
    fn bounded_loop(&mut self) {
        let types = self.types();
        let done = self.builder.block_of(&types);
        self.labels.push((done, Target::Block(types.clone())));
        let of_loop = self.types();
        let zero = self.builder.word(0);
        let initial = [vec![zero], self.values_of(&of_loop)].concat();
        // The number of iterations differs from lane to lane, or not.
        let three = self.builder.word(3);
        let limit = self.word();
        let limit = self.builder.binary(Binary::And, limit, three);
        let again = self.builder.start_loop(&initial);
        let counter = again.parameters[0];
        let seen = (self.words.len(), self.masks.len());
        self.add(&again.parameters);
        let is_over = self.builder.compare(Compare::ULe, limit, counter);
        self.builder.start_if(is_over);
        let arguments = self.values_of(&types);
        self.builder.branch(done, &arguments);
        self.builder.end_if();
        self.labels
            .push((again.label, Target::Loop(counter, of_loop)));
        if self.is_free && self.random.bool() {
            for _ in 0..LONG_LOOP {
                self.operation();
            }
        }
        self.statements();
        if !self.builder.has_ended() && self.random.u32(0..5) != 0 {
            self.branch_to(self.labels.len() - 1);
        }
        if !self.builder.has_ended() && !types.is_empty() {
            let arguments = self.values_of(&types);
            self.builder.branch(done, &arguments);
        }
        self.labels.pop();
        self.words.truncate(seen.0);
        self.masks.truncate(seen.1);
        self.builder.end_loop();
        self.labels.pop();
        let results = self.builder.end_block();
        self.add(&results);
    }

    fn early_branch(&mut self) {
        let to = self.random.usize(..self.labels.len());
        self.branch_to(to);
    }

    fn branch_to(&mut self, to: usize) {
        let (label, target) = self.labels[to].clone();
        let arguments = match target {
            Target::Block(types) => self.values_of(&types),
            Target::Loop(counter, types) => {
                let one = self.builder.word(1);
                let next = self.builder.binary(Binary::Add, counter, one);
                [vec![next], self.values_of(&types)].concat()
            }
        };
        self.builder.branch(label, &arguments);
    }
}
