//! The footprint of a pixel in the scalar code: the level of detail, and the probes of anisotropic
//! filtering.
//!
//! Anisotropic filtering is Vulkan's (1.3, *Texel Anisotropic Filtering*; the formula of
//! EXT_texture_filter_anisotropic): the longer of the two derivatives is the footprint's long axis,
//! N probes lie along it, and the level is that of a footprint η times shorter. The axes of the
//! true ellipse (Heckbert 1989) would fit skewed footprints better, but cost one more quadratic
//! equation per quad; no specification asks for them.

use super::{TexelView, cube};
use crate::lod::level_of_detail;
use estampe_types::ViewDimension;
use estampe_types::{Real, SamplerDescriptor};

/// The footprint of a pixel.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Footprint {
    /// λ, before bias and clamps.
    pub(crate) lod: f32,
    /// The number of probes that are averaged.
    pub(crate) probes: u16,
    /// The long axis, as a derivative of the coordinates.
    pub(crate) step: [f32; 3],
}

impl Footprint {
    /// The footprint of a given level of detail: one probe.
    pub(crate) fn of_level(lod: f32) -> Self {
        Self {
            lod,
            probes: 1,
            step: [0.0; 3],
        }
    }

    /// The footprint of the coordinates' derivatives along x and along y.
    pub(crate) fn new(
        view: &TexelView,
        sampler: &SamplerDescriptor,
        at: [f32; 3],
        [dx, dy]: [[f32; 3]; 2],
    ) -> Self {
        let squared = |d: [f32; 3]| squared_length(view, at, d);
        let (x, y) = (squared(dx), squared(dy));
        let is_flat = !matches!(view.dimension, ViewDimension::D1 | ViewDimension::D3);
        if sampler.max_anisotropy <= 1 || !is_flat {
            let rho2 = Real::max(Real::max(x, y), 0.0);
            return Self::of_level(level_of_detail(rho2));
        }
        let (x, y) = (Real::max(x, 0.0), Real::max(y, 0.0));
        let (most, least, step) = if y > x { (y, x, dy) } else { (x, y, dx) };
        let ratio = (most / least).sqrt();
        let ratio = if ratio >= 1.0 {
            Real::min(ratio, f32::from(sampler.max_anisotropy.min(16)))
        } else {
            1.0
        };
        let mut probes = 1;
        while f32::from(probes) < ratio {
            probes += 1;
        }
        Self {
            lod: level_of_detail(most / (ratio * ratio)),
            probes,
            step,
        }
    }
}

/// The squared length of a derivative in texels of the base level.
fn squared_length(view: &TexelView, at: [f32; 3], d: [f32; 3]) -> f32 {
    let size = view.planes[0].size;
    match view.dimension {
        ViewDimension::D1 => {
            let x = d[0] * size[0];
            x * x
        }
        ViewDimension::D2 | ViewDimension::D2Array => {
            let (x, y) = (d[0] * size[0], d[1] * size[1]);
            x * x + y * y
        }
        ViewDimension::Cube | ViewDimension::CubeArray => {
            let [s, t] = cube::project_derivative(at, d, cube::face_of(at));
            let (x, y) = (s * size[0], t * size[1]);
            x * x + y * y
        }
        ViewDimension::D3 => {
            let (x, y, z) = (d[0] * size[0], d[1] * size[1], d[2] * size[2]);
            x * x + y * y + z * z
        }
    }
}
