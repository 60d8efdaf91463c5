//! The unit space in which a model is drawn: its box becomes the cube −1..1, so that models of any
//! size, 10⁻³⁰ or 10³⁰, are drawn with the same precision.

use estampe_scene::{Mesh, Scene, Workers, pieces};
use glam::{DMat3, DMat4, DVec3, Vec3};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

/// The transform from object space through world space to the cube −1..1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct UnitSpace {
    /// Rotation from the file's space to the world's.
    pub(crate) world_from_object: DMat3,
    /// The middle of the model's box, in world space.
    center_world: DVec3,
    /// Half of the box's longest side, in world units; > 0.
    half_side: f64,
    /// Half of the box's sides, in unit space: the greatest is 1, unless the model is a point.
    half_extents: DVec3,
}

impl UnitSpace {
    /// The unit space of the vertices that some primitive of the scene uses.
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
            half_extents: (most - least) / (2.0 * half_side),
        }
    }

    /// The corners of the model's box in unit space, the least first and the greatest last.
    pub(crate) fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|k| {
            let sign = |bit: usize| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
            self.half_extents * DVec3::new(sign(0), sign(1), sign(2))
        })
    }

    /// The position of a vertex in unit space.
    pub(crate) fn unit_from_object(&self, position: Vec3) -> Vec3 {
        self.unit_from_world(self.world_from_object * position.as_dvec3())
            .as_vec3()
    }

    /// A world-space point in unit space.
    pub(crate) fn unit_from_world(&self, position: DVec3) -> DVec3 {
        (position - self.center_world) / self.half_side
    }

    /// [`Self::unit_from_object`] as a matrix, in 64 bits.
    pub(crate) fn unit_from_object_matrix(&self) -> DMat4 {
        DMat4::from_scale(DVec3::splat(1.0 / self.half_side))
            * DMat4::from_translation(-self.center_world)
            * DMat4::from_mat3(self.world_from_object)
    }

    /// A unit-space point in world space.
    pub(crate) fn world_from_unit(&self, position: DVec3) -> DVec3 {
        position * self.half_side + self.center_world
    }

    /// World units per unit of the unit space.
    pub(crate) fn world_per_unit(&self) -> f64 {
        self.half_side
    }
}

/// A range of a mesh's vertices, with flags for those that a triangle, line or point uses.
#[derive(Debug, Clone)]
pub(crate) struct UsedVertices<'a> {
    mesh: &'a Mesh,
    range: Range<usize>,
    is_used: &'a [bool],
}

impl<'a> UsedVertices<'a> {
    /// All vertices of a scene in ranges; `is_used` has one flag per vertex, by mesh.
    pub(crate) fn of_scene(scene: &'a Scene, is_used: &'a [Vec<bool>]) -> Vec<Self> {
        /// Vertices of a piece: some hundred microseconds of work.
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

    /// The finite positions that are used.
    pub(crate) fn positions(&self) -> impl Iterator<Item = Vec3> {
        let positions = self.mesh.positions[self.range.clone()].iter();
        let named = positions.zip(self.is_used).filter(|(_, is_used)| **is_used);
        named
            .map(|(&position, _)| position)
            .filter(|position| position.is_finite())
    }
}

/// For each vertex of a mesh, whether a triangle, line or point uses it.
pub(crate) fn used_vertices(mesh: &Mesh, workers: Workers) -> Vec<bool> {
    /// Indices of a piece: some hundred microseconds of work.
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
            // Most vertices are used more than once, and reading first keeps the cache line shared.
            if let Some(slot) = is_used.get(index as usize)
                && !slot.load(Ordering::Relaxed)
            {
                slot.store(true, Ordering::Relaxed);
            }
        }
    });
    is_used.into_iter().map(AtomicBool::into_inner).collect()
}
