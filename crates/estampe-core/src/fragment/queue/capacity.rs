//! How many packets are shaded in one call of the program.
//!
//! A call of a program of text takes as long as a packet or two before it computes anything, so
//! many packets are better than few, as long as what they take in and give out fits the first-level
//! cache.

use estampe_types::Interface;

/// Packets that are shaded in one call, at most.
pub(super) const CAPACITY: usize = 32;

/// Packets that are shaded in one call on the visibility path, where more are no gain: it shades
/// each pixel once, and its own lists want the cache (`many_draws` took 1.08 of its time).
pub(crate) const PACKETS_OF_VISIBILITY: usize = 16;

/// Scalars in and out of a fragment of which [`CAPACITY`] packets take 48 KiB, a first-level cache.
const FEW_SCALARS: usize = 24;

/// Packets that are shaded in one call in order: as many as fit the cache. With 32 in place of 16
/// `foliage` and `ui` take 0.98 of their times.
pub(crate) fn packets_in_order(interface: &Interface) -> usize {
    match interface.fragment_scalars() + interface.colors() * 4 {
        ..=FEW_SCALARS => CAPACITY,
        _ => PACKETS_OF_VISIBILITY,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_types::Interpolation;

    #[test]
    fn programs_with_many_scalars_have_few_packets() {
        for (varyings, packets) in [(0, 32), (20, 32), (21, 16), (60, 16)] {
            let interface = Interface {
                varyings: vec![Interpolation::Smooth; varyings],
                color_targets: 1,
                ..Interface::default()
            };
            assert_eq!(packets_in_order(&interface), packets, "{varyings} varyings");
        }
    }
}
