//! Skins: the transform of each vertex as the weighted mean of its joints' transforms.
//!
//! ```text
//! world_from_vertex = Σ wᵢ · world_from_joint[jᵢ] · joint_from_bind[jᵢ]  ÷  Σ wᵢ
//! ```
//!
//! The transform of the node that has the mesh does not count (§3.7.3.3 of the specification).

use super::document::{self, Index};
use super::fault::{element, malformed};
use super::meshes::Source;
use super::vertices::Influences;
use crate::{AssetError, Limits};
use glam::{DAffine3, Mat3, Vec3};
use std::collections::HashMap;
use std::rc::Rc;

/// The transforms of a skin's joints in a pose.
#[derive(Clone)]
pub(super) struct Skin {
    world_from_bind: Rc<[Joint]>,
}

/// The skins that nodes use, each computed once.
#[derive(Default)]
pub(super) struct Skins {
    known: HashMap<Index, Skin>,
    /// Joints and replaced elements of accessors that were read.
    read: u64,
}

impl Skins {
    /// The transforms of a skin. `pointer` is the place of its index.
    pub(super) fn get(
        &mut self,
        index: Index,
        source: &Source<'_>,
        limits: &Limits,
        pointer: impl FnOnce() -> String,
    ) -> Result<Skin, AssetError> {
        if let Some(known) = self.known.get(&index) {
            return Ok(known.clone());
        }
        let skin = element(&source.document.skins, index, "skin", pointer)?;
        self.read += skin.joints.len() as u64;
        if let Some(matrices) = skin.inverse_bind_matrices {
            let place = || format!("/skins/{index}/inverseBindMatrices");
            let matrices = source.accessors.get(matrices, place)?;
            self.read = self.read.saturating_add(matrices.replaced_count() as u64);
        }
        // Each joint moves at least one vertex, or is of no use.
        Limits::check("joints", self.read, limits.max_vertices)
            .map_err(|error| error.at_json(format!("/skins/{index}")))?;
        let computed = Skin::new(skin, index, source)?;
        self.known.insert(index, computed.clone());
        Ok(computed)
    }
}

/// A linear map and a translation, which are added and scaled component by component.
#[derive(Debug, Clone, Copy)]
pub(super) struct Joint {
    pub(super) linear: Mat3,
    pub(super) translation: Vec3,
}

impl Joint {
    pub(super) fn from_affine(affine: &DAffine3) -> Self {
        Self {
            linear: affine.matrix3.as_mat3(),
            translation: affine.translation.as_vec3(),
        }
    }
}

impl Skin {
    fn new(skin: &document::Skin, index: Index, source: &Source<'_>) -> Result<Self, AssetError> {
        let place = |property: &str| format!("/skins/{index}{property}");
        let matrices = match skin.inverse_bind_matrices {
            Some(accessor) => {
                let place = || place("/inverseBindMatrices");
                let matrices = source.accessors.get(accessor, place)?;
                if matrices.count < skin.joints.len() {
                    let what = format!(
                        "{} matrices for {} joints",
                        matrices.count,
                        skin.joints.len()
                    );
                    return Err(malformed(place(), what));
                }
                matrices.floats_in::<16>(0..skin.joints.len())?
            }
            None => Vec::new(),
        };
        let joints = skin.joints.iter().enumerate().map(|(at, &joint)| {
            let place = || place(&format!("/joints/{at}"));
            let world_from_joint = element(source.world_from_node, joint, "node", place)?;
            let joint_from_bind = matrices
                .get(at)
                .map_or(DAffine3::IDENTITY, |matrix| affine(&matrix.map(f64::from)));
            Ok(Joint::from_affine(&(*world_from_joint * joint_from_bind)))
        });
        Ok(Self {
            world_from_bind: joints.collect::<Result<_, _>>()?,
        })
    }

    /// The transform of each vertex; `unweighted` is that of vertices without weights.
    pub(super) fn transforms(
        &self,
        sets: &[Influences],
        count: usize,
        unweighted: Joint,
        pointer: &str,
    ) -> Result<Vec<Joint>, AssetError> {
        let mut transforms = Vec::with_capacity(count);
        for vertex in 0..count {
            let mut linear = Mat3::ZERO;
            let mut translation = Vec3::ZERO;
            let mut total = 0.0;
            for (set, influences) in sets.iter().enumerate() {
                let joints = influences.joints[vertex];
                for (joint, weight) in joints.into_iter().zip(influences.weights[vertex]) {
                    // Joints without weight may have any number; weights below 0 or NaN are none.
                    if weight <= 0.0 || weight.is_nan() {
                        continue;
                    }
                    let Some(transform) = self.world_from_bind.get(joint as usize) else {
                        let what = format!(
                            "vertex {vertex} is moved by joint {joint}; the skin has {}",
                            self.world_from_bind.len()
                        );
                        return Err(malformed(
                            format!("{pointer}/attributes/JOINTS_{set}"),
                            what,
                        ));
                    };
                    linear += transform.linear * weight;
                    translation += transform.translation * weight;
                    total += weight;
                }
            }
            transforms.push(if total > 0.0 && total.is_finite() {
                Joint {
                    linear: linear * (1.0 / total),
                    translation: translation / total,
                }
            } else {
                unweighted
            });
        }
        Ok(transforms)
    }
}

/// The affine part of a matrix, whose columns come one after the other.
fn affine(matrix: &[f64; 16]) -> DAffine3 {
    let column = |at: usize| glam::DVec3::new(matrix[at], matrix[at + 1], matrix[at + 2]);
    DAffine3 {
        matrix3: glam::DMat3::from_cols(column(0), column(4), column(8)),
        translation: column(12),
    }
}
