//! Uniform values: what a stage computes alike for all fragments, from sizes of textures,
//! immediates and buffers, computed once for a batch before its kernel runs.
//!
//! In · Out: a tree of the fragment stage, some of its values · a list of steps that gives them.

use super::textures::BoundTextures;
use estampe_ir::interface::Input;
use estampe_ir::interpreter::Buffer;
use estampe_ir::op::{Binary, LevelOfDetail, TextureQuery, Unary, fma};
use estampe_ir::tree::{Node, Tree};
use estampe_ir::{Op, Type, Value};
use std::collections::HashMap;

/// The most operations that lead to a value, those that lead to several operands counted as often.
const MOST_OPERATIONS: usize = 32;

/// The most words of a texture's shape.
const SHAPE: usize = 3;

/// The data that uniform values are computed from.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sources<'a> {
    pub(super) textures: &'a BoundTextures<'a>,
    pub(super) buffers: &'a [Buffer<'a>],
    pub(super) immediates: &'a [u32],
}

/// Uniform values of a stage, by number.
#[derive(Debug, Default)]
pub(super) struct Uniforms {
    /// The constants, and zeros for the others.
    initial: Vec<u32>,
    /// The operations that compute the others, in order.
    steps: Vec<(usize, Step)>,
}

/// An operation; operands are the numbers of values.
#[derive(Debug)]
enum Step {
    Immediate(u32),
    Load {
        buffer: u32,
        offset: usize,
    },
    /// All words of the shape, which follow each other.
    Shape {
        query: TextureQuery,
        texture: u32,
        level: Option<usize>,
    },
    Unary(Unary, usize),
    Binary(Binary, [usize; 2]),
    Fma([usize; 3]),
}

impl Uniforms {
    /// Computes all values.
    pub(super) fn compute(&self, of: Sources<'_>, values: &mut Vec<u32>) {
        values.clear();
        values.extend_from_slice(&self.initial);
        for (number, step) in &self.steps {
            values[*number] = match *step {
                Step::Immediate(at) => of.immediates.get(at as usize).copied().unwrap_or(0),
                Step::Load { buffer, offset } => {
                    let buffer = of.buffers.get(buffer as usize);
                    buffer.map_or(0, |buffer| buffer.load(values[offset]))
                }
                Step::Shape {
                    query,
                    texture,
                    level,
                } => {
                    let level = level.map_or(0, |at| values[at]);
                    let words = of.textures.shape(query, texture, level);
                    values[*number..][..SHAPE].copy_from_slice(&words);
                    continue;
                }
                Step::Unary(kind, a) => kind.evaluate(values[a]),
                Step::Binary(kind, [a, b]) => kind.evaluate([values[a], values[b]]),
                Step::Fma([a, b, c]) => fma([values[a], values[b], values[c]]),
            };
        }
    }
}

/// The uniform values of a tree's outermost body.
pub(super) struct Finder<'a> {
    definitions: HashMap<Value, Definition<'a>>,
    numbers: HashMap<Value, usize>,
    uniforms: Uniforms,
}

/// The operation that computes a value.
#[derive(Clone, Copy)]
struct Definition<'a> {
    op: &'a Op,
    /// Which of its results the value is.
    result: u32,
    /// Where it stands in the body.
    position: usize,
    /// The operations that lead to the value.
    operations: usize,
}

impl<'a> Finder<'a> {
    pub(super) fn new(tree: &'a Tree) -> Self {
        let mut definitions: HashMap<Value, Definition<'a>> = HashMap::new();
        for (position, node) in tree.body.iter().enumerate() {
            let Node::Op { op, first } = node else {
                continue;
            };
            let mut operations = Some(1_usize);
            for operand in operands(op) {
                let before = definitions.get(&operand).map(|one| one.operations);
                operations = operations.zip(before).map(|(a, b)| a.saturating_add(b));
            }
            let operations = operations.filter(|all| *all <= MOST_OPERATIONS);
            if let Some(operations) = operations.filter(|_| tree.is_uniform(op)) {
                for (result, value) in (0..).zip(first.and_next(op.results().len())) {
                    let definition = Definition {
                        op,
                        result,
                        position,
                        operations,
                    };
                    definitions.insert(value, definition);
                }
            }
        }
        Self {
            definitions,
            numbers: HashMap::new(),
            uniforms: Uniforms::default(),
        }
    }

    /// True if a value is uniform, and computed by few operations.
    pub(super) fn is_uniform(&self, value: Value) -> bool {
        self.definitions.contains_key(&value)
    }

    /// The number of a value that [is uniform](Self::is_uniform).
    pub(super) fn number_of(&mut self, tree: &Tree, value: Value) -> usize {
        let mut needed = Vec::new();
        let mut open = vec![value];
        while let Some(value) = open.pop() {
            let is_known = self.numbers.contains_key(&value);
            if !is_known && let Some(definition) = self.definitions.get(&value) {
                needed.push((definition.position, definition.result, value));
                open.extend(operands(definition.op));
            }
        }
        needed.sort_unstable();
        needed.dedup();
        for (_, _, value) in needed {
            self.add(tree, value);
        }
        self.numbers[&value]
    }

    /// Adds a value whose operands have numbers.
    fn add(&mut self, tree: &Tree, value: Value) {
        if self.numbers.contains_key(&value) {
            return;
        }
        let number = self.uniforms.initial.len();
        let of = |operand: Value| self.numbers[&operand];
        let Definition { op, result, .. } = self.definitions[&value];
        let mut constant = 0;
        let step = match op {
            Op::Constant(word) => {
                constant = *word;
                None
            }
            Op::Input(at) => match tree.interface.inputs[*at as usize] {
                Input::PushConstant(at) => Some(Step::Immediate(at)),
                _ => unreachable!("other inputs are not uniform"),
            },
            Op::LoadBuffer { buffer, offset } => Some(Step::Load {
                buffer: *buffer,
                offset: of(*offset),
            }),
            Op::Texture(op) => {
                let step = Step::Shape {
                    query: op.query,
                    texture: op.texture,
                    level: match op.level {
                        LevelOfDetail::Explicit(level) => Some(of(level)),
                        _ => None,
                    },
                };
                let first = Value(value.0 - result);
                let words = op.query.results() as usize;
                self.numbers
                    .extend((first.0..).map(Value).zip(number..number + words));
                self.uniforms.initial.resize(number + SHAPE, 0);
                self.uniforms.steps.push((number, step));
                return;
            }
            Op::Unary(kind, a) => Some(Step::Unary(*kind, of(*a))),
            Op::Binary(kind, [a, b]) => Some(Step::Binary(*kind, [of(*a), of(*b)])),
            Op::Fma([a, b, c]) => Some(Step::Fma([of(*a), of(*b), of(*c)])),
            _ => unreachable!("other operations are not uniform"),
        };
        self.uniforms.initial.push(constant);
        self.uniforms.steps.extend(step.map(|step| (number, step)));
        self.numbers.insert(value, number);
    }

    /// The steps that compute the values that were numbered.
    pub(super) fn finish(self) -> Uniforms {
        self.uniforms
    }
}

/// The words that an operation computes with.
fn operands(op: &Op) -> Vec<Value> {
    let mut operands = Vec::new();
    op.each_operand(|value, kind| {
        if kind == Type::Word {
            operands.push(value);
        }
    });
    operands
}
