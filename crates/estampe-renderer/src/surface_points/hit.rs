//! Where the ray through a pixel's centre meets a triangle.

use super::SurfacePoint;
use crate::geometry::faces::normals_oppose_winding;
use crate::scene_view::SceneView;
use crate::transforms::round_to_f32;
use estampe_scene::{Mesh, Scene};
use glam::{DMat4, DVec2, DVec3, DVec4, Vec2, Vec3};

/// The triangles of a scene, as rays meet them.
pub(super) struct Hits<'a> {
    scene: &'a Scene,
    view: &'a SceneView,
    clip_from_unit: DMat4,
    /// The number of the first triangle of each mesh.
    first_of_mesh: Vec<usize>,
    /// −1 for meshes whose normals point against their windings.
    signs: Vec<f64>,
    size_px: DVec2,
}

impl<'a> Hits<'a> {
    pub(super) fn new(scene: &'a Scene, view: &'a SceneView, (width, height): (u32, u32)) -> Self {
        let first = scene.meshes.iter().scan(0, |count, mesh| {
            let first = *count;
            *count += mesh.triangles.len();
            Some(first)
        });
        let sign = |mesh: &Mesh| {
            if normals_oppose_winding(mesh) {
                -1.0
            } else {
                1.0
            }
        };
        Self {
            scene,
            view,
            clip_from_unit: view.clip_from_unit(),
            first_of_mesh: first.collect(),
            signs: scene.meshes.iter().map(sign).collect(),
            size_px: DVec2::new(width.into(), height.into()),
        }
    }

    /// The point of triangle `number` at the centre of the pixel (x, y); `None` if there is no such
    /// triangle.
    pub(super) fn at(&self, number: usize, (x, y): (u32, u32)) -> Option<SurfacePoint> {
        let mesh_number = self.first_of_mesh.partition_point(|&first| first <= number) - 1;
        let mesh = self.scene.meshes.get(mesh_number)?;
        let triangle_number = number - self.first_of_mesh[mesh_number];
        let corners = mesh
            .triangles
            .get(triangle_number)?
            .map(|corner| corner as usize);
        let [a, b, c] = corners;
        let objects = [
            *mesh.positions.get(a)?,
            *mesh.positions.get(b)?,
            *mesh.positions.get(c)?,
        ];
        let units = objects.map(|object| self.view.space.unit_from_object(object).as_dvec3());
        let shares = self.shares(units, (x, y));
        let unit = weighted(units, shares);

        let world_from_object = self.view.space.world_from_object;
        let across = [objects[1] - objects[0], objects[2] - objects[0]].map(Vec3::as_dvec3);
        let of_winding = world_from_object * across[0].cross(across[1]).normalize_or_zero();
        let given = corners.map(|corner| mesh.normals.get(corner).map(|n| n.as_dvec3()));
        let smooth = match given {
            [Some(a), Some(b), Some(c)] => {
                let sum = weighted([a, b, c], shares) * self.signs[mesh_number];
                (world_from_object * sum).normalize_or(of_winding)
            }
            _ => of_winding,
        };
        let to_eye = self.view.towards_eye(unit);
        let side = if of_winding.dot(to_eye) < 0.0 {
            -1.0
        } else {
            1.0
        };

        let uvs = corners.map(|corner| mesh.uvs.get(corner).copied().unwrap_or(Vec2::ZERO));
        let uv = uvs[0] * round_to_f32(shares.x)
            + uvs[1] * round_to_f32(shares.y)
            + uvs[2] * round_to_f32(shares.z);
        let surface =
            { mesh.surfaces.iter() }.find(|surface| surface.triangles.contains(&triangle_number));
        let distance = self.view.distance(unit) * self.view.space.world_per_unit();
        Some(SurfacePoint {
            position_world: rounded(self.view.space.world_from_unit(unit)),
            normal_world: rounded(smooth * side),
            distance: round_to_f32(distance),
            uv,
            mesh: mesh_number,
            material: surface.and_then(|surface| surface.material),
        })
    }

    /// The barycentric coordinates of the point that is seen at a pixel's centre, which sum to 1.
    ///
    /// The pixel (X, Y) sees the points p = Σ λᵢ·pᵢ with (x, y, w)(p) ∝ (X, Y, 1); clip coordinates
    /// are linear, so λ ∝ M⁻¹·(X, Y, 1), where M has the corners' (x, y, w) as columns (Olano and
    /// Greer, "Triangle Scan Conversion using 2D Homogeneous Coordinates", 1997). The centre may be
    /// outside by a rounding of the pipeline: the nearest point inside is taken.
    fn shares(&self, units: [DVec3; 3], (x, y): (u32, u32)) -> DVec3 {
        let pixel = (DVec2::new(x.into(), y.into()) + 0.5) / self.size_px * 2.0 - 1.0;
        let ray = DVec3::new(pixel.x, -pixel.y, 1.0);
        let [a, b, c] = units.map(|unit| {
            let clip: DVec4 = self.clip_from_unit * unit.extend(1.0);
            DVec3::new(clip.x, clip.y, clip.w)
        });
        let shares = DVec3::new(
            b.cross(c).dot(ray),
            c.cross(a).dot(ray),
            a.cross(b).dot(ray),
        );
        let inside = (shares / shares.element_sum()).max(DVec3::ZERO);
        let inside = inside / inside.element_sum();
        if inside.is_finite() {
            inside
        } else {
            DVec3::splat(1.0 / 3.0)
        }
    }
}

fn weighted([a, b, c]: [DVec3; 3], shares: DVec3) -> DVec3 {
    a * shares.x + b * shares.y + c * shares.z
}

fn rounded(vector: DVec3) -> Vec3 {
    Vec3::from_array(vector.to_array().map(round_to_f32))
}
