//! [`BoundTexture`]: a texture that a draw binds without a sampler.

use crate::{SampledTexture, TexelView};
use estampe_simd::Level;
use estampe_types::{SamplerDescriptor, ShadowMap};
use std::sync::{Arc, Mutex, PoisonError};

/// A texture as a draw binds it, with the samplers that its shaders use with it.
#[derive(Debug)]
pub struct BoundTexture {
    view: TexelView,
    depths: Option<ShadowMap>,
    level: Level,
    /// Each sampler that was used, with the texture: `None` if it cannot sample it.
    sampled: Mutex<Vec<(SamplerDescriptor, Option<Arc<SampledTexture>>)>>,
}

impl BoundTexture {
    /// Binds a view that is sampled at a SIMD level. `depths` are its texels as a shadow map, if it
    /// is a depth texture that has them: comparisons read them.
    #[must_use]
    pub fn new(view: TexelView, depths: Option<ShadowMap>, level: Level) -> Self {
        Self {
            view,
            depths,
            level,
            sampled: Mutex::default(),
        }
    }

    /// The view.
    #[must_use]
    pub fn view(&self) -> &TexelView {
        &self.view
    }

    /// The texture with a sampler, made when it is first asked for. `None` if the sampler cannot
    /// sample it.
    #[must_use]
    pub fn sampled(&self, sampler: &SamplerDescriptor) -> Option<Arc<SampledTexture>> {
        let mut sampled = self.sampled.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, found)) = sampled.iter().find(|(one, _)| one == sampler) {
            return found.clone();
        }
        let made = SampledTexture::new(self.view.clone(), *sampler).ok();
        let made = made.map(|made| {
            let made = made.at_level(self.level);
            Arc::new(match &self.depths {
                Some(depths) => made.with_depths(depths.clone()),
                None => made,
            })
        });
        sampled.push((*sampler, made.clone()));
        made
    }
}
