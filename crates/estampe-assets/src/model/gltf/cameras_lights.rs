//! The cameras and lights of a scene's nodes, in world space.
//!
//! Both look along −z of their node; its scale does not count.

use super::document::{Document, Index, Light};
use super::fault::{element, malformed, shortened};
use crate::{AssetError, Limits};
use estampe_scene::{Camera, NamedCamera, Projection, PunctualLight, PunctualLightKind};
use glam::{DAffine3, DVec3, Vec3};
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

/// The angle of cameras that have π or more, which no perspective has.
const WIDEST_RAD: f32 = 3.1;

/// The cameras of these nodes.
pub(super) fn cameras(
    nodes: &[usize],
    document: &Document<'_>,
    world_from_node: &[DAffine3],
    limits: &Limits,
) -> Result<Vec<NamedCamera>, AssetError> {
    let mut cameras = Vec::new();
    for &node in nodes {
        let Some(index) = document.nodes[node].camera else {
            continue;
        };
        let place = || format!("/nodes/{node}/camera");
        Limits::check("cameras", cameras.len() as u64 + 1, limits.max_meshes)
            .map_err(|error| error.at_json(place()))?;
        let source = element(&document.cameras, index, "camera", place)?;
        let (projection, aspect) = projection(index, document)?;
        let world_from_node = &world_from_node[node];
        let eye = world_from_node.translation.as_vec3();
        let node_name = &document.nodes[node].name;
        cameras.push(NamedCamera {
            name: named(&source.name, node_name),
            camera: Camera {
                eye_world: eye,
                target_world: eye + forward(world_from_node),
                up_world: unit_or(world_from_node.matrix3.y_axis, Vec3::Y),
                projection,
            },
            aspect,
        });
    }
    Ok(cameras)
}

fn projection(
    index: Index,
    document: &Document<'_>,
) -> Result<(Projection, Option<f32>), AssetError> {
    let source = &document.cameras[index.0];
    let pointer = format!("/cameras/{index}");
    if let Some(lens) = &source.perspective {
        let pointer = format!("{pointer}/perspective");
        let far = lens.zfar.unwrap_or(f32::INFINITY);
        if lens.yfov <= 0.0 {
            let what = format!("the angle {} is not above 0", lens.yfov);
            return Err(malformed(format!("{pointer}/yfov"), what));
        }
        check_range(lens.znear, far, lens.znear > 0.0, &pointer)?;
        let projection = Projection::Perspective {
            fov_y_rad: lens.yfov.min(WIDEST_RAD),
            near: lens.znear,
            far,
        };
        let aspect = lens.aspect_ratio;
        return Ok((
            projection,
            aspect.filter(|&ratio| ratio > 0.0 && ratio.is_finite()),
        ));
    }
    let Some(lens) = &source.orthographic else {
        let what = "the camera has neither `perspective` nor `orthographic`";
        return Err(malformed(pointer, what));
    };
    let pointer = format!("{pointer}/orthographic");
    // Negative magnifications mirror the picture, which is advised against.
    let (width, height) = (lens.xmag.abs(), lens.ymag.abs());
    if !(width > 0.0 && height > 0.0 && width.is_finite() && height.is_finite()) {
        return Err(malformed(pointer, "a magnification is 0 or infinite"));
    }
    check_range(lens.znear, lens.zfar, true, &pointer)?;
    let projection = Projection::Orthographic {
        half_height: height,
        near: lens.znear,
        far: lens.zfar,
    };
    Ok((projection, Some(width / height)))
}

fn check_range(near: f32, far: f32, is_valid: bool, pointer: &str) -> Result<(), AssetError> {
    if is_valid && near.is_finite() && far > near {
        return Ok(());
    }
    let what = format!("the range from {near} to {far} is not one of distances");
    Err(malformed(format!("{pointer}/znear"), what))
}

/// The lights of these nodes.
pub(super) fn lights(
    nodes: &[usize],
    document: &Document<'_>,
    world_from_node: &[DAffine3],
    limits: &Limits,
) -> Result<Vec<PunctualLight>, AssetError> {
    let mut lights = Vec::new();
    for &node in nodes {
        let source = &document.nodes[node];
        let Some(used) = &source.extensions.light else {
            continue;
        };
        let index = used.light;
        let place = || format!("/nodes/{node}/extensions/KHR_lights_punctual/light");
        Limits::check("lights", lights.len() as u64 + 1, limits.max_meshes)
            .map_err(|error| error.at_json(place()))?;
        let light = element(document.extensions.lights(), index, "light", place)?;
        let Some(kind) = light_kind(light, index, &world_from_node[node])? else {
            continue;
        };
        let color = Vec3::from_array(light.color.unwrap_or([1.0; 3]));
        let limit = Vec3::splat(f32::MAX);
        lights.push(PunctualLight {
            name: named(&light.name, &source.name),
            kind,
            color: color.clamp(Vec3::ZERO, limit),
            intensity: light.intensity.unwrap_or(1.0).clamp(0.0, f32::MAX),
        });
    }
    Ok(lights)
}

/// The kind of a light; `None` if its name is unknown.
fn light_kind(
    light: &Light,
    index: Index,
    world_from_node: &DAffine3,
) -> Result<Option<PunctualLightKind>, AssetError> {
    let pointer = format!("/extensions/KHR_lights_punctual/lights/{index}");
    let position_world = world_from_node.translation.as_vec3();
    let direction_world = forward(world_from_node);
    let range = light
        .range
        .filter(|&range| range > 0.0 && range.is_finite());
    Ok(Some(match &*light.kind {
        "directional" => PunctualLightKind::Directional { direction_world },
        "point" => PunctualLightKind::Point {
            position_world,
            range,
        },
        "spot" => {
            let spot = light.spot.as_ref();
            let inner = spot.and_then(|spot| spot.inner_cone_angle).unwrap_or(0.0);
            let outer = spot
                .and_then(|spot| spot.outer_cone_angle)
                .unwrap_or(FRAC_PI_4);
            if !(0.0 <= inner && inner < outer && outer <= FRAC_PI_2) {
                let what =
                    format!("the cone's angles {inner} and {outer} do not increase from 0 to π/2");
                return Err(malformed(format!("{pointer}/spot"), what));
            }
            PunctualLightKind::Spot {
                position_world,
                direction_world,
                range,
                inner_cone_rad: inner,
                outer_cone_rad: outer,
            }
        }
        _ => return Ok(None),
    }))
}

/// The direction in which a node's camera or light looks.
fn forward(world_from_node: &DAffine3) -> Vec3 {
    unit_or(-world_from_node.matrix3.z_axis, Vec3::NEG_Z)
}

/// The unit vector; `default` if the node's scale is 0.
fn unit_or(vector: DVec3, default: Vec3) -> Vec3 {
    vector
        .try_normalize()
        .map_or(default, |unit| unit.as_vec3())
}

fn named(own: &str, of_node: &str) -> String {
    shortened(if own.is_empty() { of_node } else { own })
}
