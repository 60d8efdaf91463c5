use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};

use super::*;
use crate::mesh::ShapeMesh;
use crate::parametric;
use crate::random_cases::random_cases;
use crate::topology::topology;

fn circle(radius: f64, steps: u32) -> Curve {
    parametric::curve(&(0.0..TAU), steps, |t| {
        let (sin, cos) = (libm::sin(t), libm::cos(t));
        let point = DVec3::new(cos, sin, 0.0) * radius;
        (point, DVec3::new(-sin, cos, 0.0) * radius)
    })
}

/// Rows: M4.
#[test]
fn parametric_curves_close_and_have_their_length() {
    let ring = circle(2.0, 360);
    assert_eq!(ring.strands.len(), 1);
    assert!(ring.strands[0].is_closed && ring.strands[0].points.len() == 360);
    assert!((ring.length() - 4.0 * PI).abs() < 1e-3);
    let (positions, lines) = ring.lines();
    assert_eq!(
        (positions.len(), lines.len(), lines[359]),
        (360, 360, [359, 0])
    );

    let helix = parametric::helix(3.0, 4.0, 5.0, 2000);
    let strand = &helix.strands[0];
    assert!(!strand.is_closed && strand.points.len() == 2001);
    assert_eq!(
        strand.points[2000],
        DVec3::new(3.0, 0.0, 20.0),
        "a whole number of turns"
    );
    assert!((helix.length() - 5.0 * libm::sqrt(libm::pow(TAU * 3.0, 2.0) + 16.0)).abs() < 1e-3);
    // Right-handed: a quarter turn on, it is at +Y and a quarter of the pitch higher.
    assert!(strand.points[100].distance(DVec3::new(0.0, 3.0, 1.0)) < 1e-9);
}

/// Six times the volume is the sum of a · (b × c).
fn volume(mesh: &ShapeMesh) -> f64 {
    let at = |i: u32| mesh.positions[i as usize].as_dvec3();
    let parts = mesh
        .triangles
        .iter()
        .map(|&[a, b, c]| at(a).dot(at(b).cross(at(c))));
    parts.sum::<f64>() / 6.0
}

/// A tube is closed, faces outwards, and has the volume of its length and radius (Pappus).
/// Rows: M4.
#[test]
fn tubes_are_closed_and_have_their_volume() {
    let ring = tube(&circle(2.0, 200), 0.25, 32);
    let found = topology(&ring);
    assert!(found.border.is_empty() && found.euler_characteristic == 0);
    assert!(
        (volume(&ring) / (PI * 0.0625 * TAU * 2.0) - 1.0).abs() < 0.01,
        "{}",
        volume(&ring)
    );

    let helix = parametric::helix(1.0, 0.5, 3.0, 600);
    let spring = tube(&helix, 0.05, 24);
    let found = topology(&spring);
    assert!(found.border.is_empty() && found.euler_characteristic == 2);
    let expected = PI * 0.0025 * helix.length() + 4.0 / 3.0 * PI * 0.000_125;
    assert!((volume(&spring) / expected - 1.0).abs() < 0.02);
    for triangle in &spring.triangles {
        let [a, b, c] = triangle.map(|i| spring.positions[i as usize]);
        let face = (b - a).cross(c - a);
        for &i in triangle {
            assert!(face.dot(spring.normals[i as usize]) > 0.0, "outwards");
        }
    }
}

/// A knot that is closed and twists: the seam of its tube is as regular as the rest.
#[test]
fn closed_tubes_do_not_twist_at_their_end() {
    let knot = parametric::curve(&(0.0..TAU), 400, |t| {
        let around = |n: f64| (libm::cos(n * t), libm::sin(n * t));
        let ((c2, s2), (c3, s3)) = (around(2.0), around(3.0));
        let point = DVec3::new((2.0 + c3) * c2, (2.0 + c3) * s2, s3);
        let slope = DVec3::new(
            -3.0 * s3 * c2 - 2.0 * (2.0 + c3) * s2,
            -3.0 * s3 * s2 + 2.0 * (2.0 + c3) * c2,
            3.0 * c3,
        );
        (point, slope)
    });
    let mesh = tube(&knot, 0.2, 16);
    assert!(topology(&mesh).border.is_empty());
    let longest = mesh
        .triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let length = |[a, b]: [u32; 2]| mesh.positions[a as usize].distance(mesh.positions[b as usize]);
    let longest = f64::from(longest.map(length).fold(0.0, f32::max));
    let step = knot.length() / 400.0;
    // A diagonal of a cell: a step along, a sixteenth of a turn and a little twist across.
    assert!(longest < 2.0 * step + 0.1, "{longest} {step}");
}

#[test]
fn corners_keep_the_thickness() {
    let points = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
    let bent = Curve {
        strands: vec![Strand {
            points: points.to_vec(),
            is_closed: false,
        }],
    };
    let mesh = tube(&bent, 0.5, 16);
    assert!(topology(&mesh).border.is_empty());
    // The inner and the outer side of the corner.
    let at = |x: f32, y: f32| {
        mesh.positions
            .iter()
            .any(|p| p.distance(Vec3::new(x, y, 0.0)) < 0.05)
    };
    assert!(at(3.5, 0.5) && at(4.5, -0.5));
}

#[test]
fn hostile_curves() {
    random_cases(|random| {
        let snap = random.bool();
        let mut number = || match snap {
            true => f64::from(random.u8(..3)),
            false => {
                let any = f64::from_bits(random.u64(..));
                if any.abs() < 1e30 { any } else { 0.5 }
            }
        };
        let strands: Vec<Strand> = (0..3)
            .map(|i| Strand {
                points: (0..2 + 4 * i)
                    .map(|_| DVec3::new(number(), number(), number()))
                    .collect(),
                is_closed: i == 2,
            })
            .collect();
        let curve = Curve { strands };
        for radius in [0.0, 0.1, -1.0, f64::NAN, f64::INFINITY] {
            let mesh = tube(&curve, radius, 5);
            assert!(
                mesh.positions
                    .iter()
                    .chain(&mesh.normals)
                    .all(|p| p.is_finite())
            );
            let count = mesh.positions.len();
            assert!(
                mesh.triangles
                    .as_flattened()
                    .iter()
                    .all(|&i| (i as usize) < count)
            );
        }
    });
    assert!(tube(&Curve::default(), 1.0, 8).triangles.is_empty());
}
