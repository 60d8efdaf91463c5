//! Runs a kernel: vector bytecode, many lanes an operation, in safe Rust.
//!
//! In · Out: a kernel · [`Code`], which reads inputs and memory and writes outputs.
//!
//! An instruction works on a *chunk*: as many packets of sixteen lanes as keep all registers in the
//! processor's first cache, at most [`MAX_CHUNK`]. So the cost of finding out which instruction
//! comes next is shared by up to 256 lanes. What is the same in all lanes is held once, as a
//! scalar.
//!
//! | kernel | packets of a chunk |
//! |---|---|
//! | without effects on memory | 1 to 16, by the number of its registers |
//! | with stores to buffers or textures, or atomics | 1, so that lanes act in order |
//! | with barriers or work-group memory | 1; a run is one work-group |
//!
//! The packets of a work-group run one after the other, each up to the next barrier, with registers
//! of their own: so what they do to shared memory has an order, which machine code keeps.
//!
//! `Display` of [`Code`] lists its instructions.
//!
//! Results do not depend on the chunk or the SIMD level. Nothing panics, whatever numbers lanes
//! have: accesses outside of memory read zeros and store nothing.
//!
//! ```
//! use estampe_ir::interface::{Input, Output, Stage};
//! use estampe_ir::interpreter::{Code, InputData, OutputData, Run, Scratch, cells};
//! use estampe_ir::lanes::Kernel;
//! use estampe_ir::op::Binary;
//! use estampe_ir::tree::Builder;
//! use estampe_simd::{Level, Packet};
//!
//! let mut b = Builder::new(Stage::Vertex);
//! let index = b.input(Input::VertexIndex);
//! let square = b.binary(Binary::Mul, index, index);
//! let tree = b.finish(vec![(Output::Varying(0), square)]);
//! let code = Code::new(&Kernel::from_tree(&tree));
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

mod batch;
mod compile;
mod instruction;
mod listing;
mod memory;
mod run;
mod textures;

pub use batch::{InputData, OutputData, Part, Run, Stopped, cells};
pub use compile::{Code, MAX_CHUNK};
pub use memory::{Buffer, Words, atomic};
pub use run::Scratch;
pub use textures::{Common, NoTextures, TextureAccess, TextureAccesses, Textures};

#[cfg(test)]
mod tests;
