//! Where the inputs and outputs of packets are.

use estampe_ir::Type;
use estampe_ir::interpreter::{InputData, OutputData};

/// The slice of an input or output.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Slice {
    address: usize,
    len: usize,
    /// The element of packet 0, and the elements from one packet to the next.
    first: usize,
    stride: usize,
}

/// Where a packet is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Found {
    /// Its address; `None` beyond the end.
    pub(crate) address: Option<usize>,
    /// True if the packets up to the last one are in the slice, too.
    pub(crate) is_inside: bool,
}

impl Found {
    /// Nowhere in memory, for all packets.
    pub(crate) const STILL: Self = Self {
        address: None,
        is_inside: true,
    };
}

impl Slice {
    fn new<T>(slice: &[T], (first, stride): (usize, usize)) -> Self {
        Self {
            address: slice.as_ptr().expose_provenance(),
            len: slice.len(),
            first,
            stride,
        }
    }

    /// An input's slice; `None` if it is the same in all packets.
    #[inline(always)]
    pub(crate) fn of_input(input: &InputData<'_>, kind: Type) -> Option<Self> {
        match (*input, kind) {
            (
                InputData::Words {
                    packets,
                    first,
                    stride,
                },
                Type::Word,
            ) => Some(Self::new(packets, (first, stride))),
            (
                InputData::Floats {
                    packets,
                    first,
                    stride,
                },
                Type::Word,
            ) => Some(Self::new(packets, (first, stride))),
            (InputData::Mask(bits), Type::Mask) => Some(Self::new(bits, (0, 1))),
            (InputData::SharedMask(bits), Type::Mask) => Some(Self::new(bits, (0, 1))),
            _ => None,
        }
    }

    /// An output's slice; `None` if it goes nowhere.
    #[inline(always)]
    pub(crate) fn of_output(output: &OutputData<'_>, kind: Type) -> Option<Self> {
        match (*output, kind) {
            (
                OutputData::Words {
                    packets,
                    first,
                    stride,
                },
                Type::Word,
            ) => Some(Self::new(packets, (first, stride))),
            (
                OutputData::Floats {
                    packets,
                    first,
                    stride,
                },
                Type::Word,
            ) => Some(Self::new(packets, (first, stride))),
            (OutputData::Mask(bits), Type::Mask) => Some(Self::new(bits, (0, 1))),
            _ => None,
        }
    }

    /// The place of a packet whose elements have so many bytes, in a run up to the last one.
    #[inline(always)]
    pub(crate) fn find(&self, bytes: usize, [packet, last]: [usize; 2]) -> Found {
        let element = |packet: usize| {
            let at = packet.checked_mul(self.stride)?.checked_add(self.first)?;
            (at < self.len).then_some(at)
        };
        let at = element(packet);
        Found {
            // An element of the slice: no overflow.
            address: at.map(|at| self.address + at * bytes),
            is_inside: at.is_some() && (packet == last || element(last).is_some()),
        }
    }

    /// The bytes from one packet to the next, of which no overflow counts: the next one is inside.
    #[inline(always)]
    pub(crate) fn step(&self, bytes: usize) -> usize {
        self.stride.wrapping_mul(bytes)
    }
}

/// The bytes of a packet of words, or of a mask.
#[inline(always)]
pub(crate) fn bytes_of(kind: Type) -> usize {
    match kind {
        Type::Word => crate::frame::PACKET as usize,
        Type::Mask => size_of::<u16>(),
    }
}
