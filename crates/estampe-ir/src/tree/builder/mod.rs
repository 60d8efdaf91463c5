//! Making a tree, one node after the other.
//!
//! Operations on constants are done at once, and an operation that was done before, in a place that
//! is seen from here, gives the value of then.

mod constructs;

use super::passes::fold::{Known, fold};
use super::{Label, Node, Tree};
use crate::interface::{Input, Interface, Output, Stage};
use crate::op::{Binary, Compare, MaskBinary, Math, Unary};
use crate::{Op, Type, Value};
use constructs::{Construct, Open};
use std::collections::HashMap;

/// A tree that grows.
///
/// ```
/// use estampe_ir::interface::{Input, Output, Stage};
/// use estampe_ir::op::{Binary, Compare};
/// use estampe_ir::tree::Builder;
///
/// // Count down from the index of the vertex, and give the number of steps.
/// let mut b = Builder::new(Stage::Vertex);
/// let start = b.input(Input::VertexIndex);
/// let [zero, one] = [0, 1].map(|word| b.word(word));
/// let done = b.block(1);
/// let again = b.start_loop(&[start, zero]);
/// let [left, steps] = [again.parameters[0], again.parameters[1]];
/// let is_over = b.compare(Compare::Eq, left, zero);
/// b.start_if(is_over);
/// b.branch(done, &[steps]);
/// b.end_if();
/// let left = b.binary(Binary::Sub, left, one);
/// let steps = b.binary(Binary::Add, steps, one);
/// b.branch(again.label, &[left, steps]);
/// b.end_loop();
/// let results = b.end_block();
/// let tree = b.finish(vec![(Output::Varying(0), results[0])]);
/// estampe_ir::tree::verify(&tree).unwrap();
/// ```
#[derive(Debug)]
pub struct Builder {
    tree: Tree,
    /// The bodies that are open, from the outermost on.
    open: Vec<Open>,
    /// What is known of each value.
    known: Vec<Known>,
    /// The values of operations that are seen from here.
    seen: HashMap<Op, Value>,
    labels: u32,
    /// The number of branches to each label.
    branches: HashMap<Label, usize>,
}

impl Builder {
    /// An empty tree.
    #[must_use]
    pub fn new(stage: Stage) -> Self {
        let tree = Tree {
            stage,
            interface: Interface::default(),
            types: Vec::new(),
            body: Vec::new(),
            outputs: Vec::new(),
        };
        Self {
            tree,
            open: vec![Open::new(Construct::Body)],
            known: Vec::new(),
            seen: HashMap::new(),
            labels: 0,
            branches: HashMap::new(),
        }
    }

    /// The stage.
    #[must_use]
    pub fn stage(&self) -> Stage {
        self.tree.stage
    }

    /// The interface, to add buffers, textures, arrays and the work-group's memory. Buffers that
    /// are written must be marked so before the first load from them.
    pub fn interface_mut(&mut self) -> &mut Interface {
        &mut self.tree.interface
    }

    /// The interface.
    #[must_use]
    pub fn interface(&self) -> &Interface {
        &self.tree.interface
    }

    /// The number of values so far, which bounds the memory that a tree takes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.tree.len()
    }

    /// True if there is no value yet.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.tree.is_empty()
    }

    /// True after a branch: what is added here is never executed, and dropped.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        self.last().has_ended
    }

    /// The word that a value is known to be.
    #[must_use]
    pub fn constant_of(&self, value: Value) -> Option<u32> {
        match self.known[value.index()] {
            Known::Word(word) => Some(word),
            _ => None,
        }
    }

    /// The boolean that a mask is known to be.
    #[must_use]
    pub fn mask_of(&self, value: Value) -> Option<bool> {
        match self.known[value.index()] {
            Known::Mask(mask) => Some(mask),
            _ => None,
        }
    }

    /// What is known of a value.
    pub(crate) fn known(&self, value: Value) -> Known {
        self.known[value.index()]
    }

    /// Adds an operation, and returns its results: constants, where the operands are.
    pub fn op(&mut self, op: Op) -> Vec<Value> {
        let is_pure = op.is_pure(|buffer| self.tree.is_written(buffer));
        let op = if is_pure {
            match fold(op, &self.known) {
                Ok(value) => return vec![value],
                Err(op) => op,
            }
        } else {
            op
        };
        if is_pure && let Some(&value) = self.seen.get(&op) {
            return value.and_next(op.results().len());
        }
        let types = op.results();
        let first = self.define(types);
        if let [one] = types {
            self.known[first.index()] = match (&op, one) {
                (Op::Constant(word), _) => Known::Word(*word),
                (Op::MaskConstant(mask), _) => Known::Mask(*mask),
                (Op::MaskNot(of), _) => Known::Not(*of),
                _ => Known::Nothing,
            };
        }
        let results = first.and_next(types.len());
        if !self.has_ended() {
            if is_pure {
                self.seen.insert(op.clone(), first);
                self.last_mut().done.push(op.clone());
            }
            self.push(Node::Op { op, first });
        }
        results
    }

    /// Adds an operation with one result.
    ///
    /// # Panics
    /// If it has none.
    pub fn op1(&mut self, op: Op) -> Value {
        self.op(op)[0]
    }

    /// A word that is known.
    pub fn word(&mut self, word: u32) -> Value {
        self.op1(Op::Constant(word))
    }

    /// A float that is known.
    pub fn float(&mut self, number: f32) -> Value {
        self.word(number.to_bits())
    }

    /// A mask that is known.
    pub fn mask(&mut self, mask: bool) -> Value {
        self.op1(Op::MaskConstant(mask))
    }

    /// An input. Its entry in the interface is made where it is missing.
    pub fn input(&mut self, input: Input) -> Value {
        let inputs = &mut self.tree.interface.inputs;
        let at = inputs.iter().position(|&one| one == input);
        let at = at.unwrap_or_else(|| {
            inputs.push(input);
            inputs.len() - 1
        });
        self.op1(match input.kind() {
            Type::Word => Op::Input(position(at)),
            Type::Mask => Op::InputMask(position(at)),
        })
    }

    /// An operation on a word.
    pub fn unary(&mut self, kind: Unary, a: Value) -> Value {
        self.op1(Op::Unary(kind, a))
    }

    /// An operation on two words.
    pub fn binary(&mut self, kind: Binary, a: Value, b: Value) -> Value {
        if let Some(result) = self.division(kind, a, b) {
            return result;
        }
        self.op1(Op::Binary(kind, [a, b]))
    }

    /// A comparison.
    pub fn compare(&mut self, kind: Compare, a: Value, b: Value) -> Value {
        self.op1(Op::Compare(kind, [a, b]))
    }

    /// An operation on two masks.
    pub fn mask_binary(&mut self, kind: MaskBinary, a: Value, b: Value) -> Value {
        self.op1(Op::MaskBinary(kind, [a, b]))
    }

    /// The opposite of a mask.
    pub fn mask_not(&mut self, a: Value) -> Value {
        self.op1(Op::MaskNot(a))
    }

    /// A function of a float.
    pub fn math(&mut self, function: Math, x: Value) -> Value {
        self.op1(Op::Math(function, x))
    }

    /// `yes` where the mask is set, else `no`; both words, or both masks.
    pub fn select(&mut self, mask: Value, yes: Value, no: Value) -> Value {
        if self.tree.types[yes.index()] == Type::Word {
            return self.op1(Op::Select { mask, yes, no });
        }
        let yes = self.mask_binary(MaskBinary::And, mask, yes);
        let no = self.mask_binary(MaskBinary::AndNot, no, mask);
        self.mask_binary(MaskBinary::Or, yes, no)
    }

    /// The type of a value.
    #[must_use]
    pub fn kind(&self, value: Value) -> Type {
        self.tree.types[value.index()]
    }

    /// The tree, with these outputs.
    ///
    /// # Panics
    /// If a construct is open.
    #[must_use]
    pub fn finish(mut self, outputs: Vec<(Output, Value)>) -> Tree {
        let body = self.open.pop().expect("the body of the tree");
        assert!(self.open.is_empty(), "a construct is open");
        self.tree.body = body.nodes;
        (self.tree.interface.outputs, self.tree.outputs) = outputs.into_iter().unzip();
        self.tree
    }

    fn define(&mut self, types: &[Type]) -> Value {
        let first = Value(position(self.tree.types.len()));
        self.tree.types.extend_from_slice(types);
        self.known.resize(self.tree.types.len(), Known::Nothing);
        first
    }

    fn last(&self) -> &Open {
        self.open.last().expect("the body of the tree is open")
    }

    fn last_mut(&mut self) -> &mut Open {
        self.open.last_mut().expect("the body of the tree is open")
    }

    fn push(&mut self, node: Node) {
        let last = self.last_mut();
        if !last.has_ended {
            last.nodes.push(node);
        }
    }
}

/// A position as the number that operations hold.
fn position(at: usize) -> u32 {
    u32::try_from(at).expect("a tree of fewer than 2^32 values")
}
