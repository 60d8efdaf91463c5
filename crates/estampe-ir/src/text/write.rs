//! Trees and kernels to text.

use super::interface::{STAGES, of_input, of_output};
use super::write_ops::{op, word};
use crate::interface::{BufferSlot, Interface, Stage};
use crate::lanes::{Jump, Kernel, Terminator};
use crate::tree::{Node, Tree};
use crate::{Op, Type, Value};
use std::fmt::{Display, Formatter, Result};

/// The names of values.
pub(super) trait Names {
    /// The type, and whether it is known to be uniform.
    fn info(&self, value: Value) -> (Type, bool);

    fn name(&self, value: Value) -> String {
        let (kind, is_uniform) = self.info(value);
        let uniform = if is_uniform { "u" } else { "" };
        let kind = match kind {
            Type::Word => 'v',
            Type::Mask => 'm',
        };
        format!("{uniform}{kind}{}", value.0)
    }

    fn list(&self, values: &[Value]) -> String {
        let names: Vec<_> = values.iter().map(|&value| self.name(value)).collect();
        names.join(", ")
    }

    /// Values in brackets; nothing if there are none.
    fn bracketed(&self, values: &[Value]) -> String {
        if values.is_empty() {
            return String::new();
        }
        format!("({})", self.list(values))
    }

    fn line(&self, of_op: &Op, first: Value) -> String {
        let results = first.and_next(of_op.results().len());
        if results.is_empty() {
            return op(of_op, self);
        }
        format!("{} = {}", self.list(&results), op(of_op, self))
    }
}

impl Names for Kernel {
    fn info(&self, value: Value) -> (Type, bool) {
        let info = self.values.get(value.index());
        info.map_or((Type::Word, false), |info| (info.kind, info.is_uniform))
    }
}

impl Names for Tree {
    fn info(&self, value: Value) -> (Type, bool) {
        let kind = self.types.get(value.index());
        (kind.copied().unwrap_or(Type::Word), false)
    }
}

impl Display for Kernel {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        header(f, "kernel", self.stage, &self.interface)?;
        let parameters = self.blocks.iter().flat_map(|block| &block.parameters);
        let ops = self.blocks.iter().flat_map(|block| &block.ops);
        let results = ops.flat_map(|(op, first)| first.and_next(op.results().len()));
        undefined(
            f,
            self,
            self.values.len(),
            parameters.copied().chain(results),
        )?;
        for (block, at) in self.blocks.iter().zip(0..) {
            writeln!(f, "b{at}{}:", self.bracketed(&block.parameters))?;
            for (op, first) in &block.ops {
                writeln!(f, "  {}", self.line(op, *first))?;
            }
            let target = |jump: &Jump| format!("b{}{}", jump.to.0, self.bracketed(&jump.arguments));
            match &block.terminator {
                Terminator::Jump(jump) => writeln!(f, "  jump {}", target(jump))?,
                Terminator::Branch { mask, any, none } => {
                    let (mask, any, none) = (self.name(*mask), target(any), target(none));
                    writeln!(f, "  branch {mask} ? {any} : {none}")?;
                }
                Terminator::Return(values) => {
                    writeln!(
                        f,
                        "{}",
                        format!("  return {}", self.list(values)).trim_end()
                    )?;
                }
            }
        }
        Ok(())
    }
}

impl Display for Tree {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        header(f, "tree", self.stage, &self.interface)?;
        let mut defined = Vec::new();
        collect_defined(&self.body, &mut defined);
        undefined(f, self, self.len(), defined.into_iter())?;
        self.body(f, &self.body, 0)?;
        writeln!(
            f,
            "{}",
            format!("outputs {}", self.list(&self.outputs)).trim_end()
        )
    }
}

impl Tree {
    fn body(&self, f: &mut Formatter<'_>, nodes: &[Node], depth: usize) -> Result {
        let indent = "  ".repeat(depth);
        for node in nodes {
            match node {
                Node::Op { op, first } => writeln!(f, "{indent}{}", self.line(op, *first))?,
                Node::If {
                    condition,
                    accept,
                    reject,
                } => {
                    writeln!(f, "{indent}if {} {{", self.name(*condition))?;
                    self.body(f, accept, depth + 1)?;
                    if !reject.is_empty() {
                        writeln!(f, "{indent}}} else {{")?;
                        self.body(f, reject, depth + 1)?;
                    }
                    writeln!(f, "{indent}}}")?;
                }
                Node::Block {
                    label,
                    results,
                    body,
                } => {
                    let results = match results[..] {
                        [] => String::new(),
                        _ => format!(" {}", self.bracketed(results)),
                    };
                    writeln!(f, "{indent}block l{}{results} {{", label.0)?;
                    self.body(f, body, depth + 1)?;
                    writeln!(f, "{indent}}}")?;
                }
                Node::Loop {
                    label,
                    parameters,
                    initial,
                    body,
                } => {
                    let pairs = parameters.iter().zip(initial);
                    let pairs =
                        pairs.map(|(&a, &b)| format!("{} = {}", self.name(a), self.name(b)));
                    let pairs: Vec<_> = pairs.collect();
                    let pairs = match pairs[..] {
                        [] => String::new(),
                        _ => format!(" ({})", pairs.join(", ")),
                    };
                    writeln!(f, "{indent}loop l{}{pairs} {{", label.0)?;
                    self.body(f, body, depth + 1)?;
                    writeln!(f, "{indent}}}")?;
                }
                Node::Branch { label, arguments } => {
                    let arguments = self.bracketed(arguments);
                    writeln!(f, "{indent}branch l{}{arguments}", label.0)?;
                }
            }
        }
        Ok(())
    }
}

fn collect_defined(nodes: &[Node], defined: &mut Vec<Value>) {
    for node in nodes {
        match node {
            Node::Op { op, first } => defined.extend(first.and_next(op.results().len())),
            Node::If { accept, reject, .. } => {
                collect_defined(accept, defined);
                collect_defined(reject, defined);
            }
            Node::Block {
                results: values,
                body,
                ..
            }
            | Node::Loop {
                parameters: values,
                body,
                ..
            } => {
                defined.extend(values);
                collect_defined(body, defined);
            }
            Node::Branch { .. } => {}
        }
    }
}

/// Lists the values that nothing defines.
fn undefined(
    f: &mut Formatter<'_>,
    names: &impl Names,
    values: usize,
    defined: impl Iterator<Item = Value>,
) -> Result {
    let mut is_defined = vec![false; values];
    for value in defined {
        if let Some(is_defined) = is_defined.get_mut(value.index()) {
            *is_defined = true;
        }
    }
    let values = (0..).map(Value).zip(is_defined);
    let missing: Vec<_> = values
        .filter(|(_, is)| !is)
        .map(|(value, _)| value)
        .collect();
    if missing.is_empty() {
        return Ok(());
    }
    writeln!(f, "undefined {}", names.list(&missing))
}

fn header(f: &mut Formatter<'_>, kind: &str, stage: Stage, interface: &Interface) -> Result {
    let named = STAGES.iter().find(|(_, of_name)| *of_name == stage);
    writeln!(f, "{kind} {}", named.map_or("", |(name, _)| name))?;
    for &input in &interface.inputs {
        writeln!(f, "input {}", of_input(input))?;
    }
    for &output in &interface.outputs {
        writeln!(f, "output {}", of_output(output))?;
    }
    for buffer in &interface.buffers {
        if *buffer == BufferSlot::IMMEDIATES {
            writeln!(f, "buffer immediates")?;
            continue;
        }
        let written = if buffer.is_written { " written" } else { "" };
        writeln!(f, "buffer {}.{}{written}", buffer.group, buffer.binding)?;
    }
    for texture in &interface.textures {
        writeln!(f, "texture_at {}.{}", texture.group, texture.binding)?;
    }
    for sampler in &interface.samplers {
        writeln!(f, "sampler_at {}.{}", sampler.group, sampler.binding)?;
    }
    for array in &interface.locals {
        let words: Vec<_> = array.init.iter().map(|&one| word(one)).collect();
        let start = match words[..] {
            [] => String::new(),
            _ => format!(" [{}]", words.join(", ")),
        };
        writeln!(f, "local {}{start}", array.words)?;
    }
    let [x, y, z] = interface.workgroup_size;
    if interface.workgroup_words != 0 || [x, y, z] != [0; 3] {
        let words = interface.workgroup_words;
        writeln!(f, "workgroup {words} ({x}, {y}, {z})")?;
    }
    Ok(())
}
