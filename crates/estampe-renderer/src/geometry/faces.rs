//! Triangles without shared vertices: each corner can then have attributes of its face.

use super::face_colors::face_color;
use super::unit_space::UnitSpace;
use super::vertex_data::{MeshStreams, StreamData, attribute};
use estampe::{BufferError, Device};
use estampe_scene::Mesh;
use glam::Vec3;

/// Where a face is lit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LitAt {
    /// At each of its vertices.
    Vertices,
    /// At its centroid.
    Centroid,
}

/// What the vertices of a face have of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FaceAttributes {
    pub(crate) lit_at: LitAt,
    /// The number of the mesh's first triangle in the scene, if faces have colours by their number.
    pub(crate) first_number: Option<usize>,
}

/// The streams of a mesh with three separate vertices for each triangle, in the triangles' order,
/// and with the faces' normals instead of the vertices'.
pub(crate) fn unshared_streams(
    mesh: &Mesh,
    attributes: FaceAttributes,
    space: &UnitSpace,
    device: &Device,
) -> Result<MeshStreams, BufferError> {
    let position = |index: u32| at(&mesh.positions, index).unwrap_or(Vec3::NAN);
    let corners = || mesh.triangles.iter().flatten().copied();
    let positions = corners().map(|index| space.unit_from_object(position(index)).to_array());
    let normals = mesh.triangles.iter().flat_map(|triangle| {
        let normal = face_normal(triangle.map(position)).to_array();
        [normal, normal, normal]
    });
    let positions = StreamData::per_vertex(device, positions)?;
    let centroids = mesh.triangles.iter().flat_map(|triangle| {
        let corners = triangle.map(|index| space.unit_from_object(position(index)).as_dvec3());
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        [middle.as_vec3().to_array(); 3]
    });
    let indicators = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    Ok(MeshStreams {
        lit_at: match attributes.lit_at {
            LitAt::Vertices => positions.clone(),
            LitAt::Centroid => StreamData::per_vertex(device, centroids)?,
        },
        positions,
        normals: StreamData::per_vertex(device, normals)?,
        uvs: if mesh.uvs.is_empty() {
            StreamData::constant(device, &[0.0; 2])?
        } else {
            let uv = |index| at(&mesh.uvs, index).unwrap_or_default().to_array();
            StreamData::per_vertex(device, corners().map(uv))?
        },
        uvs_1: match attribute::<2>(mesh, Mesh::UV1) {
            [] => StreamData::constant(device, &[0.0; 2])?,
            uvs => {
                let uv = |index| at(uvs, index).unwrap_or_default();
                StreamData::per_vertex(device, corners().map(uv))?
            }
        },
        // Tangents belong to the vertices' normals.
        tangents: StreamData::constant(device, &[0.0; 4])?,
        colors: if mesh.colors.is_empty() {
            StreamData::constant(device, &[1.0; 4])?
        } else {
            StreamData::per_vertex(
                device,
                corners().map(|i| at(&mesh.colors, i).unwrap_or([1.0; 4])),
            )?
        },
        corners: StreamData::per_vertex(device, mesh.triangles.iter().flat_map(|_| indicators))?,
        faces: match attributes.first_number {
            Some(first) => {
                let color = |number| face_color(number).map(|code| f32::from(code) / 255.0);
                let numbers = (0..mesh.triangles.len()).map(|index| first + index);
                StreamData::per_vertex(device, numbers.flat_map(|number| [color(number); 3]))?
            }
            None => StreamData::constant(device, &[0.0; 3])?,
        },
    })
}

/// The unit normal of a counter-clockwise triangle, computed in f64; zero if the area is zero.
pub(crate) fn face_normal(corners: [Vec3; 3]) -> Vec3 {
    // The fourth power of any f32 is in f64's range, so nothing here overflows or underflows.
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    (b - a).cross(c - a).normalize_or_zero().as_vec3()
}

/// True if a mesh's normals point to the back of most of its triangles: some exporters flip one of
/// the two. Two-sided shading follows the winding, and would light such a model from behind.
///
/// At most a few thousand triangles, evenly spread, are examined.
pub(crate) fn normals_oppose_winding(mesh: &Mesh) -> bool {
    const EXAMINED: usize = 2048;
    let stride = mesh.triangles.len().div_ceil(EXAMINED).max(1);
    let mut votes = 0_i32;
    for triangle in mesh.triangles.iter().step_by(stride) {
        let corners = triangle.map(|index| at(&mesh.positions, index).unwrap_or(Vec3::NAN));
        let normals = triangle.map(|index| at(&mesh.normals, index).unwrap_or_default());
        let agreement = face_normal(corners).dot(normals[0] + normals[1] + normals[2]);
        votes += i32::from(agreement > 0.0) - i32::from(agreement < 0.0);
    }
    votes < 0
}

fn at<T: Copy>(values: &[T], index: u32) -> Option<T> {
    values.get(index as usize).copied()
}
