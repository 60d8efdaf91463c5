//! Where the inputs and outputs of packets are.

use estampe_ir::Type;
use estampe_ir::interpreter::{InputData, OutputData};

/// Where an input or output of a packet is.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Place {
    /// Nowhere in memory, for all packets.
    Still,
    /// Beyond the end of its slice. Other packets may be inside.
    Outside,
    At(Moving),
}

/// A place in memory that moves from packet to packet.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moving {
    pub(crate) address: usize,
    /// Bytes to the next packet.
    pub(crate) stride: usize,
    /// True if the packets that are left are in the slice, too.
    pub(crate) is_inside: bool,
    /// True if it does not move, nor with the halves of a packet.
    pub(crate) is_still: bool,
}

impl Moving {
    /// A place that does not move.
    pub(crate) fn still(address: usize) -> Self {
        Self {
            address,
            stride: 0,
            is_inside: true,
            is_still: true,
        }
    }
}

/// Element `first + packet · stride` of a slice, and whether the last packet's is there, too.
fn element<T>(slice: &[T], (first, stride): (usize, usize), [packet, last]: [usize; 2]) -> Place {
    let element = |packet: usize| {
        let at = packet.checked_mul(stride)?.checked_add(first)?;
        slice.get(at)
    };
    match element(packet) {
        None => Place::Outside,
        Some(found) => Place::At(Moving {
            address: std::ptr::from_ref(found).expose_provenance(),
            // No overflow where it counts: a packet that far is inside.
            stride: stride.wrapping_mul(size_of::<T>()),
            is_inside: last == packet || element(last).is_some(),
            is_still: false,
        }),
    }
}

/// An input of a packet, for a run up to the last one.
pub(crate) fn of_input(input: &InputData<'_>, kind: Type, packets_of_run: [usize; 2]) -> Place {
    match (*input, kind) {
        (
            InputData::Words {
                packets,
                first,
                stride,
            },
            Type::Word,
        ) => element(packets, (first, stride), packets_of_run),
        (
            InputData::Floats {
                packets,
                first,
                stride,
            },
            Type::Word,
        ) => element(packets, (first, stride), packets_of_run),
        (InputData::Mask(bits), Type::Mask) => element(bits, (0, 1), packets_of_run),
        (InputData::SharedMask(bits), Type::Mask) => element(bits, (0, 1), packets_of_run),
        _ => Place::Still,
    }
}

/// An output of a packet, for a run up to the last one.
pub(crate) fn of_output(output: &OutputData<'_>, kind: Type, packets_of_run: [usize; 2]) -> Place {
    match (*output, kind) {
        (
            OutputData::Words {
                packets,
                first,
                stride,
            },
            Type::Word,
        ) => element(packets, (first, stride), packets_of_run),
        (
            OutputData::Floats {
                packets,
                first,
                stride,
            },
            Type::Word,
        ) => element(packets, (first, stride), packets_of_run),
        (OutputData::Mask(bits), Type::Mask) => element(bits, (0, 1), packets_of_run),
        _ => Place::Still,
    }
}
