#![deny(unsafe_code)]
//! Machine code for the shader compiler's kernels, on x86-64.
//!
//! ```text
//! Kernel ─▶ select ─▶ machine instructions, ─▶ allocate ─▶ emit ─▶ bytes ─▶ Executable
//!           (plan,    virtual registers       (regalloc2)  (encoder)        (written, then
//!            frame)                                                          executable)
//! ```
//!
//! [`Code::compile`] makes [`Code`], which runs as `estampe_ir::interpreter::Code` does, on the
//! same [`Run`](estampe_ir::interpreter::Run), with the same results: those that
//! [`estampe_ir::Op`] defines, to the last bit, apart from the payloads of NaNs that no operation
//! made canonical. Where no code can be made, [`CompileError`] says why, and the interpreter runs
//! the kernel.
//!
//! * A pass of the code runs a packet, or two (`select` says when); the loop over packets is in the
//!   code, too.
//! * What is the same in all lanes of a run is computed once a run and lives in memory, from which
//!   instructions read it as a broadcast operand; so do constants and the words of buffers at fixed
//!   places. They need no registers.
//! * A call runs several work-groups of a dispatch, which differ in their ids alone.
//! * In a work-group each packet has the part of the frame where its registers are spilled for
//!   itself. At a barrier code goes on with the next packet (`machine::passes`).
//! * Operations that are rare, or act lane after lane, are calls of Rust functions (`serve`).
//! * Code reads and writes its frame, and the inputs, outputs and buffers whose addresses are
//!   there. Indices are compared with the length of the buffer first.
//!
//! ```
//! use estampe_ir::interface::{Input, Output, Stage};
//! use estampe_ir::interpreter::{InputData, OutputData, Run, cells};
//! use estampe_ir::lanes::Kernel;
//! use estampe_ir::op::Binary;
//! use estampe_ir::tree::Builder;
//! use estampe_simd::{Level, Packet};
//! use estampe_x86::{Code, Isa, Scratch, Tier};
//!
//! let mut b = Builder::new(Stage::Vertex);
//! let index = b.input(Input::VertexIndex);
//! let square = b.binary(Binary::Mul, index, index);
//! let kernel = Kernel::from_tree(&b.finish(vec![(Output::Varying(0), square)]));
//! // Where there is no code, the interpreter runs the kernel.
//! let Some(isa) = Isa::best() else { return };
//! let Ok(code) = Code::compile(&kernel, isa, Tier::Fast) else { return };
//!
//! let indices = [Packet(std::array::from_fn(|lane| lane as u32))];
//! let mut squares = [Packet([0; 16])];
//! let run = Run {
//!     inputs: &[InputData::words(&indices, 0, 1)],
//!     outputs: &[OutputData::words(cells(&mut squares), 0, 1)],
//!     ..Run::new(1)
//! };
//! code.run(Level::best(), &run, &mut Scratch::default()).unwrap();
//! assert_eq!(squares[0].0[15], 225);
//! ```
//!
//! # What makes it sound
//!
//! `unsafe` code is in two modules, `executable` and `enter`. They rely on these invariants, which
//! safe code of the crate keeps and the fuzzer looks for holes in:
//!
//! | invariant | kept by |
//! |---|---|
//! | Pages are writable before they are executable, never both; they are unmapped when the code is dropped, which no run outlives. | `executable`: `new`, `Drop`; `Code::run` borrows the code |
//! | The processor and the system have the instructions. | `Code::compile` asks `Isa::is_available` |
//! | The bytes are the instructions that were meant. | `encoder`: every row of its table is compared with a decoder |
//! | The kernel is well formed: values are defined before their uses, entries of the interface exist. | `Code::compile` verifies it |
//! | A frame is as large as its layout with the states of all packets of a work-group, in units of lines, and was cleared when this code saw it first. | `run`: `make_room`; `enter` asserts it |
//! | Places in the frame lie in their part of it. | `frame`: offsets are computed once, in checked arithmetic, and are below 64 MiB |
//! | Inputs and outputs: each pointer has a packet (64 bytes of words, 2 of a mask) behind it, of the slice, or of the frame where the slice has none. | `places`, `run`: `set_packet` |
//! | Buffers at fixed places: as many words are there, if need be of a copy that ends in zeros. | `run`: `set_buffers` |
//! | Buffers at computed places: the word's number is compared with the number of words, and lanes beyond neither read nor write. Nothing is stored to buffers that are bound for reading. | `select::memory`, `serve` |
//! | Arrays: reads clamp the index, stores compare it. | `select::memory`, `serve` |
//! | Code ends: jumps backwards use up the budget. | `select`: every one is an edge of its own; `machine::emit` |
//! | A packet of a work-group goes on at an address that its code has put into its state, which nothing else writes. | `machine::passes` |
//! | Code changes only registers that its callers may lose (`rbx` and `r12` are saved), uses 24 bytes of stack at most, calls with the stack aligned to 16 bytes and the upper halves of vectors cleared, and does not touch MXCSR: rounding and denormals are those of Rust, as in the interpreter. | `machine::allocate`, `machine::emit` |
//! | No panic passes through code. A call catches it, code returns, and `Code::run` goes on with it. | `enter`: `serve` |
//! | A run's scratch memory is one thread's; code is shared by threads and changes nothing of its own. | `&mut Scratch`; constants are in executable, that is read-only pages |
//!
//! Buffers may be changed by other threads during a run. Code reads and writes their words with
//! moves, gathers and scatters of aligned four-byte elements, and halves of words with moves of
//! aligned two-byte elements, each of which the processor does at once, as a relaxed atomic access
//! is.
//!
//! # Not there yet
//!
//! * Integer division with AVX2, stores to arrays, and some atomic operations whose results are
//!   used, are calls.
//! * Windows: there is no executable memory yet.
//!
//! On other processors [`Code::compile`] always returns [`CompileError::NoIsa`].

mod error;
mod isa;

#[cfg(target_arch = "x86_64")]
mod compile;
#[cfg(not(target_arch = "x86_64"))]
mod elsewhere;
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
mod listing;
#[cfg(target_arch = "x86_64")]
mod machine;
#[cfg(target_arch = "x86_64")]
mod places;
#[cfg(target_arch = "x86_64")]
mod run;
#[cfg(target_arch = "x86_64")]
mod scratch;
#[cfg(target_arch = "x86_64")]
mod select;
#[cfg(target_arch = "x86_64")]
mod serve;
#[cfg(target_arch = "x86_64")]
mod workgroups;

#[cfg(target_arch = "x86_64")]
pub use compile::Code;
#[cfg(not(target_arch = "x86_64"))]
pub use elsewhere::{Code, Scratch};
pub use error::CompileError;
pub use isa::{Isa, Tier};
#[cfg(target_arch = "x86_64")]
pub use scratch::Scratch;
