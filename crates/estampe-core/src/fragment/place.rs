//! The destination of a shaded packet's sixteen fragments: one packet of the tile, four quads of
//! different packets, or sixteen pixels anywhere.

use super::fill::LANE_NUMBERS;
use super::quad::{QUAD, QUADS};
use crate::pipeline::color_target::MAX_WORDS;
use estampe_simd::{
    Bytes, LANES, Lanes, Select, SimdBase, bits_of, bits_of_mut, f32x16, outline, u32x4, u32x16,
};
use std::hint::select_unpredictable;

/// The place of sixteen fragments in their tile.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Place {
    /// A packet of the tile.
    Packet(u16),
    /// Four quads: packet·4 + quad, of each. Quads that hold no fragment repeat another's place.
    Quads([u16; QUADS]),
    /// Sixteen pixels: packet·16 + lane, of each. Those that are in a mask are different ones.
    Pixels([u16; LANES]),
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

/// A pixel's packet, and its lane in it.
#[inline(always)]
fn packet_and_lane(place: u16) -> (usize, usize) {
    (usize::from(place) / LANES, usize::from(place) % LANES)
}

/// [`indices_of`] places that are stored in 16 bits.
#[inline(always)]
fn pixel_indices<S: Lanes>(s: S, places: &[u16; LANES], lines: usize, line: usize) -> u32x16<S> {
    indices_of(s, s.widen(places), [lines, line])
}

/// The indices of sixteen pixels' words in an attachment, given where they are (packet·16 + lane),
/// the lines of a packet, and the first packet's line.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "a tile has fewer lines")]
pub(crate) fn indices_of<S: Lanes>(
    s: S,
    places: u32x16<S>,
    [lines, line]: [usize; 2],
) -> u32x16<S> {
    let lane = places & <u32x16<S> as SimdBase<S>>::splat(s, LANES as u32 - 1);
    (places - lane) * (lines as u32) + (lane + (line * LANES) as u32)
}

impl Place {
    /// Sixteen pixels: packet·16 + lane, of each.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "a tile has 4096 pixels")]
    pub(crate) fn of_pixels(pixels: &[u32; LANES]) -> Self {
        let mut places = [0; LANES];
        for (to, pixel) in places.iter_mut().zip(pixels) {
            *to = *pixel as u16;
        }
        Self::Pixels(places)
    }

    /// Four quads, given by their pixels: packet·16 + lane, of each.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "a tile has 4096 pixels")]
    pub(crate) fn of_quads(pixels: &[u32; LANES]) -> Self {
        let quad = |number: usize| (pixels[number * QUAD] / QUAD as u32) as u16;
        Self::Quads([quad(0), quad(1), quad(2), quad(3)])
    }

    /// The pixel of each fragment: packet·16 + lane.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "16, and four")]
    pub(crate) fn pixels<S: Lanes>(&self, s: S) -> u32x16<S> {
        let mut pixels = LANE_NUMBERS;
        match *self {
            Self::Packet(packet) => {
                for pixel in &mut pixels {
                    *pixel += u32::from(packet) * LANES as u32;
                }
            }
            Self::Quads(ref places) => {
                for (pixels, place) in pixels.as_chunks_mut::<QUAD>().0.iter_mut().zip(places) {
                    for (pixel, lane) in pixels.iter_mut().zip(0..) {
                        *pixel = u32::from(*place) * QUAD as u32 + lane;
                    }
                }
            }
            Self::Pixels(ref places) => return s.widen(places),
        }
        u32x16::load_array(s, pixels)
    }

    /// The indices of the fragments' first words in an attachment, if they are pixels anywhere.
    #[inline(always)]
    pub(crate) fn indices<S: Lanes>(&self, s: S, layout: PacketLayout) -> u32x16<S> {
        match self {
            Self::Pixels(places) => pixel_indices(s, places, layout.line(1, 0, 0), 0),
            _ => u32x16::splat(s, 0),
        }
    }

    /// The words of one sample's texels, in the order of the fragments' lanes, given the
    /// [indices](Self::indices).
    #[inline(always)]
    pub(crate) fn load<S: Lanes>(
        &self,
        s: S,
        stored: &[[u32; LANES]],
        (layout, sample): (PacketLayout, usize),
        indices: u32x16<S>,
    ) -> Texels<S> {
        let mut words = [<u32x16<S> as SimdBase<S>>::splat(s, 0); MAX_WORDS];
        match *self {
            Self::Packet(packet) => {
                let first = layout.line(usize::from(packet), sample, 0);
                for (word, line) in words.iter_mut().zip(&stored[first..][..layout.words]) {
                    *word = u32x16::load_array_ref(s, line);
                }
            }
            Self::Quads(ref places) => {
                for (number, word) in words.iter_mut().enumerate().take(layout.words) {
                    let quad = |place: u16| {
                        let (packet, lanes) = packet_and_lanes(place);
                        u32x4::from_slice(s, &stored[layout.line(packet, sample, number)][lanes])
                    };
                    let [a, b, c, d] = [
                        quad(places[0]),
                        quad(places[1]),
                        quad(places[2]),
                        quad(places[3]),
                    ];
                    *word = s.combine_u32x8(s.combine_u32x4(a, b), s.combine_u32x4(c, d));
                }
            }
            Self::Pixels(_) => outline!(s, {
                let stored = stored[layout.line(0, sample, 0)..].as_flattened();
                match layout.words {
                    1 => [words[0]] = s.gather_lines(stored, indices),
                    2 => [words[0], words[1]] = s.gather_lines(stored, indices),
                    _ => words = s.gather_lines(stored, indices),
                }
            }),
        }
        words
    }

    /// Stores the lanes of a mask, given the [indices](Self::indices).
    #[inline(always)]
    pub(crate) fn store<S: Lanes>(
        &self,
        s: S,
        (texels, mask): (&Texels<S>, u16),
        stored: &mut [[u32; LANES]],
        (layout, sample): (PacketLayout, usize),
        indices: u32x16<S>,
    ) {
        let texels = &texels[..layout.words];
        match *self {
            Self::Packet(packet) => {
                let first = layout.line(usize::from(packet), sample, 0);
                let mask = s.mask_from_bits(mask);
                for (new, line) in texels.iter().zip(&mut stored[first..][..layout.words]) {
                    let old = u32x16::load_array_ref(s, line);
                    mask.select(*new, old).store_array(line);
                }
            }
            // Two quads of one place may hold different lanes, so each is stored over what is there
            // by then.
            Self::Quads(ref places) => {
                for (word, new) in texels.iter().enumerate() {
                    let new = new.to_array();
                    for (quad, &place) in places.iter().enumerate() {
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
            Self::Pixels(_) => outline!(s, {
                let stored = stored[layout.line(0, sample, 0)..].as_flattened_mut();
                match *texels {
                    [a] => s.scatter_lines(stored, indices, [a], mask),
                    [a, b] => s.scatter_lines(stored, indices, [a, b], mask),
                    _ => {
                        for (word, &texels) in texels.iter().enumerate() {
                            let stored = &mut stored[word * LANES..];
                            s.scatter(stored, indices, texels, mask);
                        }
                    }
                }
            }),
        }
    }

    /// The depths of all samples, in the order of the fragments' lanes.
    #[inline(always)]
    pub(crate) fn depths<S: Lanes, const N: usize>(
        &self,
        s: S,
        stored: &[[f32; LANES]],
        samples: usize,
        depths: &mut [[f32; LANES]; N],
    ) {
        match *self {
            Self::Pixels(ref places) if const { N <= 4 } => outline!(s, {
                let stored = bits_of(stored.as_flattened());
                let indices = pixel_indices(s, places, samples, 0);
                let words: [u32x16<S>; N] = s.gather_lines(stored, indices);
                for (sample, depths) in depths.iter_mut().enumerate() {
                    let of_sample: f32x16<S> = words[sample].bitcast();
                    of_sample.store_array(depths);
                }
            }),
            _ => {
                for (sample, depths) in depths.iter_mut().enumerate().take(samples) {
                    *depths = self.gather(stored, samples, sample);
                }
            }
        }
    }

    /// Puts the depths of all samples back, each in the lanes of a mask.
    #[inline(always)]
    pub(crate) fn set_depths<S: Lanes, const N: usize>(
        &self,
        s: S,
        (depths, masks): (&[[f32; LANES]; N], &[u16; N]),
        stored: &mut [[f32; LANES]],
        samples: usize,
    ) {
        match *self {
            // Lanes outside a mask have what is stored, and all are of different pixels.
            Self::Pixels(ref places) if const { N <= 4 } => outline!(s, {
                let indices = pixel_indices(s, places, samples, 0);
                let mut words = [<u32x16<S> as SimdBase<S>>::splat(s, 0); N];
                let mut any = 0;
                for (sample, words) in words.iter_mut().enumerate() {
                    *words = f32x16::load_array_ref(s, &depths[sample]).bitcast();
                    any |= masks[sample];
                }
                let stored = bits_of_mut(stored.as_flattened_mut());
                s.scatter_lines(stored, indices, words, any);
            }),
            _ => {
                for (sample, depths) in depths.iter().enumerate().take(samples) {
                    self.scatter(depths, masks[sample], stored, samples, sample);
                }
            }
        }
    }

    /// A value of each fragment's pixel, copied out.
    #[inline(always)]
    pub(crate) fn gather<T: Copy + Default>(
        &self,
        stored: &[[T; LANES]],
        samples: usize,
        sample: usize,
    ) -> [T; LANES] {
        let mut out = [T::default(); LANES];
        match *self {
            Self::Packet(packet) => out = stored[usize::from(packet) * samples + sample],
            Self::Quads(ref places) => {
                for (out, place) in out.as_chunks_mut::<QUAD>().0.iter_mut().zip(places) {
                    let (packet, lanes) = packet_and_lanes(*place);
                    out.copy_from_slice(&stored[packet * samples + sample][lanes]);
                }
            }
            Self::Pixels(ref places) => {
                for (out, place) in out.iter_mut().zip(places) {
                    let (packet, lane) = packet_and_lane(*place);
                    *out = stored[packet * samples + sample][lane];
                }
            }
        }
        out
    }

    /// Puts gathered values back in the lanes of a mask.
    #[inline(always)]
    pub(crate) fn scatter<T: Copy>(
        &self,
        values: &[T; LANES],
        mask: u16,
        stored: &mut [[T; LANES]],
        samples: usize,
        sample: usize,
    ) {
        match *self {
            Self::Packet(packet) => stored[usize::from(packet) * samples + sample] = *values,
            Self::Quads(ref places) => {
                let quads = values.as_chunks::<QUAD>().0.iter().zip(places);
                for (quad, (values, place)) in quads.enumerate() {
                    let kept = mask >> (quad * QUAD) & 0xF;
                    if kept == 0 {
                        continue;
                    }
                    let (packet, lanes) = packet_and_lanes(*place);
                    let to = &mut stored[packet * samples + sample][lanes];
                    // Each lane is written, so that there is no branch for each.
                    for (lane, (to, value)) in to.iter_mut().zip(values).enumerate() {
                        *to = if kept >> lane & 1 == 1 { *value } else { *to };
                    }
                }
            }
            Self::Pixels(ref places) => {
                for (at, (place, value)) in places.iter().zip(values).enumerate() {
                    let (packet, lane) = packet_and_lane(*place);
                    let to = &mut stored[packet * samples + sample][lane];
                    *to = select_unpredictable(mask >> at & 1 == 1, *value, *to);
                }
            }
        }
    }

    /// Returns true if one of the fragments in a mask is among some pixels, given by packet.
    #[inline(always)]
    pub(crate) fn overlaps(&self, mask: u16, pixels_of: impl Fn(usize) -> u16) -> bool {
        let quads = |places: &[u16; QUADS]| {
            places.iter().enumerate().fold(0, |both, (quad, &place)| {
                let (packet, lanes) = packet_and_lanes(place);
                both | mask >> (quad * QUAD) & 0xF & pixels_of(packet) >> lanes.start
            })
        };
        let pixels = |places: &[u16; LANES]| {
            places.iter().enumerate().fold(0, |both, (at, &place)| {
                let (packet, lane) = packet_and_lane(place);
                both | mask >> at & 1 & pixels_of(packet) >> lane
            })
        };
        let both = match *self {
            Self::Packet(packet) => mask & pixels_of(usize::from(packet)),
            Self::Quads(ref places) => quads(places),
            Self::Pixels(ref places) => pixels(places),
        };
        both != 0
    }

    /// The blocks of 16×16 pixels in which the fragments lie, one bit each.
    #[inline(always)]
    pub(crate) fn blocks(&self) -> u16 {
        match *self {
            Self::Packet(packet) => 1 << (packet >> 4 & 15),
            Self::Quads(ref places) => places
                .iter()
                .fold(0, |all, place| all | 1 << (place >> 6 & 15)),
            Self::Pixels(ref places) => places
                .iter()
                .fold(0, |all, place| all | 1 << (place >> 8 & 15)),
        }
    }
}

/// Words of sixteen texels, of which a format uses the first.
pub(crate) type Texels<S> = [u32x16<S>; MAX_WORDS];

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
