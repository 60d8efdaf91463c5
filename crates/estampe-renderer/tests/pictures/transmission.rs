//! Light that passes through surfaces, in pictures whose colours are known.

use crate::support::drawn_alike;
use estampe::srgb;
use estampe_renderer::{
    CameraOptions, Environment, EnvironmentMap, Eye, Frame, Ground, ProjectionKind, RenderOptions,
    ToneMap, composite_over,
};
use estampe_scene::{
    AlphaMode, Material, Mesh, PbrMaterial, Scene, SpecularLayer, Surface, Transmission, Volume,
};
use glam::{DVec3, Vec3};
use std::sync::Arc;

/// Glass that reflects nothing: what is seen is what passes.
fn glass() -> PbrMaterial {
    PbrMaterial {
        metallic: 0.0,
        roughness: 0.0,
        specular: Some(SpecularLayer {
            factor: 0.0,
            texture: None,
            color: Vec3::ONE,
            color_texture: None,
        }),
        transmission: Some(Transmission {
            factor: 1.0,
            texture: None,
        }),
        alpha_mode: Some(AlphaMode::Opaque),
        ..PbrMaterial::default()
    }
}

fn body(thickness: f32) -> Option<Volume> {
    Some(Volume {
        thickness,
        thickness_texture: None,
        attenuation_distance: f32::INFINITY,
        attenuation_color: Vec3::ONE,
    })
}

fn shining(color: [f32; 3]) -> PbrMaterial {
    PbrMaterial {
        base_color: Vec3::ZERO.extend(1.0),
        emissive: color.into(),
        ..glass_less()
    }
}

/// No reflection, and nothing passes.
fn glass_less() -> PbrMaterial {
    PbrMaterial {
        transmission: None,
        ..glass()
    }
}

/// A rectangle at a height z, with one normal.
fn rectangle([x0, x1]: [f32; 2], z: f32, normal: Vec3) -> Mesh {
    let corners = [[x0, -1.0], [x1, -1.0], [x1, 1.0], [x0, 1.0]];
    Mesh {
        positions: corners.map(|[x, y]| Vec3::new(x, y, z)).to_vec(),
        normals: vec![normal; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// Meshes with their materials.
fn scene(parts: Vec<(Mesh, PbrMaterial)>) -> Scene {
    let mut scene = Scene::default();
    for (number, (mut mesh, pbr)) in parts.into_iter().enumerate() {
        mesh.surfaces = vec![Surface {
            material: Some(number),
            triangles: 0..mesh.triangles.len(),
        }];
        scene.meshes.push(mesh);
        let blends = pbr.alpha_mode == Some(AlphaMode::Blend);
        scene.materials.push(Material {
            alpha_mode: if blends {
                AlphaMode::Blend
            } else {
                AlphaMode::Opaque
            },
            pbr: Some(Box::new(pbr)),
            ..Material::default()
        });
    }
    scene
}

/// From in front in parallel projection, 64 pixels for −1..1, without light from all around.
fn options() -> RenderOptions {
    RenderOptions {
        width: 64,
        height: 64,
        camera: CameraOptions {
            eye: Eye::At(DVec3::new(0.0, 0.0, 4.0)),
            target_world: Some(DVec3::ZERO),
            projection: ProjectionKind::Orthographic {
                half_height: Some(1.0),
            },
            ..CameraOptions::default()
        },
        environment: Environment {
            map: Some(Arc::new(EnvironmentMap::uniform([0.0; 3]))),
            ..Environment::default()
        },
        tone_map: ToneMap::None,
        ..RenderOptions::default()
    }
}

fn color(frame: &Frame, x: usize, y: usize) -> [f32; 3] {
    let first = (y * frame.image.width as usize + x) * 4;
    [0, 1, 2].map(|channel| srgb::decode(frame.image.rgba[first + channel]))
}

#[track_caller]
fn assert_near(own: [f32; 3], right: [f32; 3]) {
    for (one, expected) in own.into_iter().zip(right) {
        // A code of sRGB is at most 0.9 % of white.
        let bound = 0.003 + expected * 0.01;
        assert!((one - expected).abs() < bound, "{own:?}, not {right:?}");
    }
}

/// Thin clear glass cannot be seen, before surfaces and before the background, with each tone map,
/// in fog, and with one sample as with several.
///
/// Rows: F4.
#[test]
fn clear_glass_is_invisible() {
    let wall = || {
        (
            rectangle([-0.7, 0.3], -0.5, Vec3::Z),
            shining([0.6, 0.1, 0.3]),
        )
    };
    let without = scene(vec![wall()]);
    let with = scene(vec![
        wall(),
        (rectangle([-0.5, 0.9], 0.5, Vec3::Z), glass()),
    ]);
    for tone_map in [ToneMap::None, ToneMap::Neutral, ToneMap::Agx] {
        for samples in [1, 4] {
            let options = RenderOptions {
                tone_map,
                samples,
                background: Some([10, 200, 120]),
                ..options()
            };
            let (own, right) = (
                drawn_alike(&with, &options),
                drawn_alike(&without, &options),
            );
            let own = own.image.rgba.iter().zip(&right.image.rgba);
            let most = { own }.map(|(a, b)| a.abs_diff(*b)).max();
            // Light is in binary16, and at edges that of a pixel's samples is a mean.
            assert!(most <= Some(4), "{tone_map:?}, {samples}: {most:?}");
        }
    }
}

/// The base colour tints, and of a body the attenuation colour to the power of the thickness over
/// its distance, in units of the file whatever the size of the model and the mesh's scale.
///
/// Rows: F4.
#[test]
fn bodies_absorb_by_their_thickness() {
    let tinted = PbrMaterial {
        base_color: Vec3::new(0.9, 0.5, 0.2).extend(1.0),
        ..glass()
    };
    let thick = PbrMaterial {
        volume: Some(Volume {
            thickness: 3.0,
            thickness_texture: None,
            attenuation_distance: 4.0,
            attenuation_color: Vec3::new(0.5, 0.25, 1.0),
        }),
        ..tinted.clone()
    };
    let scaled = Mesh {
        scale: Some(2.0),
        ..rectangle([-0.5, 0.5], 0.5, Vec3::Z)
    };
    let light = [0.8, 0.8, 0.8];
    let wall = || (rectangle([-1.0, 1.0], -0.5, Vec3::Z), shining(light));
    let of = |mesh: &Mesh, material: &PbrMaterial| {
        let drawn = scene(vec![wall(), (mesh.clone(), material.clone())]);
        color(&drawn_alike(&drawn, &options()), 32, 32)
    };
    let pane = rectangle([-0.5, 0.5], 0.5, Vec3::Z);
    assert_near(of(&pane, &tinted), [0.72, 0.4, 0.16]);
    // 0.5^(3/4), 0.25^(3/4).
    assert_near(of(&pane, &thick), [0.72 * 0.5946, 0.4 * 0.3536, 0.16]);
    // The thickness is 6 of the world's units.
    assert_near(of(&scaled, &thick), [0.72 * 0.3536, 0.4 * 0.125, 0.16]);
}

/// The edge between dark and bright, seen through a body whose normal leans: it moves by the
/// refracted ray, and each colour by its own with dispersion.
///
/// Rows: F4.
#[test]
fn leaning_bodies_move_what_is_behind() {
    let normal = Vec3::new(0.6, 0.0, 0.8);
    let (thickness, dispersion) = (0.5, 8.0);
    let drawn = |dispersion: f32| {
        let material = PbrMaterial {
            volume: body(thickness),
            ior: 1.5,
            dispersion,
            ..glass()
        };
        let scene = scene(vec![
            (rectangle([-1.0, 0.0], -0.5, Vec3::Z), shining([1.0; 3])),
            (rectangle([0.0, 1.0], -0.5, Vec3::Z), shining([0.0; 3])),
            (rectangle([-1.0, 1.0], 0.5, normal), material),
        ]);
        drawn_alike(&scene, &options())
    };
    // Snell: the ray along −z, refracted, after the thickness.
    let offset = |ior: f32| {
        let (sin, cos) = (0.6_f32 / ior, 0.8_f32);
        let inside = (1.0 - sin * sin).sqrt();
        // eta·v − n·(eta·d + √k) with v = −z and d = −cos.
        let x = -normal.x * (-cos / ior + inside);
        x * thickness
    };
    let edge = |frame: &Frame, channel: usize| {
        let bright = (0..64).filter(|&x| color(frame, x, 32)[channel] > 0.5);
        bright.count() as f32
    };
    let plain = drawn(0.0);
    for channel in 0..3 {
        // Bright while x + offset < 0.
        let right = (1.0 - offset(1.5)) * 32.0;
        assert!((edge(&plain, channel) - right).abs() <= 1.0, "{right}");
    }
    let spread = drawn(dispersion);
    let half = 0.5 * 0.025 * dispersion;
    for (channel, ior) in [1.5 - half, 1.5, 1.5 + half].into_iter().enumerate() {
        let right = (1.0 - offset(ior)) * 32.0;
        let own = edge(&spread, channel);
        assert!((own - right).abs() <= 1.0, "{channel}: {own}, not {right}");
    }
    assert!(edge(&spread, 0) != edge(&spread, 2));
}

/// Rough glass blurs an edge, more with a higher index, and keeps its light.
///
/// Rows: F4.
#[test]
fn rough_glass_blurs_by_its_index() {
    let width = |roughness: f32, ior: f32| {
        let material = PbrMaterial {
            roughness,
            ior,
            ..glass()
        };
        let scene = scene(vec![
            (rectangle([-1.0, 0.0], -0.5, Vec3::Z), shining([0.8; 3])),
            (rectangle([0.0, 1.0], -0.5, Vec3::Z), shining([0.0; 3])),
            (rectangle([-1.0, 1.0], 0.5, Vec3::Z), material),
        ]);
        let frame = drawn_alike(&scene, &options());
        let row: Vec<f32> = (0..64).map(|x| color(&frame, x, 32)[0]).collect();
        let mean = row.iter().sum::<f32>() / 64.0;
        assert!((mean - 0.4).abs() < 0.02, "{roughness} {ior}: {mean}");
        assert!(row.windows(2).all(|pair| pair[0] >= pair[1] - 1e-3));
        row.iter().filter(|&&c| (0.05..0.75).contains(&c)).count()
    };
    assert!(width(0.0, 1.5) <= 2);
    // An index of 1 has no interface that could be rough.
    assert!(width(0.5, 1.0) <= 2);
    assert!(width(0.3, 1.5) > 3);
    assert!(width(0.6, 1.5) > 2 * width(0.3, 1.5));
    assert!(width(0.6, 1.2) < width(0.6, 1.5));
}

/// The picture before nothing, laid over the default background, is the picture before that
/// background: tinted glass, glass before a wall, and glass whose alpha blends.
///
/// Rows: F4.
#[test]
fn glass_before_nothing_can_be_laid_over_a_background() {
    let tinted = PbrMaterial {
        base_color: Vec3::new(0.9, 0.6, 0.3).extend(1.0),
        ..glass()
    };
    let blended = PbrMaterial {
        base_color: Vec3::new(0.3, 0.6, 0.9).extend(0.5),
        alpha_mode: Some(AlphaMode::Blend),
        ..glass()
    };
    let scene = scene(vec![
        (
            rectangle([-0.4, 0.1], -0.5, Vec3::Z),
            shining([0.1, 0.3, 0.7]),
        ),
        (rectangle([-0.9, -0.1], 0.2, Vec3::Z), tinted),
        (rectangle([0.0, 0.8], 0.5, Vec3::Z), blended),
    ]);
    let over = options();
    let nothing = RenderOptions {
        background: None,
        ..options()
    };
    let laid = composite_over(
        &drawn_alike(&scene, &nothing).image,
        RenderOptions::DEFAULT_BACKGROUND,
    );
    let right = drawn_alike(&scene, &over).image;
    let codes = laid.rgba.iter().zip(&right.rgba);
    let most = { codes }.map(|(a, b)| a.abs_diff(*b)).max();
    assert!(most <= Some(3), "{most:?}");
}

/// Of a surface that blends, alpha is the coverage: half of the glass, half of what is behind.
///
/// Rows: F4.
#[test]
fn alpha_is_the_coverage_of_glass() {
    let blended = PbrMaterial {
        base_color: Vec3::new(0.5, 1.0, 0.0).extend(0.5),
        alpha_mode: Some(AlphaMode::Blend),
        ..glass()
    };
    let drawn = scene(vec![
        (
            rectangle([-1.0, 0.0], -0.5, Vec3::Z),
            shining([0.8, 0.4, 0.6]),
        ),
        (rectangle([-1.0, 1.0], 0.5, Vec3::Z), blended),
    ]);
    let white = RenderOptions {
        background: Some([255; 3]),
        ..options()
    };
    let frame = drawn_alike(&drawn, &white);
    assert_near(color(&frame, 12, 32), [0.6, 0.4, 0.3]);
    assert_near(color(&frame, 52, 32), [0.75, 1.0, 0.5]);
}

/// The ground's shadow, lines and points are seen through glass.
#[test]
fn the_ground_lines_and_points_are_behind_glass() {
    let mut wall = rectangle([-0.6, 0.6], -0.5, Vec3::Z);
    wall.lines = vec![[0, 2]];
    wall.points = vec![1, 3];
    let pane = (rectangle([-1.0, 1.0], 0.6, Vec3::Z), glass());
    let black = shining([0.0; 3]);
    let behind = scene(vec![(wall, black)]);
    let mut with = behind.clone();
    let glass = scene(vec![pane]);
    with.meshes.extend(glass.meshes);
    with.meshes[1].surfaces[0].material = Some(1);
    with.materials.extend(glass.materials);
    let options = RenderOptions {
        ground: Ground::Shadow,
        camera: CameraOptions {
            eye: Eye::At(DVec3::new(0.0, 3.0, 4.0)),
            ..options().camera
        },
        ..options()
    };
    let (own, right) = (drawn_alike(&with, &options), drawn_alike(&behind, &options));
    // The unit space is that of both, so compare where the glass is not seen edge-on.
    let differing = own.image.rgba.chunks(4).zip(right.image.rgba.chunks(4));
    let differing = { differing }
        .filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 24))
        .count();
    assert!(differing < 64 * 64 / 50, "{differing} pixels");
}
