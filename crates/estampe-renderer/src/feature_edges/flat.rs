//! Pictures of one flat face: in the default light they would be one colour, as the front view of a
//! plate is, so their edges are drawn.

use crate::options::RenderOptions;
use crate::scene_view::SceneView;
use estampe_scene::{Mesh, Scene};
use glam::{DVec2, DVec3};
use std::collections::HashMap;

/// More triangles are scans and other curved surfaces, which are not looked at.
const MOST_TRIANGLES: usize = 200_000;
/// The share of the area in the picture from which on faces of one direction are nearly all.
const NEARLY_ALL: f64 = 0.9;
/// The cosine of the angle, 1 degree, within which normals are of one direction.
const COS_APART: f64 = 0.999_85;
/// Cells of normals along an axis, for a first guess of the most frequent one.
const CELLS: f64 = 32.0;

/// True if nearly all of what the picture shows are faces in one direction, in the default light
/// and without textures and varied colours of vertices.
pub(crate) fn is_one_face(scene: &Scene, view: &SceneView, options: &RenderOptions) -> bool {
    let count: usize = { scene.meshes.iter() }
        .map(|mesh| mesh.triangles.len())
        .sum();
    let is_varied = |mesh: &Mesh| mesh.colors.windows(2).any(|pair| pair[0] != pair[1]);
    let has_colors = scene.meshes.iter().any(is_varied);
    let is_one_color = options.color.is_some() || scene.images.is_empty() && !has_colors;
    let is_plain = options.program.is_none()
        && options.texture.is_none()
        && is_one_color
        && !options.wireframe;
    if !is_plain || count > MOST_TRIANGLES || view.presentation(options).is_none() {
        return false;
    }
    let faces = faces(scene, view);
    // Six times the volume, above 0 if faces are counter-clockwise from outside.
    let volume: f64 = faces.iter().map(|face| face.volume).sum();
    // In unit space; that of sheets is 0 but for rounding.
    let outside = if volume.abs() > 1e-9 { volume } else { 0.0 };
    let is_visible = |face: &&Face| face.area_ndc * outside >= 0.0;
    let mut cells: HashMap<[u64; 3], (f64, DVec3)> = HashMap::new();
    let mut whole = 0.0;
    let mut most = (0.0, DVec3::ZERO);
    for face in faces.iter().filter(is_visible) {
        let area = face.area_ndc.abs();
        whole += area;
        // Adding 0 makes −0 equal to 0.
        let cell = { face.normal * CELLS }.to_array();
        let cell = cell.map(|along| (libm::round(along) + 0.0).to_bits());
        let (sum, first) = cells.entry(cell).or_insert((0.0, face.normal));
        *sum += area;
        if *sum > most.0 {
            most = (*sum, *first);
        }
    }
    let alike = { faces.iter().filter(is_visible) }
        .filter(|face| face.normal.dot(most.1).abs() > COS_APART)
        .map(|face| face.area_ndc.abs());
    whole > 0.0 && alike.sum::<f64>() >= NEARLY_ALL * whole
}

/// A face before the eye.
struct Face {
    normal: DVec3,
    /// In normalised device coordinates, above 0 if it is counter-clockwise there.
    area_ndc: f64,
    /// Six times that of the tetrahedron to the middle of unit space.
    volume: f64,
}

/// The faces that have an area and are wholly before the eye.
fn faces(scene: &Scene, view: &SceneView) -> Vec<Face> {
    let unit_from_object = view.space.unit_from_object_matrix();
    let clip_from_unit = view.clip_from_unit();
    let least_w = view.least_w();
    let face = |mesh: &Mesh, triangle: [u32; 3]| {
        let corner = |vertex: u32| {
            let position = mesh.positions.get(vertex as usize)?.as_dvec3();
            Some(unit_from_object.transform_point3(position))
        };
        let [a, b, c] = [
            corner(triangle[0])?,
            corner(triangle[1])?,
            corner(triangle[2])?,
        ];
        let normal = (b - a).cross(c - a).try_normalize()?;
        let volume = a.dot(b.cross(c));
        let at = |point: DVec3| {
            let clip = clip_from_unit * point.extend(1.0);
            (clip.w >= least_w).then(|| DVec2::new(clip.x, clip.y) / clip.w)
        };
        let [a, b, c] = [at(a)?, at(b)?, at(c)?];
        let area_ndc = (b - a).perp_dot(c - a);
        let face = Face {
            normal,
            area_ndc,
            volume,
        };
        (area_ndc.is_finite() && volume.is_finite()).then_some(face)
    };
    let meshes = scene.meshes.iter();
    meshes
        .flat_map(|mesh| {
            let triangles = mesh.triangles.iter();
            triangles.filter_map(move |&triangle| face(mesh, triangle))
        })
        .collect()
}
