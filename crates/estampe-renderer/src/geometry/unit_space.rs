//! The space in which a model is drawn: its box becomes the cube −1..1, so that models of any size,
//! 10⁻³⁰ or 10³⁰, are drawn with the same precision.

use estampe_scene::{Mesh, Scene, Workers, pieces};
use glam::{DMat3, DVec3, Vec3};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

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
    /// The space of those vertices of a scene that a primitive names.
    pub(crate) fn new(
        used: &[UsedVertices<'_>],
        world_from_object: DMat3,
        workers: Workers,
    ) -> Self {
        let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let boxes = workers.map(used, |piece| {
            piece.positions().fold(nothing, |(least, most), position| {
                let world = world_from_object * position.as_dvec3();
                (least.min(world), most.max(world))
            })
        });
        let (mut least, mut most) = boxes
            .into_iter()
            .fold(nothing, |(least, most), (a, b)| (least.min(a), most.max(b)));
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

/// A run of a mesh's vertices, with those marked that a triangle, line or point names.
#[derive(Debug, Clone)]
pub(crate) struct UsedVertices<'a> {
    mesh: &'a Mesh,
    range: Range<usize>,
    is_used: &'a [bool],
}

impl<'a> UsedVertices<'a> {
    /// All vertices of a scene; `is_used` says, by mesh, which ones are named.
    pub(crate) fn of_scene(scene: &'a Scene, is_used: &'a [Vec<bool>]) -> Vec<Self> {
        /// Some hundred microseconds of work.
        const PIECE: usize = 1 << 14;
        let meshes = scene.meshes.iter().zip(is_used);
        let of_mesh = |(mesh, is_used): (&'a Mesh, &'a Vec<bool>)| {
            pieces(mesh.positions.len(), PIECE).map(move |range| Self {
                mesh,
                range: range.clone(),
                is_used: &is_used[range],
            })
        };
        meshes.flat_map(of_mesh).collect()
    }

    /// The finite ones that are named.
    pub(crate) fn positions(&self) -> impl Iterator<Item = Vec3> {
        let positions = self.mesh.positions[self.range.clone()].iter();
        let named = positions.zip(self.is_used).filter(|(_, is_used)| **is_used);
        named
            .map(|(&position, _)| position)
            .filter(|position| position.is_finite())
    }
}

/// Which vertices of a mesh a triangle, line or point names.
pub(crate) fn used_vertices(mesh: &Mesh, workers: Workers) -> Vec<bool> {
    /// Some hundred microseconds of work.
    const PIECE: usize = 1 << 16;
    let is_used: Vec<AtomicBool> = mesh
        .positions
        .iter()
        .map(|_| AtomicBool::new(false))
        .collect();
    let corners = mesh.triangles.as_flattened();
    let ends = mesh.lines.as_flattened();
    let runs = [corners, ends, &mesh.points];
    workers.map(runs.into_iter().flat_map(|run| run.chunks(PIECE)), |run| {
        for &index in run {
            // Nearly all are named more than once, and reading leaves the line shared.
            if let Some(slot) = is_used.get(index as usize)
                && !slot.load(Ordering::Relaxed)
            {
                slot.store(true, Ordering::Relaxed);
            }
        }
    });
    is_used.into_iter().map(AtomicBool::into_inner).collect()
}
