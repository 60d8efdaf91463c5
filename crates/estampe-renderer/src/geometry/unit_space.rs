//! The space in which a model is drawn: its box becomes the cube −1..1, so that models of any size,
//! 10⁻³⁰ or 10³⁰, are drawn with the same precision.

use estampe_scene::{Mesh, Scene};
use glam::{DMat3, DVec3, Vec3};

/// The map from a file's space by way of the world's to the cube −1..1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct UnitSpace {
    /// Turns the file's space into the world's: a rotation.
    pub(crate) world_from_object: DMat3,
    /// The middle of the model's box in the world.
    center_world: DVec3,
    /// Half of the box's longest side in the world; > 0.
    half_side: f64,
}

impl UnitSpace {
    /// The space of a scene whose `is_used` says, by mesh, which vertices a primitive names.
    pub(crate) fn new(scene: &Scene, is_used: &[Vec<bool>], world_from_object: DMat3) -> Self {
        let (mut least, mut most) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (mesh, is_used) in scene.meshes.iter().zip(is_used) {
            for position in used(mesh, is_used) {
                let world = world_from_object * position.as_dvec3();
                (least, most) = (least.min(world), most.max(world));
            }
        }
        if !least.cmple(most).all() {
            (least, most) = (DVec3::ZERO, DVec3::ZERO);
        }
        let half_side = (most - least).max_element() / 2.0;
        let half_side = if half_side > 0.0 { half_side } else { 1.0 };
        Self {
            world_from_object,
            center_world: (least + most) / 2.0,
            half_side,
        }
    }

    /// A vertex.
    pub(crate) fn unit_from_object(&self, position: Vec3) -> Vec3 {
        self.unit_from_world(self.world_from_object * position.as_dvec3())
            .as_vec3()
    }

    /// A point of the world.
    pub(crate) fn unit_from_world(&self, position: DVec3) -> DVec3 {
        (position - self.center_world) / self.half_side
    }

    /// A point of the world again.
    pub(crate) fn world_from_unit(&self, position: DVec3) -> DVec3 {
        position * self.half_side + self.center_world
    }

    /// Length in the world of 1 in the unit space.
    pub(crate) fn world_per_unit(&self) -> f64 {
        self.half_side
    }
}

/// The finite vertices that a primitive names.
pub(crate) fn used<'a>(mesh: &'a Mesh, is_used: &'a [bool]) -> impl Iterator<Item = Vec3> + 'a {
    let named = mesh
        .positions
        .iter()
        .zip(is_used)
        .filter(|(_, is_used)| **is_used);
    named
        .map(|(&position, _)| position)
        .filter(|position| position.is_finite())
}

/// Which vertices of a mesh a triangle, line or point names.
pub(crate) fn used_vertices(mesh: &Mesh) -> Vec<bool> {
    let mut is_used = vec![false; mesh.positions.len()];
    let corners = mesh.triangles.iter().flatten();
    let ends = mesh.lines.iter().flatten();
    for &index in corners.chain(ends).chain(&mesh.points) {
        if let Some(slot) = is_used.get_mut(index as usize) {
            *slot = true;
        }
    }
    is_used
}
