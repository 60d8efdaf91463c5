//! The textures among the resources that a draw binds.

use crate::{SampledView, TextureDescriptor, TextureView};
use estampe_types::{Bindings, Limits, SamplerDescriptor, TextureFormat};
use std::sync::LazyLock;

/// Textures by group and binding number. Shaders call this on the
/// [`Bindings`] of their input; where no texture of the kind is bound, they read zeros.
pub trait TextureBindings {
    /// The texture and its sampler at a group and binding number.
    fn sampled(&self, group: u32, binding: u32) -> &SampledView;

    /// The texture without a sampler at a group and binding number, to fetch texels from.
    fn texture_view(&self, group: u32, binding: u32) -> &TextureView;
}

/// One texel of zeros.
static ZERO: LazyLock<SampledView> = LazyLock::new(|| {
    let descriptor = TextureDescriptor::new_2d(1, 1, TextureFormat::Rgba8Unorm);
    let texture = descriptor.create(&[], crate::MipGeneration::None, &Limits::default());
    let view = texture.and_then(TextureView::of);
    view.and_then(|view| SampledView::new(view, SamplerDescriptor::default()))
        .expect("one texel is within every limit")
});

impl TextureBindings for Bindings {
    #[inline]
    fn sampled(&self, group: u32, binding: u32) -> &SampledView {
        self.other(group, binding).unwrap_or_else(|| &*ZERO)
    }

    #[inline]
    fn texture_view(&self, group: u32, binding: u32) -> &TextureView {
        self.other(group, binding).unwrap_or_else(|| ZERO.view())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Coordinates, MipGeneration, create_texture};
    use estampe_types::Vec2;
    use estampe_types::bindings::{BindGroup, Binding, BoundGroup, OtherResource};
    use std::sync::Arc;

    fn white() -> SampledView {
        let (format, limits) = (TextureFormat::Rgba8Unorm, Limits::default());
        let texture = create_texture(1, 1, format, &[255; 4], MipGeneration::None, &limits)
            .expect("one texel");
        let view = TextureView::of(texture).expect("it has a level");
        SampledView::new(view, SamplerDescriptor::default()).expect("the default is valid")
    }

    #[test]
    fn textures_are_found_by_number_and_are_zeros_where_none_is_bound() {
        let white = white();
        let other = |resource| Binding::Other(OtherResource(resource));
        let entries = vec![
            (3, other(Arc::new(white.clone()))),
            (5, other(Arc::new(white.view().clone()))),
        ];
        let bindings = Bindings {
            groups: vec![BoundGroup {
                group: Arc::new(BindGroup { entries }),
                ..BoundGroup::default()
            }],
        };
        let sample = |group, binding| {
            let at = Coordinates::d2(Vec2::new(0.5, 0.5));
            let color = bindings.sampled(group, binding).sample(at);
            [color.x, color.y, color.z, color.w]
        };
        let fetch = |group, binding| {
            let color = bindings.texture_view(group, binding).fetch([0; 3], 0, 0);
            [color.x, color.y, color.z, color.w]
        };
        assert_eq!([sample(0, 3), fetch(0, 5)], [[1.0; 4]; 2]);
        // Of another kind, not bound, and of a group that is not bound.
        for (group, binding) in [(0, 4), (1, 3)] {
            assert_eq!(
                [sample(group, binding), fetch(group, binding)],
                [[0.0; 4]; 2]
            );
        }
        assert_eq!([sample(0, 5), fetch(0, 3)], [[0.0; 4]; 2]);
    }
}
