#![expect(clippy::cast_possible_truncation, reason = "tests count in hundreds")]

use std::collections::HashMap;
use std::f64::consts::PI;

use glam::{DVec3, Vec2, Vec3};

use super::*;
use crate::BuiltinShape;
use crate::mesh::ShapeMesh;
use crate::random_cases::random_cases;

/// The invariants of every mesh: sizes, ranges, unit normals on the front side of the triangles,
/// images that are not mirrored.
fn assert_sound(mesh: &ShapeMesh, smallest_cosine: f32) {
    let count = mesh.positions.len();
    assert!(count > 0 && mesh.normals.len() == count && mesh.uvs.len() == count);
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
        assert!(a != b && b != c && c != a, "{a} {b} {c}");
        let face = (b - a).cross(c - a).normalize();
        for &i in triangle {
            let normal = mesh.normals[i as usize];
            assert!((normal.length() - 1.0).abs() < 1e-6);
            assert!(normal.dot(face) >= smallest_cosine, "{normal} {face}");
        }
        let [a, b, c] = triangle.map(|i| mesh.uvs[i as usize]);
        assert!((b - a).perp_dot(c - a) < 0.0, "{a} {b} {c}");
        for uv in [a, b, c] {
            assert!(
                uv.cmpge(Vec2::ZERO).all() && uv.cmple(Vec2::ONE).all(),
                "{uv}"
            );
        }
    }
}

/// Every edge has its opposite, compared by the bits of positions; returns V − E + F.
fn euler_characteristic_of_closed(mesh: &ShapeMesh) -> i64 {
    let mut points = HashMap::new();
    let mut edges = HashMap::new();
    for triangle in &mesh.triangles {
        let corners = triangle.map(|i| {
            let key = mesh.positions[i as usize].to_array().map(f32::to_bits);
            let next = points.len();
            *points.entry(key).or_insert(next)
        });
        for i in 0..3 {
            *edges.entry((corners[i], corners[(i + 1) % 3])).or_insert(0) += 1;
        }
    }
    for (&(a, b), &count) in &edges {
        assert_eq!((count, edges.get(&(b, a))), (1, Some(&1)));
    }
    (points.len() + mesh.triangles.len()) as i64 - (edges.len() / 2) as i64
}

/// Six times the volume is the sum of a · (b × c).
fn volume(mesh: &ShapeMesh) -> f64 {
    let at = |i: u32| mesh.positions[i as usize].as_dvec3();
    mesh.triangles
        .iter()
        .map(|&[a, b, c]| at(a).dot(at(b).cross(at(c))))
        .sum::<f64>()
        / 6.0
}

/// Rows: M4.
#[test]
fn closed_shapes_are_closed_and_have_their_volume() {
    let sphere = sphere(2.0, 96, 48);
    assert_sound(&sphere, 0.99);
    assert_eq!(euler_characteristic_of_closed(&sphere), 2);
    assert!((volume(&sphere) / (4.0 / 3.0 * PI * 8.0) - 1.0).abs() < 0.005);
    assert_eq!(sphere.triangles.len(), 96 * 47 * 2);

    let torus = torus(1.0, 0.45, 96, 48);
    assert_sound(&torus, 0.99);
    assert_eq!(euler_characteristic_of_closed(&torus), 0);
    assert!((volume(&torus) / (2.0 * PI * PI * 0.45 * 0.45) - 1.0).abs() < 0.005);

    let cube = crate::cube::cube(2.0);
    assert_sound(&cube, 1.0);
    assert_eq!(euler_characteristic_of_closed(&cube), 2);
    assert!((volume(&cube) - 8.0).abs() < 1e-12);
    assert_eq!((cube.positions.len(), cube.triangles.len()), (24, 12));
}

#[test]
fn the_plane_faces_up() {
    let plane = plane(2.0, 2.0, [3, 5]);
    assert_sound(&plane, 1.0);
    assert_eq!(plane.triangles.len(), 30);
    assert_eq!(
        (plane.positions[0], plane.uvs[0]),
        (Vec3::new(-1.0, 0.0, -1.0), Vec2::ZERO)
    );
    assert_eq!(plane.positions[23], Vec3::new(1.0, 0.0, 1.0));
    assert_eq!(plane.uvs[23], Vec2::ONE);
}

/// Position of the images: the middle faces +Z, u grows to the right.
#[test]
fn images_face_the_front() {
    for mesh in [sphere(1.0, 8, 4), torus(1.0, 0.25, 8, 4)] {
        let at = |uv: Vec2| mesh.positions[mesh.uvs.iter().position(|&other| other == uv).unwrap()];
        let middle = at(Vec2::splat(0.5));
        assert_eq!(middle.normalize(), Vec3::Z);
        assert!(at(Vec2::new(0.625, 0.5)).x > 0.5);
        assert!(at(Vec2::new(0.5, 0.25)).y > 0.2);
    }
}

#[test]
fn any_grid_is_valid() {
    random_cases(|random| {
        let (a, b) = (random.u32(..40), random.u32(..40));
        let sphere = sphere(1.0, a, b);
        assert_sound(&sphere, 0.4);
        assert_eq!(euler_characteristic_of_closed(&sphere), 2);
        let torus = torus(1.0, 0.45, a, b);
        assert_sound(&torus, 0.2);
        assert_eq!(euler_characteristic_of_closed(&torus), 0);
        assert_sound(&plane(1.0, 3.0, [a, b]), 0.999);
    });
}

#[test]
fn cosine_and_sine() {
    random_cases(|random| {
        let turns = random.f64() * 6.0 - 3.0;
        let (cos, sin) = cos_sin_turns(turns);
        assert!((cos - libm::cos(2.0 * PI * turns)).abs() < 1e-14);
        assert!((sin - libm::sin(2.0 * PI * turns)).abs() < 1e-14);
    });
}

/// Surfaces from arbitrary functions: indices are in range, and nothing panics.
#[test]
fn hostile_surfaces() {
    random_cases(|random| {
        let bits = [0; 6].map(|_| random.u64(..));
        let cells = [0; 2].map(|_| random.u32(..30));
        let number = |i: usize, s: f64, t: f64| {
            f64::from_bits(bits[i]) * s + f64::from_bits(bits[i + 3]) * t
        };
        let mesh = surface(
            "any",
            -1.0..f64::from_bits(bits[0]),
            0.0..1.0,
            cells,
            |s, t| SurfacePoint {
                position: DVec3::new(number(0, s, t), number(1, s, t), number(2, s, t)),
                normal: DVec3::ZERO,
            },
        );
        let count = mesh.positions.len() as u32;
        assert!(
            mesh.triangles
                .as_flattened()
                .iter()
                .all(|&index| index < count)
        );
    });
}

#[test]
fn circles_close_exactly() {
    let quarters = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)];
    for quarter in -8_i32..9 {
        let (cos, sin) = cos_sin_turns(0.25 * f64::from(quarter));
        let (expected_cos, expected_sin) = quarters[quarter.rem_euclid(4) as usize];
        assert_eq!(cos.to_bits(), f64::to_bits(expected_cos));
        assert_eq!(sin.to_bits(), f64::to_bits(expected_sin));
    }
    for odd in [f64::NAN, f64::INFINITY, 1e300, -0.0] {
        assert_eq!(cos_sin_turns(odd), (1.0, 0.0), "{odd}");
    }
}

#[test]
fn builtin_shapes_by_name() {
    for shape in BuiltinShape::ALL {
        assert_eq!(shape.name().parse(), Ok(shape));
        assert_eq!(shape.name().to_uppercase().parse(), Ok(shape));
        let mesh = shape.build();
        assert_eq!(mesh.name, shape.to_string());
        assert_sound(&mesh, 0.6);
        let largest = mesh
            .positions
            .iter()
            .map(|p| p.abs().max_element())
            .fold(0.0, f32::max);
        assert!((1.0..3.5).contains(&largest), "{shape}: {largest}");
    }
    let error = "bunny".parse::<BuiltinShape>().unwrap_err();
    assert_eq!(
        error.to_string(),
        "no built-in model is called \"bunny\"; there are teapot, sphere, torus, cube and plane"
    );
}

/// Built-in shapes have the same bits on every machine. If this fails, every picture changes.
#[test]
fn bits_are_fixed() {
    let fingerprint = |mesh: &ShapeMesh| {
        let vectors = mesh
            .positions
            .iter()
            .chain(&mesh.normals)
            .flat_map(|v| v.to_array());
        let bits = vectors
            .chain(mesh.uvs.iter().flat_map(|uv| uv.to_array()))
            .map(f32::to_bits);
        // FNV-1a over words.
        let words = bits.chain(mesh.triangles.as_flattened().iter().copied());
        words.fold(0xCBF2_9CE4_8422_2325_u64, |hash, word| {
            (hash ^ u64::from(word)).wrapping_mul(0x0100_0000_01B3)
        })
    };
    let fingerprints = BuiltinShape::ALL.map(|shape| fingerprint(&shape.build()));
    let expected: [u64; 5] = [
        0x1733_3873_B5BA_BF70,
        0x300D_33B7_04F0_96B5,
        0xE013_DAEA_2F27_0C0F,
        0x0231_06B4_A24E_0305,
        0x8CD4_0AF7_6C0B_ED0C,
    ];
    assert_eq!(fingerprints, expected, "{fingerprints:#X?}");
}
