//! Colours of primitives over which nothing varies, kept from tile to tile of a pass.
//!
//! A panel lies in several tiles, and in each of them its colour would be shaded once, alone: a
//! call of the program for one packet costs as much as for several. A colour depends on the
//! varyings, the face, and what the draw binds, which does not change in a pass unless a shader
//! stores. With a colour its [blending](SolidBlend) is kept.

use crate::per_sample::solid_blend::SolidBlend;
use estampe_simd::Packet;

/// The colours that are kept, at most. Others take their places.
const MOST: usize = 64;

/// Colours of one pipeline with the same bindings, each in the place of a hash of its varyings.
#[derive(Debug, Default)]
pub(super) struct SolidColors {
    /// The sub-draw whose pipeline and bindings they are of.
    sub_draw: Option<u32>,
    /// Words of a key: the face, then the varyings.
    words: usize,
    /// Packets of a colour.
    packets: usize,
    /// By place: the keys, and the colours. Places that no key belongs to hold [`NONE`].
    keys: Vec<u32>,
    colors: Vec<Packet<f32>>,
    blending: Vec<Blending>,
}

/// How a colour is blended into the draw's target.
#[derive(Debug, Clone, Copy, Default)]
pub(super) enum Blending {
    /// Nobody asked.
    #[default]
    Unknown,
    Line(SolidBlend),
    /// By the formula.
    Formula,
}

/// A colour that is kept.
#[derive(Debug, Clone, Copy)]
pub(super) struct KeptColor<'a> {
    pub(super) color: &'a [Packet<f32>],
    pub(super) blending: Blending,
}

/// The face of a key that is none.
const NONE: u32 = 2;

/// The place of a key, to be looked up or to be filled.
#[derive(Debug, Clone, Copy)]
pub(super) struct KeyPlace(usize);

impl SolidColors {
    /// Forgets all colours.
    pub(super) fn clear(&mut self) {
        self.sub_draw = None;
    }

    /// The sub-draw whose pipeline and bindings the colours are of.
    pub(super) fn sub_draw(&self) -> Option<u32> {
        self.sub_draw
    }

    /// Begins with colours of a sub-draw, of so many varyings, each of so many packets.
    pub(super) fn begin(&mut self, sub_draw: u32, varyings: usize, packets: usize) {
        self.sub_draw = Some(sub_draw);
        (self.words, self.packets) = (varyings + 1, packets);
        self.keys.clear();
        self.keys.resize(MOST * self.words, NONE);
        self.colors.resize(MOST * packets, Packet::default());
        self.blending.resize(MOST, Blending::Unknown);
    }

    /// The place of a colour, and the colour if it is known.
    #[inline(always)]
    pub(super) fn find(&self, varyings: &[f32], front: bool) -> (KeyPlace, Option<KeptColor<'_>>) {
        let mut hash = u64::from(front);
        for varying in varyings {
            hash = (hash ^ u64::from(varying.to_bits())).wrapping_mul(0x9E37_79B9_7F4A_7C15);
            hash ^= hash >> 29;
        }
        // The upper bits depend on all of the key.
        let place = (hash.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 58) as usize % MOST;
        let key = self.keys.get(place * self.words..).unwrap_or_default();
        let is_found = self.sub_draw.is_some()
            && key.first() == Some(&u32::from(front))
            && varyings.len() + 1 == self.words
            && key[1..]
                .iter()
                .zip(varyings)
                .all(|(a, b)| *a == b.to_bits());
        let found = is_found.then(|| KeptColor {
            color: &self.colors[place * self.packets..][..self.packets],
            blending: self.blending[place],
        });
        (KeyPlace(place), found)
    }

    /// Keeps a colour in the place of its key.
    pub(super) fn keep(
        &mut self,
        KeyPlace(place): KeyPlace,
        (varyings, front): (&[f32], bool),
        color: &[Packet<f32>],
    ) {
        if self.sub_draw.is_none()
            || varyings.len() + 1 != self.words
            || color.len() != self.packets
        {
            return;
        }
        let key = &mut self.keys[place * self.words..][..self.words];
        key[0] = u32::from(front);
        for (to, varying) in key[1..].iter_mut().zip(varyings) {
            *to = varying.to_bits();
        }
        self.colors[place * self.packets..][..self.packets].copy_from_slice(color);
        self.blending[place] = Blending::Unknown;
    }

    /// Keeps the blending of the colour that was kept or found in a place.
    pub(super) fn keep_blending(&mut self, KeyPlace(place): KeyPlace, blending: Blending) {
        if self.sub_draw.is_some() {
            self.blending[place] = blending;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_simd::LANES;

    #[test]
    fn colors_are_found_by_all_of_their_varyings() {
        let mut colors = SolidColors::default();
        let color_of = |varyings: &[f32; 2]| [Packet([varyings[0] * 100.0 + varyings[1]; LANES])];
        let (place, found) = colors.find(&[0.0, 1.0], true);
        assert!(found.is_none());
        colors.keep(place, (&[0.0, 1.0], true), &color_of(&[0.0, 1.0]));
        assert!(colors.find(&[0.0, 1.0], true).1.is_none(), "of no draw");
        colors.begin(7, 2, 1);
        assert_eq!(colors.sub_draw(), Some(7));
        let mut kept = 0;
        for number in 0..2000_u16 {
            let varyings = [f32::from(number % 20), f32::from(number % 7)];
            let color = color_of(&varyings);
            let (place, found) = colors.find(&varyings, number % 2 == 0);
            match found {
                Some(found) => {
                    assert_eq!(found.color, color);
                    kept += 1;
                }
                None => colors.keep(place, (&varyings, number % 2 == 0), &color),
            }
        }
        assert!(kept > 100, "{kept} of 2000");
        let (place, _) = colors.find(&[0.0, 1.0], true);
        colors.keep(place, (&[0.0, 1.0], true), &color_of(&[0.0, 1.0]));
        assert!(colors.find(&[0.0, 1.0], true).1.is_some());
        assert!(colors.find(&[-0.0, 1.0], true).1.is_none());
        assert!(colors.find(&[0.0, 1.0], false).1.is_none());
        colors.begin(8, 2, 1);
        assert!(colors.find(&[0.0, 1.0], true).1.is_none());
    }
}
