//! Which values are the same in all running lanes, and which labels lanes reach at different times.
//!
//! In · Out: a tree · a flag for each value and each label. Everything is uniform at first; what
//! is not spreads along edges: from an operand to the result, from a condition to the labels that
//! are branched to under it, from a label to its results.
//!
//! A label is *divergent* if lanes may come to it on different ways: a branch to it lies under a
//! condition that is not uniform, or leaves another divergent construct, in which lanes wait. A
//! loop is divergent too if some lanes may leave it before others.
//!
//! The parameters of a divergent loop may be uniform if one branch goes to it, from no other
//! divergent loop: lanes that left do not see them any more.

use crate::op::{LevelOfDetail, TextureQuery};
use crate::tree::{Label, Node, Tree};
use crate::{Op, Value};
use std::collections::HashMap;

/// What is uniform in a tree.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Uniformity {
    is_varying: Vec<bool>,
    is_divergent: HashMap<Label, bool>,
}

impl Uniformity {
    /// Analyses a tree.
    #[must_use]
    pub fn of(tree: &Tree) -> Self {
        let mut graph = Graph {
            tree,
            edges: Vec::new(),
            sources: Vec::new(),
            constructs: HashMap::new(),
            stored_arrays: stored_arrays(tree),
            path: Vec::new(),
        };
        graph.body(&tree.body);
        graph.labels();
        graph.spread()
    }

    /// True if the value is the same in all running lanes.
    #[must_use]
    pub fn is_uniform(&self, value: Value) -> bool {
        !self.is_varying[value.index()]
    }

    /// True if lanes may come to the label on different ways.
    #[must_use]
    pub fn is_divergent(&self, label: Label) -> bool {
        self.is_divergent.get(&label).is_some_and(|&is| is)
    }
}

/// What can be not uniform.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Fact {
    Value(Value),
    Label(Label),
}

struct Graph<'a> {
    tree: &'a Tree,
    /// Where the first is not uniform, the second is not.
    edges: Vec<(Fact, Fact)>,
    /// What is not uniform by itself.
    sources: Vec<Fact>,
    constructs: HashMap<Label, Construct<'a>>,
    stored_arrays: Vec<bool>,
    /// The constructs around.
    path: Vec<Around>,
}

/// A block or loop.
struct Construct<'a> {
    /// Its results or parameters.
    values: &'a [Value],
    /// The parameters in the first iteration.
    initial: Option<&'a [Value]>,
    /// The arguments of the branches to it.
    branches: Vec<&'a [Value]>,
}

#[derive(Clone, Copy)]
enum Around {
    If(Value),
    Block(Label),
    Loop(Label),
}

impl<'a> Graph<'a> {
    fn body(&mut self, nodes: &'a [Node]) {
        for node in nodes {
            match node {
                Node::Op { op, first } => self.op(op, *first),
                Node::If {
                    condition,
                    accept,
                    reject,
                } => {
                    self.path.push(Around::If(*condition));
                    self.body(accept);
                    self.body(reject);
                    self.path.pop();
                }
                Node::Block {
                    label,
                    results,
                    body,
                } => {
                    self.enter(*label, results, None);
                    self.path.push(Around::Block(*label));
                    self.body(body);
                    self.path.pop();
                }
                Node::Loop {
                    label,
                    parameters,
                    initial,
                    body,
                } => {
                    self.enter(*label, parameters, Some(initial));
                    self.path.push(Around::Loop(*label));
                    self.body(body);
                    self.path.pop();
                }
                Node::Branch { label, arguments } => self.branch(*label, arguments),
            }
        }
    }

    fn enter(&mut self, label: Label, values: &'a [Value], initial: Option<&'a [Value]>) {
        let construct = Construct {
            values,
            initial,
            branches: Vec::new(),
        };
        self.constructs.insert(label, construct);
    }

    fn branch(&mut self, to: Label, arguments: &'a [Value]) {
        if let Some(construct) = self.constructs.get_mut(&to) {
            construct.branches.push(arguments);
        }
        let mut crossed = Vec::new();
        for around in self.path.iter().rev() {
            let label = match *around {
                Around::If(condition) => {
                    crossed.push(Fact::Value(condition));
                    continue;
                }
                Around::Block(label) | Around::Loop(label) => label,
            };
            let fact = Fact::Label(label);
            let is_loop = matches!(around, Around::Loop(_));
            if label == to {
                self.edges.extend(crossed.iter().map(|&from| (from, fact)));
                return;
            }
            if is_loop {
                // Lanes leave the loop, perhaps before others. And if lanes wait where this one
                // goes, the loop must notice that none is left in it.
                self.edges
                    .extend(crossed.drain(..).map(|from| (from, fact)));
                self.edges.push((Fact::Label(to), fact));
                // They bring what the values were in different iterations.
                let brought = self.constructs.get(&to).map_or(&[][..], |of| of.values);
                let brought = brought.iter().map(|&value| (fact, Fact::Value(value)));
                self.edges.extend(brought);
            }
            crossed.push(fact);
        }
    }

    /// The edges from labels and arguments to results and parameters.
    fn labels(&mut self) {
        for (&label, construct) in &self.constructs {
            for (at, &value) in construct.values.iter().enumerate() {
                let of_branches = construct.branches.iter().map(|arguments| arguments[at]);
                let initial = construct.initial.map(|initial| initial[at]);
                let to = Fact::Value(value);
                let given = of_branches.chain(initial);
                self.edges.extend(given.map(|from| (Fact::Value(from), to)));
                if construct.initial.is_none() || construct.branches.len() > 1 {
                    self.edges.push((Fact::Label(label), to));
                }
            }
        }
    }

    fn op(&mut self, op: &Op, first: Value) {
        let results = || first.and_next(op.results().len());
        if self.is_varying(op) {
            self.sources.extend(results().into_iter().map(Fact::Value));
            return;
        }
        for result in results() {
            let to = Fact::Value(result);
            op.each_operand(|operand, _| self.edges.push((Fact::Value(operand), to)));
        }
    }

    /// True if the results are not uniform even if the operands are.
    fn is_varying(&self, op: &Op) -> bool {
        match op {
            Op::Input(at) | Op::InputMask(at) => {
                let input = self.tree.interface.inputs.get(*at as usize);
                input.is_none_or(|input| !input.is_uniform())
            }
            Op::LoadLocal { array, .. } => self.stored_arrays[*array as usize],
            Op::Atomic { .. } | Op::CompareExchange { .. } => true,
            // That of an infinity is NaN in whole quads, and 0 in others.
            Op::Derivative { .. } => true,
            // 0 in quads in which the lane does not run.
            Op::QuadLane { .. } => true,
            Op::Texture(op) => match op.query {
                TextureQuery::Size
                | TextureQuery::Levels
                | TextureQuery::Layers
                | TextureQuery::Samples => false,
                TextureQuery::Load => matches!(op.level, LevelOfDetail::Implicit),
                _ => true,
            },
            _ => false,
        }
    }

    fn spread(self) -> Uniformity {
        let mut next: HashMap<Fact, Vec<Fact>> = HashMap::new();
        for (from, to) in self.edges {
            next.entry(from).or_default().push(to);
        }
        let mut uniformity = Uniformity {
            is_varying: vec![false; self.tree.len()],
            is_divergent: HashMap::new(),
        };
        let mut open = self.sources;
        while let Some(fact) = open.pop() {
            let was = match fact {
                Fact::Value(value) => {
                    std::mem::replace(&mut uniformity.is_varying[value.index()], true)
                }
                Fact::Label(label) => {
                    let of_label = uniformity.is_divergent.insert(label, true);
                    of_label.is_some()
                }
            };
            if !was && let Some(facts) = next.get(&fact) {
                open.extend(facts);
            }
        }
        uniformity
    }
}

/// For each array of the interface, true if something is stored to it.
fn stored_arrays(tree: &Tree) -> Vec<bool> {
    let mut is_stored = vec![false; tree.interface.locals.len()];
    let mut open: Vec<&[Node]> = vec![&tree.body];
    while let Some(nodes) = open.pop() {
        for node in nodes {
            match node {
                Node::Op {
                    op: Op::StoreLocal { array, .. },
                    ..
                } => is_stored[*array as usize] = true,
                Node::Op { .. } | Node::Branch { .. } => {}
                Node::If { accept, reject, .. } => open.extend([&accept[..], &reject[..]]),
                Node::Block { body, .. } | Node::Loop { body, .. } => open.push(body),
            }
        }
    }
    is_stored
}
