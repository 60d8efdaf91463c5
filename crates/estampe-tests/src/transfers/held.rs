//! Views that were held while their textures changed: every texel is as it was.

use estampe::{SampleType, SampledTexture};
use estampe_reference::texture::ReferenceView;
use estampe_types::{SamplerDescriptor, TexelData, TextureAspect, TextureDimension, ViewDimension};
use std::sync::Arc;

/// Compares held views with textures as the oracle had them. An error describes the first
/// difference.
pub(super) fn compare_held(
    held: &[SampledTexture],
    wanted: &[Arc<TexelData>],
) -> Result<(), String> {
    for (number, (held, wanted)) in held.iter().zip(wanted).enumerate() {
        let reference = whole_view(wanted);
        let kind = wanted.format.sample_type();
        let is_integer = matches!(kind, SampleType::Uint | SampleType::Sint);
        let bits = |channel: f32| match channel {
            // All NaN are equal.
            nan if nan.is_nan() && !is_integer => f32::NAN.to_bits(),
            number => number.to_bits(),
        };
        for (level, at) in texels(wanted) {
            let got = held.view().fetch(at, level, 0);
            let got = [got.x, got.y, got.z, got.w].map(bits);
            let wanted = reference.fetch(at, level, 0).map(bits);
            if got != wanted {
                return Err(format!(
                    "held texture {number}, level {level}, {at:?}: {got:x?}, the oracle {wanted:x?}"
                ));
            }
        }
    }
    Ok(())
}

/// The view of all of a texture.
fn whole_view(texture: &Arc<TexelData>) -> ReferenceView {
    let layers = texture.shape.depth_or_layers;
    let (dimension, layers) = match texture.shape.dimension {
        TextureDimension::D1 => (ViewDimension::D1, 1),
        TextureDimension::D3 => (ViewDimension::D3, 1),
        TextureDimension::D2 if layers == 1 => (ViewDimension::D2, 1),
        TextureDimension::D2 => (ViewDimension::D2Array, layers),
    };
    ReferenceView {
        dimension,
        levels: [0, texture.levels.len()],
        layers: [0, layers],
        aspect: TextureAspect::All,
        sampler: SamplerDescriptor::default(),
        texture: Arc::clone(texture),
    }
}

/// The level and the coordinates of every texel.
fn texels(texture: &TexelData) -> impl Iterator<Item = (i32, [i32; 3])> {
    let levels = texture.levels.iter().enumerate();
    levels.flat_map(|(number, level)| {
        let slices = texture.shape.slices(number);
        let [width, height, slices] = [level.width, level.height, slices].map(u32::cast_signed);
        let number = i32::try_from(number).expect("few levels");
        let rows = (0..slices).flat_map(move |z| (0..height).map(move |y| (y, z)));
        rows.flat_map(move |(y, z)| (0..width).map(move |x| (number, [x, y, z])))
    })
}
