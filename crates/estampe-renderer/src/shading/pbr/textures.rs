//! The textures of a physically based material, with their texture coordinates.

use estampe::{Real, SampledTexture, Vec2, Vec4, WithGradient};
use estampe_scene::UvTransform;

/// A texture of a material.
#[derive(Debug, Clone)]
pub struct MaterialTexture {
    pub texture: SampledTexture,
    pub coordinates: UvChoice,
}

/// Which coordinates a texture is sampled at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UvChoice {
    /// The second set, not the first.
    pub is_second: bool,
    /// Rows of the transform, if it changes anything.
    pub transform: Option<[[f32; 3]; 2]>,
}

impl UvChoice {
    /// The first set as it is.
    pub const FIRST: Self = Self {
        is_second: false,
        transform: None,
    };

    pub fn new(uv_set: u8, transform: &UvTransform) -> Self {
        let rows = || {
            let (sin, cos) = libm::sincosf(transform.rotation_rad);
            let glam::Vec2 { x, y } = transform.scale;
            [
                [cos * x, sin * y, transform.offset.x],
                [-sin * x, cos * y, transform.offset.y],
            ]
        };
        Self {
            is_second: uv_set == 1,
            transform: (*transform != UvTransform::IDENTITY).then(rows),
        }
    }

    /// The coordinates, from both sets of the vertices.
    #[inline(always)]
    pub fn of<R: Real>(&self, uvs: (Vec2<R>, Vec2<R>)) -> Vec2<R> {
        let uv = if self.is_second { uvs.1 } else { uvs.0 };
        match self.transform {
            Some([u, v]) => Vec2::new(
                uv.x * u[0] + uv.y * u[1] + u[2],
                uv.x * v[0] + uv.y * v[1] + v[2],
            ),
            None => uv,
        }
    }
}

impl MaterialTexture {
    #[inline(always)]
    pub fn sample<R: Real>(&self, uvs: (Vec2<R>, Vec2<R>)) -> Vec4<R> {
        self.texture.sample(self.coordinates.of(uvs))
    }

    /// [`MaterialTexture::sample`] with the level of detail of the fragment itself, if the texture
    /// coordinates are those of the vertices.
    #[inline(always)]
    pub fn sample_at_varyings<R: Real>(
        &self,
        uvs: (WithGradient<Vec2<R>>, WithGradient<Vec2<R>>),
    ) -> Vec4<R> {
        let uv = if self.coordinates.is_second {
            uvs.1
        } else {
            uvs.0
        };
        match self.coordinates.transform {
            Some(_) => self.sample((uvs.0.value, uvs.1.value)),
            None => self.texture.sample(uv),
        }
    }
}
