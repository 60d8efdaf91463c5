//! Instruction selection: from a kernel to machine instructions with virtual registers.
//!
//! A pass runs sixteen lanes, or 32. A value is in one register, or in two, its *halves*:
//!
//! | instruction set | kernel | lanes of a pass | registers of a value |
//! |---|---|---|---|
//! | AVX2 | all | 16: a packet | 2 |
//! | AVX-512 | all | 16: a packet | 1 |
//! | AVX-512, optimised | straight, without calls: a second function | 32: two packets | 2 |
//!
//! Most shaders are one long chain of operations, each of which waits for the one before: the
//! halves, which are independent, fill the time. Lit fragments, ns each, with one register and with
//! two: AVX2 13.1 and 9.7, AVX-512 8.8 and 7.05, though they spill more. Kernels with branches,
//! which would be taken for both packets, and with effects, which must happen in the order of
//! sixteen lanes, run single packets; so does the last packet of an odd number.
//!
//! | module | selects |
//! |---|---|
//! | [`expand`] | nothing: replaces functions by operations |
//! | [`plan`] | nothing: finds what is needed, uniform or hoisted |
//! | [`schedule`] | nothing: orders the operations of a block |
//! | [`operands`] | loads of values that are in memory; the instructions' forms |
//! | [`words`] | operations on words |
//! | [`masks`] | comparisons and operations on masks |
//! | [`memory`] | inputs, outputs, buffers and arrays |
//! | [`calls`] | calls of what code does not do itself |

pub(crate) mod calls;
pub(crate) mod expand;
mod masks;
mod memory;
mod operands;
mod plan;
mod schedule;
mod words;

use crate::encoder::Assembler;
use crate::frame::Frame;
use crate::machine::{Function, Instruction, MASK, VECTOR};
use crate::{CompileError, Isa, Tier};
use calls::Served;
use estampe_ir::lanes::{BlockId, Jump, Kernel, Terminator};
use estampe_ir::op::Memory as Shared;
use estampe_ir::{Op, Type, Value};
use plan::Plan;
use regalloc2::{Block, Operand, RegClass, VReg};
use schedule::Scheduler;

/// What selection makes of a kernel.
#[derive(Debug)]
pub(crate) struct Selected {
    /// Computes hoisted values, once a run.
    pub(crate) prepare: Option<Function>,
    /// Runs a packet.
    pub(crate) packet: Function,
    /// Runs two packets.
    pub(crate) pair: Option<Function>,
    pub(crate) frame: Frame,
    /// What calls ask for.
    pub(crate) served: Vec<Served>,
    /// The inputs that are words of the table, with their slots.
    pub(crate) table_inputs: Vec<(usize, u32)>,
    /// For each buffer the words that instructions read at fixed places.
    pub(crate) fixed_words: Vec<u32>,
}

/// Where a value is.
#[derive(Debug, Clone, Copy)]
enum Place {
    /// Not computed yet.
    Nowhere,
    Registers([VReg; 2]),
    /// A value of the table.
    Table(u32),
    Constant(u32),
    MaskConstant(bool),
    /// A word of a buffer that does not change.
    Buffer {
        buffer: u32,
        offset: u32,
    },
    /// A word of the frame.
    Frame(u32),
}

/// Offsets in buffers up to this many bytes are operands of instructions.
const MAX_FIXED_OFFSET: u32 = 1 << 16;

struct Selector<'a> {
    kernel: &'a Kernel,
    plan: Plan,
    isa: Isa,
    /// The registers of a value.
    halves: usize,
    assembler: &'a mut Assembler,
    frame: Frame,
    function: Function,
    places: Vec<Place>,
    served: Vec<Served>,
    fixed_words: Vec<u32>,
    /// The address of each buffer in this block, once loaded.
    buffer_pointers: Vec<Option<VReg>>,
    /// The place in the pool of each array that is a table, once it is there.
    tables: Vec<Option<u32>>,
}

/// Selects instructions for a kernel.
pub(crate) fn select(
    kernel: &Kernel,
    (isa, tier): (Isa, Tier),
    assembler: &mut Assembler,
) -> Result<Selected, CompileError> {
    let plan = Plan::new(kernel);
    check(kernel, &plan)?;
    let may_pair = (isa, tier) == (Isa::Avx512, Tier::Optimised);
    let has_pair = may_pair && is_straight(kernel, &plan);
    let packets_of_pass = if has_pair { 2 } else { 1 };
    let (places, table_inputs, slots) = hoisted_places(kernel, &plan);
    let slot_bytes = match isa {
        Isa::Avx2 => 32,
        Isa::Avx512 => 4,
    };
    let packets = calls::most_packets(kernel);
    let is_stored = |array: u32| plan.is_array_stored(array);
    let frame = Frame::new(
        &kernel.interface,
        is_stored,
        (slots, slot_bytes),
        (packets, packets_of_pass),
    )
    .ok_or(CompileError::TooLarge)?;
    let mut selector = Selector {
        kernel,
        plan,
        isa,
        halves: 1,
        assembler,
        frame,
        function: Function::new(isa),
        places,
        served: Vec::new(),
        fixed_words: vec![0; kernel.interface.buffers.len()],
        buffer_pointers: vec![None; kernel.interface.buffers.len()],
        tables: vec![None; kernel.interface.locals.len()],
    };
    let prepare = selector.prepare()?;
    selector.halves = estampe_simd::LANES / isa.lanes();
    let packet = selector.packet(tier)?;
    let pair = if has_pair {
        selector.halves = 2;
        Some(selector.packet(tier)?)
    } else {
        None
    };
    Ok(Selected {
        prepare,
        packet,
        pair,
        frame: selector.frame,
        served: selector.served,
        table_inputs,
        fixed_words: selector.fixed_words,
    })
}

/// Refuses kernels with operations that are not selected.
fn check(kernel: &Kernel, plan: &Plan) -> Result<(), CompileError> {
    for (at, block) in kernel.blocks.iter().enumerate() {
        for (op, _) in block.ops.iter().filter(|_| plan.is_reached[at]) {
            let workgroup = Shared::Workgroup;
            match op {
                Op::Barrier | Op::LoadWorkgroup(_) | Op::StoreWorkgroup { .. } => {
                    return Err(CompileError::Workgroup);
                }
                Op::Atomic { memory, .. } | Op::CompareExchange { memory, .. }
                    if *memory == workgroup =>
                {
                    return Err(CompileError::Workgroup);
                }
                _ => {}
            }
        }
    }
    Ok(())
}

/// Operations up to which there is a function that runs two packets.
const MAX_PAIRED: usize = 2048;

/// True if the kernel has one block, and operations of which none is a call or has an effect.
fn is_straight(kernel: &Kernel, plan: &Plan) -> bool {
    let reached = plan.is_reached.iter().filter(|is_reached| **is_reached);
    let Some(block) = kernel.blocks.first().filter(|_| reached.count() == 1) else {
        return false;
    };
    let is_free = |(op, first): &(Op, Value)| {
        let is_call = Served::is_call(op) || matches!(op, Op::Any(_));
        let is_hoisted = op.results().len() == 1 && plan.is_hoisted(*first);
        !op.has_effect() && (!is_call || is_hoisted || !plan.is_needed(op, *first))
    };
    block.ops.len() <= MAX_PAIRED && block.ops.iter().all(is_free)
}

/// Places of hoisted values, the inputs among them, and the number of slots.
fn hoisted_places(kernel: &Kernel, plan: &Plan) -> (Vec<Place>, Vec<(usize, u32)>, u32) {
    let mut places = vec![Place::Nowhere; kernel.values.len()];
    let mut inputs = Vec::new();
    let mut slots = 0;
    for (op, first) in kernel.blocks.iter().flat_map(|block| &block.ops) {
        if !plan.is_needed(op, *first) || op.results().len() != 1 || !plan.is_hoisted(*first) {
            continue;
        }
        let place = match op {
            Op::Constant(word) => Place::Constant(*word),
            Op::MaskConstant(mask) => Place::MaskConstant(*mask),
            Op::BufferBytes(buffer) => Place::Buffer {
                buffer: *buffer,
                offset: u32::MAX,
            },
            Op::LoadBuffer { buffer, offset } if is_fixed(plan, *offset) => Place::Buffer {
                buffer: *buffer,
                offset: plan.constant(*offset).unwrap_or(0) & !3,
            },
            _ => {
                slots += 1;
                if let Op::Input(at) | Op::InputMask(at) = op {
                    inputs.push((*at as usize, slots - 1));
                }
                Place::Table(slots - 1)
            }
        };
        places[first.index()] = place;
    }
    (places, inputs, slots)
}

fn is_fixed(plan: &Plan, offset: Value) -> bool {
    plan.constant(offset)
        .is_some_and(|offset| offset < MAX_FIXED_OFFSET)
}

impl Selector<'_> {
    /// The class of registers in which masks are.
    fn mask_class(&self) -> RegClass {
        match self.isa {
            Isa::Avx2 => VECTOR,
            Isa::Avx512 => MASK,
        }
    }

    fn class_of(&self, value: Value) -> RegClass {
        match self.kernel.values[value.index()].kind {
            Type::Word => VECTOR,
            Type::Mask => self.mask_class(),
        }
    }

    /// The function that computes hoisted values; `None` if there are none.
    fn prepare(&mut self) -> Result<Option<Function>, CompileError> {
        // Places that are known without the frame's layout stood before it.
        for place in &mut self.places {
            if let Place::Buffer { buffer, offset } = *place {
                if offset == u32::MAX {
                    let at = self.frame.buffer(buffer) + crate::frame::BUFFER_BYTES;
                    *place = Place::Frame(at);
                } else if let Some(words) = self.fixed_words.get_mut(buffer as usize) {
                    *words = (*words).max(offset / 4 + 1);
                }
            }
        }
        let block = self.function.new_block();
        self.function.start_block();
        let mut is_empty = true;
        let kernel = self.kernel;
        for (at, of_kernel) in kernel.blocks.iter().enumerate() {
            if !self.plan.is_reached[at] {
                continue;
            }
            for (op, first) in &of_kernel.ops {
                // Operations without results name no value.
                if op.results().len() != 1 {
                    continue;
                }
                let Place::Table(slot) = self.places[first.index()] else {
                    continue;
                };
                if matches!(op, Op::Input(_) | Op::InputMask(_)) {
                    continue;
                }
                is_empty = false;
                self.operation(op, *first)?;
                self.keep(*first, slot);
            }
        }
        self.function.push(Instruction::Return, &[]);
        self.function.end_block(block, &[]);
        self.buffer_pointers.fill(None);
        let function = std::mem::replace(&mut self.function, Function::new(self.isa));
        Ok((!is_empty).then_some(function))
    }

    /// The function that runs a pass: a packet, or two where the halves are more than one's.
    fn packet(&mut self, tier: Tier) -> Result<Function, CompileError> {
        let kernel = self.kernel;
        let order = self.blocks_and_edges();
        let schedules = self.schedules(tier);
        let mut entries: Vec<Option<Block>> = vec![None; kernel.blocks.len()];
        for (position, part) in order.iter().enumerate() {
            let made = self.function.new_block();
            debug_assert_eq!(made.index(), position);
            if let Part::Block(at) = part {
                entries[*at] = Some(made);
                for &parameter in &kernel.blocks[*at].parameters {
                    if !self.plan.is_value_needed(parameter) {
                        continue;
                    }
                    let registers = self.new_registers(parameter);
                    let of_block = &mut self.function.blocks[position].parameters;
                    of_block.extend(&registers[..self.halves]);
                }
            }
        }
        let entry = |to: BlockId| entries[to.index()].ok_or(CompileError::TooLarge);
        for (position, part) in order.iter().enumerate() {
            let block = Block::new(position);
            self.function.start_block();
            self.buffer_pointers.fill(None);
            match *part {
                Part::Block(at) => {
                    let of_kernel = &kernel.blocks[at];
                    for &index in &schedules[at] {
                        let (op, first) = &of_kernel.ops[index];
                        self.operation(op, *first)?;
                    }
                    match &of_kernel.terminator {
                        Terminator::Jump(jump) => {
                            self.jump(block, at, jump, entry(jump.to)?);
                        }
                        Terminator::Branch { mask, any, none } => {
                            self.test(*mask);
                            // The edges of this block follow it, in this order.
                            let mut edge = position + 1;
                            let mut successor = |jump: &Jump, is_any: bool| {
                                if order.get(edge) == Some(&Part::Edge { from: at, is_any }) {
                                    edge += 1;
                                    Ok(Block::new(edge - 1))
                                } else {
                                    entry(jump.to)
                                }
                            };
                            let successors = [successor(any, true)?, successor(none, false)?];
                            self.function.end_block(block, &successors);
                        }
                        Terminator::Return(values) => {
                            self.outputs(values);
                            self.function.push(Instruction::Return, &[]);
                            self.function.end_block(block, &[]);
                        }
                    }
                }
                Part::Edge { from, is_any } => {
                    if let Terminator::Branch { any, none, .. } = &kernel.blocks[from].terminator {
                        let jump = if is_any { any } else { none };
                        self.jump(block, from, jump, entry(jump.to)?);
                    }
                }
            }
        }
        Ok(std::mem::replace(
            &mut self.function,
            Function::new(self.isa),
        ))
    }

    /// The order of the operations of each block that is reached, without those that are hoisted
    /// and those that nothing needs.
    fn schedules(&self, tier: Tier) -> Vec<Vec<usize>> {
        let mut scheduler = Scheduler::new(self.kernel, &self.plan, self.isa, self.halves);
        let blocks = 0..self.kernel.blocks.len();
        let of_block = |at: usize| match tier {
            _ if !self.plan.is_reached[at] => Vec::new(),
            // Fewer registers need fewer spills, of which the fast allocator makes many.
            Tier::Fast if self.isa == Isa::Avx2 => scheduler.as_written(at),
            _ => scheduler.by_latency(at),
        };
        blocks.map(of_block).collect()
    }

    /// The kernel's blocks in order; after those with branches the edges that need a block.
    fn blocks_and_edges(&self) -> Vec<Part> {
        let mut order = Vec::new();
        for (at, block) in self.kernel.blocks.iter().enumerate() {
            if !self.plan.is_reached[at] {
                continue;
            }
            order.push(Part::Block(at));
            if let Terminator::Branch { any, none, .. } = &block.terminator {
                for (jump, is_any) in [(any, true), (none, false)] {
                    let has_others = self.plan.predecessors[jump.to.index()] > 1;
                    if has_others || !jump.arguments.is_empty() || jump.to.index() <= at {
                        order.push(Part::Edge { from: at, is_any });
                    }
                }
            }
        }
        order
    }

    /// Ends a block with a jump that gives arguments.
    fn jump(&mut self, block: Block, from: usize, jump: &Jump, to: Block) {
        let mut arguments = Vec::new();
        let parameters = &self.kernel.blocks[jump.to.index()].parameters;
        for (&parameter, &argument) in parameters.iter().zip(&jump.arguments) {
            if !self.plan.is_value_needed(parameter) {
                continue;
            }
            for half in 0..self.halves {
                arguments.push(self.any_register(argument, half));
            }
        }
        self.function.blocks[block.index()].arguments = arguments;
        let is_back = jump.to.index() <= from;
        self.function.push(Instruction::Jump { is_back }, &[]);
        self.function.end_block(block, &[to]);
    }

    /// Ends a block with a branch.
    fn test(&mut self, mask: Value) {
        let mut tested = self.mask(mask, 0);
        for half in 1..self.halves {
            let other = self.mask(mask, half);
            tested = self.mask_or(tested, other);
        }
        let mut operands = vec![Operand::reg_use(tested)];
        if self.isa == Isa::Avx2 {
            let temporary = self.function.register(crate::machine::GPR);
            operands.push(Operand::reg_temp(temporary));
        }
        self.function.push(Instruction::Branch, &operands);
    }

    fn new_registers(&mut self, value: Value) -> [VReg; 2] {
        let class = self.class_of(value);
        let mut registers = [VReg::invalid(); 2];
        for register in &mut registers[..self.halves] {
            *register = self.function.register(class);
        }
        self.places[value.index()] = Place::Registers(registers);
        registers
    }

    /// Says in which register a half of a value is.
    fn define(&mut self, value: Value, half: usize, register: VReg) {
        let mut registers = match self.places[value.index()] {
            Place::Registers(registers) if half > 0 => registers,
            _ => [VReg::invalid(); 2],
        };
        registers[half] = register;
        self.places[value.index()] = Place::Registers(registers);
    }

    fn operation(&mut self, op: &Op, first: Value) -> Result<(), CompileError> {
        if let (
            Isa::Avx512,
            Op::StoreBuffer {
                buffer,
                offset,
                value,
                mask,
            },
        ) = (self.isa, op)
        {
            self.store_buffer(*buffer, [*offset, *value], *mask);
            return Ok(());
        }
        for half in 0..self.halves {
            let register = match op {
                Op::Unary(kind, a) => self.unary(*kind, *a, half),
                Op::Binary(kind, pair) => self.binary(*kind, *pair, half),
                Op::Fma(three) => Some(self.fma(*three, half)),
                Op::Select { mask, yes, no } => Some(self.select(*mask, [*yes, *no], half)),
                Op::Derivative {
                    axis,
                    precision,
                    value,
                    mask,
                } => Some(self.derivative((*axis, *precision), (*value, *mask), half)),
                Op::Compare(kind, pair) => Some(self.compare(*kind, *pair, half)),
                Op::MaskNot(a) => Some(self.mask_not(*a, half)),
                Op::MaskBinary(kind, pair) => Some(self.mask_binary(*kind, *pair, half)),
                Op::QuadAny(a) => {
                    let mask = self.mask(*a, half);
                    Some(self.quads(mask, false))
                }
                Op::Any(a) if half == 0 => Some(self.any(*a)),
                Op::Any(_) => Some(self.any_register(first, 0)),
                Op::Input(at) | Op::InputMask(at) => Some(self.input(*at, half)),
                Op::LoadLocal { array, index } => Some(self.load_local(*array, *index, half)),
                Op::LoadBuffer { buffer, offset } => Some(self.load_buffer(*buffer, *offset, half)),
                _ => None,
            };
            let Some(register) = register else {
                return self.call(op, first);
            };
            self.define(first, half, register);
        }
        Ok(())
    }
}

/// A part of the layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    Block(usize),
    Edge { from: usize, is_any: bool },
}
