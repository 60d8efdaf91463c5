//! Tessellation of the teapot's patches into grids, joined at their seams.

use std::collections::HashMap;

use glam::{DVec3, Vec2, Vec3};

use super::control_points::{PATCHES, POINTS};
use crate::bezier::{BicubicPatch, CurveParameter};
use crate::mesh::ShapeMesh;
use crate::parametric::SurfacePoint;
use crate::parametric::append_grid;

/// Cells per patch and direction at which an image of a thousand pixels shows no corners.
pub const DEFAULT_CELLS: u32 = 16;

/// The maximum number of cells per patch and direction: 32 patches of them are 2²³ triangles.
const MAX_PATCH_CELLS: u32 = 362;

/// Neighbouring patches are smooth where their normals agree to 2.5°. The data's seams are smooth
/// to far less; its real edges differ by far more.
const SMOOTH_COSINE: f32 = 0.999;

/// Patches that share one image: a block of rows (along s) and columns (along t).
struct Part {
    first: usize,
    columns: usize,
    /// Number of images side by side across the columns.
    images: usize,
    /// Positions at which the rows of patches divide the image, by their lengths along the surface.
    row_edges: &'static [f32],
    /// True if the image's top is at the last row, as on the spout, whose rows go upwards.
    is_upwards: bool,
}

/// Rim and body, handle, spout, knob and lid, bottom: in the order of their patches.
#[rustfmt::skip]
const PARTS: [Part; 5] = [
    Part { first: 0, columns: 4, images: 4, row_edges: &[0.0, 0.125, 0.625, 1.0], is_upwards: false },
    Part { first: 12, columns: 2, images: 1, row_edges: &[0.0, 0.5, 1.0], is_upwards: false },
    Part { first: 16, columns: 2, images: 1, row_edges: &[0.0, 0.75, 1.0], is_upwards: true },
    Part { first: 20, columns: 4, images: 4, row_edges: &[0.0, 0.375, 1.0], is_upwards: false },
    Part { first: 28, columns: 4, images: 4, row_edges: &[0.0, 1.0], is_upwards: false },
];

/// One of the 32 patches, Y up; its outside is where [`BicubicPatch::normal`] points.
///
/// Panics if `index` is not below 32.
#[must_use]
pub fn patch(index: usize) -> BicubicPatch {
    let points = PATCHES[index].map(|point| {
        let [x, y, z] = POINTS[usize::from(point) - 1];
        // Adding zero turns −0 into 0.
        DVec3::new(x, z, -y) + DVec3::ZERO
    });
    let mut control = [[DVec3::ZERO; 4]; 4];
    for (row, points) in control.iter_mut().zip(points.as_chunks::<4>().0) {
        *row = *points;
    }
    BicubicPatch { control }
}

/// The teapot with its bottom, `cells` × `cells` cells per patch (clamped to 1..=362).
///
/// Neighbouring patches share a vertex where position, normal and texture coordinate agree.
#[must_use]
pub fn teapot(cells: u32) -> ShapeMesh {
    let cells = cells.clamp(1, MAX_PATCH_CELLS);
    let mut loose = ShapeMesh::named("teapot");
    for part in PARTS {
        for row in 0..part.row_edges.len() - 1 {
            for column in 0..part.columns {
                append_patch(&mut loose, &part, row, column, cells);
            }
        }
    }
    smooth_seams(&mut loose);
    weld(&loose)
}

/// Appends one patch. Seen from outside its t runs to the left, against the image's u.
fn append_patch(mesh: &mut ShapeMesh, part: &Part, row: usize, column: usize, cells: u32) {
    let patch = patch(part.first + row * part.columns + column);
    let columns_per_image = part.columns / part.images;
    let u_width = 1.0 / columns_per_image as f32;
    let u_end = 1.0 - u_width * (column % columns_per_image) as f32;
    let u = u_end - u_width..u_end;
    let v = part.row_edges[row]..part.row_edges[row + 1];

    // Seen from outside, the spout's rows go upwards: rotate its grid by half a turn.
    let uv = if part.is_upwards {
        Vec2::new(1.0 - u.end, 1.0 - v.end)..Vec2::new(1.0 - u.start, 1.0 - v.start)
    } else {
        Vec2::new(u.start, v.start)..Vec2::new(u.end, v.end)
    };
    append_grid(
        mesh,
        [cells, cells],
        uv,
        |step_u, steps_u, step_v, steps_v| {
            let (s, t) = if part.is_upwards {
                (
                    CurveParameter::fraction(steps_v - step_v, steps_v),
                    CurveParameter::fraction(step_u, steps_u),
                )
            } else {
                (
                    CurveParameter::fraction(step_v, steps_v),
                    CurveParameter::fraction(steps_u - step_u, steps_u),
                )
            };
            SurfacePoint {
                position: patch.point(s, t),
                normal: patch.normal(s, t),
            }
        },
    );
}

/// A position as a key. Positions hold no −0.
fn position_key(position: Vec3) -> [u32; 3] {
    position.to_array().map(f32::to_bits)
}

/// Averages the normals of vertices at one position, if they agree within the limit.
fn smooth_seams(mesh: &mut ShapeMesh) {
    let mut groups: HashMap<[u32; 3], Vec<usize>> = HashMap::new();
    for (vertex, &position) in mesh.positions.iter().enumerate() {
        groups
            .entry(position_key(position))
            .or_default()
            .push(vertex);
    }
    let loose = mesh.normals.clone();
    for (vertex, normal) in mesh.normals.iter_mut().enumerate() {
        let group = &groups[&position_key(mesh.positions[vertex])];
        let agreeing = group
            .iter()
            .filter(|&&other| loose[other].dot(loose[vertex]) > SMOOTH_COSINE);
        *normal = agreeing
            .map(|&other| loose[other].as_dvec3())
            .sum::<DVec3>()
            .normalize()
            .as_vec3();
    }
}

/// Merges vertices that agree in all attributes.
fn weld(loose: &ShapeMesh) -> ShapeMesh {
    let mut mesh = ShapeMesh::named(&loose.name);
    let mut known: HashMap<[u32; 8], u32> = HashMap::new();
    let mut welded = Vec::with_capacity(loose.positions.len());
    for (vertex, &position) in loose.positions.iter().enumerate() {
        let (normal, uv) = (loose.normals[vertex], loose.uvs[vertex]);
        let [x, y, z] = position_key(position);
        let [nx, ny, nz] = position_key(normal);
        let key = [x, y, z, nx, ny, nz, uv.x.to_bits(), uv.y.to_bits()];
        let index = *known
            .entry(key)
            .or_insert_with(|| mesh.push_vertex(position, normal, uv));
        welded.push(index);
    }
    let triangles = loose.triangles.iter();
    mesh.triangles
        .extend(triangles.map(|t| t.map(|index| welded[index as usize])));
    mesh
}
