#![deny(unsafe_code)]
//! Machine code for the shader compiler's kernels, on x86-64.
//!
//! ```text
//! Kernel ─▶ select ─▶ machine instructions, ─▶ allocate ─▶ emit ─▶ bytes ─▶ Executable
//!           (plan,    virtual registers       (regalloc2)  (encoder)        (written, then
//!            frame)                                                          executable)
//! ```
//!
//! [`compile`] makes [`Code`], which runs as `estampe_ir::interpreter::Code` does, on the same
//! [`Run`](estampe_ir::interpreter::Run), with the same results: those that [`estampe_ir::Op`]
//! defines, to the last bit, apart from the payloads of NaNs that no operation made canonical. Where
//! no code can be made, [`CompileError`] says why, and the interpreter runs the kernel.
//!
//! * Code is made for one pass: a packet with AVX-512, half of one with AVX2 (`select` says when).
//! * What is the same in all lanes of a run is computed once a run and lives in memory, from which
//!   instructions read it as a broadcast operand; so do constants and the words of buffers at fixed
//!   places. They need no registers.
//! * Operations that are rare, or act lane after lane, are calls of Rust functions (`serve`).
//! * Code reads and writes its frame, and the inputs, outputs and buffers whose addresses are there.
//!   Indices are compared with the length of the buffer first.
//!
//! # Not there yet
//!
//! * Barriers and the memory of work-groups: such kernels are refused.
//! * Atomic operations, integer division, conversions of binary16, stores to arrays and, with AVX2,
//!   stores to buffers are calls.
//! * Windows: there is no executable memory yet.
#![cfg_attr(
    target_arch = "x86_64",
    doc = "
```
use estampe_ir::interface::{Input, Output, Stage};
use estampe_ir::interpreter::{InputData, OutputData, Run, cells};
use estampe_ir::lanes::Kernel;
use estampe_ir::op::Binary;
use estampe_ir::tree::Builder;
use estampe_simd::{Level, Packet};
use estampe_x86::{Isa, Scratch, Tier, compile};

let mut b = Builder::new(Stage::Vertex);
let index = b.input(Input::VertexIndex);
let square = b.binary(Binary::Mul, index, index);
let kernel = Kernel::from_tree(&b.finish(vec![(Output::Varying(0), square)]));
let Some(isa) = Isa::best() else { return };
let Ok(code) = compile(&kernel, isa, Tier::Fast) else { return };

let indices = [Packet(std::array::from_fn(|lane| lane as u32))];
let mut squares = [Packet([0; 16])];
let run = Run {
    inputs: &[InputData::words(&indices, 0, 1)],
    outputs: &[OutputData::words(cells(&mut squares), 0, 1)],
    ..Run::new(1)
};
code.run(Level::best(), &run, &mut Scratch::default()).unwrap();
assert_eq!(squares[0].0[15], 225);
```
"
)]
//!
//! On other processors the crate has no [`compile`].

mod error;
mod isa;

#[cfg(target_arch = "x86_64")]
mod compile;
#[cfg(target_arch = "x86_64")]
mod encoder;
#[cfg(target_arch = "x86_64")]
#[expect(unsafe_code, reason = "calls machine code, and is called by it")]
mod enter;
#[cfg(target_arch = "x86_64")]
#[expect(unsafe_code, reason = "owns pages with machine code")]
mod executable;
#[cfg(target_arch = "x86_64")]
mod frame;
#[cfg(target_arch = "x86_64")]
mod machine;
#[cfg(target_arch = "x86_64")]
mod run;
#[cfg(target_arch = "x86_64")]
mod select;
#[cfg(target_arch = "x86_64")]
mod serve;

#[cfg(target_arch = "x86_64")]
pub use compile::{Code, compile};
pub use error::CompileError;
pub use isa::{Isa, Tier};
#[cfg(target_arch = "x86_64")]
pub use run::Scratch;
