//! The picture in front of which transparent draws are blended.

use crate::DepthOrder;
use estampe::{Texture, TextureDescriptor, TextureFormat};

/// A picture of opaque surfaces with its depths: the samples of both, not resolved. The depths stay
/// as they are.
#[derive(Debug, Clone, Copy)]
pub struct Target<'t> {
    /// The colours, of a format that can be blended: what is not covered is premultiplied.
    pub color: &'t Texture,
    /// The depths, of a float format.
    pub depth: &'t Texture,
    /// Which depths are nearer.
    pub order: DepthOrder,
}

impl Target<'_> {
    /// A texture of the target's size and samples.
    pub(crate) fn texture_like(&self, format: TextureFormat) -> TextureDescriptor<'_> {
        TextureDescriptor {
            sample_count: self.color.sample_count(),
            ..TextureDescriptor::new_2d(self.color.width(), self.color.height(), format)
        }
    }

    pub(crate) fn is_multisampled(&self) -> bool {
        self.color.sample_count() > 1
    }
}
