//! Computation of missing normals.

use crate::model::normals::{self, NormalMode, Positions};
use crate::model::weld::{first_equals, key};
use estampe_scene::{Mesh, Workers};
use glam::Vec3;

fn cube() -> Mesh {
    let positions = (0..8_u8).map(|i| {
        let bit = |shift: u8| f32::from(i >> shift & 1);
        Vec3::new(bit(0), bit(1), bit(2))
    });
    let quads: [[u32; 4]; 6] = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = quads
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    Mesh {
        positions: positions.collect(),
        triangles: triangles.collect(),
        ..Mesh::default()
    }
}

/// A tube around the z axis with `sides` flat sides, open at both ends.
fn tube(sides: u32) -> Mesh {
    let positions = (0..sides * 2).map(|i| {
        let angle = (i / 2) as f32 / sides as f32 * std::f32::consts::TAU;
        Vec3::new(libm::cosf(angle), libm::sinf(angle), (i % 2) as f32)
    });
    let triangles = (0..sides).flat_map(|i| {
        let [a, b] = [i * 2, (i + 1) % sides * 2];
        [[a, b, a + 1], [b, b + 1, a + 1]]
    });
    Mesh {
        positions: positions.collect(),
        triangles: triangles.collect(),
        ..Mesh::default()
    }
}

fn face_normal(mesh: &Mesh, triangle: [u32; 3]) -> Vec3 {
    let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex as usize]);
    (b - a).cross(c - a).normalize()
}

/// Meshes whose positions are distinct get the same normals without a search.
#[test]
fn distinct_positions_need_no_search() {
    for mesh in [cube(), tube(7), tube(40)] {
        for mode in [NormalMode::default(), NormalMode::Flat] {
            let [mut searched, mut told] = [[mesh.clone()], [mesh.clone()]];
            normals::fill_missing(&mut searched, mode);
            let workers = Workers::default();
            normals::fill_missing_by(&mut told, mode, Positions::Distinct, workers);
            assert_eq!(searched[0].normals, told[0].normals);
            assert_eq!(searched[0].triangles, told[0].triangles);
            assert!(!told[0].normals.is_empty());
        }
    }
}

#[test]
fn a_cube_keeps_its_edges() {
    let mut meshes = [cube()];
    normals::fill_missing(&mut meshes, NormalMode::default());
    let [mesh] = meshes;
    assert_eq!(mesh.positions.len(), 24, "each corner has three normals");
    assert_eq!(mesh.normals.len(), 24);
    for &triangle in &mesh.triangles {
        for vertex in triangle {
            let distance = mesh.normals[vertex as usize].distance(face_normal(&mesh, triangle));
            assert!(distance < 1e-6);
        }
    }
}

/// Rows: M2.
#[test]
fn a_round_tube_is_smooth_and_a_square_one_is_not() {
    let mut meshes = [tube(16)];
    normals::fill_missing(&mut meshes, NormalMode::default());
    assert_eq!(
        meshes[0].positions.len(),
        32,
        "sides 22.5° apart are one surface"
    );
    for (normal, position) in meshes[0].normals.iter().zip(&meshes[0].positions) {
        // Three triangles meet in each vertex, two of one side and one of the other.
        let outwards = Vec3::new(position.x, position.y, 0.0);
        assert!(normal.dot(outwards) > libm::cosf(0.1), "{normal}");
        assert!((normal.length() - 1.0).abs() < 1e-6);
    }
    let mut meshes = [tube(4)];
    normals::fill_missing(&mut meshes, NormalMode::default());
    assert_eq!(meshes[0].positions.len(), 16, "sides 90° apart are not");
    let mut meshes = [tube(4)];
    normals::fill_missing(&mut meshes, NormalMode::CreaseAngle { degrees: 100.0 });
    assert_eq!(
        meshes[0].positions.len(),
        8,
        "unless that is what is asked for"
    );
}

/// Rows: M2.
#[test]
fn positions_equal_to_the_bit_are_one_point_even_across_meshes() {
    let whole = tube(16);
    let mut smooth = [whole.clone()];
    normals::fill_missing(&mut smooth, NormalMode::default());
    // The same surface as a triangle soup in two meshes; one has negative zeros.
    let soup = |triangles: &[[u32; 3]]| Mesh {
        positions: triangles
            .iter()
            .flatten()
            .map(|&i| whole.positions[i as usize])
            .collect(),
        triangles: (0..)
            .step_by(3)
            .take(triangles.len())
            .map(|i| [i, i + 1, i + 2])
            .collect(),
        ..Mesh::default()
    };
    let (first, second) = whole.triangles.split_at(13);
    let mut meshes = [soup(first), soup(second)];
    for position in &mut meshes[1].positions {
        *position = position.map(|value| if value == 0.0 { -0.0 } else { value });
    }
    normals::fill_missing(&mut meshes, NormalMode::default());
    let of_soup = meshes.iter().flat_map(|mesh| &mesh.normals);
    let expected = whole
        .triangles
        .iter()
        .flatten()
        .map(|&i| smooth[0].normals[i as usize]);
    assert!(of_soup.copied().eq(expected));
}

/// Rows: M2.
#[test]
fn flat_mode_gives_each_triangle_its_own_normal() {
    let mut meshes = [tube(16)];
    normals::replace(&mut meshes, NormalMode::Flat);
    let [mesh] = meshes;
    for &triangle in &mesh.triangles {
        for vertex in triangle {
            assert!(mesh.normals[vertex as usize].distance(face_normal(&mesh, triangle)) < 1e-6);
        }
    }
    assert_eq!(mesh.normals.len(), mesh.positions.len());
}

/// Rows: M2.
#[test]
fn smoothing_groups_overrule_angles() {
    let all_one = [vec![1; 12]];
    let mut meshes = [cube()];
    normals::fill_missing(&mut meshes, NormalMode::SmoothingGroups(&all_one));
    assert_eq!(meshes[0].positions.len(), 8);
    let none = [vec![0; 12]];
    let mut meshes = [cube()];
    normals::fill_missing(&mut meshes, NormalMode::SmoothingGroups(&none));
    assert_eq!(meshes[0].positions.len(), 24);
    // Bottom and top are separate groups, the four walls are one.
    let walls = [vec![2, 2, 3, 3, 1, 1, 1, 1, 1, 1, 1, 1]];
    let mut meshes = [cube()];
    normals::fill_missing(&mut meshes, NormalMode::SmoothingGroups(&walls));
    assert_eq!(meshes[0].positions.len(), 16);
}

#[test]
fn normals_of_the_file_are_kept() {
    let mut meshes = [cube()];
    let strange = Vec3::new(0.6, 0.8, 0.0);
    meshes[0].normals = vec![strange; 8];
    meshes[0].normals[3] = Vec3::ZERO;
    normals::fill_missing(&mut meshes, NormalMode::default());
    let [mesh] = meshes;
    assert_eq!(
        mesh.normals
            .iter()
            .filter(|&&normal| normal == strange)
            .count(),
        7
    );
    assert_eq!(
        mesh.positions.len(),
        10,
        "the vertex without a normal has three"
    );
}

/// Rows: M2.
#[test]
fn the_larger_face_weighs_more() {
    // Two triangles 30° apart over a common edge; one has three times the area.
    let (sin, cos) = (libm::sinf(0.5), libm::cosf(0.5));
    let mut meshes = [Mesh {
        positions: vec![
            Vec3::ZERO,
            Vec3::Y,
            Vec3::X * 3.0,
            Vec3::new(-cos, 0.0, -sin),
        ],
        triangles: vec![[0, 2, 1], [0, 1, 3]],
        ..Mesh::default()
    }];
    normals::fill_missing(&mut meshes, NormalMode::default());
    let expected = (Vec3::Z * 3.0 + Vec3::new(-sin, 0.0, cos)).normalize();
    assert!(meshes[0].normals[0].distance(expected) < 1e-6);
}

#[test]
fn the_size_of_a_model_does_not_change_its_normals() {
    let mut reference = [cube()];
    normals::fill_missing(&mut reference, NormalMode::default());
    for exponent in [-100, -60, -20, 60, 120] {
        let mut meshes = [cube()];
        for position in &mut meshes[0].positions {
            *position *= libm::ldexpf(1.0, exponent);
        }
        normals::fill_missing(&mut meshes, NormalMode::default());
        assert_eq!(meshes[0].normals, reference[0].normals, "2^{exponent}");
    }
}

#[test]
fn triangles_without_area_do_no_harm() {
    let mut mesh = cube();
    mesh.triangles.extend([[0, 0, 0], [1, 2, 1], [0, 7, 7]]);
    let mut meshes = [mesh];
    normals::fill_missing(&mut meshes, NormalMode::default());
    assert!(
        meshes[0]
            .normals
            .iter()
            .all(|normal| (normal.length() - 1.0).abs() < 1e-5)
    );
    let mut meshes = [Mesh {
        positions: vec![Vec3::ZERO; 3],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    }];
    normals::fill_missing(&mut meshes, NormalMode::default());
    assert_eq!(meshes[0].normals, [Vec3::ZERO; 3]);
}

/// The time is linear: with all pairs of faces, it would be 10^11 steps.
#[test]
fn a_vertex_shared_by_all_triangles_takes_no_quadratic_time() {
    let count = 300_000_u32;
    // A crumpled fan: neighbouring triangles point in very different directions.
    let rim = (0..count).map(|i| {
        let angle = i as f32 * 2.399_963;
        let height = (i % 97) as f32 / 48.0 - 1.0;
        Vec3::new(libm::cosf(angle), libm::sinf(angle), height)
    });
    let mut meshes = [Mesh {
        positions: [Vec3::ZERO].into_iter().chain(rim).collect(),
        triangles: (1..count).map(|i| [0, i, i + 1]).collect(),
        ..Mesh::default()
    }];
    let start = std::time::Instant::now();
    normals::fill_missing(&mut meshes, NormalMode::default());
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
    let [mesh] = meshes;
    // A cell of directions is still near the face's own direction.
    for &triangle in mesh.triangles.iter().step_by(100) {
        let own = face_normal(&mesh, triangle);
        assert!(mesh.normals[triangle[0] as usize].dot(own) > 0.3);
    }
}

#[test]
fn welding_keeps_different_positions_separate() {
    let zero = Vec3::ZERO;
    let mut keys = vec![
        key(zero, 0),
        key(Vec3::new(-0.0, 0.0, -0.0), 0),
        key(zero, 1),
        key(Vec3::splat(f32::NAN), 0),
        key(Vec3::splat(f32::NAN), 0),
        key(zero, 1),
    ];
    let special = [0, 0, 2, 3, 3, 2];
    // Different positions, then the same positions again.
    let count = 50_000_u16;
    for _ in 0..2 {
        keys.extend((0..count).map(|i| key(Vec3::new(f32::from(i), 1.0, 2.0), 0)));
    }
    for (threads, expected) in [(1, keys.len()), (2, 0), (7, 1000)] {
        let firsts = first_equals(keys.len(), expected, |i| keys[i], Workers::new(threads));
        let (start, runs) = firsts.split_at(special.len());
        assert_eq!(start, special, "{threads} threads");
        for run in runs.chunks(usize::from(count)) {
            assert!((6..).zip(run).all(|(own, &first)| own == first));
        }
    }
}
