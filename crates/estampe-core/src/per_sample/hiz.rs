//! Hierarchical z (HiZ): the least and the greatest depth of each block of 16×16 pixels, to reject
//! or accept blocks.
//!
//! The range of a primitive's depths in a block is exact, not estimated: the plane's formula is
//! monotone in X and in Y, rounding included, so its least value over the block is its value at one
//! corner, computed in the same way; clamping and rounding to fixed point are monotone too. Ranges
//! of stored depths are refreshed lazily: a block that was written is scanned when the next large
//! triangle asks. (Greene, Kass and Miller 1993.)

use super::compare::{extremes, orders, prefers_less};
use super::packet_ranges::PacketRanges;
use super::sample_tests::SampleTests;
use crate::bounds::plane::Plane;
use crate::fragment::interpolate::{DepthPlane, PlaneOrigin, evaluate};
use crate::raster::{SampleSet, TileShape};
use estampe_simd::{LANE_X, LANE_Y, LANES, Lanes, Level, SimdBase, dispatch, f32x16, outline};
use estampe_types::state::CompareFunction;

/// Ranges of the stored depths of a tile's blocks.
#[derive(Debug)]
pub(crate) struct HierarchicalZ {
    least: [f32; LANES],
    greatest: [f32; LANES],
    /// Blocks whose ranges are out of date, one bit each.
    stale: u16,
    /// How many blocks the tile has, and its least and greatest depth, if none is out of date: many
    /// triangles may be hidden in all of the tile.
    blocks: usize,
    tile: [f32; 2],
    /// Ranges of packets.
    pub(crate) packets: PacketRanges,
}

/// The blocks in which a triangle is hidden or certain to pass, one bit each.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BlockClasses {
    /// The triangle changes nothing.
    pub(crate) hidden: u16,
    /// Every covered sample passes.
    pub(crate) certain: u16,
    /// The triangle's least and greatest depth, were it to cover the block.
    least: [f32; LANES],
    greatest: [f32; LANES],
}

impl BlockClasses {
    /// Creates the same classes for all blocks, where no depths are known.
    pub(crate) fn of_all(hidden: u16, certain: u16) -> Self {
        Self {
            hidden,
            certain,
            least: [0.0; LANES],
            greatest: [1.0; LANES],
        }
    }
}

impl Default for HierarchicalZ {
    fn default() -> Self {
        Self {
            least: [0.0; LANES],
            greatest: [0.0; LANES],
            stale: u16::MAX,
            blocks: LANES,
            tile: [0.0; 2],
            packets: PacketRanges::default(),
        }
    }
}

impl HierarchicalZ {
    /// Begins a tile whose depths are all `cleared`, or unknown.
    pub(crate) fn begin(&mut self, tile: TileShape, cleared: Option<f32>) {
        let depth = cleared.unwrap_or_default();
        (self.blocks, self.tile) = (tile.blocks(), [depth; 2]);
        self.least = [depth; LANES];
        self.greatest = [depth; LANES];
        self.stale = if cleared.is_some() { 0 } else { u16::MAX };
        self.packets.invalidate(u16::MAX);
    }

    /// Notes that blocks were written.
    #[inline(always)]
    pub(crate) fn invalidate(&mut self, blocks: u16) {
        self.stale |= blocks;
        self.packets.invalidate(blocks);
    }

    /// Classifies the blocks of a tile for a triangle that is tested in the way of `tests`. Where
    /// order does not decide between equal depths, `or_equal` says that those may pass, or not,
    /// whatever the comparison.
    pub(crate) fn classify<const N: usize>(
        &mut self,
        level: Level,
        look: &HizQuery<'_, N>,
        or_equal: bool,
        stored: &[[f32; LANES]],
    ) -> BlockClasses {
        let compare = match look.tests.depth.map(|state| state.compare) {
            Some(CompareFunction::Less) if or_equal => CompareFunction::LessEqual,
            Some(CompareFunction::Greater) if or_equal => CompareFunction::GreaterEqual,
            Some(CompareFunction::Never) if look.tests.early_failure_is_final() => {
                return BlockClasses::of_all(u16::MAX, 0);
            }
            Some(CompareFunction::Never) => return BlockClasses::of_all(0, 0),
            None
            | Some(CompareFunction::Equal | CompareFunction::NotEqual | CompareFunction::Always) => {
                return BlockClasses::of_all(0, 0);
            }
            Some(other) => other,
        };
        dispatch!(level, s => self.classify_lanes::<_, N>(s, look, (compare, or_equal), stored))
    }

    /// The depth from which on triangles are hidden in all of the tile. Where order does not decide
    /// between equal depths, `or_equal` says that those may pass.
    #[inline]
    pub(crate) fn hidden_from(&self, compare: CompareFunction, or_equal: bool) -> HiddenFrom {
        let is_less = prefers_less(compare);
        let passes_equal = or_equal
            || matches!(
                compare,
                CompareFunction::LessEqual | CompareFunction::GreaterEqual
            );
        let [least, greatest] = self.tile;
        // Bounds that are out of date hide nothing.
        let is_known = self.stale == 0 && orders(compare);
        HiddenFrom {
            depth: match (is_less, is_known) {
                (true, true) => greatest,
                (true, false) => f32::INFINITY,
                (false, true) => least,
                (false, false) => f32::NEG_INFINITY,
            },
            is_less,
            with_equal: is_known && !passes_equal,
        }
    }

    /// Finds the range of the tile, after that of some blocks has changed.
    #[inline(always)]
    fn set_tile_range(&mut self) {
        let blocks = self.least.iter().zip(&self.greatest).take(self.blocks);
        let none = [f32::INFINITY, f32::NEG_INFINITY];
        self.tile = blocks.fold(none, |[low, high], (least, greatest)| {
            [low.min(*least), high.max(*greatest)]
        });
    }

    #[inline(always)]
    fn classify_lanes<S: Lanes, const N: usize>(
        &mut self,
        s: S,
        look: &HizQuery<'_, N>,
        (compare, or_equal): (CompareFunction, bool),
        stored: &[[f32; LANES]],
    ) -> BlockClasses {
        self.refresh(s, look.samples.count(), stored);
        let tests = look.tests;
        let least = tests.stored.of(s, extreme(s, look, true));
        let greatest = tests.stored.of(s, extreme(s, look, false));
        let stored_least = f32x16::load_array_ref(s, &self.least);
        let stored_greatest = f32x16::load_array_ref(s, &self.greatest);
        let (hidden, mut certain) = match compare {
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
            certain = if prefers_less(compare) {
                greatest.simd_lt(stored_least)
            } else {
                least.simd_gt(stored_greatest)
            };
        }
        let (fails, passes) = (s.bits_of_mask(hidden), s.bits_of_mask(certain));
        let if_so = |condition: bool, blocks: u16| if condition { blocks } else { 0 };
        // A hidden triangle may still change stencil values; stencil and depth bounds make nothing
        // certain.
        let failure_is_final = tests.early_failure_is_final();
        BlockClasses {
            hidden: if_so(failure_is_final, fails) | if_so(look.passes_in_vain, passes),
            certain: if_so(tests.is_depth_alone(), passes),
            least: least.to_array(),
            greatest: greatest.to_array(),
        }
    }

    /// Notes that blocks hold nothing but the depths of a triangle that was classified.
    #[inline(always)]
    pub(crate) fn replace(&mut self, blocks: u16, classes: &BlockClasses) {
        self.stale &= !blocks;
        self.packets.invalidate(blocks);
        let mut left = blocks;
        while left != 0 {
            let block = left.trailing_zeros() as usize % LANES;
            left &= left - 1;
            self.least[block] = classes.least[block];
            self.greatest[block] = classes.greatest[block];
        }
        if blocks != 0 {
            self.set_tile_range();
        }
    }

    /// Scans the blocks that are out of date.
    #[inline(always)]
    fn refresh<S: Lanes>(&mut self, s: S, samples: usize, stored: &[[f32; LANES]]) {
        if self.stale == 0 {
            return;
        }
        let blocks = stored.chunks_exact(LANES * samples);
        for (block, lines) in blocks.enumerate() {
            if self.stale >> block & 1 == 0 {
                continue;
            }
            let (mut least, mut greatest) = (
                <f32x16<S> as SimdBase<S>>::splat(s, f32::INFINITY),
                <f32x16<S> as SimdBase<S>>::splat(s, f32::NEG_INFINITY),
            );
            for line in lines {
                let value = f32x16::load_array_ref(s, line);
                least = s.min_f32(value, least);
                greatest = s.max_f32(value, greatest);
            }
            self.least[block] = extremes(&[least.to_array()])[0];
            self.greatest[block] = extremes(&[greatest.to_array()])[1];
        }
        self.stale = 0;
        self.set_tile_range();
    }
}

/// The depth from which on triangles are hidden: see [`HierarchicalZ::hidden_from`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct HiddenFrom {
    depth: f32,
    /// True if lesser depths are nearer.
    is_less: bool,
    /// True if an equal depth is hidden, too.
    with_equal: bool,
}

impl HiddenFrom {
    /// Returns true if no sample of a triangle can pass anywhere in the tile, given the depth, as
    /// it is stored, that none of them is nearer than.
    #[inline(always)]
    pub(crate) fn hides(self, nearest: f32) -> bool {
        let is_behind = if self.is_less {
            nearest > self.depth
        } else {
            nearest < self.depth
        };
        is_behind || self.with_equal && nearest == self.depth
    }
}

/// A triangle in a tile, as hierarchical z looks at it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HizQuery<'a, const N: usize> {
    pub(crate) tests: &'a SampleTests,
    pub(crate) plane: DepthPlane,
    pub(crate) tile: TileShape,
    pub(crate) samples: SampleSet<N>,
    /// True if a sample of the triangle that passes its depth test changes nothing.
    pub(crate) passes_in_vain: bool,
}

/// The least (or greatest) depth of a triangle's plane over the samples of each of sixteen blocks.
#[inline(always)]
fn extreme<S: Lanes, const N: usize>(s: S, look: &HizQuery<'_, N>, least: bool) -> f32x16<S> {
    outline!(s, {
        let Plane { dx, dy, .. } = look.plane.z;
        let PlaneOrigin { x: x0, y: y0 } = look.plane.origin;
        let positions = look.samples.subpixels();
        let (tile_x, tile_y) = (look.tile.x, look.tile.y);
        let [columns, rows] = starts_of_units(s, 16);
        let x = corner(&positions, 0, dx, least, 16);
        let y = corner(&positions, 1, dy, least, 16);
        // Positions are multiples of 1/256 below 2¹⁶: every sum is exact.
        let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
        let x = columns + splat((tile_x as f32 + x) - x0);
        let y = rows + splat((tile_y as f32 + y) - y0);
        evaluate(s, &look.plane.z, [x, y])
    })
}

/// Where in a square of `side` pixels, on an axis, a plane is least (or greatest) at a sample: at
/// the first sample where it rises, at the last where it falls.
#[inline(always)]
pub(super) fn corner<const N: usize>(
    positions: &[[i32; 2]; N],
    axis: usize,
    slope: f32,
    least: bool,
    side: i32,
) -> f32 {
    if (slope >= 0.0) == least {
        least_offset(positions, axis)
    } else {
        (side - 1) as f32 + greatest_offset(positions, axis)
    }
}

/// The least offset of a sample in its pixel, on an axis.
#[inline(always)]
pub(crate) fn least_offset<const N: usize>(positions: &[[i32; 2]; N], axis: usize) -> f32 {
    let offsets = positions.iter().map(|position| position[axis]);
    offsets.fold(256, i32::min) as f32 * (1.0 / 256.0)
}

/// The greatest offset of a sample in its pixel, on an axis.
#[inline(always)]
pub(crate) fn greatest_offset<const N: usize>(positions: &[[i32; 2]; N], axis: usize) -> f32 {
    let offsets = positions.iter().map(|position| position[axis]);
    offsets.fold(0, i32::max) as f32 * (1.0 / 256.0)
}

/// The first column and the first row of each of sixteen squares of `side` pixels.
#[inline(always)]
pub(super) fn starts_of_units<S: Lanes>(s: S, side: u8) -> [f32x16<S>; 2] {
    let (mut columns, mut rows) = ([0.0; LANES], [0.0; LANES]);
    for lane in 0..LANES {
        columns[lane] = f32::from(LANE_X[lane] * side);
        rows[lane] = f32::from(LANE_Y[lane] * side);
    }
    [f32x16::load_array(s, columns), f32x16::load_array(s, rows)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tile_hides_what_is_behind_all_of_its_depths() {
        use CompareFunction::{Always, Greater, GreaterEqual, Less, LessEqual};
        let tile = TileShape {
            x: 64,
            y: 128,
            log2: 6,
        };
        let mut hiz = HierarchicalZ::default();
        let hides = |hiz: &HierarchicalZ, compare, or_equal| {
            let hidden = hiz.hidden_from(compare, or_equal);
            [0.49, 0.5, 0.51].map(|nearest| hidden.hides(nearest))
        };
        hiz.begin(tile, Some(0.5));
        assert_eq!(hides(&hiz, Less, false), [false, true, true]);
        assert_eq!(hides(&hiz, Less, true), [false, false, true]);
        assert_eq!(hides(&hiz, LessEqual, false), [false, false, true]);
        assert_eq!(hides(&hiz, Greater, false), [true, true, false]);
        assert_eq!(hides(&hiz, Greater, true), [true, false, false]);
        assert_eq!(hides(&hiz, GreaterEqual, false), [true, false, false]);
        assert_eq!(hides(&hiz, Always, false), [false; 3]);
        // What was written since is not known.
        hiz.invalidate(1);
        for compare in [Less, LessEqual, Greater, GreaterEqual] {
            assert_eq!(hides(&hiz, compare, false), [false; 3]);
        }
    }
}
