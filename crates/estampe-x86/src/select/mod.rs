//! Instruction selection: from a kernel to machine instructions with virtual registers.
//!
//! A pass runs sixteen lanes, or 32. A value is in one register, or in two or four, its *halves*:
//!
//! | instruction set | kernel | lanes of a pass | registers of a value |
//! |---|---|---|---|
//! | AVX2 | all | 16: a packet | 2 |
//! | AVX2, optimised | with long chains in loops: a second function | 32: two packets | 4 |
//! | AVX-512 | all | 16: a packet | 1 |
//! | AVX-512, optimised | most: a second function | 32: two packets | 2 |
//!
//! Most shaders are one long chain of operations, each of which waits for the one before: the
//! halves, which are independent, fill the time. Lit fragments, ns each, with one register and with
//! two: AVX2 13.1 and 9.7, AVX-512 8.8 and 7.05, though they spill more; traced rays, which loop,
//! at 720p with AVX-512: 122 ms and 87. AVX2 has too few registers for that: there two packets take
//! turns ([`stages`]), and only in kernels with a long loop, whose iteration is mostly a chain, and
//! without textures. WGSL's `heavy_fs` takes 0.89 of its time on Zen 3 so, but a loop of few
//! operations, which one packet runs without memory, 1.3 times as long. Branches are taken if a
//! lane of either packet asks for it.
//! Where far more values live in a loop than AVX2 has registers, the two of one packet take turns.
//! Calls serve one packet after the other. Kernels with several effects on memory, or arrays, or
//! barriers, run single packets; so does the last packet of an odd number.
//!
//! | module | selects |
//! |---|---|
//! | [`expand`] | nothing: replaces functions by operations |
//! | [`small_angles`] | nothing: splits blocks of loops by whether the angles of sines are small |
//! | [`plan`] | nothing: finds what is needed, uniform or hoisted |
//! | [`quadruples`] | loads of the components of vectors |
//! | [`uniform_loads`] | loads at places that are the same in all lanes |
//! | [`exact_products`] | nothing: fuses sums of exact products |
//! | [`overlap`] | nothing: pipelines loops |
//! | [`strides`] | nothing: finds what grows by the same number from lane to lane |
//! | [`schedule`] | nothing: orders the operations of a block |
//! | [`stages`] | runs of operations of one packet of a pass after the other |
//! | [`functions`] | blocks, edges, jumps and branches |
//! | [`operands`] | loads of values that are in memory; the instructions' forms |
//! | [`words`] | operations on words |
//! | [`halves`] | conversions of binary16 |
//! | [`lane_loops`] | stores and atomic operations |
//! | [`masks`] | comparisons and operations on masks |
//! | [`division`], [`pair_division`] | integer division, with AVX2 by pairs of words |
//! | [`known_divisors`] | divisions by constants, as products |
//! | [`bits`] | counts of bits, and their order |
//! | [`inverse_root`] | reciprocals of square roots |
//! | [`memory`] | inputs, outputs and buffers |
//! | [`locals`] | arrays of the lanes |
//! | [`calls`] | calls of what code does not do itself |

mod bits;
pub(crate) mod calls;
mod division;
pub(crate) mod exact_products;
pub(crate) mod expand;
mod functions;
mod halves;
mod inverse_root;
pub(crate) mod known_divisors;
mod lane_loops;
mod locals;
mod masks;
mod memory;
mod operands;
mod overlap;
mod pair_division;
mod plan;
mod quadruples;
mod schedule;
pub(crate) mod small_angles;
mod stages;
mod strides;
mod uniform_loads;
mod words;

use crate::encoder::Assembler;
use crate::frame::Frame;
use crate::machine::{Function, Instruction, MASK, VECTOR};
use crate::{CompileError, Isa, Tier};
use calls::Served;
use estampe_ir::lanes::{self, Kernel};
use estampe_ir::op::TextureQuery;
use estampe_ir::{Op, Type, Value};
use overlap::overlap;
use plan::Plan;
use quadruples::Group;
use regalloc2::{RegClass, VReg};
use std::collections::HashMap;
use std::ops::Range;
use strides::Strides;
use uniform_loads::UniformGroups;

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
    pub(crate) table_inputs: Vec<(u32, u32)>,
    /// For each buffer the words that instructions read at fixed places.
    pub(crate) fixed_words: Vec<u32>,
}

/// The most registers of a value.
const MOST_HALVES: usize = 4;

/// Where a value is.
#[derive(Debug, Clone, Copy)]
enum Place {
    /// Not computed yet.
    Nowhere,
    Registers([VReg; MOST_HALVES]),
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
    /// Blocks whose operations have their order already.
    in_order: Vec<usize>,
    strides: Strides,
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
    /// The loads of this block that are done together, by their results; `None` once they are done.
    groups: HashMap<Value, Option<Group>>,
    uniform: UniformGroups,
    /// What is added, by its sum.
    sums: HashMap<Value, [Value; 2]>,
    /// How often each value is used.
    use_counts: Vec<u32>,
    /// The constants of the operation that is selected, where all halves take them from registers.
    shared_constants: Option<Vec<(u32, VReg)>>,
}

/// Selects instructions for a kernel.
pub(crate) fn select(
    kernel: &Kernel,
    (isa, tier): (Isa, Tier),
    assembler: &mut Assembler,
) -> Result<Selected, CompileError> {
    let plan = Plan::new(kernel);
    let is_worth_it = match isa {
        Isa::Avx2 => stages::has_long_loop(kernel, &plan),
        Isa::Avx512 => true,
    };
    let may_pair = tier == Tier::Optimised && is_worth_it;
    let has_pair = may_pair && !kernel.runs_workgroups() && can_pair(kernel, &plan);
    let packets_of_pass = if has_pair { 2 } else { 1 };
    // Two packets of a pass overlap as they are.
    let may_overlap = (isa, tier) == (Isa::Avx512, Tier::Optimised) && !has_pair;
    let overlapped = may_overlap.then(|| overlap(kernel, &plan)).flatten();
    let (kernel, plan, in_order) = match &overlapped {
        Some(overlapped) => {
            debug_assert_eq!(lanes::verify(&overlapped.kernel), Ok(()));
            let kernel = &overlapped.kernel;
            (kernel, Plan::new(kernel), overlapped.bodies.clone())
        }
        None => (kernel, plan, Vec::new()),
    };
    let (places, table_inputs, slots) = hoisted_places(kernel, &plan);
    let slot_bytes = match isa {
        Isa::Avx2 => 32,
        Isa::Avx512 => 4,
    };
    let packets = calls::most_packets(kernel, &plan, packets_of_pass);
    let is_stored = |array: u32| plan.is_array_stored(array);
    let frame = Frame::new(
        kernel,
        is_stored,
        (slots, slot_bytes),
        (packets, packets_of_pass),
    )
    .ok_or(CompileError::TooLarge)?;
    let strides = Strides::new(kernel, &plan);
    let mut selector = Selector {
        kernel,
        plan,
        in_order,
        strides,
        isa,
        halves: 1,
        assembler,
        frame,
        function: Function::new(isa),
        places,
        served: Vec::new(),
        fixed_words: vec![0; kernel.interface.buffers.len()],
        // The memory of a work-group comes after the buffers.
        buffer_pointers: vec![None; kernel.interface.buffers.len() + 1],
        tables: vec![None; kernel.interface.locals.len()],
        groups: HashMap::new(),
        uniform: UniformGroups::default(),
        sums: HashMap::new(),
        use_counts: vec![0; kernel.values.len()],
        shared_constants: None,
    };
    selector.count_uses();
    let prepare = selector.prepare()?;
    selector.halves = isa.registers_of_packet();
    let packet = selector.packet(tier)?;
    let pair = if has_pair {
        selector.halves *= 2;
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

/// Operations up to which there is a function that runs two packets.
const MAX_PAIRED: usize = 2048;

/// True if two packets can run together: what is uniform in a packet is so in all packets of a run,
/// so that they take uniform branches together, and what they do to memory has the order that it
/// has if one ends before the other begins.
fn can_pair(kernel: &Kernel, plan: &Plan) -> bool {
    let (mut ops, mut effects, mut stored, mut loaded) = (0, 0, None, Vec::new());
    for (at, block) in kernel.blocks.iter().enumerate() {
        for (op, first) in block.ops.iter().filter(|_| plan.is_reached[at]) {
            ops += 1;
            let is_ordered = match op {
                // A lane of the other packet may be set.
                Op::Any(_) => true,
                // Arrays are those of one packet.
                Op::StoreLocal { .. } => true,
                Op::LoadLocal { array, .. } => plan.is_array_stored(*array),
                Op::LoadBuffer { buffer, .. } => plan.is_written(*buffer),
                _ => op.has_effect() && is_in_loop(kernel, at),
            };
            if is_ordered {
                return false;
            }
            effects += usize::from(op.has_effect());
            if let Op::Texture(op) = op {
                let count = op.query.results() as usize;
                let mut results = first.and_next(count).into_iter();
                // The packet whose lanes do not run has other words.
                if results.any(|value| kernel.values[value.index()].is_uniform)
                    && !plan.is_hoisted(*first)
                {
                    return false;
                }
                match op.query {
                    TextureQuery::Store => stored = Some(op.texture),
                    TextureQuery::Load => loaded.push(op.texture),
                    _ => {}
                }
            }
        }
    }
    let is_loaded = stored.is_some_and(|stored| loaded.contains(&stored));
    ops <= MAX_PAIRED && effects <= 1 && !is_loaded
}

/// True if a block can be reached from itself: a jump back goes around it.
fn is_in_loop(kernel: &Kernel, at: usize) -> bool {
    let later = kernel.blocks.iter().skip(at);
    let mut jumps = later.flat_map(|block| block.terminator.jumps());
    jumps.any(|jump| jump.to.index() <= at)
}

/// Places of hoisted values, the inputs among them, and the number of slots.
fn hoisted_places(kernel: &Kernel, plan: &Plan) -> (Vec<Place>, Vec<(u32, u32)>, u32) {
    let mut places = vec![Place::Nowhere; kernel.values.len()];
    let mut inputs = Vec::new();
    let mut slots = 0;
    for (op, first) in kernel.blocks.iter().flat_map(|block| &block.ops) {
        let results = op.results().len();
        if !plan.is_needed(op, *first) || results == 0 || !plan.is_hoisted(*first) {
            continue;
        }
        let place = match op {
            Op::Constant(word) => Some(Place::Constant(*word)),
            Op::MaskConstant(mask) => Some(Place::MaskConstant(*mask)),
            Op::BufferBytes(buffer) => Some(Place::Buffer {
                buffer: *buffer,
                offset: u32::MAX,
            }),
            Op::LoadBuffer { buffer, offset } if is_fixed(plan, *offset) => Some(Place::Buffer {
                buffer: *buffer,
                offset: plan.constant(*offset).unwrap_or(0) & !3,
            }),
            _ => None,
        };
        for value in first.and_next(results) {
            places[value.index()] = place.unwrap_or_else(|| {
                slots += 1;
                Place::Table(slots - 1)
            });
        }
        if let Op::Input(at) | Op::InputMask(at) = op {
            inputs.push((*at, slots - 1));
        }
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

    /// The registers that a value takes: one for each half, or one for all if its lanes are all
    /// the same. Two packets of a pass take each branch together, so that what is the same in all
    /// lanes of one is so in both.
    fn register_count(&self, value: Value) -> usize {
        if self.plan.is_splat(value) {
            1
        } else {
            self.halves
        }
    }

    fn new_registers(&mut self, value: Value) -> [VReg; MOST_HALVES] {
        let class = self.class_of(value);
        let mut registers = [self.function.register(class); MOST_HALVES];
        for other in &mut registers[1..self.register_count(value)] {
            *other = self.function.register(class);
        }
        self.places[value.index()] = Place::Registers(registers);
        registers
    }

    /// Says in which register a half of a value is.
    fn define(&mut self, value: Value, half: usize, register: VReg) {
        let mut registers = match self.places[value.index()] {
            Place::Registers(registers) if half > 0 => registers,
            _ => [VReg::invalid(); MOST_HALVES],
        };
        registers[half] = register;
        self.places[value.index()] = Place::Registers(registers);
    }

    /// The halves of each packet of a pass.
    fn packets_of_pass(&self) -> Vec<Range<usize>> {
        let of_packet = self.halves.min(self.isa.registers_of_packet());
        let firsts = (0..self.halves).step_by(of_packet);
        firsts.map(|first| first..first + of_packet).collect()
    }

    fn operation(&mut self, op: &Op, first: Value) -> Result<(), CompileError> {
        if self.effect_on_memory(op, first) {
            return Ok(());
        }
        if let Op::StoreLocal {
            array,
            index,
            value,
            mask,
        } = *op
        {
            self.store_local(array, [index, value, mask]);
            return Ok(());
        }
        if matches!(op, Op::LoadBuffer { .. } | Op::LoadWorkgroup(_))
            && (self.group(first) || self.uniform_group(first))
        {
            return Ok(());
        }
        if self.uniform.dropped.contains(&first) {
            return Ok(());
        }
        if matches!(op, Op::Barrier) {
            self.function.push(Instruction::Barrier, &[]);
            self.buffer_pointers.fill(None);
            return Ok(());
        }
        for half in 0..self.halves {
            let Some(register) = self.half_of(op, half) else {
                return self.call(op, first);
            };
            self.define(first, half, register);
            if self.plan.is_splat(first) {
                for other in 1..self.halves {
                    self.define(first, other, register);
                }
                break;
            }
        }
        Ok(())
    }

    /// A half of an operation's result; `None` if a call does it.
    fn half_of(&mut self, op: &Op, half: usize) -> Option<VReg> {
        match op {
            Op::Unary(kind, a) => Some(self.unary(*kind, *a, half)),
            Op::Binary(kind, pair) => Some(self.binary(*kind, *pair, half)),
            Op::Fma(three) => Some(self.fma(*three, half)),
            Op::Select { mask, yes, no } => Some(self.select(*mask, [*yes, *no], half)),
            Op::Derivative {
                axis,
                precision,
                value,
                mask,
            } => Some(self.derivative((*axis, *precision), (*value, *mask), half)),
            Op::QuadLane { lane, value, mask } => {
                Some(self.quad_lane(*lane, (*value, *mask), half))
            }
            Op::Compare(kind, pair) => Some(self.compare(*kind, *pair, half)),
            Op::MaskNot(a) => Some(self.mask_not(*a, half)),
            Op::MaskBinary(kind, pair) => Some(self.mask_binary(*kind, *pair, half)),
            Op::QuadAny(a) => {
                let mask = self.mask(*a, half);
                Some(self.quads(mask, false))
            }
            Op::Any(a) => Some(self.any(*a)),
            Op::Input(at) | Op::InputMask(at) => Some(self.input(*at, half)),
            Op::LoadLocal { array, index } => Some(self.load_local(*array, *index, half)),
            Op::LoadBuffer { buffer, offset } => Some(self.load_buffer(*buffer, *offset, half)),
            Op::LoadWorkgroup(index) => Some(self.load_workgroup(*index, half)),
            _ => None,
        }
    }
}
