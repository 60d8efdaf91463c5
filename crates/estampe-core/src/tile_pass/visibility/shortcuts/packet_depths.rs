//! Depths of the triangles of a packet in a tile, of all of them at once: quick for the many
//! triangles that something in front hides.

use crate::bounds::primitives::TrianglePacket;
use crate::depth_format::StoredDepth;
use crate::per_sample::compare::prefers_less;
use crate::per_sample::hiz::{greatest_offset, least_offset};
use crate::raster::{SampleSet, TileShape};
use crate::tile_pass::visibility::ONLY_WIDE;
use estampe_simd::{LANES, Lanes, Level, Select, SimdBase, SimdCvtFloat, dispatch, f32x16, i32x16};
use estampe_types::state::CompareFunction;

/// By lane of a packet: depths in a tile.
#[derive(Debug, Clone, Copy)]
pub(super) struct PacketDepths {
    /// Those at the tile's middle.
    pub(super) middle: [f32; LANES],
    /// Those, as they are stored, that no sample of the triangle in the tile is nearer than: of the
    /// plane's nearest corner.
    pub(super) nearest: [f32; LANES],
}

impl PacketDepths {
    pub(super) fn new<const N: usize>(
        level: Level,
        packet: &TrianglePacket,
        (tile, samples): (TileShape, SampleSet<N>),
        (stored, compare): (StoredDepth, CompareFunction),
    ) -> Self {
        let positions = samples.subpixels();
        let is_less = prefers_less(compare);
        let half = tile.side() as f32 * 0.5;
        let last = (tile.side() - 1) as f32;
        // For each axis the tile's middle, and its first and its last sample.
        let places =
            [tile.x as f32, tile.y as f32].map(|start| [start + half, start, start + last]);
        let offsets = |axis| {
            [
                0.0,
                least_offset(&positions, axis),
                greatest_offset(&positions, axis),
            ]
        };
        let places = [0, 1].map(|axis| {
            let offsets = offsets(axis);
            [0, 1, 2].map(|place| places[axis][place] + offsets[place])
        });
        dispatch!(@wide level, s => Self::of_lanes(s, packet, (places, is_less), stored),
            scalar => unreachable!("{ONLY_WIDE}"))
    }

    #[inline(always)]
    fn of_lanes<S: Lanes>(
        s: S,
        packet: &TrianglePacket,
        ([columns, rows], is_less): ([[f32; 3]; 2], bool),
        stored: StoredDepth,
    ) -> Self {
        let load = |lanes: &[f32; LANES]| f32x16::load_array_ref(s, lanes);
        let (dx, dy) = (load(&packet.z.dx), load(&packet.z.dy));
        let x = Distances::new(s, &packet.x[0], columns, (dx, is_less));
        let y = Distances::new(s, &packet.y[0], rows, (dy, is_less));
        let origin = load(&packet.z.origin);
        let middle = origin + (x.middle * dx + y.middle * dy);
        let nearest = origin + (x.nearest * dx + y.nearest * dy);
        Self {
            middle: middle.to_array(),
            nearest: stored.of(s, nearest).to_array(),
        }
    }
}

/// Distances on an axis from the origins of planes. Positions are multiples of 1/256 below 2¹⁶:
/// every sum is exact.
struct Distances<S: Lanes> {
    /// To the tile's middle.
    middle: f32x16<S>,
    /// To where the plane is nearest.
    nearest: f32x16<S>,
}

impl<S: Lanes> Distances<S> {
    /// Those of planes of these slopes, whose origins are these, in 1/256 pixel; given the tile's
    /// middle and its first and last sample.
    #[inline(always)]
    fn new(
        s: S,
        origin: &[i32; LANES],
        [middle, first, last]: [f32; 3],
        (slope, is_less): (f32x16<S>, bool),
    ) -> Self {
        let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
        let origin = f32x16::float_from(i32x16::load_array_ref(s, origin)) * splat(1.0 / 256.0);
        let rises = slope.simd_ge(splat(0.0));
        let [least, greatest] = [splat(first) - origin, splat(last) - origin];
        Self {
            middle: splat(middle) - origin,
            nearest: if is_less {
                rises.select(least, greatest)
            } else {
                rises.select(greatest, least)
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::depth_format::DepthFormat;

    const TILE: TileShape = TileShape {
        x: 64,
        y: 128,
        log2: 6,
    };

    /// Of random planes: no pixel of the tile is nearer than the nearest depth, one at a corner is
    /// as near, and every level finds the same bits.
    #[test]
    fn no_pixel_is_nearer_than_the_nearest_depth() {
        let mut state = 5u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / 16_777_216.0 - 0.5
        };
        let stored = StoredDepth {
            range: [0.0, 1.0],
            format: DepthFormat::Float,
        };
        let samples = SampleSet::<1>::new(1);
        // In 1/256 pixel and in pixels.
        let origin = [90 * 256 + 128, 140 * 256 + 64];
        let [left, top] = origin.map(|at: i32| at as f32 / 256.0);
        for compare in [CompareFunction::Less, CompareFunction::GreaterEqual] {
            let mut packet = TrianglePacket::EMPTY;
            for lane in 0..LANES {
                [packet.x[0][lane], packet.y[0][lane]] = origin;
                packet.z.origin[lane] = random() + 0.5;
                packet.z.dx[lane] = random() / 64.0;
                packet.z.dy[lane] = random() / 64.0;
            }
            let of_level = |level| {
                let depths = PacketDepths::new(level, &packet, (TILE, samples), (stored, compare));
                (depths.middle, depths.nearest)
            };
            let (middle, nearest) = of_level(Level::best());
            for level in Level::all_available()
                .into_iter()
                .filter(|level| !level.is_scalar())
            {
                assert_eq!(of_level(level), (middle, nearest), "{level:?}");
            }
            for lane in 0..LANES {
                let z = packet.z.lane(lane);
                let at = |x: f32, y: f32| z.origin + ((x - left) * z.dx + (y - top) * z.dy);
                assert_eq!(middle[lane], at(96.0, 160.0), "{z:?}");
                let mut nearest_pixel = at(64.5, 128.5).clamp(0.0, 1.0);
                for pixel in 0..64 * 64 {
                    let x = (TILE.x + pixel % 64) as f32 + 0.5;
                    let y = (TILE.y + pixel / 64) as f32 + 0.5;
                    let depth = at(x, y).clamp(0.0, 1.0);
                    nearest_pixel = match prefers_less(compare) {
                        true => nearest_pixel.min(depth),
                        false => nearest_pixel.max(depth),
                    };
                }
                assert_eq!(nearest[lane], nearest_pixel, "{z:?}");
            }
        }
    }
}
