//! Processors for which no code is made: the same interface, which refuses every kernel.

use crate::{CompileError, Isa, Tier};
use estampe_ir::interpreter::{Run, Stopped};
use estampe_ir::lanes::Kernel;
use estampe_simd::Level;

/// Machine code of a kernel. There is none for this processor.
#[derive(Debug)]
pub enum Code {}

/// The memory of a run, kept for the next one. One for each thread.
#[derive(Debug, Default)]
pub struct Scratch {}

impl Scratch {
    /// True if it was last used for this code.
    #[must_use]
    pub fn is_of(&self, code: &Code) -> bool {
        match *code {}
    }

    /// The bytes of its memory.
    #[must_use]
    pub fn bytes(&self) -> usize {
        0
    }

    /// The jumps backwards of the last run of a code, about.
    #[must_use]
    pub fn jumps(&self, code: &Code, _: &Run<'_>) -> u64 {
        match *code {}
    }
}

impl Code {
    /// Makes code for a kernel.
    ///
    /// # Errors
    /// [`CompileError::NoIsa`], always.
    pub fn compile(_: &Kernel, isa: Isa, _: Tier) -> Result<Self, CompileError> {
        Err(CompileError::NoIsa(isa.name()))
    }

    /// The machine code of a kernel as text.
    ///
    /// # Errors
    /// [`CompileError::NoIsa`], always.
    pub fn listing(_: &Kernel, isa: Isa, _: Tier) -> Result<String, CompileError> {
        Err(CompileError::NoIsa(isa.name()))
    }

    /// Executes the kernel in all lanes of all packets.
    ///
    /// # Errors
    /// None: there is no code to run.
    pub fn run(&self, _: Level, _: &Run<'_>, _: &mut Scratch) -> Result<(), Stopped> {
        match *self {}
    }

    /// Executes the kernel for several work-groups.
    ///
    /// # Errors
    /// None: there is no code to run.
    pub fn run_workgroups(
        &self,
        _: Level,
        _: &Run<'_>,
        _: &[[u32; 3]],
        _: &mut Scratch,
    ) -> Result<(), Stopped> {
        match *self {}
    }

    /// The instruction set.
    #[must_use]
    pub fn isa(&self) -> Isa {
        match *self {}
    }

    /// The instructions, without the constants that follow them. For disassemblers.
    #[must_use]
    pub fn instructions(&self) -> &[u8] {
        match *self {}
    }
}
