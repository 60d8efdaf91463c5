//! [`TexelView`]: how a texture's dimension, mip levels and layers are reinterpreted.

use super::packet_texel::PacketFormat;
use crate::TextureError;
use estampe_format::{AttachmentCodec, TexelCodec};
use estampe_simd::Level;
use estampe_types::{
    TexelData, TexelViewDescriptor, TextureAspect, TextureDimension, TextureFormat, ViewDimension,
};
use std::sync::Arc;

/// The longest side: sides are clamped to it, so that arithmetic stays in range.
const MAX_SIDE: u32 = 16_384;

/// The most layers, more than any valid texture has, for which arithmetic stays in range.
const MAX_LAYERS: u32 = 1 << 14;

/// One mip level as sampling reads it. The fields of a [`TexelData`] are public and may hold any
/// value: sides are clamped here, and missing texels read as zeros.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plane {
    /// Width, height and depth (layers do not count).
    pub(crate) sides: [i32; 3],
    /// The sides as floats.
    pub(crate) size: [f32; 3],
    /// The number of texels before the level, with all samples.
    offset: usize,
}

/// A texture as a shader reads it: a dimension, a range of layers and a range of mip levels. Cheap
/// to clone.
#[derive(Debug, Clone)]
pub struct TexelView {
    pub(crate) texture: Arc<TexelData>,
    pub(crate) dimension: ViewDimension,
    pub(crate) planes: Arc<[Plane]>,
    pub(crate) base_layer: u32,
    /// The number of layers, or of cubes.
    pub(crate) layers: i32,
    pub(crate) codec: TexelCodec,
    /// How packet code decodes the texels; `None` for integers.
    pub(crate) packets: Option<PacketFormat>,
    /// How packet code decodes integers that are colours; `None` for other texels.
    pub(crate) integers: Option<AttachmentCodec>,
    /// True if texels are four unorm bytes, in two dimensions, with one sample.
    pub(crate) is_unorm8: bool,
    /// True if the view contains all layers and levels of the texture.
    pub(crate) is_whole: bool,
    /// The SIMD level of packet code.
    pub(crate) level: Level,
}

impl TexelView {
    /// Creates a view of a texture.
    ///
    /// # Errors
    /// [`TextureError::View`] when the texture does not have what the descriptor asks for.
    pub fn new(
        texture: impl Into<Arc<TexelData>>,
        descriptor: &TexelViewDescriptor,
    ) -> Result<Self, TextureError> {
        use ViewDimension as V;
        let texture: Arc<TexelData> = texture.into();
        let missing = |what| TextureError::View { what };
        let all_layers = match texture.shape.dimension {
            TextureDimension::D3 => 1,
            TextureDimension::D1 | TextureDimension::D2 => texture.shape.depth_or_layers,
        };
        let dimension = descriptor
            .dimension
            .unwrap_or(match texture.shape.dimension {
                TextureDimension::D1 => V::D1,
                TextureDimension::D2 if all_layers > 1 => V::D2Array,
                TextureDimension::D2 => V::D2,
                TextureDimension::D3 => V::D3,
            });
        let wanted = match dimension {
            V::D1 => TextureDimension::D1,
            V::D3 => TextureDimension::D3,
            V::D2 | V::D2Array | V::Cube | V::CubeArray => TextureDimension::D2,
        };
        if texture.shape.dimension != wanted {
            return Err(missing("another dimension"));
        }
        let first = descriptor.base_array_layer;
        let rest = all_layers.saturating_sub(first);
        let layers = descriptor.array_layer_count.unwrap_or(match dimension {
            V::D1 | V::D2 | V::D3 => rest.min(1),
            V::Cube => rest.min(6),
            V::D2Array | V::CubeArray => rest,
        });
        if layers == 0 || layers > rest || layers > MAX_LAYERS || first > MAX_LAYERS {
            return Err(missing("layers"));
        }
        let is_whole = layers == all_layers;
        let layers = match dimension {
            V::D1 | V::D2 | V::D3 if layers == 1 => 1,
            V::D2Array => layers,
            V::Cube if layers == 6 => 1,
            V::CubeArray if layers.is_multiple_of(6) => layers / 6,
            _ => return Err(missing("another number of layers (a cube is six)")),
        };
        let base = descriptor.base_mip_level as usize;
        let rest = texture.levels.len().saturating_sub(base);
        let levels = descriptor
            .mip_level_count
            .map_or(rest, |count| count as usize);
        if levels == 0 || levels > rest {
            return Err(missing("levels"));
        }
        let is_multisampled = texture.shape.samples > 1;
        let is_cube = matches!(dimension, V::Cube | V::CubeArray);
        let is_square = texture.levels.iter().all(|l| l.width == l.height);
        if is_cube && (!is_square || is_multisampled) {
            return Err(missing(
                "a cube of faces that are square and have one sample",
            ));
        }
        if descriptor.aspect == TextureAspect::Stencil && !texture.format.has_stencil() {
            return Err(missing("stencil"));
        }
        if descriptor.aspect == TextureAspect::Depth && !texture.format.has_depth() {
            return Err(missing("depth"));
        }
        let is_whole = is_whole && levels == texture.levels.len();
        let planes = (base..base + levels).map(|level| Plane::new(&texture, level));
        let stored = texture.stored_format();
        let codec = TexelCodec::of_aspect(stored, descriptor.aspect);
        let is_unorm8 =
            stored == TextureFormat::Rgba8Unorm && dimension == V::D2 && !is_multisampled;
        Ok(Self {
            planes: planes.collect(),
            dimension,
            base_layer: first,
            layers: layers.cast_signed(),
            packets: PacketFormat::new(stored, &codec),
            integers: (codec.is_integer() && stored.is_renderable() && stored.is_color())
                .then(|| AttachmentCodec::new(stored)),
            codec,
            is_unorm8,
            is_whole,
            level: Level::best(),
            texture,
        })
    }

    /// A view of all of a texture, as an array if it has several layers.
    ///
    /// # Errors
    /// [`TextureError::View`] when it has no level or no layer.
    pub fn of(texture: impl Into<Arc<TexelData>>) -> Result<Self, TextureError> {
        Self::new(texture, &TexelViewDescriptor::default())
    }

    /// The texture.
    #[must_use]
    pub fn texture(&self) -> &Arc<TexelData> {
        &self.texture
    }

    /// The dimension of the view.
    #[must_use]
    pub fn dimension(&self) -> ViewDimension {
        self.dimension
    }

    /// Width, height and depth of a level (`textureDimensions`); 1 for a side that the dimension
    /// does not have, 0 for a level that does not exist.
    #[must_use]
    pub fn size(&self, level: usize) -> [u32; 3] {
        self.planes
            .get(level)
            .map_or([0; 3], |plane| plane.sides.map(i32::cast_unsigned))
    }

    /// The number of mip levels (`textureNumLevels`).
    #[must_use]
    pub fn level_count(&self) -> usize {
        self.planes.len()
    }

    /// The number of layers, or of cubes (`textureNumLayers`).
    #[must_use]
    pub fn layer_count(&self) -> u32 {
        self.layers.cast_unsigned()
    }

    /// The number of samples of a texel (`textureNumSamples`).
    #[must_use]
    pub fn sample_count(&self) -> u32 {
        self.texture.shape.samples
    }

    pub(crate) fn is_cube(&self) -> bool {
        matches!(
            self.dimension,
            ViewDimension::Cube | ViewDimension::CubeArray
        )
    }

    /// The words of a level of the view's first slice, with one sample and one word a texel.
    #[inline]
    pub(crate) fn slice_words(&self, plane: &Plane) -> Option<&[u32]> {
        self.layer_words(plane, 0)
    }

    /// The words of a level of a layer of the view, with one sample and one word a texel.
    pub(crate) fn layer_words(&self, plane: &Plane, layer: u32) -> Option<&[u32]> {
        let [width, height, _] = plane.sides.map(|side| side as usize);
        let slice = (self.base_layer + layer) as usize * width * height;
        let begin = plane.offset.checked_add(slice)?;
        self.texture
            .texels
            .get(begin..begin.checked_add(width * height)?)
    }

    /// The words of a sample of a texel inside its level: `slice` is a depth, or a layer of the
    /// texture.
    #[inline]
    pub(crate) fn texel(&self, plane: &Plane, [x, y, slice]: [i32; 3], sample: u32) -> &[u32] {
        let [width, height, _] = plane.sides.map(|side| side as usize);
        let samples = self.texture.shape.samples as usize;
        // Saturating, because the public fields of a texture may hold any value.
        let row = (slice as usize * height).saturating_add(y as usize);
        let texel = row.saturating_mul(width).saturating_add(x as usize);
        let at = plane.offset.saturating_add(texel.saturating_mul(samples));
        let at = at.saturating_add(sample as usize);
        let begin = at.saturating_mul(self.codec.words());
        let end = begin.saturating_add(self.codec.words());
        self.texture.texels.get(begin..end).unwrap_or_default()
    }
}

impl Plane {
    /// The index of the level's first word in the texture.
    #[inline(always)]
    pub(crate) fn begin_words(&self, words: i32) -> i32 {
        // Valid textures have fewer than 2³¹ words; for other values of the public fields, gathers
        // clamp their indices.
        let begin = i32::try_from(self.offset).unwrap_or(i32::MAX);
        begin.wrapping_mul(words)
    }

    fn new(texture: &TexelData, level: usize) -> Self {
        let of_level = &texture.levels[level];
        let depth = match texture.shape.dimension {
            TextureDimension::D3 => texture.shape.slices(level),
            TextureDimension::D1 | TextureDimension::D2 => 1,
        };
        let sides = [of_level.width, of_level.height, depth];
        let sides = sides.map(|side| side.clamp(1, MAX_SIDE).cast_signed());
        Self {
            sides,
            size: sides.map(|side| side as f32),
            offset: of_level.offset as usize,
        }
    }
}
