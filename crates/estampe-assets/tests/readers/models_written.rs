//! Models that are written are read back as they were.

use estampe_assets::model::NoResources;
use estampe_assets::{Limits, ModelFormat, encode_model, parse_model};
use estampe_scene::{Mesh, Scene};
use estampe_shapes::BuiltinShape;
use fastrand::Rng;
use glam::{Vec2, Vec3};

const FORMATS: [ModelFormat; 3] = [ModelFormat::Obj, ModelFormat::Stl, ModelFormat::Ply];

fn scene(meshes: Vec<Mesh>) -> Scene {
    Scene {
        meshes,
        ..Scene::default()
    }
}

fn builtin(shape: BuiltinShape) -> Mesh {
    let built = shape.build();
    Mesh {
        name: built.name,
        positions: built.positions,
        normals: built.normals,
        uvs: built.uvs,
        triangles: built.triangles,
        ..Mesh::default()
    }
}

fn read(bytes: &[u8], format: ModelFormat) -> Scene {
    let read = parse_model(bytes, format, "written", &NoResources, &Limits::default());
    let read = read.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(read.warning_count, 0, "{:?}", read.warnings);
    read.scene
}

/// Positions, normals and texture coordinates of all corners of all triangles.
fn corners(scene: &Scene) -> Vec<(Vec3, Vec3, Vec2)> {
    let mut corners = Vec::new();
    for mesh in &scene.meshes {
        for &vertex in mesh.triangles.as_flattened() {
            let vertex = vertex as usize;
            let normal = mesh.normals.get(vertex).copied().unwrap_or_default();
            let uv = mesh.uvs.get(vertex).copied().unwrap_or_default();
            corners.push((mesh.positions[vertex], normal, uv));
        }
    }
    corners
}

#[test]
fn builtin_models_are_read_back() {
    for shape in BuiltinShape::ALL {
        let written = scene(vec![builtin(shape)]);
        for format in FORMATS {
            let bytes = encode_model(&written, format).unwrap();
            assert_eq!(bytes, encode_model(&written, format).unwrap());
            assert_eq!(ModelFormat::from_content(&bytes), Some(format));
            let back = read(&bytes, format);
            let (before, after) = (corners(&written), corners(&back));
            assert_eq!(before.len(), after.len(), "{shape} {format:?}");
            for ((p, n, uv), (q, m, vw)) in before.into_iter().zip(after) {
                assert_eq!(p, q, "{shape} {format:?}");
                if format != ModelFormat::Stl {
                    assert!(
                        n.distance(m) < 1e-6 && uv.distance(vw) < 1e-6,
                        "{shape} {format:?}"
                    );
                }
            }
        }
    }
    // A seam has one position for two vertices.
    let sphere = builtin(BuiltinShape::Sphere);
    let obj = encode_model(&scene(vec![sphere.clone()]), ModelFormat::Obj).unwrap();
    let positions = obj
        .split(|b| *b == b'\n')
        .filter(|line| line.starts_with(b"v "));
    assert_eq!(positions.count(), 96 * 47 + 2);
}

/// Numbers of all sizes keep their bits.
#[test]
fn numbers_are_read_back_to_the_bit() {
    let mut random = Rng::with_seed(3);
    let mut number = || loop {
        let number = f32::from_bits(random.u32(..));
        if number.is_finite() && number.abs() < 1e30 {
            return number;
        }
    };
    let positions: Vec<Vec3> = (0..3000)
        .map(|_| Vec3::new(number(), number(), number()))
        .collect();
    let triangles: Vec<[u32; 3]> = (0..1000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mesh = Mesh {
        positions: positions.clone(),
        triangles,
        ..Mesh::default()
    };
    for format in FORMATS {
        let back = read(
            &encode_model(&scene(vec![mesh.clone()]), format).unwrap(),
            format,
        );
        let read: Vec<Vec3> = corners(&back).into_iter().map(|(p, _, _)| p).collect();
        assert_eq!(read, positions, "{format:?}");
    }
}

#[test]
fn lines_and_points_are_read_back() {
    let count = 2500_u32;
    let mesh = Mesh {
        name: "a curve\nf 1 2 3".to_owned(),
        positions: (0..count).map(|i| Vec3::new(i as f32, 0.5, -1.0)).collect(),
        lines: (1..count)
            .map(|i| [i - 1, i])
            .chain([[0, 9], [3, 5]])
            .collect(),
        points: vec![7],
        ..Mesh::default()
    };
    let ends = |scene: &Scene| -> Vec<[Vec3; 2]> {
        let meshes = scene.meshes.iter();
        meshes
            .flat_map(|mesh| {
                mesh.lines
                    .iter()
                    .map(|line| line.map(|i| mesh.positions[i as usize]))
            })
            .collect()
    };
    let written = scene(vec![mesh]);
    let obj = encode_model(&written, ModelFormat::Obj).unwrap();
    let text = String::from_utf8(obj.clone()).unwrap();
    assert!(
        text.contains("o a_curve_f_1_2_3\n"),
        "a name cannot add a statement"
    );
    assert_eq!(
        text.lines().filter(|line| line.starts_with("l ")).count(),
        5
    );
    assert_eq!(ends(&read(&obj, ModelFormat::Obj)), ends(&written));
    assert_eq!(read(&obj, ModelFormat::Obj).meshes[0].points.len(), 1);
    let ply = encode_model(&written, ModelFormat::Ply).unwrap();
    assert_eq!(ends(&read(&ply, ModelFormat::Ply)), ends(&written));
    let error = encode_model(&written, ModelFormat::Stl).unwrap_err();
    assert!(error.to_string().contains("write OBJ or PLY"), "{error}");
}

#[test]
fn several_meshes_keep_their_order() {
    let written = scene(vec![
        builtin(BuiltinShape::Cube),
        builtin(BuiltinShape::Plane),
    ]);
    for format in FORMATS {
        let back = read(&encode_model(&written, format).unwrap(), format);
        let positions = |scene: &Scene| -> Vec<Vec3> {
            corners(scene).into_iter().map(|(p, _, _)| p).collect()
        };
        assert_eq!(positions(&back), positions(&written), "{format:?}");
    }
    let mut broken = builtin(BuiltinShape::Cube);
    broken.positions[5].y = f32::INFINITY;
    for format in FORMATS {
        let error = encode_model(&scene(vec![broken.clone()]), format).unwrap_err();
        assert!(error.to_string().contains("vertex 5"), "{error}");
        assert!(encode_model(&Scene::default(), format).is_ok());
    }
}
