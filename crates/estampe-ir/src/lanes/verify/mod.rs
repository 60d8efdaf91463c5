//! Checks that a kernel is one.

use crate::lanes::dominators::Dominators;
use crate::lanes::{BasicBlock, BlockId, Jump, Kernel, Terminator};
use crate::op::{LevelOfDetail, Memory, TextureQuery};
use crate::{Op, Type, Value};

/// What is wrong with a kernel.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{what}, in {place}")]
pub struct VerifyError {
    /// What is wrong.
    pub what: String,
    /// The block, and the operation.
    pub place: String,
}

/// Checks that each value is defined once, before it is used on all ways to its use; that types and
/// numbers of arguments fit; that the entries of the interface exist; that what is called uniform
/// is made of what is uniform; and that blocks stand in order. In blocks that are never reached,
/// only values and entries must exist.
///
/// # Errors
/// The first thing that is wrong.
pub fn verify(kernel: &Kernel) -> Result<(), VerifyError> {
    let mut checker = Checker {
        kernel,
        dominators: Dominators::default(),
        defined: vec![None; kernel.values.len()],
        is_stored: vec![false; kernel.interface.locals.len()],
    };
    checker.define_all()?;
    checker.flow()?;
    checker.dominators = Dominators::of(kernel);
    checker.order()?;
    for (block, at) in kernel.blocks.iter().zip(0..) {
        checker.block(BlockId(at), block)?;
    }
    Ok(())
}

struct Checker<'a> {
    kernel: &'a Kernel,
    dominators: Dominators,
    /// Block and operation of each value. Parameters are at 0, the first operation is at 1.
    defined: Vec<Option<(BlockId, usize)>>,
    /// For each array, whether something is stored to it.
    is_stored: Vec<bool>,
}

type Checked = Result<(), String>;

impl Checker<'_> {
    fn define_all(&mut self) -> Result<(), VerifyError> {
        for (block, id) in self.kernel.blocks.iter().zip((0..).map(BlockId)) {
            for &parameter in &block.parameters {
                let defined = self.define(parameter, None, (id, 0));
                defined.map_err(|what| at(id, None, what))?;
            }
            for (index, (op, first)) in block.ops.iter().enumerate() {
                for (offset, &kind) in (0..).zip(op.results()) {
                    let value = Value(first.0.saturating_add(offset));
                    let defined = self.define(value, Some(kind), (id, index + 1));
                    defined.map_err(|what| at(id, Some(op), what))?;
                }
                if let Op::StoreLocal { array, .. } = op
                    && let Some(is_stored) = self.is_stored.get_mut(*array as usize)
                {
                    *is_stored = true;
                }
            }
        }
        Ok(())
    }

    fn define(&mut self, value: Value, kind: Option<Type>, place: (BlockId, usize)) -> Checked {
        let Some(info) = self.kernel.values.get(value.index()) else {
            return Err(format!("nothing is known of value {}", value.0));
        };
        if kind.is_some_and(|kind| kind != info.kind) {
            return Err(format!("value {} has not the type of the result", value.0));
        }
        if self.defined[value.index()].replace(place).is_some() {
            return Err(format!("value {} is defined twice", value.0));
        }
        Ok(())
    }

    /// Jumps go to blocks, with as many arguments as those have parameters.
    fn flow(&self) -> Result<(), VerifyError> {
        let blocks = &self.kernel.blocks;
        let Some(entry) = blocks.first() else {
            return Err(at(BlockId(0), None, "there is no block".to_owned()));
        };
        if !entry.parameters.is_empty() {
            let what = "the first block has parameters".to_owned();
            return Err(at(BlockId(0), None, what));
        }
        for (block, id) in blocks.iter().zip((0..).map(BlockId)) {
            for jump in block.terminator.jumps() {
                let checked = match blocks.get(jump.to.index()) {
                    None => Err(format!("block {} does not exist", jump.to.0)),
                    Some(_) if jump.to.0 == 0 => Err("a jump goes to the first block".to_owned()),
                    Some(to) => count(jump.arguments.len(), to.parameters.len()),
                };
                checked.map_err(|what| at(id, None, what))?;
            }
        }
        Ok(())
    }

    /// A jump backwards goes to a loop header: a block without which its source is not reached.
    fn order(&self) -> Result<(), VerifyError> {
        for (block, id) in self.kernel.blocks.iter().zip((0..).map(BlockId)) {
            for jump in block.terminator.jumps() {
                if jump.to <= id
                    && self.dominators.is_reached(id)
                    && !self.dominators.dominates(jump.to, id)
                {
                    let what = format!(
                        "a jump goes back to block {}, which is no loop header",
                        jump.to.0
                    );
                    return Err(at(id, None, what));
                }
            }
        }
        Ok(())
    }

    fn block(&self, id: BlockId, block: &BasicBlock) -> Result<(), VerifyError> {
        for (index, (op, first)) in block.ops.iter().enumerate() {
            let checked = self.op(op, (id, index + 1));
            let checked = checked.and_then(|()| self.is_uniform_result(op, *first));
            checked.map_err(|what| at(id, Some(op), what))?;
        }
        let here = (id, block.ops.len() + 1);
        let checked = self.terminator(&block.terminator, here);
        checked.map_err(|what| at(id, None, what))
    }

    fn op(&self, op: &Op, here: (BlockId, usize)) -> Checked {
        self.entries(op)?;
        let mut checked = Ok(());
        op.each_operand(|value, kind| {
            if checked.is_ok() {
                checked = self.uses(value, kind, here);
            }
        });
        checked
    }

    fn entries(&self, op: &Op) -> Checked {
        let interface = &self.kernel.interface;
        let exists = |at: u32, len: usize| {
            let is_there = (at as usize) < len;
            let missing = || "it names an entry that the interface lacks".to_owned();
            is_there.then_some(()).ok_or_else(missing)
        };
        let is_written = |buffer: u32| {
            let slot = interface.buffers.get(buffer as usize);
            let is_written = slot.is_some_and(|slot| slot.is_written);
            let not = || "it stores to a buffer that is not marked as written".to_owned();
            is_written.then_some(()).ok_or_else(not)
        };
        match op {
            Op::Input(at) | Op::InputMask(at) => {
                exists(*at, interface.inputs.len())?;
                let kind = interface.inputs[*at as usize].kind();
                let differs = || "the input is of another type".to_owned();
                (op.results() == [kind]).then_some(()).ok_or_else(differs)
            }
            Op::LoadLocal { array, .. } | Op::StoreLocal { array, .. } => {
                exists(*array, interface.locals.len())
            }
            Op::LoadBuffer { buffer, .. } | Op::BufferBytes(buffer) => {
                exists(*buffer, interface.buffers.len())
            }
            Op::StoreBuffer { buffer, .. }
            | Op::Atomic {
                memory: Memory::Buffer(buffer),
                ..
            }
            | Op::CompareExchange {
                memory: Memory::Buffer(buffer),
                ..
            } => {
                exists(*buffer, interface.buffers.len())?;
                is_written(*buffer)
            }
            Op::Texture(op) => {
                exists(op.texture, interface.textures.len())?;
                let sampler = op.sampler.unwrap_or(0);
                let samplers = interface.samplers.len();
                exists(sampler, samplers + usize::from(op.sampler.is_none()))
            }
            _ => Ok(()),
        }
    }

    /// A uniform result has uniform operands, and its operation gives all lanes the same. The mask
    /// in which an operation acts may differ: results count in the lanes that run.
    fn is_uniform_result(&self, op: &Op, first: Value) -> Checked {
        let results = first.and_next(op.results().len());
        if !results.iter().any(|&value| self.is_uniform(value)) || matches!(op, Op::Any(_)) {
            return Ok(());
        }
        let mask = op.clone().mask_mut().copied();
        let mut is_uniform = !self.is_varying(op);
        op.each_operand(|value, _| {
            is_uniform &= self.is_uniform(value) || Some(value) == mask;
        });
        if is_uniform {
            return Ok(());
        }
        Err("the result is called uniform, and is not".to_owned())
    }

    /// True if the operation may give lanes different results for the same operands.
    fn is_varying(&self, op: &Op) -> bool {
        match op {
            Op::Input(at) | Op::InputMask(at) => {
                !self.kernel.interface.inputs[*at as usize].is_uniform()
            }
            Op::LoadLocal { array, .. } => self.is_stored[*array as usize],
            Op::Atomic { .. } | Op::CompareExchange { .. } => true,
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

    fn terminator(&self, terminator: &Terminator, here: (BlockId, usize)) -> Checked {
        if let Terminator::Branch { mask, .. } = terminator {
            self.uses(*mask, Type::Mask, here)?;
        }
        for jump in terminator.jumps() {
            self.jump(jump, here)?;
        }
        if let Terminator::Return(values) = terminator {
            let outputs = &self.kernel.interface.outputs;
            if self.dominators.is_reached(here.0) {
                count(values.len(), outputs.len())?;
            }
            for (&value, output) in values.iter().zip(outputs) {
                self.uses(value, output.kind(), here)?;
            }
        }
        Ok(())
    }

    fn jump(&self, jump: &Jump, here: (BlockId, usize)) -> Checked {
        let parameters = &self.kernel.blocks[jump.to.index()].parameters;
        for (&parameter, &argument) in parameters.iter().zip(&jump.arguments) {
            self.uses(argument, self.kernel.values[parameter.index()].kind, here)?;
            if self.is_uniform(parameter) && !self.is_uniform(argument) {
                let (parameter, argument) = (parameter.0, argument.0);
                return Err(format!(
                    "value {argument} is not uniform, but the parameter {parameter} is"
                ));
            }
        }
        Ok(())
    }

    fn uses(&self, value: Value, kind: Type, here: (BlockId, usize)) -> Checked {
        let Some(info) = self.kernel.values.get(value.index()) else {
            return Err(format!("nothing is known of value {}", value.0));
        };
        if info.kind != kind {
            return Err(format!("value {} is no {kind:?}", value.0));
        }
        let (block, index) = here;
        if !self.dominators.is_reached(block) {
            return Ok(());
        }
        let is_seen = self.defined[value.index()].is_some_and(|(of_value, defined)| {
            if of_value == block {
                defined < index
            } else {
                self.dominators.dominates(of_value, block)
            }
        });
        let not_seen = || format!("value {} is not defined on all ways to its use", value.0);
        is_seen.then_some(()).ok_or_else(not_seen)
    }

    fn is_uniform(&self, value: Value) -> bool {
        let info = self.kernel.values.get(value.index());
        info.is_some_and(|info| info.is_uniform)
    }
}

fn count(found: usize, expected: usize) -> Checked {
    let differ = || format!("there are {found} values for {expected}");
    (found == expected).then_some(()).ok_or_else(differ)
}

fn at(block: BlockId, op: Option<&Op>, what: String) -> VerifyError {
    let place = match op {
        Some(op) => format!("block {}, {op:?}", block.0),
        None => format!("block {}", block.0),
    };
    VerifyError { what, place }
}

#[cfg(test)]
mod tests;
