//! A stage of a program: its kernel, as machine code or as bytecode.

use super::alpha_test::AlphaTests;
use super::batch::Widths;
use super::buffers::BoundBuffers;
use super::ends::{Ends, Source, Target};
use super::machine::MachineCode;
use super::nondependent::Reads;
use super::textures::BoundTextures;
use estampe_ir::Op;
use estampe_ir::interface::{Input, Interface, TextureSlot};
use estampe_ir::interpreter::{Buffer, Code, InputData, OutputData, Run, Scratch, Stopped};
use estampe_ir::lanes::Kernel;
use estampe_ir::op::TextureQuery;
use estampe_ir::tree::Tree;
use estampe_simd::Level;
use estampe_types::Bindings;
use estampe_types::shader::TextureReads;
use std::cell::RefCell;
use std::sync::OnceLock;

thread_local! {
    /// The registers of the interpreter, kept from one batch to the next.
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// A stage that can run.
#[derive(Debug)]
pub(super) struct Stage {
    kernel: Kernel,
    /// The texture reads that are made before the kernel runs.
    reads: Reads,
    /// What decides whether a fragment has an effect.
    alpha_tests: Option<AlphaTests>,
    /// The kernel's colours are the texels of its only read: nothing is left to run.
    passes_texels: bool,
    inputs: Ends<Source>,
    outputs: Ends<Target>,
    machine: MachineCode,
    /// What runs where there is no machine code.
    bytecode: OnceLock<Code>,
    /// No machine code is made: all runs are by bytecode.
    is_interpreted: bool,
    /// The number of jumps that a run may execute.
    budget: u64,
}

impl Stage {
    /// A stage whose runs are given the data of each input and output.
    pub(super) fn new(tree: &Tree, budget: u64) -> Self {
        Self {
            kernel: Kernel::from_tree(tree),
            reads: Reads::default(),
            alpha_tests: None,
            passes_texels: false,
            inputs: Ends::default(),
            outputs: Ends::default(),
            machine: MachineCode::default(),
            bytecode: OnceLock::new(),
            is_interpreted: false,
            budget,
        }
    }

    /// A vertex stage. `attributes` says at which scalar each location begins, and `varyings` to
    /// which scalar of the fragments each scalar of the vertices goes.
    pub(super) fn of_vertices(
        tree: &Tree,
        budget: u64,
        (attributes, varyings): (&[usize], &[Option<u32>]),
    ) -> Self {
        let stage = Self::new(tree, budget);
        let Interface {
            inputs, outputs, ..
        } = stage.interface();
        Self {
            inputs: Ends::<Source>::of_vertices(inputs, attributes),
            outputs: Ends::<Target>::of_vertices(outputs, varyings),
            ..stage
        }
    }

    /// A fragment stage, whose non-dependent texture reads are made before its kernel runs.
    /// `gradients` lists the scalars of the varyings that have derivatives, in ascending order.
    pub(super) fn of_fragments(
        tree: &Tree,
        budget: u64,
        (widths, gradients): (Widths, &[usize]),
    ) -> Self {
        let mut tree = tree.clone();
        let reads = Reads::take(&mut tree, widths, gradients);
        let alpha_tests = AlphaTests::of(&tree, &reads);
        let stage = Self::new(&tree, budget);
        let Interface {
            inputs, outputs, ..
        } = stage.interface();
        Self {
            inputs: Ends::<Source>::of_fragments(inputs, &reads, (widths, gradients)),
            outputs: Ends::<Target>::of_fragments(outputs, widths),
            passes_texels: widths.colors == 1 && reads.are_colors(&tree),
            alpha_tests: Some(alpha_tests),
            reads,
            ..stage
        }
    }

    /// The data that a run of a vertex or fragment stage is given for its inputs.
    pub(super) fn sources(&self) -> &[Source] {
        self.inputs.data()
    }

    /// The data that a run of a vertex or fragment stage is given for its outputs.
    pub(super) fn targets(&self) -> &[Target] {
        self.outputs.data()
    }

    /// The texture reads that are made before the kernel runs.
    pub(super) fn reads(&self) -> &Reads {
        &self.reads
    }

    /// What decides whether a fragment has an effect.
    pub(super) fn alpha_tests(&self) -> Option<&AlphaTests> {
        self.alpha_tests.as_ref()
    }

    /// True if the colours of fragments are the texels of the only read, so that no run is needed.
    pub(super) fn passes_texels(&self) -> bool {
        self.passes_texels
    }

    /// Runs by bytecode from now on.
    pub(super) fn interpret(&mut self) {
        self.is_interpreted = true;
    }

    pub(super) fn interface(&self) -> &Interface {
        &self.kernel.interface
    }

    /// The buffers among the resources that a draw or dispatch binds.
    #[inline]
    pub(super) fn buffers<'a>(&self, bindings: &'a Bindings) -> BoundBuffers<'a> {
        BoundBuffers::new(bindings, &self.interface().buffers)
    }

    /// The textures among the resources that a draw or dispatch binds.
    #[inline(always)]
    pub(super) fn textures<'a>(&'a self, bindings: &'a Bindings) -> BoundTextures<'a> {
        let Interface {
            textures, samplers, ..
        } = self.interface();
        BoundTextures::new(bindings, textures, samplers)
    }

    /// How a texture is read.
    pub(super) fn texture_reads(&self, slot: TextureSlot) -> TextureReads {
        let mut slots = self.interface().textures.iter();
        let Some(at) = slots.position(|one| *one == slot) else {
            return TextureReads::default();
        };
        let at = u32::try_from(at).unwrap_or(u32::MAX);
        let of_op = |op: &Op| match op {
            Op::Texture(op) if op.texture == at && !op.query.is_of_shape() => {
                let compares = op.query == TextureQuery::SampleCompare && op.offset == [0; 3];
                TextureReads {
                    compares,
                    others: !compares,
                    ..TextureReads::default()
                }
            }
            _ => TextureReads::default(),
        };
        let ops = self.kernel.blocks.iter().flat_map(|block| &block.ops);
        ops.map(|(op, _)| of_op(op))
            .fold(self.reads.of_texture(at), |all, reads| all | reads)
    }

    /// Runs so many packets. Inlined, because pairs of arguments in memory are read before they
    /// have arrived there.
    #[inline(always)]
    pub(super) fn run(
        &self,
        level: Level,
        (textures, buffers): (&BoundTextures<'_>, &[Buffer<'_>]),
        packets: usize,
        (inputs, outputs): (&[InputData<'_>], &[OutputData<'_>]),
    ) -> Result<(), Stopped> {
        let run = Run {
            packets,
            inputs,
            input_parts: self.inputs.parts(),
            outputs,
            output_parts: self.outputs.parts(),
            buffers,
            textures,
            budget: self.budget,
        };
        if !self.is_interpreted
            && let Some(stopped) = self.machine.run(&self.kernel, level, (&run, &[]))
        {
            return stopped;
        }
        self.run_bytecode(level, &run)
    }

    /// Runs so many packets for each of some work-groups, one after the other. The inputs that are
    /// their ids are set here.
    pub(super) fn run_workgroups(
        &self,
        level: Level,
        (textures, buffers): (&BoundTextures<'_>, &[Buffer<'_>]),
        (packets, ids): (usize, &[[u32; 3]]),
        inputs: &mut [InputData<'_>],
    ) -> Result<(), Stopped> {
        let of_all = Run {
            buffers,
            textures,
            budget: self.budget,
            ..Run::new(packets)
        };
        let run = Run { inputs, ..of_all };
        if !self.is_interpreted
            && let Some(stopped) = self.machine.run(&self.kernel, level, (&run, ids))
        {
            return stopped;
        }
        for id in ids {
            for (input, data) in self.interface().inputs.iter().zip(&mut *inputs) {
                if let Input::WorkgroupId(axis) = input {
                    let part = id.get(*axis as usize).copied();
                    *data = InputData::Uniform(part.unwrap_or_default());
                }
            }
            self.run_bytecode(level, &Run { inputs, ..of_all })?;
        }
        Ok(())
    }

    #[inline(never)]
    fn run_bytecode(&self, level: Level, run: &Run<'_>) -> Result<(), Stopped> {
        let code = self.bytecode.get_or_init(|| Code::new(&self.kernel));
        SCRATCH.with_borrow_mut(|scratch| code.run(level, run, scratch))
    }
}
