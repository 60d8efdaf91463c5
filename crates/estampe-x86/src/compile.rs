//! From a kernel to code: selection, allocation, encoding.

use crate::encoder::Assembler;
use crate::encoder::text::{Note, Text};
use crate::executable::Executable;
use crate::frame::{Frame, PACKET};
use crate::machine::passes::Passes;
use crate::machine::{Function, allocate, emit};
use crate::select::{self, Selected, calls::Served};
use crate::{CompileError, Isa, Tier, listing};
use estampe_ir::interface::{Input, Interface};
use estampe_ir::lanes::{self, BasicBlock, Kernel};
use estampe_ir::{Op, Type};
use std::sync::atomic::{AtomicU64, Ordering};

/// Machine code of a kernel.
#[derive(Debug)]
pub struct Code {
    pub(crate) executable: Executable,
    /// The bytes that are instructions; constants follow.
    code_bytes: usize,
    /// Where the function begins that computes hoisted values, if there is one.
    pub(crate) prepare: Option<usize>,
    /// Where the function begins that runs packets one by one.
    pub(crate) packet: usize,
    /// Where the function begins that runs two packets in a pass, if there is one.
    pub(crate) pair: Option<usize>,
    pub(crate) isa: Isa,
    pub(crate) frame: Frame,
    pub(crate) served: Vec<Served>,
    pub(crate) table_inputs: Vec<(u32, u32)>,
    /// The inputs that are parts of the id of the work-group, and the axis of each.
    pub(crate) workgroup_ids: Vec<(u32, u32)>,
    pub(crate) fixed_words: Vec<u32>,
    pub(crate) input_types: Vec<Type>,
    pub(crate) output_types: Vec<Type>,
    /// True if there are jumps backwards, which the budget counts.
    pub(crate) has_loops: bool,
    /// The words of the memory of a work-group; `None` if a run is not one.
    pub(crate) workgroup_words: Option<usize>,
    pub(crate) reset_locals: Vec<ResetLocal>,
    /// A number that no other code has.
    pub(crate) id: u64,
}

/// An array that is stored to, and the words that it has at the start.
#[derive(Debug)]
pub(crate) struct ResetLocal {
    /// The packet of its first word, from that of the first array on.
    pub(crate) first: usize,
    pub(crate) words: usize,
    /// Words beyond the end of the list are 0.
    pub(crate) init: Vec<u32>,
}

static NEXT_ID: AtomicU64 = AtomicU64::new(1);

/// The bytes of instructions and constants beyond which a kernel is refused.
const MAX_CODE_BYTES: usize = 1 << 26;

/// Virtual registers beyond which a kernel is refused: regalloc2 counts up to 2²⁴ units of eight
/// bytes in which they are spilled, and a register takes eight.
const MAX_REGISTERS: usize = 1 << 20;

/// Instructions beyond which registers are allocated in one pass, whatever the tier: the careful
/// allocator may take more than linear time.
const MAX_CAREFUL: usize = 1 << 14;

/// Operations, parameters and arguments beyond which a kernel is refused, with functions replaced
/// by their operations.
const MAX_SIZE: usize = 1 << 16;

impl Code {
    /// True if a pass runs two packets where so many are left.
    #[must_use]
    pub fn runs_pairs(&self) -> bool {
        self.pair.is_some()
    }

    /// Makes code for a kernel.
    ///
    /// # Errors
    /// [`CompileError`] says why the kernel must be interpreted.
    pub fn compile(kernel: &Kernel, isa: Isa, tier: Tier) -> Result<Self, CompileError> {
        Ok(Self::assembled(kernel, (isa, tier), Assembler::default())?.0)
    }

    /// The machine code of a kernel as text: for each instruction its address from the start of
    /// the code, its bytes in hexadecimal digits, and its text.
    ///
    /// # Errors
    /// [`CompileError`] as for [`Code::compile`].
    pub fn listing(kernel: &Kernel, isa: Isa, tier: Tier) -> Result<String, CompileError> {
        let assembler = Assembler::with_notes();
        let (code, notes) = Self::assembled(kernel, (isa, tier), assembler)?;
        Ok(listing::listing(
            code.executable.bytes(),
            code.code_bytes,
            &notes,
        ))
    }

    fn assembled(
        kernel: &Kernel,
        (isa, tier): (Isa, Tier),
        mut assembler: Assembler,
    ) -> Result<(Self, Vec<Note>), CompileError> {
        if !isa.is_available() {
            return Err(CompileError::NoIsa(isa.name()));
        }
        if size(kernel) > MAX_SIZE {
            return Err(CompileError::TooLarge);
        }
        lanes::verify(kernel).map_err(|error| CompileError::Malformed(error.to_string()))?;
        let split = select::small_angles::split(kernel);
        let kernel = split.as_ref().unwrap_or(kernel);
        debug_assert_eq!(lanes::verify(kernel), Ok(()), "blocks are split well");
        let expanded = select::expand::expand(kernel, MAX_SIZE)?;
        let kernel = expanded.as_ref().unwrap_or(kernel);
        let divided = select::known_divisors::replace(kernel);
        let kernel = divided.as_ref().unwrap_or(kernel);
        debug_assert_eq!(lanes::verify(kernel), Ok(()), "divisions are replaced well");
        let fused = select::exact_products::fuse(kernel);
        let kernel = fused.as_ref().unwrap_or(kernel);
        let Selected {
            prepare,
            packet,
            pair,
            mut frame,
            served,
            table_inputs,
            fixed_words,
        } = select::select(kernel, (isa, tier), &mut assembler)?;
        let reset_locals = reset_locals(kernel, &frame);
        let resets_locals = !reset_locals.is_empty();
        let is_workgroup = kernel.runs_workgroups();
        let many = if is_workgroup {
            Passes::Workgroup { resets_locals }
        } else {
            Passes::Many { resets_locals }
        };
        // First, as the frame has its final size where code steps from state to state.
        let prepare = prepare
            .map(|function| {
                assembler.note(|| Text::Part("what is the same in all lanes, once a run"));
                let once = (&function, Passes::Once);
                finish(&mut assembler, once, (isa, tier), &mut frame)
            })
            .transpose()?;
        assembler.note(|| Text::Part("packets one by one"));
        let packet = finish(&mut assembler, (&packet, many), (isa, tier), &mut frame)?;
        let pair = pair
            .map(|function| {
                assembler.note(|| Text::Part("two packets in a pass"));
                finish(&mut assembler, (&function, many), (isa, tier), &mut frame)
            })
            .transpose()?;
        if assembler.len() > MAX_CODE_BYTES {
            return Err(CompileError::TooLarge);
        }
        let finished = assembler.finish();
        let interface = &kernel.interface;
        let code = Self {
            executable: Executable::new(&finished.bytes)?,
            code_bytes: finished.code_bytes,
            prepare,
            packet,
            pair,
            isa,
            served,
            table_inputs,
            workgroup_ids: workgroup_ids(interface),
            fixed_words,
            input_types: interface.inputs.iter().map(|input| input.kind()).collect(),
            output_types: interface
                .outputs
                .iter()
                .map(|output| output.kind())
                .collect(),
            has_loops: kernel.has_loops(),
            workgroup_words: is_workgroup.then_some(interface.workgroup_words as usize),
            reset_locals,
            frame,
            id: NEXT_ID.fetch_add(1, Ordering::Relaxed),
        };
        Ok((code, finished.notes))
    }

    /// The instruction set.
    #[must_use]
    pub fn isa(&self) -> Isa {
        self.isa
    }

    /// The instructions, without the constants that follow them. For disassemblers.
    #[must_use]
    pub fn instructions(&self) -> &[u8] {
        &self.executable.bytes()[..self.code_bytes]
    }
}

/// The arrays that are stored to.
fn reset_locals(kernel: &Kernel, frame: &Frame) -> Vec<ResetLocal> {
    let locals = &kernel.interface.locals;
    let mut is_stored = vec![false; locals.len()];
    for (op, _) in kernel.blocks.iter().flat_map(|block| &block.ops) {
        if let Op::StoreLocal { array, .. } = op
            && let Some(is_stored) = is_stored.get_mut(*array as usize)
        {
            *is_stored = true;
        }
    }
    let places = frame.locals.iter().zip(locals).zip(is_stored);
    let stored = places.filter(|(_, is_stored)| *is_stored);
    stored
        .map(|((start, array), _)| ResetLocal {
            first: ((start - frame.locals[0]) / PACKET) as usize,
            words: array.words as usize,
            init: array.init.clone(),
        })
        .collect()
}

/// The inputs that are parts of the id of the work-group, and the axis of each.
fn workgroup_ids(interface: &Interface) -> Vec<(u32, u32)> {
    let inputs = (0..).zip(&interface.inputs);
    let ids = inputs.filter_map(|(at, input)| match *input {
        Input::WorkgroupId(axis) => Some((at, axis)),
        _ => None,
    });
    ids.collect()
}

/// The operations, parameters and arguments of a kernel.
fn size(kernel: &Kernel) -> usize {
    let of_block = |block: &BasicBlock| {
        let arguments = block.terminator.jumps().map(|jump| jump.arguments.len());
        block.ops.len() + block.parameters.len() + arguments.sum::<usize>() + 1
    };
    kernel.blocks.iter().map(of_block).sum()
}

/// Allocates registers and encodes a function. Returns where it begins.
fn finish(
    assembler: &mut Assembler,
    (function, passes): (&Function, Passes),
    (isa, tier): (Isa, Tier),
    frame: &mut Frame,
) -> Result<usize, CompileError> {
    let tier = if function.instructions.len() > MAX_CAREFUL {
        Tier::Fast
    } else {
        tier
    };
    if function.registers() > MAX_REGISTERS {
        return Err(CompileError::TooLarge);
    }
    let allocated = allocate::allocate(function, isa, tier)
        .map_err(|error| CompileError::Malformed(format!("{error:?}")))?;
    frame
        .reserve_spills(allocated.num_spillslots)
        .ok_or(CompileError::TooLarge)?;
    let start = assembler.len();
    emit::emit(assembler, (function, passes), &allocated, (isa, frame));
    Ok(start)
}
