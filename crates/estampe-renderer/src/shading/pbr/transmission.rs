//! Light that passes through a surface (KHR_materials_transmission, KHR_materials_volume,
//! KHR_materials_dispersion): the opaque surfaces behind it, drawn before
//! (`behind` of the crate), are looked up where the refracted ray leaves the body.
//!
//! ```text
//!   eye ◄─── v ─── p            p  point of the surface, n normal
//!                  ╲            r  refracted by the index of refraction
//!                   ╲ r·d       d  thickness; 0 without a volume: no offset
//!                    q          q  in the picture: what is seen there, blurred by the roughness
//!
//!   light · base colour · attenuation colour^(d ÷ attenuation distance)         Beer and Lambert
//! ```
//!
//! Each channel has a ray of its own if the body disperses light: with h = (ior − 1)·0.025·D, the
//! indices of red, green and blue are ior − h, ior and ior + h. The level is that of the sample
//! renderer: log₂ of the picture's longer side, times roughness · min(2·ior − 2, 1), so that a body
//! of index 1 does not blur.

use super::textures::MaterialTexture;
use crate::shading::backdrop::Backdrop;
use estampe::{FragmentIn, Mat4, Real, SampledTexture, Vec2, Vec3, Vec4};

/// The group at which the picture of what is behind is bound, as number 0.
pub const BEHIND_GROUP: u32 = 1;

/// The default background, linear. Alpha hides all channels alike, so a coloured surface on a
/// transparent background has the colour that it has on this one.
const LIGHT_BACKGROUND: f32 = 0.887_923_1;

/// The picture of the opaque surfaces, as shaders look it up: light after the exposure and before
/// the tone map, times its coverage in alpha. The rest is the background.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BehindView {
    pub clip_from_view: Mat4,
    /// log₂ of the longer side: the level of one texel.
    pub last_level: f32,
    pub background: Background,
}

/// The background, as it is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Background {
    /// Nothing.
    Transparent,
    /// A linear colour.
    Color([f32; 3]),
    /// The gradient at the surface's own pixel.
    Gradient(Backdrop),
}

/// Transmission of a material.
#[derive(Debug, Clone)]
pub struct TransmissionParameters {
    /// The share of light that passes instead of being diffused.
    pub factor: f32,
    /// In red.
    pub texture: Option<MaterialTexture>,
    /// Indices of refraction of red, green and blue, at least 1.
    pub iors: [f32; 3],
    pub volume: Option<VolumeParameters>,
}

/// The body below a surface.
#[derive(Debug, Clone)]
pub struct VolumeParameters {
    /// In view space.
    pub thickness: f32,
    /// In green.
    pub texture: Option<MaterialTexture>,
    /// Halvings of light per length in view space.
    pub absorption: [f32; 3],
}

/// A point of a surface, as light passes through it.
#[derive(Debug, Clone, Copy)]
pub struct PassedPoint<R> {
    /// In view space.
    pub position: Vec3<R>,
    /// Unit normal.
    pub normal: Vec3<R>,
    /// Unit direction to the eye.
    pub to_eye: Vec3<R>,
    /// Perceptual.
    pub roughness: R,
}

/// The light that arrives at a point from behind.
#[derive(Debug, Clone, Copy)]
pub struct Behind<R> {
    /// The share of light that passes instead of being diffused.
    pub share: R,
    /// The share that the body leaves of it, by channel.
    pub tint: Vec3<R>,
    /// The light of opaque surfaces, times the coverage.
    pub light: Vec3<R>,
    /// The share of each channel that comes from opaque surfaces, not from the background.
    pub coverage: Vec3<R>,
}

impl TransmissionParameters {
    /// The light that arrives at a point, from the picture of what is behind.
    #[inline(always)]
    pub fn behind<R: Real>(
        &self,
        (view, picture): (&BehindView, &SampledTexture),
        point: PassedPoint<R>,
        uvs: (Vec2<R>, Vec2<R>),
    ) -> Behind<R> {
        let one = point.roughness.splat(1.0);
        let mut share = one * self.factor;
        if let Some(texture) = &self.texture {
            share *= texture.sample(uvs).x;
        }
        let mut tint = Vec3::repeat(one);
        let mut thickness = None;
        if let Some(volume) = &self.volume {
            let mut length = one * volume.thickness;
            if let Some(texture) = &volume.texture {
                length *= texture.sample(uvs).y;
            }
            let halvings = Vec3::uniform(one, volume.absorption) * -length;
            tint = Vec3::new(halvings.x.exp2(), halvings.y.exp2(), halvings.z.exp2());
            thickness = Some(length);
        }
        let [red, green, blue] = self.iors;
        if red == blue {
            let seen = view.along_ray(picture, point, thickness, green);
            return Behind {
                share,
                tint,
                light: seen.xyz(),
                coverage: Vec3::repeat(seen.w),
            };
        }
        let along_ray = |ior| {
            one.out_of_line(
                #[inline(always)]
                || view.along_ray(picture, point, thickness, ior),
            )
        };
        let (red, green, blue) = (along_ray(red), along_ray(green), along_ray(blue));
        Behind {
            share,
            tint,
            light: Vec3::new(red.x, green.y, blue.z),
            coverage: Vec3::new(red.w, green.w, blue.w),
        }
    }
}

impl<R: Real> Behind<R> {
    /// The light where opaque surfaces cover.
    #[inline(always)]
    pub fn covered_light(&self) -> Vec3<R> {
        const LEAST: f32 = 1e-4;
        let (light, share) = (self.light, self.coverage);
        Vec3::new(
            light.x / share.x.max(LEAST),
            light.y / share.y.max(LEAST),
            light.z / share.z.max(LEAST),
        )
    }
}

impl BehindView {
    /// The picture where the ray that is refracted by this index leaves the body.
    #[inline(always)]
    fn along_ray<R: Real>(
        &self,
        picture: &SampledTexture,
        point: PassedPoint<R>,
        thickness: Option<R>,
        ior: f32,
    ) -> Vec4<R> {
        let exit = match thickness {
            Some(length) => {
                let ratio = length.splat(1.0 / ior);
                let inside = (-point.to_eye).refract(point.normal, ratio);
                point.position + inside.normalize() * length
            }
            None => point.position,
        };
        let blur = (ior * 2.0 - 2.0).min(1.0) * self.last_level;
        self.seen(picture, exit, point.roughness * blur)
    }

    /// The picture at a point in view space: light, and coverage in alpha.
    #[inline(always)]
    fn seen<R: Real>(&self, picture: &SampledTexture, point: Vec3<R>, level: R) -> Vec4<R> {
        let clip = self.clip_from_view.transform_point(point);
        let (x, y) = (clip.x / clip.w, clip.y / clip.w);
        picture.sample_level(Vec2::new(x * 0.5 + 0.5, y * -0.5 + 0.5), level)
    }

    /// The colour that is shown through a surface: `shown` of the surface and of what is behind it,
    /// and the background's `clear` share.
    #[inline(always)]
    pub fn over_background<R: Real>(
        &self,
        input: &FragmentIn<'_, R>,
        shown: Vec3<R>,
        clear: Vec3<R>,
    ) -> Seen<R> {
        match &self.background {
            Background::Color(color) => Seen {
                color: shown + Vec3::uniform(clear.x, *color) * clear,
                opacity: None,
            },
            Background::Gradient(gradient) if gradient.is_opaque() => Seen {
                color: shown + gradient.color(input).xyz() * clear,
                opacity: None,
            },
            Background::Gradient(gradient) => {
                let (color, opacity) = over_nothing(shown, clear);
                let (behind, hidden) = (gradient.color(input), 1.0 - opacity);
                Seen {
                    color: color + behind.xyz() * hidden,
                    opacity: Some(opacity + behind.w * hidden),
                }
            }
            Background::Transparent => {
                let (color, opacity) = over_nothing(shown, clear);
                Seen {
                    color,
                    opacity: Some(opacity),
                }
            }
        }
    }
}

/// The colour, multiplied by the opacity, and the opacity where nothing is behind a surface.
#[inline(always)]
fn over_nothing<R: Real>(shown: Vec3<R>, clear: Vec3<R>) -> (Vec3<R>, R) {
    // No channel is brighter than alpha, so that highlights stay.
    let least = clear.x.min(clear.y).min(clear.z);
    let tinted = clear - Vec3::repeat(least);
    let color = shown + tinted * LIGHT_BACKGROUND;
    let brightest = color.x.max(color.y).max(color.z);
    (color, (1.0 - least).max(brightest).saturate())
}

/// A colour as it is shown.
#[derive(Debug, Clone, Copy)]
pub struct Seen<R> {
    /// Multiplied by the opacity.
    pub color: Vec3<R>,
    /// Less than 1 where a transparent background is seen through the surface.
    pub opacity: Option<R>,
}
