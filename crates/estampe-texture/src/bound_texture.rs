//! [`BoundTexture`]: a texture that a draw binds without a sampler.

use crate::{SampledTexture, TexelView, TexelViewDescriptor, TiledTexels, texture_from_depth};
use estampe_simd::Level;
use estampe_types::{SamplerDescriptor, ShadowMap};
use std::sync::{Arc, OnceLock};

/// A texture as a draw binds it, with the samplers that its shaders use with it.
#[derive(Debug)]
pub struct BoundTexture {
    view: TexelView,
    /// False if it has a shape alone.
    has_texels: bool,
    depths: Option<ShadowMap>,
    tiles: Option<TiledTexels>,
    level: Level,
    /// The first of the samplers that were used.
    first: OnceLock<Box<Sampled>>,
}

/// The texture with a sampler that was used, in a list that only grows: threads that shade read it
/// without a lock, as each would ask for the same one with every batch of packets.
#[derive(Debug)]
struct Sampled {
    sampler: SamplerDescriptor,
    /// `None` if the sampler cannot sample the texture.
    texture: Option<SampledTexture>,
    next: OnceLock<Box<Self>>,
}

impl BoundTexture {
    /// Binds a view that is sampled at a SIMD level. `depths` are its texels as a shadow map, if it
    /// is a depth texture that has them: comparisons read them.
    #[must_use]
    pub fn new(view: TexelView, depths: Option<ShadowMap>, level: Level) -> Self {
        Self {
            view,
            has_texels: true,
            depths,
            tiles: None,
            level,
            first: OnceLock::new(),
        }
    }

    /// Binds a texture of which shaders ask for the size, and what else is given: depths to compare
    /// with, and texels that they load at the fragment's own pixel. The view has no texels. Where a
    /// sampler reads them all the same, they are taken from the depths.
    #[must_use]
    pub fn without_texels(
        view: TexelView,
        (depths, tiles): (Option<ShadowMap>, Option<TiledTexels>),
        level: Level,
    ) -> Self {
        let mut bound = Self::new(view, depths, level);
        (bound.has_texels, bound.tiles) = (false, tiles);
        bound
    }

    /// The view.
    #[must_use]
    pub fn view(&self) -> &TexelView {
        &self.view
    }

    /// The texels that shaders load at the fragment's own pixel, if they are there as an attachment
    /// stores them.
    #[must_use]
    pub fn tiles(&self) -> Option<&TiledTexels> {
        self.tiles.as_ref()
    }

    /// The texture with a sampler, made when it is first asked for. `None` if the sampler cannot
    /// sample it.
    #[must_use]
    pub fn sampled(&self, sampler: &SamplerDescriptor) -> Option<&SampledTexture> {
        // Equal to none, not even to itself: the list would grow with every use. No texture can be
        // sampled so.
        let (least, most) = (sampler.lod_min_clamp, sampler.lod_max_clamp);
        if least.is_nan() || most.is_nan() || sampler.lod_bias.is_nan() {
            return None;
        }
        let (mut next, mut is_made) = (&self.first, false);
        loop {
            let entry = next.get_or_init(|| {
                is_made = true;
                Box::new(self.with(*sampler))
            });
            // Another thread may have made an entry at the same time, of another sampler.
            if is_made || entry.sampler == *sampler {
                return entry.texture.as_ref();
            }
            next = &entry.next;
        }
    }

    /// The texture with a sampler.
    #[cold]
    fn with(&self, sampler: SamplerDescriptor) -> Sampled {
        let mut texture = self.sampled_view(self.view.clone(), sampler);
        if let (Some(depths), Some(made), false) = (&self.depths, &texture, self.has_texels)
            && made.depths().is_none()
        {
            let view = texture_from_depth(depths)
                .map(|data| TexelView::new(Arc::new(data), &TexelViewDescriptor::default()));
            let view = view.and_then(|view| view).ok();
            texture = view.and_then(|view| self.sampled_view(view, sampler));
        }
        Sampled {
            sampler,
            texture,
            next: OnceLock::new(),
        }
    }

    fn sampled_view(&self, view: TexelView, sampler: SamplerDescriptor) -> Option<SampledTexture> {
        let made = SampledTexture::new(view, sampler)
            .ok()?
            .at_level(self.level);
        made.make_squares();
        Some(match &self.depths {
            Some(depths) => made.with_depths(depths.clone()),
            None => made,
        })
    }
}

impl Drop for BoundTexture {
    /// Drops the list entry by entry, however long it is.
    fn drop(&mut self) {
        let mut next = self.first.take();
        if next.is_some() {
            self.view.texture().squares.note_sampled();
        }
        while let Some(mut entry) = next {
            next = entry.next.take();
        }
    }
}
