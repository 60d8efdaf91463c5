//! Checks that a tree is one.

use super::{Label, Node, Tree};
use crate::{Op, Type, Value};

/// What is wrong with a tree.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{what}, in {place}")]
pub struct VerifyError {
    /// What is wrong.
    pub what: String,
    /// The node.
    pub place: String,
}

/// Checks that each value is defined once, in a place that is seen where it is used, that types
/// fit, and that branches go to constructs around them with the right arguments.
///
/// # Errors
/// The first thing that is wrong.
pub fn verify(tree: &Tree) -> Result<(), VerifyError> {
    let mut checker = Checker {
        tree,
        is_seen: vec![false; tree.len()],
        is_defined: vec![false; tree.len()],
        labels: Vec::new(),
        used_labels: Vec::new(),
    };
    // The outputs are seen from the outermost body, so they are checked before it is left.
    checker.body(&tree.body, &|checker| {
        let outputs = &tree.interface.outputs;
        if outputs.len() != tree.outputs.len() {
            return Err("the numbers of outputs and of their values differ".to_owned());
        }
        let pairs = outputs.iter().zip(&tree.outputs);
        pairs
            .into_iter()
            .try_for_each(|(output, &value)| checker.uses(value, output.kind()))
    })?;
    Ok(())
}

struct Checker<'a> {
    tree: &'a Tree,
    is_seen: Vec<bool>,
    is_defined: Vec<bool>,
    /// The constructs around: label and the types of a branch's arguments.
    labels: Vec<(Label, Vec<Type>)>,
    used_labels: Vec<Label>,
}

impl Checker<'_> {
    fn body(
        &mut self,
        nodes: &[Node],
        at_end: &dyn Fn(&Self) -> Result<(), String>,
    ) -> Result<(), VerifyError> {
        let mut defined = Vec::new();
        for (at, node) in nodes.iter().enumerate() {
            let inside = self.begin(node, &mut defined);
            let inside = inside.map_err(|what| VerifyError {
                what,
                place: summary(node),
            })?;
            for body in bodies(node) {
                self.body(body, &|_| Ok(()))?;
            }
            let is_last = at + 1 == nodes.len();
            let ended = self.end(node, is_last, inside, &mut defined);
            ended.map_err(|what| VerifyError {
                what,
                place: summary(node),
            })?;
        }
        at_end(self).map_err(|what| VerifyError {
            what,
            place: "the outputs".to_owned(),
        })?;
        self.leave(defined);
        Ok(())
    }

    /// Checks what comes before the bodies of a node. Returns the values that are seen in them
    /// alone.
    fn begin(&mut self, node: &Node, defined: &mut Vec<Value>) -> Result<Vec<Value>, String> {
        let mut inside = Vec::new();
        match node {
            Node::Op { op, first } => {
                self.op(op)?;
                for (offset, kind) in (0..).zip(op.results()) {
                    self.define(Value(first.0 + offset), *kind, defined)?;
                }
            }
            Node::If { condition, .. } => self.uses(*condition, Type::Mask)?,
            Node::Block { label, results, .. } => {
                let types = self.types(results)?;
                self.enter(*label, types)?;
            }
            Node::Loop {
                label,
                parameters,
                initial,
                ..
            } => {
                let types = self.types(parameters)?;
                self.all_use(initial, &types)?;
                for (value, kind) in parameters.iter().zip(&types) {
                    self.define(*value, *kind, &mut inside)?;
                }
                self.enter(*label, types)?;
            }
            Node::Branch { .. } => {}
        }
        Ok(inside)
    }

    /// Checks what comes after the bodies of a node.
    fn end(
        &mut self,
        node: &Node,
        is_last: bool,
        inside: Vec<Value>,
        defined: &mut Vec<Value>,
    ) -> Result<(), String> {
        match node {
            Node::Op { .. } | Node::If { .. } => {}
            Node::Block { results, body, .. } => {
                let (_, types) = self.labels.pop().expect("the block was entered");
                if !results.is_empty() && !ends(body) {
                    return Err("the end of a block with results is reached".to_owned());
                }
                for (value, kind) in results.iter().zip(types) {
                    self.define(*value, kind, defined)?;
                }
            }
            Node::Loop { .. } => {
                self.labels.pop();
                self.leave(inside);
            }
            Node::Branch { label, arguments } => {
                if !is_last {
                    return Err("a branch is not the last of its body".to_owned());
                }
                let around = self.labels.iter().find(|(name, _)| name == label);
                let Some((_, types)) = around else {
                    return Err("the label is not that of a construct around".to_owned());
                };
                self.all_use(arguments, types)?;
            }
        }
        Ok(())
    }

    fn op(&self, op: &Op) -> Result<(), String> {
        if matches!(op, Op::Any(_)) {
            return Err("a tree knows one lane alone".to_owned());
        }
        let interface = &self.tree.interface;
        let entry = match op {
            Op::Input(at) | Op::InputMask(at) => Some((*at, interface.inputs.len())),
            Op::LoadLocal { array, .. } | Op::StoreLocal { array, .. } => {
                Some((*array, interface.locals.len()))
            }
            Op::LoadBuffer { buffer, .. }
            | Op::StoreBuffer { buffer, .. }
            | Op::BufferBytes(buffer) => Some((*buffer, interface.buffers.len())),
            Op::Texture(op) => Some((op.texture, interface.textures.len())),
            _ => None,
        };
        if entry.is_some_and(|(at, len)| at as usize >= len) {
            return Err("it names an entry that the interface lacks".to_owned());
        }
        if let Op::StoreBuffer { buffer, .. } = op
            && !self.tree.is_written(*buffer)
        {
            return Err("it stores to a buffer that is not marked as written".to_owned());
        }
        let mut result = Ok(());
        op.each_operand(|value, kind| {
            let checked = self.uses(value, kind);
            if result.is_ok() {
                result = checked;
            }
        });
        result
    }

    fn types(&self, values: &[Value]) -> Result<Vec<Type>, String> {
        let kind = |value: &Value| self.tree.types.get(value.index()).copied();
        let types: Option<_> = values.iter().map(kind).collect();
        types.ok_or_else(|| "a value has no type".to_owned())
    }

    fn all_use(&self, values: &[Value], types: &[Type]) -> Result<(), String> {
        if values.len() != types.len() {
            return Err(format!("{} values for {}", values.len(), types.len()));
        }
        let mut pairs = values.iter().zip(types);
        pairs.try_for_each(|(value, kind)| self.uses(*value, *kind))
    }

    fn uses(&self, value: Value, kind: Type) -> Result<(), String> {
        if !self.is_seen.get(value.index()).is_some_and(|&seen| seen) {
            return Err(format!("value {} is not seen here", value.0));
        }
        if self.tree.types[value.index()] != kind {
            return Err(format!("value {} is no {kind:?}", value.0));
        }
        Ok(())
    }

    fn define(&mut self, value: Value, kind: Type, defined: &mut Vec<Value>) -> Result<(), String> {
        if self.tree.types.get(value.index()) != Some(&kind) {
            return Err(format!("value {} has not the type of the result", value.0));
        }
        if std::mem::replace(&mut self.is_defined[value.index()], true) {
            return Err(format!("value {} is defined twice", value.0));
        }
        self.is_seen[value.index()] = true;
        defined.push(value);
        Ok(())
    }

    fn leave(&mut self, defined: Vec<Value>) {
        for value in defined {
            self.is_seen[value.index()] = false;
        }
    }

    fn enter(&mut self, label: Label, types: Vec<Type>) -> Result<(), String> {
        if self.used_labels.contains(&label) {
            return Err(format!("label {} is used twice", label.0));
        }
        self.used_labels.push(label);
        self.labels.push((label, types));
        Ok(())
    }
}

/// The bodies of a node.
fn bodies(node: &Node) -> [&[Node]; 2] {
    match node {
        Node::Op { .. } | Node::Branch { .. } => [&[], &[]],
        Node::If { accept, reject, .. } => [accept, reject],
        Node::Block { body, .. } | Node::Loop { body, .. } => [body, &[]],
    }
}

/// True if the end of a body is never reached.
pub(crate) fn ends(body: &[Node]) -> bool {
    match body.last() {
        Some(Node::Branch { .. }) => true,
        Some(Node::If { accept, reject, .. }) => ends(accept) && ends(reject),
        Some(Node::Loop { body, .. }) => ends(body),
        Some(Node::Block { label, body, .. }) => ends(body) && !branches_to(body, *label),
        _ => false,
    }
}

fn branches_to(body: &[Node], to: Label) -> bool {
    body.iter().any(|node| match node {
        Node::Op { .. } => false,
        Node::If { accept, reject, .. } => branches_to(accept, to) || branches_to(reject, to),
        Node::Block { body, .. } | Node::Loop { body, .. } => branches_to(body, to),
        Node::Branch { label, .. } => *label == to,
    })
}

fn summary(node: &Node) -> String {
    match node {
        Node::Op { op, first } => format!("{op:?}, value {}", first.0),
        Node::If { condition, .. } => format!("the `if` of value {}", condition.0),
        Node::Block { label, .. } => format!("block {}", label.0),
        Node::Loop { label, .. } => format!("loop {}", label.0),
        Node::Branch { label, .. } => format!("a branch to label {}", label.0),
    }
}
