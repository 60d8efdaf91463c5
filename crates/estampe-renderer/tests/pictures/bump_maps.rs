//! Bump maps through pictures: slopes with known normals.

use crate::support::drawn_alike;
use estampe_renderer::{
    CameraOptions, Eye, ProjectionKind, RenderOptions, Shading, Specular, SpecularModel,
};
use estampe_scene::{Image, Light, LightSource, Material, Mesh, Scene, Surface};
use glam::{DVec3, Vec2, Vec3};

/// A square of side `side` in the plane z = 0 with a bump map whose height is u, and which is
/// repeated this often in each direction.
fn slope(side: f32, repeats: f32, scale: f32) -> Scene {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from);
    let mut ramp = Image::filled(256, 1, [255; 4]);
    for x in 0..=255 {
        ramp.rgba[usize::from(x) * 4..][..3].fill(x);
    }
    let mesh = Mesh {
        positions: corners.map(|at| ((at - 0.5) * side).extend(0.0)).to_vec(),
        normals: vec![Vec3::Z; 4],
        uvs: corners.map(|at| at * repeats).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        surfaces: vec![Surface {
            material: Some(0),
            triangles: 0..2,
        }],
        ..Mesh::default()
    };
    let material = Material {
        base_color: Vec3::ONE,
        bump_texture: Some(0),
        bump_scale: scale,
        ..Material::default()
    };
    Scene {
        meshes: vec![mesh],
        materials: vec![material],
        images: vec![ramp],
        ..Scene::default()
    }
}

/// The linear brightness in a pixel's middle in light from this direction, seen from a side.
fn lit(scene: &Scene, towards: Vec3, eye_z: f64, shading: Shading) -> f32 {
    let half_size = f64::from(scene.meshes[0].positions[2].x);
    let options = RenderOptions {
        width: 64,
        height: 64,
        samples: 1,
        camera: CameraOptions {
            eye: Eye::At(DVec3::new(0.01, 0.02, eye_z) * half_size),
            target_world: Some(DVec3::new(0.01, 0.02, 0.0) * half_size),
            projection: ProjectionKind::Orthographic { half_height: None },
            ..CameraOptions::default()
        },
        shading,
        lights: vec![Light {
            source: LightSource::Directional {
                towards_light_world: towards,
            },
            color: Vec3::ONE,
        }],
        ambient: Some(0.0),
        specular: Specular {
            model: SpecularModel::None,
            strength: None,
        },
        ..RenderOptions::default()
    };
    let frame = drawn_alike(scene, &options);
    estampe::srgb::decode(frame.image.texel(20, 32)[0])
}

/// White is 1/50 of the texture's size above black, so a multiplier of 50 is a slope of 45°, on a
/// surface of any size and for any number of repetitions.
///
/// Rows: F3.
#[test]
fn a_ramp_of_heights_tilts_the_normal() {
    let (left, right) = (Vec3::new(-1.0, 0.0, 1.0), Vec3::new(1.0, 0.0, 1.0));
    for (side, repeats) in [(2.0, 1.0), (2e6, 1.0), (2e-6, 1.0), (2.0, 3.0)] {
        let scene = slope(side, repeats, 50.0);
        let towards = lit(&scene, left, 5.0, Shading::Phong);
        let away = lit(&scene, right, 5.0, Shading::Phong);
        let context = format!("side {side}, {repeats} times: {towards} and {away}");
        assert!((towards - 1.0).abs() < 0.03 && away < 0.06, "{context}");
        // From behind the slope is the same, and the normal the other one.
        let behind = lit(&scene, -left, -5.0, Shading::Phong);
        assert!((behind - 1.0).abs() < 0.03, "{context}, behind {behind}");
    }
    let dented = slope(2.0, 1.0, -50.0);
    assert!((lit(&dented, right, 5.0, Shading::Phong) - 1.0).abs() < 0.03);
    let gentle = slope(2.0, 1.0, 25.0);
    // The normal (−1/2, 0, 1)/√(5/4) with the light (−1, 0, 1)/√2.
    let brightness = lit(&gentle, left, 5.0, Shading::Phong);
    assert!((brightness - 0.9487).abs() < 0.02, "{brightness}");
}

#[test]
fn bump_maps_need_fragments_and_texture_coordinates() {
    let left = Vec3::new(-1.0, 0.0, 1.0);
    let even = 0.5_f32.sqrt();
    let bumpy = slope(2.0, 1.0, 50.0);
    for shading in [Shading::Flat, Shading::Gouraud] {
        let brightness = lit(&bumpy, left, 5.0, shading);
        assert!((brightness - even).abs() < 0.01, "{brightness}");
    }
    let toon = lit(&bumpy, left, 5.0, Shading::Toon);
    assert!(toon > 0.95, "toon light has the bent normal: {toon}");
    for change in 0..3 {
        let mut scene = slope(2.0, 1.0, 50.0);
        match change {
            0 => scene.meshes[0].uvs.clear(),
            1 => scene.meshes[0].uvs = vec![Vec2::splat(0.5); 4],
            _ => scene.materials[0].bump_texture = Some(7),
        }
        let brightness = lit(&scene, left, 5.0, Shading::Phong);
        assert!((brightness - even).abs() < 0.01, "{change}: {brightness}");
    }
    for scale in [f32::NAN, f32::INFINITY, -1e30, 1e30] {
        lit(&slope(2.0, 1.0, scale), left, 5.0, Shading::Phong);
    }
}
