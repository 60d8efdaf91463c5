//! Where a light looks from, so that its map holds the whole model.

use crate::shading::shadow::{FILTER_RADIUS, ShadowMapView};
use crate::transforms::projection::{self, DepthConvention, Frustum};
use crate::transforms::view::CameraFrame;
use crate::transforms::{round_to_f32, to_f32};
use glam::{DMat4, DVec3};

/// A light that casts a shadow, in view space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum ShadowSource {
    /// The unit direction towards the light.
    Directional([f32; 3]),
    /// The light's position.
    Positional([f32; 3]),
}

/// The map of a light, given the corners of the model's box in view space; `None` if the model is
/// not in front of it: then the light is inside the box, or too near it for one map.
pub(super) fn fitted(
    source: ShadowSource,
    corners: &[DVec3; 8],
    view_from_unit: &DMat4,
    (number, side_texels): (usize, u32),
) -> Option<ShadowMapView> {
    let side = f64::from(side_texels);
    /// The distance, in sizes of the model, from which light is as good as parallel.
    const FAR: f64 = 1e3;
    // So that the filter stays on the map at the model's silhouette.
    let border = side / (side - 2.0 * f64::from(FILTER_RADIUS) - 2.0);
    let (clip_from_view, axis, texel_at_1) = match source {
        ShadowSource::Directional(towards) => {
            let towards = DVec3::from(towards.map(f64::from)).try_normalize()?;
            let (clip, widest) = parallel(towards, corners, border);
            (clip, towards, widest / side)
        }
        ShadowSource::Positional(position) => {
            let eye = DVec3::from(position.map(f64::from));
            let middle = corners.iter().sum::<DVec3>() / 8.0;
            let size = (corners[7] - corners[0]).length();
            if eye.distance(middle) > FAR * size {
                let towards = (eye - middle).as_vec3().to_array();
                let parallel = ShadowSource::Directional(towards);
                return fitted(parallel, corners, view_from_unit, (number, side_texels));
            }
            let (clip, widest) = central(eye, corners, border)?;
            (clip, (eye - middle).normalize_or_zero(), widest / side)
        }
    };
    // The filter's corner is the furthest.
    let reach = f64::from(FILTER_RADIUS) * std::f64::consts::SQRT_2 + 0.5;
    Some(ShadowMapView {
        binding: u32::try_from(number).ok()?,
        side: side_texels,
        clip_from_unit: to_f32(&(clip_from_view * *view_from_unit)).into(),
        clip_from_view: to_f32(&clip_from_view).into(),
        axis: axis.as_vec3().to_array(),
        texel: round_to_f32(1.0 / side),
        normal_offset: round_to_f32(reach * texel_at_1),
    })
}

/// Parallel light: the projection, and the width of what the map shows.
fn parallel(towards: DVec3, corners: &[DVec3; 8], border: f64) -> (DMat4, f64) {
    let frame = CameraFrame::look_at(towards, DVec3::ZERO, DVec3::Y);
    let light_from_view = frame.view_from_world();
    let (least, most) = box_of(corners.map(|corner| light_from_view.transform_point3(corner)));
    let middle = (least + most) / 2.0;
    let half = (most - least).max_element().max(1e-6) / 2.0 * border;
    let depth = (most.z - least.z).max(1e-6) * 0.01;
    let frustum = Frustum {
        left: middle.x - half,
        right: middle.x + half,
        bottom: middle.y - half,
        top: middle.y + half,
        near: -most.z - depth,
        far: -least.z + depth,
    };
    let clip = projection::orthographic(&frustum, DepthConvention::ZeroToOne) * light_from_view;
    (clip, 2.0 * half)
}

/// Light from a point: the projection, and the width of what the map shows in the distance 1.
fn central(eye: DVec3, corners: &[DVec3; 8], border: f64) -> Option<(DMat4, f64)> {
    /// The tangent of half of the widest angle: 140° in all.
    const WIDEST: f64 = 2.75;
    let middle = corners.iter().sum::<DVec3>() / 8.0;
    let frame = CameraFrame::look_at(eye, middle, DVec3::Y);
    let light_from_view = frame.view_from_world();
    let in_light = corners.map(|corner| light_from_view.transform_point3(corner));
    let (least, most) = box_of(in_light);
    let (nearest, furthest) = (-most.z, -least.z);
    let size = (most - least).max_element();
    if nearest <= size * 1e-3 {
        return None;
    }
    let tangents = in_light.map(|p| (p.x / -p.z).abs().max((p.y / -p.z).abs()));
    let half = tangents.into_iter().fold(1e-6, f64::max) * border;
    if half > WIDEST {
        return None;
    }
    let near = nearest * 0.98;
    let frustum = Frustum {
        left: -half * near,
        right: half * near,
        bottom: -half * near,
        top: half * near,
        near,
        far: furthest * 1.02,
    };
    let clip = projection::frustum(&frustum, DepthConvention::ZeroToOne) * light_from_view;
    Some((clip, 2.0 * half))
}

fn box_of(points: [DVec3; 8]) -> (DVec3, DVec3) {
    let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    points
        .into_iter()
        .fold(nothing, |(least, most), p| (least.min(p), most.max(p)))
}
