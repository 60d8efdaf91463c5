//! What a run is given: inputs, outputs and memory.

use super::{Buffer, NoTextures, Textures};
use estampe_simd::Packet;
use std::cell::Cell;

/// What a run of a kernel is given.
#[derive(Debug, Clone, Copy)]
pub struct Run<'a> {
    /// The number of packets. A kernel with barriers or work-group memory is given one work-group.
    pub packets: usize,
    /// The inputs, in the order of the interface. Those that are missing are 0.
    pub inputs: &'a [InputData<'a>],
    /// Where outputs go, in the order of the interface. Those that are missing are dropped.
    pub outputs: &'a [OutputData<'a>],
    /// The buffers, in the order of the interface. Those that are missing are empty.
    pub buffers: &'a [Buffer<'a>],
    /// Accesses to textures.
    pub textures: &'a dyn Textures,
    /// The number of jumps that a chunk may execute. A chunk that needs more is stopped.
    pub budget: u64,
}

impl Run<'_> {
    /// A run of so many packets without inputs, outputs and memory.
    #[must_use]
    pub fn new(packets: usize) -> Self {
        Self {
            packets,
            inputs: &[],
            outputs: &[],
            buffers: &[],
            textures: &NoTextures,
            budget: 1 << 32,
        }
    }
}

/// Why a run ended before its kernel did. Outputs are then unspecified.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Stopped {
    /// A loop goes on for too long.
    #[error("the shader executed as many jumps as its budget allows: does a loop never end?")]
    Budget,
    /// The registers do not fit into memory.
    #[error("there is not enough memory for the local variables of the shader")]
    Memory,
}

/// Where an input is read. Elements beyond the end of a slice are 0.
#[derive(Debug, Clone, Copy)]
pub enum InputData<'a> {
    /// Element `first + p · stride` is packet p.
    Words {
        /// The packets.
        packets: &'a [Packet<u32>],
        /// The element of packet 0.
        first: usize,
        /// The number of elements from one packet to the next.
        stride: usize,
    },
    /// The bits of floats; places as for words.
    Floats {
        /// The packets.
        packets: &'a [Packet<f32>],
        /// The element of packet 0.
        first: usize,
        /// The number of elements from one packet to the next.
        stride: usize,
    },
    /// A mask: bit i of element p is lane i of packet p.
    Mask(&'a [u16]),
    /// A mask that the run also writes. A chunk reads its packets before it writes them.
    SharedMask(&'a [Cell<u16>]),
    /// The same word in all lanes. For masks, 0 is false.
    Uniform(u32),
}

impl<'a> InputData<'a> {
    /// Words: element `first + p · stride` is packet p.
    #[must_use]
    pub fn words(packets: &'a [Packet<u32>], first: usize, stride: usize) -> Self {
        Self::Words {
            packets,
            first,
            stride,
        }
    }

    /// The bits of floats: element `first + p · stride` is packet p.
    #[must_use]
    pub fn floats(packets: &'a [Packet<f32>], first: usize, stride: usize) -> Self {
        Self::Floats {
            packets,
            first,
            stride,
        }
    }

    /// The first lane, for inputs that are the same in all lanes.
    #[must_use]
    pub fn first_word(&self) -> u32 {
        match *self {
            Self::Words { packets, first, .. } => packets.get(first).map_or(0, |words| words.0[0]),
            Self::Floats { packets, first, .. } => {
                packets.get(first).map_or(0, |floats| floats.0[0].to_bits())
            }
            Self::Mask(bits) => bits.first().map_or(0, |bits| u32::from(bits & 1)),
            Self::SharedMask(bits) => bits.first().map_or(0, |bits| u32::from(bits.get() & 1)),
            Self::Uniform(word) => word,
        }
    }
}

/// Where an output is written. Elements beyond the end of a slice are dropped.
#[derive(Debug, Clone, Copy)]
pub enum OutputData<'a> {
    /// Element `first + p · stride` is packet p.
    Words {
        /// The packets: [`cells`] of a slice, which several outputs may share.
        packets: &'a [Cell<Packet<u32>>],
        /// The element of packet 0.
        first: usize,
        /// The number of elements from one packet to the next.
        stride: usize,
    },
    /// The words are bits of floats; places as for words.
    Floats {
        /// The packets: [`cells`] of a slice, which several outputs may share.
        packets: &'a [Cell<Packet<f32>>],
        /// The element of packet 0.
        first: usize,
        /// The number of elements from one packet to the next.
        stride: usize,
    },
    /// A mask: bit i of element p is lane i of packet p.
    Mask(&'a [Cell<u16>]),
    /// Nowhere.
    Dropped,
}

impl<'a> OutputData<'a> {
    /// Words: element `first + p · stride` is packet p.
    #[must_use]
    pub fn words(packets: &'a [Cell<Packet<u32>>], first: usize, stride: usize) -> Self {
        Self::Words {
            packets,
            first,
            stride,
        }
    }

    /// Bits of floats: element `first + p · stride` is packet p.
    #[must_use]
    pub fn floats(packets: &'a [Cell<Packet<f32>>], first: usize, stride: usize) -> Self {
        Self::Floats {
            packets,
            first,
            stride,
        }
    }
}

/// The elements of a slice as cells, so that several outputs can share it.
#[must_use]
pub fn cells<T>(slice: &mut [T]) -> &[Cell<T>] {
    Cell::from_mut(slice).as_slice_of_cells()
}
