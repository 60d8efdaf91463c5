//! Layers against the formula of docs/NUMERICS.md, one pixel and one operation at a time.

use super::*;
use crate::bounds::plane::Plane;
use crate::fragment::interpolate::PlaneOrigin;
use crate::layout::{TileGrid, morton};
use estampe_simd::{Level, dispatch};

const TILE: TileShape = TileShape {
    x: 128,
    y: 64,
    log2: 6,
};

/// Pseudo-random numbers.
struct Noise(u32);

impl Noise {
    fn word(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        self.0 ^ self.0 >> 15
    }

    /// A number from 0 to 1, often one of few.
    fn unit(&mut self) -> f32 {
        match self.word() % 4 {
            0 => (self.word() % 3) as f32 * 0.5,
            1 => (self.word() % 256) as f32 / 255.0,
            _ => (self.word() >> 8) as f32 / 16_777_215.0,
        }
    }

    /// A plane whose values right of and below its origin are from 0 to 1, or now and then beyond.
    fn plane(&mut self, is_level: bool) -> Plane {
        let origin = self.unit();
        if is_level {
            return Plane {
                origin,
                dx: 0.0,
                dy: 0.0,
            };
        }
        let scale = if self.word().is_multiple_of(8) {
            1.0 / 64.0
        } else {
            1.0 / 512.0
        };
        let mut slope = || (self.unit() - origin) * scale;
        Plane {
            origin,
            dx: slope(),
            dy: slope(),
        }
    }

    fn colors(&mut self) -> ColorPlanes {
        let is_flat = self.word().is_multiple_of(4);
        let has_one_alpha = is_flat || self.word().is_multiple_of(2);
        ColorPlanes {
            origin: PlaneOrigin {
                x: 100.0 + (self.word() % 7000) as f32 / 256.0,
                y: 36.0 + (self.word() % 7000) as f32 / 256.0,
            },
            channels: [
                self.plane(is_flat),
                self.plane(is_flat),
                self.plane(is_flat),
                self.plane(has_one_alpha),
            ],
        }
    }
}

/// One texel blended with one layer.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "codes are from 0 to 255"
)]
fn blended(colors: &ColorPlanes, [x, y]: [i32; 2], below: u32) -> u32 {
    let x = x as f32 + 0.5 - colors.origin.x;
    let y = y as f32 + 0.5 - colors.origin.y;
    let [r, g, b, alpha] = colors.channels.map(|plane| {
        let value = plane.origin + (x * plane.dx + y * plane.dy);
        value.clamp(0.0, 1.0)
    });
    let below = |channel: u32| (below >> (8 * channel) & 0xFF) as f32 * (1.0 / 255.0);
    let code = |value: f32| (value.clamp(0.0, 1.0) * 255.0 + 0.5).floor() as u32;
    let rest = 1.0 - alpha;
    code(r * alpha + below(0) * rest)
        | code(g * alpha + below(1) * rest) << 8
        | code(b * alpha + below(2) * rest) << 16
        | code(alpha + below(3) * rest) << 24
}

#[test]
fn layers_are_the_formula_of_each_pixel() {
    let grid = TileGrid::new(64, 64, 1);
    let mut noise = Noise(1);
    let mut sums = LayerCounts::default();
    // Kept from round to round, as a tile's are for the next one.
    let mut layers = Layers::default();
    for round in 0..40 {
        let opaque = if round % 2 == 0 { 0xFF00_0000 } else { 0 };
        let texels: Vec<u32> = (0..4096).map(|_| noise.word() | opaque).collect();
        let count = 1 + noise.word() as usize % MOST;
        let colors: Vec<_> = (0..count).map(|_| noise.colors()).collect();
        let mut wanted = texels.clone();
        let mut masks = Vec::new();
        for colors in &colors {
            let mut of_layer = [[u16::MAX; LANES]; LANES];
            for mask in of_layer.as_flattened_mut() {
                let bits = (noise.word() & 0xFFFF) as u16;
                *mask = [0, bits, u16::MAX, u16::MAX][noise.word() as usize % 4];
            }
            for whole in of_layer.iter_mut().step_by(1 + noise.word() as usize % 3) {
                *whole = [u16::MAX; LANES];
            }
            for (x, y) in (0..64).flat_map(|y| (0..64).map(move |x| (x, y))) {
                let at = grid.packet_of(x, y) * LANES + morton(x % 4, y % 4) as usize;
                if of_layer[at / 256][at / LANES % LANES] >> (at % LANES) & 1 == 1 {
                    let pixel = [TILE.x + x.cast_signed(), TILE.y + y.cast_signed()];
                    wanted[at] = blended(colors, pixel, wanted[at]);
                }
            }
            masks.push(of_layer);
        }
        for level in Level::all_available() {
            if level.is_scalar() {
                continue;
            }
            let mut stored = texels.clone();
            for (colors, masks) in colors.iter().zip(&masks) {
                layers.begin(*colors, TILE);
                for (block, masks) in (0_u16..).zip(masks) {
                    match noise.word() % 2 {
                        0 => layers.add_tested(block.into(), masks),
                        _ => {
                            let packets = (0..).map(|packet| block * 16 + packet).zip(masks);
                            for (packet, mask) in packets.filter(|(_, mask)| **mask != 0) {
                                layers.add_packet(packet, *mask);
                            }
                        }
                    }
                }
            }
            let stored_lines = stored.as_chunks_mut::<LANES>().0;
            let counts = dispatch!(@wide level, s => layers.blend(s, TILE, stored_lines, || ()),
                scalar => unreachable!("left out"));
            assert!(stored == wanted, "round {round}, {level:?}");
            sums.packets += counts.packets;
            sums.layers += counts.layers;
            sums.exact += counts.exact;
        }
    }
    // Both ways are taken, and several layers at a time.
    assert!(sums.layers > sums.packets * 2, "{sums:?}");
    assert!(sums.exact > sums.layers / 100, "{sums:?}");
    assert!(sums.exact < sums.layers * 3 / 4, "{sums:?}");
}
