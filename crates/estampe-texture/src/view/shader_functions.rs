//! The functions by which a shader samples, gathers and compares a [`SampledTexture`].

use super::coordinates::{Answers, Coordinates, Lod, TextureCoordinates, by_sixteen};
use super::{PacketRequest, SampledTexture};
use crate::{Rgba8Texture, sample_compare_level};
use estampe_types::shader::Sample2d;
use estampe_types::{Real, Vec2, Vec3, Vec4};

impl Sample2d for SampledTexture {
    #[inline(always)]
    fn sample<R: Real>(&self, uv: Vec2<R>) -> Vec4<R> {
        Self::sample(self, uv)
    }
}

impl SampledTexture {
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
                            |lanes| {
                                let mut texels = Answers::default();
                                self.gather_lanes(lanes, channel, &mut texels);
                                texels
                            },
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
                            |lanes| {
                                let mut results = Answers::default();
                                self.gather_compare_lanes(lanes, &mut results);
                                results
                            },
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
