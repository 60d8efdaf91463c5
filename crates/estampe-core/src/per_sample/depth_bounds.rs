//! Hierarchical depth: what a tile's 16×16 blocks hold at most and at least, to reject whole blocks.
//!
//! The bound of a primitive in a block is exact, not estimated: the plane's formula is monotone in X and
//! in Y, rounding included, so its least value over the block is its value at one corner, computed in the
//! same way. Bounds of the stored depths are refreshed lazily: a block that was written is scanned when
//! the next large triangle asks.

use super::depth::{DepthTest, line_mut};
use crate::fragment::interpolate::{DepthPlane, PlaneOrigin, evaluate};
use crate::fragment::queue::clamp_depth;
use crate::tiles::Plane;
use estampe_simd::{LANE_X, LANE_Y, LANES, Lanes, Level, SimdBase, dispatch, f32x16};
use estampe_types::state::CompareFunction;

/// Bounds of the stored depths of a tile's blocks.
#[derive(Debug, Clone)]
pub(crate) struct DepthBounds {
    least: [f32; LANES],
    greatest: [f32; LANES],
    /// Blocks whose bounds are out of date.
    stale: u16,
}

impl Default for DepthBounds {
    fn default() -> Self {
        Self {
            least: [0.0; LANES],
            greatest: [0.0; LANES],
            stale: u16::MAX,
        }
    }
}

impl DepthBounds {
    /// Begins a tile whose depths are all `cleared`, or unknown.
    pub(crate) fn begin(&mut self, cleared: Option<f32>) {
        let depth = cleared.unwrap_or_default();
        self.least = [depth; LANES];
        self.greatest = [depth; LANES];
        self.stale = if cleared.is_some() { 0 } else { u16::MAX };
    }

    /// Notes that blocks were written.
    #[inline(always)]
    pub(crate) fn invalidate(&mut self, blocks: u16) {
        self.stale |= blocks;
    }

    /// The blocks in which no sample of a triangle can pass, one bit each.
    pub(crate) fn hidden<const N: usize>(
        &mut self,
        level: Level,
        test: &DepthTest,
        triangle: &DepthPlane,
        stored: &mut [f32],
    ) -> u16 {
        let nearer_is_less = match test.state.compare {
            CompareFunction::Less | CompareFunction::LessEqual => true,
            CompareFunction::Greater | CompareFunction::GreaterEqual => false,
            CompareFunction::Never => return u16::MAX,
            CompareFunction::Equal | CompareFunction::NotEqual | CompareFunction::Always => {
                return 0;
            }
        };
        dispatch!(level, s => self.hidden_lanes::<_, N>(s, test, triangle, nearer_is_less, stored))
    }

    #[inline(always)]
    fn hidden_lanes<S: Lanes, const N: usize>(
        &mut self,
        s: S,
        test: &DepthTest,
        triangle: &DepthPlane,
        nearer_is_less: bool,
        stored: &mut [f32],
    ) -> u16 {
        self.refresh::<S, N>(s, stored);
        let z = clamp_depth(
            s,
            extreme::<S, N>(s, test, triangle, nearer_is_less),
            test.range,
        );
        let hidden = match test.state.compare {
            CompareFunction::Less => z.simd_ge(f32x16::load_array_ref(s, &self.greatest)),
            CompareFunction::LessEqual => z.simd_gt(f32x16::load_array_ref(s, &self.greatest)),
            CompareFunction::Greater => z.simd_le(f32x16::load_array_ref(s, &self.least)),
            _ => z.simd_lt(f32x16::load_array_ref(s, &self.least)),
        };
        s.bits_of_mask(hidden)
    }

    /// Scans the blocks that are out of date.
    #[inline(always)]
    fn refresh<S: Lanes, const N: usize>(&mut self, s: S, stored: &mut [f32]) {
        let blocks = stored.len() / (256 * N);
        let mut stale = self.stale;
        while stale != 0 {
            let block = stale.trailing_zeros() as usize;
            stale &= stale - 1;
            if block >= blocks {
                continue;
            }
            let first = block * LANES * N;
            let Some(line) = line_mut(stored, first) else {
                continue;
            };
            let mut least = f32x16::load_array_ref(s, line);
            let mut greatest = least;
            for number in first + 1..first + LANES * N {
                if let Some(line) = line_mut(stored, number) {
                    let value = f32x16::load_array_ref(s, line);
                    least = s.min_f32(least, value);
                    greatest = s.max_f32(greatest, value);
                }
            }
            let (least, greatest) = (least.to_array(), greatest.to_array());
            self.least[block] = least.into_iter().fold(f32::INFINITY, f32::min);
            self.greatest[block] = greatest.into_iter().fold(f32::NEG_INFINITY, f32::max);
        }
        self.stale = 0;
    }
}

/// The least (or greatest) depth of a triangle's plane over the samples of each of sixteen blocks.
#[inline(always)]
fn extreme<S: Lanes, const N: usize>(
    s: S,
    test: &DepthTest,
    triangle: &DepthPlane,
    least: bool,
) -> f32x16<S> {
    let Plane { dx, dy, .. } = triangle.z;
    let PlaneOrigin { x: x0, y: y0 } = triangle.origin;
    let positions = crate::raster::sample_positions::<N>();
    // The corner at which the plane is least: the first sample where it rises, the last where it falls.
    let corner = |slope: f32, axis: usize| {
        let offsets = positions.map(|position| position[axis]);
        let (low, high) = offsets.iter().fold((256, 0), |(low, high), &offset| {
            (offset.min(low), offset.max(high))
        });
        let first = (slope >= 0.0) == least;
        if first {
            low as f32 * (1.0 / 256.0)
        } else {
            15.0 + high as f32 * (1.0 / 256.0)
        }
    };
    let distance = |lanes: &[u8; LANES], tile: i32, offset: f32, origin: f32| {
        let mut starts = [0.0; LANES];
        for (start, lane) in starts.iter_mut().zip(lanes) {
            *start = (tile + i32::from(*lane) * 16) as f32;
        }
        // As in `interpolate::coordinate`: the sum of pixel and offset is exact, then one rounding.
        let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
        (f32x16::load_array(s, starts) + splat(offset)) - splat(origin)
    };
    let [tile_x, tile_y] = test.origin;
    let x = distance(&LANE_X, tile_x, corner(dx, 0), x0);
    let y = distance(&LANE_Y, tile_y, corner(dy, 1), y0);
    evaluate(s, &triangle.z, [x, y])
}
