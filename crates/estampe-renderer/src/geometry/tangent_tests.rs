//! Tangents of MikkTSpace against tangents that are known, and the properties that its author
//! states (M. Mikkelsen, 2008, and the comments of his implementation): the result depends on the
//! corners alone, not on their order or indices; tangents are unit and perpendicular to the normal;
//! mirrored coordinates have the sign −1 and share no tangent with others; degenerate triangles
//! take the tangents of their neighbours.

use super::tangents::with_tangents;
use estampe_scene::{Mesh, Triangle};
use glam::{Mat2, Quat, Vec2, Vec3, Vec4};

/// The tangents of a triangle's corners.
fn tangents(mesh: &Mesh, triangle: usize) -> [Vec4; 3] {
    let values = &mesh.attribute(Mesh::TANGENT).expect("tangents").values;
    let of = |index: u32| Vec4::from_slice(&values[index as usize * 4..][..4]);
    mesh.triangles[triangle].map(of)
}

fn made(mesh: &Mesh) -> Mesh {
    with_tangents(mesh, 0).expect("normals, coordinates and triangles")
}

/// A grid of squares over the unit square, each of two triangles, whose points are mapped.
fn grid(columns: u16, rows: u16, vertex: impl Fn(Vec2) -> (Vec3, Vec3, Vec2)) -> Mesh {
    let mut mesh = Mesh::default();
    for row in 0..=rows {
        for column in 0..=columns {
            let at = Vec2::new(
                f32::from(column) / f32::from(columns),
                f32::from(row) / f32::from(rows),
            );
            let (position, normal, uv) = vertex(at);
            mesh.positions.push(position);
            mesh.normals.push(normal);
            mesh.uvs.push(uv);
        }
    }
    let across = u32::from(columns) + 1;
    for row in 0..u32::from(rows) {
        for column in 0..u32::from(columns) {
            let first = row * across + column;
            let (right, below) = (first + 1, first + across);
            mesh.triangles.push([first, right, below + 1]);
            mesh.triangles.push([first, below + 1, below]);
        }
    }
    mesh
}

/// A plane whose texture is turned, stretched and sheared: the tangent is the direction in which u
/// grows, ∂p/∂u, which the inverse of the texture's matrix has as a column.
#[test]
fn planes_have_the_direction_of_u() {
    let turn = Quat::from_euler(glam::EulerRot::XYZ, 0.4, -0.8, 0.3);
    for (angle, stretch, shear) in [(0.0, 1.0, 0.0), (0.7, 3.0, 0.5), (-2.0, 0.2, -1.5)] {
        let matrix = Mat2::from_angle(angle) * Mat2::from_cols_array(&[stretch, 0.0, shear, 1.0]);
        let mesh = grid(3, 2, |at| {
            // Image rows point down: v = 1 − (up).
            let uv = matrix * at;
            let position = turn * Vec3::new(at.x, at.y, 0.0);
            (position, turn * Vec3::Z, Vec2::new(uv.x, 1.0 - uv.y))
        });
        let along_u = matrix.inverse().x_axis.normalize();
        let right = turn * along_u.extend(0.0);
        let made = made(&mesh);
        for triangle in 0..mesh.triangles.len() {
            for tangent in tangents(&made, triangle) {
                assert!((tangent.truncate() - right).length() < 1e-5, "{tangent}");
                assert_eq!(tangent.w, 1.0);
            }
        }
    }
}

/// A cylinder whose u runs around it: tangents are those of the circle at each vertex, and on its
/// mirrored copy they point the other way, with the sign −1.
#[test]
fn cylinders_have_the_tangents_of_circles() {
    for mirrored in [false, true] {
        let mesh = grid(24, 3, |at| {
            let (sin, cos) = libm::sincosf(at.x * std::f32::consts::TAU);
            let u = if mirrored { 1.0 - at.x } else { at.x };
            let normal = Vec3::new(sin, 0.0, cos);
            (normal + Vec3::Y * at.y, normal, Vec2::new(u, 1.0 - at.y))
        });
        let sign = if mirrored { -1.0 } else { 1.0 };
        let made = made(&mesh);
        for triangle in 0..mesh.triangles.len() {
            for (tangent, vertex) in tangents(&made, triangle)
                .into_iter()
                .zip(mesh.triangles[triangle])
            {
                let normal = mesh.normals[vertex as usize];
                let right = Vec3::Y.cross(normal) * sign;
                assert!(
                    (tangent.truncate() - right).length() < 2e-5,
                    "{tangent}, not {right}"
                );
                assert_eq!(tangent.w, sign);
            }
        }
    }
}

/// Two halves of a plane whose coordinates mirror each other share the vertices of the seam, but
/// no tangents: the vertices are divided.
#[test]
fn mirrored_halves_share_no_tangents() {
    let mesh = grid(2, 1, |at| {
        let u = (at.x - 0.5).abs();
        (at.extend(0.0), Vec3::Z, Vec2::new(u, 1.0 - at.y))
    });
    let made = made(&mesh);
    assert_eq!(made.positions.len(), mesh.positions.len() + 2);
    for (triangle, corners) in mesh.triangles.iter().enumerate() {
        let middle: f32 = corners
            .iter()
            .map(|&vertex| mesh.positions[vertex as usize].x)
            .sum();
        let sign = if middle > 1.5 { 1.0 } else { -1.0 };
        for tangent in tangents(&made, triangle) {
            assert_eq!(tangent, Vec4::new(sign, 0.0, 0.0, sign));
        }
    }
}

/// Triangles with two corners at one place take the tangents of the good ones at their vertices.
/// Three points of a line, which MikkTSpace does not count among them, do not disturb the others.
#[test]
fn degenerate_triangles_take_the_tangents_of_neighbours() {
    let plain = grid(2, 2, |at| {
        (at.extend(0.0), Vec3::Z, Vec2::new(at.x, 1.0 - at.y))
    });
    let mut mesh = plain.clone();
    mesh.triangles.push([0, 1, 1]);
    mesh.triangles.push([4, 4, 4]);
    let made = made(&mesh);
    for triangle in 0..mesh.triangles.len() {
        for tangent in tangents(&made, triangle) {
            assert_eq!(
                tangent,
                Vec4::new(1.0, 0.0, 0.0, 1.0),
                "triangle {triangle}"
            );
        }
    }
    assert_eq!(made.positions.len(), plain.positions.len());
    mesh.triangles.push([0, 1, 2]);
    let made = self::made(&mesh);
    for triangle in 0..plain.triangles.len() {
        for tangent in tangents(&made, triangle) {
            assert_eq!(
                tangent,
                Vec4::new(1.0, 0.0, 0.0, 1.0),
                "triangle {triangle}"
            );
        }
    }
}

/// A bumpy surface with random coordinates: tangents are unit and perpendicular to the normals, and
/// neither the order of triangles, nor that of corners, nor shared vertices change them; nor does
/// the scale of the coordinates.
#[test]
fn tangents_depend_on_the_corners_alone() {
    let mut rng = fastrand::Rng::with_seed(12);
    let mut noise = || rng.f32() - 0.5;
    let mut mesh = grid(5, 4, |at| (at.extend(0.0), Vec3::Z, at));
    for ((position, normal), uv) in mesh
        .positions
        .iter_mut()
        .zip(&mut mesh.normals)
        .zip(&mut mesh.uvs)
    {
        position.z = noise() * 0.3;
        *normal = Vec3::new(noise(), noise(), 1.5).normalize();
        *uv += Vec2::new(noise(), noise()) * 0.1;
    }
    let right = made(&mesh);
    for triangle in 0..mesh.triangles.len() {
        let corners = tangents(&right, triangle).into_iter();
        for (tangent, vertex) in corners.zip(mesh.triangles[triangle]) {
            let tangent = tangent.truncate();
            assert!((tangent.length() - 1.0).abs() < 1e-5);
            assert!(tangent.dot(mesh.normals[vertex as usize]).abs() < 1e-5);
        }
    }
    let mut scaled = mesh.clone();
    for uv in &mut scaled.uvs {
        *uv *= 64.0;
    }
    let mut reversed = mesh.clone();
    reversed.triangles.reverse();
    for triangle in &mut reversed.triangles {
        triangle.rotate_left(1);
    }
    // Each corner a vertex of its own.
    let mut unshared = Mesh::default();
    for &vertex in mesh.triangles.as_flattened() {
        let vertex = vertex as usize;
        unshared.positions.push(mesh.positions[vertex]);
        unshared.normals.push(mesh.normals[vertex]);
        unshared.uvs.push(mesh.uvs[vertex]);
    }
    let numbers: Vec<u32> = (0..).take(unshared.positions.len()).collect();
    let triples: &[Triangle] = numbers.as_chunks::<3>().0;
    unshared.triangles = triples.to_vec();
    let (scaled, reversed, unshared) = (made(&scaled), made(&reversed), made(&unshared));
    let last = mesh.triangles.len() - 1;
    for triangle in 0..=last {
        let expected = tangents(&right, triangle);
        let mut turned = tangents(&reversed, last - triangle);
        turned.rotate_right(1);
        for other in [
            tangents(&scaled, triangle),
            turned,
            tangents(&unshared, triangle),
        ] {
            for (own, right) in other.into_iter().zip(expected) {
                assert!((own - right).length() < 1e-4, "{own}, not {right}");
            }
        }
    }
}
