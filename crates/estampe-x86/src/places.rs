//! Where the inputs and outputs of packets are.

use estampe_ir::Type;
use estampe_ir::interpreter::{InputData, OutputData};
use std::hint::select_unpredictable;

/// Where the packets of an input or output are in a run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Track {
    /// The address of packet 0.
    start: usize,
    /// The bytes from one packet to the next.
    step: usize,
    /// The packets that are in memory, from the first on. The others are at a place that does not
    /// move; all are, of an input that is the same in all packets or an output that goes nowhere.
    packets: usize,
    /// The address of that place.
    still: usize,
}

impl Track {
    /// Nowhere in memory, for all packets.
    pub(crate) const STILL: Self = Self {
        start: 0,
        step: 0,
        packets: 0,
        still: 0,
    };

    /// The packets in a slice of which packet 0 is at `first`, and the others `stride` elements
    /// after each other, up to the last packet of a run. `bytes` are those of an element.
    #[inline(always)]
    fn new<T>(slice: &[T], (first, stride): (usize, usize), bytes: usize, last: usize) -> Self {
        let Some(behind) = slice.len().checked_sub(first).filter(|len| *len > 0) else {
            return Self::STILL;
        };
        let is_last_inside = last.checked_mul(stride).is_some_and(|last| last < behind);
        Self {
            // An element of the slice: no overflow.
            start: slice.as_ptr().expose_provenance() + first * bytes,
            // No overflow that counts: a packet that is reached by a step is inside.
            step: stride.wrapping_mul(bytes),
            packets: if is_last_inside {
                last + 1
            } else {
                // A stride of 0 leads nowhere else, so the last packet is then inside.
                behind.div_ceil(stride)
            },
            still: 0,
        }
    }

    /// The same with an address for what is not in memory.
    #[inline(always)]
    pub(crate) fn or_still(self, still: usize) -> Self {
        Self { still, ..self }
    }

    /// An input's packets.
    #[inline(always)]
    pub(crate) fn of_input(input: &InputData<'_>, kind: Type, last: usize) -> Self {
        let bytes = bytes_of(kind);
        match (*input, kind) {
            (
                InputData::Words {
                    packets,
                    first,
                    stride,
                },
                Type::Word,
            ) => Self::new(packets, (first, stride), bytes, last),
            (
                InputData::Floats {
                    packets,
                    first,
                    stride,
                },
                Type::Word,
            ) => Self::new(packets, (first, stride), bytes, last),
            (InputData::Mask(bits), Type::Mask) => Self::new(bits, (0, 1), bytes, last),
            (InputData::SharedMask(bits), Type::Mask) => Self::new(bits, (0, 1), bytes, last),
            _ => Self::STILL,
        }
    }

    /// An output's packets.
    #[inline(always)]
    pub(crate) fn of_output(output: &OutputData<'_>, kind: Type, last: usize) -> Self {
        let bytes = bytes_of(kind);
        match (*output, kind) {
            (
                OutputData::Words {
                    packets,
                    first,
                    stride,
                },
                Type::Word,
            ) => Self::new(packets, (first, stride), bytes, last),
            (
                OutputData::Floats {
                    packets,
                    first,
                    stride,
                },
                Type::Word,
            ) => Self::new(packets, (first, stride), bytes, last),
            (OutputData::Mask(bits), Type::Mask) => Self::new(bits, (0, 1), bytes, last),
            _ => Self::STILL,
        }
    }

    /// True if a packet is where those before it lead: in memory, or where all are.
    #[inline(always)]
    pub(crate) fn has(&self, packet: usize) -> bool {
        self.packets == 0 || packet < self.packets
    }

    /// True if the packets up to this one are in memory.
    #[inline(always)]
    pub(crate) fn moves_up_to(&self, packet: usize) -> bool {
        packet < self.packets
    }

    /// The address of a packet.
    #[inline(always)]
    pub(crate) fn address(&self, packet: usize) -> usize {
        let address = self.start.wrapping_add(self.step.wrapping_mul(packet));
        select_unpredictable(packet < self.packets, address, self.still)
    }

    /// The bytes from one packet to the next.
    #[inline(always)]
    pub(crate) fn step(&self) -> usize {
        self.step
    }
}

/// The bytes of a packet of words, or of a mask.
#[inline(always)]
fn bytes_of(kind: Type) -> usize {
    match kind {
        Type::Word => crate::frame::PACKET as usize,
        Type::Mask => size_of::<u16>(),
    }
}
