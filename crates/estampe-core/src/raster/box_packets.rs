//! The packets of the tile that the boxes of small triangles touch, sixteen boxes at a time.

use super::covered_pixels::spread;
use super::small::SmallBoxes;
use estampe_simd::{LANES, Lanes, Select, SimdBase, u32x16};

impl<const N: usize> SmallBoxes<N> {
    /// The packets of the tile that the boxes in `lanes` touch, by lane, in bytes, and how many
    /// they are: up to four. Of boxes that touch more, and of empty ones, there are none.
    #[inline(always)]
    pub(crate) fn packets<S: Lanes>(&self, s: S, lanes: u16) -> ([u32; LANES], [u32; LANES]) {
        let splat = |value: u32| <u32x16<S> as SimdBase<S>>::splat(s, value);
        let low = splat(0xFFFF);
        let first = u32x16::load_array_ref(s, &self.first.0);
        let last = first + u32x16::load_array_ref(s, &self.extent);
        let columns = ((last & low) >> 2) - ((first & low) >> 2);
        let rows = (last >> 18) - (first >> 18);
        let one = splat(1);
        let is_listed = columns.simd_le(one) & rows.simd_le(one) & s.mask_from_bits(lanes);
        let right = spread(s, (last & low) | (first & !low)) >> 4;
        let below = spread(s, (first & low) | (last & !low)) >> 4;
        let second = columns.simd_eq(one).select(right, below);
        let packets = (spread(s, first) >> 4)
            | (second << 8)
            | (below << 16)
            | ((spread(s, last) >> 4) << 24);
        let count = (columns + one) * (rows + one);
        let count = is_listed.select(count, splat(0));
        (packets.to_array(), count.to_array())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::morton;
    use estampe_simd::{Level, dispatch};

    #[test]
    fn boxes_touch_the_packets_of_their_pixels() {
        let mut state = 5_u32;
        let mut random = |below: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) % below
        };
        let (mut listed, mut larger) = (0, 0);
        for _ in 0..300 {
            let mut boxes = SmallBoxes::<1>::default();
            let mut expected = [const { Vec::new() }; LANES];
            let lanes = u16::try_from(random(1 << 16)).unwrap();
            for (lane, expected) in expected.iter_mut().enumerate() {
                let [x, y] = [random(57), random(57)];
                let [across, down] = [random(8), random(8)];
                boxes.first.0[lane] = x | y << 16;
                boxes.extent[lane] = across | down << 16;
                let is_empty = random(8) == 0;
                if is_empty {
                    boxes.extent[lane] = 0x7FFF_7FFF;
                }
                if lanes >> lane & 1 == 0 || is_empty {
                    continue;
                }
                for row in y / 4..=(y + down) / 4 {
                    for column in x / 4..=(x + across) / 4 {
                        expected.push(morton(column, row));
                    }
                }
                if (x + across) / 4 - x / 4 > 1 || (y + down) / 4 - y / 4 > 1 {
                    expected.clear();
                    larger += 1;
                }
                listed += expected.len();
            }
            for level in Level::all_available() {
                let (packets, counts) = dispatch!(level, s => boxes.packets(s, lanes));
                for (lane, expected) in expected.iter().enumerate() {
                    let packets = packets[lane].to_le_bytes().map(u32::from);
                    assert_eq!(&packets[..counts[lane] as usize], expected, "{level:?}");
                }
            }
        }
        assert!(listed > 1000 && larger > 100, "{listed} {larger}");
    }
}
