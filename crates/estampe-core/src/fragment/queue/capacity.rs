//! How many packets are shaded in one call of the program.
//!
//! A call of a program of text takes as long as a packet or two before it computes anything, and
//! the stages around it have their own loops to begin and to end, so many packets are better than
//! few, as long as what they take in and give out fits the second-level cache beside the tile.

use crate::pipeline::RenderPipeline;
use estampe_simd::Packet;
use estampe_types::Interface;

/// Packets that are shaded in one call, at most. With 64 in place of 32, and of 16 on the
/// visibility path, `postfx` takes 0.93 of its time, `mid_tris` 0.94; 128 are no gain.
pub(super) const CAPACITY: usize = 64;

/// Packets that are shaded in one call at least, however much they take in and give out.
const FEW_PACKETS: usize = 16;

/// The bytes that the inputs and outputs of a call take, beyond which it has fewer packets.
const CALL_BYTES: usize = 128 << 10;

/// The packets that are shaded in one call: as many as fit, by blocks of 16.
pub(crate) fn packets_of_call(interface: &Interface) -> usize {
    let scalars = interface.fragment_scalars() + interface.colors() * 4;
    let packets = CALL_BYTES / size_of::<Packet<f32>>() / scalars.max(1);
    (packets / FEW_PACKETS * FEW_PACKETS).clamp(FEW_PACKETS, CAPACITY)
}

/// The same on the visibility path, whose own lists want the first-level cache: where varyings are
/// the colours, no program is called, and few packets do (with 32 `small_tris` took 1.01 of its
/// time).
pub(crate) fn packets_of_visibility(pipeline: &RenderPipeline) -> usize {
    if pipeline.key().color_passthrough {
        return FEW_PACKETS;
    }
    packets_of_call(pipeline.interface())
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_types::Interpolation;

    #[test]
    fn programs_with_many_scalars_have_few_packets() {
        for (varyings, packets) in [
            (0, 64),
            (28, 64),
            (29, 48),
            (38, 48),
            (60, 32),
            (124, 16),
            (300, 16),
        ] {
            let interface = Interface {
                varyings: vec![Interpolation::Smooth; varyings],
                color_targets: 1,
                ..Interface::default()
            };
            assert_eq!(packets_of_call(&interface), packets, "{varyings} varyings");
        }
    }
}
