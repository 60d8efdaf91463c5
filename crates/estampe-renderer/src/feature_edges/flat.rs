//! Pictures of one flat face: in the default light they would be one colour, as the front view of a
//! plate is, so their edges are drawn.

use crate::options::RenderOptions;
use crate::scene_view::SceneView;
use estampe_scene::{Mesh, Scene, Workers, pieces};
use glam::{DVec2, DVec3, Vec3};

/// More triangles are scans and other curved surfaces, which are not looked at.
const MOST_TRIANGLES: usize = 200_000;
/// The share of the area in the picture from which on faces of one direction are nearly all.
const NEARLY_ALL: f64 = 0.9;
/// The cosine of the angle, 1 degree, within which normals are of one direction.
const COS_APART: f64 = 0.999_85;
/// Vertices or triangles of a piece of work for one thread: some hundred microseconds.
const PIECE: usize = 1 << 13;

/// True if nearly all of what the picture shows are faces in one direction, in the default light
/// and without textures and varied colours of vertices.
pub(crate) fn is_one_face(
    scene: &Scene,
    view: &SceneView,
    options: &RenderOptions,
    workers: Workers,
) -> bool {
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
    let meshes: Vec<Faces<'_>> = { scene.meshes.iter() }
        .map(|mesh| Faces::of(mesh, view, workers))
        .collect();
    let tally = { meshes.iter() }
        .flat_map(|mesh| mesh.of_pieces(workers, Tally::add))
        .fold(Tally::default(), Tally::and);
    // Six times the volume in unit space, above 0 if faces are counter-clockwise from outside. That
    // of sheets is 0 but for rounding.
    let volume = tally.volume;
    let outside = if volume.abs() > 1e-9 { volume } else { 0.0 };
    let [back, front] = tally.votes;
    let vote = if outside > 0.0 {
        front
    } else if outside < 0.0 {
        back
    } else {
        back.and(front)
    };
    // Nine tenths against one lead by eight, and by a little less where sums are rounded.
    if vote.lead < (2.0 * NEARLY_ALL - 1.01) * vote.whole {
        return false;
    }
    let alike = |sum: &mut f64, face: &Face| {
        if face.area_ndc * outside >= 0.0 && is_along(face.normal, vote.normal) {
            *sum += face.area_ndc.abs();
        }
    };
    let alike: f64 = { meshes.iter() }
        .flat_map(|mesh| mesh.of_pieces(workers, alike))
        .sum();
    vote.whole > 0.0 && alike >= NEARLY_ALL * vote.whole
}

/// The majority vote of Boyer and Moore (1981): a direction that has more than half of the area is
/// the candidate at the end, and leads by what it has more than all others.
#[derive(Debug, Clone, Copy, Default)]
struct Vote {
    /// The area of all faces.
    whole: f64,
    /// The area by which the candidate leads.
    lead: f64,
    /// The candidate.
    normal: DVec3,
}

impl Vote {
    fn and(self, other: Self) -> Self {
        let whole = self.whole + other.whole;
        let (first, second) = match self.lead >= other.lead {
            true => (self, other),
            false => (other, self),
        };
        let lead = match is_along(first.normal, second.normal) {
            true => first.lead + second.lead,
            false => first.lead - second.lead,
        };
        Self {
            whole,
            lead,
            ..first
        }
    }
}

/// Sums over faces.
#[derive(Debug, Clone, Copy, Default)]
struct Tally {
    volume: f64,
    /// Of faces that are clockwise in the picture, and of others.
    votes: [Vote; 2],
}

impl Tally {
    fn add(&mut self, face: &Face) {
        self.volume += face.volume;
        let vote = &mut self.votes[usize::from(face.area_ndc >= 0.0)];
        let area = face.area_ndc.abs();
        *vote = vote.and(Vote {
            whole: area,
            lead: area,
            normal: face.normal,
        });
    }

    fn and(self, other: Self) -> Self {
        let [back, front] = self.votes;
        Self {
            volume: self.volume + other.volume,
            votes: [back.and(other.votes[0]), front.and(other.votes[1])],
        }
    }
}

/// True if two normals have one direction, or opposite ones.
fn is_along(a: DVec3, b: DVec3) -> bool {
    a.dot(b).abs() > COS_APART
}

/// A face before the eye.
struct Face {
    normal: DVec3,
    /// In normalised device coordinates, above 0 if it is counter-clockwise there.
    area_ndc: f64,
    /// Six times that of the tetrahedron to the middle of unit space.
    volume: f64,
}

impl Face {
    /// `None` without an area, or with a corner behind the eye.
    fn of([a, b, c]: [&Corner; 3]) -> Option<Self> {
        let normal = (b.unit - a.unit).cross(c.unit - a.unit);
        let face = Self {
            normal: normal.try_normalize()?,
            area_ndc: (b.ndc - a.ndc).perp_dot(c.ndc - a.ndc),
            volume: a.unit.dot(b.unit.cross(c.unit)),
        };
        (face.area_ndc.is_finite() && face.volume.is_finite()).then_some(face)
    }
}

/// A vertex before the eye.
struct Corner {
    /// In unit space.
    unit: DVec3,
    /// In normalised device coordinates; NaN behind the eye.
    ndc: DVec2,
}

/// The faces of a mesh that have an area and are wholly before the eye. They are made again for
/// each look at them, which costs less than memory for them.
struct Faces<'a> {
    mesh: &'a Mesh,
    /// Of each vertex, in pieces.
    corners: Vec<Vec<Corner>>,
}

impl<'a> Faces<'a> {
    fn of(mesh: &'a Mesh, view: &SceneView, workers: Workers) -> Self {
        let unit_from_object = view.space.unit_from_object_matrix();
        let clip_from_unit = view.clip_from_unit();
        let least_w = view.least_w();
        let corner = |position: &Vec3| {
            let unit = unit_from_object.transform_point3(position.as_dvec3());
            let clip = clip_from_unit * unit.extend(1.0);
            let is_before = clip.w >= least_w;
            let ndc = is_before.then(|| DVec2::new(clip.x, clip.y) / clip.w);
            Corner {
                unit,
                ndc: ndc.unwrap_or(DVec2::NAN),
            }
        };
        let vertices = pieces(mesh.positions.len(), PIECE);
        let corners = |range| -> Vec<Corner> {
            let positions: &[Vec3] = &mesh.positions[range];
            positions.iter().map(corner).collect()
        };
        Self {
            mesh,
            corners: workers.map(vertices, corners),
        }
    }

    fn corner(&self, vertex: u32) -> Option<&Corner> {
        let vertex = vertex as usize;
        self.corners.get(vertex / PIECE)?.get(vertex % PIECE)
    }

    /// Shows each face of a piece of the mesh to a `T`; gives those of all pieces, in order.
    fn of_pieces<T: Default + Send>(
        &self,
        workers: Workers,
        see: impl Fn(&mut T, &Face) + Sync,
    ) -> Vec<T> {
        let triangles = pieces(self.mesh.triangles.len(), PIECE);
        workers.map(triangles, |range| {
            let mut seen = T::default();
            for &[a, b, c] in &self.mesh.triangles[range] {
                let corners = (self.corner(a), self.corner(b), self.corner(c));
                if let (Some(a), Some(b), Some(c)) = corners
                    && let Some(face) = Face::of([a, b, c])
                {
                    see(&mut seen, &face);
                }
            }
            seen
        })
    }
}
