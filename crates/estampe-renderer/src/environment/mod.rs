//! Light from all around: an image of the surroundings, prepared for surfaces of every roughness.
//!
//! ```text
//! studio | equirectangular      radiance of a direction
//!   -> cube                     an image of six faces, and its mip levels
//!        ├─ specular            convolved with the GGX lobe of each level's roughness
//!        └─ diffuse             spherical harmonics of the cosine-weighted mean
//! directional_albedo            the share of white light that a lobe reflects (split sum)
//! ```
//!
//! The split sum is that of B. Karis, "Real Shading in Unreal Engine 4", 2013: light and
//! reflectance are integrated apart. All of it is computed on the processor, in an order that does
//! not depend on threads, so the same surroundings give the same bits everywhere. Row F4.

mod cube;
mod diffuse;
mod directional_albedo;
mod equirectangular;
mod sampling;
mod specular;
mod studio;

#[cfg(test)]
mod tests;

pub(crate) use directional_albedo::{ALBEDO_SIDE, directional_albedos};

use cube::CubeImage;
use estampe_scene::Workers;
use glam::Vec3;
use std::sync::{Arc, OnceLock};

/// An image of the surroundings, prepared for lighting.
///
/// Its space is right-handed with Y up. A panorama's middle is at +Z; the studio's key light is at
/// −X, +Y, +Z, as seen from a camera at +Z.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvironmentMap {
    /// Radiance convolved with GGX lobes, from roughness 0 to 1.
    specular: Vec<CubeImage>,
    /// Coefficients of the irradiance ÷ π.
    diffuse: [[f32; 3]; 9],
}

/// Why a panorama cannot light a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum EnvironmentError {
    /// The number of values is not that of the size.
    #[error("a panorama of {width}x{height} pixels has {expected} numbers, not {actual}")]
    Size {
        /// Width in pixels.
        width: usize,
        /// Height in pixels.
        height: usize,
        /// Three for each pixel.
        expected: usize,
        /// The numbers that were given.
        actual: usize,
    },
    /// There are no pixels.
    #[error("a panorama has at least one pixel")]
    Empty,
}

impl EnvironmentMap {
    /// The greatest radiance: beyond, a pixel of the sun would be all of the light.
    pub const MAX_RADIANCE: f32 = 65_504.0;

    /// The studio: soft boxes around a grey room. It is made once in a process.
    #[must_use]
    pub fn studio() -> Arc<Self> {
        static STUDIO: OnceLock<Arc<EnvironmentMap>> = OnceLock::new();
        let studio = STUDIO.get_or_init(|| {
            let workers = Workers::default();
            let cube = CubeImage::new(studio::SIDE, studio::radiance, workers);
            Arc::new(Self::from_cube(cube, workers))
        });
        Arc::clone(studio)
    }

    /// The same radiance from everywhere: linear RGB.
    #[must_use]
    pub fn uniform(radiance: [f32; 3]) -> Self {
        let radiance = checked(Vec3::from(radiance));
        let mut diffuse = [[0.0; 3]; 9];
        diffuse[0] = radiance.to_array();
        Self {
            specular: vec![CubeImage::new(1, |_| radiance, Workers::ONE)],
            diffuse,
        }
    }

    /// A panorama in equirectangular projection: linear RGB, rows from the zenith, three numbers a
    /// pixel. Negative numbers and NaN are taken as 0, and numbers above [`Self::MAX_RADIANCE`] as
    /// that.
    ///
    /// # Errors
    /// [`EnvironmentError`] if there are no pixels, or not three numbers for each.
    pub fn from_panorama(
        width: usize,
        height: usize,
        rgb: &[f32],
        workers: Workers,
    ) -> Result<Self, EnvironmentError> {
        let panorama = equirectangular::Panorama::new(width, height, rgb)?;
        let side = panorama.cube_side();
        let cube = CubeImage::new(side, |direction| panorama.radiance(direction), workers);
        Ok(Self::from_cube(cube, workers))
    }

    fn from_cube(cube: CubeImage, workers: Workers) -> Self {
        let levels = cube.levels();
        Self {
            diffuse: diffuse::coefficients(&levels),
            specular: specular::convolved(levels, workers),
        }
    }

    /// The cubes of the levels, from the greatest on: the side, and texels of four floats times a
    /// factor, face after face.
    pub(crate) fn specular_texels(&self, factor: f32) -> Vec<(u32, Vec<u8>)> {
        let levels = self.specular.iter();
        levels.map(|level| level.texels(factor)).collect()
    }

    /// The mean radiance around a unit direction, over some tens of degrees.
    pub(crate) fn blurred(&self, direction: Vec3) -> Vec3 {
        self.specular[self.specular.len() / 2].sample(direction)
    }

    /// Coefficients of the irradiance ÷ π, in the order of [`diffuse::basis`].
    pub(crate) fn diffuse(&self) -> [[f32; 3]; 9] {
        self.diffuse
    }
}

/// A radiance without negative numbers, NaN and what is too great.
fn checked(radiance: Vec3) -> Vec3 {
    // `max` returns the number if the other is NaN.
    radiance
        .max(Vec3::ZERO)
        .min(Vec3::splat(EnvironmentMap::MAX_RADIANCE))
}
