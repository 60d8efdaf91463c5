//! The destination of a shaded packet's sixteen fragments: one packet of the tile, or four quads of
//! different packets.

use super::quad::{QUAD, QUADS};
use estampe_simd::{LANES, Lanes, Select, SimdBase, u32x4, u32x16};

/// The place of sixteen fragments in their tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// A packet of the tile.
    Packet(u16),
    /// Four quads: packet·4 + quad, of each. Quads that hold no fragment repeat another's place.
    Quads([u16; QUADS]),
}

impl Default for Place {
    fn default() -> Self {
        Self::Packet(0)
    }
}

/// The order in which an attachment stores its packets: the samples of a packet follow each other,
/// and so do the words of a sample.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PacketLayout {
    pub(crate) samples: usize,
    /// Words of a texel.
    pub(crate) words: usize,
}

impl PacketLayout {
    /// The index at which one word of one sample of a packet is stored, in packets of sixteen
    /// words.
    #[inline(always)]
    pub(crate) fn line(self, packet: usize, sample: usize, word: usize) -> usize {
        (packet * self.samples + sample) * self.words + word
    }
}

/// The quads' packets, and their lanes' numbers in it.
#[inline(always)]
fn packet_and_lanes(place: u16) -> (usize, std::ops::Range<usize>) {
    let from = usize::from(place) % QUADS * QUAD;
    (usize::from(place) / QUADS, from..from + QUAD)
}

impl Place {
    /// Sixteen words of one sample, in the order of the fragments' lanes.
    #[inline(always)]
    pub(crate) fn load<S: Lanes>(
        self,
        s: S,
        stored: &[[u32; LANES]],
        layout: PacketLayout,
        [sample, word]: [usize; 2],
    ) -> u32x16<S> {
        match self {
            Self::Packet(packet) => {
                let line = layout.line(usize::from(packet), sample, word);
                u32x16::load_array_ref(s, &stored[line])
            }
            Self::Quads(places) => {
                let quad = |place: u16| {
                    let (packet, lanes) = packet_and_lanes(place);
                    u32x4::from_slice(s, &stored[layout.line(packet, sample, word)][lanes])
                };
                let [a, b, c, d] = [
                    quad(places[0]),
                    quad(places[1]),
                    quad(places[2]),
                    quad(places[3]),
                ];
                s.combine_u32x8(s.combine_u32x4(a, b), s.combine_u32x4(c, d))
            }
        }
    }

    /// Stores the lanes of a mask.
    #[inline(always)]
    pub(crate) fn store<S: Lanes>(
        self,
        s: S,
        values: MaskedWords<S>,
        stored: &mut [[u32; LANES]],
        layout: PacketLayout,
        [sample, word]: [usize; 2],
    ) {
        let MaskedWords { new, mask } = values;
        match self {
            Self::Packet(packet) => {
                let line = &mut stored[layout.line(usize::from(packet), sample, word)];
                let old = u32x16::load_array_ref(s, line);
                s.mask_from_bits(mask).select(new, old).store_array(line);
            }
            // Two quads of one place may hold different lanes, so each is stored over what is there
            // by then.
            Self::Quads(places) => {
                let new = new.to_array();
                for (quad, place) in places.into_iter().enumerate() {
                    let masks = &QUAD_MASKS[usize::from(mask >> (quad * QUAD)) % 16];
                    if masks == &QUAD_MASKS[0] {
                        continue;
                    }
                    let (packet, lanes) = packet_and_lanes(place);
                    let to = &mut stored[layout.line(packet, sample, word)][lanes];
                    let new = u32x4::from_slice(s, &new[quad * QUAD..][..QUAD]);
                    let masks = u32x4::load_array_ref(s, masks);
                    let old = u32x4::from_slice(s, to);
                    ((old & !masks) | (new & masks)).store_slice(to);
                }
            }
        }
    }

    /// Four bytes or floats of each quad, or a packet's sixteen, copied out.
    #[inline(always)]
    pub(crate) fn gather<T: Copy + Default>(
        self,
        stored: &[[T; LANES]],
        samples: usize,
        sample: usize,
    ) -> [T; LANES] {
        match self {
            Self::Packet(packet) => stored[usize::from(packet) * samples + sample],
            Self::Quads(places) => {
                let mut out = [T::default(); LANES];
                for (out, place) in out.as_chunks_mut::<QUAD>().0.iter_mut().zip(places) {
                    let (packet, lanes) = packet_and_lanes(place);
                    out.copy_from_slice(&stored[packet * samples + sample][lanes]);
                }
                out
            }
        }
    }

    /// Puts gathered values back in the lanes of a mask.
    #[inline(always)]
    pub(crate) fn scatter<T: Copy>(
        self,
        values: &[T; LANES],
        mask: u16,
        stored: &mut [[T; LANES]],
        samples: usize,
        sample: usize,
    ) {
        match self {
            Self::Packet(packet) => stored[usize::from(packet) * samples + sample] = *values,
            Self::Quads(places) => {
                let quads = values.as_chunks::<QUAD>().0.iter().zip(places);
                for (quad, (values, place)) in quads.enumerate() {
                    let kept = mask >> (quad * QUAD) & 0xF;
                    if kept == 0 {
                        continue;
                    }
                    let (packet, lanes) = packet_and_lanes(place);
                    let to = &mut stored[packet * samples + sample][lanes];
                    // Each lane is written, so that there is no branch for each.
                    for (lane, (to, value)) in to.iter_mut().zip(values).enumerate() {
                        *to = if kept >> lane & 1 == 1 { *value } else { *to };
                    }
                }
            }
        }
    }
}

/// Words to store in the lanes of a mask.
#[derive(Clone, Copy)]
pub(crate) struct MaskedWords<S: Lanes> {
    pub(crate) new: u32x16<S>,
    pub(crate) mask: u16,
}

/// For each mask of four lanes, all bits of the lanes that it has.
const QUAD_MASKS: [[u32; QUAD]; 16] = {
    let mut masks = [[0; QUAD]; 16];
    let mut at = 0;
    while at < 16 * QUAD {
        if (at / QUAD) >> (at % QUAD) & 1 == 1 {
            masks[at / QUAD][at % QUAD] = u32::MAX;
        }
        at += 1;
    }
    masks
};
