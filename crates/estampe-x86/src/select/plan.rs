//! What is known of a kernel's values before instructions are selected.
//!
//! In · Out: a kernel · for each value whether it is needed, the same in all lanes, or *hoisted*:
//! computed once a run, not once a packet. Values are hoisted if nothing that they depend on
//! changes in a run. They live in memory, where instructions read them as operands.

use estampe_ir::interface::Input;
use estampe_ir::lanes::{Kernel, Terminator};
use estampe_ir::op::{Binary, Memory, TextureQuery, Unary};
use estampe_ir::{Op, Value};

/// The blocks and values of a kernel.
#[derive(Debug)]
pub(crate) struct Plan {
    /// Blocks that can be reached.
    pub(crate) is_reached: Vec<bool>,
    /// The number of jumps to each block from blocks that are reached.
    pub(crate) predecessors: Vec<u32>,
    /// Values that something needs.
    is_needed: Vec<bool>,
    /// Values that are the same in all lanes, whether those run or not.
    is_splat: Vec<bool>,
    is_hoisted: Vec<bool>,
    /// True if the kernel stores texels.
    stores_texels: bool,
    /// Buffers that the kernel may change: those to which it may store, if it stores to any. Most
    /// programs declare buffers for writing that only some of their kernels write.
    is_written: Vec<bool>,
    /// Arrays to which something is stored. The others are tables of constants.
    is_array_stored: Vec<bool>,
    /// Masks in which a quad has all of its lanes or none of those that run.
    has_whole_quads: Vec<bool>,
    constants: Vec<Option<u32>>,
    /// Values that are square roots.
    is_root: Vec<bool>,
    /// Values that operations of floats gave.
    is_float: Vec<bool>,
}

impl Plan {
    /// Analyses a kernel.
    pub(crate) fn new(kernel: &Kernel) -> Self {
        let values = kernel.values.len();
        let mut plan = Self {
            is_reached: vec![false; kernel.blocks.len()],
            predecessors: vec![0; kernel.blocks.len()],
            is_needed: vec![false; values],
            is_splat: vec![true; values],
            is_hoisted: vec![false; values],
            stores_texels: stores_texels(kernel),
            is_written: written_buffers(kernel),
            is_array_stored: vec![false; kernel.interface.locals.len()],
            has_whole_quads: vec![false; values],
            constants: vec![None; values],
            is_root: vec![false; values],
            is_float: vec![false; values],
        };
        plan.reach(kernel);
        plan.roots(kernel);
        plan.need(kernel);
        plan.hoist(kernel);
        plan.splat(kernel);
        plan
    }

    /// True if an operation must be done.
    pub(crate) fn is_needed(&self, op: &Op, first: Value) -> bool {
        op.has_effect()
            || op
                .results()
                .iter()
                .zip(first.0..)
                .any(|(_, at)| self.is_needed[at as usize])
    }

    /// True if something needs the value.
    pub(crate) fn is_value_needed(&self, value: Value) -> bool {
        self.is_needed[value.index()]
    }

    /// True if the value is computed once a run.
    pub(crate) fn is_hoisted(&self, value: Value) -> bool {
        self.is_hoisted[value.index()]
    }

    /// True if all lanes have the same value, whether they run or not.
    pub(crate) fn is_splat(&self, value: Value) -> bool {
        self.is_splat[value.index()]
    }

    /// True if derivatives with this mask need not be set to 0: the lanes of other quads never run.
    pub(crate) fn has_whole_quads(&self, mask: Value) -> bool {
        self.has_whole_quads[mask.index()]
    }

    /// True if something is stored to an array; else it is a table of constants.
    pub(crate) fn is_array_stored(&self, array: u32) -> bool {
        let is_stored = self.is_array_stored.get(array as usize);
        is_stored.is_none_or(|&is_stored| is_stored)
    }

    /// True if the operation may be one call together with others: it reads a texture which nothing
    /// changes while the kernel runs.
    pub(crate) fn can_join(&self, op: &Op) -> bool {
        let Op::Texture(op) = op else {
            return false;
        };
        op.sampler.is_some() || op.query == TextureQuery::Load && !self.stores_texels
    }

    /// True if the kernel may change a buffer.
    pub(crate) fn is_written(&self, buffer: u32) -> bool {
        let is_written = self.is_written.get(buffer as usize);
        is_written.is_none_or(|&is_written| is_written)
    }

    /// The word that a value always is.
    pub(crate) fn constant(&self, value: Value) -> Option<u32> {
        self.constants[value.index()]
    }

    /// True if a value is a square root: normal, infinite, zero or not a number.
    pub(crate) fn is_root(&self, value: Value) -> bool {
        self.is_root[value.index()]
    }

    /// True if an operation of floats gave a value.
    pub(crate) fn is_float(&self, value: Value) -> bool {
        self.is_float[value.index()]
    }

    /// Parameters are roots whose arguments all are.
    fn roots(&mut self, kernel: &Kernel) {
        for block in &kernel.blocks {
            for &parameter in &block.parameters {
                self.is_root[parameter.index()] = true;
            }
            for (op, value) in &block.ops {
                if gives_float(op) {
                    self.is_float[value.index()] = true;
                }
                if matches!(op, Op::Unary(Unary::FSqrt, _)) {
                    self.is_root[value.index()] = true;
                }
            }
        }
        let mut changes = true;
        while std::mem::take(&mut changes) {
            let blocks = kernel.blocks.iter().zip(&self.is_reached);
            let reached = blocks.filter(|(_, is_reached)| **is_reached);
            for jump in reached.flat_map(|(block, _)| block.terminator.jumps()) {
                let parameters = &kernel.blocks[jump.to.index()].parameters;
                for (parameter, argument) in parameters.iter().zip(&jump.arguments) {
                    if !self.is_root[argument.index()] {
                        changes |= std::mem::take(&mut self.is_root[parameter.index()]);
                    }
                }
            }
        }
    }

    fn reach(&mut self, kernel: &Kernel) {
        let mut open = vec![0];
        while let Some(at) = open.pop() {
            if std::mem::replace(&mut self.is_reached[at], true) {
                continue;
            }
            for jump in kernel.blocks[at].terminator.jumps() {
                self.predecessors[jump.to.index()] += 1;
                open.push(jump.to.index());
            }
        }
    }

    fn need(&mut self, kernel: &Kernel) {
        // Where each value comes from: an operation, or a parameter of a block.
        let mut ops: Vec<Option<&Op>> = vec![None; kernel.values.len()];
        let mut parameters: Vec<Option<(usize, usize)>> = vec![None; kernel.values.len()];
        let mut jumps: Vec<Vec<&[Value]>> = vec![Vec::new(); kernel.blocks.len()];
        let mut open: Vec<Value> = Vec::new();
        for (at, block) in kernel.blocks.iter().enumerate() {
            if !self.is_reached[at] {
                continue;
            }
            for (position, value) in block.parameters.iter().enumerate() {
                parameters[value.index()] = Some((at, position));
            }
            for (op, first) in &block.ops {
                for value in first.and_next(op.results().len()) {
                    ops[value.index()] = Some(op);
                }
                if op.has_effect() {
                    op.each_operand(|value, _| open.push(value));
                }
            }
            match &block.terminator {
                Terminator::Return(values) => open.extend(values),
                Terminator::Branch { mask, .. } => open.push(*mask),
                Terminator::Jump(_) => {}
            }
            for jump in block.terminator.jumps() {
                jumps[jump.to.index()].push(&jump.arguments);
            }
        }
        while let Some(value) = open.pop() {
            if std::mem::replace(&mut self.is_needed[value.index()], true) {
                continue;
            }
            if let Some(op) = ops[value.index()] {
                op.each_operand(|value, _| open.push(value));
            }
            if let Some((block, position)) = parameters[value.index()] {
                open.extend(jumps[block].iter().map(|arguments| arguments[position]));
            }
        }
    }

    fn hoist(&mut self, kernel: &Kernel) {
        let interface = &kernel.interface;
        let mut covers = vec![false; kernel.values.len()];
        // In the order of blocks every operand comes before, except parameters, which stay.
        for block in &kernel.blocks {
            for (op, first) in &block.ops {
                if let Op::StoreLocal { array, .. } = op
                    && let Some(is_stored) = self.is_array_stored.get_mut(*array as usize)
                {
                    *is_stored = true;
                }
                let mut is_hoisted = op.is_pure(|buffer| self.is_written(buffer));
                if let Op::Input(at) | Op::InputMask(at) = op {
                    let input = interface.inputs.get(*at as usize);
                    is_hoisted = input.is_some_and(|input| input.is_uniform());
                    // Quads without a lane that has effects never run.
                    covers[first.index()] = input == Some(&Input::Cover);
                }
                op.each_operand(|value, _| is_hoisted &= self.is_hoisted[value.index()]);
                for value in first.and_next(op.results().len()) {
                    self.is_hoisted[value.index()] = is_hoisted;
                }
                if op.results().len() == 1 {
                    self.constants[first.index()] = match op {
                        Op::Constant(word) => Some(*word),
                        _ => None,
                    };
                    self.has_whole_quads[first.index()] = match op {
                        Op::MaskConstant(mask) => *mask,
                        Op::QuadAny(of) => covers[of.index()],
                        _ => false,
                    };
                }
            }
        }
    }

    /// Everything is the same in all lanes at first; what is not spreads from operands to results,
    /// and from arguments to parameters.
    fn splat(&mut self, kernel: &Kernel) {
        let mut next: Vec<Vec<Value>> = vec![Vec::new(); kernel.values.len()];
        let mut open = Vec::new();
        for (at, block) in kernel.blocks.iter().enumerate() {
            for (op, first) in &block.ops {
                let is_splat = match op {
                    Op::Input(_) | Op::InputMask(_) => self.is_hoisted[first.index()],
                    Op::Any(_) => continue,
                    Op::LoadBuffer { .. } | Op::LoadWorkgroup(_) => true,
                    _ => op.is_pure(|_| true),
                };
                for result in first.and_next(op.results().len()) {
                    if is_splat {
                        op.each_operand(|operand, _| next[operand.index()].push(result));
                    } else {
                        open.push(result);
                    }
                }
            }
            for jump in block.terminator.jumps() {
                let parameters = &kernel.blocks[jump.to.index()].parameters;
                if self.is_reached[at] {
                    for (&parameter, argument) in parameters.iter().zip(&jump.arguments) {
                        next[argument.index()].push(parameter);
                    }
                }
            }
        }
        while let Some(value) = open.pop() {
            if std::mem::replace(&mut self.is_splat[value.index()], false) {
                open.append(&mut next[value.index()]);
            }
        }
    }
}

/// True if the units for floats compute an operation.
fn gives_float(op: &Op) -> bool {
    match op {
        Op::Fma(_) => true,
        Op::Unary(kind, _) => matches!(
            kind,
            Unary::FNeg
                | Unary::FAbs
                | Unary::FSqrt
                | Unary::FRound
                | Unary::FFloor
                | Unary::FCeil
                | Unary::FTrunc
        ),
        Op::Binary(kind, _) => matches!(
            kind,
            Binary::FAdd | Binary::FSub | Binary::FMul | Binary::FDiv | Binary::FMin | Binary::FMax
        ),
        _ => false,
    }
}

/// True if an operation of the kernel stores to a texture, which may be bound as another, too.
fn stores_texels(kernel: &Kernel) -> bool {
    let mut ops = kernel.blocks.iter().flat_map(|block| &block.ops);
    ops.any(|(op, _)| matches!(op, Op::Texture(op) if op.query == TextureQuery::Store))
}

/// For each buffer, whether the kernel may change it. Where it changes one, another one may be the
/// same memory.
fn written_buffers(kernel: &Kernel) -> Vec<bool> {
    let mut ops = kernel.blocks.iter().flat_map(|block| &block.ops);
    let writes = ops.any(|(op, _)| match op {
        Op::StoreBuffer { .. } => true,
        Op::Atomic { memory, .. } | Op::CompareExchange { memory, .. } => {
            matches!(memory, Memory::Buffer(_))
        }
        _ => false,
    });
    let buffers = kernel.interface.buffers.iter();
    buffers.map(|buffer| writes && buffer.is_written).collect()
}

#[cfg(test)]
mod tests {
    use super::Plan;
    use estampe_ir::interface::{BufferSlot, Input, Output, Stage};
    use estampe_ir::lanes::Kernel;
    use estampe_ir::tree::Builder;
    use estampe_ir::{Op, Value};

    /// A kernel that loads a word of a buffer that is declared as written, and stores another one
    /// or not; the plan, and the word.
    fn planned(stores: bool) -> (Plan, Value) {
        let mut b = Builder::new(Stage::Compute);
        b.interface_mut().buffers.push(BufferSlot {
            group: 0,
            binding: 0,
            is_written: true,
        });
        let offset = b.word(8);
        let loaded = b.op(Op::LoadBuffer { buffer: 0, offset })[0];
        if stores {
            let (value, mask) = (b.word(1), b.input(Input::Cover));
            b.op(Op::StoreBuffer {
                buffer: 0,
                offset,
                value,
                mask,
            });
        }
        let kernel = Kernel::from_tree(&b.finish(vec![(Output::Varying(0), loaded)]));
        let mut ops = kernel.blocks.iter().flat_map(|block| &block.ops);
        let found = ops.find(|(op, _)| matches!(op, Op::LoadBuffer { .. }));
        let loaded = found.map_or(Value(0), |(_, value)| *value);
        (Plan::new(&kernel), loaded)
    }

    #[test]
    fn words_of_buffers_that_no_kernel_stores_to_are_loaded_once() {
        for stores in [false, true] {
            let (plan, loaded) = planned(stores);
            assert_eq!(plan.is_written(0), stores);
            assert_eq!(plan.is_hoisted(loaded), !stores);
        }
    }
}
