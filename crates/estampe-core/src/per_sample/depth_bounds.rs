//! Hierarchical depth: what a tile's 16×16 blocks hold at most and at least, to reject whole blocks.
//!
//! The bound of a primitive in a block is exact, not estimated: the plane's formula is monotone in X and
//! in Y, rounding included, so its least value over the block is its value at one corner, computed in the
//! same way. Bounds of the stored depths are refreshed lazily: a block that was written is scanned when
//! the next large triangle asks.

use super::depth::{DepthTest, line_mut};
use super::visibility::{orders, prefers_less};
use crate::fragment::interpolate::{DepthPlane, PlaneOrigin, evaluate};
use crate::fragment::queue::clamp_depth;
use crate::tiles::Plane;
use estampe_simd::{LANE_X, LANE_Y, LANES, Lanes, Level, SimdBase, dispatch, f32x16};
use estampe_types::state::{CompareFunction, DepthState};

/// Bounds of the stored depths of a tile's blocks.
#[derive(Debug, Clone)]
pub(crate) struct DepthBounds {
    least: [f32; LANES],
    greatest: [f32; LANES],
    /// Blocks whose bounds are out of date.
    stale: u16,
}

/// What becomes of a triangle in each block, one bit or value each.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Judgement {
    /// No sample can pass.
    pub(crate) hidden: u16,
    /// Every covered sample passes.
    pub(crate) certain: u16,
    /// The triangle's least and greatest depth, were it to cover the block.
    least: [f32; LANES],
    greatest: [f32; LANES],
}

impl Judgement {
    /// The same for all blocks, nothing being known of depths.
    pub(crate) fn of_all(hidden: u16, certain: u16) -> Self {
        Self {
            hidden,
            certain,
            least: [0.0; LANES],
            greatest: [1.0; LANES],
        }
    }
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

    /// What becomes of a triangle in each block. Where equal depths are not decided by order, `or_equal` says
    /// that they may pass, or not, whatever the comparison.
    pub(crate) fn judge<const N: usize>(
        &mut self,
        level: Level,
        test: &DepthTest,
        triangle: &DepthPlane,
        or_equal: bool,
        stored: &mut [f32],
    ) -> Judgement {
        let compare = match test.state.compare {
            CompareFunction::Less if or_equal => CompareFunction::LessEqual,
            CompareFunction::Greater if or_equal => CompareFunction::GreaterEqual,
            CompareFunction::Never => return Judgement::of_all(u16::MAX, 0),
            CompareFunction::Equal | CompareFunction::NotEqual | CompareFunction::Always => {
                return Judgement::of_all(0, 0);
            }
            other => other,
        };
        let state = DepthState {
            compare,
            ..test.state
        };
        let test = &DepthTest { state, ..*test };
        dispatch!(level, s => self.judge_lanes::<_, N>(s, test, triangle, or_equal, stored))
    }

    /// Whether no sample of a triangle can pass anywhere in the tile. A quick look at the plane's nearest corner,
    /// for the many that something in front hides; false where bounds are out of date.
    #[inline]
    pub(crate) fn hide<const N: usize>(
        &self,
        test: &DepthTest,
        triangle: &DepthPlane,
        or_equal: bool,
        side: i32,
    ) -> bool {
        let compare = test.state.compare;
        if self.stale != 0 || !orders(compare) {
            return false;
        }
        let is_less = prefers_less(compare);
        let DepthPlane { origin, z } = triangle;
        let positions = crate::raster::sample_positions::<N>();
        let nearest = |slope: f32, axis: usize, tile: i32, origin: f32| {
            let sample = if (slope >= 0.0) == is_less {
                least_offset(&positions, axis)
            } else {
                (side - 1) as f32 + greatest_offset(&positions, axis)
            };
            (tile as f32 + sample) - origin
        };
        let [tile_x, tile_y] = test.origin;
        let x = nearest(z.dx, 0, tile_x, origin.x);
        let y = nearest(z.dy, 1, tile_y, origin.y);
        let [low, high] = test.range;
        let depth = z.origin + (x * z.dx + y * z.dy);
        // As lanes are clamped: NaN becomes the lower end.
        let depth = if depth > low { depth } else { low };
        let depth = if depth < high { depth } else { high };
        let strict = or_equal
            || matches!(
                compare,
                CompareFunction::LessEqual | CompareFunction::GreaterEqual
            );
        let blocks = (side / 16 * (side / 16)) as usize;
        if is_less {
            let mut all = self.greatest.iter().take(blocks);
            all.all(|&stored| depth > stored || !strict && depth == stored)
        } else {
            let mut all = self.least.iter().take(blocks);
            all.all(|&stored| depth < stored || !strict && depth == stored)
        }
    }

    #[inline(always)]
    fn judge_lanes<S: Lanes, const N: usize>(
        &mut self,
        s: S,
        test: &DepthTest,
        triangle: &DepthPlane,
        or_equal: bool,
        stored: &mut [f32],
    ) -> Judgement {
        self.refresh::<S, N>(s, stored);
        let least = clamp_depth(s, extreme::<S, N>(s, test, triangle, true), test.range);
        let greatest = clamp_depth(s, extreme::<S, N>(s, test, triangle, false), test.range);
        let stored_least = f32x16::load_array_ref(s, &self.least);
        let stored_greatest = f32x16::load_array_ref(s, &self.greatest);
        let (hidden, mut certain) = match test.state.compare {
            CompareFunction::Less => (
                least.simd_ge(stored_greatest),
                greatest.simd_lt(stored_least),
            ),
            CompareFunction::LessEqual => (
                least.simd_gt(stored_greatest),
                greatest.simd_le(stored_least),
            ),
            CompareFunction::Greater => (
                greatest.simd_le(stored_least),
                least.simd_gt(stored_greatest),
            ),
            _ => (
                greatest.simd_lt(stored_least),
                least.simd_ge(stored_greatest),
            ),
        };
        if or_equal {
            certain = if prefers_less(test.state.compare) {
                greatest.simd_lt(stored_least)
            } else {
                least.simd_gt(stored_greatest)
            };
        }
        Judgement {
            hidden: s.bits_of_mask(hidden),
            certain: s.bits_of_mask(certain),
            least: least.to_array(),
            greatest: greatest.to_array(),
        }
    }

    /// Notes that blocks hold nothing but a judged triangle's depths now.
    #[inline(always)]
    pub(crate) fn replace(&mut self, blocks: u16, judgement: &Judgement) {
        self.stale &= !blocks;
        let mut left = blocks;
        while left != 0 {
            let block = left.trailing_zeros() as usize % LANES;
            left &= left - 1;
            self.least[block] = judgement.least[block];
            self.greatest[block] = judgement.greatest[block];
        }
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
        if (slope >= 0.0) == least {
            least_offset(&positions, axis)
        } else {
            15.0 + greatest_offset(&positions, axis)
        }
    };
    let [tile_x, tile_y] = test.origin;
    let x = distance(s, &LANE_X, (tile_x, corner(dx, 0)), x0);
    let y = distance(s, &LANE_Y, (tile_y, corner(dy, 1)), y0);
    evaluate(s, &triangle.z, [x, y])
}

/// The least offset of a sample in its pixel, on an axis.
#[inline(always)]
fn least_offset<const N: usize>(positions: &[[i32; 2]; N], axis: usize) -> f32 {
    let offsets = positions.iter().map(|position| position[axis]);
    offsets.fold(256, i32::min) as f32 * (1.0 / 256.0)
}

/// The greatest offset of a sample in its pixel, on an axis.
#[inline(always)]
fn greatest_offset<const N: usize>(positions: &[[i32; 2]; N], axis: usize) -> f32 {
    let offsets = positions.iter().map(|position| position[axis]);
    offsets.fold(0, i32::max) as f32 * (1.0 / 256.0)
}

/// The distance of each block's column (or row) at an offset from a plane's origin.
#[inline(always)]
fn distance<S: Lanes>(
    s: S,
    lanes: &[u8; LANES],
    (tile, offset): (i32, f32),
    origin: f32,
) -> f32x16<S> {
    let mut starts = [0.0; LANES];
    for (start, lane) in starts.iter_mut().zip(lanes) {
        *start = (tile + i32::from(*lane) * 16) as f32;
    }
    // Positions are multiples of 1/256 below 2¹⁶: every sum is exact.
    let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
    (f32x16::load_array(s, starts) + splat(offset)) - splat(origin)
}
