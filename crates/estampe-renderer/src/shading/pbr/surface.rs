//! The shader of physically based surfaces.

use super::anisotropy::Grooves;
use super::environment::EnvironmentLight;
use super::layers::{clearcoat, dielectric, fibres, thin_film};
use super::lights::PbrLight;
use super::parameters::{NormalMap, PbrParameters};
use super::reflection::PbrPoint;
use super::tone_map::ToneMap;
use super::transmission::{BEHIND_GROUP, Behind, BehindView, PassedPoint, Seen};
use crate::shading::base_color::Alpha;
use crate::shading::cut_out;
use crate::shading::output::Output;
use crate::shading::shadow::{ShadowMapView, Visibilities};
use crate::shading::surface::Written;
use crate::shading::{VertexTransforms, shading_normal};
use estampe::{
    FragmentIn, FragmentOut, Real, TextureBindings, Vec2, Vec3, Vec4, VertexIn, VertexOut,
    WithGradient,
};
use std::sync::Arc;

/// The light of a frame, and how it is shown.
#[derive(Debug, Clone)]
pub struct PbrLighting {
    pub environment: EnvironmentLight,
    pub lights: Vec<PbrLight>,
    /// The shadow maps of lights, and of the environment.
    pub shadow_maps: Vec<ShadowMapView>,
    /// What is seen through surfaces, if light passes through some.
    pub behind: Option<BehindView>,
    /// Factor of all light.
    pub exposure: f32,
    pub tone_map: ToneMap,
}

/// A surface.
#[derive(Debug, Clone)]
pub struct PbrSurface {
    pub transforms: VertexTransforms,
    pub lighting: Arc<PbrLighting>,
    pub parameters: Arc<PbrParameters>,
    pub alpha: Alpha,
    pub output: Output,
    pub written: Written,
}

/// What is interpolated: view position, normal, tangent with the bitangent's sign, both texture
/// coordinates, colour.
type Interpolated<R> = (
    Vec3<R>,
    Vec3<R>,
    Vec4<R>,
    (WithGradient<Vec2<R>>, WithGradient<Vec2<R>>),
    Vec4<R>,
);

/// The frame of normal maps at a fragment, as MikkTSpace wants it: as interpolated.
#[derive(Debug, Clone, Copy)]
pub(super) struct TangentFrame<R> {
    tangent: Vec3<R>,
    bitangent: Vec3<R>,
    normal: Vec3<R>,
    /// The unit normal of the side that is seen.
    pub(super) unit: Vec3<R>,
    front_facing_sign: R,
}

impl<R: Real> TangentFrame<R> {
    /// The unit normal of a map.
    #[inline(always)]
    pub(super) fn normal_of(&self, map: &NormalMap, uvs: (Vec2<R>, Vec2<R>)) -> Vec3<R> {
        let texel = map.texture.sample(uvs);
        let (x, y, z) = (
            texel.x * 2.0 - 1.0,
            texel.y * 2.0 - 1.0,
            texel.z * 2.0 - 1.0,
        );
        let bent = self.tangent * (x * map.scale) + self.bitangent * (y * map.scale);
        let bent = (bent + self.normal * z) * self.front_facing_sign;
        let squared = bent.dot(bent);
        let is_bent = squared.gt(1e-12) & squared.lt(f32::INFINITY);
        Vec3::select(is_bent, bent / squared.sqrt(), self.unit)
    }
}

impl PbrSurface {
    #[inline(always)]
    fn frame<R: Real>(
        &self,
        input: &FragmentIn<'_, R>,
        v: &Interpolated<R>,
        to_eye: Vec3<R>,
    ) -> TangentFrame<R> {
        let (view, normal, tangent, uvs, _) = *v;
        let uvs = (uvs.0.value, uvs.1.value);
        let one = input.real(1.0);
        let unit = shading_normal(normal, to_eye, input.front_facing);
        let sign = R::select(input.front_facing, one, -one);
        let given = tangent.xyz();
        let mut frame = TangentFrame {
            tangent: given,
            bitangent: normal.cross(given) * tangent.w,
            normal,
            unit,
            front_facing_sign: sign,
        };
        let has_tangent = given.dot(given).gt(1e-6);
        if !R::all(has_tangent) {
            // Without tangents: the directions in which the texture coordinates grow.
            let uv = match &self.parameters.normal {
                Some(map) => map.texture.coordinates.of(uvs),
                None => uvs.0,
            };
            let made = one.out_of_line(
                #[inline(always)]
                || frame_of_derivatives(view, unit * sign, uv),
            );
            frame.tangent = Vec3::select(has_tangent, frame.tangent, made[0]);
            frame.bitangent = Vec3::select(has_tangent, frame.bitangent, made[1]);
            frame.normal = Vec3::select(has_tangent, frame.normal, unit * sign);
        }
        frame
    }

    /// The reflectance of a fragment.
    #[inline(always)]
    fn point<R: Real>(
        &self,
        input: &FragmentIn<'_, R>,
        v: &Interpolated<R>,
        base: Vec3<R>,
    ) -> (PbrPoint<R>, Option<Behind<R>>) {
        let parameters = &*self.parameters;
        let (view, _, _, uvs, _) = *v;
        let uvs = (uvs.0.value, uvs.1.value);
        let one = input.real(1.0);
        let to_eye = self.transforms.eye_direction(view);
        let frame = self.frame(input, v, to_eye);
        let normal = match &parameters.normal {
            Some(map) => one.out_of_line(
                #[inline(always)]
                || frame.normal_of(map, uvs),
            ),
            None => frame.unit,
        };
        let mut metallic = one * parameters.metallic;
        let mut roughness = one * parameters.roughness;
        if let Some(texture) = &parameters.metallic_roughness_texture {
            let texel = texture.sample(uvs);
            if parameters.is_metallic_textured {
                metallic *= texel.z;
            }
            if parameters.is_roughness_textured {
                roughness *= texel.y;
            }
        }
        let occlusion = match &parameters.occlusion {
            Some(map) => {
                let texel = map.texture.sample(uvs);
                ((texel.x - 1.0) * map.strength + 1.0).saturate()
            }
            None => one,
        };
        let roughness = roughness.saturate();
        let (f0, f90) = dielectric(parameters, uvs, one);
        let mut diffuse = base * (one - metallic);
        let behind = self.behind(
            input,
            uvs,
            PassedPoint {
                position: view,
                normal,
                to_eye,
                roughness,
            },
        );
        let mut passing = None;
        if let Some(behind) = &behind {
            passing = Some(diffuse * behind.share * behind.tint);
            diffuse *= one - behind.share;
        }
        let mut sheen = None;
        if let Some(parameters) = &parameters.sheen {
            sheen = Some(one.out_of_line(
                #[inline(always)]
                || fibres(parameters, uvs, one),
            ));
        }
        let mut coat = None;
        if let Some(parameters) = &parameters.clearcoat {
            coat = Some(one.out_of_line(
                #[inline(always)]
                || clearcoat(parameters, uvs, &frame, one),
            ));
        }
        let mut film = None;
        if let Some(parameters) = &parameters.iridescence {
            film = Some(one.out_of_line(
                #[inline(always)]
                || thin_film(parameters, uvs, one),
            ));
        }
        let point = PbrPoint {
            position: view,
            normal,
            to_eye,
            visibilities: Visibilities::at(&self.lighting.shadow_maps, input, view, frame.unit),
            diffuse,
            passing,
            f0: f0.mix(base, metallic),
            f90: f90.mix(one, metallic),
            roughness: filtered(roughness, normal),
            occlusion,
            clearcoat: coat,
            sheen,
            grooves: match &parameters.anisotropy {
                Some(parameters) => {
                    let across = [frame.tangent, frame.bitangent];
                    Some(one.out_of_line(
                        #[inline(always)]
                        || Grooves::new(parameters, uvs, across, normal),
                    ))
                }
                None => None,
            },
            film,
        };
        (point, behind)
    }

    /// The light from behind the surface, if some passes.
    #[inline(always)]
    fn behind<R: Real>(
        &self,
        input: &FragmentIn<'_, R>,
        uvs: (Vec2<R>, Vec2<R>),
        point: PassedPoint<R>,
    ) -> Option<Behind<R>> {
        let transmission = self.parameters.transmission.as_ref()?;
        let view = self.lighting.behind.as_ref()?;
        let picture = input.bindings.sampled_texture(BEHIND_GROUP, 0);
        let passed = point.roughness.out_of_line(
            #[inline(always)]
            || transmission.behind((view, picture), point, uvs),
        );
        Some(passed)
    }

    /// The colour of a fragment, as it is shown.
    #[inline(always)]
    fn seen<R: Real>(
        &self,
        input: &FragmentIn<'_, R>,
        v: &Interpolated<R>,
        base: Vec3<R>,
    ) -> Seen<R> {
        let opaque = |color| Seen {
            color,
            opacity: None,
        };
        let parameters = &*self.parameters;
        if parameters.is_unlit {
            return opaque(base);
        }
        let PbrLighting {
            environment,
            lights,
            exposure,
            tone_map,
            ..
        } = &*self.lighting;
        let (point, behind) = self.point(input, v, base);
        let leaving = point.leaving(environment, lights);
        let mut emitted = Vec3::uniform(input.zero, parameters.emissive);
        if let Some(texture) = &parameters.emissive_texture {
            emitted *= texture.sample((v.3.0.value, v.3.1.value)).xyz();
        }
        let sum = (leaving.reflected + emitted) * *exposure;
        if self.written == Written::Light {
            return opaque(sum);
        }
        let (Some(behind), Some(passing), Some(view)) =
            (behind, leaving.passing, &self.lighting.behind)
        else {
            return opaque(tone_map.apply(sum));
        };
        // The covered part of what is behind has a tone of its own.
        let covered = tone_map.apply(sum + passing * behind.covered_light());
        let shown = tone_map.apply(sum).mix(covered, behind.coverage);
        let clear = passing * (Vec3::repeat(input.real(1.0)) - behind.coverage);
        input.zero.out_of_line(
            #[inline(always)]
            || view.over_background(input, shown, clear),
        )
    }
}

/// The roughness with the spread of the normals that a pixel covers, so that small highlights do
/// not flicker (Y. Tokuyoshi, A. Kaplanyan, "Improved Geometric Specular Antialiasing", 2019).
#[inline(always)]
fn filtered<R: Real>(roughness: R, normal: Vec3<R>) -> R {
    /// Variance of the pixel filter, and the most that is added to α².
    const VARIANCE: f32 = 0.25;
    const MOST: f32 = 0.18;
    let across = Vec3::new(normal.x.ddx(), normal.y.ddx(), normal.z.ddx());
    let down = Vec3::new(normal.x.ddy(), normal.y.ddy(), normal.z.ddy());
    let spread = across.dot(across) + down.dot(down);
    let added = (spread * (2.0 * VARIANCE)).min(MOST);
    let alpha = roughness * roughness;
    (alpha * alpha + added).min(1.0).sqrt().sqrt()
}

/// Tangent and bitangent of the texture coordinates' derivatives, with a unit normal; zero where
/// the coordinates do not change.
#[inline(always)]
fn frame_of_derivatives<R: Real>(view: Vec3<R>, normal: Vec3<R>, uv: Vec2<R>) -> [Vec3<R>; 2] {
    let step_x = Vec3::new(view.x.ddx(), view.y.ddx(), view.z.ddx());
    let step_y = Vec3::new(view.x.ddy(), view.y.ddy(), view.z.ddy());
    let (uv_x, uv_y) = (
        Vec2::new(uv.x.ddx(), uv.y.ddx()),
        Vec2::new(uv.x.ddy(), uv.y.ddy()),
    );
    let (r1, r2) = (step_y.cross(normal), normal.cross(step_x));
    let tangent = r1 * uv_x.x + r2 * uv_y.x;
    // v points down in images, and up in tangent space.
    let bitangent = -(r1 * uv_x.y + r2 * uv_y.y);
    let longest = tangent.dot(tangent).max(bitangent.dot(bitangent));
    let length = longest.sqrt();
    let scale = 1.0 / R::select(step_x.dot(r1).lt(0.0), -length, length);
    let has_any = longest.gt(1e-30);
    let none = Vec3::repeat(longest.splat(0.0));
    [
        Vec3::select(has_any, tangent * scale, none),
        Vec3::select(has_any, bitangent * scale, none),
    ]
}

estampe::shader! {
    impl Shader for PbrSurface {
        // Position, normal, tangent, texture coordinates, colour.
        type Attributes<R: Real> = Interpolated<R>;
        type Varyings<R: Real> = Interpolated<R>;

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, normal, tangent, uvs, color): Interpolated<R>,
        ) -> VertexOut<R, Interpolated<R>> {
            let transforms = &self.transforms;
            let direction = transforms.normal(tangent.xyz());
            let varyings = (
                transforms.view(position),
                transforms.normal(normal),
                direction.extend(tangent.w),
                uvs,
                color,
            );
            VertexOut::new(transforms.clip(position), varyings)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, v: Interpolated<R>) -> FragmentOut<R> {
            let mut base = v.4 * Vec4::uniform(input.zero, self.parameters.base);
            if let Some(texture) = &self.parameters.base_texture {
                // Light takes derivatives, and so does the alpha of a smooth edge: then quads are
                // needed all the same, and cost less than derivatives of their own.
                let needs_quads =
                    !self.parameters.is_unlit || matches!(self.alpha, Alpha::Covers(_));
                base *= match needs_quads {
                    true => texture.sample((v.3.0.value, v.3.1.value)),
                    false => texture.sample_at_varyings(v.3),
                };
            }
            let seen = self.seen(&input, &v, base.xyz());
            let mut color = self.output.color(&input, seen.color);
            let mut alpha = match self.alpha {
                Alpha::Ignored | Alpha::CutsOut | Alpha::Covers(_) => input.real(1.0),
                Alpha::Kept => base.w,
            };
            if let Some(opacity) = seen.opacity {
                let opacity = self.output.opacity(&input, opacity);
                if self.alpha == Alpha::Kept {
                    // Blending multiplies by alpha.
                    color /= opacity.max(1e-6);
                }
                alpha *= opacity;
            }
            let out = self.written.fragment(&input, color.extend(alpha));
            let cutoff = self.parameters.alpha_cutoff;
            match self.alpha {
                Alpha::CutsOut => cut_out::hard(out, base.w, cutoff),
                Alpha::Covers(samples) => cut_out::smooth(out, base.w, cutoff, samples),
                Alpha::Ignored | Alpha::Kept => out,
            }
        }
    }
}
