//! Nodes, skins, cameras and lights.
//!
//! Validator: `NODE_MATRIX_TRS`, `NODE_MATRIX_NON_TRS`, `ROTATION_NON_UNIT`, `VALUE_NOT_IN_RANGE`,
//! `NODE_SKIN_WITH_NON_SKINNED_MESH`, `NODE_WEIGHTS_INVALID`, `UNSATISFIED_DEPENDENCY`,
//! `DUPLICATE_ELEMENTS`, `UNDEFINED_PROPERTY`, `CAMERA_YFOV_GEQUAL_PI`, `VALUE_NOT_IN_LIST`,
//! `CAMERA_ZFAR_LEQUAL_ZNEAR`, `CAMERA_XMAG_YMAG_ZERO`, `KHR_LIGHTS_PUNCTUAL_LIGHT_SPOT_ANGLES`,
//! `SCENE_NON_ROOT_NODE`.

use super::super::document::{Camera, Document, Index, Light, Mesh, Node};
use super::Report;
use glam::DVec3;
use std::collections::HashSet;
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// Difference from 1 of the squared length of a unit quaternion: that of four normalized bytes.
const MAX_UNIT_ERROR: f64 = 0.007_69;
/// Warns of nodes that are drawn and break a rule.
pub(super) fn check(document: &Document<'_>, report: &mut Report<'_, '_>) {
    let meshes: Vec<MeshFacts> = document.meshes.iter().map(MeshFacts::of).collect();
    for (at, node) in document.nodes.iter().enumerate() {
        check_transform(node, at, report);
        check_mesh(node, at, &meshes, report);
    }
    check_scenes(document, report);
    for (at, skin) in document.skins.iter().enumerate() {
        let mut known = HashSet::with_capacity(skin.joints.len());
        let twice = skin.joints.iter().find(|joint| !known.insert(**joint));
        if let Some(joint) = twice {
            report.warn(
                || format!("/skins/{at}/joints"),
                || format!("node {joint} is a joint twice"),
            );
        }
    }
    for (at, camera) in document.cameras.iter().enumerate() {
        check_camera(camera, at, report);
    }
    for (at, light) in document.extensions.lights().iter().enumerate() {
        check_light(light, at, report);
    }
}

/// Nodes of scenes are roots, each once.
fn check_scenes(document: &Document<'_>, report: &mut Report<'_, '_>) {
    let children = document.nodes.iter().flat_map(|node| &node.children);
    let children: HashSet<Index> = children.copied().collect();
    for (at, scene) in document.scenes.iter().enumerate() {
        let mut known = HashSet::with_capacity(scene.nodes.len());
        for (i, &node) in scene.nodes.iter().enumerate() {
            let place = || format!("/scenes/{at}/nodes/{i}");
            if children.contains(&node) {
                report.warn(place, || format!("node {node} is a child, not a root"));
            } else if !known.insert(node) {
                report.warn(place, || format!("node {node} is in the scene twice"));
            }
        }
    }
}

fn check_transform(node: &Node, at: usize, report: &mut Report<'_, '_>) {
    let has_parts = node.translation.is_some() || node.rotation.is_some() || node.scale.is_some();
    if let Some(matrix) = &node.matrix {
        let place = || format!("/nodes/{at}/matrix");
        if has_parts {
            report.warn(place, || {
                "a node has a matrix, or translation, rotation and scale; the matrix is used"
                    .to_owned()
            });
        } else if let Some(what) = fault_of_matrix(matrix) {
            report.warn(place, || what.to_owned());
        }
    }
    if let Some(rotation) = node.rotation {
        let squared: f64 = rotation.iter().map(|value| value * value).sum();
        if (squared - 1.0).abs() > MAX_UNIT_ERROR {
            report.warn(
                || format!("/nodes/{at}/rotation"),
                || "the quaternion is not of unit length; its direction is used".to_owned(),
            );
        }
    }
}

/// The reason why a matrix is not a product of translation, rotation and scale.
fn fault_of_matrix(matrix: &[f64; 16]) -> Option<&'static str> {
    let last = [matrix[3], matrix[7], matrix[11], matrix[15]];
    let is_affine = last[..3].iter().all(|value| *value == 0.0) && (last[3] - 1.0).abs() < 1e-12;
    if !is_affine {
        return Some("its last row is not 0 0 0 1; it is taken for that");
    }
    let column = |at: usize| DVec3::new(matrix[at], matrix[at + 1], matrix[at + 2]);
    let columns = [column(0), column(4), column(8)];
    let determinant = columns[0].dot(columns[1].cross(columns[2]));
    (determinant == 0.0).then_some("it has no inverse")
}

/// Facts of a mesh for the rules of its nodes, of which there may be many.
struct MeshFacts {
    has_joints: bool,
    targets: usize,
}

impl MeshFacts {
    fn of(mesh: &Mesh) -> Self {
        let mut attributes = mesh
            .primitives
            .iter()
            .map(|primitive| &primitive.attributes);
        let first = mesh.primitives.first();
        Self {
            has_joints: attributes.any(|found| found.contains_key("JOINTS_0")),
            targets: first.map_or(0, |primitive| primitive.targets.len()),
        }
    }
}

fn check_mesh(node: &Node, at: usize, meshes: &[MeshFacts], report: &mut Report<'_, '_>) {
    let place = |property: &str| format!("/nodes/{at}/{property}");
    let Some(index) = node.mesh else {
        let has_skin = node.skin.is_some();
        if has_skin || !node.weights.is_empty() {
            let property = if has_skin { "skin" } else { "weights" };
            report.warn(
                || place(property),
                || "the node has no mesh for it".to_owned(),
            );
        }
        return;
    };
    let Some(mesh) = meshes.get(index.0) else {
        return;
    };
    if node.skin.is_some() && !mesh.has_joints {
        report.warn(
            || place("skin"),
            || "no vertex of the mesh has joints; it is drawn without the skin".to_owned(),
        );
    }
    let (targets, weights) = (mesh.targets, node.weights.len());
    if weights != 0 && weights != targets {
        report.warn(
            || place("weights"),
            || format!("{weights} weights for {targets} morph targets"),
        );
    }
}

fn check_camera(camera: &Camera, at: usize, report: &mut Report<'_, '_>) {
    let kinds = [
        ("perspective", camera.perspective.is_some()),
        ("orthographic", camera.orthographic.is_some()),
    ];
    let stated = camera.kind.as_deref();
    let is_as_stated = kinds
        .iter()
        .all(|&(kind, is_there)| is_there == (stated == Some(kind)));
    if !is_as_stated {
        report.warn(
            || format!("/cameras/{at}/type"),
            || "the type is not that of the camera's one projection".to_owned(),
        );
    }
    if let Some(lens) = &camera.perspective
        && lens.yfov >= PI
    {
        report.warn(
            || format!("/cameras/{at}/perspective/yfov"),
            || {
                format!(
                    "the angle {} is not below π; one just below is used",
                    lens.yfov
                )
            },
        );
    }
    if let Some(lens) = &camera.perspective
        && lens.aspect_ratio.is_some_and(|ratio| ratio <= 0.0)
    {
        report.warn(
            || format!("/cameras/{at}/perspective/aspectRatio"),
            || "it is not above 0, and not used".to_owned(),
        );
    }
    if let Some(lens) = &camera.orthographic {
        if lens.znear < 0.0 || lens.zfar <= lens.znear {
            let (near, far) = (lens.znear, lens.zfar);
            report.warn(
                || format!("/cameras/{at}/orthographic/znear"),
                || format!("the range from {near} to {far} is not one of distances"),
            );
        }
        if lens.xmag == 0.0 || lens.ymag == 0.0 {
            report.warn(
                || format!("/cameras/{at}/orthographic"),
                || "a magnification is 0".to_owned(),
            );
        }
    }
    if let Some(lens) = &camera.perspective
        && let far = lens.zfar.unwrap_or(f32::INFINITY)
        && (lens.znear <= 0.0 || far <= lens.znear)
    {
        report.warn(
            || format!("/cameras/{at}/perspective/znear"),
            || {
                format!(
                    "the range from {} to {far} is not one of distances",
                    lens.znear
                )
            },
        );
    }
}

fn check_light(light: &Light, at: usize, report: &mut Report<'_, '_>) {
    let mut outside = |property: &str, range: &str, is_outside: bool| {
        if is_outside {
            report.warn(
                || format!("/extensions/KHR_lights_punctual/lights/{at}/{property}"),
                || format!("it is not {range}"),
            );
        }
    };
    let is_unit = |value: &f32| (0.0..=1.0).contains(value);
    outside(
        "color",
        "from 0 to 1",
        light.color.is_some_and(|color| !color.iter().all(is_unit)),
    );
    outside(
        "intensity",
        "at least 0",
        light.intensity.is_some_and(|value| value < 0.0),
    );
    outside(
        "range",
        "above 0",
        light.range.is_some_and(|value| value <= 0.0),
    );
    if !matches!(&*light.kind, "directional" | "point" | "spot") {
        report.warn(
            || format!("/extensions/KHR_lights_punctual/lights/{at}/type"),
            || {
                let kind = &light.kind;
                format!("`{kind}` is not one of directional, point and spot; the light is left out")
            },
        );
    }
    if let Some(spot) = &light.spot {
        let inner = spot.inner_cone_angle.unwrap_or(0.0);
        let outer = spot.outer_cone_angle.unwrap_or(FRAC_PI_4);
        if !(0.0 <= inner && inner < outer && outer <= FRAC_PI_2) {
            report.warn(
                || format!("/extensions/KHR_lights_punctual/lights/{at}/spot"),
                || format!("the cone's angles {inner} and {outer} do not increase from 0 to π/2"),
            );
        }
    }
    if light.kind == "spot" && light.spot.is_none() {
        report.warn(
            || format!("/extensions/KHR_lights_punctual/lights/{at}"),
            || "a spot light without `spot`; its default angles are used".to_owned(),
        );
    }
}
