//! Alpha tests: whether a fragment has any effect, where the alpha of a texture alone decides it.
//!
//! Most fragments of a leaf or a fence are discarded, once a texture was sampled for them. Where a
//! program discards them for their alpha alone, and the texture is sampled at varyings as they are,
//! an [`AlphaMap`] tells of many of them before: no texel that they can read has an alpha that
//! passes. Such a fragment need not be shaded.

use std::sync::{Arc, Mutex, PoisonError};

/// Cells of a map along a side.
pub const ALPHA_CELLS: usize = 32;

/// Steps of a map for each level of detail.
pub const ALPHA_STEPS: usize = 4;

/// Where the alpha of a texture may pass a test: a bit for each of 32×32 cells of each layer, for
/// each step of the level of detail.
///
/// A bit is set if the greatest alphas that linear filtering at a place in the cell may read, of
/// two mip levels, are mixed to one that passes, at the step's beginning or end. The steps of a
/// level l begin at levels of detail of l + ½·log₂ of 1, 3/2, 2 and 3: the exponent of ρ² and the
/// first bit of its mantissa tell which it is.
#[derive(Debug, Clone, PartialEq)]
pub struct AlphaMap {
    /// Width and height of the base level in texels.
    pub size: [f32; 2],
    /// True if coordinates repeat along u and v; else they are clamped to the edge.
    pub repeats: [bool; 2],
    /// The first and the last step that levels of detail are clamped to, at most 60.
    pub steps: [u32; 2],
    /// The number of layers.
    pub layers: u32,
    /// Rows of cells, bit x of a word: those of a layer follow each other, then layers, then steps
    /// from that of level 0 on.
    pub rows: Vec<u32>,
}

/// What a map of a texture depends on, beside its texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AlphaMapKey {
    /// The code of the greatest alpha that fails.
    pub failing: u8,
    /// As in [`AlphaMap`].
    pub repeats: [bool; 2],
    /// True if two mip levels are mixed; else either is read.
    pub mixes_levels: bool,
    /// As in [`AlphaMap`].
    pub steps: [u32; 2],
    /// Width and height of the base level in texels.
    pub size: [u32; 2],
    /// The first layer, and how many there are.
    pub layers: [u32; 2],
    /// The first mip level's place in the texture, and how many levels there are.
    pub planes: [usize; 2],
}

/// The maps that were made of a texture's texels.
#[derive(Debug, Default)]
pub struct AlphaMaps(Mutex<MadeMaps>);

#[derive(Debug, Default)]
struct MadeMaps {
    /// `None` where there is no map.
    maps: Vec<(AlphaMapKey, Option<Arc<AlphaMap>>)>,
    /// Primitives that were drawn since without a map.
    primitives: usize,
}

impl AlphaMaps {
    /// The most maps that are kept.
    const MOST: usize = 8;

    /// The map of a key. A new one is made once `worth` primitives were drawn without a map since
    /// the last: a threshold that is another in each frame must not have the texture looked through
    /// for each.
    pub fn get(
        &self,
        key: AlphaMapKey,
        (primitives, worth): (usize, usize),
        make: impl FnOnce() -> Option<AlphaMap>,
    ) -> Option<Arc<AlphaMap>> {
        let mut made = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, map)) = made.maps.iter().find(|(of, _)| *of == key) {
            return map.clone();
        }
        made.primitives = made.primitives.saturating_add(primitives);
        if made.primitives < worth {
            return None;
        }
        let map = make().map(Arc::new);
        if made.maps.len() == Self::MOST {
            made.maps.remove(0);
        }
        made.maps.push((key, map.clone()));
        made.primitives = 0;
        map
    }
}

/// The alpha test of a program with its bindings: fragments for which it fails have no effect.
#[derive(Debug, Clone, PartialEq)]
pub struct AlphaTest {
    /// The code of the greatest alpha that fails, of eight bits.
    pub failing: u8,
    /// Where alpha may pass.
    pub map: Arc<AlphaMap>,
    /// The scalars of the varyings that are the coordinates u and v.
    pub at: [usize; 2],
    /// The scalar that is the layer, as the bits of a signed integer.
    pub layer: Option<usize>,
    /// True if the level of detail comes from the differences inside a quad, and a quad has an
    /// effect unless the test fails in all four; false if it comes from the derivatives of the
    /// coordinates at the fragment.
    pub of_quads: bool,
}

/// What is known of a draw when its alpha test is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AlphaTestRequest {
    /// True if the alpha of the first colour selects samples, of which there are four at most.
    pub to_coverage: bool,
    /// Primitives that are drawn: a map is made when it is likely to be worth it.
    pub primitives: usize,
}
