//! Invalid scenes: invalid parts are omitted, and nothing panics.

use estampe::{Device, DeviceDescriptor};
use estampe_renderer::{
    CameraOptions, Eye, Fog, RenderError, RenderOptions, Shading, Specular, SpecularModel,
    Transparency, ViewDirection, render,
};
use estampe_scene::{AlphaMode, Image, Light, LightSource, Material, Mesh, Scene, Surface};
use glam::{DVec3, Vec2, Vec3};

const SHADINGS: [Shading; 16] = [
    Shading::Automatic,
    Shading::Pbr,
    Shading::Flat,
    Shading::Gouraud,
    Shading::Phong,
    Shading::Toon,
    Shading::ToonFlat,
    Shading::ToonGouraud,
    Shading::Unlit,
    Shading::Wireframe,
    Shading::Normals,
    Shading::Depth,
    Shading::Uv,
    Shading::FaceId,
    Shading::Barycentric,
    Shading::Overdraw,
];

fn device() -> Device {
    let descriptor = DeviceDescriptor {
        threads: 1,
        ..DeviceDescriptor::default()
    };
    Device::new(&descriptor).expect("the calling thread exists")
}

fn small(shading: Shading) -> RenderOptions {
    RenderOptions {
        width: 24,
        height: 16,
        shading,
        ..RenderOptions::default()
    }
}

/// A valid triangle among all kinds of invalid data.
fn broken() -> Scene {
    let mesh = Mesh {
        positions: vec![
            Vec3::ZERO,
            Vec3::X,
            Vec3::Y,
            Vec3::NAN,
            Vec3::INFINITY,
            Vec3::splat(1e38),
        ],
        normals: vec![
            Vec3::ZERO,
            Vec3::NAN,
            Vec3::splat(1e30),
            Vec3::Z,
            Vec3::Z,
            Vec3::Z,
        ],
        uvs: vec![
            Vec2::splat(1e30),
            Vec2::NAN,
            Vec2::INFINITY,
            Vec2::ZERO,
            Vec2::ONE,
            Vec2::X,
        ],
        colors: vec![[f32::NAN, -1.0, 1e30, 0.5]; 6],
        triangles: vec![
            [0, 1, 2],
            [0, 0, 0],
            [0, 1, 3],
            [2, 4, 1],
            [0, 1, 99],
            [u32::MAX, 5, 2],
        ],
        lines: vec![[0, 1], [3, 4], [0, 1_000_000]],
        points: vec![0, 3, 77],
        surfaces: vec![
            Surface {
                material: Some(0),
                triangles: 0..1,
            },
            Surface {
                material: Some(1),
                triangles: 1..4,
            },
            Surface {
                material: Some(9),
                triangles: 4..700,
            },
            #[expect(
                clippy::reversed_empty_ranges,
                reason = "it is what a broken reader gives"
            )]
            Surface {
                material: None,
                triangles: 5..2,
            },
        ],
        ..Mesh::default()
    };
    let odd = Material {
        base_color: Vec3::splat(f32::NAN),
        opacity: f32::NAN,
        specular: Vec3::splat(1e30),
        shininess: f32::NAN,
        base_color_texture: Some(0),
        bump_texture: Some(0),
        bump_scale: f32::NAN,
        alpha_mode: AlphaMode::Blend,
        ..Material::default()
    };
    let masked = Material {
        base_color_texture: Some(5),
        alpha_mode: AlphaMode::Mask,
        ..odd.clone()
    };
    Scene {
        meshes: vec![mesh, Mesh::default()],
        materials: vec![odd, masked],
        images: vec![Image::filled(2, 2, [255, 0, 0, 128])],
        ..Scene::default()
    }
}

#[test]
fn broken_scenes_are_drawn_without_their_invalid_parts() {
    let device = device();
    let mut options = RenderOptions {
        lights: vec![Light {
            source: LightSource::Directional {
                towards_light_world: Vec3::ZERO,
            },
            color: Vec3::NAN,
        }],
        background: None,
        ..RenderOptions::default()
    };
    for shading in SHADINGS {
        for scene in [broken(), Scene::default()] {
            render(&scene, &small(shading), &device).expect("every scene can be drawn");
            options = RenderOptions {
                shading,
                width: 7,
                height: 9,
                ..options
            };
            render(&scene, &options, &device).expect("every scene can be drawn");
        }
    }
}

#[test]
fn broken_scenes_are_drawn_by_every_method_of_transparency() {
    let device = device();
    for transparency in [
        Transparency::Sorted,
        Transparency::Exact,
        Transparency::Weighted,
    ] {
        for shading in SHADINGS {
            for samples in [1, 4] {
                let options = RenderOptions {
                    transparency,
                    samples,
                    wireframe: true,
                    ..small(shading)
                };
                render(&broken(), &options, &device).expect("every scene can be drawn");
            }
        }
    }
}

#[test]
fn odd_lights_and_fog_give_pictures() {
    let device = device();
    let numbers = [0.0, -1.0, 1e-38, 1e38, f32::INFINITY, f32::NAN];
    for number in numbers {
        let light = |position_world, reach| Light {
            source: LightSource::Positional {
                position_world,
                reach,
            },
            color: Vec3::new(number, 1.0, -number),
        };
        for end_world in numbers.map(f64::from) {
            let options = |shading| RenderOptions {
                lights: vec![
                    light(Vec3::splat(number), None),
                    light(Vec3::ZERO, Some(number)),
                ],
                ambient: Some(number),
                specular: Specular {
                    model: SpecularModel::Blinn,
                    strength: Some(number),
                },
                shininess: Some(u32::MAX),
                levels: Some(0),
                fog: Some(Fog {
                    start_world: f64::from(number),
                    end_world,
                    color: None,
                }),
                ..small(shading)
            };
            for shading in [
                Shading::Flat,
                Shading::Gouraud,
                Shading::Phong,
                Shading::Toon,
            ] {
                for scene in [broken(), Scene::default()] {
                    render(&scene, &options(shading), &device).expect("every light can be used");
                }
            }
        }
    }
}

#[test]
fn a_mesh_without_normals_is_lit_by_its_faces() {
    let triangle = |normals: Vec<Vec3>| {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        let mesh = Mesh {
            positions,
            normals,
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        };
        Scene {
            meshes: vec![mesh],
            ..Scene::default()
        }
    };
    let device = device();
    let options = RenderOptions {
        camera: CameraOptions {
            eye: Eye::Fitted(ViewDirection::FRONT),
            ..CameraOptions::default()
        },
        ..small(Shading::Phong)
    };
    let without = render(&triangle(Vec::new()), &options, &device).expect("small");
    let with = render(&triangle(vec![Vec3::Z; 3]), &options, &device).expect("small");
    assert_eq!(without.image, with.image);
    assert_eq!(with.statistics.primitives_in, 1);
    // Normals that point away from the front of the face are treated as an exporter's mistake.
    let turned = render(&triangle(vec![-Vec3::Z; 3]), &options, &device).expect("small");
    assert_eq!(turned.image, with.image);
}

#[test]
fn odd_cameras_give_images() {
    let device = device();
    for eye in [
        DVec3::ZERO,
        DVec3::splat(1e30),
        DVec3::splat(-1e-30),
        DVec3::NAN,
    ] {
        for target_world in [None, Some(DVec3::ZERO), Some(DVec3::splat(1e300))] {
            let camera = CameraOptions {
                eye: Eye::At(eye),
                target_world,
                ..CameraOptions::default()
            };
            let options = RenderOptions {
                camera,
                ..small(Shading::Phong)
            };
            render(&broken(), &options, &device).expect("every camera can be used");
        }
    }
}

#[test]
fn sizes_beyond_the_limits_are_errors() {
    let device = device();
    for (width, height) in [(0, 5), (5, 0), (16_385, 5), (u32::MAX, u32::MAX)] {
        let options = RenderOptions {
            width,
            height,
            ..RenderOptions::default()
        };
        let error = render(&Scene::default(), &options, &device).expect_err("too large");
        assert!(matches!(error, RenderError::Size { .. }), "{error}");
        assert!(error.to_string().contains("16384"), "{error}");
    }
}
