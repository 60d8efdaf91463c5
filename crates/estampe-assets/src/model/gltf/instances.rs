//! EXT_mesh_gpu_instancing: the places of a node's mesh.

use super::accessor::{Accessors, Elements};
use super::document::Instancing;
use super::fault::malformed;
use super::hierarchy::transform;
use crate::{AssetError, Limits};
use glam::DAffine3;

/// The transforms from each instance's space to the node's. `pointer` is the place of the
/// extension, `counted` the number of instances of other nodes.
pub(super) fn transforms(
    instancing: &Instancing,
    accessors: &Accessors<'_>,
    counted: u64,
    limits: &Limits,
    pointer: &str,
) -> Result<Vec<DAffine3>, AssetError> {
    let get = |name: &str| -> Result<Option<Elements<'_>>, AssetError> {
        let Some(&index) = instancing.attributes.get(name) else {
            return Ok(None);
        };
        let place = || format!("{pointer}/attributes/{name}");
        accessors.get(index, place).map(Some)
    };
    let [translations, rotations, scales] = ["TRANSLATION", "ROTATION", "SCALE"].map(get);
    let (translations, rotations, scales) = (translations?, rotations?, scales?);
    let all = [&translations, &rotations, &scales];
    let counts = all.into_iter().flatten().map(|elements| elements.count);
    let counts: Vec<usize> = counts.collect();
    let Some(&count) = counts.first() else {
        return Ok(vec![DAffine3::IDENTITY]);
    };
    if counts.iter().any(|&other| other != count) {
        return Err(malformed(
            format!("{pointer}/attributes"),
            "the attributes have different numbers of instances",
        ));
    }
    // Each instance has at least one vertex, or is of no use.
    let total = counted.saturating_add(count as u64);
    Limits::check("instances", total, limits.max_vertices)
        .map_err(|error| error.at_json(pointer))?;
    let translations = translations
        .map(|elements| elements.floats::<3>())
        .transpose()?;
    let rotations = rotations
        .map(|elements| elements.floats::<4>())
        .transpose()?;
    let scales = scales.map(|elements| elements.floats::<3>()).transpose()?;
    let instance = |at: usize| {
        transform(
            translations
                .as_ref()
                .map_or([0.0; 3], |all| all[at].map(f64::from)),
            rotations
                .as_ref()
                .map_or([0.0, 0.0, 0.0, 1.0], |all| all[at].map(f64::from)),
            scales
                .as_ref()
                .map_or([1.0; 3], |all| all[at].map(f64::from)),
        )
    };
    Ok((0..count).map(instance).collect())
}
