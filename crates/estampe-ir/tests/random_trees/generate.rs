//! Random trees: every construct, nested, with uniform and other conditions. They all end.

use estampe_ir::interface::{BufferSlot, Input, LocalArray, Output, Stage};
use estampe_ir::op::{Binary, Compare, MaskBinary, Math, Unary};
use estampe_ir::tree::{Builder, Label, Tree};
use estampe_ir::{Op, Type, Value};
use fastrand::Rng;

/// The position of the buffer that is read.
pub(crate) const READ: u32 = 0;
/// The position of the buffer that is written: eight words for each invocation.
pub(crate) const WRITTEN: u32 = 1;
/// Words of an invocation in the buffer that is written.
pub(crate) const OWN_WORDS: u32 = 8;
/// The number of outputs.
const OUTPUTS: u32 = 3;

/// What a tree has, so that a test can assert that all of it occurs.
#[derive(Debug, Default, Clone, Copy)]
pub(crate) struct Made {
    pub(crate) ifs: u32,
    pub(crate) loops: u32,
    pub(crate) early_branches: u32,
    pub(crate) stores: u32,
}

struct Generator<'a> {
    random: &'a mut Rng,
    builder: Builder,
    words: Vec<Value>,
    masks: Vec<Value>,
    labels: Vec<(Label, Target)>,
    /// Nodes that may still be made.
    left: u32,
    own_offset: Value,
    cover: Value,
    made: Made,
}

#[derive(Clone)]
enum Target {
    Block(Vec<Type>),
    /// The counter, which every branch counts up, is the first parameter.
    Loop(Value, Vec<Type>),
}

/// A random shader.
pub(crate) fn tree(random: &mut Rng) -> (Tree, Made) {
    // Two packets of a fragment stage may run together. This draws no number from `random`.
    let is_compute = random.clone().bool();
    let mut builder = Builder::new(if is_compute {
        Stage::Compute
    } else {
        Stage::Fragment
    });
    for is_written in [false, true] {
        builder.interface_mut().buffers.push(BufferSlot {
            group: 0,
            binding: u32::from(is_written),
            is_written,
        });
    }
    builder.interface_mut().locals = vec![
        LocalArray {
            words: 5,
            init: vec![7, 8],
        },
        LocalArray {
            words: 4,
            init: vec![3, 1, 4, 1],
        },
    ];
    let index = builder.input(Input::LocalInvocationIndex);
    let uniforms = [0, 1, 2].map(|at| builder.input(Input::PushConstant(at)));
    let cover = builder.input(Input::Cover);
    let bytes = builder.word(OWN_WORDS * 4);
    let own_offset = builder.binary(Binary::Mul, index, bytes);
    let left = random.u32(5..120);
    let mut generator = Generator {
        random,
        words: [&uniforms[..], &[index]].concat(),
        masks: vec![cover],
        builder,
        labels: Vec::new(),
        left,
        own_offset,
        cover,
        made: Made::default(),
    };
    let types = vec![Type::Word; OUTPUTS as usize];
    let results = generator.block(&types);
    let outputs = (0..).map(Output::Varying).zip(results).collect();
    (generator.builder.finish(outputs), generator.made)
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
        for _ in 0..self.random.u32(1..8) {
            if self.left == 0 || self.builder.has_ended() {
                break;
            }
            self.left -= 1;
            match self.random.u32(0..16) {
                0..=7 => self.operation(),
                8 => self.load_or_store(),
                9..=11 if self.labels.len() < 6 => self.if_else(),
                12 if self.labels.len() < 6 => {
                    let types = self.types();
                    let results = self.block(&types);
                    self.add(&results);
                }
                13 | 14 if self.labels.len() < 6 => self.bounded_loop(),
                15 if self.random.u32(0..4) == 0 => self.early_branch(),
                _ => self.operation(),
            }
        }
        self.words.truncate(seen.0);
        self.masks.truncate(seen.1);
    }

    fn types(&mut self) -> Vec<Type> {
        let count = self.random.usize(0..4);
        let kind = |random: &mut Rng| {
            if random.u32(0..4) == 0 {
                Type::Mask
            } else {
                Type::Word
            }
        };
        (0..count).map(|_| kind(self.random)).collect()
    }

    fn word(&mut self) -> Value {
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

    fn mask(&mut self) -> Value {
        match self.random.u32(0..3) {
            0 => self.masks[self.random.usize(..self.masks.len())],
            _ => {
                let (a, b) = (self.word(), self.word());
                let kind = Compare::ALL[self.random.usize(..Compare::ALL.len())];
                self.builder.compare(kind, a, b)
            }
        }
    }

    fn values_of(&mut self, types: &[Type]) -> Vec<Value> {
        let value = |kind: &Type| match kind {
            Type::Word => self.word(),
            Type::Mask => self.mask(),
        };
        types.iter().map(value).collect()
    }

    fn add(&mut self, values: &[Value]) {
        for &value in values {
            match self.builder.kind(value) {
                Type::Word => self.words.push(value),
                Type::Mask => self.masks.push(value),
            }
        }
    }

    fn operation(&mut self) {
        let (a, b) = (self.word(), self.word());
        let value = match self.random.u32(0..12) {
            0 => {
                let kind = Unary::ALL[self.random.usize(..Unary::ALL.len())];
                self.canonical(Op::Unary(kind, a))
            }
            1 => {
                let x = self.builder.unary(Unary::F32FromS32, a);
                let function = Math::ALL[self.random.usize(..Math::ALL.len())];
                self.canonical(Op::Math(function, x))
            }
            2 => {
                let mask = self.mask();
                self.builder.select(mask, a, b)
            }
            3 => {
                let (a, b) = (self.mask(), self.mask());
                let kind = MaskBinary::ALL[self.random.usize(..MaskBinary::ALL.len())];
                self.builder.mask_binary(kind, a, b)
            }
            4 => {
                let mask = self.mask();
                self.builder.mask_not(mask)
            }
            5 => {
                let three = self.word();
                let offset = self.builder.binary(Binary::And, three, a);
                self.builder.op1(Op::LoadBuffer {
                    buffer: READ,
                    offset,
                })
            }
            _ => {
                let kind = Binary::ALL[self.random.usize(..Binary::ALL.len())];
                self.canonical(Op::Binary(kind, [a, b]))
            }
        };
        self.add(&[value]);
    }

    /// The result of an operation with the NaN of all: payloads are unspecified.
    fn canonical(&mut self, op: Op) -> Value {
        let result = self.builder.op1(op);
        self.builder.unary(Unary::Canonical, result)
    }

    fn load_or_store(&mut self) {
        let (at, value) = (self.word(), self.word());
        match self.random.u32(0..4) {
            0 => {
                let array = self.random.u32(0..2);
                let loaded = self.builder.op1(Op::LoadLocal { array, index: at });
                self.add(&[loaded]);
            }
            1 => {
                let mask = self.mask();
                self.builder.op(Op::StoreLocal {
                    array: 0,
                    index: at,
                    value,
                    mask,
                });
            }
            2 => {
                let offset = self.own_place(at);
                let loaded = self.builder.op1(Op::LoadBuffer {
                    buffer: WRITTEN,
                    offset,
                });
                self.add(&[loaded]);
            }
            _ => {
                let offset = self.own_place(at);
                let mask = self.cover;
                self.builder.op(Op::StoreBuffer {
                    buffer: WRITTEN,
                    offset,
                    value,
                    mask,
                });
            }
        }
        self.made.stores += 1;
    }

    /// A word of this invocation in the buffer that is written.
    fn own_place(&mut self, at: Value) -> Value {
        let limit = self.builder.word(OWN_WORDS - 1);
        let index = self.builder.binary(Binary::And, at, limit);
        let four = self.builder.word(4);
        let offset = self.builder.binary(Binary::Mul, index, four);
        self.builder.binary(Binary::Add, self.own_offset, offset)
    }

    fn if_else(&mut self) {
        self.made.ifs += 1;
        let condition = self.mask();
        self.builder.start_if(condition);
        self.statements();
        if self.random.bool() {
            self.builder.start_else();
            self.statements();
        }
        self.builder.end_if();
    }

    /// A block around a loop that a counter ends.
    fn bounded_loop(&mut self) {
        self.made.loops += 1;
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
        self.made.early_branches += 1;
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
