//! The textures among the resources that a draw binds.

use crate::{BoundTexture, SampledTexture, TexelDescriptor, TexelView, TiledTexels};
use estampe_types::{Bindings, Limits, SamplerDescriptor, TextureFormat};
use std::sync::LazyLock;

/// Textures by group and binding number. Shaders call this on the
/// [`Bindings`] of their input; where no texture of the kind is bound, they read zeros.
pub trait TextureBindings {
    /// The texture and its sampler at a group and binding number.
    fn sampled_texture(&self, group: u32, binding: u32) -> &SampledTexture;

    /// The texture without a sampler at a group and binding number, to fetch texels from.
    fn texture(&self, group: u32, binding: u32) -> &TexelView;

    /// The texels of the texture without a sampler at a group and binding number as an attachment
    /// stores them, if they are bound so: for loads at the fragment's own pixel.
    fn tiled_texels(&self, group: u32, binding: u32) -> Option<&TiledTexels>;

    /// The texture at one group and binding number with the sampler at another one; `None` if
    /// either is not bound, or the sampler cannot sample the texture.
    fn texture_with_sampler(&self, texture: [u32; 2], sampler: [u32; 2])
    -> Option<&SampledTexture>;
}

/// One texel of zeros.
static ZERO: LazyLock<SampledTexture> = LazyLock::new(|| {
    let descriptor = TexelDescriptor::new_2d(1, 1, TextureFormat::Rgba8Unorm);
    let texture = descriptor.create(&[], crate::MipGeneration::None, &Limits::default());
    let view = texture.and_then(TexelView::of);
    view.and_then(|view| SampledTexture::new(view, SamplerDescriptor::default()))
        .expect("one texel is within every limit")
});

impl TextureBindings for Bindings {
    #[inline]
    fn sampled_texture(&self, group: u32, binding: u32) -> &SampledTexture {
        self.other(group, binding).unwrap_or_else(|| &*ZERO)
    }

    #[inline]
    fn texture(&self, group: u32, binding: u32) -> &TexelView {
        self.other(group, binding)
            .map_or_else(|| ZERO.view(), BoundTexture::view)
    }

    fn tiled_texels(&self, group: u32, binding: u32) -> Option<&TiledTexels> {
        self.other(group, binding).and_then(BoundTexture::tiles)
    }

    fn texture_with_sampler(
        &self,
        texture: [u32; 2],
        sampler: [u32; 2],
    ) -> Option<&SampledTexture> {
        let bound: Option<&BoundTexture> = self.other(texture[0], texture[1]);
        if bound.is_none() {
            self.miss();
        }
        bound?.sampled(self.sampler(sampler[0], sampler[1])?)
    }
}
