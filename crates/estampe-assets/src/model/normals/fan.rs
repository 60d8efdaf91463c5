//! The normals of the corners around one point, and the rule by which its faces share them.

use super::faces::Faces;
use super::unit_or_zero;
use estampe_scene::Mesh;
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
pub(super) struct Fan {
    bundles: Vec<Bundle>,
    results: Vec<Vec3>,
    cells: Vec<Vec3>,
    by_group: Vec<(u32, u32)>,
}

impl Fan {
    /// Appends each of one point's `corners` with its normal.
    pub(super) fn normals(
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
