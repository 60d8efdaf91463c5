//! The layers of a material at a point: each factor times its texture.

use super::iridescence::Film;
use super::parameters::{
    ClearcoatParameters, IridescenceParameters, PbrParameters, SheenParameters,
};
use super::reflection::{Coat, Fibres};
use super::surface::TangentFrame;
use estampe::{Real, Vec2, Vec3};

/// F0 and F90 of the dielectric.
#[inline(always)]
pub(super) fn dielectric<R: Real>(
    parameters: &PbrParameters,
    uvs: (Vec2<R>, Vec2<R>),
    one: R,
) -> (Vec3<R>, R) {
    let Some(specular) = &parameters.specular else {
        return (Vec3::repeat(one * parameters.dielectric_f0), one);
    };
    let mut color = Vec3::uniform(one, specular.color);
    if let Some(texture) = &specular.color_texture {
        color *= texture.sample(uvs).xyz();
    }
    let mut factor = one * specular.factor;
    if let Some(texture) = &specular.texture {
        factor *= texture.sample(uvs).w;
    }
    let f0 = color * parameters.dielectric_f0;
    let f0 = Vec3::new(f0.x.min(one), f0.y.min(one), f0.z.min(one));
    (f0 * factor, factor)
}

#[inline(always)]
pub(super) fn fibres<R: Real>(
    sheen: &SheenParameters,
    uvs: (Vec2<R>, Vec2<R>),
    one: R,
) -> Fibres<R> {
    let mut color = Vec3::uniform(one, sheen.color);
    if let Some(texture) = &sheen.color_texture {
        color *= texture.sample(uvs).xyz();
    }
    let mut roughness = one * sheen.roughness;
    if let Some(texture) = &sheen.roughness_texture {
        roughness *= texture.sample(uvs).w;
    }
    Fibres { color, roughness }
}

#[inline(always)]
pub(super) fn thin_film<R: Real>(
    film: &IridescenceParameters,
    uvs: (Vec2<R>, Vec2<R>),
    one: R,
) -> Film<R> {
    let mut factor = one * film.factor;
    if let Some(texture) = &film.texture {
        factor *= texture.sample(uvs).x;
    }
    let [least, most] = film.thickness_nm;
    Film {
        factor: factor.saturate(),
        ior: film.ior,
        thickness_nm: match &film.thickness_texture {
            Some(texture) => texture.sample(uvs).y * (most - least) + least,
            None => one * most,
        },
    }
}

#[inline(always)]
pub(super) fn clearcoat<R: Real>(
    coat: &ClearcoatParameters,
    uvs: (Vec2<R>, Vec2<R>),
    frame: &TangentFrame<R>,
    one: R,
) -> Coat<R> {
    let mut factor = one * coat.factor;
    if let Some(texture) = &coat.texture {
        factor *= texture.sample(uvs).x;
    }
    let mut roughness = one * coat.roughness;
    if let Some(texture) = &coat.roughness_texture {
        roughness *= texture.sample(uvs).y;
    }
    Coat {
        factor,
        roughness: roughness.saturate(),
        normal: match &coat.normal {
            Some(map) => frame.normal_of(map, uvs),
            None => frame.unit,
        },
    }
}
