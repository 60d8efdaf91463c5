//! Frames of light: what is above 1 stays, and codes of it are the picture for a screen.

use crate::support::{DEVICES, drawn_alike};
use estampe::srgb;
use estampe_renderer::{
    BoundingBox, CameraOptions, Eye, Fog, Gradient, GradientShape, LightImage, ProjectionKind,
    RenderOptions, Shading, ToneMap, Transparency, render_light,
};
use estampe_scene::{AlphaMode, Material, Mesh, PbrMaterial, Scene, Surface};
use glam::{DVec3, Vec3, Vec4};

/// A square from −1 to 1 that faces +Z at this height.
fn square(z: f32, material: usize) -> Mesh {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    Mesh {
        positions: corners.map(|[x, y]| Vec3::new(x, y, z)).to_vec(),
        normals: vec![Vec3::Z; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        surfaces: vec![Surface {
            material: Some(material),
            triangles: 0..2,
        }],
        ..Mesh::default()
    }
}

/// A lamp: black, and it emits this light.
fn lamp(emissive: Vec3) -> Material {
    Material {
        pbr: Some(Box::new(PbrMaterial {
            base_color: Vec4::new(0.0, 0.0, 0.0, 1.0),
            metallic: 1.0,
            emissive,
            ..PbrMaterial::default()
        })),
        ..Material::default()
    }
}

/// A transparent colour.
fn glass(color: Vec3, opacity: f32) -> Material {
    Material {
        base_color: color,
        opacity,
        alpha_mode: AlphaMode::Blend,
        pbr: Some(Box::new(PbrMaterial {
            base_color: color.extend(opacity),
            is_unlit: true,
            alpha_mode: Some(AlphaMode::Blend),
            ..PbrMaterial::default()
        })),
        ..Material::default()
    }
}

/// The square from −1 to 1 in the middle of a picture from −2 to 2, seen from +Z.
fn options() -> RenderOptions {
    RenderOptions {
        width: 24,
        height: 24,
        samples: 1,
        camera: CameraOptions {
            eye: Eye::At(DVec3::new(0.0, 0.0, 4.0)),
            target_world: Some(DVec3::ZERO),
            projection: ProjectionKind::Orthographic {
                half_height: Some(2.0),
            },
            ..CameraOptions::default()
        },
        ..RenderOptions::default()
    }
}

/// The light, which has the same bits on every device.
fn lit_alike(scene: &Scene, options: &RenderOptions) -> LightImage {
    let draw = |device| {
        let frame = render_light(scene, options, device).expect("a small picture");
        frame.image
    };
    let image = draw(&DEVICES[0]);
    let bits = |image: &LightImage| image.rgba.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    for device in &DEVICES[1..] {
        assert!(
            bits(&draw(device)) == bits(&image),
            "{:?} by {} threads gives other light",
            device.level(),
            device.threads()
        );
    }
    image
}

fn pixel(image: &LightImage, x: usize, y: usize) -> [f32; 4] {
    image.rgba.as_chunks().0[y * image.width as usize + x]
}

fn assert_near(own: [f32; 4], right: [f32; 4], what: &str) {
    for (own, right) in own.into_iter().zip(right) {
        assert!(
            (own - right).abs() <= right.abs() * 1e-5 + 2e-4,
            "{what}: {own}, not {right}"
        );
    }
}

/// Rows: I4.
#[test]
fn a_lamp_brighter_than_one_stays() {
    let scene = Scene {
        meshes: vec![square(0.0, 0)],
        materials: vec![lamp(Vec3::new(40.0, 3.0, 0.25))],
        ..Scene::default()
    };
    for (tone_map, samples) in [
        (ToneMap::Neutral, 1),
        (ToneMap::Aces, 4),
        (ToneMap::Agx, 16),
    ] {
        let bright = RenderOptions {
            tone_map,
            samples,
            exposure_ev: 1.0,
            background: Some([188; 3]),
            ..options()
        };
        let light = lit_alike(&scene, &bright);
        let center = pixel(&light, 12, 12);
        // A black metal reflects next to nothing; light is doubled by the exposure.
        assert_near(center, [80.0, 6.0, 0.5, 1.0], "the lamp");
        // The background is no light of the scene: neither exposure nor tone map apply.
        let linear = srgb::decode(188);
        assert_near(
            pixel(&light, 0, 0),
            [linear, linear, linear, 1.0],
            "the background",
        );
    }
    let clear = RenderOptions {
        background: None,
        samples: 4,
        ..options()
    };
    let light = lit_alike(&scene, &clear);
    assert_eq!(pixel(&light, 0, 0), [0.0; 4]);
    assert_near(
        pixel(&light, 12, 12),
        [40.0, 3.0, 0.25, 1.0],
        "the lamp over nothing",
    );
    // On a border the light is multiplied by alpha.
    let partial = light
        .rgba
        .as_chunks::<4>()
        .0
        .iter()
        .filter(|p| p[3] > 0.0 && p[3] < 1.0);
    for pixel in partial {
        assert_near(
            *pixel,
            [40.0, 3.0, 0.25, 1.0].map(|x| x * pixel[3]),
            "a border",
        );
    }
}

/// Codes of the light are those of the picture, or one beside: the picture rounds each sample.
fn assert_codes(scene: &Scene, options: &RenderOptions, what: &str) {
    let picture = drawn_alike(scene, options).image;
    let light = lit_alike(scene, options);
    let holds_numbers = matches!(
        options.shading,
        Shading::Normals | Shading::Depth | Shading::Uv | Shading::Barycentric | Shading::FaceId
    );
    let pixels = picture
        .rgba
        .as_chunks::<4>()
        .0
        .iter()
        .zip(light.rgba.as_chunks::<4>().0);
    for (at, (codes, light)) in pixels.enumerate() {
        let alpha = light[3];
        let code = |value: f32| (value.clamp(0.0, 1.0) * 255.0).round();
        assert!(
            (code(alpha) - f32::from(codes[3])).abs() <= 1.0,
            "{what}: {at}"
        );
        if codes[3] == 0 {
            continue;
        }
        for (own, light) in codes.iter().zip(&light[..3]) {
            let straight = light / alpha.max(1e-6);
            let right = if holds_numbers {
                code(straight)
            } else {
                f32::from(srgb::encode(straight))
            };
            // Straight colours of faint pixels are coarse in eight bits, and letters with an
            // outline cover a pixel up to nine times.
            let most = match codes[3] {
                _ if options.axes => 6.0,
                255 => 1.0,
                _ => 3.0,
            };
            assert!(
                (right - f32::from(*own)).abs() <= most,
                "{what}, pixel {at}: {own}, not {right}"
            );
        }
    }
}

/// Rows: I4.
#[test]
fn codes_of_the_light_are_the_picture() {
    let panes = [
        glass(Vec3::new(0.7, 0.1, 0.3), 0.5),
        glass(Vec3::new(0.1, 0.5, 0.2), 0.3),
        Material {
            base_color: Vec3::new(0.4, 0.3, 0.2),
            ..Material::default()
        },
    ];
    let scene = Scene {
        meshes: vec![square(0.5, 0), square(0.2, 1), square(-0.3, 2)],
        materials: panes.to_vec(),
        ..Scene::default()
    };
    let clear = Gradient::new(GradientShape::Radial, &[[200, 40, 20, 255], [0, 0, 90, 60]]);
    let opaque = Gradient::new(
        GradientShape::Linear,
        &[[20, 40, 200, 255], [240, 200, 9, 255]],
    );
    let plain = RenderOptions {
        tone_map: ToneMap::None,
        ..options()
    };
    for shading in [
        Shading::Pbr,
        Shading::Phong,
        Shading::Flat,
        Shading::Gouraud,
        Shading::Toon,
        Shading::Unlit,
        Shading::Wireframe,
        Shading::Normals,
        Shading::Depth,
        Shading::Barycentric,
        Shading::FaceId,
        Shading::Overdraw,
    ] {
        let options = RenderOptions {
            shading,
            ..plain.clone()
        };
        assert_codes_of(&scene, &options, &format!("{shading:?}"));
    }
    for transparency in [
        Transparency::Sorted,
        Transparency::Exact,
        Transparency::Weighted,
    ] {
        for (samples, background, gradient) in [
            (1, Some([9, 80, 200]), None),
            (4, Some([9, 80, 200]), opaque),
            (1, None, None),
            (4, None, clear),
        ] {
            let options = RenderOptions {
                transparency,
                samples,
                background,
                gradient,
                ..plain.clone()
            };
            assert_codes(
                &scene,
                &options,
                &format!("{transparency:?} {samples} {background:?}"),
            );
        }
    }
    let marked = RenderOptions {
        width: 96,
        height: 96,
        axes: true,
        grid: true,
        bounding_box: Some(BoundingBox::default()),
        fog: Some(Fog {
            start_world: 3.0,
            end_world: 6.0,
            color: Some([30, 60, 90]),
        }),
        levels: Some(5),
        ..plain
    };
    assert_codes(&scene, &marked, "guides, fog and levels");
}

/// Overdraw counts without a bound in light.
fn assert_codes_of(scene: &Scene, options: &RenderOptions, what: &str) {
    if options.shading != Shading::Overdraw {
        return assert_codes(scene, options, what);
    }
    let light = lit_alike(scene, options);
    let [red, _, blue, _] = pixel(&light, 12, 12);
    assert_near(
        [red, blue, 0.0, 0.0],
        [96.0 / 255.0, 3.0 / 255.0, 0.0, 0.0],
        "three fragments",
    );
}

/// A lamp behind a pane is seen through it, with each method, and is no less bright than it should.
#[test]
fn transparent_surfaces_do_not_clamp_light() {
    let scene = Scene {
        meshes: vec![square(0.5, 1), square(0.0, 0)],
        materials: vec![
            lamp(Vec3::splat(20.0)),
            glass(Vec3::new(0.5, 0.0, 0.0), 0.25),
        ],
        ..Scene::default()
    };
    for transparency in [
        Transparency::Sorted,
        Transparency::Exact,
        Transparency::Weighted,
    ] {
        for samples in [1, 4] {
            let options = RenderOptions {
                transparency,
                samples,
                ..options()
            };
            let light = lit_alike(&scene, &options);
            let expected = [15.125, 15.0, 15.0, 1.0];
            assert_near(
                pixel(&light, 12, 12),
                expected,
                &format!("{transparency:?} {samples}"),
            );
        }
    }
}

#[test]
fn impossible_sizes_are_errors() {
    let scene = Scene {
        meshes: vec![square(0.0, 0)],
        materials: vec![lamp(Vec3::ONE)],
        ..Scene::default()
    };
    for (width, height) in [(0, 1), (1, 0), (1_000_000, 1), (u32::MAX, u32::MAX)] {
        let options = RenderOptions {
            width,
            height,
            ..options()
        };
        assert!(render_light(&scene, &options, &DEVICES[0]).is_err());
    }
}
