//! The textures of the textured loads: the common kind, and the same picture in other formats and
//! shapes.

use super::Load;
use super::geometry::{GLYPH_PX, GLYPHS, TEXTURE_SIDE, half_of_256th};
use crate::BenchError;
use crate::generate::diffuse_texture;
use estampe::{
    Device, DeviceDescriptor, Extent3d, FilterMode, SampledTexture, Sampler, SamplerDescriptor,
    TextureDescriptor, TextureFormat, TextureViewDescriptor, ViewDimension,
};

/// A texture format or shape other than the common kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ViewKind {
    pub(super) format: TextureFormat,
    pub(super) dimension: ViewDimension,
}

/// A view and the conversion of (u, v) to its coordinates.
#[derive(Debug, Clone)]
pub(super) struct ViewTexture {
    pub(super) view: SampledTexture,
    pub(super) lookup: Lookup,
}

/// The conversion of (u, v) to coordinates.
#[derive(Debug, Clone, Copy)]
pub(super) enum Lookup {
    /// (u, v) unchanged.
    Image,
    /// (u, v) in this layer.
    Layer(i32),
    /// A direction.
    Direction,
}

/// The number of layers of the array.
const LAYERS: u32 = 4;

/// The pictures of the textured loads in RGBA8, row by row, created once.
#[derive(Debug)]
pub(super) struct Pictures {
    surface: Vec<u8>,
    glyphs: Vec<u8>,
    /// Makes the textures; these do not depend on it.
    device: Device,
    bilinear: Sampler,
}

impl Pictures {
    pub(super) fn new() -> Result<Self, BenchError> {
        let device = Device::new(&DeviceDescriptor {
            threads: 1,
            ..DeviceDescriptor::default()
        })?;
        Ok(Self {
            surface: diffuse_texture(TEXTURE_SIDE, 23).levels.swap_remove(0),
            glyphs: glyphs(),
            bilinear: device.create_sampler(&bilinear())?,
            device,
        })
    }

    fn of(&self, load: Load) -> &[u8] {
        match load {
            Load::Text => &self.glyphs,
            _ => &self.surface,
        }
    }

    /// The load's picture as a texture of the common kind.
    pub(super) fn sampled(&self, load: Load) -> Result<SampledTexture, BenchError> {
        let format = TextureFormat::Rgba8Unorm;
        let descriptor = TextureDescriptor::new_2d(TEXTURE_SIDE, TEXTURE_SIDE, format);
        let texture = self
            .device
            .create_texture_with_data(&descriptor, &[self.of(load)])?;
        Ok(self
            .device
            .sampled_texture(&texture.view(), &self.bilinear)?)
    }

    /// The load's picture in another format or shape; each layer and each face has the same
    /// picture.
    pub(super) fn view(&self, load: Load, kind: ViewKind) -> Result<ViewTexture, BenchError> {
        let layers = match kind.dimension {
            ViewDimension::Cube => 6,
            ViewDimension::D2Array => LAYERS,
            _ => 1,
        };
        let descriptor = TextureDescriptor {
            size: Extent3d {
                width: TEXTURE_SIDE,
                height: TEXTURE_SIDE,
                depth_or_array_layers: layers,
            },
            ..TextureDescriptor::new_2d(TEXTURE_SIDE, TEXTURE_SIDE, kind.format)
        };
        let bytes = converted(self.of(load), kind.format).repeat(layers as usize);
        let texture = self
            .device
            .create_texture_with_data(&descriptor, &[&bytes])?;
        let view = texture.create_view(&TextureViewDescriptor {
            dimension: Some(kind.dimension),
            ..TextureViewDescriptor::default()
        })?;
        Ok(ViewTexture {
            view: self.device.sampled_texture(&view, &self.bilinear)?,
            lookup: match kind.dimension {
                ViewDimension::Cube => Lookup::Direction,
                ViewDimension::D2Array => Lookup::Layer(2),
                _ => Lookup::Image,
            },
        })
    }
}

fn bilinear() -> SamplerDescriptor {
    SamplerDescriptor {
        mag_filter: FilterMode::Linear,
        min_filter: FilterMode::Linear,
        ..SamplerDescriptor::default()
    }
}

/// RGBA8 converted to one of the formats of the states.
fn converted(rgba: &[u8], format: TextureFormat) -> Vec<u8> {
    let texels = rgba.as_chunks::<4>().0.iter();
    match format {
        TextureFormat::R8Unorm => texels.map(|texel| texel[0]).collect(),
        TextureFormat::Bgra8Unorm | TextureFormat::Bgra8UnormSrgb => {
            texels.flat_map(|&[r, g, b, a]| [b, g, r, a]).collect()
        }
        TextureFormat::Rgba16Float => {
            let channels = texels.flatten().map(|&code| half_of_256th(code));
            channels.flat_map(u16::to_le_bytes).collect()
        }
        _ => rgba.to_vec(),
    }
}

/// Rings of different sizes, anti-aliased and premultiplied, with about as much ink as letters.
fn glyphs() -> Vec<u8> {
    let [width, height] = GLYPH_PX;
    let mut rgba = vec![0; (TEXTURE_SIDE * TEXTURE_SIDE * 4) as usize];
    for (y, row) in (0..).zip(rgba.chunks_exact_mut(TEXTURE_SIDE as usize * 4)) {
        for (x, texel) in (0..).zip(row.as_chunks_mut::<4>().0) {
            if x / width >= GLYPHS[0] || y / height >= GLYPHS[1] {
                continue;
            }
            let from_center =
                |at: u32, side: u32| f64::from(at % side) + 0.5 - f64::from(side) * 0.5;
            let (dx, dy) = (from_center(x, width), from_center(y, height) * 0.75);
            let radius = 2.5 + f64::from((x / width + y / height) % 4) * 0.5;
            let distance = ((dx * dx + dy * dy).sqrt() - radius).abs();
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "within 0..=255"
            )]
            let coverage = ((1.25 - distance).clamp(0.0, 1.0) * 255.0) as u8;
            *texel = [coverage; 4];
        }
    }
    rgba
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_has_as_many_bytes_as_its_format_takes() {
        let rgba = [1, 2, 3, 4, 5, 6, 7, 255];
        for (format, expected) in [
            (TextureFormat::Rgba8UnormSrgb, rgba.to_vec()),
            (TextureFormat::Bgra8Unorm, vec![3, 2, 1, 4, 7, 6, 5, 255]),
            (TextureFormat::R8Unorm, vec![1, 5]),
        ] {
            assert_eq!(converted(&rgba, format), expected);
        }
        assert_eq!(converted(&rgba, TextureFormat::Rgba16Float).len(), 16);
    }

    #[test]
    fn glyphs_are_ink_and_paper() {
        let glyphs = glyphs();
        let [width, height] = GLYPH_PX;
        let texels = (width * GLYPHS[0] * height * GLYPHS[1]) as usize;
        let inked = glyphs
            .as_chunks::<4>()
            .0
            .iter()
            .filter(|texel| texel[3] > 0);
        let inked = inked.count();
        assert!(
            inked > texels / 5 && inked < texels * 3 / 4,
            "{inked} of {texels}"
        );
    }
}
