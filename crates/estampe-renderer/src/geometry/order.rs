//! The order of transparent triangles: back to front, over all surfaces at once.

/// A triangle of a surface with its distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DistantTriangle {
    /// Distance of the triangle's centroid along the view direction.
    pub(crate) distance: f32,
    /// Index of the surface.
    pub(crate) surface: u32,
    /// Vertex indices of the corners.
    pub(crate) corners: [u32; 3],
}

/// Consecutive triangles of one surface, in drawing order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Run {
    /// Index of the surface.
    pub(crate) surface: u32,
    /// Vertex indices, three per triangle.
    pub(crate) indices: Vec<u32>,
}

/// The most runs that are drawn; beyond, their cost exceeds their use, and surfaces are drawn
/// whole.
const MOST_RUNS: usize = 4096;

/// Sorts triangles back to front (stably) and joins consecutive triangles of one surface to runs.
///
/// If interleaved surfaces would need more than `MOST_RUNS` draws, whole surfaces are ordered by
/// their furthest triangle instead, and triangles are sorted inside each surface.
pub(crate) fn back_to_front(mut triangles: Vec<DistantTriangle>) -> Vec<Run> {
    triangles.sort_by(|a, b| b.distance.total_cmp(&a.distance));
    let changes = triangles
        .windows(2)
        .filter(|pair| pair[0].surface != pair[1].surface)
        .count();
    if changes >= MOST_RUNS {
        let surfaces = triangles
            .iter()
            .map(|t| t.surface as usize + 1)
            .max()
            .unwrap_or(0);
        let mut rank_of_surface = vec![usize::MAX; surfaces];
        for (rank, triangle) in triangles.iter().enumerate() {
            let first = &mut rank_of_surface[triangle.surface as usize];
            *first = rank.min(*first);
        }
        triangles.sort_by_key(|triangle| rank_of_surface[triangle.surface as usize]);
    }
    let mut runs: Vec<Run> = Vec::new();
    for triangle in triangles {
        match runs.last_mut() {
            Some(run) if run.surface == triangle.surface => run.indices.extend(triangle.corners),
            _ => runs.push(Run {
                surface: triangle.surface,
                indices: triangle.corners.to_vec(),
            }),
        }
    }
    runs
}
