//! Sixteen pixels of the target, by column and row.

use estampe_simd::{
    Bytes, LANE_X, LANE_Y, LANES, Lanes, SimdBase, SimdCvtFloat, f32x16, i32x16, u32x16,
};

/// Sixteen pixels of the target: columns and rows.
#[derive(Clone, Copy)]
pub(crate) struct WindowPixels<S: Lanes>(pub(super) [i32x16<S>; 2]);

impl<S: Lanes> WindowPixels<S> {
    /// The packet of 4×4 pixels from one on.
    #[inline(always)]
    pub(crate) fn of_packet(s: S, [x, y]: [i32; 2]) -> Self {
        let steps = |lanes: &[u8; LANES]| {
            let mut steps = [0; LANES];
            let mut lane = 0;
            while lane < LANES {
                steps[lane] = i32::from(lanes[lane]);
                lane += 1;
            }
            i32x16::load_array(s, steps)
        };
        Self([steps(&LANE_X) + x, steps(&LANE_Y) + y])
    }

    /// Four quads, given their first pixels.
    #[inline(always)]
    pub(crate) fn of_quads(s: S, quads: [[i32; 2]; 4]) -> Self {
        let (mut x, mut y) = ([0; LANES], [0; LANES]);
        let mut lane = 0;
        while lane < LANES {
            let [left, top] = quads[lane / 4];
            // The first four lanes of a packet are a quad.
            x[lane] = left + i32::from(LANE_X[lane % 4]);
            y[lane] = top + i32::from(LANE_Y[lane % 4]);
            lane += 1;
        }
        Self([i32x16::load_array(s, x), i32x16::load_array(s, y)])
    }

    /// Pixels of a tile, given by packet·16 + lane, and the tile's first pixel.
    #[inline(always)]
    pub(crate) fn of_places(s: S, places: u32x16<S>, [x, y]: [i32; 2]) -> Self {
        let mask = |bits: u32| <u32x16<S> as SimdBase<S>>::splat(s, bits);
        // Packets and their lanes are in Morton order: even bits are the column's, odd ones the
        // row's. They are drawn together in the two halves of a word.
        let v = (places & mask(0x555)) | ((places & mask(0xAAA)) << 15);
        let v = (v | (v >> 1)) & mask(0x0333_0333);
        let v = (v | (v >> 2)) & mask(0x030F_030F);
        let v = (v | (v >> 4)) & mask(0x003F_003F);
        let column: i32x16<S> = (v & mask(0x3F)).bitcast();
        let row: i32x16<S> = (v >> 16).bitcast();
        Self([column + x, row + y])
    }

    /// The window coordinates of a place in each pixel.
    #[inline(always)]
    pub(crate) fn coordinates(self, [x, y]: [f32; 2]) -> [f32x16<S>; 2] {
        let [column, row] = self.0;
        [f32x16::float_from(column) + x, f32x16::float_from(row) + y]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::packet_origin;
    use estampe_simd::{Level, dispatch};

    #[test]
    fn places_of_a_tile_are_packets_and_their_lanes() {
        for level in Level::all_available() {
            for packet in 0..256_u32 {
                let mut places = [0; LANES];
                for (place, lane) in places.iter_mut().zip(0..) {
                    *place = packet * 16 + lane;
                }
                let (x, y) = packet_origin(packet);
                let [of_places, of_packet] = dispatch!(level, s => {
                    let places = u32x16::load_array(s, places);
                    let of_places = WindowPixels::of_places(s, places, [640, -64]);
                    let of_packet = WindowPixels::of_packet(s, [640 + x, y - 64]);
                    [
                        [of_places.0[0].to_array(), of_places.0[1].to_array()],
                        [of_packet.0[0].to_array(), of_packet.0[1].to_array()],
                    ]
                });
                assert_eq!(of_places, of_packet, "{level:?}, packet {packet}");
            }
        }
    }
}
