//! Sampling of texture views of every dimension and format, texel by texel.
//!
//! In · Out: coordinates of one lane, or derivatives of a quad · filtered values, results of
//! comparisons, gathered or fetched texels. Precision: f32 in the order of NUMERICS.md, *Textures*.

mod filter;
mod texels;

use super::cube;
use super::log2;
use super::texel::TexelReader;
use crate::arithmetic::{clamp, max, min};
use estampe_types::shader::Sample2d;
use estampe_types::{
    Real, SamplerDescriptor, TexelData, TextureAspect, TextureDimension, Vec2, Vec4, ViewDimension,
};
use std::sync::Arc;

/// A texture view and its sampler.
#[derive(Debug, Clone)]
pub struct ReferenceView {
    /// The texture.
    pub texture: Arc<TexelData>,
    /// The dimension of the view.
    pub dimension: ViewDimension,
    /// The first mip level and the number of levels.
    pub levels: [usize; 2],
    /// The first layer and the number of layers (six for each cube).
    pub layers: [u32; 2],
    /// The aspect of a depth-stencil texture that is read.
    pub aspect: TextureAspect,
    /// Addressing, filtering and comparison.
    pub sampler: SamplerDescriptor,
}

/// The coordinates, level of detail and footprint of one lane's sample.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// (u, v, w), or the direction for cubes.
    pub at: [f32; 3],
    /// The array layer, or the number of the cube.
    pub layer: i32,
    /// λ with its bias, before it is clamped.
    pub lod: f32,
    /// The number of anisotropic probes.
    pub probes: u16,
    /// The derivative of the coordinates along which the probes are placed.
    pub step: [f32; 3],
    /// The offset in texels.
    pub offset: [i32; 3],
    /// The reference of a comparison; `None` returns the texels' channels.
    pub reference: Option<f32>,
}

impl Sample2d for ReferenceView {
    fn sample<R: Real>(&self, uv: Vec2<R>) -> Vec4<R> {
        // Two packet pairs have sixty-four lanes; a single fragment is its own quad.
        let mut texels = [[0.0; 4]; 64];
        let gradients = [uv.x.ddx(), uv.y.ddx(), uv.x.ddy(), uv.y.ddy()];
        for (lane, texel) in texels.iter_mut().enumerate().take(R::LANES) {
            let first = if R::LANES >= 4 { lane / 4 * 4 } else { lane };
            let at = |lane: usize| [uv.x.lane(lane), uv.y.lane(lane), 0.0];
            let [u_x, v_x, u_y, v_y] = gradients.map(|gradient| gradient.lane(first));
            let (lod, probes, step) = self.footprint(at(first), [u_x, v_x, 0.0], [u_y, v_y, 0.0]);
            *texel = self.sample(&Sample {
                at: at(lane),
                layer: 0,
                lod: self.biased(lod, 0.0),
                probes,
                step,
                offset: [0; 3],
                reference: None,
            });
        }
        let channel = |k: usize| uv.x.with_lanes(|lane| texels[lane][k]);
        Vec4::new(channel(0), channel(1), channel(2), channel(3))
    }
}

impl ReferenceView {
    /// The 2D view of all mip levels of a texture's first layer.
    #[must_use]
    pub fn of_image(texture: Arc<TexelData>, sampler: SamplerDescriptor) -> Self {
        Self {
            dimension: ViewDimension::D2,
            levels: [0, texture.levels.len()],
            layers: [0, 1],
            aspect: TextureAspect::All,
            sampler,
            texture,
        }
    }

    fn reader(&self) -> TexelReader {
        TexelReader {
            format: self.texture.stored_format(),
            aspect: self.aspect,
        }
    }

    fn is_cube(&self) -> bool {
        use ViewDimension::{Cube, CubeArray};
        matches!(self.dimension, Cube | CubeArray)
    }

    /// Width, height and depth of a mip level of the view, in texels.
    fn sides(&self, level: usize) -> [u32; 3] {
        let of_level = &self.texture.levels[self.levels[0] + level];
        let depth = match self.texture.shape.dimension {
            TextureDimension::D3 => self.texture.shape.slices(self.levels[0] + level),
            TextureDimension::D1 | TextureDimension::D2 => 1,
        };
        [of_level.width, of_level.height, depth]
    }

    /// The number of layers, or of cubes.
    fn layer_count(&self) -> u32 {
        if self.is_cube() {
            self.layers[1] / 6
        } else {
            self.layers[1]
        }
    }

    /// λ without bias, the number of probes, and the derivative along which they are placed, from
    /// the coordinates and their derivatives along x and y.
    #[must_use]
    pub fn footprint(&self, at: [f32; 3], dx: [f32; 3], dy: [f32; 3]) -> (f32, u16, [f32; 3]) {
        use ViewDimension::{D1, D3};
        let sides = self.sides(0).map(|side| side as f32);
        let squared = |d: [f32; 3]| {
            let d = if self.is_cube() {
                let [s, t] = cube::derivatives(cube::face(at), at, d);
                [s, t, 0.0]
            } else {
                d
            };
            let texels: [f32; 3] = std::array::from_fn(|k| d[k] * sides[k]);
            let one = texels[0] * texels[0];
            let two = one + texels[1] * texels[1];
            match self.dimension {
                D1 => one,
                D3 => two + texels[2] * texels[2],
                _ => two,
            }
        };
        let (x, y) = (squared(dx), squared(dy));
        let limit = f32::from(self.sampler.max_anisotropy);
        if limit <= 1.0 || matches!(self.dimension, D1 | D3) {
            return (0.5 * log2(max(max(x, y), 0.0)), 1, [0.0; 3]);
        }
        let (x, y) = (max(x, 0.0), max(y, 0.0));
        let (larger, smaller, step) = if y > x { (y, x, dy) } else { (x, y, dx) };
        let r = (larger / smaller).sqrt();
        let eta = if r >= 1.0 { min(r, limit) } else { 1.0 };
        let probes = (1..=16).find(|&n| f32::from(n) >= eta).unwrap_or(16);
        (0.5 * log2(larger / (eta * eta)), probes, step)
    }

    /// λ plus the sampler's and the shader's bias, whose sum is clamped to −16..=15.99.
    #[must_use]
    pub fn biased(&self, lod: f32, shader_bias: f32) -> f32 {
        lod + clamp(self.sampler.lod_bias + shader_bias, -16.0, 15.99)
    }
}
