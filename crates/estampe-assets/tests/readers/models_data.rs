//! Model files from outside the repository: their contents, and errors for missing files.

use estampe_assets::{AssetError, Limits, load_model};
use std::path::Path;

#[test]
fn missing_files_and_folders_are_io_errors() {
    let limits = Limits::default();
    let missing = load_model(Path::new("no/such/file.obj"), None, &limits);
    assert!(matches!(missing, Err(AssetError::Io(_))), "{missing:?}");
    assert!(
        missing
            .unwrap_err()
            .to_string()
            .starts_with("no/such/file.obj: ")
    );
    let folder = load_model(Path::new("."), None, &limits);
    assert!(matches!(folder, Err(AssetError::Io(_))), "{folder:?}");
}

/// Tests of data that is not part of the project: `cargo test -- --ignored shared_data::`.
mod shared_data {
    use super::*;
    use estampe_assets::Loaded;
    use std::path::PathBuf;

    fn folder() -> PathBuf {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/models");
        assert!(path.is_dir(), "{} is not here", path.display());
        path
    }

    /// Different positions, triangles, lines, points, meshes, materials, images, warnings.
    type Counts = [usize; 8];

    fn counts(loaded: &Loaded) -> Counts {
        let meshes = &loaded.scene.meshes;
        let bits = |p: &glam::Vec3| p.to_array().map(|value| (value + 0.0).to_bits());
        let positions: std::collections::HashSet<_> = meshes
            .iter()
            .flat_map(|mesh| {
                let used = mesh.triangles.iter().flatten();
                let used = used.chain(mesh.lines.iter().flatten()).chain(&mesh.points);
                used.map(|&vertex| bits(&mesh.positions[vertex as usize]))
            })
            .collect();
        [
            positions.len(),
            meshes.iter().map(|mesh| mesh.triangles.len()).sum(),
            meshes.iter().map(|mesh| mesh.lines.len()).sum(),
            meshes.iter().map(|mesh| mesh.points.len()).sum(),
            meshes.len(),
            loaded.scene.materials.len(),
            loaded.scene.images.len(),
            usize::try_from(loaded.warning_count).unwrap(),
        ]
    }

    fn all_files(folder: &Path) -> Vec<PathBuf> {
        let mut files: Vec<PathBuf> = ["", "african_head", "odd-obj", "stl", "ply"]
            .iter()
            .flat_map(|sub| std::fs::read_dir(folder.join(sub)).unwrap())
            .map(|entry| entry.unwrap().path())
            .filter(|path| estampe_assets::ModelFormat::from_extension(path).is_some())
            .collect();
        files.sort();
        files
    }

    #[test]
    #[ignore = "needs ../shared/data/models"]
    fn every_file_is_read_or_refused_clearly() {
        let folder = folder();
        let files = all_files(&folder);
        assert!(files.len() >= 45, "{}", files.len());
        for path in files {
            let name = path.strip_prefix(&folder).unwrap().display().to_string();
            match load_model(&path, None, &Limits::default()) {
                Ok(loaded) => {
                    eprintln!("{name}: {:?}", counts(&loaded));
                    for warning in loaded.warnings.iter().take(3) {
                        eprintln!("    {warning}");
                    }
                    for mesh in &loaded.scene.meshes {
                        assert!(
                            mesh.triangles.is_empty() || mesh.normals.len() == mesh.positions.len()
                        );
                    }
                }
                Err(error) => panic!("{name}: {error}"),
            }
        }
    }

    /// The counts of different positions, triangles, lines, points and meshes agree with other
    /// readers'.
    #[test]
    #[ignore = "needs ../shared/data/models"]
    fn known_files_have_the_expected_counts() {
        let folder = folder();
        let known: [(&str, [usize; 5]); 18] = [
            ("african_head/african_head.obj", [1258, 2492, 0, 0, 1]),
            ("cow.obj", [2903, 5804, 0, 0, 1]),
            ("fandisk.obj", [6475, 12946, 0, 0, 1]),
            ("homer.obj", [6002, 12000, 0, 0, 1]),
            ("spot.obj", [2930, 5856, 0, 0, 1]),
            ("suzanne.obj", [505, 968, 0, 0, 1]),
            ("teapot.obj", [3241, 6320, 0, 0, 1]),
            ("stanford-bunny.obj", [34834, 69451, 0, 0, 1]),
            ("odd-obj/cube.obj", [8, 12, 0, 0, 6]),
            ("odd-obj/line-prim.obj", [8, 0, 6, 0, 1]),
            ("odd-obj/points-prim.obj", [8, 0, 0, 8, 1]),
            ("odd-obj/issue-319-003.obj", [10, 8, 0, 0, 1]),
            ("stl/box.STL", [4455, 8954, 0, 0, 1]),
            ("stl/two_objects_mixed_case_names.stl", [16, 24, 0, 0, 2]),
            ("stl/soup.stl", [300, 100, 0, 0, 1]),
            ("ply/bunny.ply", [8146, 16301, 0, 0, 1]),
            ("ply/sphere.ply", [642, 1280, 0, 0, 1]),
            ("ply/points_ascii_with_lists.ply", [5, 0, 0, 5, 1]),
        ];
        for (name, expected) in known {
            let loaded = load_model(&folder.join(name), None, &Limits::default()).unwrap();
            assert_eq!(counts(&loaded)[..5], expected, "{name}");
        }
    }

    /// Normals of the file are kept, computed ones are on the front side of their faces, and those
    /// of spheres are radial.
    #[test]
    #[ignore = "needs ../shared/data/models"]
    fn normals_agree_with_the_faces() {
        let folder = folder();
        let load = |name: &str| load_model(&folder.join(name), None, &Limits::default()).unwrap();
        for name in [
            "suzanne.obj",
            "stanford-bunny.obj",
            "ply/sphere.ply",
            "stl/unit_sphere.STL",
        ] {
            let loaded = load(name);
            let mesh = &loaded.scene.meshes[0];
            let agreeing = mesh.triangles.iter().filter(|triangle| {
                let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex as usize]);
                let face = (b - a).cross(c - a);
                triangle
                    .iter()
                    .all(|&vertex| mesh.normals[vertex as usize].dot(face) >= 0.0)
            });
            let share = agreeing.count() as f64 / mesh.triangles.len() as f64;
            assert!(share > 0.97, "{name}: {share}");
            if name.contains("sphere") {
                for (normal, position) in mesh.normals.iter().zip(&mesh.positions) {
                    assert!(
                        normal.dot(position.normalize()) > 0.999,
                        "{name}: {normal} {position}"
                    );
                }
            }
        }
    }
}
