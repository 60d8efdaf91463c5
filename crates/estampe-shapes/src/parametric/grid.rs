//! Meshes of surfaces over a grid of parameters.

use std::ops::Range;

use glam::{DVec3, Vec2};

use crate::mesh::ShapeMesh;

/// The maximum number of cells of a grid in either direction; larger numbers are clamped.
pub const MAX_CELLS: u32 = 2048;

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The position.
    pub position: DVec3,
    /// The unit normal, on the side of ∂S/∂t × ∂S/∂s.
    pub normal: DVec3,
}

/// Meshes the surface `point(s, t)` over a rectangle of parameters.
///
/// `cells` are the numbers of cells along s and t, clamped to 1..=[`MAX_CELLS`]. Texture
/// coordinates run from 0 to 1 along both. Degenerate triangles are omitted, see [the
/// module](super).
#[must_use]
pub fn surface(
    name: &str,
    s_range: Range<f64>,
    t_range: Range<f64>,
    cells: [u32; 2],
    point: impl Fn(f64, f64) -> SurfacePoint,
) -> ShapeMesh {
    let mut mesh = ShapeMesh::named(name);
    let whole = Vec2::ZERO..Vec2::ONE;
    append_grid(
        &mut mesh,
        cells,
        whole,
        |step_s, steps_s, step_t, steps_t| {
            point(
                between(&s_range, step_s, steps_s),
                between(&t_range, step_t, steps_t),
            )
        },
    );
    mesh
}

/// Interpolates a range; exact at both ends in spite of rounding.
pub(crate) fn between(range: &Range<f64>, step: u32, steps: u32) -> f64 {
    let (step, steps) = (f64::from(step), f64::from(steps));
    (range.start * (steps - step) + range.end * step) / steps
}

/// Appends a grid of cells. `point` is called with a step along s, the number of steps, and the
/// same along t. The grid shows the part `uv` of the image; `uv.start` belongs to its first point.
pub(crate) fn append_grid(
    mesh: &mut ShapeMesh,
    cells: [u32; 2],
    uv: Range<Vec2>,
    point: impl Fn(u32, u32, u32, u32) -> SurfacePoint,
) {
    let [cells_s, cells_t] = cells.map(|count| count.clamp(1, MAX_CELLS));
    let uv_at = |cell_s: f64, step_t: u32| {
        let fraction_s = cell_s / f64::from(cells_s);
        let fraction_t = f64::from(step_t) / f64::from(cells_t);
        let (start, end) = (uv.start.as_dvec2(), uv.end.as_dvec2());
        // Both ends exact, so that neighbouring grids agree.
        let u = start.x * (1.0 - fraction_s) + end.x * fraction_s;
        let v = start.y * (1.0 - fraction_t) + end.y * fraction_t;
        glam::DVec2::new(u, v).as_vec2()
    };

    let mut row_above: Vec<u32> = Vec::new();
    for step_t in 0..=cells_t {
        // Sample the row, and test whether all of it is a single point.
        let samples: Vec<_> = (0..=cells_s)
            .map(|step_s| {
                let sample = point(step_s, cells_s, step_t, cells_t);
                // Adding zero turns −0 into 0.
                let position = sample.position.as_vec3() + glam::Vec3::ZERO;
                (position, sample.normal.as_vec3() + glam::Vec3::ZERO)
            })
            .collect();
        let is_pole = samples
            .iter()
            .all(|&(position, _)| position == samples[0].0);

        let row: Vec<u32> = (0..=cells_s)
            .zip(samples)
            .take(if is_pole {
                cells_s as usize
            } else {
                usize::MAX
            })
            .map(|(step_s, (position, normal))| {
                let cell_s = if is_pole {
                    f64::from(step_s) + 0.5
                } else {
                    f64::from(step_s)
                };
                mesh.push_vertex(position, normal, uv_at(cell_s, step_t))
            })
            .collect();

        // Vertex i of a pole is both upper or both lower corners of cell i.
        let corners = |row: &[u32], cell: usize| {
            let right = if row.len() > cells_s as usize {
                cell + 1
            } else {
                cell
            };
            (row[cell], row[right])
        };
        if !row_above.is_empty() {
            for cell in 0..cells_s as usize {
                let (a, d) = corners(&row_above, cell);
                let (b, c) = corners(&row, cell);
                mesh.push_triangle([a, b, c]);
                mesh.push_triangle([a, c, d]);
            }
        }
        row_above = row;
    }
}
