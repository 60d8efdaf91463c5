//! The detail that textures need.

use estampe_scene::Scene;

/// Tells how large the textures of a scene need to be.
pub trait TextureDetail {
    /// The first mip level of each image that is needed: 0 is the whole image, each further one has
    /// half its sides. Images beyond the end of the list are needed whole.
    ///
    /// The scene is complete but for the texels: each image has its size, and `rgba` is empty.
    /// Materials whose use of alpha depends on their texture blend.
    fn first_levels(&self, scene: &Scene) -> Vec<u32>;
}

/// No texture is needed: each is decoded to its last level, of one texel, so that damage is found.
#[derive(Debug, Clone, Copy, Default)]
pub struct LeastDetail;

impl TextureDetail for LeastDetail {
    fn first_levels(&self, scene: &Scene) -> Vec<u32> {
        vec![u32::MAX; scene.images.len()]
    }
}

/// Every texture is needed whole.
#[derive(Debug, Clone, Copy, Default)]
pub struct FullDetail;

impl TextureDetail for FullDetail {
    fn first_levels(&self, _scene: &Scene) -> Vec<u32> {
        Vec::new()
    }
}
