//! What a run is given: inputs, outputs and memory.

use super::{Buffer, NoTextures, Textures};
use estampe_simd::Packet;
use std::cell::Cell;

/// What a run of a kernel is given.
#[derive(Debug, Clone, Copy)]
pub struct Run<'a> {
    /// The number of packets. A kernel with barriers or work-group memory is given one work-group.
    pub packets: usize,
    /// The data of the inputs.
    pub inputs: &'a [InputData<'a>],
    /// The part of the data that each input is, in the order of the interface. Inputs beyond the
    /// end are the data of their own number, and those whose data are missing are 0.
    pub input_parts: &'a [Part],
    /// Where the data of outputs go.
    pub outputs: &'a [OutputData<'a>],
    /// The part of the data that each output is, as for inputs. Those whose data are missing are
    /// dropped.
    pub output_parts: &'a [Part],
    /// The buffers, in the order of the interface. Those that are missing are empty.
    pub buffers: &'a [Buffer<'a>],
    /// Accesses to textures.
    pub textures: &'a dyn Textures,
    /// The number of jumps that a chunk may execute. A chunk that needs more is stopped.
    pub budget: u64,
}

impl<'a> Run<'a> {
    /// A run of so many packets without inputs, outputs and memory.
    #[must_use]
    pub fn new(packets: usize) -> Self {
        Self {
            packets,
            inputs: &[],
            input_parts: &[],
            outputs: &[],
            output_parts: &[],
            buffers: &[],
            textures: &NoTextures,
            budget: 1 << 32,
        }
    }

    /// The data of an input of the interface.
    #[inline]
    #[must_use]
    pub fn input(&self, at: u32) -> InputData<'a> {
        let part = Part::of(self.input_parts, at);
        let data = self.inputs.get(part.data as usize);
        data.map_or(InputData::Uniform(0), |data| data.part(part.first as usize))
    }

    /// Where an output of the interface goes.
    #[inline]
    #[must_use]
    pub fn output(&self, at: u32) -> OutputData<'a> {
        let part = Part::of(self.output_parts, at);
        let data = self.outputs.get(part.data as usize);
        data.map_or(OutputData::Dropped, |data| data.part(part.first as usize))
    }
}

/// The part of a run's data that an input or output is. Many are parts of one slice, as all scalars
/// of a batch's varyings are: so parts are listed once, and a run names a few slices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// The position of the data in the list of the run.
    pub data: u32,
    /// The elements by which it lies behind the first one of the data. Masks have one part.
    pub first: u32,
}

impl Part {
    /// Of no data: an input that is 0, an output that is dropped.
    pub const NONE: Self = Self {
        data: u32::MAX,
        first: 0,
    };

    /// The part that is listed for an input or output.
    #[inline(always)]
    #[must_use]
    pub fn of(parts: &[Self], at: u32) -> Self {
        let own = Self { data: at, first: 0 };
        parts.get(at as usize).copied().unwrap_or(own)
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
    /// Words each of which is the same in all lanes; element `first` is that of a part.
    UniformWords(&'a [u32]),
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

    /// The data of a part that lies so many elements behind the first one.
    #[inline]
    #[must_use]
    pub fn part(self, behind: usize) -> Self {
        match self {
            Self::Words {
                packets,
                first,
                stride,
            } => Self::words(packets, first.saturating_add(behind), stride),
            Self::Floats {
                packets,
                first,
                stride,
            } => Self::floats(packets, first.saturating_add(behind), stride),
            Self::UniformWords(words) => {
                Self::Uniform(words.get(behind).copied().unwrap_or_default())
            }
            Self::Mask(_) | Self::SharedMask(_) | Self::Uniform(_) => self,
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
            Self::UniformWords(words) => words.first().copied().unwrap_or_default(),
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

    /// The data of a part that lies so many elements behind the first one.
    #[inline]
    #[must_use]
    pub fn part(self, behind: usize) -> Self {
        match self {
            Self::Words {
                packets,
                first,
                stride,
            } => Self::words(packets, first.saturating_add(behind), stride),
            Self::Floats {
                packets,
                first,
                stride,
            } => Self::floats(packets, first.saturating_add(behind), stride),
            Self::Mask(_) | Self::Dropped => self,
        }
    }
}

/// The elements of a slice as cells, so that several outputs can share it.
#[must_use]
pub fn cells<T>(slice: &mut [T]) -> &[Cell<T>] {
    Cell::from_mut(slice).as_slice_of_cells()
}
