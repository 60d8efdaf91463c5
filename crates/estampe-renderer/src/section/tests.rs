//! Sections of meshes whose cross-sections are known.

use super::{SectionPlane, clip, half_spaces};
use crate::options::RenderOptions;
use crate::render_error::RenderError;
use estampe_scene::{Mesh, Scene, UpAxis, Workers};
use glam::{DVec3, Vec3};

/// The corners and outward triangles of a box.
fn block(low: Vec3, high: Vec3) -> Mesh {
    let corner = |k: usize| {
        let pick = |bit: usize, axis: usize| {
            if k >> bit & 1 == 1 {
                high[axis]
            } else {
                low[axis]
            }
        };
        Vec3::new(pick(0, 0), pick(1, 1), pick(2, 2))
    };
    let quads = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    Mesh {
        positions: (0..8).map(corner).collect(),
        triangles: quads
            .iter()
            .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
            .collect(),
        ..Mesh::default()
    }
}

fn joined(mut a: Mesh, b: &Mesh) -> Mesh {
    let first = u32::try_from(a.positions.len()).expect("few");
    a.positions.extend(&b.positions);
    let moved = b.triangles.iter().map(|t| t.map(|corner| corner + first));
    a.triangles.extend(moved);
    a
}

fn inside_out(mut mesh: Mesh) -> Mesh {
    for triangle in &mut mesh.triangles {
        triangle.swap(1, 2);
    }
    mesh
}

/// A mesh with three vertices for each triangle, as in STL files.
fn soup(mesh: &Mesh) -> Mesh {
    let corners = mesh.triangles.iter().flatten();
    let count = u32::try_from(mesh.triangles.len()).expect("few");
    Mesh {
        positions: corners
            .map(|&corner| mesh.positions[corner as usize])
            .collect(),
        triangles: (0..count).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect(),
        ..Mesh::default()
    }
}

fn unit_box() -> Mesh {
    block(Vec3::splat(-1.0), Vec3::ONE)
}

fn plane(normal_world: DVec3, offset_world: Option<f64>) -> SectionPlane {
    SectionPlane {
        normal_world,
        offset_world,
    }
}

/// The scene of a mesh, cut.
fn cut(mesh: &Mesh, planes: &[SectionPlane]) -> Scene {
    let mut options = RenderOptions::default();
    options.section.planes = planes.to_vec();
    let scene = Scene {
        meshes: vec![mesh.clone()],
        ..Scene::default()
    };
    let cut = options.cut(&scene, Workers::new(1)).expect("not empty");
    cut.expect("there are planes").scene
}

/// The area of a mesh, as a vector: the sum of its triangles' normals times their areas.
fn vector_area(mesh: &Mesh) -> DVec3 {
    let area = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|corner| mesh.positions[corner as usize].as_dvec3());
        (b - a).cross(c - a) / 2.0
    };
    mesh.triangles.iter().map(area).sum()
}

/// The area of the caps, which face in the plane's direction.
fn cap_area(mesh: &Mesh, planes: &[SectionPlane]) -> f64 {
    let cut = cut(mesh, planes);
    cut.meshes[1..]
        .iter()
        .map(|cap| vector_area(cap).length())
        .sum()
}

#[track_caller]
fn assert_near(value: f64, expected: f64) {
    assert!(
        (value - expected).abs() < 1e-5 * expected.abs().max(1.0),
        "{value}, not {expected}"
    );
}

#[test]
fn a_cut_box_has_caps_of_its_cross_section() {
    for mesh in [unit_box(), soup(&unit_box()), inside_out(unit_box())] {
        assert_near(cap_area(&mesh, &[plane(DVec3::X, None)]), 4.0);
        assert_near(cap_area(&mesh, &[plane(DVec3::Y * -7.0, Some(2.0))]), 4.0);
        // Along a diagonal of two sides: a rectangle of 2 by 2√2.
        let diagonal = plane(DVec3::new(1.0, 1.0, 0.0), None);
        assert_near(cap_area(&mesh, &[diagonal]), 32_f64.sqrt());
        // Through the middles of six edges: a hexagon of sides √2.
        let hexagon = plane(DVec3::ONE, Some(0.0));
        assert_near(cap_area(&mesh, &[hexagon]), 27_f64.sqrt());
        // Three planes leave an eighth away: each cap is a square.
        let planes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| plane(axis, None));
        let cut = cut(&mesh, &planes);
        assert_eq!(cut.meshes.len(), 2);
        assert_near(vector_area(&cut.meshes[1]).dot(DVec3::ONE), 3.0);
    }
}

/// The vector area of a closed surface is zero, so that of the cut mesh with its caps is.
#[test]
fn caps_close_what_is_cut_exactly() {
    let mut torus = torus_of_quads();
    torus.normals.clear();
    for normal in [
        DVec3::X,
        DVec3::new(0.3, -0.8, 0.5),
        DVec3::new(0.0, 1.0, 0.001),
    ] {
        for offset in [-0.31, 0.0, 0.22] {
            let cut = cut(&torus, &[plane(normal, Some(offset))]);
            let [model, cap] = &cut.meshes[..] else {
                panic!("a mesh and its cap");
            };
            let sum = vector_area(model) + vector_area(cap);
            assert!(sum.length() < 1e-5, "{normal} {offset}: {sum}");
            assert!(vector_area(cap).dot(normal) > 0.1);
            // The border's points are those of the cut mesh, bit by bit.
            for position in &cap.positions {
                assert!(model.positions.contains(position), "{position}");
            }
        }
    }
}

/// A torus whose ring lies in the plane z = 0, of radii 1 and 0.4.
fn torus_of_quads() -> Mesh {
    let (around, across) = (24_u16, 12_u16);
    let at = |i: u16, j: u16| {
        let turn = |k: u16, n: u16| f64::from(k % n) / f64::from(n) * std::f64::consts::TAU;
        let (a, b) = (turn(i, around), turn(j, across));
        let radius = 1.0 + 0.4 * libm::cos(b);
        DVec3::new(
            radius * libm::cos(a),
            radius * libm::sin(a),
            0.4 * libm::sin(b),
        )
        .as_vec3()
    };
    let number = |i: u16, j: u16| u32::from(i % around) * u32::from(across) + u32::from(j % across);
    let cells = (0..around).flat_map(|i| (0..across).map(move |j| (i, j)));
    Mesh {
        positions: cells.clone().map(|(i, j)| at(i, j)).collect(),
        triangles: cells
            .flat_map(|(i, j)| {
                let [a, b] = [number(i, j), number(i + 1, j)];
                let [c, d] = [number(i + 1, j + 1), number(i, j + 1)];
                [[a, b, c], [a, c, d]]
            })
            .collect(),
        ..Mesh::default()
    }
}

#[test]
fn cavities_are_hollow_and_overlaps_are_solid() {
    let outer = unit_box();
    let small = block(Vec3::splat(-0.5), Vec3::splat(0.5));
    let hollow = joined(outer.clone(), &inside_out(small.clone()));
    assert_near(cap_area(&hollow, &[plane(DVec3::X, None)]), 3.0);
    let overlap = joined(outer, &block(Vec3::splat(-0.5), Vec3::new(0.5, 0.5, 1.5)));
    assert_near(cap_area(&overlap, &[plane(DVec3::X, Some(0.0))]), 4.5);
}

#[test]
fn triangles_with_different_outsides_are_solid_by_parity() {
    let mut mesh = joined(unit_box(), &block(Vec3::splat(-0.5), Vec3::splat(0.5)));
    for triangle in mesh.triangles.iter_mut().step_by(3) {
        triangle.swap(0, 1);
    }
    assert_near(cap_area(&mesh, &[plane(DVec3::X, None)]), 3.0);
}

#[test]
fn open_meshes_have_no_caps_and_small_gaps_are_closed() {
    let mut open = unit_box();
    open.triangles.truncate(10);
    let cut_open = cut(&open, &[plane(DVec3::X, None)]);
    assert_eq!(cut_open.meshes.len(), 1, "no cap");
    // Two sides meet with a gap.
    let mut gap = soup(&unit_box());
    for position in &mut gap.positions[..6] {
        position.z += 1e-5;
    }
    assert_near(cap_area(&gap, &[plane(DVec3::Y, None)]), 4.0);
}

#[test]
fn planes_are_in_world_space() {
    let scene = Scene {
        meshes: vec![unit_box()],
        up: UpAxis::Z,
        ..Scene::default()
    };
    let mut options = RenderOptions::default();
    options.section.planes = vec![plane(DVec3::Y, Some(0.25)), plane(DVec3::ZERO, None)];
    let planes = half_spaces(&options, &scene);
    assert_eq!(planes.len(), 1, "a plane without direction cuts nothing");
    // (x, y, z) → (x, z, −y): up in the world is the file's z.
    assert!((planes[0].normal - DVec3::Z).length() < 1e-12);
    options.section.planes = vec![plane(DVec3::Y, Some(-5.0))];
    let empty = options.cut(&scene, Workers::new(1));
    assert_eq!(empty.map(|_| ()), Err(RenderError::EmptySection));
}

#[test]
fn attributes_are_interpolated_and_invalid_triangles_left_out() {
    let mesh = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X * 4.0, Vec3::Y, Vec3::NAN],
        uvs: vec![
            glam::Vec2::ZERO,
            glam::Vec2::X,
            glam::Vec2::Y,
            glam::Vec2::ZERO,
        ],
        colors: vec![[0.0; 4], [1.0; 4], [0.0; 4], [0.0; 4]],
        triangles: vec![[0, 1, 2], [0, 1, 3], [0, 1, 9]],
        lines: vec![[0, 1], [1, 0], [1, 9]],
        points: vec![0, 1, 3],
        ..Mesh::default()
    };
    let mut options = RenderOptions::default();
    options.section.planes = vec![plane(DVec3::X, Some(1.0))];
    let scene = Scene {
        meshes: vec![mesh.clone()],
        ..Scene::default()
    };
    let planes = half_spaces(&options, &scene);
    let cut = clip::clip(&mesh, &planes[0]);
    assert_eq!(cut.triangles, [[0, 4, 5], [0, 5, 2]]);
    assert_eq!(cut.lines, [[0, 4], [4, 0]]);
    assert_eq!(cut.points, [0]);
    assert_eq!(cut.positions[4], Vec3::X);
    assert_eq!(cut.uvs[4], glam::Vec2::X * 0.25);
    assert_eq!(cut.colors[4], [0.25; 4]);
    assert_eq!(cut.positions[5], Vec3::new(1.0, 0.75, 0.0));
}
