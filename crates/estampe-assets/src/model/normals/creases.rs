//! Normals of corners, with creases.

use super::faces::{Faces, PIECE};
use super::unit_or_zero;
use crate::zeros::zeros;
use estampe_scene::{Mesh, Workers, pieces};
use glam::Vec3;

/// Points with more faces than this group them into cells before pairs are compared.
pub(super) const MAX_PAIRED: usize = 64;

/// Rule by which faces around a point share a normal.
#[derive(Debug)]
pub(super) enum Grouping {
    /// Faces whose normals have at least this cosine.
    ByAngle {
        /// Cosine of the crease angle.
        cos_whole: f32,
        /// Cosine of half of it.
        cos_half: f32,
    },
    /// Faces with the same number, one number for each triangle of all meshes; 0 shares with none.
    ByGroup(Vec<u32>),
}

impl Grouping {
    pub(super) fn by_angle(degrees: f32) -> Self {
        let whole_rad = degrees.clamp(0.0, 180.0).to_radians();
        // Above 0, so that a zero sum is within the angle of no face.
        let cos_half = libm::cosf(whole_rad * 0.5).max(f32::EPSILON);
        Self::ByAngle {
            cos_whole: libm::cosf(whole_rad),
            cos_half,
        }
    }

    pub(super) fn by_group(meshes: &[Mesh], groups: &[Vec<u32>]) -> Self {
        let mut all = Vec::new();
        for (index, mesh) in meshes.iter().enumerate() {
            let end = all.len() + mesh.triangles.len();
            let listed = groups.get(index).map_or(&[][..], Vec::as_slice);
            all.extend(listed.iter().take(mesh.triangles.len()));
            all.resize(end, 0);
        }
        Self::ByGroup(all)
    }
}

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

/// Faces that are treated as one: a face, or a cell of faces with similar normals.
#[derive(Debug, Clone, Copy, Default)]
struct Bundle {
    /// Unit normal.
    normal: Vec3,
    /// Area-weighted sum.
    weighted: Vec3,
}

/// Scratch for one point's faces.
#[derive(Debug, Default)]
struct Fan {
    bundles: Vec<Bundle>,
    results: Vec<Vec3>,
    cells: Vec<Vec3>,
    by_group: Vec<(u32, u32)>,
}

impl Fan {
    /// Appends each of one point's `corners` with its normal.
    fn normals(
        &mut self,
        corners: &[u32],
        faces: &Faces,
        grouping: &Grouping,
        out: &mut Vec<(u32, Vec3)>,
    ) {
        match grouping {
            &Grouping::ByAngle { cos_whole, .. } if corners.len() <= MAX_PAIRED => {
                self.bundles.clear();
                self.bundles.extend(corners.iter().map(|&corner| {
                    let face = faces.of_corner(corner);
                    Bundle {
                        normal: face.normal(),
                        weighted: face.weighted(),
                    }
                }));
                self.pair(cos_whole);
                out.extend(corners.iter().copied().zip(self.results.iter().copied()));
            }
            &Grouping::ByAngle { cos_whole, .. } => self.by_cells(corners, faces, cos_whole, out),
            Grouping::ByGroup(groups) => self.by_groups(corners, faces, groups, out),
        }
    }

    /// For each bundle, the normalised sum of all bundles within the angle.
    fn pair(&mut self, cos_whole: f32) {
        let bundles = &self.bundles;
        self.results.clear();
        self.results.extend(bundles.iter().map(|own| {
            // A bundle without direction shares with all.
            let goes_with = |other: &Bundle| {
                own.normal == Vec3::ZERO || own.normal.dot(other.normal) >= cos_whole
            };
            let together = bundles.iter().filter(|other| goes_with(other));
            let sum = together.fold(Vec3::ZERO, |sum, other| sum + other.weighted);
            let unit = unit_or_zero(sum);
            if unit == Vec3::ZERO { own.normal } else { unit }
        }));
    }

    /// Compares pairs of cells instead of pairs of faces.
    fn by_cells(
        &mut self,
        corners: &[u32],
        faces: &Faces,
        cos_whole: f32,
        out: &mut Vec<(u32, Vec3)>,
    ) {
        self.cells.clear();
        self.cells.resize(CELL_COUNT, Vec3::ZERO);
        for &corner in corners {
            let face = faces.of_corner(corner);
            self.cells[cell(face.normal())] += face.weighted();
        }
        self.bundles.clear();
        let bundles = self.cells.iter();
        self.bundles.extend(bundles.map(|&weighted| Bundle {
            normal: unit_or_zero(weighted),
            weighted,
        }));
        // Most cells are empty, and comparing them would waste time.
        let is_used = |bundle: &Bundle| bundle.normal != Vec3::ZERO;
        let used: Vec<usize> = (0..CELL_COUNT)
            .filter(|&i| is_used(&self.bundles[i]))
            .collect();
        self.bundles = used.iter().map(|&i| self.bundles[i]).collect();
        self.pair(cos_whole);
        for (&used, &normal) in used.iter().zip(&self.results) {
            self.cells[used] = normal;
        }
        out.extend(corners.iter().map(|&corner| {
            let own = faces.of_corner(corner).normal();
            let shared = self.cells[cell(own)];
            (
                corner,
                if own == Vec3::ZERO {
                    Vec3::ZERO
                } else {
                    shared
                },
            )
        }));
    }

    /// One normal for each smoothing group; the face's own for group 0.
    fn by_groups(
        &mut self,
        corners: &[u32],
        faces: &Faces,
        groups: &[u32],
        out: &mut Vec<(u32, Vec3)>,
    ) {
        let group = |corner: u32| groups[corner as usize / 3];
        self.by_group.clear();
        self.by_group
            .extend(corners.iter().map(|&corner| (group(corner), corner)));
        self.by_group.sort_unstable();
        for run in self.by_group.chunk_by(|a, b| a.0 == b.0) {
            let faces = run.iter().map(|&(_, corner)| faces.of_corner(corner));
            if run[0].0 == 0 {
                out.extend(
                    run.iter()
                        .zip(faces)
                        .map(|(&(_, corner), face)| (corner, face.normal())),
                );
                continue;
            }
            let normal = unit_or_zero(faces.map(|face| face.weighted()).sum());
            out.extend(run.iter().map(|&(_, corner)| (corner, normal)));
        }
    }
}

/// Cells of a side of the cube around the directions.
const CELLS_PER_SIDE: usize = 6;
const CELL_COUNT: usize = 6 * CELLS_PER_SIDE * CELLS_PER_SIDE;

/// The cell of a direction: the side of a cube that it passes through, and the position there.
/// About 15° wide.
fn cell(normal: Vec3) -> usize {
    let size = normal.abs();
    let (side, major, u, v) = if size.x >= size.y && size.x >= size.z {
        (0, normal.x, normal.y, normal.z)
    } else if size.y >= size.z {
        (1, normal.y, normal.z, normal.x)
    } else {
        (2, normal.z, normal.x, normal.y)
    };
    #[expect(
        clippy::cast_possible_truncation,
        reason = "floats saturate, NaN becomes 0"
    )]
    #[expect(clippy::cast_sign_loss, reason = "floats saturate")]
    let along = |minor: f32| {
        let from_zero_to_one = minor / major.abs() * 0.5 + 0.5;
        ((from_zero_to_one * CELLS_PER_SIDE as f32) as usize).min(CELLS_PER_SIDE - 1)
    };
    let side = side * 2 + usize::from(major < 0.0);
    (side * CELLS_PER_SIDE + along(u)) * CELLS_PER_SIDE + along(v)
}
