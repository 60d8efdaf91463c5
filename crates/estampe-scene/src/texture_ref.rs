//! Uses of images as textures: the sampler, the texture coordinates and their transform.

use glam::Vec2;

/// A texture of a material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextureRef {
    /// Index into `Scene::images`.
    pub image: usize,
    /// How the image is sampled.
    pub sampler: TextureSampler,
    /// The texture coordinates: set 0 is `Mesh::uvs`, set 1 the attribute
    /// [`Mesh::UV1`](crate::Mesh::UV1).
    pub uv_set: u8,
    /// Applied to the texture coordinates before sampling.
    pub transform: UvTransform,
}

impl TextureRef {
    /// The image with the first set of texture coordinates, repeated and filtered.
    #[must_use]
    pub fn new(image: usize) -> Self {
        Self {
            image,
            sampler: TextureSampler::default(),
            uv_set: 0,
            transform: UvTransform::IDENTITY,
        }
    }
}

/// How a texture is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct TextureSampler {
    /// Texture coordinates outside of 0..1, along u.
    pub wrap_u: AddressMode,
    /// Texture coordinates outside of 0..1, along v.
    pub wrap_v: AddressMode,
    /// Filter where a texel covers several pixels.
    pub magnify: TextureFilter,
    /// Filter where a pixel covers several texels, within one mip level.
    pub minify: TextureFilter,
    /// Filter between mip levels; `None` uses the first level alone.
    pub mipmap: Option<TextureFilter>,
}

impl Default for TextureSampler {
    /// Repeated, trilinear.
    fn default() -> Self {
        Self {
            wrap_u: AddressMode::Repeat,
            wrap_v: AddressMode::Repeat,
            magnify: TextureFilter::Linear,
            minify: TextureFilter::Linear,
            mipmap: Some(TextureFilter::Linear),
        }
    }
}

/// The meaning of texture coordinates outside of 0..1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum AddressMode {
    /// The image is repeated.
    #[default]
    Repeat,
    /// The image is repeated, every second time mirrored.
    MirrorRepeat,
    /// The texels at the edge go on.
    ClampToEdge,
}

/// A filter of texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TextureFilter {
    /// The nearest texel.
    Nearest,
    /// The weighted mean of the texels around.
    #[default]
    Linear,
}

/// A transform of texture coordinates: scaled first, then rotated, then moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UvTransform {
    /// Added last.
    pub offset: Vec2,
    /// Rotation around the origin: of the coordinates counter-clockwise as seen, so of the image
    /// clockwise (v points down).
    pub rotation_rad: f32,
    /// Factors of the coordinates.
    pub scale: Vec2,
}

impl UvTransform {
    /// Changes nothing.
    pub const IDENTITY: Self = Self {
        offset: Vec2::ZERO,
        rotation_rad: 0.0,
        scale: Vec2::ONE,
    };

    /// The transformed coordinates, as KHR_texture_transform defines them:
    ///
    /// ```text
    /// | u' |   |  cos r  sin r |   | scale.x · u |   | offset.x |
    /// | v' | = | −sin r  cos r | · | scale.y · v | + | offset.y |
    /// ```
    #[must_use]
    pub fn apply(&self, uv: Vec2) -> Vec2 {
        let (sin, cos) = libm::sincosf(self.rotation_rad);
        let Vec2 { x, y } = uv * self.scale;
        Vec2::new(cos * x + sin * y, cos * y - sin * x) + self.offset
    }
}

impl Default for UvTransform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

#[cfg(test)]
mod tests {
    use super::UvTransform;
    use glam::Vec2;
    use std::f32::consts::FRAC_PI_2;

    #[test]
    fn coordinates_are_scaled_then_rotated_then_moved() {
        let transform = UvTransform {
            offset: Vec2::new(0.0, 1.0),
            rotation_rad: FRAC_PI_2,
            scale: Vec2::splat(0.5),
        };
        // The example of the extension's text: u and v swap their places.
        let moved = transform.apply(Vec2::new(1.0, 0.5));
        assert!((moved - Vec2::new(0.25, 0.5)).length() < 1e-6, "{moved}");
        let uv = Vec2::new(0.3, 0.7);
        assert_eq!(UvTransform::IDENTITY.apply(uv), uv);
    }
}
