//! Normals of corners, with creases.

use super::faces::{Faces, PIECE};
use super::fan::{Fan, Grouping};
use super::unit_or_zero;
use crate::zeros::zeros;
use estampe_scene::{Workers, pieces};
use glam::Vec3;

/// The normals of all corners of all meshes.
#[derive(Debug)]
pub(super) struct CornerNormals {
    /// Point of each vertex; empty if no point is smooth.
    point_of_vertex: Vec<u32>,
    /// The single normal of each smooth point; arbitrary for other points.
    normals: Vec<Vec3>,
    /// Corners of the points that are not smooth, in order, with their normals.
    creased: Vec<(u32, Vec3)>,
}

/// The normals of one mesh.
#[derive(Debug)]
pub(super) struct MeshNormals<'a> {
    all: &'a CornerNormals,
    first_triangle: usize,
    first_vertex: usize,
}

impl MeshNormals<'_> {
    /// The point of each vertex of the mesh; `None` if no point is smooth.
    pub(super) fn points(&self, vertex_count: usize) -> Option<&[u32]> {
        self.all
            .point_of_vertex
            .get(self.first_vertex..self.first_vertex + vertex_count)
    }

    pub(super) fn normal_of_point(&self, point: u32) -> Vec3 {
        self.all.normals[point as usize]
    }

    /// Triangle, corner and normal of each corner of the mesh that differs from its point's normal.
    pub(super) fn creased(
        &self,
        triangle_count: usize,
    ) -> impl Iterator<Item = (usize, usize, Vec3)> {
        let first = self.first_triangle * 3;
        let end = first + triangle_count * 3;
        let creased = &self.all.creased;
        let start = creased.partition_point(|&(corner, _)| (corner as usize) < first);
        let stop = creased.partition_point(|&(corner, _)| (corner as usize) < end);
        creased[start..stop].iter().map(move |&(corner, normal)| {
            let corner = corner as usize - first;
            (corner / 3, corner % 3, normal)
        })
    }
}

impl CornerNormals {
    pub(super) fn of_mesh(&self, first_triangle: usize, first_vertex: usize) -> MeshNormals<'_> {
        MeshNormals {
            all: self,
            first_triangle,
            first_vertex,
        }
    }

    /// The normal of each vertex's point, if there is one mesh; empty if no point is smooth.
    pub(super) fn take_vertex_normals(&mut self) -> Vec<Vec3> {
        let mut normals = std::mem::take(&mut self.normals);
        for (vertex, &point) in self.point_of_vertex.iter().enumerate() {
            // A point is the first of its vertices, which has the sum.
            normals[vertex] = normals[point as usize];
        }
        normals
    }

    /// Each corner has its face's normal.
    pub(super) fn flat(faces: &Faces) -> Self {
        let creased = (0..)
            .zip(faces.iter())
            .flat_map(|(triangle, face): (u32, _)| {
                [0, 1, 2].map(|corner| (triangle * 3 + corner, face.normal()))
            });
        Self {
            point_of_vertex: Vec::new(),
            normals: Vec::new(),
            creased: creased.collect(),
        }
    }

    /// Corners share normals by `grouping`; `triangles` are triples of points.
    pub(super) fn smooth(
        triangles: &[[u32; 3]],
        point_of_vertex: Vec<u32>,
        faces: &Faces,
        grouping: &Grouping,
        workers: Workers,
    ) -> Self {
        let normals = smooth_normals(triangles, point_of_vertex.len(), faces, workers);
        let is_creased = find_creased_points(triangles, &normals, faces, grouping, workers);
        let around = CornersAround::new(triangles, &is_creased);
        let mut creased = Vec::with_capacity(around.corners.len());
        let mut fan = Fan::default();
        for range in around.points() {
            let corners = &around.corners[range];
            fan.normals(corners, faces, grouping, &mut creased);
        }
        creased.sort_unstable_by_key(|&(corner, _)| corner);
        Self {
            point_of_vertex,
            normals,
            creased,
        }
    }
}

/// The normalised sum of the weighted normals around each point.
///
/// Each thread has a range of points and reads the triangles for it, so sums are in the order of
/// the triangles for any number of threads. It leaves out pieces without points of its range, which
/// are most in meshes whose neighbouring triangles have neighbouring points.
fn smooth_normals(
    triangles: &[[u32; 3]],
    point_count: usize,
    faces: &Faces,
    workers: Workers,
) -> Vec<Vec3> {
    let ranges = if triangles.len() <= PIECE {
        1
    } else {
        workers.count()
    };
    let range = point_count.div_ceil(ranges).max(1);
    let extremes = workers.map(triangles.chunks(PIECE), |triangles| {
        let extend =
            |[least, greatest]: [u32; 2], &point: &u32| [least.min(point), greatest.max(point)];
        triangles.as_flattened().iter().fold([u32::MAX, 0], extend)
    });
    let mut sums: Vec<[f32; 3]> = zeros(point_count);
    workers.map(sums.chunks_mut(range).enumerate(), |(index, sums)| {
        let first = index * range;
        let pieces = triangles.chunks(PIECE).zip(&extremes).enumerate();
        for (piece, (triangles, &[least, greatest])) in pieces {
            if (greatest as usize) < first || least as usize >= first + sums.len() {
                continue;
            }
            for (triangle, face) in triangles.iter().zip(faces.starting_at(piece * PIECE)) {
                for &point in triangle {
                    // A point before the first wraps around to an index beyond the last.
                    if let Some(sum) = sums.get_mut((point as usize).wrapping_sub(first)) {
                        *sum = (Vec3::from_array(*sum) + face.weighted()).to_array();
                    }
                }
            }
        }
        for sum in sums {
            *sum = unit_or_zero(Vec3::from_array(*sum)).to_array();
        }
    });
    sums.into_iter().map(Vec3::from_array).collect()
}

/// Finds the points whose faces do not all share one normal.
fn find_creased_points(
    triangles: &[[u32; 3]],
    normals: &[Vec3],
    faces: &Faces,
    grouping: &Grouping,
    workers: Workers,
) -> Vec<bool> {
    let mut is_creased = vec![false; normals.len()];
    match grouping {
        &Grouping::ByAngle { cos_half, .. } => {
            let creased = workers.map(pieces(triangles.len(), PIECE), |range| {
                let faces = faces.starting_at(range.start);
                let mut creased = Vec::new();
                for (triangle, face) in triangles[range].iter().zip(faces) {
                    for &point in triangle {
                        let is_near = face.normal().dot(normals[point as usize]) >= cos_half;
                        // A face without area shares with any other.
                        if !is_near && face.area() > 0.0 {
                            creased.push(point);
                        }
                    }
                }
                creased
            });
            for point in creased.into_iter().flatten() {
                is_creased[point as usize] = true;
            }
        }
        Grouping::ByGroup(groups) => {
            /// Marks points without a face so far. A smoothing group with this number only costs
            /// time.
            const UNSEEN: u32 = u32::MAX;
            let mut group_of_point = vec![UNSEEN; normals.len()];
            for (triangle, &group) in triangles.iter().zip(groups) {
                for &point in triangle {
                    let seen = &mut group_of_point[point as usize];
                    if group == 0 || (*seen != UNSEEN && *seen != group) {
                        is_creased[point as usize] = true;
                    }
                    *seen = group;
                }
            }
        }
    }
    is_creased
}

/// The corners at each creased point (compressed sparse rows).
struct CornersAround {
    /// Corners, point by point, ascending within a point.
    corners: Vec<u32>,
    /// The end of each point's corners.
    ends: Vec<usize>,
}

impl CornersAround {
    fn new(triangles: &[[u32; 3]], is_creased: &[bool]) -> Self {
        let mut ends = vec![0; is_creased.len()];
        if !is_creased.contains(&true) {
            return Self {
                corners: Vec::new(),
                ends: Vec::new(),
            };
        }
        for &point in triangles.iter().flatten() {
            ends[point as usize] += usize::from(is_creased[point as usize]);
        }
        let mut total = 0;
        for end in &mut ends {
            // From here on the position of the point's next corner; finally the end of its corners.
            total += std::mem::replace(end, total);
        }
        let mut corners = vec![0; total];
        for (corner, &point) in (0..).zip(triangles.iter().flatten()) {
            if is_creased[point as usize] {
                corners[ends[point as usize]] = corner;
                ends[point as usize] += 1;
            }
        }
        Self { corners, ends }
    }

    fn points(&self) -> impl Iterator<Item = std::ops::Range<usize>> {
        let starts = [0].into_iter().chain(self.ends.iter().copied());
        starts
            .zip(&self.ends)
            .map(|(start, &end)| start..end)
            .filter(|range| !range.is_empty())
    }
}
