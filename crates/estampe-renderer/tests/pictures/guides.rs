//! Grids, axes and boxes around models.

use crate::support::drawn_alike;
use estampe_renderer::{
    BoundingBox, CameraOptions, Eye, ProjectionKind, RenderOptions, Shading, ViewDirection,
};
use estampe_scene::{Mesh, Scene};
use estampe_shapes::BuiltinShape;

fn scene(shape: BuiltinShape) -> Scene {
    let shape = shape.build();
    Scene {
        meshes: vec![Mesh {
            positions: shape.positions,
            normals: shape.normals,
            triangles: shape.triangles,
            ..Mesh::default()
        }],
        ..Scene::default()
    }
}

fn options(is_orthographic: bool, samples: u32) -> RenderOptions {
    RenderOptions {
        width: 72,
        height: 60,
        samples,
        background: None,
        shading: Shading::Unlit,
        camera: CameraOptions {
            eye: Eye::Fitted(ViewDirection::default()),
            projection: if is_orthographic {
                ProjectionKind::Orthographic { half_height: None }
            } else {
                ProjectionKind::default()
            },
            ..CameraOptions::default()
        },
        ..RenderOptions::default()
    }
}

/// The grid lies behind the model and beside it, and changes neither camera nor model.
#[test]
fn the_model_hides_the_grid() {
    let torus = scene(BuiltinShape::Torus);
    for (is_orthographic, samples) in [(false, 1), (true, 4)] {
        let plain = options(is_orthographic, samples);
        let with_grid = RenderOptions {
            grid: true,
            ..plain.clone()
        };
        let [plain, grid] = [&plain, &with_grid].map(|options| drawn_alike(&torus, options));
        assert_eq!(plain.camera, grid.camera);
        let mut beside = 0;
        let pairs = plain.image.rgba.chunks(4).zip(grid.image.rgba.chunks(4));
        for (plain, grid) in pairs {
            if plain[3] == 255 {
                assert_eq!(plain, grid);
            } else if plain[3] == 0 && grid[3] > 0 {
                beside += 1;
            }
        }
        assert!(beside > 150, "{beside}");
    }
}

#[test]
fn a_box_is_inside_of_the_picture_and_the_model_hides_its_far_edges() {
    let sphere = scene(BuiltinShape::Sphere);
    for (is_orthographic, samples) in [(false, 4), (true, 1)] {
        let options = RenderOptions {
            bounding_box: Some(BoundingBox {
                unit: Some("mm".to_owned()),
            }),
            ..options(is_orthographic, samples)
        };
        let image = drawn_alike(&sphere, &options).image;
        let alpha = |x: u32, y: u32| image.rgba[((y * image.width + x) * 4 + 3) as usize];
        // The middle is the sphere, whose base colour covers the box's far corner.
        let at = ((30 * image.width + 36) * 4) as usize;
        let without = drawn_alike(
            &sphere,
            &RenderOptions {
                bounding_box: None,
                ..options.clone()
            },
        );
        assert_eq!(
            image.rgba[at..at + 4],
            without.image.rgba[(30 * 72 + 36) * 4..][..4]
        );
        let rows = (0..image.height).filter(|&y| (0..image.width).any(|x| alpha(x, y) > 0));
        assert!(rows.count() > 40);
    }
}

#[test]
fn the_axes_are_in_the_lower_left_corner() {
    let cube = scene(BuiltinShape::Cube);
    let plain = RenderOptions {
        width: 160,
        height: 120,
        ..options(false, 4)
    };
    let with_axes = RenderOptions {
        axes: true,
        ..plain.clone()
    };
    let [plain, axes] = [&plain, &with_axes].map(|options| drawn_alike(&cube, options).image);
    let pixels = plain.rgba.chunks(4).zip(axes.rgba.chunks(4)).zip(0_u32..);
    let changed = pixels.filter(|((plain, axes), _)| plain != axes);
    let places: Vec<(u32, u32)> = changed.map(|(_, at)| (at % 160, at / 160)).collect();
    assert!(places.len() > 60, "{}", places.len());
    assert!(places.iter().all(|&(x, y)| x < 64 && y > 56), "{places:?}");
}
