//! Physically based surfaces through pictures: squares whose colours are known.

use crate::support::drawn_alike;
use estampe::srgb;
use estampe_renderer::{
    CameraOptions, Environment, EnvironmentMap, Eye, Frame, ProjectionKind, RenderOptions, Shading,
    ToneMap, render,
};
use estampe_scene::{
    AddressMode, AlphaMode, Anisotropy, Clearcoat, Image, Iridescence, Light, LightSource,
    Material, Mesh, MeshAttribute, NormalTexture, PbrMaterial, PunctualLight, PunctualLightKind,
    Scene, Sheen, SpecularLayer, Surface, TextureRef, TextureSampler, Transmission, UvTransform,
    Volume,
};
use estampe_shapes::BuiltinShape;
use glam::{DVec3, Vec2, Vec3, Vec4};
use std::sync::Arc;

/// A material that reflects diffusely alone.
fn diffuse(color: [f32; 3]) -> PbrMaterial {
    PbrMaterial {
        base_color: Vec3::from(color).extend(1.0),
        metallic: 0.0,
        specular: Some(SpecularLayer {
            factor: 0.0,
            texture: None,
            color: Vec3::ONE,
            color_texture: None,
        }),
        ..PbrMaterial::default()
    }
}

/// A square from −1 to 1 in the plane z = 0 that faces +Z; u runs to the right and v down.
fn square(material: PbrMaterial, images: Vec<Image>) -> Scene {
    let corners = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]].map(Vec2::from);
    let position = |uv: Vec2| Vec3::new(uv.x * 2.0 - 1.0, 1.0 - uv.y * 2.0, 0.0);
    let mesh = Mesh {
        positions: corners.map(position).to_vec(),
        normals: vec![Vec3::Z; 4],
        uvs: corners.to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        surfaces: vec![Surface {
            material: Some(0),
            triangles: 0..2,
        }],
        ..Mesh::default()
    };
    scene(mesh, material, images)
}

fn scene(mesh: Mesh, pbr: PbrMaterial, images: Vec<Image>) -> Scene {
    Scene {
        meshes: vec![mesh],
        materials: vec![Material {
            pbr: Some(Box::new(pbr)),
            ..Material::default()
        }],
        images,
        ..Scene::default()
    }
}

/// The square from in front, without a tone map, in these uniform surroundings.
fn options(radiance: f32) -> RenderOptions {
    RenderOptions {
        width: 32,
        height: 32,
        samples: 1,
        camera: CameraOptions {
            eye: Eye::At(DVec3::new(0.0, 0.0, 4.0)),
            target_world: Some(DVec3::ZERO),
            projection: ProjectionKind::Orthographic {
                half_height: Some(1.0),
            },
            ..CameraOptions::default()
        },
        environment: Environment {
            map: Some(Arc::new(EnvironmentMap::uniform([radiance; 3]))),
            ..Environment::default()
        },
        tone_map: ToneMap::None,
        ..RenderOptions::default()
    }
}

/// The linear colour of a pixel.
fn color(frame: &Frame, x: usize, y: usize) -> [f32; 3] {
    let first = (y * frame.image.width as usize + x) * 4;
    [0, 1, 2].map(|channel| srgb::decode(frame.image.rgba[first + channel]))
}

fn assert_near(own: [f32; 3], right: [f32; 3], what: &str) {
    for (own, right) in own.into_iter().zip(right) {
        // A code of sRGB is at most 0.9 % of white.
        assert!(
            (own - right).abs() < 0.006 + right * 0.01,
            "{what}: {own}, not {right}"
        );
    }
}

/// A metal ball whose surroundings are as bright as the background cannot be seen.
///
/// Rows: F4.
#[test]
fn a_white_ball_vanishes_in_a_white_furnace() {
    let ball = BuiltinShape::Sphere.build();
    let mesh = Mesh {
        positions: ball.positions,
        normals: ball.normals,
        triangles: ball.triangles,
        surfaces: Vec::new(),
        ..Mesh::default()
    };
    for (metallic, roughness) in [(1.0, 0.1), (1.0, 0.6), (1.0, 1.0), (0.0, 0.3), (0.0, 0.9)] {
        let material = PbrMaterial {
            metallic,
            roughness,
            ..PbrMaterial::default()
        };
        let mut scene = scene(mesh.clone(), material, Vec::new());
        scene.meshes[0].surfaces.push(Surface {
            material: Some(0),
            triangles: 0..mesh.triangles.len(),
        });
        let grey = [0xbc; 3];
        let options = RenderOptions {
            background: Some(grey),
            camera: CameraOptions::default(),
            ..options(srgb::decode(grey[0]))
        };
        let frame = drawn_alike(&scene, &options);
        assert!(frame.statistics.fragments_shaded > 300, "the ball is drawn");
        for &code in &frame.image.rgba {
            let off = code.abs_diff(grey[0]);
            assert!(code == 255 || off <= 1, "{metallic} {roughness}: {code}");
        }
    }
}

/// What is emitted, its strength, and the exposure.
#[test]
fn emitted_light_is_multiplied_by_its_strength_and_the_exposure() {
    let material = PbrMaterial {
        emissive: Vec3::new(0.1, 0.05, 0.0),
        emissive_strength: 2.0,
        ..diffuse([0.0; 3])
    };
    let bright = RenderOptions {
        exposure_ev: 1.0,
        ..options(0.0)
    };
    let frame = drawn_alike(&square(material, Vec::new()), &bright);
    assert_near(color(&frame, 16, 16), [0.4, 0.2, 0.0], "emitted");
}

/// A point light of I candela at distance d: I ÷ d² · colour ÷ π. It shines if it is asked for.
#[test]
fn lights_of_the_scene_have_their_units() {
    let mut scene = square(diffuse([1.0, 0.5, 0.25]), Vec::new());
    scene.lights.push(PunctualLight {
        name: String::new(),
        kind: PunctualLightKind::Point {
            position_world: Vec3::new(0.0, 0.0, 20.0),
            range: None,
        },
        color: Vec3::ONE,
        intensity: 400.0 * std::f32::consts::PI * 0.5,
    });
    let lit = RenderOptions {
        scene_lights: true,
        ..options(0.0)
    };
    assert_near(
        color(&drawn_alike(&scene, &lit), 16, 16),
        [0.5, 0.25, 0.125],
        "lit",
    );
    let dark = drawn_alike(&scene, &options(0.0));
    assert_near(color(&dark, 16, 16), [0.0; 3], "dark");
}

/// A normal map that leans to the right is brighter in light from the right, and one that leans up
/// in light from above; mirrored coordinates mirror it.
///
/// Rows: F4.
#[test]
fn normal_maps_lean_as_their_texture_says() {
    // (0.6, 0, 0.8) and (0, 0.6, 0.8) as codes.
    let leaning = [[204, 128, 230, 255], [128, 204, 230, 255]];
    for (axis, texel) in leaning.into_iter().enumerate() {
        let material = PbrMaterial {
            normal_texture: Some(NormalTexture {
                texture: TextureRef::new(0),
                scale: 1.0,
            }),
            ..diffuse([1.0; 3])
        };
        let image = Image::filled(4, 4, texel);
        let upright = square(material.clone(), vec![image.clone()]);
        let mut mirrored = upright.clone();
        for uv in &mut mirrored.meshes[0].uvs {
            uv[axis] = 1.0 - uv[axis];
        }
        // Tangents that the file brings give the same as those that are made.
        let mut given = upright.clone();
        given.meshes[0].attributes.push(MeshAttribute {
            name: Mesh::TANGENT.to_owned(),
            components: 4,
            values: [1.0, 0.0, 0.0, 1.0].repeat(4),
        });
        let mut towards = Vec3::new(0.0, 0.0, 0.8);
        towards[axis] = 0.6;
        let light = |towards_light_world| RenderOptions {
            lights: vec![Light {
                source: LightSource::Directional {
                    towards_light_world,
                },
                color: Vec3::ONE,
            }],
            ..options(0.0)
        };
        for (name, scene, right) in [
            ("upright", &upright, 1.0),
            ("given", &given, 1.0),
            ("mirrored", &mirrored, 0.28),
        ] {
            let frame = drawn_alike(scene, &light(towards));
            assert_near(color(&frame, 9, 21), [right; 3], &format!("{name} {axis}"));
        }
    }
}

/// Textures are sampled at the set of coordinates, the transform and the sampler of the material.
#[test]
fn textures_have_their_own_coordinates_and_samplers() {
    let mut image = Image::filled(2, 1, [255, 0, 0, 255]);
    image.rgba[4..].copy_from_slice(&[0, 255, 0, 255]);
    let texture = TextureRef {
        sampler: TextureSampler {
            magnify: estampe_scene::TextureFilter::Nearest,
            ..TextureSampler::default()
        },
        ..TextureRef::new(0)
    };
    let drawn = |texture: TextureRef| {
        let material = PbrMaterial {
            base_color_texture: Some(texture),
            is_unlit: true,
            ..diffuse([1.0; 3])
        };
        let mut scene = square(material, vec![image.clone()]);
        scene.meshes[0].attributes.push(MeshAttribute {
            name: Mesh::UV1.to_owned(),
            components: 2,
            values: [[0.9, 0.5]; 4].concat(),
        });
        let frame = drawn_alike(&scene, &options(1.0));
        [color(&frame, 4, 16), color(&frame, 27, 16)]
    };
    let (red, green) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    assert_eq!(drawn(texture), [red, green]);
    let second = TextureRef {
        uv_set: 1,
        ..texture
    };
    assert_eq!(drawn(second), [green, green]);
    let moved = |x: f32| TextureRef {
        transform: UvTransform {
            offset: Vec2::new(x, 0.0),
            ..UvTransform::IDENTITY
        },
        ..texture
    };
    assert_eq!(drawn(moved(0.5)), [green, red]);
    let clamped = TextureRef {
        sampler: TextureSampler {
            wrap_u: AddressMode::ClampToEdge,
            ..texture.sampler
        },
        ..moved(0.5)
    };
    assert_eq!(drawn(clamped), [green, green]);
}

/// Rows: F4.
#[test]
fn cut_outs_have_the_cutoff_of_the_material() {
    for (cutoff, is_visible) in [(0.2, true), (0.4, false)] {
        let material = PbrMaterial {
            base_color: Vec4::new(0.0, 1.0, 0.0, 0.3),
            alpha_cutoff: cutoff,
            is_unlit: true,
            ..PbrMaterial::default()
        };
        let mut scene = square(material, Vec::new());
        scene.materials[0].alpha_mode = AlphaMode::Mask;
        scene.materials[0].opacity = 0.3;
        let frame = drawn_alike(&scene, &options(1.0));
        let is_green = color(&frame, 16, 16) == [0.0, 1.0, 0.0];
        assert_eq!(is_green, is_visible, "cutoff {cutoff}");
    }
}

/// The vertices' alpha of 1 is rounded in each pixel where a surface is seen at an angle.
#[test]
fn an_alpha_that_equals_the_cutoff_is_kept_everywhere() {
    let drawn = |alpha: f32, cutoff: f32, samples: u32| {
        let material = PbrMaterial {
            base_color: Vec4::new(0.0, 1.0, 0.0, alpha),
            alpha_cutoff: cutoff,
            is_unlit: true,
            ..PbrMaterial::default()
        };
        let mut scene = square(material, Vec::new());
        scene.materials[0].alpha_mode = AlphaMode::Mask;
        scene.materials[0].opacity = alpha;
        let mut options = options(1.0);
        options.samples = samples;
        options.camera.eye = Eye::At(DVec3::new(2.0, 1.0, 1.0));
        drawn_alike(&scene, &options).image
    };
    for samples in [1, 4] {
        for alpha in [0.3, 0.5, 1.0] {
            let whole = drawn(alpha, 0.1, samples);
            assert!(drawn(alpha, alpha, samples) == whole, "{alpha}");
            assert!(drawn(alpha, alpha + 0.01, samples) != whole, "{alpha}");
        }
    }
}

#[test]
fn backs_of_faces_are_visible_if_the_material_says_so() {
    for is_double_sided in [true, false] {
        let material = PbrMaterial {
            is_unlit: true,
            is_double_sided,
            ..diffuse([1.0, 0.0, 0.0])
        };
        let scene = square(material, Vec::new());
        let mut options = options(1.0);
        options.camera.eye = Eye::At(DVec3::new(0.0, 0.0, -4.0));
        let frame = drawn_alike(&scene, &options);
        assert_eq!(color(&frame, 16, 16) == [1.0, 0.0, 0.0], is_double_sided);
    }
}

/// A scene without such materials is drawn by Phong's model, one with them physically.
#[test]
fn the_shading_follows_the_materials() {
    let physical = square(diffuse([0.5; 3]), Vec::new());
    let mut plain = physical.clone();
    plain.materials[0].pbr = None;
    assert_eq!(Shading::Automatic.of_scene(&physical), Shading::Pbr);
    assert_eq!(Shading::Automatic.of_scene(&plain), Shading::Phong);
    assert_eq!(Shading::Toon.of_scene(&physical), Shading::Toon);
    for scene in [physical, plain] {
        let automatic = drawn_alike(&scene, &options(0.3));
        let named = RenderOptions {
            shading: Shading::Automatic.of_scene(&scene),
            ..options(0.3)
        };
        assert!(drawn_alike(&scene, &named).image == automatic.image);
    }
}

/// Every layer at once, in the studio and in light of the scene: the same bytes on every device,
/// for numbers that no material should have too.
///
/// Rows: D4.
#[test]
fn pictures_do_not_depend_on_the_device() {
    let device = &crate::support::DEVICES[0];
    let mut pictures = Vec::new();
    for value in [0.5, 0.0, -3.0, 1e30, f32::NAN, f32::INFINITY] {
        let texture = Some(TextureRef::new(0));
        let normal_texture = Some(NormalTexture {
            texture: TextureRef::new(0),
            scale: value,
        });
        let material = PbrMaterial {
            base_color: Vec4::splat(value),
            base_color_texture: texture,
            metallic: value,
            roughness: value,
            metallic_roughness_texture: texture,
            normal_texture,
            occlusion_texture: texture,
            emissive: Vec3::splat(value) * 0.1,
            emissive_texture: texture,
            ior: value + 1.0,
            specular: Some(SpecularLayer {
                factor: value,
                texture,
                color: Vec3::splat(value),
                color_texture: texture,
            }),
            clearcoat: Some(Clearcoat {
                factor: value,
                texture,
                roughness: value,
                roughness_texture: texture,
                normal_texture,
            }),
            sheen: Some(Sheen {
                color: Vec3::splat(value),
                color_texture: texture,
                roughness: value,
                roughness_texture: texture,
            }),
            anisotropy: Some(Anisotropy {
                strength: value,
                rotation_rad: value,
                texture,
            }),
            iridescence: Some(Iridescence {
                factor: value,
                texture,
                ior: value,
                thickness_min_nm: value,
                thickness_max_nm: value * 600.0,
                thickness_texture: texture,
            }),
            transmission: Some(Transmission {
                factor: value,
                texture,
            }),
            volume: Some(Volume {
                thickness: value,
                thickness_texture: texture,
                attenuation_distance: value,
                attenuation_color: Vec3::splat(value),
            }),
            dispersion: value,
            ..PbrMaterial::default()
        };
        let ball = BuiltinShape::Torus.build();
        let count = ball.triangles.len();
        let mesh = Mesh {
            positions: ball.positions,
            normals: ball.normals,
            uvs: ball.uvs,
            triangles: ball.triangles,
            surfaces: vec![Surface {
                material: Some(0),
                triangles: 0..count,
            }],
            ..Mesh::default()
        };
        let mut image = Image::filled(8, 8, [200, 120, 240, 255]);
        image.rgba[64..128].fill(90);
        let mut scene = scene(mesh, material, vec![image]);
        scene.lights.push(PunctualLight {
            name: String::new(),
            kind: PunctualLightKind::Spot {
                position_world: Vec3::new(1.0, 2.0, 3.0),
                direction_world: Vec3::new(-1.0, -2.0, -3.0),
                range: Some(50.0),
                inner_cone_rad: 0.2,
                outer_cone_rad: 0.5,
            },
            color: Vec3::ONE,
            intensity: value,
        });
        let options = RenderOptions {
            width: 40,
            height: 32,
            scene_lights: true,
            tone_map: ToneMap::Agx,
            ..RenderOptions::default()
        };
        pictures.push(drawn_alike(&scene, &options).image);
    }
    assert!(pictures[0] != pictures[1]);
    // Nothing to draw is a picture too.
    assert!(render(&Scene::default(), &RenderOptions::default(), device).is_ok());
}
