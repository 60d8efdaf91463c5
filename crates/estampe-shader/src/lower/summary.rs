//! What functions change, and which variables are indexed by numbers that the shader computes.

use naga::{Block, Expression, Function, GlobalVariable, Handle, LocalVariable, Module, Statement};
use std::collections::{HashMap, HashSet};

/// Where a pointer begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Root {
    Local(Handle<LocalVariable>),
    Argument(u32),
    Global(Handle<GlobalVariable>),
}

/// What code does to memory of the invocation.
#[derive(Debug, Clone, Default)]
pub(super) struct Summary {
    /// The variables that it may change.
    pub(super) stored: HashSet<Root>,
    /// The variables that it indexes by a number that is computed.
    pub(super) indexed: HashSet<Root>,
    /// It may discard the invocation.
    pub(super) kills: bool,
}

/// The summaries of all functions.
#[derive(Debug)]
pub(super) struct Summaries {
    of_function: HashMap<Handle<Function>, Summary>,
    /// Global variables that any function indexes.
    indexed: HashSet<Handle<GlobalVariable>>,
    /// Global variables that any function stores to.
    stored: HashSet<Handle<GlobalVariable>>,
}

impl Summaries {
    pub(super) fn new(module: &Module) -> Self {
        let mut summaries = Self {
            of_function: HashMap::new(),
            indexed: HashSet::new(),
            stored: HashSet::new(),
        };
        // A function stands after those that it calls.
        for (handle, function) in module.functions.iter() {
            let summary = summaries.of(function, &function.body);
            summaries.of_function.insert(handle, summary);
        }
        for point in &module.entry_points {
            summaries.of(&point.function, &point.function.body);
        }
        summaries
    }

    /// True if a function indexes a global variable by a number that is computed.
    pub(super) fn is_indexed(&self, global: Handle<GlobalVariable>) -> bool {
        self.indexed.contains(&global)
    }

    /// True if a function stores to a global variable.
    pub(super) fn is_stored(&self, global: Handle<GlobalVariable>) -> bool {
        self.stored.contains(&global)
    }

    /// What a block of a function does.
    pub(super) fn of(&mut self, function: &Function, block: &Block) -> Summary {
        let mut summary = Summary::default();
        for (_, expression) in function.expressions.iter() {
            if let Expression::Access { base, index } = *expression
                && !matches!(function.expressions[index], Expression::Literal(_))
                && let Some(root) = root(function, base)
            {
                self.index(root, &mut summary);
            }
        }
        self.block(function, block, &mut summary);
        self.stored
            .extend(summary.stored.iter().filter_map(|root| match root {
                Root::Global(global) => Some(*global),
                Root::Local(_) | Root::Argument(_) => None,
            }));
        summary
    }

    fn index(&mut self, root: Root, summary: &mut Summary) {
        summary.indexed.insert(root);
        if let Root::Global(global) = root {
            self.indexed.insert(global);
        }
    }

    fn block(&mut self, function: &Function, block: &Block, summary: &mut Summary) {
        for statement in block {
            match statement {
                Statement::Block(block) => self.block(function, block, summary),
                Statement::If { accept, reject, .. } => {
                    self.block(function, accept, summary);
                    self.block(function, reject, summary);
                }
                Statement::Switch { cases, .. } => {
                    for case in cases {
                        self.block(function, &case.body, summary);
                    }
                }
                Statement::Loop {
                    body, continuing, ..
                } => {
                    self.block(function, body, summary);
                    self.block(function, continuing, summary);
                }
                Statement::Store { pointer, .. } => {
                    summary.stored.extend(root(function, *pointer));
                }
                Statement::Kill => summary.kills = true,
                Statement::Call {
                    function: callee,
                    arguments,
                    ..
                } => self.call(function, *callee, arguments, summary),
                _ => {}
            }
        }
    }

    fn call(
        &mut self,
        function: &Function,
        callee: Handle<Function>,
        arguments: &[Handle<Expression>],
        summary: &mut Summary,
    ) {
        let of_callee = self.of_function.get(&callee).cloned().unwrap_or_default();
        let here = |one: Root| match one {
            Root::Argument(at) => root(function, *arguments.get(at as usize)?),
            Root::Global(_) => Some(one),
            Root::Local(_) => None,
        };
        summary
            .stored
            .extend(of_callee.stored.iter().filter_map(|one| here(*one)));
        for one in of_callee.indexed.iter().filter_map(|one| here(*one)) {
            self.index(one, summary);
        }
        summary.kills |= of_callee.kills;
    }
}

/// Where a pointer begins; `None` if the expression is none.
pub(super) fn root(function: &Function, mut pointer: Handle<Expression>) -> Option<Root> {
    loop {
        match function.expressions[pointer] {
            Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => {
                pointer = base;
            }
            Expression::LocalVariable(local) => return Some(Root::Local(local)),
            Expression::FunctionArgument(at) => return Some(Root::Argument(at)),
            Expression::GlobalVariable(global) => return Some(Root::Global(global)),
            _ => return None,
        }
    }
}
