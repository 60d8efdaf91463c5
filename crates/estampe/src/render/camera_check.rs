//! Refuses cameras without a direction: an eye at its target.

use crate::failure::Failure;
use estampe_renderer::Up;
use estampe_scene::{Scene, UpAxis};
use glam::DVec3;

/// Refuses an eye of the options at the target of the options.
pub(super) fn eye_and_target(eye: Option<DVec3>, target: Option<DVec3>) -> Result<(), Failure> {
    match (eye, target) {
        (Some(eye), Some(target)) if eye == target => Err(Failure::Usage(
            "--eye and --target are the same point, so the camera has no direction; move one of them"
                .to_owned(),
        )),
        _ => Ok(()),
    }
}

/// Refuses an eye of the options in the middle of the model, which is the target if the options
/// have none.
pub(super) fn eye_in_middle(
    eye: Option<DVec3>,
    target: Option<DVec3>,
    (scene, up): (&Scene, Up),
) -> Result<(), Failure> {
    /// The share of the model's size within which two points are one.
    const CLOSEST: f64 = 1e-9;
    let (Some(eye), None) = (eye, target) else {
        return Ok(());
    };
    let mut least = DVec3::INFINITY;
    let mut most = DVec3::NEG_INFINITY;
    for mesh in &scene.meshes {
        let corners = mesh.triangles.as_flattened().iter();
        for &index in corners.chain(mesh.lines.as_flattened()).chain(&mesh.points) {
            let position = mesh.positions.get(index as usize);
            if let Some(position) = position.filter(|position| position.is_finite()) {
                (least, most) = (
                    least.min(position.as_dvec3()),
                    most.max(position.as_dvec3()),
                );
            }
        }
    }
    let is_z_up = match up {
        Up::FromScene => scene.up == UpAxis::Z,
        Up::Axis(axis) => axis == UpAxis::Z,
        Up::Direction(_) => false,
    };
    let middle = (least + most) / 2.0;
    let middle = if is_z_up {
        DVec3::new(middle.x, middle.z, -middle.y)
    } else {
        middle
    };
    if middle.distance(eye) <= CLOSEST * (most - least).length() {
        return Err(Failure::Usage(
            "--eye is the middle of the model, at which the camera looks; add --target X,Y,Z, or \
             move the eye"
                .to_owned(),
        ));
    }
    Ok(())
}
