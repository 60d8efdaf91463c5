//! From one invocation to many lanes: control flow that is not uniform becomes masks.
//!
//! In · Out: a tree · a kernel. Uniform `if`s, blocks and loops become branches and jumps. For the
//! others, the *state* says where the lanes are: the mask of those that run, and for each divergent
//! label around the mask of those that wait there, with the values that they brought.
//!
//! After a construct that some lanes left for another: the rest of the body is skipped if all
//! did, and if it costs more than two branches. `if … { continue; }` at the start of a long body
//! then saves what an `if` around the rest would.
//!
//! Where ways of the flow graph join, a part of the state that differs becomes a parameter.

mod divergent;
mod flow;
mod leaving;
mod masks;

use super::uniform::Uniformity;
use super::{BlockId, Jump, Kernel, Terminator, ValueInfo};
use crate::op::MaskBinary;
use crate::tree::{Label, Node, Tree};
use crate::{Op, Type, Value};
use flow::Incoming;
use leaving::{Leaving, WORTH_A_BRANCH, cost};

impl Kernel {
    /// The kernel of a tree: finds what is uniform, and turns the other control flow into masks.
    #[must_use]
    pub fn from_tree(tree: &Tree) -> Self {
        let mut lowering = Lowering::new(tree);
        lowering.body(&tree.body);
        let outputs = lowering.mapped(&tree.outputs);
        lowering.end(Terminator::Return(outputs));
        lowering.kernel
    }
}

/// Where the lanes are: the mask of those that run, then for each divergent label around the mask
/// of those that wait, and what they brought.
type State = Vec<Value>;

/// The position of the running lanes in the state.
const RUNNING: usize = 0;

struct Lowering<'a> {
    tree: &'a Tree,
    uniformity: Uniformity,
    leaving: Leaving,
    kernel: Kernel,
    /// The kernel's value of each value of the tree.
    map: Vec<Value>,
    /// The block that grows; `None` where nothing is executed.
    current: Option<BlockId>,
    state: State,
    /// The blocks and loops around.
    around: Vec<Around>,
    constants: Constants,
    /// The running lanes at the beginning.
    entry: Value,
    /// A mask that was found not to be empty.
    not_empty: Value,
}

/// Values of the first block.
#[derive(Debug, Clone, Copy)]
struct Constants {
    none: Value,
    all: Value,
    zero: Value,
}

/// A block or loop around.
struct Around {
    label: Label,
    way: Way,
}

/// How a label is reached.
enum Way {
    /// Lanes wait: their mask stands at this place of the state, followed by so many values.
    Waiting { slot: usize, values: usize },
    /// Jumps to the end of a block.
    Block(Vec<Incoming>),
    /// Jumps to the first block of a loop.
    Loop(BlockId),
}

/// True if it is worth a branch to skip the rest of a body.
fn is_long(rest: &[Node]) -> bool {
    cost(rest) >= 2 * WORTH_A_BRANCH
}

/// The parameters of a loop, and their values in the first iteration.
type Carried<'a> = (&'a [Value], &'a [Value]);

impl<'a> Lowering<'a> {
    fn body(&mut self, nodes: &'a [Node]) {
        for (at, node) in nodes.iter().enumerate() {
            if self.current.is_none() {
                return;
            }
            let rest = &nodes[at + 1..];
            let before = self.state[RUNNING];
            match node {
                Node::Op { op, first } => self.op(op, *first),
                Node::If {
                    condition,
                    accept,
                    reject,
                } => {
                    let mask = self.map[condition.index()];
                    if self.uniformity.is_uniform(*condition) {
                        let may_skip = !self.leaving.of(node).is_empty() && is_long(rest);
                        let skipping = self.uniform_if(mask, [accept, reject], may_skip);
                        if !skipping.is_empty() {
                            self.rest(rest, before, skipping);
                            return;
                        }
                    } else {
                        self.varying_if(node, mask, [accept, reject]);
                    }
                }
                Node::Block {
                    label,
                    results,
                    body,
                } if self.uniformity.is_divergent(*label) => {
                    self.divergent_block(node, *label, results, body);
                }
                Node::Block {
                    label,
                    results,
                    body,
                } => self.uniform_block(*label, results, body),
                Node::Loop {
                    label,
                    parameters,
                    initial,
                    body,
                } => {
                    let skip = self.guard();
                    if self.uniformity.is_divergent(*label) {
                        self.divergent_loop(node, *label, (parameters, initial), body);
                    } else {
                        self.uniform_loop(*label, (parameters, initial), body);
                    }
                    if let Some(skip) = skip {
                        let ended = self.incoming(Vec::new());
                        self.join(ended.into_iter().chain([skip]).collect(), &[]);
                    }
                }
                Node::Branch { label, arguments } => self.branch(*label, arguments),
            }
            if self.may_skip_after(node, before) && is_long(rest) {
                // What the rest defines is seen in the rest alone.
                self.side(rest);
                return;
            }
        }
    }

    /// True if lanes that ran before a construct may all have left it for another one.
    fn may_skip_after(&self, node: &Node, before: Value) -> bool {
        self.current.is_some()
            && matches!(node, Node::If { .. } | Node::Block { .. })
            && !self.leaving.of(node).is_empty()
            && self.state[RUNNING] != before
    }

    fn op(&mut self, op: &Op, first: Value) {
        if let Op::MaskConstant(is_set) = op {
            // A function that is inlined several times has its own constants each time. As one
            // value they show which operations act in the same lanes.
            let Constants { none, all, .. } = self.constants;
            self.map[first.index()] = if *is_set { all } else { none };
            return;
        }
        let mut op = op.clone();
        op.each_operand_mut(|value, _| *value = self.map[value.index()]);
        let running = self.state[RUNNING];
        if running != self.entry
            && !op.is_pure(|_| true)
            && let Some(mask) = op.mask_mut()
        {
            let before = *mask;
            let combined = self.mask_binary(MaskBinary::And, before, running);
            if let Some(mask) = op.mask_mut() {
                *mask = combined;
            }
        }
        let types = op.results();
        let results = first.and_next(types.len());
        let defined = types
            .iter()
            .zip(&results)
            .map(|(&kind, &result)| ValueInfo {
                kind,
                is_uniform: self.uniformity.is_uniform(result),
            });
        let defined: Vec<_> = defined.collect();
        let new_first = self.push(op, &defined);
        for (result, new) in results.iter().zip(new_first.and_next(types.len())) {
            self.map[result.index()] = new;
        }
    }

    /// The rest of a body behind a uniform `if`, of which one side left it for another construct.
    fn rest(&mut self, rest: &'a [Node], before: Value, skipping: Vec<Incoming>) {
        if self.state[RUNNING] == before {
            self.body(rest);
        } else {
            self.side(rest);
        }
        let ran = self.incoming(Vec::new());
        self.join(ran.into_iter().chain(skipping).collect(), &[]);
    }

    /// A uniform `if`. If the rest of the body may be skipped, and no lane runs at the end of one
    /// side, the jump from there is returned.
    fn uniform_if(&mut self, mask: Value, sides: [&'a [Node]; 2], may_skip: bool) -> Vec<Incoming> {
        let Some(fork) = self.current else {
            return Vec::new();
        };
        let before = self.state.clone();
        let mut incoming = Vec::new();
        let [any, none] = sides.map(|body| {
            let side = self.new_block();
            self.current = Some(side);
            self.state.clone_from(&before);
            self.body(body);
            incoming.extend(self.incoming(Vec::new()));
            Jump::to(side)
        });
        self.set_terminator(fork, Terminator::Branch { mask, any, none });
        let none = self.constants.none;
        let has_left = |one: &Incoming| one.runs() == none;
        let all_left = incoming.iter().all(has_left);
        let leaves = |one: &Incoming| may_skip && !all_left && has_left(one);
        let (skipping, staying): (Vec<_>, Vec<_>) = incoming.into_iter().partition(leaves);
        self.join(staying, &[]);
        skipping
    }

    fn uniform_block(&mut self, label: Label, results: &[Value], body: &'a [Node]) {
        self.around.push(Around {
            label,
            way: Way::Block(Vec::new()),
        });
        self.body(body);
        let way = self.around.pop().map(|around| around.way);
        if let Some(Way::Block(mut incoming)) = way {
            // The end is reached by the flow graph even if all lanes wait elsewhere.
            let nothing = self.nothing(results);
            incoming.extend(self.incoming(nothing));
            self.join(incoming, results);
        }
    }

    fn uniform_loop(&mut self, label: Label, carried: Carried<'_>, body: &'a [Node]) {
        let (parameters, initial) = carried;
        let initial = self.mapped(initial);
        let header = self.start_header(initial);
        self.define_parameters(header, parameters);
        self.around.push(Around {
            label,
            way: Way::Loop(header),
        });
        self.body(body);
        self.around.pop();
    }

    fn branch(&mut self, label: Label, arguments: &[Value]) {
        let arguments = self.mapped(arguments);
        let around = self.around.iter().rposition(|around| around.label == label);
        let Some(around) = around else {
            return;
        };
        match self.around[around].way {
            Way::Waiting { slot, .. } => self.wait(slot, &arguments),
            Way::Loop(header) => self.end(Terminator::Jump(Jump {
                to: header,
                arguments,
            })),
            Way::Block(_) => {
                let new = self.incoming(arguments);
                if let Way::Block(incoming) = &mut self.around[around].way {
                    incoming.extend(new);
                }
            }
        }
    }

    /// Values for results that no lane has brought.
    fn nothing(&self, results: &[Value]) -> Vec<Value> {
        let value = |result: &Value| match self.tree.types[result.index()] {
            Type::Word => self.constants.zero,
            Type::Mask => self.constants.none,
        };
        results.iter().map(value).collect()
    }

    fn mapped(&self, values: &[Value]) -> Vec<Value> {
        values.iter().map(|value| self.map[value.index()]).collect()
    }
}
