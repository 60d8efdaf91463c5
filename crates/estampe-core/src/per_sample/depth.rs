//! The depth test (O4).

use crate::fragment::interpolate::Surface;
use crate::fragment::queue::{clamp_depth, sample_offsets};
use crate::raster::{CoverageList, packet_origin};
use estampe_simd::{LANES, Lanes, Select, SimdBase, f32x16, mask32x16};
use estampe_types::state::{CompareFunction, DepthState};

/// What a depth test of a primitive needs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DepthTest {
    pub(crate) state: DepthState,
    /// The range that depth is clamped to.
    pub(crate) range: [f32; 2],
    /// The tile's first pixel.
    pub(crate) origin: [i32; 2],
}

/// The lanes in which `new OP stored` holds.
///
/// The choice is made anew for every packet, where a branch predictor finds it; a copy of the loops for
/// each of the eight comparisons, at every level, took the compiler minutes.
#[inline(always)]
pub(crate) fn compare<S: Lanes>(
    s: S,
    function: CompareFunction,
    new: f32x16<S>,
    stored: f32x16<S>,
) -> mask32x16<S> {
    match function {
        CompareFunction::Never => s.mask_from_bits(0),
        CompareFunction::Less => new.simd_lt(stored),
        CompareFunction::Equal => new.simd_eq(stored),
        CompareFunction::LessEqual => new.simd_le(stored),
        CompareFunction::Greater => new.simd_gt(stored),
        CompareFunction::NotEqual => new.simd_ne(stored),
        CompareFunction::GreaterEqual => new.simd_ge(stored),
        CompareFunction::Always => s.mask_from_bits(u16::MAX),
    }
}

/// Tests a primitive's packets before shading, and stores what passes if `writes`; the list keeps the
/// samples that pass. Returns the blocks that were written, one bit each.
#[inline(always)]
pub(crate) fn test_early<S: Lanes, const N: usize>(
    s: S,
    test: &DepthTest,
    writes: bool,
    surface: &impl Surface<S>,
    stored: &mut [f32],
    list: &mut CoverageList<N>,
) -> u16 {
    let offsets = sample_offsets::<N>();
    let mut touched = 0;
    list.retain(
        #[inline(always)]
        |item| {
            let packet = usize::from(item.packet);
            let (x, y) = packet_origin(u32::from(item.packet));
            let pixel = [test.origin[0] + x, test.origin[1] + y];
            for (sample, &offset) in offsets.iter().enumerate() {
                let Some(line) = line_mut(stored, packet * N + sample) else {
                    return;
                };
                let new = clamp_depth(s, surface.depth(s, pixel, offset), test.range);
                let old = f32x16::load_array_ref(s, line);
                let passes =
                    compare(s, test.state.compare, new, old) & s.mask_from_bits(item.masks[sample]);
                if writes {
                    passes.select(new, old).store_array(line);
                }
                item.masks[sample] = s.bits_of_mask(passes);
            }
            touched |= 1u16 << ((packet >> 4) & 15);
        },
    );
    if writes { touched } else { 0 }
}

/// Tests one packet of one sample after shading, and stores what passes if the state says so. Returns
/// the lanes that pass.
#[inline(always)]
pub(crate) fn test_late<S: Lanes>(
    s: S,
    state: DepthState,
    new: f32x16<S>,
    mask: u16,
    line: &mut [f32; LANES],
) -> u16 {
    let old = f32x16::load_array_ref(s, line);
    let passes = compare(s, state.compare, new, old) & s.mask_from_bits(mask);
    if state.write_enabled {
        passes.select(new, old).store_array(line);
    }
    s.bits_of_mask(passes)
}

/// The sixteen values of one packet and sample.
#[inline(always)]
pub(crate) fn line_mut<T>(stored: &mut [T], number: usize) -> Option<&mut [T; LANES]> {
    let from = number * LANES;
    stored.get_mut(from..from + LANES)?.try_into().ok()
}
