//! Shadows of lights, and on the ground.

use crate::support::drawn_alike;
use estampe_renderer::{
    CameraOptions, Environment, EnvironmentMap, Eye, Frame, Ground, ProjectionKind, RenderOptions,
    Shading, Transparency, render,
};
use estampe_scene::{
    AlphaMode, Image, Light, LightSource, Material, Mesh, PbrMaterial, Scene, Surface,
};
use estampe_shapes::BuiltinShape;
use glam::{DVec3, Vec2, Vec3};
use std::sync::Arc;

/// Half of the floor's side.
const FLOOR: f32 = 2.0;

/// A level square at a height, seen from above: corners counter-clockwise from +Y.
fn level_square(half: f32, height: f32) -> Mesh {
    let corners = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]].map(Vec2::from);
    let position = |c: Vec2| Vec3::new(c.x * half, height, c.y * half);
    Mesh {
        positions: corners.map(position).to_vec(),
        normals: vec![Vec3::Y; 4],
        uvs: corners.map(|c| c * 0.5 + 0.5).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// A floor at height 0, and a square of half side 0.5 that floats at height 1.
fn floor_and_square() -> Scene {
    Scene {
        meshes: vec![level_square(FLOOR, 0.0), level_square(0.5, 1.0)],
        ..Scene::default()
    }
}

/// From above, 8 pixels per 0.25 units: x to the left, z upwards.
fn from_above(source: LightSource) -> RenderOptions {
    RenderOptions {
        width: 128,
        height: 128,
        samples: 1,
        camera: CameraOptions {
            eye: Eye::At(DVec3::new(0.0, 9.0, 0.0)),
            target_world: Some(DVec3::ZERO),
            projection: ProjectionKind::Orthographic {
                half_height: Some(f64::from(FLOOR)),
            },
            ..CameraOptions::default()
        },
        shading: Shading::Phong,
        ambient: Some(0.1),
        lights: vec![Light {
            color: Vec3::ONE,
            source,
        }],
        shadows: true,
        ..RenderOptions::default()
    }
}

/// The place of the middle of a pixel on the floor.
fn place(frame: &Frame, index: usize) -> Vec2 {
    let side = frame.image.width as usize;
    let along = |pixel: usize| {
        let pixel = f32::from(u16::try_from(pixel).expect("a small picture"));
        (1.0 - (pixel + 0.5) / 128.0 * 2.0) * FLOOR
    };
    Vec2::new(along(index % side), along(index / side))
}

/// Compares with the same picture without shadows: floor whose ray to the light meets the square is
/// darker, other floor is the same, but for an edge.
fn check_floor(options: &RenderOptions, ray_meets: impl Fn(Vec3) -> Vec2) {
    let lit = RenderOptions {
        shadows: false,
        ..options.clone()
    };
    let scene = floor_and_square();
    let (shaded, lit) = (drawn_alike(&scene, options), drawn_alike(&scene, &lit));
    let (mut dark, mut bright, mut edges) = (0, 0, 0);
    let pixels = shaded
        .image
        .rgba
        .chunks_exact(4)
        .zip(lit.image.rgba.chunks_exact(4));
    for (index, (own, unshaded)) in pixels.enumerate() {
        let at = place(&shaded, index);
        let is_square = at.abs().max_element() < 0.52;
        // Where the ray towards the light is at the square's height, from its edge outwards.
        let outside = ray_meets(Vec3::new(at.x, 0.0, at.y)).abs().max_element() - 0.5;
        if is_square || outside.abs() < 0.04 {
            assert!(own[0] <= unshaded[0], "{at}");
            edges += 1;
        } else if outside < 0.0 {
            assert!(
                u32::from(own[0]) * 2 < u32::from(unshaded[0]),
                "{at} is bright"
            );
            dark += 1;
        } else {
            assert_eq!(own, unshaded, "{at} is dark");
            bright += 1;
        }
    }
    assert!(
        dark > 200 && bright > 8000,
        "{dark} dark, {bright} bright, {edges} edges"
    );
}

/// Rows: F4.
#[test]
fn parallel_light_casts_the_shadow_that_rays_say() {
    let towards = Vec3::new(1.0, 1.5, 0.3);
    let options = from_above(LightSource::Directional {
        towards_light_world: towards,
    });
    for shading in [Shading::Phong, Shading::Pbr] {
        let options = RenderOptions {
            shading,
            ..options.clone()
        };
        check_floor(&options, |floor| {
            let met = floor + towards / towards.y;
            Vec2::new(met.x, met.z)
        });
    }
}

/// Rows: F4.
#[test]
fn light_from_a_point_casts_the_shadow_that_rays_say() {
    let from = Vec3::new(-1.5, 3.0, 0.8);
    let options = from_above(LightSource::Positional {
        position_world: from,
        reach: None,
    });
    for shading in [Shading::Phong, Shading::Pbr] {
        let options = RenderOptions {
            shading,
            ..options.clone()
        };
        check_floor(&options, |floor| {
            let met = floor + (from - floor) / from.y;
            Vec2::new(met.x, met.z)
        });
    }
}

/// Holes of a surface cast no shadow, and transparent surfaces cast none.
#[test]
fn only_what_is_opaque_casts_a_shadow() {
    let hole = |alpha: u8| Image {
        width: 1,
        height: 1,
        rgba: vec![255, 255, 255, alpha],
    };
    let options = from_above(LightSource::Directional {
        towards_light_world: Vec3::new(1.0, 1.5, 0.3),
    });
    let darkest = |alpha_mode, alpha, transparency| {
        let mut scene = floor_and_square();
        scene.images = vec![hole(alpha)];
        scene.materials = vec![Material {
            base_color_texture: Some(0),
            alpha_mode,
            ..Material::default()
        }];
        scene.meshes[1].surfaces = vec![Surface {
            material: Some(0),
            triangles: 0..2,
        }];
        let options = RenderOptions {
            transparency,
            ..options.clone()
        };
        let frame = drawn_alike(&scene, &options);
        // In the shadow of the square, which lies towards −X.
        let pixel = (66 * 128 + 90) * 4;
        frame.image.rgba[pixel]
    };
    let sorted = Transparency::Sorted;
    let shadow = darkest(AlphaMode::Opaque, 255, sorted);
    let light = darkest(AlphaMode::Mask, 0, sorted);
    assert!(
        u32::from(shadow) * 2 < u32::from(light),
        "{shadow}, {light}"
    );
    assert_eq!(darkest(AlphaMode::Mask, 255, sorted), shadow);
    for transparency in [sorted, Transparency::Exact, Transparency::Weighted] {
        assert_eq!(darkest(AlphaMode::Blend, 200, transparency), light);
    }
}

fn builtin(shape: BuiltinShape) -> Scene {
    let shape = shape.build();
    let mesh = Mesh {
        positions: shape.positions,
        normals: shape.normals,
        triangles: shape.triangles,
        ..Mesh::default()
    };
    Scene {
        meshes: vec![mesh],
        ..Scene::default()
    }
}

/// A convex body does not shade itself.
///
/// Rows: F4.
#[test]
fn convex_bodies_look_the_same_with_shadows() {
    for shape in [BuiltinShape::Sphere, BuiltinShape::Cube] {
        let scene = builtin(shape);
        for towards in [[-0.5, 0.8, 0.6], [0.1, 0.1, 1.0], [1.0, 0.2, 0.3]].map(Vec3::from) {
            let shaded = RenderOptions {
                width: 160,
                height: 160,
                shading: Shading::Phong,
                lights: vec![Light {
                    color: Vec3::ONE,
                    source: LightSource::Directional {
                        towards_light_world: towards,
                    },
                }],
                shadows: true,
                ..RenderOptions::default()
            };
            let lit = RenderOptions {
                shadows: false,
                ..shaded.clone()
            };
            let (own, right) = (drawn_alike(&scene, &shaded), drawn_alike(&scene, &lit));
            assert!(
                right.image.rgba.iter().any(|&code| code < 0xa0),
                "something is dark"
            );
            let pairs = own.image.rgba.iter().zip(&right.image.rgba);
            let worst = pairs.map(|(own, right)| own.abs_diff(*right)).max();
            // Where light grazes the facets of the ball, it is weak.
            assert!(
                worst <= Some(8),
                "{shape:?}, light from {towards}: {worst:?} codes"
            );
        }
    }
}

/// Uniform surroundings have no brightest side; a bright half casts a shadow.
#[test]
fn surroundings_cast_shadows_if_a_side_is_brighter() {
    let mut scene = floor_and_square();
    scene.materials = vec![Material {
        pbr: Some(Box::new(PbrMaterial {
            metallic: 0.0,
            ..PbrMaterial::default()
        })),
        ..Material::default()
    }];
    let draw = |map: EnvironmentMap, shadows| {
        let options = RenderOptions {
            shading: Shading::Pbr,
            lights: Vec::new(),
            environment: Environment {
                map: Some(Arc::new(map)),
                ..Environment::default()
            },
            shadows,
            ..from_above(LightSource::Directional {
                towards_light_world: Vec3::Y,
            })
        };
        drawn_alike(&scene, &options).image
    };
    let uniform = || EnvironmentMap::uniform([0.6; 3]);
    assert!(draw(uniform(), true) == draw(uniform(), false));
    // Light from above, where it is brighter towards +X.
    let mut panorama = vec![0.05; 32 * 16 * 3];
    for row in 2..6 {
        for column in 20..28 {
            let first = (row * 32 + column) * 3;
            panorama[first..first + 3].fill(8.0);
        }
    }
    let bright = || {
        let workers = estampe_scene::Workers::ONE;
        EnvironmentMap::from_panorama(32, 16, &panorama, workers).expect("a panorama")
    };
    let (shaded, lit) = (draw(bright(), true), draw(bright(), false));
    let pairs = || shaded.rgba.iter().zip(&lit.rgba);
    assert!(
        pairs().all(|(own, unshaded)| own <= unshaded),
        "shadows are dark"
    );
    let darker = pairs().filter(|(own, unshaded)| u32::from(**own) * 4 < u32::from(**unshaded) * 3);
    assert!(darker.count() > 600, "the shadow is seen");
}

/// The ground shows the shadow alone: its alpha is that of the picture.
#[test]
fn the_ground_is_a_shadow() {
    let scene = builtin(BuiltinShape::Sphere);
    let options = RenderOptions {
        width: 96,
        height: 96,
        background: None,
        ground: Ground::Shadow,
        ..RenderOptions::default()
    };
    let frame = drawn_alike(&scene, &options);
    let none = RenderOptions {
        ground: Ground::None,
        ..options.clone()
    };
    let alone = drawn_alike(&scene, &none);
    let mut shadow = 0;
    let pixels = frame
        .image
        .rgba
        .chunks_exact(4)
        .zip(alone.image.rgba.chunks_exact(4));
    for (own, without) in pixels {
        match without[3] {
            255 => assert_eq!(own, without, "the ground hides nothing"),
            0 => {
                assert!(own[3] == 0 || own[..3] == [0; 3], "{own:?}");
                shadow += u32::from(own[3] > 8);
            }
            _ => {}
        }
    }
    assert!(shadow > 500, "{shadow} pixels of shadow");

    // From below there is none, and numbers stand on none.
    let below = CameraOptions {
        eye: Eye::Fitted(estampe_renderer::ViewDirection {
            azimuth_deg: 20.0,
            elevation_deg: -30.0,
        }),
        ..CameraOptions::default()
    };
    for (camera, shading) in [(below, Shading::Phong), (options.camera, Shading::Normals)] {
        let options = RenderOptions {
            camera,
            shading,
            ..options.clone()
        };
        let none = RenderOptions {
            ground: Ground::None,
            ..options.clone()
        };
        let device = &crate::support::DEVICES[0];
        let [own, right] = [&options, &none].map(|o| render(&scene, o, device).expect("small"));
        assert!(own.image == right.image, "{shading:?}");
    }
}
