//! Levels of textures on planes whose size in pixels is known.

use super::{first_level_of_texture, first_levels};
use crate::options::{Ground, RenderOptions};
use crate::{CameraOptions, Eye, ProjectionKind, SectionPlane};
use estampe_scene::{
    AlphaMode, Image, Material, Mesh, PbrMaterial, Scene, Surface, TextureRef, UvTransform, Workers,
};
use glam::{DVec3, Vec2, Vec3};

/// A square of side 2 with a texture of this side, `repeats` times.
fn square(side: u32, repeats: f32) -> Scene {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let mesh = Mesh {
        positions: corners.map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec(),
        uvs: corners
            .map(|(x, y)| Vec2::new(x + 1.0, 1.0 - y) * 0.5 * repeats)
            .to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        surfaces: vec![Surface {
            material: Some(0),
            triangles: 0..2,
        }],
        ..Mesh::default()
    };
    Scene {
        meshes: vec![mesh],
        materials: vec![Material {
            base_color_texture: Some(0),
            ..Material::default()
        }],
        images: vec![Image {
            width: side,
            height: side,
            rgba: Vec::new(),
        }],
        ..Scene::default()
    }
}

/// A parallel projection in which the square has 128² of the picture's 256² pixels.
fn options() -> RenderOptions {
    RenderOptions {
        width: 256,
        height: 256,
        camera: CameraOptions {
            eye: Eye::At(DVec3::new(0.0, 0.0, 5.0)),
            projection: ProjectionKind::Orthographic {
                half_height: Some(2.0),
            },
            ..CameraOptions::default()
        },
        ..RenderOptions::default()
    }
}

fn level(side: u32, repeats: f32) -> u32 {
    first_levels(&square(side, repeats), &options(), Workers::ONE)[0]
}

#[test]
fn a_texture_keeps_two_texels_for_each_pixel() {
    // Four times as many texels as the picture has pixels stay whole: 512².
    assert_eq!(level(512, 1.0), 0);
    // 1024 texels on 128 pixels: 8 for each, of which 2 stay.
    assert_eq!(level(1024, 1.0), 2);
    assert_eq!(level(16_384, 1.0), 6);
    // Between two powers of two more texels stay.
    assert_eq!(level(2047, 1.0), 2);
    assert_eq!(level(2048, 1.0), 3);
}

#[test]
fn repetitions_and_transforms_count_as_texels() {
    // A part of the texture fills the square, so that each pixel has fewer texels.
    assert_eq!(level(1024, 0.25), 0);
    assert_eq!(level(1024, 0.5), 1);
    // Repeated, a pixel covers more.
    assert_eq!(level(1024, 4.0), 4);
    let mut scene = square(1024, 1.0);
    let transform = UvTransform {
        scale: Vec2::splat(0.5),
        ..UvTransform::IDENTITY
    };
    scene.materials[0].pbr = Some(Box::new(PbrMaterial {
        base_color_texture: Some(TextureRef {
            transform,
            ..TextureRef::new(0)
        }),
        ..PbrMaterial::default()
    }));
    assert_eq!(first_levels(&scene, &options(), Workers::ONE), [1]);
}

#[test]
fn the_nearest_corner_decides_in_perspective() {
    // A floor that reaches from below the eye into the distance.
    let mut scene = square(4096, 1.0);
    for position in &mut scene.meshes[0].positions {
        *position = Vec3::new(position.x, 0.0, 10.0 * position.y);
    }
    let from = |height: f64| RenderOptions {
        camera: CameraOptions {
            eye: Eye::At(DVec3::new(0.0, height, 11.0)),
            target_world: Some(DVec3::ZERO),
            ..CameraOptions::default()
        },
        ..options()
    };
    let far = first_levels(&scene, &from(40.0), Workers::ONE)[0];
    let near = first_levels(&scene, &from(0.3), Workers::ONE)[0];
    assert!(far > 1, "{far}");
    assert_eq!(near, 0);
}

#[test]
fn a_cut_model_is_seen_from_nearer() {
    let fitted = RenderOptions {
        camera: CameraOptions::default(),
        ..options()
    };
    let mut cut = fitted.clone();
    // Less than a quarter of the width is left, and of the height.
    for normal_world in [DVec3::X, DVec3::Y] {
        cut.section.planes.push(SectionPlane {
            normal_world,
            offset_world: Some(-0.6),
        });
    }
    let scene = square(4096, 1.0);
    let of = |options: &RenderOptions| first_levels(&scene, options, Workers::ONE)[0];
    assert!(of(&fitted) >= of(&cut) + 2);
    // The error comes later.
    cut.section.planes[0].offset_world = Some(-9.0);
    assert!(of(&cut) <= of(&fitted));
}

#[test]
fn slivers_below_a_pixel_do_not_count() {
    let with_sliver = |width: f32| {
        let mut scene = square(1024, 1.0);
        let mesh = &mut scene.meshes[0];
        // All three corners have the same texture coordinates.
        for (x, y) in [(-1.0, 0.0), (1.0, 0.0), (1.0, width)] {
            mesh.positions.push(Vec3::new(x, y, 0.0));
            mesh.uvs.push(Vec2::splat(0.5));
        }
        mesh.triangles.push([4, 5, 6]);
        mesh.surfaces[0].triangles = 0..3;
        first_levels(&scene, &options(), Workers::ONE)[0]
    };
    assert_eq!(with_sliver(1e-4), 2);
    assert_eq!(with_sliver(0.1), 0);
}

#[test]
fn invisible_textures_and_those_of_shadows_are_told() {
    let mut scene = square(4096, 1.0);
    scene.meshes[0].uvs.clear();
    assert_eq!(first_levels(&scene, &options(), Workers::ONE), [u32::MAX]);

    let mut scene = square(4096, 1.0);
    let with_ground = RenderOptions {
        ground: Ground::Shadow,
        ..options()
    };
    assert_eq!(first_levels(&scene, &with_ground, Workers::ONE), [4]);
    scene.materials[0].alpha_mode = AlphaMode::Mask;
    assert_eq!(first_levels(&scene, &options(), Workers::ONE), [4]);
    assert_eq!(first_levels(&scene, &with_ground, Workers::ONE), [0]);
}

#[test]
fn a_texture_of_the_options_is_that_of_all_surfaces() {
    let scene = square(1, 1.0);
    let of = |side| first_level_of_texture((side, side), &scene, &options(), Workers::ONE);
    assert_eq!([512, 1024, 4096].map(of), [0, 2, 4]);
}

#[test]
fn broken_geometry_needs_everything_or_nothing() {
    let mut scene = square(4096, 1.0);
    scene.meshes[0].uvs[0] = Vec2::NAN;
    assert_eq!(first_levels(&scene, &options(), Workers::ONE), [0]);
    let mut scene = square(4096, 1.0);
    scene.meshes[0].positions[0] = Vec3::splat(f32::MAX);
    let _ = first_levels(&scene, &options(), Workers::ONE);
    scene.meshes[0].triangles.clear();
    scene.meshes[0].surfaces[0].triangles = 0..2;
    assert_eq!(first_levels(&scene, &options(), Workers::ONE), [u32::MAX]);
}
