//! [`SampledTexture`]: a view with a sampler, as a shader holds it.

use super::coordinates::{Answers, Coordinates, Lod, TextureCoordinates, by_sixteen};
use super::packet::{LevelTable, PacketFormat};
use super::{PacketRequest, TexelView};
use crate::rgba8_texture::is_rgba8;
use crate::{Rgba8Texture, TextureError, sample_compare_level};
use estampe_simd::Level;
use estampe_types::shader::Sample2d;
use estampe_types::state::CompareFunction;
use estampe_types::{AddressMode, ShadowMap, TextureFormat, ViewDimension};
use estampe_types::{FilterMode, Real, SampleType, SamplerDescriptor, TexelData};
use estampe_types::{Vec2, Vec3, Vec4};
use std::sync::Arc;

/// A view of any texture with a sampler. Cheap to clone.
///
/// Coordinates may be any number: NaN and infinities read some texel, as `docs/NUMERICS.md` says.
/// For integer formats, every function gives the [bits](Real::to_bits).
#[derive(Debug, Clone)]
pub struct SampledTexture {
    pub(crate) view: TexelView,
    pub(crate) sampler: SamplerDescriptor,
    /// The sampler of the common kind of view, if this is one: 2D, four 8-bit channels, WebGPU's
    /// address modes.
    common: Option<Rgba8Texture>,
    /// The texel decoder of packet code; `None` for formats without packet code.
    pub(crate) packets: Option<PacketFormat>,
    /// True if view and sampler allow the common case of a packet (`packet/inside.rs`): linear
    /// filtering in one image of each level, with wrapped coordinates or on a cube's face.
    pub(crate) is_simple: bool,
    /// The mip levels, if view and sampler are those of `packet/bytes.rs`: as for the common case,
    /// and anisotropic filtering, of a format of bytes.
    pub(crate) level_table: Option<Arc<LevelTable>>,
    /// True if the level of detail is of no effect: one mip level, and the same filter for
    /// magnification and minification.
    pub(crate) ignores_lod: bool,
    /// The SIMD level of packet code.
    pub(crate) level: Level,
    /// The depths, if comparisons read them as [`sample_compare_level`] does.
    depths: Option<ShadowMap>,
}

impl Sample2d for SampledTexture {
    #[inline(always)]
    fn sample<R: Real>(&self, uv: Vec2<R>) -> Vec4<R> {
        Self::sample(self, uv)
    }
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
    /// those of [`sample_compare_level`]. The results are the same.
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

    /// Samples with the level of detail of the quad (`textureSample`); at a varying with a
    /// [gradient](estampe_types::WithGradient), with that of the fragment itself.
    #[inline(always)]
    pub fn sample<R: Real>(&self, at: impl TextureCoordinates<R>) -> Vec4<R> {
        if let Some([dx, dy]) = at.gradient() {
            return self.sample_at_gradient(at.coordinates(), dx, dy);
        }
        at.coordinates().uvw.x.takes_derivatives();
        if let Some(common) = &self.common {
            let uvw = at.coordinates().uvw;
            return common.sample(Vec2::new(uvw.x, uvw.y));
        }
        self.sample_other(at)
    }

    /// Samples with the level of detail of a fragment's derivatives.
    #[inline(always)]
    fn sample_at_gradient<R: Real>(&self, at: Coordinates<R>, dx: Vec3<R>, dy: Vec3<R>) -> Vec4<R> {
        if let Some(common) = &self.common {
            let [at, dx, dy] = [at.uvw, dx, dy].map(|of| Vec2::new(of.x, of.y));
            return common.sample_grad(at, dx, dy);
        }
        at.uvw.x.out_of_line(
            #[inline(always)]
            move || self.sample_with(at, Lod::Gradients(dx, dy), [0; 3]),
        )
    }

    /// Samples a texture that is not [common](Self::common), outside the shader's code.
    #[inline(always)]
    fn sample_other<R: Real>(&self, at: impl TextureCoordinates<R>) -> Vec4<R> {
        let at = at.coordinates();
        at.uvw.x.out_of_line(
            #[inline(always)]
            move || self.sample_with(at, Lod::Implicit, [0; 3]),
        )
    }

    /// Samples several textures at the same coordinates, such as a surface's colour and its normal
    /// map. The results are those of [`Self::sample`]; for 2D textures of four 8-bit channels, one
    /// size and one sampler state, what they have in common is computed once.
    #[inline(always)]
    pub fn sample_all<R: Real, const N: usize>(
        textures: [&Self; N],
        at: impl TextureCoordinates<R>,
    ) -> [Vec4<R>; N] {
        let gradient = at.gradient();
        if gradient.is_none() {
            at.coordinates().uvw.x.takes_derivatives();
        }
        if let Some(common) = all_common(&textures) {
            let two = |of: Vec3<R>| Vec2::new(of.x, of.y);
            let uv = two(at.coordinates().uvw);
            return match gradient {
                Some([dx, dy]) => Rgba8Texture::sample_all_grad(common, uv, [two(dx), two(dy)]),
                None => Rgba8Texture::sample_all(common, uv),
            };
        }
        let mut colors = [Vec4::repeat(at.coordinates().uvw.x); N];
        for (color, texture) in colors.iter_mut().zip(textures) {
            *color = match gradient {
                Some([dx, dy]) => texture.sample_at_gradient(at.coordinates(), dx, dy),
                None => texture.sample_other(at),
            };
        }
        colors
    }

    /// Samples with a bias that is added to the level of detail of the quad (`textureSampleBias`).
    #[inline(always)]
    pub fn sample_bias<R: Real>(&self, at: impl TextureCoordinates<R>, bias: R) -> Vec4<R> {
        self.sample_with(at, Lod::Bias(bias), [0; 3])
    }

    /// Samples at a level of detail (`textureSampleLevel`): 0 is the base level, each further level
    /// is half as large.
    #[inline(always)]
    pub fn sample_level<R: Real>(&self, at: impl TextureCoordinates<R>, level: R) -> Vec4<R> {
        self.sample_with(at, Lod::Level(level), [0; 3])
    }

    /// Samples with the level of detail of the coordinates' derivatives along x and along y
    /// (`textureSampleGrad`); of 2D views their third component is without effect.
    #[inline(always)]
    pub fn sample_grad<R: Real>(
        &self,
        at: impl TextureCoordinates<R>,
        dx: Vec3<R>,
        dy: Vec3<R>,
    ) -> Vec4<R> {
        self.sample_with(at, Lod::Gradients(dx, dy), [0; 3])
    }

    /// Samples with the level of detail that `lod` determines, `offset` texels from the coordinates
    /// (`textureSampleBias`, `textureSampleLevel`, `textureSampleGrad`). Cubes take no offsets.
    #[inline(always)]
    pub fn sample_with<R: Real>(
        &self,
        at: impl TextureCoordinates<R>,
        lod: Lod<R>,
        offset: [i32; 3],
    ) -> Vec4<R> {
        let at = at.coordinates();
        if lod.takes_derivatives() {
            at.uvw.x.takes_derivatives();
        }
        by_sixteen(
            at.uvw.x,
            #[inline(always)]
            |first| {
                PacketRequest::with(
                    &at,
                    &lod,
                    (None, offset),
                    first,
                    #[inline(always)]
                    |lanes| {
                        let mut colors = Answers::default();
                        self.sample_lanes(lanes, &mut colors);
                        colors
                    },
                )
            },
        )
    }

    /// One channel, 0 to 3, of the four texels of the base level around the coordinates
    /// (`textureGather`): lower left, lower right, upper right, upper left, v pointing down. 1D and
    /// 3D textures give zeros.
    #[inline(always)]
    pub fn gather<R: Real>(
        &self,
        at: impl TextureCoordinates<R>,
        channel: usize,
        offset: [i32; 2],
    ) -> Vec4<R> {
        let at = at.coordinates();
        at.uvw.x.out_of_line(
            #[inline(always)]
            || {
                let more = (None, [offset[0], offset[1], 0]);
                by_sixteen(
                    at.uvw.x,
                    #[inline(always)]
                    |first| {
                        PacketRequest::with(
                            &at,
                            &Lod::Implicit,
                            more,
                            first,
                            #[inline(always)]
                            |lanes| self.gather_lanes(lanes, channel),
                        )
                    },
                )
            },
        )
    }

    /// The filtered share of texels against which `reference` passes the comparison
    /// (`textureSampleCompare`), 0 to 1. Without a comparison in the sampler, 0.
    #[inline(always)]
    pub fn sample_compare<R: Real>(
        &self,
        at: impl TextureCoordinates<R>,
        reference: R,
        lod: Lod<R>,
        offset: [i32; 2],
    ) -> R {
        let at = at.coordinates();
        if lod.takes_derivatives() {
            reference.takes_derivatives();
        }
        if let Some(depths) = self.depths.as_ref().filter(|_| offset == [0; 2]) {
            return sample_compare_level(depths, Vec2::new(at.uvw.x, at.uvw.y), reference);
        }
        reference.out_of_line(
            #[inline(always)]
            || {
                let more = (Some(reference), [offset[0], offset[1], 0]);
                by_sixteen(
                    reference,
                    #[inline(always)]
                    |first| {
                        PacketRequest::with(
                            &at,
                            &lod,
                            more,
                            first,
                            #[inline(always)]
                            |lanes| {
                                let mut answers = Answers::default();
                                self.compare_lanes(lanes, &mut answers);
                                answers
                            },
                        )
                    },
                )
                .x
            },
        )
    }

    /// The comparison of `reference` with each of the four texels around the coordinates, 1 or 0
    /// (`textureGatherCompare`), in the order of [`SampledTexture::gather`].
    #[inline(always)]
    pub fn gather_compare<R: Real>(
        &self,
        at: impl TextureCoordinates<R>,
        reference: R,
        offset: [i32; 2],
    ) -> Vec4<R> {
        let at = at.coordinates();
        reference.out_of_line(
            #[inline(always)]
            || {
                let more = (Some(reference), [offset[0], offset[1], 0]);
                by_sixteen(
                    reference,
                    #[inline(always)]
                    |first| {
                        PacketRequest::with(
                            &at,
                            &Lod::Implicit,
                            more,
                            first,
                            #[inline(always)]
                            |lanes| self.gather_compare_lanes(lanes),
                        )
                    },
                )
            },
        )
    }
}

/// The textures as [`Rgba8Texture`]s, if all of them are.
#[inline(always)]
fn all_common<'t, const N: usize>(
    textures: &[&'t SampledTexture; N],
) -> Option<[&'t Rgba8Texture; N]> {
    let first = textures.first()?.common.as_ref()?;
    let mut common = [first; N];
    for (common, texture) in common.iter_mut().zip(textures) {
        *common = texture.common.as_ref()?;
    }
    Some(common)
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
