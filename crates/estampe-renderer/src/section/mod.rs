//! Sections: planes that cut the model away on one side, and caps that close it where it is solid.
//!
//! ```text
//!   mesh ──┬─ clip      triangles, lines and points on the side that is kept
//!          └─ outline   where the plane meets the mesh: rings ── caps: their inside, as triangles
//! ```
//!
//! The cut is made in the geometry, so all shadings, shadows, transparency, edges and data passes
//! see the same model. (Rejected: user clip distances with caps by stencil parity, which show the
//! cap's colour through every hole of a mesh that is not closed, and cast no shadows.)
//!
//! A closed mesh meets a plane in closed rings: a vertex on the plane counts as cut away, so every
//! triangle that has vertices on both sides has exactly two crossed edges, and both triangles at an
//! edge cross it at the same point, bit by bit. What is inside of the rings is solid. An open mesh
//! also has chains with ends; they are closed if the ends meet within a small distance, or if the
//! gap is short beside the chain. Others have no inside, and the model is seen from within.

mod caps;
mod clip;
mod outline;

#[cfg(test)]
mod tests;

use crate::alpha::{Encoding, decode};
use crate::options::RenderOptions;
use crate::render_error::RenderError;
use crate::scene_view::orientation;
use estampe_scene::{Bounds, Material, Mesh, Scene, Workers};
use glam::{DVec3, Vec3};

/// Planes that cut the model, and the colour of its solid parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// The planes; what one of them cuts away is not drawn. Default none.
    pub planes: Vec<SectionPlane>,
    /// The colour of cut solids, sRGB. Default [`Self::CAP_COLOR`].
    pub cap_color: [u8; 3],
}

impl Section {
    /// The default colour of cut solids.
    pub const CAP_COLOR: [u8; 3] = [0xc8, 0x6a, 0x4e];
}

impl Default for Section {
    fn default() -> Self {
        Self {
            planes: Vec::new(),
            cap_color: Self::CAP_COLOR,
        }
    }
}

/// A plane that cuts away the points p with n·p ≥ offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionPlane {
    /// n, a direction in world space of any length; it points to the side that is cut away. A plane
    /// whose direction is zero or not finite cuts nothing.
    pub normal_world: DVec3,
    /// The plane's distance from the origin along n, in world units if n has the length 1. `None`
    /// is the plane through the middle of the model's box.
    pub offset_world: Option<f64>,
}

/// A scene that was cut.
#[derive(Debug)]
pub(crate) struct CutScene {
    /// The meshes of the scene as they were, cut, and then the caps; caps have a material of their
    /// own, the last one.
    pub(crate) scene: Scene,
    /// For each mesh of caps, the number of the mesh that it closes.
    pub(crate) cap_of: Vec<usize>,
}

/// The side of a plane that is kept: the points with n·p < offset, in object space.
#[derive(Debug, Clone, Copy)]
struct HalfSpace {
    /// Unit.
    normal: DVec3,
    offset: f64,
}

impl HalfSpace {
    /// Distance from the plane, negative on the side that is kept.
    fn distance(&self, position: Vec3) -> f64 {
        self.normal.dot(position.as_dvec3()) - self.offset
    }

    /// The point at which the plane crosses the edge between two positions on different sides, and
    /// the second one's share of it. The same for both directions of the edge.
    fn crossing(&self, a: Vec3, b: Vec3) -> (Vec3, f64) {
        let is_turned = bits(b) < bits(a);
        let (p, q) = if is_turned { (b, a) } else { (a, b) };
        let (near, far) = (self.distance(p), self.distance(q));
        let share = (near / (near - far)).clamp(0.0, 1.0);
        let (p, q) = (p.as_dvec3(), q.as_dvec3());
        let point = (p + (q - p) * share).as_vec3();
        (point, if is_turned { 1.0 - share } else { share })
    }
}

/// The bits of a position, equal for equal positions: −0 is 0.
fn bits(position: Vec3) -> [u32; 3] {
    (position + Vec3::ZERO).to_array().map(f32::to_bits)
}

impl RenderOptions {
    /// The scene, cut by the planes of the options; `None` if there are none.
    ///
    /// # Errors
    /// [`RenderError::EmptySection`] if nothing is left.
    pub(crate) fn cut(
        &self,
        scene: &Scene,
        workers: Workers,
    ) -> Result<Option<CutScene>, RenderError> {
        let planes = half_spaces(self, scene);
        if planes.is_empty() {
            return Ok(None);
        }
        let cap_material = scene.materials.len();
        // Each mesh with its caps.
        let cut = workers.map(&scene.meshes, |mesh| {
            let mut caps = Mesh {
                name: mesh.name.clone(),
                ..Mesh::default()
            };
            for (number, plane) in planes.iter().enumerate() {
                let mut cap = caps::cap(mesh, plane);
                for (other, plane) in planes.iter().enumerate() {
                    if other != number && !cap.triangles.is_empty() {
                        cap = clip::clip(&cap, plane);
                    }
                }
                caps::append(&mut caps, &cap, cap_material);
            }
            let first = clip::clip(mesh, &planes[0]);
            let cut = planes[1..].iter().fold(first, |cut, p| clip::clip(&cut, p));
            (cut, caps)
        });
        let (mut meshes, caps): (Vec<Mesh>, Vec<Mesh>) = cut.into_iter().unzip();
        let is_empty =
            |m: &Mesh| m.triangles.is_empty() && m.lines.is_empty() && m.points.is_empty();
        if meshes.iter().all(is_empty) {
            return Err(RenderError::EmptySection);
        }
        let mut cap_of = Vec::new();
        for (number, cap) in caps.into_iter().enumerate() {
            if !cap.triangles.is_empty() {
                cap_of.push(number);
                meshes.push(cap);
            }
        }
        let mut materials = scene.materials.clone();
        materials.push(Material {
            name: "section".to_owned(),
            base_color: self
                .section
                .cap_color
                .map(|c| decode(c, Encoding::Srgb))
                .into(),
            specular: Vec3::ZERO,
            ..Material::default()
        });
        let scene = Scene {
            meshes,
            materials,
            images: scene.images.clone(),
            up: scene.up,
            cameras: Vec::new(),
            lights: scene.lights.clone(),
        };
        Ok(Some(CutScene { scene, cap_of }))
    }
}

/// The planes of the options in object space.
fn half_spaces(options: &RenderOptions, scene: &Scene) -> Vec<HalfSpace> {
    let planes = &options.section.planes;
    if planes.is_empty() {
        return Vec::new();
    }
    let (world_from_object, _) = orientation(options.up, scene.up);
    let middle = middle_of_box(scene);
    let half_space = |plane: &SectionPlane| {
        let length = plane.normal_world.length();
        let normal = world_from_object.transpose() * plane.normal_world.try_normalize()?;
        let offset = match plane.offset_world {
            Some(offset) => offset / length,
            None => normal.dot(middle),
        };
        Some(HalfSpace { normal, offset })
    };
    planes.iter().filter_map(half_space).collect()
}

/// The middle of the model's box, in object space.
fn middle_of_box(scene: &Scene) -> DVec3 {
    let of_mesh = |mesh: &Mesh| {
        let corners = mesh.triangles.iter().flatten();
        let ends = mesh.lines.iter().flatten();
        let used = corners.chain(ends).chain(&mesh.points);
        Bounds::of(used.filter_map(|&index| mesh.positions.get(index as usize).copied()))
    };
    let boxes = scene.meshes.iter().map(of_mesh);
    let whole = boxes.fold(Bounds::EMPTY, |a, b| a.union(&b));
    if whole.is_empty() {
        DVec3::ZERO
    } else {
        (whole.min.as_dvec3() + whole.max.as_dvec3()) / 2.0
    }
}
