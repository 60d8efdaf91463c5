use std::collections::HashMap;
use std::f64::consts::PI;
use std::ops::Range;

use fastrand::Rng;
use glam::{DVec2, DVec3, Vec3};

use super::surface::surface_up_to;
use super::*;
use crate::expression::Expression;
use crate::mesh::ShapeMesh;
use crate::topology::{Topology, topology};

const XYZ: &[&str] = &["x", "y", "z"];

/// The surface of an expression in the cube from −half to half.
fn meshed(text: &str, half: f64, cells: u32) -> ImplicitSurface {
    let expression = Expression::parse_equation(text, XYZ).unwrap_or_else(|e| panic!("{e}"));
    let bounds = [-half..half, -half..half, -half..half];
    let surface = surface(
        &bounds,
        [cells; 3],
        |p| expression.value(&p.to_array()),
        |p| DVec3::from_array(expression.dual(p.to_array()).partials),
    );
    surface.unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// The border edges that do not lie on a face of the cube from −half to half.
fn inner_border(mesh: &ShapeMesh, topology: &Topology, half: f32) -> usize {
    let at = |vertex: u32| mesh.positions[vertex as usize];
    let is_on_face =
        |[a, b]: [Vec3; 2]| (0..3).any(|axis| a[axis].abs() == half && a[axis] == b[axis]);
    let border = topology.border.iter().map(|edge| edge.map(at));
    border.filter(|edge| !is_on_face(*edge)).count()
}

/// The share of vertices at roots: beside them the function changes its sign, within a few
/// thousandths of a cell along the normal or an axis (a normal at a crease may run along the
/// surface), or it is as small there.
fn share_at_roots(mesh: &ShapeMesh, cell: f64, function: impl Fn(DVec3) -> f64) -> f64 {
    let vertices = mesh.positions.iter().zip(&mesh.normals);
    let at_roots = vertices.filter(|(position, normal)| {
        let p = position.as_dvec3();
        let ways = [normal.as_dvec3(), DVec3::X, DVec3::Y, DVec3::Z];
        let values = ways.into_iter().flat_map(|way| {
            let step = way * (2e-3 * cell);
            [function(p - step), function(p + step)]
        });
        let negative = values.filter(|value| *value < 0.0).count();
        (1..8).contains(&negative) || function(p).abs() < 1e-5 * cell
    });
    at_roots.count() as f64 / mesh.positions.len().max(1) as f64
}

/// Rows: M5.
#[test]
fn known_surfaces_have_their_topology_area_and_normals() {
    let torus = "(x^2 + y^2 + z^2 + 0.5)^2 - 3.3*(x^2 + y^2)";
    // Two rings around (±1, 0, 0) that touch and are fattened until they merge.
    let double_torus = "((x^2*(1 - x^2) - y^2)^2 + z^2 - 0.01)";
    for (text, half, cells, characteristic) in [
        ("x^2 + y^2 + z^2 = 1", 1.5, 24, 2),
        // Nodes of the lattice lie on the surface.
        ("x^2 + y^2 + z^2 = 1", 2.0, 32, 2),
        ("abs(x) + abs(y) + abs(z) = 1", 1.5, 24, 2),
        ("max(abs(x), abs(y), abs(z)) = 1", 1.5, 24, 2),
        (torus, 2.0, 40, 0),
        (double_torus, 1.25, 60, -2),
        (
            "min((x-1)^2 + y^2 + z^2, (x+1)^2 + y^2 + z^2) = 0.5",
            2.0,
            31,
            4,
        ),
        // A sphere in a sphere, and one of a single cell.
        ("(x^2 + y^2 + z^2 - 1)*(x^2 + y^2 + z^2 - 2)", 2.0, 33, 4),
        ("x^2 + y^2 + z^2 = 0.01", 2.0, 32, 2),
    ] {
        let ImplicitSurface {
            mesh,
            interruptions,
        } = meshed(text, half, cells);
        let found = topology(&mesh);
        assert_eq!(found.border, [[0; 2]; 0], "{text}");
        assert_eq!(
            (found.euler_characteristic, interruptions),
            (characteristic, 0),
            "{text}"
        );
    }
    let sphere = meshed("x^2 + y^2 + z^2 = 1", 2.0, 48).mesh;
    for (position, normal) in sphere.positions.iter().zip(&sphere.normals) {
        assert!(
            (position.length() - 1.0).abs() < 1e-3 * 4.0 / 48.0,
            "{position}"
        );
        assert!(
            position.normalize().distance(*normal) < 1e-6,
            "{position} {normal}"
        );
    }
    let (area, volume) = area_and_volume(&sphere);
    assert!((area / (4.0 * PI) - 1.0).abs() < 4e-3, "{area}");
    assert!((volume / (4.0 / 3.0 * PI) - 1.0).abs() < 4e-3, "{volume}");
}

fn area_and_volume(mesh: &ShapeMesh) -> (f64, f64) {
    let at = |corner: u32| mesh.positions[corner as usize].as_dvec3();
    let triangles = mesh.triangles.iter().map(|triangle| triangle.map(at));
    triangles.fold((0.0, 0.0), |(area, volume), [a, b, c]| {
        (
            area + 0.5 * (b - a).cross(c - a).length(),
            volume + a.dot(b.cross(c)) / 6.0,
        )
    })
}

/// A random function that is defined and continuous everywhere.
fn continuous(random: &mut Rng) -> String {
    let kind = random.u32(..5);
    let mut number = |scale: f64| format!("({:.3})", (random.f64() * 2.0 - 1.0) * scale);
    let axis = |i: usize| XYZ[i % 3];
    match kind {
        0 => {
            // Waves.
            let wave =
                |i: usize, n: [String; 3]| format!("{}*sin({}*{} + {})", n[0], n[1], axis(i), n[2]);
            let waves = (0..6).map(|i| wave(i, [number(1.0), number(6.0), number(3.0)]));
            waves.collect::<Vec<_>>().join(" + ") + " + " + &number(0.5)
        }
        1 => {
            // Balls that melt together.
            let ball = |[a, b, c]: [String; 3]| {
                format!("exp(-4*((x - {a})^2 + (y - {b})^2 + (z - {c})^2))")
            };
            let balls = (0..5).map(|_| ball([number(1.2), number(1.2), number(1.2)]));
            "0.4 - ".to_owned() + &balls.collect::<Vec<_>>().join(" - ")
        }
        2 => {
            // Solids cut from each other.
            let ball = |[a, b, c]: [String; 3]| {
                format!("sqrt((x - {a})^2 + (y - {b})^2 + (z - {c})^2) - 0.7")
            };
            let mut ball = || ball([number(1.0), number(1.0), number(1.0)]);
            let (a, b, c) = (ball(), ball(), ball());
            let boxed = format!(
                "max(abs(x) - 1, abs(y) - 0.8, abs(z - {}) - 0.9)",
                number(0.5)
            );
            format!("max(min({a}, {boxed}), -({b}), -({c}))")
        }
        3 => {
            // A cubic polynomial.
            let mut terms = Vec::new();
            for power in [
                "300", "030", "003", "111", "210", "012", "100", "001", "000",
            ] {
                let [i, j, k] = [0, 1, 2].map(|at| &power[at..=at]);
                terms.push(format!("{}*x^{i}*y^{j}*z^{k}", number(1.0)));
            }
            terms.join(" + ")
        }
        _ => {
            // A triply periodic surface with facets: many values are exactly zero or equal.
            let level = number(0.6);
            let wave = |axis: &str| format!("abs({axis} - floor({axis} + 0.5))");
            format!(
                "{} + {} - {} - {level}*0.5",
                wave("x"),
                wave("y"),
                wave("z")
            )
        }
    }
}

/// Rows: M5.
#[test]
fn random_surfaces_are_closed_manifolds_but_for_the_box() {
    const HALF: f32 = 1.5;
    let mut random = Rng::with_seed(11);
    let (mut closed, mut on_box, mut empty, mut triangles) = (0, 0, 0, 0);
    for case in 0..240 {
        let text = continuous(&mut random);
        let cells = random.u32(4..13);
        let ImplicitSurface {
            mesh,
            interruptions,
        } = meshed(&text, f64::from(HALF), cells);
        let found = topology(&mesh);
        assert_eq!(interruptions, 0, "{case}: {text}");
        assert_eq!(inner_border(&mesh, &found, HALF), 0, "{case}: {text}");
        let expression = Expression::parse(&text, XYZ).unwrap();
        let value = |p: DVec3| expression.value(&p.to_array());
        let share = share_at_roots(&mesh, 3.0 / f64::from(cells), value);
        assert!(
            share > 0.999 || mesh.triangles.is_empty(),
            "{case}: {share} {text}"
        );
        match (mesh.triangles.len(), found.border.len()) {
            (0, _) => empty += 1,
            (_, 0) => closed += 1,
            _ => on_box += 1,
        }
        triangles += mesh.triangles.len();
    }
    assert!(
        closed > 20 && on_box > 100 && empty < 40,
        "{closed} {on_box} {empty}"
    );
    assert!(triangles > 100_000, "{triangles}");
}

/// A random function with jumps, poles, and regions where it is not defined.
fn broken(random: &mut Rng) -> String {
    let whole = continuous(random);
    let number = format!("{:.2}", random.f64() - 0.5);
    match random.u32(..5) {
        0 => format!("({whole}) + floor(x*2 + {number})"),
        1 => format!("({whole})/(y - {number})"),
        2 => format!("({whole}) + 0*sqrt(z + x - {number})"),
        3 => format!("sign({whole})*max(0.2, z)"),
        _ => format!("({whole})*ln(1.5 - x^2 - y^2) + 1/(z*3)"),
    }
}

/// Rows: M5.
#[test]
fn jumps_and_undefined_regions_leave_a_border_and_no_false_wall() {
    const HALF: f32 = 1.5;
    let mut random = Rng::with_seed(5);
    let (mut interrupted, mut triangles) = (0, 0);
    for case in 0..200 {
        let text = broken(&mut random);
        let cells = random.u32(4..12);
        let ImplicitSurface {
            mesh,
            interruptions,
        } = meshed(&text, f64::from(HALF), cells);
        let found = topology(&mesh);
        let open = inner_border(&mesh, &found, HALF);
        assert!(open == 0 || interruptions > 0, "{case}: {text}");
        let expression = Expression::parse(&text, XYZ).unwrap();
        let value = |p: DVec3| expression.value(&p.to_array());
        let share = share_at_roots(&mesh, 3.0 / f64::from(cells), value);
        assert!(
            share == 1.0 || mesh.triangles.is_empty(),
            "{case}: {share} {text}"
        );
        interrupted += usize::from(open > 0);
        triangles += mesh.triangles.len();
    }
    assert!(
        interrupted > 60 && triangles > 50_000,
        "{interrupted} {triangles}"
    );
    // A jump or a pole alone has no root at all.
    for text in [
        "sign(x)",
        "1/x",
        "floor(x) + 0.5",
        "1/(x^2 + y^2 - 1)",
        "0/0",
        "1",
        "-1",
    ] {
        assert!(meshed(text, 1.5, 9).mesh.triangles.is_empty(), "{text}");
    }
    assert!(meshed("1/x", 1.5, 9).interruptions > 0);
    // Half of a sphere ends where the function does.
    let half = meshed("x^2 + y^2 + z^2 - 1 + 0*sqrt(z)", 1.5, 30);
    let lowest = half
        .mesh
        .positions
        .iter()
        .map(|p| p.z)
        .fold(f32::MAX, f32::min);
    assert!(
        half.interruptions > 0 && (0.0..0.1).contains(&lowest),
        "{lowest}"
    );
    assert_eq!(topology(&half.mesh).euler_characteristic, 1);
}

/// Rows: M5.
#[test]
fn curves_are_closed_or_end_on_the_box() {
    let mut random = Rng::with_seed(2);
    let bounds = [-1.5..1.5, -1.5..1.5];
    let (mut closed, mut open) = (0, 0);
    for case in 0..300 {
        let text = continuous(&mut random).replace('z', "0.3");
        let expression = Expression::parse(&text, XYZ).unwrap();
        let value = |p: DVec2| expression.value(&[p.x, p.y]);
        let cells = random.u32(5..80);
        let ImplicitCurve {
            curve,
            interruptions,
        } = curve(&bounds, [cells; 2], value).unwrap();
        assert_eq!(interruptions, 0, "{case}");
        let mut used: HashMap<[u64; 2], u32> = HashMap::new();
        for strand in &curve.strands {
            for point in &strand.points {
                *used
                    .entry([point.x, point.y].map(f64::to_bits))
                    .or_insert(0) += 1;
            }
            let ends = [strand.points[0], strand.points[strand.points.len() - 1]];
            let is_on_box = |p: &DVec3| p.x.abs() == 1.5 || p.y.abs() == 1.5;
            assert!(
                strand.is_closed || ends.iter().all(is_on_box),
                "{case}: {text}"
            );
            *(if strand.is_closed {
                &mut closed
            } else {
                &mut open
            }) += 1;
            // The inside is on the left.
            let (near, mut wrong) = (3e-3 * 3.0 / f64::from(cells), 0);
            for pair in strand.points.windows(2) {
                let [a, b] = [pair[0], pair[1]].map(|p| p.truncate());
                let left = (b - a).perp().normalize() * near;
                let is_at = |p: DVec2| value(p + left * 2.0) < 0.0 && value(p - left * 2.0) >= 0.0;
                wrong += usize::from(!(is_at(a) || is_at(b)));
            }
            assert!(
                wrong * 20 <= strand.points.len() + 20,
                "{case}: {wrong} {text}"
            );
        }
        assert!(
            used.values().all(|count| *count == 1),
            "{case}: a point is used twice"
        );
    }
    assert!(closed > 100 && open > 300, "{closed} {open}");

    let circle = |cells| {
        let circle = curve(&[-2.0..2.0, -2.0..2.0], [cells; 2], |p| {
            p.length_squared() - 1.0
        });
        circle.unwrap().curve
    };
    let [strand] = &circle(64).strands[..] else {
        panic!("a circle is one polyline");
    };
    assert!(
        strand.is_closed
            && strand
                .points
                .iter()
                .all(|p| (p.length() - 1.0).abs() < 1e-4)
    );
    assert!((circle(64).length() / (2.0 * PI) - 1.0).abs() < 1e-3);
    let hyperbola = curve(&bounds, [20, 30], |p| p.x - 1.0 / p.y).unwrap();
    assert_eq!(hyperbola.curve.strands.len(), 2, "no line at the pole");
    assert!(hyperbola.interruptions > 0);
}

#[test]
fn impossible_boxes_are_errors() {
    let sphere = |bounds: [Range<f64>; 3], cells| {
        surface(&bounds, cells, |p| p.length_squared() - 1.0, |p| p * 2.0)
    };
    let unit = || -1.5..1.5;
    for bad in [0.0..0.0, f64::NAN..1.0, 0.0..f64::INFINITY, -1e300..1e300] {
        let error = sphere([unit(), bad, unit()], [4; 3]).unwrap_err();
        assert_eq!(error, ImplicitError::Bounds { axis: 1 });
        assert!(error.to_string().contains("range of y"), "{error}");
    }
    let far = sphere([unit(), unit(), 1e6..1e6 + 1.0], [4; 3]).unwrap_err();
    assert!(
        matches!(far, ImplicitError::TooFine { axis: 2, .. }),
        "{far}"
    );
    // A box that runs backwards is the same box, and odd numbers of cells are clamped.
    let there = sphere([unit(), unit(), unit()], [8, 9, 10]).unwrap();
    let back = sphere([1.5..-1.5, unit(), 1.5..-1.5], [8, 9, 10]).unwrap();
    assert_eq!(there, back);
    assert!(sphere([unit(), unit(), unit()], [0; 3]).is_ok());
    let far_away = sphere([1000.0..1003.0, unit(), unit()], [8; 3]).unwrap();
    assert!(far_away.mesh.triangles.is_empty());
    let ball = |most: usize| {
        let bounds = [unit(), unit(), unit()];
        surface_up_to(
            most,
            &bounds,
            [8; 3],
            |p| p.length_squared() - 1.0,
            |p| p * 2.0,
        )
    };
    let count = ball(MAX_ELEMENTS).unwrap().mesh.triangles.len();
    assert!(ball(count).is_ok());
    assert_eq!(ball(count - 1), Err(ImplicitError::TooManyElements));
}

/// The mesh has the same bits on every machine.
#[test]
fn bits_are_fixed() {
    let mesh = meshed("sin(x)*cos(y) + sin(y)*cos(z) + sin(z)*cos(x)", PI, 12).mesh;
    let vectors = mesh.positions.iter().chain(&mesh.normals);
    let words = vectors.flat_map(|v| v.to_array()).map(f32::to_bits);
    let words = words.chain(mesh.triangles.as_flattened().iter().copied());
    let hash = words.fold(0xCBF2_9CE4_8422_2325_u64, |hash, word| {
        (hash ^ u64::from(word)).wrapping_mul(0x0100_0000_01B3)
    });
    assert_eq!(hash, 0xFD45_C3C3_B1F8_D0BC, "{hash:#X}");
}
