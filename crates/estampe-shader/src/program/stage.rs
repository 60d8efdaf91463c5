//! A stage of a program: its kernel, as code.

use super::textures::BoundTextures;
use estampe_ir::interface::Interface;
use estampe_ir::interpreter::{Buffer, Code, InputData, OutputData, Run, Scratch, Stopped};
use estampe_ir::lanes::Kernel;
use estampe_ir::tree::Tree;
use estampe_simd::Level;
use estampe_types::Bindings;
use std::cell::RefCell;

thread_local! {
    /// The registers of the interpreter, kept from one batch to the next.
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// A stage that can run.
#[derive(Debug)]
pub(super) struct Stage {
    interface: Interface,
    code: Code,
    /// The number of jumps that a run may execute.
    budget: u64,
}

impl Stage {
    pub(super) fn new(tree: &Tree, budget: u64) -> Self {
        let kernel = Kernel::from_tree(tree);
        Self {
            code: Code::new(&kernel),
            interface: kernel.interface,
            budget,
        }
    }

    pub(super) fn interface(&self) -> &Interface {
        &self.interface
    }

    pub(super) fn run(
        &self,
        level: Level,
        (bindings, buffers): (&Bindings, &[Buffer<'_>]),
        packets: usize,
        (inputs, outputs): (&[InputData<'_>], &[OutputData<'_>]),
    ) -> Result<(), Stopped> {
        let Interface {
            textures, samplers, ..
        } = &self.interface;
        let textures = BoundTextures::new(bindings, textures, samplers);
        let run = Run {
            packets,
            inputs,
            outputs,
            buffers,
            textures: &textures,
            budget: self.budget,
        };
        SCRATCH.with_borrow_mut(|scratch| self.code.run(level, &run, scratch))
    }
}
