//! [`SampledTexture`]: a view with a sampler, as a shader holds it.

use super::TexelView;
use super::packet::{LevelTable, PacketFormat};
use crate::rgba8_texture::is_rgba8;
use crate::{Rgba8Texture, TextureError};
use estampe_simd::Level;
use estampe_types::state::CompareFunction;
use estampe_types::{AddressMode, ShadowMap, TextureFormat, ViewDimension};
use estampe_types::{FilterMode, SampleType, SamplerDescriptor, TexelData};
use std::sync::Arc;

/// A view of any texture with a sampler. Cheap to clone.
///
/// Coordinates may be any number: NaN and infinities read some texel, as `docs/NUMERICS.md` says.
/// For integer formats, every function gives the [bits](estampe_types::Real::to_bits).
#[derive(Debug, Clone)]
pub struct SampledTexture {
    pub(crate) view: TexelView,
    pub(crate) sampler: SamplerDescriptor,
    /// The sampler of the common kind of view, if this is one: 2D, four 8-bit channels, WebGPU's
    /// address modes.
    pub(super) common: Option<Rgba8Texture>,
    /// The texel decoder of packet code; `None` for formats without packet code.
    pub(crate) packets: Option<PacketFormat>,
    /// True if view and sampler allow the common case of a packet (`packet/inside.rs`): linear
    /// filtering in one image of each level, with wrapped coordinates or on a cube's face.
    pub(crate) is_simple: bool,
    /// The mip levels, if view and sampler are those of `packet/bytes.rs`: as for the common case,
    /// and anisotropic filtering, of a format of bytes.
    pub(crate) level_table: Option<Arc<LevelTable>>,
    /// True if packets read [squares](estampe_types::ByteSquares) where they are made.
    pub(crate) reads_squares: bool,
    /// True if the level of detail is of no effect: one mip level, and the same filter for
    /// magnification and minification.
    pub(crate) ignores_lod: bool,
    /// The SIMD level of packet code.
    pub(crate) level: Level,
    /// The depths, if comparisons read them as
    /// [`sample_compare_level`](crate::sample_compare_level) does.
    pub(super) depths: Option<ShadowMap>,
}

impl SampledTexture {
    /// Combines a view with a sampler.
    ///
    /// # Errors
    /// [`TextureError::Sampler`] when the sampler is not valid, or cannot sample the view.
    pub fn new(view: TexelView, sampler: SamplerDescriptor) -> Result<Self, TextureError> {
        check(&view, &sampler)?;
        let common = is_common(&view, &sampler).then(|| {
            let texture = TexelData {
                format: view.texture.stored_format(),
                ..TexelData::clone(&view.texture)
            };
            Rgba8Texture::new(texture, sampler)
        });
        let packets = view.packets;
        let is_linear = is_linear(&view, &sampler);
        let level_table = packets
            .filter(|format| is_linear && format.is_of_bytes())
            .and_then(|_| LevelTable::new(&view.planes));
        Ok(Self {
            packets,
            is_simple: is_linear && sampler.max_anisotropy <= 1,
            reads_squares: level_table.is_some()
                && sampler.max_anisotropy <= 1
                && !view.is_cube()
                && packets.is_some_and(PacketFormat::is_one_byte),
            level_table: level_table.map(Arc::new),
            ignores_lod: view.level_count() == 1
                && sampler.mag_filter == sampler.min_filter
                && sampler.max_anisotropy <= 1,
            level: Level::best(),
            view,
            sampler,
            common,
            depths: None,
        })
    }

    /// Checks the rules of a sampler that hold for every view.
    ///
    /// # Errors
    /// [`TextureError::Sampler`] names the rule that it breaks.
    pub fn check_sampler(sampler: &SamplerDescriptor) -> Result<(), TextureError> {
        check_alone(sampler)
    }

    /// Samples packets at the given SIMD level instead of the best one. The results are the same.
    #[must_use]
    pub fn at_level(self, level: Level) -> Self {
        Self { level, ..self }
    }

    /// The texture with its depths as a shadow map, which comparisons read if view and sampler are
    /// those of [`sample_compare_level`](crate::sample_compare_level). The results are the same.
    #[must_use]
    pub fn with_depths(self, depths: ShadowMap) -> Self {
        let (view, sampler) = (&self.view, &self.sampler);
        let size = view.size(0);
        let is_common = view.dimension() == ViewDimension::D2
            && view.level_count() == 1
            && view.texture.stored_format() == TextureFormat::Depth32Float
            && [size[0], size[1]] == [depths.width(), depths.height()]
            && [sampler.mag_filter, sampler.min_filter] == [FilterMode::Linear; 2]
            && [sampler.address_mode_u, sampler.address_mode_v] == [AddressMode::ClampToEdge; 2]
            && sampler.compare == Some(CompareFunction::LessEqual);
        Self {
            depths: is_common.then_some(depths),
            ..self
        }
    }

    /// The SIMD level at which packets are sampled.
    #[must_use]
    pub fn level(&self) -> Level {
        self.level
    }

    /// The depths that comparisons read: see [`Self::with_depths`].
    #[must_use]
    pub fn depths(&self) -> Option<&ShadowMap> {
        self.depths.as_ref()
    }

    /// The texture with its sampler, if it is of the common kind: 2D, four 8-bit channels, WebGPU's
    /// address modes.
    #[must_use]
    pub fn common(&self) -> Option<&Rgba8Texture> {
        self.common.as_ref()
    }

    /// The view, for its sizes and for fetching texels.
    #[must_use]
    pub fn view(&self) -> &TexelView {
        &self.view
    }

    /// The sampler.
    #[must_use]
    pub fn sampler(&self) -> &SamplerDescriptor {
        &self.sampler
    }
}

fn refuse(what: &'static str) -> Result<(), TextureError> {
    Err(TextureError::Sampler { what })
}

/// Checks the rules of a sampler that do not depend on a view.
fn check_alone(sampler: &SamplerDescriptor) -> Result<(), TextureError> {
    let filters = filters(sampler);
    let (least, most) = (sampler.lod_min_clamp, sampler.lod_max_clamp);
    let has_nan = least.is_nan() || most.is_nan() || sampler.lod_bias.is_nan();
    if has_nan || least > most {
        return refuse("a sampler's lod_min_clamp is at most its lod_max_clamp, and none is NaN");
    }
    if !(1..=16).contains(&sampler.max_anisotropy) {
        return refuse("max_anisotropy is 1 to 16");
    }
    if sampler.max_anisotropy > 1 && filters != [FilterMode::Linear; 3] {
        return refuse("a sampler with max_anisotropy above 1 filters linearly, levels too");
    }
    Ok(())
}

fn filters(sampler: &SamplerDescriptor) -> [FilterMode; 3] {
    [
        sampler.mag_filter,
        sampler.min_filter,
        sampler.mipmap_filter,
    ]
}

fn check(view: &TexelView, sampler: &SamplerDescriptor) -> Result<(), TextureError> {
    check_alone(sampler)?;
    if view.texture.shape.samples != 1 {
        return refuse("multisampled textures are not sampled: fetch their texels");
    }
    if view.codec.is_integer() && filters(sampler) != [FilterMode::Nearest; 3] {
        return refuse("integers cannot be filtered: choose FilterMode::Nearest");
    }
    if sampler.compare.is_some() && view.codec.sample_type() != SampleType::Depth {
        return refuse("a comparison sampler needs a texture of depths");
    }
    if sampler.compare.is_some() && view.dimension == ViewDimension::D3 {
        return refuse("3D textures are not compared");
    }
    Ok(())
}

/// Returns true if filtering is linear in one image of each level, with wrapped coordinates or on a
/// cube's face.
fn is_linear(view: &TexelView, sampler: &SamplerDescriptor) -> bool {
    let is_flat = matches!(view.dimension, ViewDimension::D2 | ViewDimension::D2Array);
    let is_plain = sampler.address_mode_u.is_plain() && sampler.address_mode_v.is_plain();
    (view.is_cube() || is_flat && is_plain)
        && [sampler.mag_filter, sampler.min_filter] == [FilterMode::Linear; 2]
}

/// Returns true if [`Rgba8Texture`] gives the same results faster.
fn is_common(view: &TexelView, sampler: &SamplerDescriptor) -> bool {
    is_rgba8(view.texture.stored_format())
        && view.dimension == ViewDimension::D2
        && view.is_whole
        && sampler.address_mode_u.is_plain()
        && sampler.address_mode_v.is_plain()
        && sampler.max_anisotropy <= 1
        && sampler.lod_bias == 0.0
}
