use std::f64::consts::PI;

use glam::{DVec3, Vec3};

use super::*;
use crate::curve::Curve;
use crate::expression::Dual;
use crate::expression::Expression;
use crate::mesh::ShapeMesh;
use crate::random_cases::random_cases;
use crate::topology::topology;

fn plotted(text: &str, x: Range<f64>, values: Option<&Range<f64>>, steps: u32) -> Curve {
    let expression = Expression::parse(text, &["x"]).unwrap_or_else(|error| panic!("{error}"));
    curve(&x, values, steps, |x| expression.dual([x]))
}

fn surface_of(text: &str, range: Range<f64>, values: Option<&Range<f64>>, cells: u32) -> ShapeMesh {
    let expression = Expression::parse(text, &["x", "y"]).unwrap_or_else(|error| panic!("{error}"));
    surface([range.clone(), range], values, [cells; 2], |x, y| {
        expression.dual([x, y])
    })
}

/// First and last point of each polyline.
fn ends(curve: &Curve) -> Vec<[DVec3; 2]> {
    let strands = curve.strands.iter();
    strands
        .map(|s| [s.points[0], s.points[s.points.len() - 1]])
        .collect()
}

/// Rows: M3.
#[test]
fn curves_are_the_functions_graph() {
    let line = plotted("sin(x)", 0.0..2.0 * PI, None, 64);
    let [strand] = &line.strands[..] else {
        panic!("one polyline");
    };
    assert_eq!(strand.points.len(), 65);
    assert!(!strand.is_closed);
    for point in &strand.points {
        assert_eq!((point.y, point.z), (libm::sin(point.x), 0.0));
    }
    // The length of a parabola from 0 to 1 is √5/2 + asinh(2)/4.
    let length = plotted("x^2", 0.0..1.0, None, 1000).length();
    assert!((length - 1.478_942_857_5).abs() < 1e-6, "{length}");
    assert_eq!(
        plotted("x", 3.0..-3.0, None, 6).strands[0].points[0],
        DVec3::new(3.0, 3.0, 0.0)
    );
    assert!(plotted("0/0", 0.0..1.0, None, 9).strands.is_empty());
}

/// Rows: M3.
#[test]
fn curves_are_interrupted_where_functions_are() {
    // Jumps: the pieces reach up to them.
    for steps in [7, 10, 64, 101] {
        let steps_of_floor = plotted("floor(x)", -1.5..1.5, None, steps);
        let found = ends(&steps_of_floor);
        assert_eq!(found.len(), 4, "{steps}");
        for ([from, to], (x, y)) in
            found
                .iter()
                .zip([(-1.5, -2.0), (-1.0, -1.0), (0.0, 0.0), (1.0, 1.0)])
        {
            assert!(
                (from.x - x).abs() < 1e-12 && from.y == y && to.y == y,
                "{from} {to}"
            );
            assert!(
                (to.x - (x + 1.0).min(1.5)).abs() < 1e-12 || x == -1.5,
                "{from} {to}"
            );
        }
        // A pole: two pieces, which end at the samples beside it.
        let pole = plotted("1/(x - 0.1)", -1.0..1.0, None, steps);
        assert_eq!(pole.strands.len(), 2, "{steps}");
        // The ends of a domain.
        let root = ends(&plotted("sqrt(1 - x^2)", -2.0..2.0, None, steps));
        let [[from, to]] = root[..] else {
            panic!("{root:?}");
        };
        assert!(
            (from.x + 1.0).abs() < 1e-12 && (to.x - 1.0).abs() < 1e-12,
            "{from} {to}"
        );
        assert!(from.y < 1e-6 && to.y < 1e-6, "{from} {to}");
    }
    assert_eq!(plotted("tan(x)", -5.0..5.0, None, 200).strands.len(), 5);
    // Steep is not broken: each of these is one piece.
    for whole in [
        "tanh(1000*x)",
        "abs(x)^0.3",
        "sqrt(abs(x))",
        "exp(-1/x^2)",
        "x^9",
        "abs(x)",
        "sin(30*x)",
    ] {
        let curve = plotted(whole, -1.05..1.0, None, 41);
        assert_eq!(curve.strands.len(), 1, "{whole}");
    }
    // Beyond 1e30 a function counts as undefined.
    assert!(
        plotted("exp(x)", 0.0..1000.0, None, 100)
            .bounds()
            .unwrap()
            .1
            .y
            <= 1e30
    );
}

/// Rows: M3.
#[test]
fn curves_end_one_sample_before_a_pole() {
    let nearest = |text: &str, pieces: usize, x: Range<f64>, steps: u32| {
        let found = ends(&plotted(text, x, None, steps));
        assert_eq!(found.len(), pieces, "{text}");
        let distances = found.iter().flatten().map(|p| p.x.abs());
        distances.fold(f64::MAX, f64::min)
    };
    for steps in [10, 100, 1000] {
        let step = 10.0 / f64::from(steps);
        for (text, pieces) in [("1/x", 2), ("1/x^2", 2), ("ln(x)", 1), ("x^-0.5", 1)] {
            // The pole is a sample, or a third of a step away from one.
            let at = nearest(text, pieces, -5.0..5.0, steps);
            assert!((at - step).abs() < 1e-9, "{text} {at}");
            let near = -5.0 - step / 3.0..5.0 - step / 3.0;
            let at = nearest(text, pieces, near, steps);
            assert!(at >= step * 0.33, "{text} {at}");
        }
        // Functions that tend to a point reach it, however steep.
        for text in ["sqrt(x)", "x^0.2", "x*ln(x)", "sin(x)/sqrt(x)"] {
            for offset in [0.0, 1.0 / 3.0] {
                let moved = -5.0 - step * offset..5.0 - step * offset;
                let at = nearest(text, 1, moved, steps);
                assert!(at < step * 1e-9, "{text} {at}");
            }
        }
    }
}

/// Rows: M3.
#[test]
fn a_range_of_values_cuts_curves_at_its_limits() {
    for steps in [20, 33, 500] {
        let cut = plotted("1/x", -4.0..4.0, Some(&(-2.0..3.0)), steps);
        let found = ends(&cut);
        let [[_, low], [high, _]] = found[..] else {
            panic!("{found:?}");
        };
        assert_eq!((low.y, high.y), (-2.0, 3.0));
        assert!(
            (low.x + 0.5).abs() < 1e-9 && (high.x - 1.0 / 3.0).abs() < 1e-9,
            "{low} {high}"
        );
    }
    // Poles at odd places and many resolutions: no vertical lines through them.
    for steps in 90..200 {
        let tangent = plotted("tan(x)", -5.0..5.0, Some(&(-3.0..3.0)), steps);
        assert_eq!(tangent.strands.len(), 3, "{steps}");
        let backwards = plotted("tan(x)", 5.0..-5.0, Some(&(-3.0..3.0)), steps);
        assert_eq!(backwards.strands.len(), 3, "{steps}");
        for text in ["1/(x^3 - x/7)", "1/((x + 0.7)*(x - 0.3))"] {
            let poles = plotted(text, -2.0..2.0, Some(&(-30.0..30.0)), steps);
            for pair in poles
                .strands
                .iter()
                .flat_map(|strand| strand.points.windows(2))
            {
                assert!(
                    pair[0].y * pair[1].y > -1.0,
                    "{text} {steps}: {} {}",
                    pair[0],
                    pair[1]
                );
            }
        }
    }
    // A step over the whole range gives both ends; a range that runs backwards is the same range.
    for values in [-0.25..0.25, 0.25..-0.25] {
        let steep = ends(&plotted("x", -1.0..1.0, Some(&values), 1));
        assert_eq!(steep.len(), 1);
        assert_eq!(steep[0].map(|p| p.y), [-0.25, 0.25]);
    }
    assert!(
        plotted("x + 9", -1.0..1.0, Some(&(-0.25..0.25)), 9)
            .strands
            .is_empty()
    );
}

/// Rows: M3.
#[test]
fn surfaces_have_the_functions_heights_and_normals() {
    let mesh = surface_of("sin(x)*cos(2*y)", -3.0..3.0, None, 20);
    assert_eq!((mesh.positions.len(), mesh.triangles.len()), (21 * 21, 800));
    assert_eq!(topology(&mesh).euler_characteristic, 1);
    for ((p, n), uv) in mesh.positions.iter().zip(&mesh.normals).zip(&mesh.uvs) {
        let [x, y, z] = p.to_array().map(f64::from);
        assert!((z - libm::sin(x) * libm::cos(2.0 * y)).abs() < 1e-6);
        let (by_x, by_y) = (
            libm::cos(x) * libm::cos(2.0 * y),
            -2.0 * libm::sin(x) * libm::sin(2.0 * y),
        );
        let normal = DVec3::new(-by_x, -by_y, 1.0).normalize();
        assert!(n.as_dvec3().distance(normal) < 1e-6, "{n} {normal}");
        assert!((uv.x - (p.x + 3.0) / 6.0).abs() < 1e-6 && (uv.y - (3.0 - p.y) / 6.0).abs() < 1e-6);
    }
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
        assert!((b - a).cross(c - a).z > 0.0, "counter-clockwise from above");
    }
}

/// Rows: M3.
#[test]
fn surfaces_are_cut_where_functions_end_or_jump() {
    // A half sphere above a disc: the rim is at the disc's edge, to the last bits.
    let dome = surface_of("sqrt(1 - x^2 - y^2)", -1.5..1.5, None, 30);
    let found = topology(&dome);
    assert_eq!(found.euler_characteristic, 1);
    for &[a, _] in &found.border {
        let p = dome.positions[a as usize];
        assert!(
            (p.with_z(0.0).length() - 1.0).abs() < 1e-6 && p.z < 1e-3,
            "{p}"
        );
    }
    for (p, n) in dome.positions.iter().zip(&dome.normals) {
        assert!(p.distance(*n) < 1e-3, "{p} {n}");
    }
    // A step: no triangle joins the two heights.
    let step = surface_of("floor(x)", -1.05..1.0, None, 13);
    let heights = |triangle: &[u32; 3]| triangle.map(|i| step.positions[i as usize].z);
    assert!(
        step.triangles
            .iter()
            .map(heights)
            .all(|[a, b, c]| a == b && b == c)
    );
    assert_eq!(step.triangles.len(), 2 * 13 * (13 - 3));
    // A steep but continuous one is whole.
    assert_eq!(
        surface_of("tanh(100*x)", -1.05..1.0, None, 13)
            .triangles
            .len(),
        2 * 13 * 13
    );
    // A range of heights.
    let cut = surface_of("x*y", -2.0..2.0, Some(&(-1.0..1.5)), 17);
    let z = || cut.positions.iter().map(|p| p.z);
    assert_eq!(
        (z().fold(f32::MAX, f32::min), z().fold(f32::MIN, f32::max)),
        (-1.0, 1.5)
    );
    for &[a, b] in &topology(&cut).border {
        let [a, b] = [a, b].map(|i| cut.positions[i as usize]);
        let is_limit = a.z == b.z && (a.z == -1.0 || a.z == 1.5);
        let is_side = (a.x == b.x && a.x.abs() == 2.0) || (a.y == b.y && a.y.abs() == 2.0);
        assert!(is_limit || is_side, "{a} {b}");
    }
    for p in &cut.positions {
        assert!(
            (p.x * p.y - p.z).abs() < 1e-5,
            "vertices at the cut are on the surface: {p}"
        );
    }
    // Without a range, the cells at a pole are left out.
    let pole = surface_of("1/(x^2 + y^2)", -1.0..1.0, None, 16);
    assert!(pole.positions.iter().all(|p| p.z <= 64.0));
    assert_eq!(
        topology(&pole).euler_characteristic,
        0,
        "a disc with a hole"
    );
    let poles = surface_of("1/(x^2 + y^2)", -1.0..1.0, Some(&(0.0..4.0)), 16);
    assert_eq!(
        topology(&poles).euler_characteristic,
        0,
        "a disc with a hole"
    );
}

/// Functions of arbitrary bits: no panic, finite vertices, indices in range.
#[test]
fn hostile_functions() {
    random_cases(|random| {
        let bits = [0; 4].map(|_| random.u64(..));
        let snap = random.bool();
        let number = |x: f64, y: f64| {
            let mixed = x.to_bits().wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ y.to_bits() ^ bits[0];
            let mixed = mixed.rotate_left(27).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            if snap {
                f64::from((mixed >> 60) as u8)
            } else {
                f64::from_bits(mixed)
            }
        };
        let dual = |x: f64, y: f64| Dual {
            value: number(x, y),
            partials: [number(y, x), f64::from_bits(bits[1])],
        };
        let range = || f64::from_bits(bits[2])..f64::from_bits(bits[3]);
        let ranges = if random.bool() {
            [range(), range()]
        } else {
            [-1.0..1.0, 0.0..2.0]
        };
        let values = random.bool().then_some(0.0..1.0);
        let cells = [random.u32(..12), random.u32(..12)];
        let mesh = surface(ranges.clone(), values.as_ref(), cells, dual);
        assert!(
            mesh.positions
                .iter()
                .chain(&mesh.normals)
                .all(|p: &Vec3| p.is_finite())
        );
        let count = mesh.positions.len();
        assert!(
            mesh.triangles
                .as_flattened()
                .iter()
                .all(|&i| (i as usize) < count)
        );
        let [x, _] = ranges;
        let line = curve(&x, values.as_ref(), cells[0], |x| Dual {
            value: number(x, 0.0),
            partials: [number(0.0, x)],
        });
        assert!(line.strands.iter().all(|s| s.points.len() > 1));
        assert!(
            line.strands
                .iter()
                .flat_map(|s| &s.points)
                .all(|p| p.is_finite())
        );
    });
}
