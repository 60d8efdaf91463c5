use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec2};

use super::*;
use crate::expression::Expression;
use crate::parametric::{numeric_jet, sphere, torus};
use crate::topology::topology;

/// The jet of a surface whose coordinates are expressions of s and t.
fn jet_of(coordinates: &[Expression], s: f64, t: f64) -> SurfaceJet {
    let [x, y, z] = [0, 1, 2].map(|axis| coordinates[axis].jet([s, t]));
    let vector = |of: fn(&crate::expression::Jet) -> f64| DVec3::new(of(&x), of(&y), of(&z));
    SurfaceJet {
        position: vector(|jet| jet.value),
        s: vector(|jet| jet.partials[0]),
        t: vector(|jet| jet.partials[1]),
        ss: vector(|jet| jet.seconds[0]),
        st: vector(|jet| jet.seconds[1]),
        tt: vector(|jet| jet.seconds[2]),
    }
}

fn parsed(text: &str) -> Vec<Expression> {
    Expression::parse_list(text, &["s", "t"]).unwrap_or_else(|error| panic!("{error}"))
}

fn sheet_of(text: &str, s: Range<f64>, t: Range<f64>, cells: [u32; 2], seams: Seams) -> ShapeMesh {
    let coordinates = parsed(text);
    let grid = Grid { s, t, cells, seams };
    sheet("sheet", &grid, |s, t| jet_of(&coordinates, s, t))
}

const SPHERE: &str = "2*cos(s)*cos(t), 2*sin(s)*cos(t), 2*sin(t)";
const TORUS: &str = "(3 + cos(t))*cos(s), (3 + cos(t))*sin(s), sin(t)";

/// The mesh with vertices at the same position merged.
fn by_position(mesh: &ShapeMesh) -> ShapeMesh {
    let mut numbers = HashMap::new();
    let mut merged = ShapeMesh::named("merged");
    for triangle in &mesh.triangles {
        let triangle = triangle.map(|corner| {
            let (position, normal) = (
                mesh.positions[corner as usize],
                mesh.normals[corner as usize],
            );
            let key = position.to_array().map(f32::to_bits);
            *numbers
                .entry(key)
                .or_insert_with(|| merged.push_vertex(position, normal, Vec2::ZERO))
        });
        merged.triangles.push(triangle);
    }
    merged
}

/// Rows: M4.
#[test]
fn closed_surfaces_are_closed_by_indices_or_by_positions() {
    let ellipsoid = "3*cos(s)*cos(t), sin(s)*cos(t), 2*sin(t)";
    let knot = "(2 + cos(3*s)/2 + cos(t)/4)*cos(2*s), (2 + cos(3*s)/2 + cos(t)/4)*sin(2*s), \
                sin(3*s)/2 + sin(t)/4";
    for (text, t, characteristic) in [
        (SPHERE, -PI / 2.0..PI / 2.0, 2),
        (ellipsoid, -PI / 2.0..PI / 2.0, 2),
        (TORUS, -PI..PI, 0),
        (knot, 0.0..TAU, 0),
    ] {
        for cells in [[3, 3], [7, 5], [40, 20]] {
            let joined = sheet_of(text, -PI..PI, t.clone(), cells, Seams::Joined);
            let found = topology(&joined);
            assert!(found.border.is_empty(), "{text} {cells:?}");
            assert_eq!(
                found.euler_characteristic, characteristic,
                "{text} {cells:?}"
            );
            assert!(joined.uvs.is_empty());
            let split = sheet_of(text, -PI..PI, t.clone(), cells, Seams::Split);
            assert_eq!(split.uvs.len(), split.positions.len());
            let found = topology(&by_position(&split));
            assert!(found.border.is_empty(), "{text} {cells:?}");
            assert_eq!(
                found.euler_characteristic, characteristic,
                "{text} {cells:?}"
            );
            assert_eq!(split.triangles.len(), joined.triangles.len());
            for triangle in &split.triangles {
                let [a, b, c] = triangle.map(|i| split.uvs[i as usize]);
                assert!(
                    (b - a).perp_dot(c - a) < 0.0,
                    "images are not mirrored: {a} {b} {c}"
                );
            }
        }
    }
    // A strip of Möbius has no inside: its ends meet turned over, and stay apart.
    let moebius = "(1 + t*cos(s/2))*cos(s), (1 + t*cos(s/2))*sin(s), t*sin(s/2)";
    let strip = sheet_of(moebius, 0.0..TAU, -0.3..0.3, [40, 4], Seams::Joined);
    assert_eq!(topology(&strip).euler_characteristic, 1);
}

/// Normals are the exact ones everywhere, poles included.
/// Rows: M4.
#[test]
fn normals_are_exact_and_limits_at_poles() {
    for seams in [Seams::Split, Seams::Joined] {
        let ball = sheet_of(SPHERE, -PI..PI, -PI / 2.0..PI / 2.0, [12, 8], seams);
        for (position, normal) in ball.positions.iter().zip(&ball.normals) {
            assert!(
                position.distance(*normal * 2.0) < 1e-6,
                "{position} {normal}"
            );
        }
        let poles = ball.positions.iter().filter(|p| p.z.abs() == 2.0).count();
        assert_eq!(poles, if seams == Seams::Joined { 2 } else { 2 * 12 });
    }
    // With both ranges turned around it is the same sphere, with one of them its inside.
    for (s, t, sign) in [
        (PI..-PI, PI / 2.0..-PI / 2.0, 0.5),
        (PI..-PI, -PI / 2.0..PI / 2.0, -0.5),
    ] {
        let ball = sheet_of(SPHERE, s, t, [12, 8], Seams::Joined);
        for (position, normal) in ball.positions.iter().zip(&ball.normals) {
            assert!(
                normal.distance(*position * sign) < 1e-6,
                "{position} {normal}"
            );
        }
    }
    // The tip of a cone at the end of t, and of a cusp whose first and second derivatives vanish.
    let cone = sheet_of(
        "(1-t)*cos(s), (1-t)*sin(s), t",
        0.0..TAU,
        0.0..1.0,
        [16, 4],
        Seams::Split,
    );
    let mut tips = 0;
    for (position, normal) in cone.positions.iter().zip(&cone.normals) {
        assert!(
            (normal.z - libm::sqrtf(0.5)).abs() < 1e-6,
            "{position} {normal}"
        );
        tips += usize::from(position.z == 1.0);
    }
    assert_eq!(tips, 16, "a cone's tip has a normal for each side");
    let cusp = sheet_of(
        "t^3*cos(s), t^3*sin(s), -t^3",
        0.0..TAU,
        0.0..1.0,
        [16, 4],
        Seams::Split,
    );
    for normal in &cusp.normals {
        assert!((normal.z.abs() - libm::sqrtf(0.5)).abs() < 1e-3, "{normal}");
    }
    // A column that is a point: a pole on the side of s.
    let turned = "2*cos(t)*cos(s), 2*sin(t)*cos(s), 2*sin(s)";
    let ball = sheet_of(turned, -PI / 2.0..PI / 2.0, -PI..PI, [8, 12], Seams::Joined);
    let found = topology(&ball);
    assert!(found.border.is_empty() && found.euler_characteristic == 2);
    for (position, normal) in ball.positions.iter().zip(&ball.normals) {
        assert!(
            position.distance(*normal * -2.0) < 1e-6,
            "inwards: {position} {normal}"
        );
    }
}

/// The general form agrees with the named solids, up to the direction of their axes.
/// Rows: M4.
#[test]
fn sheets_agree_with_the_named_solids() {
    let sphere = sphere(2.0, 24, 12);
    let torus = torus(3.0, 1.0, 24, 12);
    for (named, text, s, t) in [
        (sphere, SPHERE, -PI..PI, -PI / 2.0..PI / 2.0),
        (torus, TORUS, -PI..PI, -PI..PI),
    ] {
        let general = sheet_of(text, s, t, [24, 12], Seams::Split);
        assert_eq!(general.triangles.len(), named.triangles.len());
        // Y up, image in the middle of +Z, against Z up and +X.
        let turned = |v: &glam::Vec3| glam::Vec3::new(v.z, v.x, v.y);
        for (position, normal) in named.positions.iter().zip(&named.normals) {
            let (position, normal) = (turned(position), turned(normal));
            let nearest = general
                .positions
                .iter()
                .zip(&general.normals)
                .min_by(|a, b| {
                    let distance = |v: &glam::Vec3| v.distance(position);
                    distance(a.0).total_cmp(&distance(b.0))
                });
            let (p, n) = nearest.unwrap();
            assert!(
                p.distance(position) < 1e-6 && n.distance(normal) < 1e-6,
                "{p} {position}"
            );
        }
    }
}

/// Rows: M4.
#[test]
fn numeric_derivatives_agree_with_exact_ones() {
    for text in [SPHERE, TORUS, "s*t, exp(s)*sin(t), s^2 - cos(t*s)"] {
        let coordinates = parsed(text);
        for (s, t) in [(0.3, 0.7), (-1.0, 0.2), (2.0, -0.9)] {
            let exact = jet_of(&coordinates, s, t);
            let numeric = numeric_jet(
                |s, t| DVec3::from_array([0, 1, 2].map(|axis| coordinates[axis].value(&[s, t]))),
                [s, t],
                [1e-4, 1e-4],
            );
            assert_eq!(exact.position, numeric.position);
            for (a, b, limit) in [
                (exact.s, numeric.s, 1e-6),
                (exact.t, numeric.t, 1e-6),
                (exact.ss, numeric.ss, 1e-5),
                (exact.st, numeric.st, 1e-5),
                (exact.tt, numeric.tt, 1e-5),
            ] {
                assert!(
                    a.distance(b) < limit * (1.0 + a.length()),
                    "{text}: {a} {b}"
                );
            }
            let (a, b) = (exact.normal([1.0, 1.0]), numeric.normal([1.0, 1.0]));
            assert!(a.unwrap().distance(b.unwrap()) < 1e-6);
        }
    }
    // The pole of a sphere by differences.
    let point = |s: f64, t: f64| {
        DVec3::new(
            libm::cos(s) * libm::cos(t),
            libm::sin(s) * libm::cos(t),
            libm::sin(t),
        )
    };
    let pole = numeric_jet(point, [1.0, PI / 2.0], [1e-4, 1e-4]);
    assert!(pole.normal([1.0, -1.0]).unwrap().distance(DVec3::Z) < 1e-4);
}

#[test]
fn jumps_and_ends_of_the_domain() {
    // A screw of which one half is lifted by a step.
    let stepped = sheet_of(
        "s, t, 2*floor(s)",
        -1.0..0.99,
        0.0..1.0,
        [11, 3],
        Seams::Joined,
    );
    let heights = |triangle: &[u32; 3]| triangle.map(|i| stepped.positions[i as usize].z);
    assert!(
        stepped
            .triangles
            .iter()
            .map(heights)
            .all(|[a, b, c]| a == b && b == c)
    );
    assert_eq!(stepped.triangles.len(), 10 * 3 * 2);
    // A sphere by its roots ends at the equator of both halves.
    let half = sheet_of(
        "s, t, sqrt(1 - s^2 - t^2)",
        -1.0..1.0,
        -1.0..1.0,
        [20, 20],
        Seams::Split,
    );
    let rim = topology(&half).border;
    let on_rim = |&[a, _]: &[u32; 2]| half.positions[a as usize].z < 1e-3;
    assert!(rim.len() > 40 && rim.iter().all(on_rim));
    // Nothing at all.
    for nothing in ["0/0, 0, 0", "1, 2, 3", "s, 0, 0"] {
        let mesh = sheet_of(nothing, 0.0..1.0, 0.0..1.0, [4, 4], Seams::Joined);
        assert!(mesh.positions.iter().all(|p| p.is_finite()), "{nothing}");
        assert!(
            mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-6),
            "{nothing}"
        );
    }
}
