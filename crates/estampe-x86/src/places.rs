//! Where the inputs and outputs of packets are.

use estampe_ir::Type;
use estampe_ir::interpreter::{InputData, OutputData};

/// Where the packets of an input's or output's data are in a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Track {
    /// The type of the elements; `None` of data that are not in memory.
    kind: Option<Type>,
    /// The address of packet 0 of the first part.
    start: usize,
    /// The bytes from one packet to the next.
    step: usize,
    /// The elements from one packet to the next.
    stride: usize,
    /// The elements from packet 0 of the first part on.
    room: usize,
    /// The first part of which not all packets of the run are in memory.
    whole: usize,
}

impl Track {
    /// Of data that are not in memory.
    pub(crate) const NOWHERE: Self = Self {
        kind: None,
        start: 0,
        step: 0,
        stride: 0,
        room: 0,
        whole: 0,
    };

    /// True of data that are not in memory.
    pub(crate) fn is_nowhere(&self) -> bool {
        self.kind.is_none()
    }

    /// True if the packets are where those of another track are, and of so many parts all packets
    /// of the run are in memory.
    #[inline(always)]
    pub(crate) fn goes_as(&self, other: &Self, parts: usize) -> bool {
        (self.kind, self.start, self.step) == (other.kind, other.start, other.step)
            && self.whole >= parts
    }

    /// The packets in a slice of which packet 0 is at `first`, and the others `stride` elements
    /// after each other, in a run that ends with packet `last`.
    #[inline(always)]
    fn new<T>(slice: &[T], (first, stride): (usize, usize), kind: Type, last: usize) -> Self {
        let bytes = bytes_of(kind);
        let room = slice.len().saturating_sub(first);
        let whole = room.saturating_sub(last.saturating_mul(stride));
        Self {
            kind: Some(kind),
            // No overflow that counts: where there is no room, the address is not used.
            start: (slice.as_ptr().expose_provenance()).wrapping_add(first.wrapping_mul(bytes)),
            step: stride.wrapping_mul(bytes),
            stride,
            room,
            whole: if kind == Type::Mask {
                whole.min(1)
            } else {
                whole
            },
        }
    }

    /// An input's packets.
    #[inline(always)]
    pub(crate) fn of_input(input: &InputData<'_>, last: usize) -> Self {
        match *input {
            InputData::Words {
                packets,
                first,
                stride,
            } => Self::new(packets, (first, stride), Type::Word, last),
            InputData::Floats {
                packets,
                first,
                stride,
            } => Self::new(packets, (first, stride), Type::Word, last),
            InputData::Mask(bits) => Self::new(bits, (0, 1), Type::Mask, last),
            InputData::SharedMask(bits) => Self::new(bits, (0, 1), Type::Mask, last),
            InputData::Uniform(_) | InputData::UniformWords(_) => Self::NOWHERE,
        }
    }

    /// An output's packets.
    #[inline(always)]
    pub(crate) fn of_output(output: &OutputData<'_>, last: usize) -> Self {
        match *output {
            OutputData::Words {
                packets,
                first,
                stride,
            } => Self::new(packets, (first, stride), Type::Word, last),
            OutputData::Floats {
                packets,
                first,
                stride,
            } => Self::new(packets, (first, stride), Type::Word, last),
            OutputData::Mask(bits) => Self::new(bits, (0, 1), Type::Mask, last),
            OutputData::Dropped => Self::NOWHERE,
        }
    }

    /// The address of a packet of a part, and the bytes to the next one, if all packets of the run
    /// are in memory, of the type that is asked for.
    #[inline(always)]
    pub(crate) fn whole_part(
        &self,
        kind: Type,
        first: u32,
        packet: usize,
    ) -> Option<(usize, usize)> {
        let is_whole = self.kind == Some(kind) && (first as usize) < self.whole;
        // A mask has one part, at 0.
        let part = self
            .start
            .wrapping_add(first as usize * bytes_of(Type::Word));
        is_whole.then_some((part.wrapping_add(packet.wrapping_mul(self.step)), self.step))
    }

    /// The address of a packet of a part, if it is in memory, of the type that is asked for.
    pub(crate) fn packet_of_part(&self, kind: Type, first: u32, packet: usize) -> Option<usize> {
        let is_part = self.kind == Some(kind) && (kind == Type::Word || first == 0);
        let of_packet = packet.checked_mul(self.stride)?;
        let element = of_packet.checked_add(first as usize)?;
        let is_inside = is_part && element < self.room;
        is_inside.then(|| self.start + element * bytes_of(kind))
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
